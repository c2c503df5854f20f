//! Measures of the roots: acceleration, arrival, stalling, detours, side-steps, tracking (`FbCrowd` App. 11, Eq. 18,
//! whose sum runs over T steps; it is printed to N, and with one term too many).
//!
//! Velocities are differences of the synthesised root, whose path is ripple-free. Agents start from rest, so T steps
//! have T accelerations. World, metres, seconds.

use glam::{DVec2, Vec2};
use motiondb::statistics::mean;

use crate::behaviour::Behaviour;
use crate::measures::frame_pairs::FramePairs;
use crate::planning::plan::VelocitySet;
use crate::population::{AgentId, Population};
use crate::recording::frame::AgentFrame;
use crate::route::arrival::Arrival;
use crate::scenario::{AgentSpec, Scenario};

/// Speed below which an agent stands: it stalls if it does so for [`STALL_S`] before it arrives, m/s.
const STALL_SPEED_MPS: f64 = 0.1;
/// Time of standing that counts as stalling, s.
const STALL_S: f64 = 5.0;

/// Measures every root, step by step, while its agent is present. Means over steps are over those before each agent's arrival unless stated.
#[derive(Debug)]
pub(crate) struct RootMeasures {
    dt_s: f64,
    steps: usize,
    behaviour: Behaviour,
    /// By id.
    tracks: Vec<RootTrack>,
    /// A: acceleration over all steps, m/s².
    pub(crate) acceleration_mps2: RunningMean,
    /// Acceleration before arrival, m/s².
    pub(crate) acceleration_before_arrival_mps2: RunningMean,
    /// Distance between the root and the position to which the planned velocity leads, over all steps, m.
    pub(crate) tracking_error_m: RunningMean,
    /// Greatest such distance, m.
    pub(crate) tracking_worst_m: f64,
    /// Angle between facing and displacement of an agent that walks in the turning set, degrees.
    pub(crate) heading_error_deg: RunningMean,
    /// Angle between facing and displacement of an agent that walks, degrees.
    pub(crate) walking_heading_error_deg: RunningMean,
    /// Share of steps of side-stepping at held facing.
    pub(crate) strafing: RunningMean,
    /// Share of steps of stepping back at held facing.
    pub(crate) stepping_back: RunningMean,
}

/// A mean to which values are added one by one.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct RunningMean {
    sum: f64,
    count: usize,
}

/// One agent so far.
#[derive(Debug)]
struct RootTrack {
    agent: AgentSpec,
    /// Time at which the agent was born, s.
    born_s: f64,
    /// Whether the agent was removed.
    is_gone: bool,
    arrival: Arrival,
    velocity_mps: DVec2,
    /// Length of the path until the arrival, m.
    path_m: f64,
    /// That length, divided by the straight path's, on arrival; none of a straight path without length.
    path_over_straight: Option<f64>,
    slow_steps: usize,
    stalled: bool,
}

/// How an agent walks while the planner holds its facing (§4.5).
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Sidewards {
    Strafing,
    SteppingBack,
}

impl RunningMean {
    fn add(&mut self, value: f64) {
        self.sum += value;
        self.count += 1;
    }

    /// The mean; 0 of no values.
    pub(crate) fn value(self) -> f64 {
        self.sum / self.count.max(1) as f64
    }
}

impl RootMeasures {
    /// The agents at their start.
    pub(crate) fn new(scenario: &Scenario, population: &Population, start: &[AgentFrame]) -> Self {
        let mut measures = Self {
            dt_s: scenario.dt_s.into(),
            steps: 0,
            behaviour: scenario.behaviour.clone(),
            tracks: Vec::new(),
            acceleration_mps2: RunningMean::default(),
            acceleration_before_arrival_mps2: RunningMean::default(),
            tracking_error_m: RunningMean::default(),
            tracking_worst_m: 0.0,
            heading_error_deg: RunningMean::default(),
            walking_heading_error_deg: RunningMean::default(),
            strafing: RunningMean::default(),
            stepping_back: RunningMean::default(),
        };
        start.iter().for_each(|frame| measures.begin(population, frame));
        measures
    }

    /// Begins with an agent that is born in the present frame.
    fn begin(&mut self, population: &Population, frame: &AgentFrame) {
        let now_s = self.steps as f64 * self.dt_s;
        let mut track = RootTrack::new(population.spec(frame.id), now_s);
        track.arrive(frame, &self.behaviour, now_s);
        self.tracks.push(track);
    }

    /// Adds one step, given the agents that are present before and after it, and those that were removed or born.
    pub(crate) fn push(&mut self, population: &Population, pairs: &FramePairs<'_>) {
        self.steps += 1;
        let now_s = self.steps as f64 * self.dt_s;
        pairs.removed.iter().for_each(|agent| self.tracks[agent.id.index()].leave(now_s));
        for &(before, after) in &pairs.common {
            let track = &mut self.tracks[after.id.index()];
            let displacement_m = position_m(after) - position_m(before);
            let velocity_mps = displacement_m / self.dt_s;
            let acceleration_mps2 = (velocity_mps - track.velocity_mps).length() / self.dt_s;
            track.velocity_mps = velocity_mps;
            self.acceleration_mps2.add(acceleration_mps2); // Eq. 18: ‖a_i‖
            if track.arrival.at_s.is_none() {
                self.acceleration_before_arrival_mps2.add(acceleration_mps2);
                let sidewards = track.sidewards(after);
                self.strafing.add(f64::from(sidewards == Some(Sidewards::Strafing)));
                self.stepping_back.add(f64::from(sidewards == Some(Sidewards::SteppingBack)));
                if velocity_mps.length() >= STALL_SPEED_MPS {
                    let error_deg = heading_error_deg(displacement_m, before, after);
                    self.walking_heading_error_deg.add(error_deg);
                    if after.set == VelocitySet::Turning {
                        self.heading_error_deg.add(error_deg);
                    }
                }
                track.path_m += displacement_m.length();
                track.watch_for_stall(after, self.dt_s);
            }
            let tracking_error_m = displacement_m.distance(DVec2::from(after.planned_mps) * self.dt_s);
            self.tracking_error_m.add(tracking_error_m);
            self.tracking_worst_m = self.tracking_worst_m.max(tracking_error_m);
            track.arrive(after, &self.behaviour, now_s);
        }
        pairs.born.iter().for_each(|frame| self.begin(population, frame));
    }

    /// Whether every present agent has passed its waypoints and is near its last goal now.
    pub(crate) fn all_are_at_goals(&self) -> bool {
        self.tracks.iter().all(|track| track.arrival.is_at_goal || track.is_gone)
    }

    /// Whether an agent has arrived at its last goal so far.
    pub(crate) fn has_arrived(&self, id: AgentId) -> bool {
        self.tracks.get(id.index()).is_some_and(|track| track.arrival.at_s.is_some())
    }

    /// Number of agents that have arrived, whether they are still present or not.
    pub(crate) fn arrived(&self) -> usize {
        self.tracks.iter().filter(|track| track.arrival.at_s.is_some()).count()
    }

    /// Number of agents that stalled before they arrived.
    pub(crate) fn stalled(&self) -> usize {
        self.tracks.iter().filter(|track| track.stalled).count()
    }

    /// Mean time from birth to arrival, s; none where no agent arrived.
    pub(crate) fn mean_time_to_goal_s(&self) -> Option<f64> {
        mean(self.tracks.iter().filter_map(|track| Some(track.arrival.at_s? - track.born_s)))
    }

    /// Mean length of the paths until arrival, divided by that of the straight paths; none where no agent had to move.
    pub(crate) fn path_over_straight_line(&self) -> Option<f64> {
        mean(self.tracks.iter().filter_map(|track| track.path_over_straight))
    }
}

impl RootTrack {
    fn new(agent: &AgentSpec, born_s: f64) -> Self {
        Self {
            agent: agent.clone(),
            born_s,
            is_gone: false,
            arrival: Arrival::default(),
            velocity_mps: DVec2::ZERO,
            path_m: 0.0,
            path_over_straight: None,
            slow_steps: 0,
            stalled: false,
        }
    }

    /// Notes that the agent was removed; one that begins in a state of the behaviour arrives by that.
    fn leave(&mut self, now_s: f64) {
        self.is_gone = true;
        if self.agent.state != 0 {
            self.arrival.at_s = self.arrival.at_s.or(Some(now_s));
        }
    }

    fn arrive(&mut self, frame: &AgentFrame, behaviour: &Behaviour, now_s: f64) {
        let is_in_final_state = behaviour.is_final(frame.state.into());
        if self.arrival.follow(&self.agent, frame.root.position_m, is_in_final_state, now_s) {
            let straight_m = self.straight_path_m(position_m(frame));
            self.path_over_straight = (straight_m > 0.0).then(|| self.path_m / straight_m);
        }
    }

    /// Length of the straight path from the start through the waypoints to the position of arrival, m.
    fn straight_path_m(&self, arrival_m: DVec2) -> f64 {
        let waypoints_m = self.agent.goals_m.iter().take(self.arrival.progress.next as usize);
        let corners_m = [&self.agent.position_m].into_iter().chain(waypoints_m).map(|&corner_m| DVec2::from(corner_m));
        let corners_m = corners_m.chain([arrival_m]);
        corners_m.clone().skip(1).zip(corners_m).map(|(to, from)| from.distance(to)).sum()
    }

    /// How the agent walks at held facing; none where it walks in the turning set or stands.
    fn sidewards(&self, after: &AgentFrame) -> Option<Sidewards> {
        let walks = self.velocity_mps.length() >= STALL_SPEED_MPS;
        let ahead = self.velocity_mps.dot(DVec2::from(after.root.forward())) >= 0.0;
        match after.set {
            VelocitySet::Holding if walks && ahead => Some(Sidewards::Strafing),
            VelocitySet::Holding if walks => Some(Sidewards::SteppingBack),
            _ => None,
        }
    }

    /// Counts steps in which the agent stands. An agent that does not want to walk does not stall: it has not begun, waits
    /// at a signal, door or one-way zone, or stands behind others that have taken its goal.
    fn watch_for_stall(&mut self, after: &AgentFrame, dt_s: f64) {
        let waits = after.preferred_mps == Vec2::ZERO;
        let slow = self.velocity_mps.length() < STALL_SPEED_MPS && !waits;
        self.slow_steps = if slow { self.slow_steps + 1 } else { 0 };
        // Half a step of tolerance, since dt is not exact in binary.
        self.stalled |= (self.slow_steps as f64 + 0.5) * dt_s >= STALL_S;
    }
}

/// Angle between the displacement of a step and the facing in its middle, degrees.
fn heading_error_deg(displacement_m: DVec2, before: &AgentFrame, after: &AgentFrame) -> f64 {
    let facing = DVec2::from(before.root.forward() + after.root.forward());
    libm::fabs(libm::atan2(facing.perp_dot(displacement_m), facing.dot(displacement_m))).to_degrees()
}

fn position_m(frame: &AgentFrame) -> DVec2 {
    DVec2::from(frame.root.position_m)
}

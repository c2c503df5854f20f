//! How agents get on: acceleration, arrival, stalling, detours, side-steps, tracking (`FbCrowd` App. 11, Eq. 18 with
//! its sum over T steps: printed to N, and with one term too many).
//!
//! Velocities are differences of the synthesised root, whose path is ripple-free. Agents start from rest, so T steps
//! have T accelerations. World, metres, seconds.

use glam::DVec2;

use crate::planning::plan::VelocitySet;
use crate::recording::frame::AgentFrame;
use crate::route::arrival::Arrival;
use crate::scenario::AgentSpec;

/// Slower than this for [`STALL_S`] before arriving is stalling, and no side-step, m/s.
const STALL_SPEED_MPS: f64 = 0.1;
/// How long, s.
const STALL_S: f64 = 5.0;

/// Follows every agent, step by step.
#[derive(Debug)]
pub struct RootMeasures {
    dt_s: f64,
    steps: usize,
    walkers: Vec<Walker>,
    acceleration: Mean,
    acceleration_before_arrival: Mean,
    tracking_error: Mean,
    tracking_worst_m: f64,
    heading_error_deg: Mean,
    walking_heading_error_deg: Mean,
    strafing: Mean,
    stepping_back: Mean,
}

/// A sum on its way to a mean.
#[derive(Clone, Copy, Debug, Default)]
pub struct Mean {
    sum: f64,
    count: usize,
}

#[derive(Debug)]
struct Walker {
    agent: AgentSpec,
    arrival: Arrival,
    velocity_mps: DVec2,
    /// Walked before the arrival, m.
    path_m: f64,
    /// Walked over the straight way from the start over the waypoints to the place of arrival.
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

impl Mean {
    fn add(&mut self, value: f64) {
        self.sum += value;
        self.count += 1;
    }

    /// 0 of nothing.
    pub fn value(self) -> f64 {
        self.sum / self.count.max(1) as f64
    }
}

impl RootMeasures {
    /// At the start.
    pub fn new(agents: &[AgentSpec], start: &[AgentFrame], dt_s: f32) -> Self {
        let mut walkers: Vec<Walker> = agents.iter().map(Walker::new).collect();
        for (walker, frame) in walkers.iter_mut().zip(start) {
            walker.arrive(frame, 0.0);
        }
        Self {
            dt_s: dt_s.into(),
            steps: 0,
            walkers,
            acceleration: Mean::default(),
            acceleration_before_arrival: Mean::default(),
            tracking_error: Mean::default(),
            tracking_worst_m: 0.0,
            heading_error_deg: Mean::default(),
            walking_heading_error_deg: Mean::default(),
            strafing: Mean::default(),
            stepping_back: Mean::default(),
        }
    }

    /// Adds one step, given every agent before and after it.
    pub fn push(&mut self, before: &[AgentFrame], after: &[AgentFrame]) {
        self.steps += 1;
        for (walker, (before, after)) in self.walkers.iter_mut().zip(before.iter().zip(after)) {
            let displacement_m = position_m(after) - position_m(before);
            let velocity_mps = displacement_m / self.dt_s;
            let acceleration_mps2 = (velocity_mps - walker.velocity_mps).length() / self.dt_s;
            walker.velocity_mps = velocity_mps;
            self.acceleration.add(acceleration_mps2); // Eq. 18
            if walker.arrival.at_s.is_none() {
                self.acceleration_before_arrival.add(acceleration_mps2);
                let sidewards = walker.sidewards(after);
                self.strafing.add(f64::from(sidewards == Some(Sidewards::Strafing)));
                self.stepping_back.add(f64::from(sidewards == Some(Sidewards::SteppingBack)));
                if velocity_mps.length() >= STALL_SPEED_MPS {
                    let error_deg = heading_error_deg(displacement_m, before, after);
                    self.walking_heading_error_deg.add(error_deg);
                    if after.set == VelocitySet::Turning {
                        self.heading_error_deg.add(error_deg);
                    }
                }
                walker.path_m += displacement_m.length();
                walker.watch_for_stall(self.dt_s);
            }
            let planned_m = DVec2::from(after.planned_mps) * self.dt_s;
            let tracking_error_m = displacement_m.distance(planned_m);
            self.tracking_error.add(tracking_error_m);
            self.tracking_worst_m = self.tracking_worst_m.max(tracking_error_m);
            walker.arrive(after, self.steps as f64 * self.dt_s);
        }
    }

    /// Over all agents and steps, m/s².
    pub fn mean_acceleration_mps2(&self) -> f64 {
        self.acceleration.value()
    }

    /// Over the steps before each agent's arrival, m/s².
    pub fn mean_acceleration_before_arrival_mps2(&self) -> f64 {
        self.acceleration_before_arrival.value()
    }

    /// Mean distance between the synthesised root and where the planned velocity would have brought it, m.
    pub fn root_tracking_error_m(&self) -> f64 {
        self.tracking_error.value()
    }

    /// The greatest such distance, m.
    pub fn root_tracking_worst_m(&self) -> f64 {
        self.tracking_worst_m
    }

    /// Mean angle between facing and travel over the steps before each agent's arrival in which it walks and is not to
    /// side-step or step back, degrees.
    pub fn heading_error_deg(&self) -> f64 {
        self.heading_error_deg.value()
    }

    /// The same over all steps in which it walks, side-steps and steps back too.
    pub fn walking_heading_error_deg(&self) -> f64 {
        self.walking_heading_error_deg.value()
    }

    /// Whether every agent, its waypoints passed, is within 0.5 m of its last goal now.
    pub fn all_are_at_goals(&self) -> bool {
        self.walkers.iter().all(|walker| walker.arrival.is_at_goal)
    }

    /// Whether an agent has come to its last goal so far.
    pub fn has_arrived(&self, agent: usize) -> bool {
        self.walkers[agent].arrival.at_s.is_some()
    }

    /// Agents that came within 0.5 m of their last goal at any time after their waypoints.
    pub fn arrived(&self) -> usize {
        self.walkers.iter().filter(|walker| walker.arrival.at_s.is_some()).count()
    }

    /// Agents that stayed under 0.1 m/s for 5 s before arriving.
    pub fn stalled(&self) -> usize {
        self.walkers.iter().filter(|walker| walker.stalled).count()
    }

    /// Over the agents that arrived; none where nobody did.
    pub fn mean_time_to_goal_s(&self) -> Option<f64> {
        mean(self.walkers.iter().filter_map(|walker| walker.arrival.at_s))
    }

    /// Mean over the agents that arrived of the length of their paths until then over that of the straight way; none
    /// where nobody arrived, or nobody had a way to go.
    pub fn path_over_straight_line(&self) -> Option<f64> {
        mean(self.walkers.iter().filter_map(|walker| walker.path_over_straight))
    }

    /// Share of the steps before each agent's arrival in which it walks sidewards at held facing.
    pub fn strafing_share(&self) -> f64 {
        self.strafing.value()
    }

    /// Share of the steps before each agent's arrival in which it walks backward at held facing.
    pub fn stepping_back_share(&self) -> f64 {
        self.stepping_back.value()
    }
}

/// None of nothing.
fn mean(values: impl Iterator<Item = f64>) -> Option<f64> {
    let mut mean = Mean::default();
    values.for_each(|value| mean.add(value));
    (mean.count > 0).then(|| mean.value())
}

impl Walker {
    fn new(agent: &AgentSpec) -> Self {
        Self {
            agent: agent.clone(),
            arrival: Arrival::default(),
            velocity_mps: DVec2::ZERO,
            path_m: 0.0,
            path_over_straight: None,
            slow_steps: 0,
            stalled: false,
        }
    }

    fn arrive(&mut self, frame: &AgentFrame, now_s: f64) {
        if self.arrival.follow(&self.agent, frame.root.position_m, now_s) {
            let straight_m = self.straight_way_m(position_m(frame));
            self.path_over_straight = (straight_m > 0.0).then(|| self.path_m / straight_m);
        }
    }

    /// From the start over the waypoints to a place near the last.
    fn straight_way_m(&self, arrival_m: DVec2) -> f64 {
        let waypoints_m = self.agent.goals_m.iter().take(self.arrival.progress.next as usize);
        let corners_m = [&self.agent.position_m].into_iter().chain(waypoints_m).map(|&corner_m| DVec2::from(corner_m));
        let corners_m = corners_m.chain([arrival_m]);
        corners_m.clone().skip(1).zip(corners_m).map(|(to, from)| from.distance(to)).sum()
    }

    /// How the agent walks, unless it follows its facing or stands.
    fn sidewards(&self, after: &AgentFrame) -> Option<Sidewards> {
        let walks = self.velocity_mps.length() >= STALL_SPEED_MPS;
        let ahead = self.velocity_mps.dot(DVec2::from(after.root.forward())) >= 0.0;
        match after.set {
            VelocitySet::Holding if walks && ahead => Some(Sidewards::Strafing),
            VelocitySet::Holding if walks => Some(Sidewards::SteppingBack),
            _ => None,
        }
    }

    fn watch_for_stall(&mut self, dt_s: f64) {
        let slow = self.velocity_mps.length() < STALL_SPEED_MPS;
        self.slow_steps = if slow { self.slow_steps + 1 } else { 0 };
        // Half a step of tolerance, since dt is not exact in binary.
        self.stalled |= (self.slow_steps as f64 + 0.5) * dt_s >= STALL_S;
    }
}

/// Angle between the way of a step and the facing in its middle.
fn heading_error_deg(displacement_m: DVec2, before: &AgentFrame, after: &AgentFrame) -> f64 {
    let facing = DVec2::from(before.root.forward() + after.root.forward());
    libm::fabs(libm::atan2(facing.perp_dot(displacement_m), facing.dot(displacement_m))).to_degrees()
}

fn position_m(frame: &AgentFrame) -> DVec2 {
    DVec2::from(frame.root.position_m)
}

//! Any step of a recording as the planner saw it: a recording is complete enough to plan each step again.
//!
//! Step k leads from frame k to frame k + 1. Positions, facings, strafing times and the stance foot are frame k's,
//! velocities those that led to it; v_pref and the direction of the route, which the step itself computes, are in
//! frame k + 1. Everything but the stance foot is kept bit for bit. The stance foot comes from a packed pose and time to
//! landing, so where it decides, their rounding does too (a tenth of a millimetre at the sole, some mm/s of the plan).
//! The velocity to which a body is committed on the paper's transition between syntheses
//! (`transition = "through_m_mb"`) is not recorded; the actual velocity stands in for it. World axes, metres, seconds,
//! radians.

use std::sync::Arc;

use glam::Vec2;
use motiondb::velocity_sets::velocity_hull::VelocityHull;

use crate::planning::mcn::motion_constraints::MotionConstraints;
use crate::planning::plan::Stance;
use crate::planning::planner::ranking_horizon_s;
use crate::planning::world_view::{OwnConstraints, OwnWalls, WorldView};
use crate::population::AgentId;
use crate::recording::error::RecordingError;
use crate::recording::frame::AgentFrame;
use crate::recording::header::Header;
use crate::recording::reader::Recording;
use crate::scenario::places::state_zones::StateZones;
use crate::scenario::{AgentSpec, Scenario};
use crate::synthesis::Stature;
use crate::world::neighbours::NeighbourSearch;
use crate::world::obstacles::{Obstacles, ZoneWalls};
use crate::world::one_way::OneWayZone;

/// A recording whose steps are planned again.
#[derive(Debug)]
pub struct Replay<'a> {
    recording: &'a Recording,
    /// The walls with all doors open.
    obstacles: Arc<Walls>,
    state_zones: StateZones,
    one_way: Vec<OneWayZone>,
    /// The constraints of each database.
    constraints: Vec<MotionConstraints>,
}

/// The walls of a step.
#[derive(Debug)]
struct Walls {
    obstacles: Obstacles,
    /// The walls of agents that do not enter some zones.
    zone_walls: ZoneWalls,
}

/// One recorded step, with everything that its planner read: the agents that are present before and after it. Slices
/// are by index among them.
#[derive(Debug)]
pub struct RecordedStep<'a> {
    replay: &'a Replay<'a>,
    /// Index of the frame in which the step begins.
    pub frame: usize,
    /// Every agent of the step at its beginning.
    pub before: Vec<AgentFrame>,
    /// The same agents at its end.
    pub after: Vec<AgentFrame>,
    radii_m: Vec<f32>,
    wall_radii_m: Vec<f32>,
    positions_m: Vec<Vec2>,
    velocities_mps: Vec<Vec2>,
    facings_rad: Vec<f32>,
    preferred_mps: Vec<Vec2>,
    free_speeds_mps: Vec<f32>,
    facing_offsets_rad: Vec<f32>,
    stances: Vec<Stance>,
    planned_mps: Vec<Vec2>,
    strafing_s: Vec<f32>,
    stepping_back_s: Vec<f32>,
    neighbours: NeighbourSearch,
    closed_zones: Vec<u32>,
    /// The database by which each body moves.
    databases: Vec<u32>,
    priorities: Option<Vec<f32>>,
    speed_factors: Vec<f32>,
    walls: Arc<Walls>,
}

impl Walls {
    fn new(scenario: &Scenario, closed: &[bool]) -> Self {
        Self { obstacles: scenario.walls_with(closed), zone_walls: scenario.zone_walls(closed) }
    }
}

impl<'a> Replay<'a> {
    /// Prepares what all steps share.
    pub fn new(recording: &'a Recording) -> Self {
        let scenario = &recording.header().scenario;
        let databases = recording.header().databases.iter();
        let constraints = databases.map(|database| MotionConstraints::new(&database.velocity_hull));
        Self {
            recording,
            constraints: constraints.collect(),
            obstacles: Arc::new(Walls::new(scenario, &[])),
            state_zones: StateZones::new(scenario),
            one_way: scenario.one_way_zones(),
        }
    }

    /// What holds for all frames.
    pub fn header(&self) -> &Header {
        self.recording.header()
    }

    /// Number of recorded steps.
    pub fn step_count(&self) -> usize {
        self.recording.frame_count().saturating_sub(1)
    }

    /// The step that begins in a frame.
    ///
    /// # Errors
    /// If a frame of it is missing or damaged.
    pub fn step(&'a self, frame: usize) -> Result<RecordedStep<'a>, RecordingError> {
        let read = |index: usize| {
            let mut agents = Vec::new();
            self.recording.read_frame(index, &mut agents).map(|()| agents)
        };
        let (earlier, mut before, mut after) = (read(frame.saturating_sub(1))?, read(frame)?, read(frame + 1)?);
        // Agents that are removed leave before the step is planned, those that are born come after it.
        keep_common(&mut before, &after);
        keep_common(&mut after, &before);
        let (population, number) = (self.recording.population(), frame as u32);
        let life = |agent: &AgentFrame| &population.agents[agent.id.index()];
        let radii_m: Vec<f32> = before.iter().map(|agent| life(agent).radius_m(number + 1)).collect();
        let positions_m: Vec<Vec2> = before.iter().map(|agent| agent.root.position_m).collect();
        let velocities_mps = self.velocities_mps(&earlier, &before, number);
        let mut neighbours = NeighbourSearch::default();
        let Scenario { planner, params, .. } = &self.header().scenario;
        neighbours.rebuild(&positions_m, &velocities_mps, &radii_m, ranking_horizon_s(*planner, params));
        let scenario = &self.header().scenario;
        // The agents were planned in the states that the step recorded.
        let priority =
            |agent: &AgentFrame| scenario.behaviour.priority(usize::from(agent.state), life(agent).spec.priority);
        let priorities = scenario.has_priorities().then(|| after.iter().map(priority).collect());
        let speed_factor = |agent: &AgentFrame| Stature::new(life(agent).stature).speed_factor();
        let is_teleported = |agent: &AgentFrame| life(agent).is_teleported(number);
        let planned_mps = |agent: &AgentFrame| if is_teleported(agent) { Vec2::ZERO } else { agent.planned_mps };
        let closed_zones = |(before, after): (&AgentFrame, &AgentFrame)| {
            let (own, radius_m) = (life(before).spec.closed_zones, life(before).wall_radius_m(number + 1));
            self.state_zones.for_walls(own, usize::from(after.state), before.root.position_m, radius_m)
        };
        Ok(RecordedStep {
            replay: self,
            frame,
            radii_m,
            wall_radii_m: before.iter().map(|agent| life(agent).wall_radius_m(number + 1)).collect(),
            positions_m,
            velocities_mps,
            facings_rad: before.iter().map(|agent| agent.root.facing_rad).collect(),
            preferred_mps: after.iter().map(|agent| agent.preferred_mps).collect(),
            free_speeds_mps: before.iter().map(|agent| life(agent).spec.preferred_speed_mps).collect(),
            facing_offsets_rad: after.iter().map(|agent| agent.facing_offset_rad).collect(),
            stances: before.iter().map(|agent| self.stance(agent, life(agent).stature)).collect(),
            planned_mps: before.iter().map(planned_mps).collect(),
            strafing_s: before.iter().map(|agent| agent.strafing_s).collect(),
            stepping_back_s: before.iter().map(|agent| agent.stepping_back_s).collect(),
            neighbours,
            closed_zones: before.iter().zip(&after).map(closed_zones).collect(),
            databases: before.iter().map(|agent| life(agent).database).collect(),
            priorities,
            speed_factors: before.iter().map(speed_factor).collect(),
            walls: self.walls(number + 1),
            before,
            after,
        })
    }

    /// The walls of the step that leads to a frame.
    fn walls(&self, frame: u32) -> Arc<Walls> {
        let closed = self.recording.population().closed_doors(frame);
        match closed.contains(&true) {
            true => Arc::new(Walls::new(&self.header().scenario, &closed)),
            false => self.obstacles.clone(),
        }
    }

    /// Velocities between two frames, as `coupling::body_to_disc` computes them, m/s; all agents start at rest, also
    /// where a state has moved them at once.
    fn velocities_mps(&self, from: &[AgentFrame], to: &[AgentFrame], number: u32) -> Vec<Vec2> {
        let (dt_s, agents) = (self.header().scenario.dt_s, &self.recording.population().agents);
        let before = |to: &AgentFrame| of_id(from, to.id).filter(|_| !agents[to.id.index()].is_teleported(number));
        let moved_m = |to: &AgentFrame| to.root.position_m - before(to).copied().unwrap_or(*to).root.position_m;
        to.iter().map(|to| moved_m(to) / dt_s).collect()
    }

    fn stance(&self, agent: &AgentFrame, stature: f32) -> Stance {
        let skeleton = self.header().skeleton();
        let joints = agent.pose.forward_kinematics(skeleton);
        let soles_m = [0, 1].map(|side| joints.sole_points_m(skeleton, side).map(|point_m| stature * point_m));
        Stance::on_soles(&soles_m, agent.root.forward(), agent.contacts, |_| agent.time_to_landing_s)
    }
}

impl RecordedStep<'_> {
    /// What holds for all frames.
    pub fn header(&self) -> &Header {
        self.replay.header()
    }

    /// The velocity sets of an agent's database, by index.
    pub fn velocity_hull(&self, agent: usize) -> &VelocityHull {
        &self.header().databases[self.databases[agent] as usize].velocity_hull
    }

    /// Index of an agent among those of the step; none of one that is not present before and after it.
    pub fn index_of(&self, id: AgentId) -> Option<usize> {
        self.before.binary_search_by_key(&id, |agent| agent.id).ok()
    }

    /// The start of an agent, by index.
    pub fn spec(&self, agent: usize) -> &AgentSpec {
        self.replay.recording.population().spec(self.before[agent].id)
    }

    /// Velocities of an agent's body, by index, divided by those of a body of the skeleton's size.
    pub fn speed_factor(&self, agent: usize) -> f32 {
        self.world().speed_factor(agent)
    }

    /// The view that the planner read.
    pub fn world(&self) -> WorldView<'_> {
        let Scenario { coupling, dt_s, .. } = self.header().scenario;
        WorldView {
            positions_m: &self.positions_m,
            velocities_mps: &self.velocities_mps,
            facings_rad: &self.facings_rad,
            radii_m: &self.radii_m,
            wall_radii_m: &self.wall_radii_m,
            preferred_mps: &self.preferred_mps,
            free_speeds_mps: &self.free_speeds_mps,
            facing_offsets_rad: &self.facing_offsets_rad,
            stances: &self.stances,
            planned_mps: &self.planned_mps,
            strafing_s: &self.strafing_s,
            stepping_back_s: &self.stepping_back_s,
            neighbours: &self.neighbours,
            obstacles: &self.walls.obstacles,
            own_walls: (!self.walls.zone_walls.sets.is_empty())
                .then_some(OwnWalls { closed_zones: &self.closed_zones, zone_walls: &self.walls.zone_walls }),
            one_way: &self.replay.one_way,
            priorities: self.priorities.as_deref(),
            constraints: &self.replay.constraints[0],
            own_constraints: (self.replay.constraints.len() > 1)
                .then_some(OwnConstraints { styles: &self.databases, constraints: &self.replay.constraints }),
            speed_factors: Some(&self.speed_factors),
            dt_s,
            bodies: coupling.plans_for_bodies(),
        }
    }

    /// Actual velocity of an agent in the step, m/s.
    pub fn actual_mps(&self, agent: usize) -> Vec2 {
        let moved_m = self.after[agent].root.position_m - self.before[agent].root.position_m;
        moved_m / self.header().scenario.dt_s
    }
}

/// Keeps the agents that are in both frames.
fn keep_common(agents: &mut Vec<AgentFrame>, others: &[AgentFrame]) {
    agents.retain(|agent| of_id(others, agent.id).is_some());
}

/// The agent with an id in a frame.
fn of_id(agents: &[AgentFrame], id: AgentId) -> Option<&AgentFrame> {
    Some(&agents[agents.binary_search_by_key(&id, |agent| agent.id).ok()?])
}

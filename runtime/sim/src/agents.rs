//! The state of all agents, in index order. What planners read of other agents is a structure of arrays; bodies, plans
//! and frames, which only the synthesis of their own agent reads or changes, are arrays of structures.
//!
//! What planners read changes only after all have planned: the stance foot during synthesis, all else in
//! `coupling::body_to_disc`.
//!
//! World frame; metres, seconds, radians.

use glam::Vec2;
use motiondb::body::Root;

use crate::maths::random::SplitMix64;
use crate::planning::plan::{Plan, Stance};
use crate::recording::frame::AgentFrame;
use crate::route::crowd_routes::RouteMemory;
use crate::route::path::PathProgress;
use crate::scenario::Scenario;
use crate::scenario::coupling::Coupling;
use crate::synthesis::{Body, SynthesisContext};

/// First random stream of the starting phases; the scenario uses those below.
const START_PHASE_STREAM: u64 = 1 << 32;

/// All agents; all arrays have the same length.
#[derive(Clone, Debug, Default)]
pub struct Agents {
    /// Centre of the disc: position of the synthesised root, m.
    pub positions_m: Vec<Vec2>,
    /// Velocity of the root in the last step, or the velocity to which the body is committed, m/s.
    pub velocities_mps: Vec<Vec2>,
    /// Facing of the synthesised root, rad.
    pub facings_rad: Vec<f32>,
    /// Radius of the disc that other agents see, m.
    pub radii_m: Vec<f32>,
    /// Radius of the disc that walls hold, m.
    pub wall_radii_m: Vec<f32>,
    /// How far each has got on its way.
    pub progress: Vec<PathProgress>,
    /// What each remembers of its route around walls.
    pub route_memory: Vec<RouteMemory>,
    /// v_pref, m/s.
    pub preferred_mps: Vec<Vec2>,
    /// Plan for the step.
    pub plans: Vec<Plan>,
    /// Contiguous time of strafing after the last plan, s.
    pub strafing_s: Vec<f32>,
    /// Contiguous time of stepping back after the last plan, s.
    pub stepping_back_s: Vec<f32>,
    /// The simulated body.
    pub bodies: Vec<Body>,
    /// Stance that planners read.
    pub stances: Vec<Stance>,
    /// Recorded frame, which holds the pose.
    pub frames: Vec<AgentFrame>,
}

impl Agents {
    /// Agents that stand at the start positions of a scenario, each at another phase of its cycle, so that a crowd does
    /// not march in step.
    pub fn new(scenario: &Scenario, context: &SynthesisContext) -> Self {
        let count = scenario.agents.len();
        let mut agents = Self {
            positions_m: scenario.agents.iter().map(|agent| agent.position_m).collect(),
            velocities_mps: vec![Vec2::ZERO; count],
            facings_rad: scenario.agents.iter().map(|agent| agent.facing_rad).collect(),
            radii_m: scenario.agents.iter().map(|agent| agent.radius_m).collect(),
            wall_radii_m: scenario.agents.iter().map(|agent| agent.wall_radius_m).collect(),
            progress: vec![PathProgress::default(); count],
            route_memory: vec![RouteMemory::default(); count],
            preferred_mps: vec![Vec2::ZERO; count],
            plans: vec![Plan::default(); count],
            strafing_s: vec![0.0; count],
            stepping_back_s: vec![0.0; count],
            frames: vec![AgentFrame::default(); count],
            ..Self::default()
        };
        for (index, agent) in scenario.agents.iter().enumerate() {
            let root = Root { position_m: agent.position_m, facing_rad: agent.facing_rad };
            let (body, mut output) = Body::standing(context, root, start_phase(scenario.seed, index as u64));
            if scenario.coupling == Coupling::Discs {
                output.contacts = [0.0; 2];
            }
            agents.bodies.push(body);
            agents.stances.push(output.stance);
            agents.frames[index].show(&output);
        }
        agents
    }

    /// Memory of all arrays, bytes; their elements hold no pointers.
    pub fn size_bytes(&self) -> usize {
        let Self { positions_m, velocities_mps, facings_rad, radii_m, progress, preferred_mps, plans, .. } = self;
        let Self { route_memory, wall_radii_m, strafing_s, stepping_back_s, bodies, stances, frames, .. } = self;
        let of_planning = size_of_val(&**positions_m)
            + size_of_val(&**velocities_mps)
            + size_of_val(&**facings_rad)
            + size_of_val(&**radii_m)
            + size_of_val(&**wall_radii_m)
            + size_of_val(&**progress)
            + size_of_val(&**route_memory)
            + size_of_val(&**preferred_mps)
            + size_of_val(&**plans)
            + size_of_val(&**strafing_s)
            + size_of_val(&**stepping_back_s)
            + size_of_val(&**stances);
        of_planning + size_of_val(&**bodies) + size_of_val(&**frames)
    }
}

/// A phase in [0, 1) from 24 random bits, the mantissa of an f32.
fn start_phase(seed: u64, agent: u64) -> f32 {
    (SplitMix64::new(seed, START_PHASE_STREAM + agent).next_u64() >> 40) as f32 / (1 << 24) as f32
}

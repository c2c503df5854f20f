//! The state of all agents, in index order: what a planner reads of others is a structure of arrays; bodies, plans and
//! frames, which nobody but their own agent's synthesis touches, are arrays of structures.
//!
//! World axes, metres, seconds, radians. What the planner reads of the bodies changes only after all have planned:
//! the stance foot as they are synthesised, all else in `coupling::body_to_disc`.

use glam::Vec2;
use motiondb::body::Root;

use crate::maths::random::SplitMix64;
use crate::planning::plan::{Plan, Stance};
use crate::recording::frame::AgentFrame;
use crate::route::path::PathProgress;
use crate::scenario::Scenario;
use crate::scenario::coupling::Coupling;
use crate::synthesis::{Body, Motion};

/// Streams from here on draw the starting phases; those below are the scenario's.
const START_PHASE_STREAM: u64 = 1 << 32;

/// Every agent; all arrays are of the same length.
#[derive(Clone, Debug, Default)]
pub struct Agents {
    /// Centres of the discs: the synthesised roots, m.
    pub positions_m: Vec<Vec2>,
    /// Of the synthesised roots over the last step, or what a body is committed to, m/s.
    pub velocities_mps: Vec<Vec2>,
    /// Of the synthesised roots, rad.
    pub facings_rad: Vec<f32>,
    /// Radii of the discs, m.
    pub radii_m: Vec<f32>,
    /// How far each has got on its way.
    pub progress: Vec<PathProgress>,
    /// v_pref, m/s.
    pub preferred_mps: Vec<Vec2>,
    /// What was planned for the step.
    pub plans: Vec<Plan>,
    /// Contiguous strafing time after the last plan, s.
    pub strafing_s: Vec<f32>,
    /// Contiguous time stepping back after the last plan, s.
    pub stepping_back_s: Vec<f32>,
    /// Synthesis, from step to step.
    pub bodies: Vec<Body>,
    /// The stance foot that the planner sees.
    pub stances: Vec<Stance>,
    /// What is recorded; it holds the poses.
    pub frames: Vec<AgentFrame>,
}

impl Agents {
    /// Standing where the scenario puts them. Each starts at another phase of its cycle, so that no crowd marches in
    /// step.
    pub fn new(scenario: &Scenario, motion: &Motion) -> Self {
        let count = scenario.agents.len();
        let mut agents = Self {
            positions_m: scenario.agents.iter().map(|agent| agent.position_m).collect(),
            velocities_mps: vec![Vec2::ZERO; count],
            facings_rad: scenario.agents.iter().map(|agent| agent.facing_rad).collect(),
            radii_m: scenario.agents.iter().map(|agent| agent.radius_m).collect(),
            progress: vec![PathProgress::default(); count],
            preferred_mps: vec![Vec2::ZERO; count],
            plans: vec![Plan::default(); count],
            strafing_s: vec![0.0; count],
            stepping_back_s: vec![0.0; count],
            frames: vec![AgentFrame::default(); count],
            ..Self::default()
        };
        for (index, agent) in scenario.agents.iter().enumerate() {
            let root = Root { position_m: agent.position_m, facing_rad: agent.facing_rad };
            let (body, mut synthesis) = Body::standing(motion, root, start_phase(scenario.seed, index as u64));
            if scenario.coupling == Coupling::Discs {
                synthesis.contacts = [0.0; 2];
            }
            agents.bodies.push(body);
            agents.stances.push(synthesis.stance);
            agents.frames[index].show(&synthesis);
        }
        agents
    }

    /// What all arrays take together, bytes; nothing in them points to more.
    pub fn size_bytes(&self) -> usize {
        let Self { positions_m, velocities_mps, facings_rad, radii_m, progress, preferred_mps, plans, .. } = self;
        let Self { strafing_s, stepping_back_s, bodies, stances, frames, .. } = self;
        let of_planning = size_of_val(&**positions_m)
            + size_of_val(&**velocities_mps)
            + size_of_val(&**facings_rad)
            + size_of_val(&**radii_m)
            + size_of_val(&**progress)
            + size_of_val(&**preferred_mps)
            + size_of_val(&**plans)
            + size_of_val(&**strafing_s)
            + size_of_val(&**stepping_back_s)
            + size_of_val(&**stances);
        of_planning + size_of_val(&**bodies) + size_of_val(&**frames)
    }
}

/// A phase in [0, 1), from 24 random bits, all that an f32 holds.
fn start_phase(seed: u64, agent: u64) -> f32 {
    (SplitMix64::new(seed, START_PHASE_STREAM + agent).next_u64() >> 40) as f32 / (1 << 24) as f32
}

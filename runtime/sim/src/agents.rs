//! The state of all present agents, in the order of their ids. What planners read of other agents is a structure of arrays; bodies, plans
//! and frames, which only the synthesis of their own agent reads or changes, are arrays of structures.
//!
//! What planners read changes only after all have planned: the stance foot during synthesis, all else in
//! `coupling::body_to_disc`. Agents come and go between steps only: a new one has the greatest id, so it is appended, and
//! where agents are removed, the others close up.
//!
//! World frame; metres, seconds, radians.

use glam::Vec2;
use motiondb::body::Root;

use crate::maths::random::SplitMix64;
use crate::planning::plan::{Plan, Stance};
use crate::population::AgentId;
use crate::recording::frame::AgentFrame;
use crate::route::crowd_routes::RouteMemory;
use crate::route::path::PathProgress;
use crate::scenario::coupling::Coupling;
use crate::scenario::{AgentSpec, Scenario};
use crate::synthesis::{Body, BodyOutput, ExtraState, Stature, SynthesisContext, Traits};

/// First random stream of the starting phases; the scenario uses those below.
const START_PHASE_STREAM: u64 = 1 << 32;

/// When an agent is removed.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Removal {
    /// Before the next step.
    AtOnce,
    /// Between two steps of its feet: as soon as both feet are planted or a foot has just landed. A body of
    /// `coupling = "discs"` plants no foot; it is removed before the next step.
    BetweenSteps,
}

/// All present agents; all arrays have the same length.
#[derive(Clone, Debug, Default)]
pub struct Agents {
    /// Ids, rising.
    pub ids: Vec<AgentId>,
    /// When the agent is to be removed; none of an agent that stays.
    pub removals: Vec<Option<Removal>>,
    /// Whether the body is between two steps of its feet.
    pub are_between_steps: Vec<bool>,
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
    /// Zones that the agent does not enter, by bits.
    pub closed_zones: Vec<u32>,
    /// Right of way in the present state.
    pub priorities: Vec<f32>,
    /// Speed that the agent prefers on a free path, as in [`AgentSpec`], m/s.
    pub free_speeds_mps: Vec<f32>,
    /// Style of the body's motion, as in [`AgentSpec`]: index of its synthesis context.
    pub styles: Vec<u32>,
    /// How far each has got on its way.
    pub progress: Vec<PathProgress>,
    /// What each remembers of its route around walls.
    pub route_memory: Vec<RouteMemory>,
    /// v_pref, m/s.
    pub preferred_mps: Vec<Vec2>,
    /// Angle from v_pref to the direction of the route, which the agent faces, rounded as it is recorded, rad.
    pub facing_offsets_rad: Vec<f32>,
    /// Plan for the step.
    pub plans: Vec<Plan>,
    /// Velocity of the last plan, m/s.
    pub planned_mps: Vec<Vec2>,
    /// Contiguous time of strafing after the last plan, s.
    pub strafing_s: Vec<f32>,
    /// Contiguous time of stepping back after the last plan, s.
    pub stepping_back_s: Vec<f32>,
    /// Velocities of the body, divided by those of a body of the skeleton's size.
    pub speed_factors: Vec<f32>,
    /// Size of the body.
    pub statures: Vec<Stature>,
    /// The simulated body, in the world of its own size.
    pub bodies: Vec<Body>,
    /// Joints of the body beside the 22 roles.
    pub extras: Vec<ExtraState>,
    /// Stance that planners read.
    pub stances: Vec<Stance>,
    /// Recorded frame, which holds the pose.
    pub frames: Vec<AgentFrame>,
}

/// Calls a macro with every array of [`Agents`], so that none is forgotten where agents come and go.
macro_rules! for_each_array {
    ($each:ident) => {
        $each!(
            ids,
            removals,
            are_between_steps,
            positions_m,
            velocities_mps,
            facings_rad,
            radii_m,
            wall_radii_m,
            closed_zones,
            priorities,
            free_speeds_mps,
            styles,
            progress,
            route_memory,
            preferred_mps,
            facing_offsets_rad,
            plans,
            planned_mps,
            strafing_s,
            stepping_back_s,
            speed_factors,
            statures,
            bodies,
            extras,
            stances,
            frames
        )
    };
}

impl Agents {
    /// Number of present agents.
    pub fn count(&self) -> usize {
        self.ids.len()
    }

    /// Appends an agent that stands at its start, with its cycle at a phase of its own, so that a crowd does not march
    /// in step. Its id must be greater than all others.
    pub fn push(
        &mut self,
        id: AgentId,
        spec: &AgentSpec,
        stature: f32,
        scenario: &Scenario,
        context: &SynthesisContext,
    ) {
        let root = Root { position_m: spec.position_m, facing_rad: spec.facing_rad };
        let stature = Stature::new(stature);
        let (body, output) = standing(id, root, stature, scenario, context);
        let mut frame = AgentFrame { id, ..AgentFrame::default() };
        frame.show(&output);
        self.ids.push(id);
        self.removals.push(None);
        self.are_between_steps.push(true);
        // Rounded as it is recorded: taken to the body's world and back.
        self.positions_m.push(stature.root_of_crowd(body.root).position_m);
        self.velocities_mps.push(Vec2::ZERO);
        self.facings_rad.push(spec.facing_rad);
        self.radii_m.push(spec.radius_m);
        self.wall_radii_m.push(spec.wall_radius_m);
        self.closed_zones.push(spec.closed_zones);
        self.priorities.push(spec.priority);
        self.free_speeds_mps.push(spec.preferred_speed_mps);
        self.styles.push(spec.style);
        self.progress.push(PathProgress::default());
        self.route_memory.push(RouteMemory::default());
        self.preferred_mps.push(Vec2::ZERO);
        self.facing_offsets_rad.push(0.0);
        self.plans.push(Plan::default());
        self.planned_mps.push(Vec2::ZERO);
        self.strafing_s.push(0.0);
        self.stepping_back_s.push(0.0);
        self.speed_factors.push(stature.speed_factor());
        self.statures.push(stature);
        self.extras.push(body.extra(context));
        self.bodies.push(body);
        self.stances.push(output.stance);
        self.frames.push(frame);
    }

    /// Lets an agent stand at another position, with a body that has not moved yet.
    pub(crate) fn stand_at(&mut self, index: usize, position_m: Vec2, scenario: &Scenario, context: &SynthesisContext) {
        let root = Root { position_m, facing_rad: self.facings_rad[index] };
        let (body, output) = standing(self.ids[index], root, self.statures[index], scenario, context);
        self.frames[index].show(&output);
        self.are_between_steps[index] = true;
        self.positions_m[index] = self.statures[index].root_of_crowd(body.root).position_m;
        self.velocities_mps[index] = Vec2::ZERO;
        self.planned_mps[index] = Vec2::ZERO;
        self.progress[index].standing = None;
        self.extras[index] = body.extra(context);
        self.bodies[index] = body;
        self.stances[index] = output.stance;
    }

    /// Keeps the agents that `keeps` marks, by index.
    pub fn retain(&mut self, keeps: &[bool]) {
        macro_rules! retain {
            ($($array:ident),*) => { $(retain_marked(&mut self.$array, keeps);)* };
        }
        for_each_array!(retain);
    }

    /// Memory of all arrays, bytes; only the extra joints hold pointers.
    pub fn size_bytes(&self) -> usize {
        macro_rules! size {
            ($($array:ident),*) => { [$(size_of_val(&*self.$array)),*] };
        }
        for_each_array!(size).iter().sum::<usize>() + self.extras.iter().map(ExtraState::size_bytes).sum::<usize>()
    }
}

/// Keeps the values that `keeps` marks, by index.
fn retain_marked<T>(values: &mut Vec<T>, keeps: &[bool]) {
    let mut keeps = keeps.iter();
    values.retain(|_| keeps.next().copied().unwrap_or(true));
}

/// The body of an agent that stands at a root, with the agent's phase and traits, and its first output.
fn standing(
    id: AgentId,
    root: Root,
    stature: Stature,
    scenario: &Scenario,
    context: &SynthesisContext,
) -> (Body, BodyOutput) {
    let Scenario { seed, coupling, variation, .. } = *scenario;
    // Bodies of the baseline follow their discs as in the clips.
    let variation = variation.filter(|_| coupling == Coupling::TwoWay);
    let traits = variation.map_or_else(Traits::default, |variation| variation.traits(seed, id.0));
    let root = stature.root_of_body(root);
    let (body, mut output) = Body::standing_with(context, root, start_phase(seed, id), traits);
    if coupling == Coupling::Discs {
        output.contacts = [0.0; 2];
    }
    (body, stature.output_of_crowd(&output))
}

/// A phase in [0, 1) from 24 random bits, the mantissa of an f32.
fn start_phase(seed: u64, id: AgentId) -> f32 {
    (SplitMix64::new(seed, START_PHASE_STREAM + u64::from(id.0)).next_u64() >> 40) as f32 / (1 << 24) as f32
}

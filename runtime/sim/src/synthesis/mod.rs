//! Human motion synthesis (`FbCrowd` §5): a plan becomes the next pose, and the next root, of a body.
//!
//! One step of a body has two halves, with the walls between them. `advance`: the body follows its plan.
//!
//! 1. `command`: the plan as (v_f, ω_t, ω_s), smoothed; what of it the body can do,
//!    standing or stepping; and how far it gets in one step;
//! 2. `blending` or `semi_procedural`: what is played follows (`weight_transition`); phase (`phase_catch_up`) and root move, the
//!    root exactly along its arc; the pose eases into both, and the gait turns back with the body (`pose_smoothing`); `mode`
//!    tells which synthesis is wanted, and at the next pair of `switch_points` it changes hands (`switching`).
//!
//! `synthesize`: the pose there.
//!
//! 3. It is sampled (`active_motion`; in long strides heels rise, `heel_rise`, and hips come down to each `landing`);
//!    `inertialization` carries away what a switch left; head and chest turn first (`look_at`);
//! 4. `foot_lock`: planted feet are held;
//! 5. `posture`, `pelvis`, `ik`: the pelvis comes down where a leg would not reach its foot, and the legs reach
//!    them.
//!
//! The root frame has x forward, y left, z up, its origin on the ground under the ripple-free root; metres,
//! seconds, radians.

pub(crate) mod advance;
pub mod blending;
pub mod command;
pub mod hybrid;
pub mod library;
pub(crate) mod params;
pub mod pose;
pub mod semi_procedural;
pub(crate) mod synthesize;
#[cfg(test)]
pub(crate) mod tests;
pub(crate) mod time_step;

pub use params::{HmsParams, Modes, Transition};
pub use time_step::TimeStep;

use glam::Vec2;
use motiondb::body::{Pose, Root};
use motiondb::motion::{MotionDb, Parameters};

use crate::planning::plan::Stance;
use crate::synthesis::blending::blend_space::Space;
use crate::synthesis::blending::mix::Mix;
use crate::synthesis::command::command_filter::Intention;
use crate::synthesis::command::displacement_accumulator::Owed;
use crate::synthesis::command::phase_catch_up::Hurry;
use crate::synthesis::command::stand_or_step::Gait;
use crate::synthesis::hybrid::inertialization::Inertia;
use crate::synthesis::hybrid::mode::{Choice, Mode};
use crate::synthesis::hybrid::pose_smoothing::Seen;
use crate::synthesis::hybrid::switch_points::Hybrid;
use crate::synthesis::pose::foot_lock::FootHold;
use crate::synthesis::pose::look_at::Gaze;
use crate::synthesis::pose::pelvis::Descent;

/// A database, ready for synthesis.
#[derive(Clone, Copy, Debug)]
pub struct Motion<'a> {
    /// Poses, parameters and phase maps.
    pub db: &'a MotionDb,
    /// Its blend space.
    pub space: &'a Space,
    /// What hybrid synthesis needs of it; without, bodies only blend.
    pub hybrid: Option<&'a Hybrid>,
    /// Tunables.
    pub params: &'a HmsParams,
}

/// The synthesis of one body, from step to step.
#[derive(Clone, Copy, Debug)]
pub struct Body {
    /// Where it is.
    pub root: Root,
    /// φ.
    pub phase: f32,
    /// Synthesis in force.
    pub mode: Mode,
    /// Examples in play, while it blends.
    pub mix: Mix,
    /// What m_sp is deformed to, otherwise.
    walking: Parameters,
    /// What is seen of either, and what was a step ago.
    pub seen: [Seen; 2],
    choice: Choice,
    inertia: Inertia,
    gait: Gait,
    gaze: Gaze,
    owed: Owed,
    /// What the plans of the last moments asked for.
    intention: Intention,
    /// Velocity of the last step, world, m/s.
    walked_mps: Vec2,
    /// The velocity that it will have whatever is planned, world, m/s: on the paper's way from one synthesis to the
    /// other.
    pub committed_mps: Option<Vec2>,
    feet: [FootHold; 2],
    descent: Descent,
    hurry: Hurry,
}

/// A synthesised body.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Synthesis {
    /// After IK, in the root frame.
    pub pose: Pose,
    /// Blended contact of each foot.
    pub contacts: [f32; 2],
    /// For the planner's next step (§4.2).
    pub stance: Stance,
    /// Weight-averaged planted-foot slide of the examples in use, cm/s.
    pub examples_slide_cm_s: f32,
}

impl Body {
    /// A body that stands at `root`, its cycle at `phase`.
    pub fn standing(motion: &Motion, root: Root, phase: f32) -> (Self, Synthesis) {
        let mix = Mix::new(&motion.space.standing.shares);
        let mut body = Self {
            root,
            phase,
            mode: Mode::Blending,
            mix,
            walking: Parameters::default(),
            seen: [Seen::standing(mix); 2],
            choice: Choice::BLENDING,
            inertia: Inertia::default(),
            gait: Gait::STANDING,
            gaze: Gaze::default(),
            owed: Owed::default(),
            intention: Intention::default(),
            walked_mps: Vec2::ZERO,
            committed_mps: None,
            feet: Default::default(),
            descent: Descent::default(),
            hurry: Hurry::default(),
        };
        let synthesis = body.settle(motion);
        (body, synthesis)
    }
}

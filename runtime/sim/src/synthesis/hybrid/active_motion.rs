//! The active motion: blending or semi-procedural locomotion, whichever is active, at one phase.
//!
//! Root frame (x forward, y left, z up), metres; seconds.

use glam::Quat;
use motiondb::body::Pose;

use crate::planning::plan::PLANTED_CONTACT;
use crate::synthesis::SynthesisContext;
use crate::synthesis::blending::PoseWeights;
use crate::synthesis::hybrid::idle_clock::IdleClock;
use crate::synthesis::hybrid::played_transition::PlayedTransition;
use crate::synthesis::pose::Posture;
use crate::synthesis::pose::upper_body::curve_look::turn_ahead;
use crate::synthesis::semi_procedural::Deformation;
use crate::synthesis::traits::{ArmRotations, swing_arms};

/// One synthesis at one phase.
#[derive(Clone, Copy, Debug)]
pub(crate) enum ActiveMotion<'a> {
    /// Motion blending.
    Blending {
        /// Weights of the drawn mix, which give the pose.
        drawn: PoseWeights,
        /// Weights of the active mix, which give the contacts.
        current: PoseWeights,
        /// The idle in which the body stands.
        idle: IdleClock,
    },
    /// Semi-procedural locomotion as it is drawn.
    SemiProcedural(Deformation<'a>),
    /// A recorded transition.
    Transition(PlayedTransition),
}

impl ActiveMotion<'_> {
    /// The pose and the targets of its feet. The legs may not have bent yet: locks move the feet first.
    pub(crate) fn posture(&self, context: &SynthesisContext, phase: f32) -> Posture {
        let db = &context.db;
        match self {
            Self::Blending { drawn, current, idle } => {
                let mut pose = drawn.pose_with_idle(db, phase, || idle.pose(db));
                turn_ahead(&mut pose, context.domain.curve_look_rad(drawn), &db.skeleton);
                Posture::new(pose, current.contacts(db, phase), &db.skeleton)
            }
            Self::SemiProcedural(deformation) => deformation.posture(db, phase),
            Self::Transition(played) => {
                let frame = played.at(db, phase);
                Posture::new(frame.pose, frame.contacts, &db.skeleton)
            }
        }
    }

    /// Rotations of the extra joints, in place of `rotations`.
    pub(crate) fn blend_extra(&self, context: &SynthesisContext, phase: f32, rotations: &mut Vec<Quat>) {
        let (db, extra) = (&context.db, &context.db.extra);
        match self {
            Self::Blending { drawn, idle, .. } => {
                extra.blend(drawn.extra_rows(db, phase, idle.extra_frames(db)), rotations);
            }
            Self::SemiProcedural(deformation) => extra.blend(deformation.extra_rows(db, phase), rotations),
            Self::Transition(played) => extra.blend(played.extra_frames(db, phase), rotations),
        }
    }

    /// Scales the swing of each arm of a pose, `[left, right]`, about its mean over the motion.
    pub(crate) fn swing_arms(&self, pose: &mut Pose, swing: [f32; 2], context: &SynthesisContext) {
        if swing != [1.0; 2] {
            swing_arms(pose, &self.arm_means(context), swing);
        }
    }

    /// Mean rotations of the joints of the arms: of the examples that are blended, otherwise of the base walk.
    fn arm_means(&self, context: &SynthesisContext) -> ArmRotations {
        let Self::Blending { drawn, .. } = self else { return context.arm_means[context.base] };
        let of = |example: u32| &context.arm_means[example as usize];
        let sum = |arm: usize, joint: usize| {
            let weighted = drawn.entries().iter().map(|&(example, weight)| of(example)[arm][joint] * weight);
            weighted.reduce(|sum, rotation| sum + rotation).map_or(Quat::IDENTITY, Quat::normalize)
        };
        [0, 1].map(|arm| [0, 1].map(|joint| sum(arm, joint)))
    }

    /// Contact of each foot, `[left, right]`.
    pub(crate) fn contacts(&self, context: &SynthesisContext, phase: f32) -> [f32; 2] {
        match self {
            Self::Blending { current, .. } => current.contacts(&context.db, phase),
            Self::SemiProcedural(deformation) => deformation.contacts(&context.db, phase),
            Self::Transition(played) => played.at(&context.db, phase).contacts,
        }
    }

    /// φ', 1/s.
    pub(crate) fn phase_rate_hz(&self, context: &SynthesisContext, phase: f32) -> f32 {
        match self {
            Self::Blending { drawn, .. } => drawn.phase_rate_hz,
            Self::SemiProcedural(deformation) => deformation.phase_map().rate_hz(phase),
            Self::Transition(played) => played.phase_rate_hz(&context.db),
        }
    }

    /// Time until a swinging foot lands, s.
    pub(crate) fn time_to_landing_s(&self, context: &SynthesisContext, phase: f32, side: usize) -> f32 {
        match self {
            Self::Blending { current, .. } => current.time_to_landing_s(&context.db, phase, side, PLANTED_CONTACT),
            Self::SemiProcedural(deformation) => deformation.time_to_landing_s(phase, side),
            Self::Transition(played) => played.time_to_landing_s(&context.db, side),
        }
    }

    /// Weighted mean of the planted-foot slide of the examples, at the cadence at which they play, cm/s.
    pub(crate) fn examples_slide_cm_s(&self, context: &SynthesisContext) -> f32 {
        match self {
            Self::Blending { current, .. } => current.examples_slide_cm_s(&context.db),
            Self::SemiProcedural(deformation) => deformation.examples_slide_cm_s(&context.db),
            Self::Transition(played) => played.slide_cm_s(&context.db),
        }
    }
}

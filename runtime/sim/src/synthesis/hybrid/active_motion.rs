//! What a body plays: a mix of examples, or m_sp deformed. Both give poses, contacts and a phase rate at any phase.

use crate::planning::plan::PLANTED_CONTACT;
use crate::synthesis::Motion;
use crate::synthesis::blending::mix::{Mix, Weights};
use crate::synthesis::hybrid::mode::Mode;
use crate::synthesis::hybrid::pose_smoothing::Seen;
use crate::synthesis::pose::posture::Posture;
use crate::synthesis::semi_procedural::deformation::Deformation;

/// One synthesis at one phase.
#[derive(Clone, Copy, Debug)]
pub enum Playing<'a> {
    /// Motion blending: the pose is that of the mix that is seen, and contacts keep the time of the one that the root
    /// has come to. M_sp's root does as it is seen to.
    Blend {
        /// Of the mix that is seen.
        seen: Weights,
        /// Of that which is due.
        due: Weights,
    },
    /// Semi-procedural locomotion.
    Deform(Deformation<'a>),
}

impl<'a> Playing<'a> {
    /// What is seen of a body at a phase, where its root has come to a mix.
    pub fn new(motion: &Motion<'a>, mode: Mode, seen: &Seen, due: &Mix, phase: f32) -> Self {
        match (mode, motion.hybrid) {
            (Mode::SemiProcedural, Some(hybrid)) => {
                Self::Deform(Deformation::going(&hybrid.semi_procedural, seen.walking, seen.way))
            }
            _ => Self::Blend { seen: seen.mix.weights(motion.db, phase), due: due.weights(motion.db, phase) },
        }
    }

    /// The pose on its feet. Those of examples are where their legs have them.
    pub fn bent(&self, motion: &Motion, phase: f32) -> Posture {
        let mut posture = self.posture(motion, phase);
        if let Self::Deform(_) = self {
            posture.bend_legs(&motion.db.skeleton);
        }
        posture
    }

    /// The pose, whose legs may not have bent yet, and its feet: whoever moves them bends legs once.
    pub fn posture(&self, motion: &Motion, phase: f32) -> Posture {
        match self {
            Self::Blend { seen, due } => {
                Posture::new(seen.pose(motion.db, phase), due.contacts(motion.db, phase), &motion.db.skeleton)
            }
            Self::Deform(deformation) => deformation.posture(motion.db, phase),
        }
    }

    /// The contact of each foot.
    pub fn contacts(&self, motion: &Motion, phase: f32) -> [f32; 2] {
        match self {
            Self::Blend { due, .. } => due.contacts(motion.db, phase),
            Self::Deform(deformation) => deformation.contacts(motion.db, phase),
        }
    }

    /// φ', 1/s.
    pub fn phase_rate_hz(&self, phase: f32) -> f32 {
        match self {
            Self::Blend { seen, .. } => seen.phase_rate_hz,
            Self::Deform(deformation) => deformation.phase_map().rate_hz(phase),
        }
    }

    /// Seconds until a swinging foot lands.
    pub fn time_to_landing_s(&self, motion: &Motion, phase: f32, side: usize) -> f32 {
        match self {
            Self::Blend { due, .. } => due.time_to_landing_s(motion.db, phase, side, PLANTED_CONTACT),
            Self::Deform(deformation) => deformation.time_to_landing_s(phase, side),
        }
    }

    /// Weight-averaged planted-foot slide of the examples in use, at the cadence at which they are played, cm/s.
    pub fn examples_slide_cm_s(&self, motion: &Motion) -> f32 {
        match self {
            Self::Blend { due, .. } => due.examples_slide_cm_s(motion.db),
            Self::Deform(deformation) => deformation.examples_slide_cm_s(motion.db),
        }
    }
}

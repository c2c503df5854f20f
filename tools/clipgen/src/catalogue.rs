//! The list of clips: name, what it claims to be, and its gait.
//!
//! Turns and side-steps are authored to the left; the compiler mirrors them. Speeds of turns fall with their rate, as
//! people's do.

use crate::body::Pose;
use crate::cadence::{self, FRAME_RATE_HZ, Gait};
use crate::footsteps::RootMotion;
use crate::idle;
use crate::stepping::{self, Film};
use crate::variation::Variation;

/// One clip.
#[derive(Clone, Debug)]
pub(crate) struct Clip {
    /// File name without extension.
    pub(crate) name: &'static str,
    /// What the name claims.
    pub(crate) motion: RootMotion,
    /// How it is made.
    pub(crate) recipe: Recipe,
}

/// Standing or stepping.
#[derive(Clone, Debug)]
pub(crate) enum Recipe {
    /// Standing.
    Idle,
    /// A gait, so many strides of it.
    Steps {
        /// The gait as planned (forward, where the film is reversed).
        gait: Box<Gait>,
        /// Whole strides.
        strides: usize,
        /// Which way the film runs.
        film: Film,
    },
}

/// What a clip is made with: the gait's kind.
#[derive(Clone, Copy)]
enum Kind {
    Walk,
    Run,
    Diagonal,
    Backward,
    /// Feet so far from the midline, m.
    StepAbout(f64),
}

/// Name, kind, (v_f m/s, ω_t °/s, ω_s m/s), frames, strides. Frames over strides leaves a rest of one: see
/// `cadence.rs`.
type Row = (&'static str, Kind, (f64, f64, f64), usize, usize);

const ROWS: &[Row] = &[
    ("walk_050", Kind::Walk, (0.5, 0.0, 0.0), 145, 3),
    ("walk_080", Kind::Walk, (0.8, 0.0, 0.0), 161, 4),
    ("walk_110", Kind::Walk, (1.1, 0.0, 0.0), 145, 4),
    ("walk_140", Kind::Walk, (1.4, 0.0, 0.0), 121, 4),
    ("walk_180", Kind::Walk, (1.8, 0.0, 0.0), 109, 4),
    ("jog_240", Kind::Run, (2.4, 0.0, 0.0), 89, 4),
    ("run_350", Kind::Run, (3.5, 0.0, 0.0), 81, 4),
    ("turn_030_left", Kind::Walk, (1.0, 30.0, 0.0), 145, 4),
    ("turn_060_left", Kind::Walk, (0.85, 60.0, 0.0), 145, 4),
    ("turn_090_left", Kind::Walk, (0.65, 90.0, 0.0), 129, 4),
    ("turn_130_left", Kind::Walk, (0.45, 130.0, 0.0), 121, 4),
    ("jog_turn_060_left", Kind::Run, (2.3, 60.0, 0.0), 89, 4),
    ("jog_turn_110_left", Kind::Run, (1.75, 110.0, 0.0), 85, 4),
    ("spin_090_left", Kind::StepAbout(0.095), (0.0, 90.0, 0.0), 121, 4),
    ("spin_170_left", Kind::StepAbout(0.100), (0.0, 170.0, 0.0), 81, 4),
    ("side_035_left", Kind::StepAbout(0.155), (0.0, 0.0, 0.35), 145, 4),
    ("side_060_left", Kind::StepAbout(0.180), (0.0, 0.0, 0.6), 109, 4),
    ("shuffle_120_left", Kind::StepAbout(0.215), (0.0, 0.0, 1.2), 97, 6),
    ("diagonal_110_030_left", Kind::Diagonal, (1.1, 0.0, 0.3), 137, 4),
    ("diagonal_080_040_left", Kind::Diagonal, (0.8, 0.0, 0.4), 145, 4),
    ("backward_040", Kind::Backward, (-0.4, 0.0, 0.0), 127, 3),
    ("backward_080", Kind::Backward, (-0.8, 0.0, 0.0), 137, 4),
    ("backward_110", Kind::Backward, (-1.1, 0.0, 0.0), 117, 4),
    ("backward_turn_045_left", Kind::Backward, (-0.6, 45.0, 0.0), 145, 4),
];

/// Clips written as GLB, with a skinned body; one of every kind of gait, so that what people see by default comes
/// through both importers.
const SKINNED: [&str; 7] = [
    "walk_140",
    "turn_030_left",
    "jog_turn_060_left",
    "spin_090_left",
    "side_035_left",
    "diagonal_110_030_left",
    "backward_080",
];

/// Every clip, in the order of the README.
pub(crate) fn clips() -> Vec<Clip> {
    let still = RootMotion { speed_mps: 0.0, turn_rate_rad_s: 0.0, strafe_mps: 0.0 };
    let mut clips = vec![Clip { name: "idle", motion: still, recipe: Recipe::Idle }];
    clips.extend(ROWS.iter().map(clip_of));
    clips
}

fn clip_of(&(name, kind, (speed_mps, turn_deg_s, strafe_mps), frames, strides): &Row) -> Clip {
    let stride_frames = frames as f64 / strides as f64;
    let motion = RootMotion { speed_mps, turn_rate_rad_s: turn_deg_s.to_radians(), strafe_mps };
    let (gait, film) = match kind {
        Kind::Walk => (cadence::walk(motion, stride_frames), Film::Forward),
        Kind::Run => (cadence::run(motion, stride_frames), Film::Forward),
        Kind::Diagonal => (cadence::diagonal(motion, stride_frames), Film::Forward),
        Kind::StepAbout(half_width_m) => (cadence::step_about(motion, stride_frames, half_width_m), Film::Forward),
        Kind::Backward => (cadence::backward_film(motion, stride_frames), Film::Reversed),
    };
    Clip { name, motion, recipe: Recipe::Steps { gait: Box::new(gait), strides, film } }
}

impl Clip {
    /// Whether its file is a GLB with a skinned body, not a BVH.
    pub(crate) fn is_skinned(&self) -> bool {
        SKINNED.contains(&self.name)
    }

    /// Its name in the folder.
    pub(crate) fn file_name(&self) -> String {
        format!("{}.{}", self.name, if self.is_skinned() { "glb" } else { "bvh" })
    }

    /// Its frames.
    pub(crate) fn poses(&self) -> Vec<Pose> {
        match &self.recipe {
            Recipe::Idle => idle::frames(),
            Recipe::Steps { gait, strides, film } => {
                stepping::frames(gait, *film, &Variation::of_clip(self.name, *strides))
            }
        }
    }

    /// Steps a minute and metres a step, for clips that step.
    pub(crate) fn cadence_and_step_m(&self) -> Option<(f64, f64)> {
        let Recipe::Steps { gait, .. } = &self.recipe else { return None };
        let step_s = 0.5 * gait.stride_frames / FRAME_RATE_HZ;
        Some((60.0 / step_s, self.motion.pace_mps() * step_s))
    }
}

//! The list of clips: name, motion that the name claims, and plan of the gait.
//!
//! Turns and side-steps are to the left; the compiler mirrors them. The speed of a turn falls with its rate, as in
//! humans.

use crate::body::ClipPose;
use crate::motion::idle::{self, StandingPlan};
use crate::motion::{Playback, idle_frames, stepping_frames};
use crate::plan::{FRAME_RATE_HZ, GaitPlan, RootMotion, StrideVariation, gaits};

/// The plan of one clip.
#[derive(Clone, Debug)]
pub(crate) struct PlannedClip {
    /// File name without extension.
    pub(crate) name: &'static str,
    /// Motion of the root that the name claims.
    pub(crate) motion: RootMotion,
    /// Standing, or strides of a gait.
    pub(crate) recipe: ClipRecipe,
}

/// How the frames of a clip are made.
#[derive(Clone, Debug)]
pub(crate) enum ClipRecipe {
    /// Standing.
    Idle(StandingPlan),
    /// Strides of a gait.
    Steps {
        /// Plan of the gait; of a reversed clip that of the forward gait.
        gait: Box<GaitPlan>,
        /// Number of whole strides.
        strides: usize,
        /// Direction in time.
        playback: Playback,
    },
}

/// Families of gaits, each with its plan in [`gaits`].
#[derive(Clone, Copy)]
enum GaitFamily {
    Walk,
    Run,
    Diagonal,
    Backward,
    /// Steps sideways or about itself; distance of the feet from the midline, m.
    StepAbout(f64),
}

/// Name, family, (v_f m/s, ω_t °/s, ω_s m/s), frames, strides. Frames over strides leave a remainder of one, so that
/// strides are sampled at different moments (see [`gaits`]).
type CatalogueRow = (&'static str, GaitFamily, (f64, f64, f64), usize, usize);

/// Every clip that stands.
const IDLES: [(&str, StandingPlan); 3] =
    [("idle", idle::EVEN), ("idle_on_left_leg", idle::ON_LEFT), ("idle_on_right_leg", idle::ON_RIGHT)];

/// Every clip that steps.
const ROWS: &[CatalogueRow] = &[
    ("walk_050", GaitFamily::Walk, (0.5, 0.0, 0.0), 145, 3),
    ("walk_080", GaitFamily::Walk, (0.8, 0.0, 0.0), 161, 4),
    ("walk_110", GaitFamily::Walk, (1.1, 0.0, 0.0), 145, 4),
    ("walk_140", GaitFamily::Walk, (1.4, 0.0, 0.0), 121, 4),
    ("walk_180", GaitFamily::Walk, (1.8, 0.0, 0.0), 109, 4),
    ("jog_240", GaitFamily::Run, (2.4, 0.0, 0.0), 89, 4),
    ("run_350", GaitFamily::Run, (3.5, 0.0, 0.0), 81, 4),
    ("turn_030_left", GaitFamily::Walk, (1.0, 30.0, 0.0), 145, 4),
    ("turn_060_left", GaitFamily::Walk, (0.85, 60.0, 0.0), 145, 4),
    ("turn_090_left", GaitFamily::Walk, (0.65, 90.0, 0.0), 129, 4),
    ("turn_130_left", GaitFamily::Walk, (0.45, 130.0, 0.0), 121, 4),
    ("jog_turn_060_left", GaitFamily::Run, (2.3, 60.0, 0.0), 89, 4),
    ("jog_turn_110_left", GaitFamily::Run, (1.75, 110.0, 0.0), 85, 4),
    ("spin_090_left", GaitFamily::StepAbout(0.095), (0.0, 90.0, 0.0), 121, 4),
    ("spin_170_left", GaitFamily::StepAbout(0.100), (0.0, 170.0, 0.0), 81, 4),
    ("side_035_left", GaitFamily::StepAbout(0.155), (0.0, 0.0, 0.35), 145, 4),
    ("side_060_left", GaitFamily::StepAbout(0.180), (0.0, 0.0, 0.6), 109, 4),
    ("shuffle_120_left", GaitFamily::StepAbout(0.215), (0.0, 0.0, 1.2), 97, 6),
    ("diagonal_110_030_left", GaitFamily::Diagonal, (1.1, 0.0, 0.3), 137, 4),
    ("diagonal_080_040_left", GaitFamily::Diagonal, (0.8, 0.0, 0.4), 145, 4),
    ("backward_040", GaitFamily::Backward, (-0.4, 0.0, 0.0), 127, 3),
    ("backward_080", GaitFamily::Backward, (-0.8, 0.0, 0.0), 137, 4),
    ("backward_110", GaitFamily::Backward, (-1.1, 0.0, 0.0), 117, 4),
    ("backward_turn_045_left", GaitFamily::Backward, (-0.6, 45.0, 0.0), 145, 4),
];

/// Clips that are GLB files with a skinned body: one of every family, so that the default set exercises both importers.
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
pub(crate) fn planned_clips() -> Vec<PlannedClip> {
    let still = RootMotion { speed_mps: 0.0, turn_rate_rad_s: 0.0, strafe_mps: 0.0 };
    let idle = |&(name, plan): &(&'static str, StandingPlan)| PlannedClip {
        name,
        motion: still,
        recipe: ClipRecipe::Idle(plan),
    };
    let mut clips: Vec<_> = IDLES.iter().map(idle).collect();
    clips.extend(ROWS.iter().map(planned_clip));
    clips
}

fn planned_clip(row: &CatalogueRow) -> PlannedClip {
    let &(name, family, (speed_mps, turn_deg_s, strafe_mps), frames, strides) = row;
    let stride_frames = frames as f64 / strides as f64;
    let motion = RootMotion { speed_mps, turn_rate_rad_s: turn_deg_s.to_radians(), strafe_mps };
    let (gait, playback) = match family {
        GaitFamily::Walk => (gaits::walk(motion, stride_frames), Playback::Forward),
        GaitFamily::Run => (gaits::run(motion, stride_frames), Playback::Forward),
        GaitFamily::Diagonal => (gaits::diagonal(motion, stride_frames), Playback::Forward),
        GaitFamily::StepAbout(half_width_m) => {
            (gaits::step_about(motion, stride_frames, half_width_m), Playback::Forward)
        }
        GaitFamily::Backward => (gaits::reversed_backward_walk(motion, stride_frames), Playback::Reversed),
    };
    PlannedClip { name, motion, recipe: ClipRecipe::Steps { gait: Box::new(gait), strides, playback } }
}

impl PlannedClip {
    /// Whether its file is a GLB with a skinned body, not a BVH.
    pub(crate) fn is_skinned(&self) -> bool {
        SKINNED.contains(&self.name)
    }

    /// Name of its file, with extension.
    pub(crate) fn file_name(&self) -> String {
        format!("{}.{}", self.name, if self.is_skinned() { "glb" } else { "bvh" })
    }

    /// The frames of the clip.
    pub(crate) fn poses(&self) -> Vec<ClipPose> {
        match &self.recipe {
            ClipRecipe::Idle(plan) => idle_frames(self.name, plan),
            ClipRecipe::Steps { gait, strides, playback } => {
                stepping_frames(gait, *playback, &StrideVariation::of_clip(self.name, *strides))
            }
        }
    }

    /// Cadence (steps/min) and length of a step (m), of clips that step.
    pub(crate) fn cadence_and_step_m(&self) -> Option<(f64, f64)> {
        let ClipRecipe::Steps { gait, .. } = &self.recipe else { return None };
        let step_s = 0.5 * gait.stride_frames / FRAME_RATE_HZ;
        Some((60.0 / step_s, self.motion.pace_mps() * step_s))
    }
}

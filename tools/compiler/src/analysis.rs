//! HumanClip → what its example will be made of: the clip on the target skeleton, its gait, its mean stride; or why it
//! gives none.
//!
//! A folder may hold anything: dances, jumps, deaths. What steps or stands steadily may still be no model of standing
//! on the ground, and then gives no example either.

use glam::DVec3;

use crate::cycle::{self, GaitCycle};
use crate::foot_slide;
use crate::gait::{self, Gait, GaitAnalysis};
use crate::human_clip::{HumanBody, HumanClip};
use crate::remark::NO_EXAMPLE;
use crate::root_motion::{self, GroundedClip, leg_length_m};
use crate::{parameterize, unroll};

/// Whoever walks, crouched or on hands, has the pelvis above this, m.
const PELVIS_HEIGHT_MIN_M: f64 = 0.01;
/// Why a clip in which it is elsewhere is no example.
const STRAY: &str = "the pelvis is where no legs could carry it";

/// A clip on the target skeleton, its gait found and, where it steps, its mean stride.
pub(crate) struct Analyzed {
    pub grounded: GroundedClip,
    pub gait: GaitAnalysis,
    pub stepping: Option<GaitCycle>,
    pub warnings: Vec<String>,
}

/// Analyses one clip.
pub(crate) fn analyze(clip: &HumanClip, body: &HumanBody) -> Analyzed {
    let grounded = unroll::unroll(root_motion::ground(clip, body), body);
    let mut gait = gait::analyze(&grounded, body);
    let heights_m = grounded.poses.iter().map(|pose| DVec3::Z * pose.pelvis_m.z);
    if matches!(gait.gait, Gait::Stands) && strays(heights_m, body) {
        gait.gait = Gait::Unsteady(STRAY);
    }
    let (mut stepping, mut warnings) = (None, Vec::new());
    match &gait.gait {
        Gait::Steps(strides) => {
            let mut cycle = cycle::mean_stride(&grounded, body, &gait.planted, strides);
            warnings = parameterize::snap(&mut cycle);
            match unfit(&cycle, body) {
                Some(reason) => warnings.push(format!("{NO_EXAMPLE}{reason}")),
                None => {
                    warnings.extend(foot_slide::lint(&cycle, body));
                    stepping = Some(cycle);
                }
            }
        }
        Gait::Unsteady(reason) => warnings.push(format!("{NO_EXAMPLE}{reason}")),
        Gait::Stands => {}
    }
    Analyzed { grounded, gait, stepping, warnings }
}

/// Why a cycle must not be blended with others, if so.
fn unfit(cycle: &GaitCycle, body: &HumanBody) -> Option<String> {
    if strays(cycle.rows.iter().map(|row| row.pelvis_m), body) {
        return Some(STRAY.to_owned());
    }
    foot_slide::excess(cycle, body)
}

/// Whether a pelvis leaves its root, at z = 0: more than two legs aside, three up, or into the ground.
fn strays(mut pelvis_m: impl Iterator<Item = DVec3>, body: &HumanBody) -> bool {
    let leg_m = leg_length_m(body);
    let heights_m = PELVIS_HEIGHT_MIN_M..3.0 * leg_m;
    let is_near = |place_m: &DVec3| place_m.truncate().length() < 2.0 * leg_m && heights_m.contains(&place_m.z);
    !pelvis_m.all(|place_m| is_near(&place_m))
}

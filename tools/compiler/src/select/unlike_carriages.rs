//! Walks in which the body holds a part otherwise than in the other walks of its style: an arm, the head or the trunk. It
//! would be blended into all of them.
//!
//! Frame of the facing: x forward, y left, z up.

use std::ops::Range;

use glam::{DVec3, Vec3};
use motiondb::body::Joint;
use motiondb::diagnostic::{Diagnostic, HeldPart, Warning};
use motiondb::statistics::median;
use rayon::prelude::*;

use crate::cycle::analyzed_clip::AnalyzedClip;
use crate::cycle::gait_cycle::GaitCycle;
use crate::ground::root_arc::Rates;
use crate::retarget::human_clip::HumanBody;

/// Least number of walks that show what is usual.
const WALKS_MIN: usize = 4;
/// Speeds ahead of the walks that are compared, m/s: arms swing otherwise in steps back, and bend in runs.
const WALKS_MPS: Range<f64> = 0.3..2.0;
/// Greatest speed to a side, m/s.
const ASIDE_MAX_MPS: f64 = 0.3;
/// Greatest turn rate, rad/s: the head turns into sharp curves.
const TURN_MAX_RAD_S: f64 = 0.8;
/// Parts that are compared, and the least angle from the usual that is reported, degrees.
const PARTS: [(HeldPart, f64); 4] =
    [(HeldPart::LeftArm, 40.0), (HeldPart::RightArm, 40.0), (HeldPart::Head, 35.0), (HeldPart::Trunk, 20.0)];
/// Least such angle over that of the middle walk: some sets are varied.
const OVER_MIDDLE: f64 = 3.0;

/// Adds a warning to the windows of a style's clips that walk with an unusual carriage.
pub(crate) fn warn_of_unlike_carriages(analyzed: &mut [AnalyzedClip], body: &HumanBody) {
    let windows: Vec<[usize; 2]> = analyzed
        .iter()
        .enumerate()
        .flat_map(|(clip, found)| (0..found.windows.len()).map(move |window| [clip, window]))
        .collect();
    let directions = |&[clip, window]: &[usize; 2]| {
        let cycle = analyzed[clip].windows[window].stepping().filter(|cycle| walks(cycle))?;
        Some(([clip, window], part_directions(cycle, body)))
    };
    let walks: Vec<([usize; 2], [Vec3; PARTS.len()])> = windows.par_iter().filter_map(directions).collect();
    if walks.len() < WALKS_MIN {
        return;
    }
    for (part, (held, least_deg)) in PARTS.into_iter().enumerate() {
        let of_axis =
            |axis: usize| median(walks.iter().map(|(_, parts)| f64::from(parts[part][axis]))).unwrap_or_default();
        let usual = DVec3::new(of_axis(0), of_axis(1), of_axis(2)).as_vec3();
        let angles_deg: Vec<f64> =
            walks.iter().map(|(_, parts)| f64::from(parts[part].angle_between(usual).to_degrees())).collect();
        let middle_deg = median(angles_deg.iter().copied()).unwrap_or_default();
        for (([clip, window], _), angle_deg) in walks.iter().zip(angles_deg) {
            if angle_deg > least_deg.max(OVER_MIDDLE * middle_deg) {
                let warning = Warning::CarriageUnlike { part: held, angle_deg: angle_deg as f32, from_s: None };
                analyzed[*clip].windows[*window].diagnostics.push(Diagnostic::Warning(warning));
            }
        }
    }
}

fn walks(cycle: &GaitCycle) -> bool {
    let Rates { speed_mps, turn_rate_rad_s, strafe_mps } = cycle.rates;
    let goes_ahead = WALKS_MPS.contains(&speed_mps) && strafe_mps.abs() < ASIDE_MAX_MPS;
    !cycle.is_run() && goes_ahead && turn_rate_rad_s.abs() < TURN_MAX_RAD_S
}

/// Mean directions of [`PARTS`] over a cycle: from each shoulder to its wrist, where the head faces, from the pelvis to the
/// neck.
fn part_directions(cycle: &GaitCycle, body: &HumanBody) -> [Vec3; PARTS.len()] {
    let joints = cycle.joints(body);
    let mean_of = |from: Joint, to: Joint| {
        let directions =
            joints.iter().map(|joints| (joints.position_m(to) - joints.position_m(from)).normalize_or_zero());
        directions.sum::<DVec3>().as_vec3()
    };
    let head = joints.iter().map(|joints| joints.orientations[Joint::Head.index()] * DVec3::X).sum::<DVec3>().as_vec3();
    [
        mean_of(Joint::LeftUpperArm, Joint::LeftHand),
        mean_of(Joint::RightUpperArm, Joint::RightHand),
        head,
        mean_of(Joint::Pelvis, Joint::Neck),
    ]
}

#[cfg(test)]
mod tests {
    use glam::DQuat;

    use super::*;
    use crate::synthetic::{SyntheticWalk, database_of, walk};

    /// Parts in the warnings about six walks, of which the last turns a joint.
    fn held(joint: Joint, turn: DQuat) -> Vec<HeldPart> {
        let at = |speed_mps: f64| walk(&format!("walk_{speed_mps}"), SyntheticWalk::at(speed_mps, 0.0, 0.0));
        let mut clips: Vec<_> = [0.6, 0.8, 1.0, 1.2, 1.4, 1.6].map(at).into();
        for pose in &mut clips[5].frames {
            pose.rotations[joint.index()] = turn * pose.rotations[joint.index()];
        }
        let db = database_of(clips, 0);
        let part = |source: usize, found: &Diagnostic| match found {
            Diagnostic::Warning(Warning::CarriageUnlike { part, .. }) => {
                assert_eq!(db.sources[source].file, "walk_1.6.bvh");
                Some(*part)
            }
            _ => None,
        };
        let all = db.sources.iter().enumerate();
        all.flat_map(|(source, record)| record.diagnostics.iter().filter_map(move |found| part(source, found)))
            .collect()
    }

    #[test]
    fn parts_held_otherwise_are_named() {
        assert!(held(Joint::Head, DQuat::IDENTITY).is_empty());
        assert_eq!(held(Joint::Head, DQuat::from_rotation_z(1.2)), [HeldPart::Head]);
        assert_eq!(held(Joint::RightUpperArm, DQuat::from_rotation_y(-1.2)), [HeldPart::RightArm]);
        assert!(held(Joint::SpineLower, DQuat::from_rotation_y(0.6)).contains(&HeldPart::Trunk));
    }
}

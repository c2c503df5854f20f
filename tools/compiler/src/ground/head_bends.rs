//! How the head of each clip is bent against that of its rig.
//!
//! No direction in a clip shows where the face points, so a clip alone has a head that is level on average
//! ([`crate::retarget::calibration`]): one that is bent throughout comes out level. Its offset belongs to the rig, not
//! to the clip. Three or more clips of one rig share the median of their offsets, and each keeps how far its head is
//! bent down or up against it. How far a head is turned aside is not kept: in a set of turns to the left the median is
//! a head that is turned left.

use std::collections::BTreeMap;
use std::f64::consts::PI;

use glam::{DQuat, DVec3};
use motiondb::body::Joint;

use crate::ground::pose_mean::mean_rotation;
use crate::ground::rotations::rotation_vector;
use crate::retarget::human_clip::{HumanClip, HumanPose};
use crate::rig::rig_head::Rig;

/// Greatest angle of a head off that of its rig, rad: 60°. A joint that is turned farther belongs to another rig.
const BEND_MAX_RAD: f64 = PI / 3.0;

/// Least number of clips whose median is the offset of their rig: of two that differ, either may be the bent one.
const CLIPS_MIN: usize = 3;
/// Number of iterations for the median of rotations.
const MEDIAN_ITERATIONS: usize = 32;
/// Angle within which rotations weigh alike in the median, rad.
const SAME_RAD: f64 = 1e-3;

/// The rotation of each clip's head about its left, from a level mean to the clip's own bend.
pub(crate) fn head_bends(clips: &[HumanClip]) -> Vec<DQuat> {
    let mut of_rigs: BTreeMap<&Rig, Vec<DQuat>> = BTreeMap::new();
    for head in clips.iter().filter_map(|clip| clip.rig_head.as_ref()) {
        of_rigs.entry(&head.rig).or_default().push(head.offset);
    }
    of_rigs.retain(|_, offsets| offsets.len() >= CLIPS_MIN);
    let offsets: BTreeMap<&Rig, DQuat> =
        of_rigs.into_iter().map(|(rig, offsets)| (rig, median_rotation(&offsets))).collect();
    let bend = |clip: &HumanClip| {
        let head = clip.rig_head.as_ref()?;
        let bend = head.offset.inverse() * *offsets.get(&head.rig)?;
        let is_same_rig = rotation_vector(bend).length() < BEND_MAX_RAD;
        is_same_rig.then(|| DQuat::from_rotation_y(libm::asin(-(bend * DVec3::X).z)))
    };
    clips.iter().map(|clip| bend(clip).unwrap_or(DQuat::IDENTITY)).collect()
}

/// Bends the head of a pose.
pub(crate) fn bend_head(pose: &mut HumanPose, bend: DQuat) {
    let head = &mut pose.rotations[Joint::Head.index()];
    *head = (*head * bend).normalize();
}

/// The geometric median of some rotations, of which the sum of angles to all is least (Weiszfeld's iteration from their
/// mean).
fn median_rotation(rotations: &[DQuat]) -> DQuat {
    let mut at = mean_rotation(rotations.iter().map(|rotation| (1.0, *rotation)));
    for _ in 0..MEDIAN_ITERATIONS {
        let (mut sum, mut weights) = (DVec3::ZERO, 0.0);
        for rotation in rotations {
            let arc = rotation_vector(at.inverse() * *rotation);
            let weight = 1.0 / (arc.length() + SAME_RAD);
            sum += arc * weight;
            weights += weight;
        }
        at = (at * DQuat::from_scaled_axis(sum / weights)).normalize();
    }
    at
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::rig::rig_head::RigHead;
    use crate::synthetic::{self, SyntheticWalk};

    /// Angles of the bends of clips of one rig whose offsets are turned by some angles about an axis, degrees.
    fn bends_deg(axis: DVec3, offsets_deg: &[f64]) -> Vec<f64> {
        let clip = |offset_deg: &f64| {
            let mut clip = synthetic::walk("walk", SyntheticWalk { duration_s: 1.0, ..SyntheticWalk::default() });
            let rig = Rig { names: Vec::new(), lengths: Vec::new() };
            clip.rig_head = Some(RigHead { rig, offset: DQuat::from_axis_angle(axis, offset_deg.to_radians()) });
            clip
        };
        let clips: Vec<HumanClip> = offsets_deg.iter().map(clip).collect();
        head_bends(&clips).into_iter().map(|bend| rotation_vector(bend).y.to_degrees()).collect()
    }

    #[track_caller]
    fn check(offsets_deg: &[f64], wanted_deg: &[f64]) {
        let found = bends_deg(DVec3::Y, offsets_deg);
        assert!(found.iter().zip(wanted_deg).all(|(found, wanted)| (found - wanted).abs() < 0.1), "{found:?}");
    }

    #[test]
    fn one_bent_head_of_three_is_bent_in_any_order() {
        check(&[0.0, 0.0, 25.0], &[0.0, 0.0, -25.0]);
        check(&[25.0, 0.0, 0.0], &[-25.0, 0.0, 0.0]);
        check(&[190.0, 165.0, 165.0], &[-25.0, 0.0, 0.0]);
    }

    #[test]
    fn turns_to_one_side_turn_no_head() {
        let found = bends_deg(DVec3::Z, &[0.0, 20.0, 25.0, 30.0]);
        assert!(found.iter().all(|bend_deg| bend_deg.abs() < 1e-6), "{found:?}");
    }

    #[test]
    fn one_or_two_clips_and_turned_axes_show_no_bend() {
        check(&[25.0], &[0.0]);
        check(&[0.0, 25.0], &[0.0, 0.0]);
        check(&[0.0, 0.0, 90.0], &[0.0; 3]);
    }
}

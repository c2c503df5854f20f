//! How the head of each clip is bent against that of its rig.
//!
//! No direction in a clip shows where the face points, so calibration makes heads level on average
//! ([`crate::retarget::calibration`]), also one that is bent throughout. Its offset belongs to the rig, not to the clip:
//!
//! - Three or more clips of one rig share the median of their offsets. Each keeps how far its head is bent down or up
//!   against it.
//! - Of fewer clips the rest pose shows the offset, where it is a body that stands ([`crate::rig::rest_pose`]). A head
//!   that is bent far down against it stays bent. People look down; heads that are far up are those of rest poses that
//!   look down.
//!
//! How far a head is turned aside is not kept: in a set of turns to the left the median is a head that is turned left.

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
/// Least angle by which a head is bent down against its rest pose, rad: 18°. Heads of walks and turns of other makers are
/// down by 2° up to 16°, of their idles by 14°.
const REST_BEND_MIN_RAD: f64 = PI / 10.0;

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
        match offsets.get(&head.rig) {
            Some(offset) => pitch(head.offset.inverse() * *offset),
            None => pitch(head.offset.inverse() * head.rest_offset?).filter(|down_rad| *down_rad > REST_BEND_MIN_RAD),
        }
    };
    clips.iter().map(|clip| DQuat::from_rotation_y(bend(clip).unwrap_or_default())).collect()
}

/// How far a rotation pitches a head, rad, + down; `None` beyond what necks do.
fn pitch(bend: DQuat) -> Option<f64> {
    (rotation_vector(bend).length() < BEND_MAX_RAD).then(|| libm::asin(-(bend * DVec3::X).z))
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
        bends_of_rest_deg(axis, offsets_deg, None)
    }

    /// The same with the offset that the rest pose shows.
    fn bends_of_rest_deg(axis: DVec3, offsets_deg: &[f64], rest_offset: Option<DQuat>) -> Vec<f64> {
        let clip = |offset_deg: &f64| {
            let mut clip = synthetic::walk("walk", SyntheticWalk { duration_s: 1.0, ..SyntheticWalk::default() });
            let rig = Rig { names: Vec::new(), lengths: Vec::new() };
            clip.rig_head = Some(RigHead {
                rig,
                offset: DQuat::from_axis_angle(axis, offset_deg.to_radians()),
                rest_offset,
                rest_up: String::new(),
            });
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
    fn a_rest_pose_shows_a_lone_head_that_is_bent_down() {
        let bend_deg = |offset_deg: f64| bends_of_rest_deg(DVec3::Y, &[offset_deg], Some(DQuat::IDENTITY))[0];
        assert!((bend_deg(-25.0) - 25.0).abs() < 0.1 && bend_deg(-10.0).abs() < 0.1);
        assert!(bend_deg(28.0).abs() < 0.1 && bend_deg(-70.0).abs() < 0.1);
        let of_three = bends_of_rest_deg(DVec3::Y, &[-25.0; 3], Some(DQuat::IDENTITY));
        assert!(of_three.iter().all(|bend_deg| bend_deg.abs() < 0.1), "{of_three:?}");
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

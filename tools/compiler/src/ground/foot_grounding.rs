//! Poses on the target skeleton → poses whose planted feet stand on the ground at z = 0 and whose feet never sink.
//!
//! First the clip is shifted so that planted soles lie on the ground, half of the time a little over it. A foot of
//! other proportions, or one whose rig cannot bend its toes, rolls off through the ground: its toe tip comes down where
//! the performer's own was up. People's toes bend instead. So an ankle rises until heel and ball are on the ground,
//! knees giving way, and then the toes bend up until their tip is; where they cannot bend so far, the ankle rises for
//! the rest. World frame, Z up, metres, radians.

use std::ops::Range;

use glam::{DQuat, DVec3};
use motiondb::body::Joint;

use crate::ground::leg_ik;
use crate::ground::root_motion::percentile;
use crate::retarget::human_clip::{HumanBody, HumanPose};

/// The pad of a heel and the sole of a shoe give by about this much under a body's weight, m: so far a sole may sink.
const SOLE_GIVES_M: f64 = 0.01;
/// Toes bend up by 60° at most as a foot rolls off (published range of the first metatarsophalangeal joint: 60–70°),
/// rad.
const TOE_BEND_MAX_RAD: f64 = 60.0 * std::f64::consts::PI / 180.0;

/// Of heel, ball and toe tip those that stand before the toes bend, and all.
const HEEL_AND_BALL: Range<usize> = 0..2;
const WHOLE_SOLE: Range<usize> = 0..3;

/// Puts the feet on the ground; `is_planted` tells of a side and a frame whether that foot stands.
pub(crate) fn stand(poses: &mut [HumanPose], body: &HumanBody, is_planted: impl Fn(usize, usize) -> bool) {
    lower_to_ground(poses, body, is_planted);
    lift_soles(poses, body);
}

fn lower_to_ground(poses: &mut [HumanPose], body: &HumanBody, is_planted: impl Fn(usize, usize) -> bool) {
    let mut heights_m = Vec::new();
    for (frame, pose) in poses.iter().enumerate() {
        let joints = pose.forward_kinematics(body);
        let lowest_m = |side: usize| joints.sole_points_m(body, side).map(|point| point.z).into_iter().reduce(f64::min);
        heights_m.extend([0, 1].into_iter().filter(|&side| is_planted(side, frame)).filter_map(lowest_m));
    }
    let ground_m = percentile(&mut heights_m, 0.5);
    poses.iter_mut().for_each(|pose| pose.pelvis_m.z -= ground_m);
}

/// Lifts heels, balls and toe tips that lie deeper than a sole gives.
pub(crate) fn lift_soles(poses: &mut [HumanPose], body: &HumanBody) {
    for pose in poses {
        for side in 0..2 {
            raise_foot(pose, body, side, HEEL_AND_BALL);
            bend_toes(pose, body, side);
            raise_foot(pose, body, side, WHOLE_SOLE);
        }
    }
}

/// Raises an ankle until some of heel, ball and toe tip are on the ground.
fn raise_foot(pose: &mut HumanPose, body: &HumanBody, side: usize, points: Range<usize>) {
    let joints = pose.forward_kinematics(body);
    let lowest_m = joints.sole_points_m(body, side)[points].iter().map(|point| point.z).fold(f64::INFINITY, f64::min);
    let sunk_m = -SOLE_GIVES_M - lowest_m;
    if sunk_m > 0.0 {
        let ankle_m = joints.positions_m[Joint::FEET[side].index()];
        leg_ik::place_ankle(pose, body, side, ankle_m + DVec3::Z * sunk_m);
    }
}

fn bend_toes(pose: &mut HumanPose, body: &HumanBody, side: usize) {
    let joints = pose.forward_kinematics(body);
    let [foot, toe] = [Joint::FEET[side].index(), Joint::TOES[side].index()];
    let tip_m = joints.sole_points_m(body, side)[2];
    if tip_m.z < -SOLE_GIVES_M {
        let (toes_m, across) = (tip_m - joints.positions_m[toe], joints.orientations[foot] * DVec3::Y);
        let bend_rad = bend_to_height_rad(toes_m, across, -SOLE_GIVES_M - joints.positions_m[toe].z);
        pose.rotations[toe] = DQuat::from_rotation_y(bend_rad) * pose.rotations[toe];
    }
}

/// The least turn of a vector about an axis, toes up, after which its end is at a height, or as near as it comes.
fn bend_to_height_rad(vector_m: DVec3, axis: DVec3, height_m: f64) -> f64 {
    // Turned by θ, the vector has the height p + a·cos θ + b·sin θ = p + r·cos(θ − δ).
    let parallel_m = axis * axis.dot(vector_m);
    let (a, b) = (vector_m.z - parallel_m.z, axis.cross(vector_m).z);
    let (r, highest_rad) = (libm::hypot(a, b), libm::atan2(b, a));
    let bend_rad = highest_rad + libm::acos(((height_m - parallel_m.z) / r).clamp(-1.0, 1.0));
    bend_rad.clamp(-TOE_BEND_MAX_RAD, 0.0)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::retarget::human_clip::HumanClip;
    use crate::synthetic::{self, Walk};

    fn walk() -> HumanClip {
        synthetic::walk("walk", Walk::default())
    }

    /// The lowest of all soles once they are lifted.
    fn lowest_m(clip: &HumanClip) -> f64 {
        let mut poses = clip.frames.clone();
        lift_soles(&mut poses, &clip.body);
        let soles = poses.iter().flat_map(|pose| {
            let joints = pose.forward_kinematics(&clip.body);
            [0, 1].map(|side| joints.sole_points_m(&clip.body, side))
        });
        soles.flatten().map(|point| point.z).fold(f64::INFINITY, f64::min)
    }

    #[test]
    fn feet_that_stand_on_the_ground_stay_as_they_are() {
        let clip = walk();
        let mut poses = clip.frames.clone();
        lift_soles(&mut poses, &clip.body);
        assert_eq!(poses, clip.frames);
    }

    #[test]
    fn feet_that_sink_are_raised_to_the_ground() {
        let mut clip = walk();
        clip.frames.iter_mut().for_each(|pose| pose.pelvis_m.z -= 0.05);
        assert!(lowest_m(&clip) > -SOLE_GIVES_M - 1e-3, "{}", lowest_m(&clip));
    }

    #[test]
    fn toes_bend_up_where_they_would_sink() {
        for pitch_rad in [0.2, 0.4, 0.6, 1.5] {
            let mut clip = walk();
            for pose in &mut clip.frames {
                Joint::TOES.iter().for_each(|toe| pose.rotations[toe.index()] = DQuat::from_rotation_y(pitch_rad));
            }
            assert!(lowest_m(&clip) > -SOLE_GIVES_M - 1e-3, "{pitch_rad}: {}", lowest_m(&clip));
        }
    }
}

//! The pelvis comes down where a leg would have to stretch to reach its foot (`motion.md` §2: "lower the pelvis").
//!
//! With d_left and d_right the descents that the legs need to reach the targets, negative where they reach, and S(d) the
//! soft maximum of both and of none, the pelvis comes down by
//!
//! ```text
//! S(d) − S(d⁰)·e^((S(d⁰) − S(d))/s),   S(d) = s·ln(1 + e^(d_left/s) + e^(d_right/s)),
//! ```
//!
//! d⁰ being the descents to the pose's own feet: a pose whose feet are where they should be is left as it is, and one
//! whose feet are out of reach comes down by what is needed. It begins a little before it must: neither hips nor knee
//! jerk as the leg comes to its end. It depends on this step's pose alone. All vectors are in the root frame (x forward, y left, z up), metres.

use glam::Vec3;
use motiondb::pose::{Joints, Pose};
use motiondb::skeleton::{Joint, Skeleton};

use super::ik::FootTarget;

/// Straightest a leg may be before the pelvis comes down for it, as a share of its length; straighter only where the
/// pose is.
const EXTENSION: f32 = 0.99;
/// Furthest that the pelvis comes down, m.
const DROP_MAX_M: f32 = 0.12;
/// s, m: half of what the hips bob in walking. With 0.01 knees still snap at stops, with 0.02 they stay bent where they
/// need not.
const SOFTNESS_M: f32 = 0.015;

/// Lowers the pelvis of `pose`, and with it all of `joints`, its forward kinematics.
pub fn lower(pose: &mut Pose, joints: &mut Joints, skeleton: &Skeleton, targets: &[FootTarget; 2]) {
    let needed_m = |side: usize, ankle_m: Vec3| needed_m(joints, skeleton, side, ankle_m);
    let to_targets_m = [0, 1].map(|side| needed_m(side, targets[side].ankle_m));
    let to_own_m = [0, 1].map(|side| needed_m(side, joints.positions_m[Joint::FEET[side].index()]));
    let [asked_m, own_m] = [to_targets_m, to_own_m].map(soft_maximum_m);
    let drop_m = (asked_m - own_m * libm::expf((own_m - asked_m) / SOFTNESS_M)).clamp(0.0, DROP_MAX_M);
    pose.pelvis_m.z -= drop_m;
    joints.positions_m.iter_mut().for_each(|position_m| position_m.z -= drop_m);
}

/// d; infinite where it is far beyond what a pelvis can do.
fn soft_maximum_m(needed_m: [f32; 2]) -> f32 {
    let [left, right] = needed_m.map(|needed_m| libm::expf(needed_m / SOFTNESS_M));
    SOFTNESS_M * libm::logf(1.0 + left + right)
}

/// How far the hip must come down for its leg to reach an ankle's place without stretching more than the pose does; negative
/// if it reaches.
fn needed_m(joints: &Joints, skeleton: &Skeleton, side: usize, ankle_m: Vec3) -> f32 {
    let [thigh, shank, foot] = [Joint::THIGHS[side], Joint::SHANKS[side], Joint::FEET[side]].map(Joint::index);
    let hip_m = joints.positions_m[thigh];
    let leg_m = skeleton.offsets_m[shank].length() + skeleton.offsets_m[foot].length();
    let reach_m = (EXTENSION * leg_m).max(joints.positions_m[foot].distance(hip_m));
    let to_foot_m = ankle_m - hip_m;
    -to_foot_m.z - libm::sqrtf((reach_m * reach_m - to_foot_m.truncate().length_squared()).max(0.0))
}

#[cfg(test)]
mod tests {
    use glam::{Quat, Vec3};
    use motiondb::skeleton::JOINT_COUNT;

    use super::*;
    use crate::test_db::skeleton;

    /// Descent of a standing body whose right foot is left behind by this much, and the descent that its leg needs.
    fn lowered_m(behind_m: f32) -> (f32, f32) {
        let skeleton = skeleton();
        let mut pose = Pose { pelvis_m: skeleton.offsets_m[0], rotations: [Quat::IDENTITY; JOINT_COUNT] };
        let mut joints = pose.forward_kinematics(&skeleton);
        let target = |side: usize, x: f32| FootTarget {
            ankle_m: joints.positions_m[Joint::FEET[side].index()] + Vec3::new(x, 0.0, 0.0),
            orientation: Quat::IDENTITY,
        };
        let targets = [target(0, 0.0), target(1, -behind_m)];
        let needed_m = needed_m(&joints, &skeleton, 1, targets[1].ankle_m);
        lower(&mut pose, &mut joints, &skeleton, &targets);
        (skeleton.offsets_m[0].z - pose.pelvis_m.z, needed_m)
    }

    #[test]
    fn comes_down_far_enough_and_without_a_jerk() {
        let step_m = 0.01;
        let lowered_m: Vec<(f32, f32)> = (0..40).map(|step| lowered_m(step as f32 * step_m)).collect();
        // A leg has another 7 mm between EXTENSION and its end.
        assert!(lowered_m.iter().all(|&(drop_m, needed_m)| drop_m >= needed_m - 0.003));
        let slopes: Vec<f32> = lowered_m.windows(2).map(|pair| (pair[1].0 - pair[0].0) / step_m).collect();
        assert!(slopes.windows(2).all(|pair| (pair[1] - pair[0]).abs() < 0.05), "{slopes:?}");
    }

    #[test]
    fn a_pose_whose_feet_are_where_they_should_be_is_left_as_it_is() {
        assert!(lowered_m(0.0).0.abs() < 1e-6);
    }

    #[test]
    fn a_foot_out_of_all_reach_takes_it_down_no_further_than_a_crouch() {
        assert!((lowered_m(100.0).0 - DROP_MAX_M).abs() < 1e-6);
    }
}

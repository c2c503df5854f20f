//! Two-bone leg inverse kinematics: moves an ankle to a target and keeps the orientation of the foot.
//!
//! Unlike a solver that starts from bare bones, it changes a recorded pose as little as possible. Three steps:
//! 1. Flex the knee about its own axis, forward, until hip and ankle have the target's distance (law of cosines).
//! 2. Swing the whole leg onto the target by the shortest arc.
//! 3. Turn the foot back to the orientation that it had.
//!
//! Positions and orientations are those of the pose's own frame: metres, radians.

use glam::{DQuat, DVec3};
use motiondb::body::Joint;

use crate::retarget::human_clip::{HumanBody, HumanJoints, HumanPose};

/// Greatest distance of hip and ankle, share of thigh plus shank. Near 1 the knee's angle changes without bound.
const REACH_MAX: f64 = 0.9995;
/// Share of thigh plus shank (a knee flexed by 6°) from which the leg straightens less and less, to stop without a
/// jerk. Takes half a millimetre from a straight leg.
const REACH_SOFT: f64 = 0.9985;
/// Least distance of hip and ankle, as a multiple of the difference in length of thigh and shank.
const REACH_MIN: f64 = 1.01;
/// Weight of the thigh's left axis in the axis of a straight knee, as the sine of a flexion: 3°.
const STRAIGHT_LEAN: f64 = 0.05;

/// Moves one ankle to `target_m`, or as near as the leg reaches. The foot keeps its orientation.
pub(crate) fn place_ankle(pose: &mut HumanPose, body: &HumanBody, side: usize, target_m: DVec3) {
    let joints = pose.forward_kinematics(body);
    let [thigh, shank, foot] = [Joint::THIGHS[side].index(), Joint::SHANKS[side].index(), Joint::FEET[side].index()];
    let (hip_m, knee_m, ankle_m) = (joints.positions_m[thigh], joints.positions_m[shank], joints.positions_m[foot]);

    let (thigh_m, shank_m) = (knee_m - hip_m, ankle_m - knee_m);
    let flexion_rad = knee_flexion_rad(thigh_m.length(), shank_m.length(), (target_m - hip_m).length());
    let flexed = DQuat::from_axis_angle(knee_axis(&joints, side), flexion_rad) * thigh_m.normalize();
    let bend = DQuat::from_rotation_arc(shank_m.normalize(), flexed);
    let bent_ankle_m = knee_m + bend * (ankle_m - knee_m);
    let swing = DQuat::from_rotation_arc((bent_ankle_m - hip_m).normalize(), (target_m - hip_m).normalize());

    let pelvis = joints.orientations[0];
    let thigh_world = swing * joints.orientations[thigh];
    let shank_world = swing * bend * joints.orientations[shank];
    pose.rotations[thigh] = pelvis.inverse() * thigh_world;
    pose.rotations[shank] = thigh_world.inverse() * shank_world;
    pose.rotations[foot] = shank_world.inverse() * joints.orientations[foot];
}

/// Moves one ankle to `ankle_m`, or as near as the leg reaches, and gives the foot an orientation.
pub(crate) fn place_foot(pose: &mut HumanPose, body: &HumanBody, side: usize, ankle_m: DVec3, orientation: DQuat) {
    place_ankle(pose, body, side, ankle_m);
    let shank = pose.forward_kinematics(body).orientations[Joint::SHANKS[side].index()];
    pose.rotations[Joint::FEET[side].index()] = shank.inverse() * orientation;
}

/// The axis about which the knee flexes: across the leg's plane, on the side of the thigh's left axis.
///
/// Three cases:
/// - a bent knee: the normal of its plane;
/// - a nearly straight leg has no plane: the normal leans on the thigh's left axis, by an amount that a bent knee does
///   not feel;
/// - a knee that bends backward: its flexion about the left axis changes sign. Its sideways part stays, so that the
///   axis never jumps.
fn knee_axis(joints: &HumanJoints, side: usize) -> DVec3 {
    let position = |joint: Joint| joints.positions_m[joint.index()];
    let thigh = position(Joint::SHANKS[side]) - position(Joint::THIGHS[side]);
    let shank = position(Joint::FEET[side]) - position(Joint::SHANKS[side]);
    let left = joints.orientations[Joint::THIGHS[side].index()] * DVec3::Y;
    let normal = thigh.cross(shank) / (thigh.length() * shank.length());
    let (along, straight) = (normal.dot(left), 1.0 - normal.length());
    let lean = STRAIGHT_LEAN * straight * straight * straight * straight;
    let axis = normal + left * (along.abs() - along + lean);
    (axis - thigh * (axis.dot(thigh) / thigh.length_squared())).normalize()
}

/// Flexion of the knee at which hip and ankle are `reach_m` apart, rad.
fn knee_flexion_rad(thigh_m: f64, shank_m: f64, reach_m: f64) -> f64 {
    let (a, b) = (thigh_m, shank_m);
    let reach = softened(reach_m.max(REACH_MIN * (a - b).abs()), a + b);
    libm::acos(((reach * reach - a * a - b * b) / (2.0 * a * b)).clamp(-1.0, 1.0))
}

/// The requested reach, but never more than [`REACH_MAX`] of a leg, which it approaches ever more slowly.
fn softened(reach_m: f64, leg_m: f64) -> f64 {
    let (from_m, room_m) = (REACH_SOFT * leg_m, (REACH_MAX - REACH_SOFT) * leg_m);
    if reach_m <= from_m { reach_m } else { from_m + room_m * (1.0 - libm::exp((from_m - reach_m) / room_m)) }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::synthetic::{self, SyntheticWalk};

    /// The ankle arrives, the foot keeps its orientation and the knee its side, in every pose of a walk.
    #[track_caller]
    fn check_reach(offset_m: DVec3) {
        let clip = synthetic::walk("walk", SyntheticWalk::default());
        for pose in &clip.frames {
            for side in 0..2 {
                let foot = Joint::FEET[side].index();
                let before = pose.forward_kinematics(&clip.body);
                let mut moved = pose.clone();
                place_ankle(&mut moved, &clip.body, side, before.positions_m[foot] + offset_m);
                let after = moved.forward_kinematics(&clip.body);
                assert!(after.positions_m[foot].distance(before.positions_m[foot] + offset_m) < 1e-3);
                assert!(after.orientations[foot].angle_between(before.orientations[foot]) < 1e-6);
                let [hip, knee] = [Joint::THIGHS[side], Joint::SHANKS[side]].map(|j| after.positions_m[j.index()]);
                let bulge = (knee - hip).cross(after.positions_m[foot] - knee);
                let left = after.orientations[Joint::THIGHS[side].index()] * DVec3::Y;
                assert!(bulge.dot(left) > -1e-6, "a knee bends backward: {bulge}");
            }
        }
    }

    #[test]
    fn ankles_reach_targets_within_the_leg() {
        check_reach(DVec3::ZERO);
        check_reach(DVec3::new(0.02, -0.03, 0.05));
    }

    #[test]
    fn legs_straighten_towards_targets_out_of_reach() {
        let clip = synthetic::walk("walk", SyntheticWalk::default());
        let mut pose = clip.frames[0].clone();
        let hip_m = pose.forward_kinematics(&clip.body).positions_m[Joint::LeftThigh.index()];
        place_ankle(&mut pose, &clip.body, 0, hip_m + DVec3::new(0.0, 0.3, -2.0));
        let ankle_m = pose.forward_kinematics(&clip.body).positions_m[Joint::LeftFoot.index()] - hip_m;
        assert!(ankle_m.normalize().dot(DVec3::new(0.0, 0.3, -2.0).normalize()) > 0.999_99);
        assert!((ankle_m.length() - 0.84).abs() < 2e-3, "{}", ankle_m.length());
    }

    #[test]
    fn knees_that_bend_backward_turn_forward_without_a_jump() {
        let clip = synthetic::walk("walk", SyntheticWalk::default());
        let [thigh, shank, foot] = [Joint::LeftThigh, Joint::LeftShank, Joint::LeftFoot].map(Joint::index);
        let knee_m = |flexion_rad: f64| {
            let mut pose = clip.frames[0].clone();
            pose.rotations[shank] = DQuat::from_rotation_x(0.03) * DQuat::from_rotation_y(flexion_rad);
            let target_m = pose.forward_kinematics(&clip.body).positions_m[foot];
            place_ankle(&mut pose, &clip.body, 0, target_m);
            let placed = pose.forward_kinematics(&clip.body);
            let [hip_m, knee_m, ankle_m] = [thigh, shank, foot].map(|joint| placed.positions_m[joint]);
            let bulge = (knee_m - hip_m).cross(ankle_m - knee_m);
            assert!(bulge.dot(placed.orientations[thigh] * DVec3::Y) > 0.0, "{flexion_rad}: {bulge}");
            assert!(ankle_m.distance(target_m) < 2e-3, "{flexion_rad}: {ankle_m}, not {target_m}");
            knee_m
        };
        for step in -150..150 {
            let flexion_rad = 0.001 * f64::from(step);
            let moved_m = knee_m(flexion_rad).distance(knee_m(flexion_rad + 0.001));
            assert!(moved_m < 2e-3, "{flexion_rad}: {moved_m} m");
        }
    }

    #[test]
    fn legs_straighten_without_a_jerk() {
        let steps: Vec<f64> = (0..400).map(|step| softened(0.8 + 0.0001 * f64::from(step), 0.83)).collect();
        assert!(steps.windows(2).all(|pair| pair[0] < pair[1]) && steps[399] <= REACH_MAX * 0.83);
        let flexion = |reach_m: f64| 2.0 * libm::acos(reach_m / 0.83);
        for near in steps.windows(3) {
            let change = flexion(near[0]) - 2.0 * flexion(near[1]) + flexion(near[2]);
            assert!(change.abs() < 1e-3, "{near:?}: {change}");
        }
    }
}

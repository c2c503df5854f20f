//! Two-bone leg inverse kinematics: puts an ankle where it should be and keeps the foot's orientation.
//!
//! Three steps: bend the knee about its own axis until hip to ankle has the wanted length; swing the whole leg onto the
//! target by the shortest arc; turn the foot back to the orientation that it had. Positions and orientations are those
//! of the pose's own frame.

use glam::{DQuat, DVec3};
use motiondb::skeleton::Joint;

use crate::human_clip::{HumanBody, HumanJoints, HumanPose};

/// The leg never straightens beyond this share of thigh plus shank: near 1 the knee's angle changes without bound.
const REACH_MAX: f64 = 0.9995;
/// Nor folds closer than this multiple of their difference.
const REACH_MIN: f64 = 1.01;

/// Moves one ankle to `target_m`, or as near as the leg reaches; the foot keeps its orientation.
pub fn place_ankle(pose: &mut HumanPose, body: &HumanBody, side: usize, target_m: DVec3) {
    let joints = pose.forward_kinematics(body);
    let [thigh, shank, foot] = [Joint::THIGHS[side].index(), Joint::SHANKS[side].index(), Joint::FEET[side].index()];
    let (hip_m, knee_m, ankle_m) = (joints.positions_m[thigh], joints.positions_m[shank], joints.positions_m[foot]);

    let bend = DQuat::from_axis_angle(
        knee_axis(&joints, side),
        knee_angle_change(knee_m - hip_m, ankle_m - knee_m, (target_m - hip_m).length()),
    );
    let bent_ankle_m = knee_m + bend * (ankle_m - knee_m);
    let swing = DQuat::from_rotation_arc((bent_ankle_m - hip_m).normalize(), (target_m - hip_m).normalize());

    let pelvis = joints.orientations[0];
    let thigh_world = swing * joints.orientations[thigh];
    let shank_world = swing * bend * joints.orientations[shank];
    pose.rotations[thigh] = pelvis.inverse() * thigh_world;
    pose.rotations[shank] = thigh_world.inverse() * shank_world;
    pose.rotations[foot] = shank_world.inverse() * joints.orientations[foot];
}

/// The axis about which the knee flexes: across the leg's plane, on the side of the thigh's own left axis.
fn knee_axis(joints: &HumanJoints, side: usize) -> DVec3 {
    let position = |joint: Joint| joints.positions_m[joint.index()];
    let thigh = position(Joint::SHANKS[side]) - position(Joint::THIGHS[side]);
    let shank = position(Joint::FEET[side]) - position(Joint::SHANKS[side]);
    let left = joints.orientations[Joint::THIGHS[side].index()] * DVec3::Y;
    // A nearly straight leg has no plane of its own: lean on the thigh's axis, by an amount that a bent knee does not
    // feel.
    let normal = thigh.cross(shank) / (thigh.length() * shank.length());
    let normal = if normal.dot(left) < 0.0 { -normal } else { normal };
    let axis = normal + 0.05 * left;
    (axis - thigh * (axis.dot(thigh) / thigh.length_squared())).normalize()
}

/// How much more the knee must flex for hip and ankle to be `reach_m` apart.
fn knee_angle_change(thigh: DVec3, shank: DVec3, reach_m: f64) -> f64 {
    let (a, b) = (thigh.length(), shank.length());
    let reach = reach_m.clamp(REACH_MIN * (a - b).abs(), REACH_MAX * (a + b));
    let cos_wanted = (reach * reach - a * a - b * b) / (2.0 * a * b);
    let cos_now = thigh.dot(shank) / (a * b);
    libm::acos(cos_wanted.clamp(-1.0, 1.0)) - libm::acos(cos_now.clamp(-1.0, 1.0))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::synthetic::{self, Walk};

    /// The ankle arrives, the foot keeps its orientation and the knee its side, in every pose of a walk.
    fn check_reach(off_m: DVec3, tolerance_m: f64) {
        let clip = synthetic::walk("walk", Walk::default());
        for pose in &clip.frames {
            for side in 0..2 {
                let foot = Joint::FEET[side].index();
                let before = pose.forward_kinematics(&clip.body);
                let mut moved = pose.clone();
                place_ankle(&mut moved, &clip.body, side, before.positions_m[foot] + off_m);
                let after = moved.forward_kinematics(&clip.body);
                assert!(after.positions_m[foot].distance(before.positions_m[foot] + off_m) < tolerance_m);
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
        check_reach(DVec3::ZERO, 1e-3);
        check_reach(DVec3::new(0.02, -0.03, 0.05), 1e-3);
    }

    #[test]
    fn a_target_out_of_reach_straightens_the_leg_towards_it() {
        let clip = synthetic::walk("walk", Walk::default());
        let mut pose = clip.frames[0].clone();
        let hip_m = pose.forward_kinematics(&clip.body).positions_m[Joint::LeftThigh.index()];
        place_ankle(&mut pose, &clip.body, 0, hip_m + DVec3::new(0.0, 0.3, -2.0));
        let ankle_m = pose.forward_kinematics(&clip.body).positions_m[Joint::LeftFoot.index()] - hip_m;
        assert!(ankle_m.normalize().dot(DVec3::new(0.0, 0.3, -2.0).normalize()) > 0.999_99);
        assert!((ankle_m.length() - 0.84).abs() < 2e-3, "{}", ankle_m.length());
    }
}

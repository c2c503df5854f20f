//! How a pose tilts: about its pelvis, and its trunk above it by another angle. The head keeps its orientation: the gaze
//! stays level.
//!
//! Root frame (x forward, y left, z up), radians. A tilt is a vector: its direction, and its angle as its length.

use glam::{Quat, Vec2};
use motiondb::body::{Joint, Pose};

use crate::maths::angle::rotation;

/// Share of the lean of a body by which its trunk tilts: 2.6° for each m/s², in a start, which the filter evens out, half
/// a degree. In captured circles the trunk tilts by half of what the legs lean.
pub(crate) const TRUNK_SHARE: f32 = 0.45;
/// Tilt below which the pose is left unchanged, rad.
const UPRIGHT_RAD: f32 = 1e-4;
/// Joints from the foot of the spine to the neck, which carry the head.
const TRUNK: [Joint; 4] = [Joint::SpineLower, Joint::SpineMiddle, Joint::SpineUpper, Joint::Neck];

/// Whether a tilt leaves a pose unchanged.
pub(crate) fn is_upright(tilt_rad: Vec2) -> bool {
    tilt_rad.length_squared() < UPRIGHT_RAD * UPRIGHT_RAD
}

/// Tilts the trunk of a pose.
pub(crate) fn tilt_trunk(pose: &mut Pose, tilt_rad: Vec2) {
    if !is_upright(tilt_rad) {
        incline(pose, Vec2::ZERO, tilt_rad);
    }
}

/// Tilts a pose about its pelvis, and its trunk by `trunk_rad` in all. Returns the turn of the pelvis.
pub(crate) fn incline(pose: &mut Pose, pelvis_rad: Vec2, trunk_rad: Vec2) -> Quat {
    let before = pose.rotations[Joint::Pelvis.index()];
    // The axis of a tilt is z × tilt.
    let turn = rotation(pelvis_rad.perp().extend(0.0));
    let pelvis = turn * before;
    let beyond = rotation((trunk_rad - pelvis_rad).perp().extend(0.0));
    let neck = before * TRUNK.iter().fold(Quat::IDENTITY, |chain, joint| chain * pose.rotations[joint.index()]);
    pose.rotations[Joint::Pelvis.index()] = pelvis;
    let spine = &mut pose.rotations[TRUNK[0].index()];
    *spine = pelvis.conjugate() * beyond * pelvis * *spine;
    let head = &mut pose.rotations[Joint::Head.index()];
    *head = (beyond * turn * neck).conjugate() * neck * *head;
    turn
}

#[cfg(test)]
mod tests {
    use motiondb::body::Joints;

    use super::*;
    use crate::test_db::test_db;

    /// Joints of a pose before and after a tilt about the pelvis and of the trunk.
    fn tilted(pelvis_rad: Vec2, trunk_rad: Vec2) -> [Joints; 2] {
        let db = test_db();
        let before = db.rows.pose(2, 10);
        let mut pose = before;
        incline(&mut pose, pelvis_rad, trunk_rad);
        [before, pose].map(|pose| pose.forward_kinematics(&db.skeleton))
    }

    /// Change of the direction from one joint to another, forward and left.
    fn moved([before, after]: &[Joints; 2], from: Joint, to: Joint) -> Vec2 {
        let direction =
            |joints: &Joints| (joints.positions_m[to.index()] - joints.positions_m[from.index()]).normalize();
        (direction(after) - direction(before)).truncate()
    }

    #[test]
    fn the_trunk_tilts_and_the_head_stays_level() {
        let trunk_rad = Vec2::new(0.05, -0.03);
        let joints = tilted(Vec2::ZERO, trunk_rad);
        assert!(moved(&joints, Joint::SpineLower, Joint::Neck).distance(trunk_rad) < 5e-3);
        let [before, after] = joints.map(|joints| joints.orientations[Joint::Head.index()]);
        assert!(after.angle_between(before) < 1e-3);
    }

    #[test]
    fn the_trunk_of_a_leaning_body_tilts_less() {
        let joints = tilted(Vec2::new(0.0, 0.1), Vec2::new(0.0, 0.05));
        assert!(moved(&joints, Joint::SpineLower, Joint::Neck).distance(Vec2::new(0.0, 0.05)) < 5e-3);
        assert!(moved(&joints, Joint::LeftFoot, Joint::LeftThigh).distance(Vec2::new(0.0, 0.1)) < 0.02);
        let [before, after] = joints.map(|joints| joints.orientations[Joint::Head.index()]);
        assert!(after.angle_between(before) < 1e-3);
    }

    #[test]
    fn legs_do_not_depend_on_the_trunk() {
        let [before, after] = tilted(Vec2::ZERO, Vec2::new(0.05, -0.03));
        let legs = Joint::LeftThigh.index()..;
        assert_eq!(after.positions_m[legs.clone()], before.positions_m[legs]);
    }
}

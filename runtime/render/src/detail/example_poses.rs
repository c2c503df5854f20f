//! Poses in which a reduced mesh must look as before: at rest, and both sides of a long stride. World, metres.

use glam::{Quat, Vec2, Vec3};
use motiondb::body::{JOINT_COUNT, Joint, Pose, Root, Skeleton};
use motiondb::character::CharacterFit;

/// Number of poses.
pub(super) const POSES: usize = 3;
/// Bends of a stride with the left leg ahead: joint, axis, angle, °. The arms hang, the left one bent.
const STRIDE: [(Joint, Vec3, f32); 8] = [
    (Joint::LeftThigh, Vec3::Y, -45.0),
    (Joint::LeftShank, Vec3::Y, 75.0),
    (Joint::RightThigh, Vec3::Y, 20.0),
    (Joint::RightToe, Vec3::Y, -30.0),
    (Joint::LeftUpperArm, Vec3::X, -75.0),
    (Joint::RightUpperArm, Vec3::X, 75.0),
    (Joint::LeftForearm, Vec3::Z, -70.0),
    (Joint::SpineMiddle, Vec3::Y, 15.0),
];

/// Positions of all vertices in each pose, m.
pub(super) fn posed_m(fit: &CharacterFit, skeleton: &Skeleton) -> [Vec<Vec3>; POSES] {
    let right_ahead = STRIDE.map(|(joint, axis, angle_deg)| {
        // Mirrored left to right, turns about y stay, and those about x and z are reversed.
        (joint.mirrored(), axis, if axis == Vec3::Y { angle_deg } else { -angle_deg })
    });
    [&[][..], &STRIDE, &right_ahead].map(|bends| {
        let joints = standing(skeleton, bends).forward_kinematics(skeleton);
        let root = Root { position_m: Vec2::ZERO, facing_rad: 0.0 };
        let (mut transforms, mut positions_m, mut normals) = (Vec::new(), Vec::new(), Vec::new());
        fit.pose(skeleton, &joints, root.frame(), &mut transforms);
        fit.character.mesh.skin(&transforms, &mut positions_m, &mut normals);
        positions_m
    })
}

/// The resting body with some joints bent.
fn standing(skeleton: &Skeleton, bends: &[(Joint, Vec3, f32)]) -> Pose {
    let mut pose = Pose { pelvis_m: Vec3::ZERO, rotations: [Quat::IDENTITY; JOINT_COUNT] };
    let soles_m = pose.forward_kinematics(skeleton).sole_points_m(skeleton, 0);
    pose.pelvis_m.z = -soles_m[0].z;
    for (joint, axis, angle_deg) in bends {
        pose.rotations[joint.index()] = Quat::from_axis_angle(*axis, angle_deg.to_radians());
    }
    pose
}

//! Poses → BVH text: centimetres, Y up, Z forward, X to the body's left; 30 frames per second.
//!
//! The generator's frame (x forward, y left, z up) becomes BVH's by (X, Y, Z) = (y, z, x), which keeps it right-handed.
//! Angles are intrinsic in the order of their channels: Z X Y, but Z Y X in the legs, whose turn about X (the knee's
//! fold) can pass 90°, where the middle angle of an order is singular. Four decimals: 1 µm and 2 µrad.

use std::fmt::Write;

use glam::{DMat3, DQuat, DVec3};

use crate::body::ClipPose;
use crate::body::skeleton::{JOINT_COUNT, JointAtRest, THIGHS, joints_at_rest};
use crate::plan::FRAME_RATE_HZ;

/// Centimetres per metre.
const CENTIMETRES: f64 = 100.0;

/// The bytes of a BVH file.
pub(crate) fn bvh_bytes(poses: &[ClipPose]) -> Vec<u8> {
    let joints = joints_at_rest();
    let mut text = String::from("HIERARCHY\n");
    write_joint(&mut text, &joints, 0, 0);
    let _ = write!(text, "MOTION\nFrames: {}\nFrame Time: {:.8}\n", poses.len(), 1.0 / FRAME_RATE_HZ);
    let mut heading_deg = 0.0;
    for pose in poses {
        write_frame(&mut text, &joints, pose, &mut heading_deg);
    }
    text.into_bytes()
}

/// Writes a joint and, indented, its children.
fn write_joint(text: &mut String, joints: &[JointAtRest; JOINT_COUNT], index: usize, depth: usize) {
    let joint = &joints[index];
    let indent = "  ".repeat(depth);
    let offset = to_bvh(joint.offset_m) * CENTIMETRES;
    let kind = if index == 0 { "ROOT" } else { "JOINT" };
    let channels = match (index, folds_about_x(index)) {
        (0, _) => "6 Xposition Yposition Zposition Zrotation Xrotation Yrotation",
        (_, true) => "3 Zrotation Yrotation Xrotation",
        (_, false) => "3 Zrotation Xrotation Yrotation",
    };
    // Writing to a string cannot fail.
    let _ = writeln!(text, "{indent}{kind} {}\n{indent}{{", joint.name);
    let _ = writeln!(text, "{indent}  OFFSET {:.4} {:.4} {:.4}", plain(offset.x), plain(offset.y), plain(offset.z));
    let _ = writeln!(text, "{indent}  CHANNELS {channels}");
    if let Some(end_m) = joint.end_m {
        let end = to_bvh(end_m) * CENTIMETRES;
        let _ = writeln!(text, "{indent}  End Site\n{indent}  {{");
        let _ = writeln!(text, "{indent}    OFFSET {:.4} {:.4} {:.4}", plain(end.x), plain(end.y), plain(end.z));
        let _ = writeln!(text, "{indent}  }}");
    }
    for child in index + 1..JOINT_COUNT {
        if joints[child].parent == index {
            write_joint(text, joints, child, depth + 1);
        }
    }
    let _ = writeln!(text, "{indent}}}");
}

/// Writes one frame as a line. The root's yaw is unbroken: within 180° of the frame before.
fn write_frame(text: &mut String, joints: &[JointAtRest; JOINT_COUNT], pose: &ClipPose, heading_deg: &mut f64) {
    let hips = to_bvh(pose.hips_m) * CENTIMETRES;
    let _ = write!(text, "{:.4} {:.4} {:.4}", plain(hips.x), plain(hips.y), plain(hips.z));
    for (index, joint) in joints.iter().enumerate() {
        if joint.end_m == Some(DVec3::ZERO) {
            text.push_str(" 0 0 0");
            continue;
        }
        let mut angles = angles_deg(pose.rotations[index], folds_about_x(index));
        if index == 0 {
            angles[2] -= 360.0 * libm::round((angles[2] - *heading_deg) / 360.0);
            *heading_deg = angles[2];
        }
        for angle in angles {
            let _ = write!(text, " {:.4}", plain(angle));
        }
    }
    text.push('\n');
}

/// Whether a joint folds about X: hip and knee.
fn folds_about_x(index: usize) -> bool {
    THIGHS.iter().any(|thigh| (*thigh..=thigh + 1).contains(&index))
}

/// Angles in the order of the channels, degrees.
fn angles_deg(rotation: DQuat, folds_about_x: bool) -> [f64; 3] {
    let q = DQuat::from_xyzw(rotation.y, rotation.z, rotation.x, rotation.w);
    let m = DMat3::from_quat(q);
    let at = |row: usize, column: usize| m.col(column)[row];
    let radians = if folds_about_x {
        // R = Rz Ry Rx
        [libm::atan2(at(1, 0), at(0, 0)), libm::asin((-at(2, 0)).clamp(-1.0, 1.0)), libm::atan2(at(2, 1), at(2, 2))]
    } else {
        // R = Rz Rx Ry
        [libm::atan2(-at(0, 1), at(1, 1)), libm::asin(at(2, 1).clamp(-1.0, 1.0)), libm::atan2(-at(2, 0), at(2, 2))]
    };
    radians.map(f64::to_degrees)
}

/// A vector of the generator's frame in BVH's.
fn to_bvh(v: DVec3) -> DVec3 {
    DVec3::new(v.y, v.z, v.x)
}

/// A value that does not round to a negative zero at four decimals.
fn plain(value: f64) -> f64 {
    if value.abs() < 5e-5 { 0.0 } else { value }
}

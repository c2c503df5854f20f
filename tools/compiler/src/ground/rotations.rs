//! Rotations as the stages of the compiler compare and interpolate them: hemispheres, rotation vectors, turns on the
//! ground.
//!
//! A rotation is both q and −q. Component-wise sums of quaternions need the same sign in all of them. Angles in
//! radians, counter-clockwise from above.

use glam::{DMat2, DQuat, DVec2, DVec3};
use motiondb::body::JOINT_COUNT;

use crate::retarget::human_clip::HumanPose;

/// A rotation of the ground plane.
pub(crate) fn ground_rotation(angle_rad: f64) -> DMat2 {
    let (sin, cos) = libm::sincos(angle_rad);
    DMat2::from_cols(DVec2::new(cos, sin), DVec2::new(-sin, cos))
}

/// Axis times angle of a rotation, by the shorter arc, rad.
pub(crate) fn rotation_vector(rotation: DQuat) -> DVec3 {
    (if rotation.w < 0.0 { -rotation } else { rotation }).to_scaled_axis()
}

/// Flips quaternions into the hemispheres of a reference; returns the flipped joints, one bit each.
pub(crate) fn align_hemispheres(rotations: &mut [DQuat; JOINT_COUNT], reference: &[DQuat; JOINT_COUNT]) -> u32 {
    let mut flipped = 0;
    for (joint, (rotation, reference)) in rotations.iter_mut().zip(reference).enumerate() {
        if rotation.dot(*reference) < 0.0 {
            *rotation = -*rotation;
            flipped |= 1 << joint;
        }
    }
    flipped
}

/// Negates the quaternions of some joints, one bit each.
pub(crate) fn flip(rotations: &mut [DQuat; JOINT_COUNT], joints: u32) {
    for (joint, rotation) in rotations.iter_mut().enumerate() {
        if joints >> joint & 1 == 1 {
            *rotation = -*rotation;
        }
    }
}

/// Flips the quaternions of each pose into the hemispheres of the pose before, so that they interpolate by component.
pub(crate) fn align_successive(poses: &mut [HumanPose]) {
    for frame in 1..poses.len() {
        let (before, after) = poses.split_at_mut(frame);
        align_hemispheres(&mut after[0].rotations, &before[frame - 1].rotations);
    }
}

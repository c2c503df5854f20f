//! The skeleton of a database: bones, girths by stature, joint limits that hold every pose.
//!
//! Enters: the target body and the poses of examples and actions. Leaves: [`motiondb::body::Skeleton`] in its rest pose (a
//! T-pose; x forward, y left, z up), metres, joint limits as rotation vectors in radians.

use glam::{DQuat, DVec3, Vec3};
use motiondb::body::{Foot, JOINT_COUNT, JOINT_RANGES_DEG, Joint, Skeleton};

use crate::database::segment_radii::SEGMENT_RADII_PER_STATURE;
use crate::ground::foot_grounding::lowest_sole_m;
use crate::ground::rotations::rotation_vector;
use crate::retarget::human_clip::{HumanBody, HumanPose};

/// The skeleton of a body; its joint limits hold all poses.
pub(crate) fn skeleton<'a>(body: &HumanBody, poses: impl Iterator<Item = &'a HumanPose>) -> Skeleton {
    let rotations = [DQuat::IDENTITY; JOINT_COUNT];
    let rest = HumanPose { pelvis_m: DVec3::ZERO, rotations, extra: Box::default() }.forward_kinematics(body);
    let sole_m = lowest_sole_m(&rest, body, 0).min(lowest_sole_m(&rest, body, 1));
    let crown_m = rest.positions_m[Joint::Head.index()].z + body.segment_ends_m[Joint::Head.index()].z;
    let stature_m = crown_m - sole_m;
    let mut offsets_m = body.offsets_m.map(|offset| offset.as_vec3());
    offsets_m[0] = Vec3::new(0.0, 0.0, -sole_m as f32);
    Skeleton {
        offsets_m,
        segment_ends_m: body.segment_ends_m.map(|end| end.as_vec3()),
        segment_radii_m: SEGMENT_RADII_PER_STATURE.map(|radius| (radius * stature_m) as f32),
        limits_rad: limits_rad(poses),
        feet: [0, 1].map(|side| {
            let [heel_m, ball_m, toe_tip_m] = body.soles_m[side].map(|point| point.as_vec3());
            Foot { heel_m, ball_m, toe_tip_m, measured_m: body.measured_m[side].map(|point| point.as_vec3()) }
        }),
    }
}

/// The skeleton of a body without cycles: its joint limits are the published ones.
pub fn body_skeleton(body: &HumanBody) -> Skeleton {
    skeleton(body, std::iter::empty())
}

/// Published joint ranges, widened where a pose goes beyond them: limits never forbid what the clips do.
fn limits_rad<'a>(poses: impl Iterator<Item = &'a HumanPose>) -> [[Vec3; 2]; JOINT_COUNT] {
    let mut limits = JOINT_RANGES_DEG.map(|range| range.map(|degrees| Vec3::from_array(degrees.map(f32::to_radians))));
    for row in poses {
        for (range, rotation) in limits.iter_mut().zip(&row.rotations) {
            let vector_rad = rotation_vector(*rotation).as_vec3();
            *range = [range[0].min(vector_rad), range[1].max(vector_rad)];
        }
    }
    limits
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::synthetic::{self, SyntheticWalk, cycle_of};

    #[test]
    fn limits_hold_every_row() {
        let clip = synthetic::walk("walk", SyntheticWalk::default());
        let cycle = cycle_of(&clip);
        let skeleton = skeleton(&clip.body, cycle.rows.iter());
        for row in &cycle.rows {
            for (rotation, [least, greatest]) in row.rotations.iter().zip(skeleton.limits_rad) {
                let vector_rad = rotation_vector(*rotation).as_vec3();
                assert!(vector_rad.cmpge(least).all() && vector_rad.cmple(greatest).all());
            }
        }
    }

    #[test]
    fn the_standing_pelvis_is_as_high_as_the_legs() {
        let skeleton = skeleton(&synthetic::body(1.0), std::iter::empty());
        assert!((skeleton.offsets_m[0].z - 0.93).abs() < 1e-6);
    }

    #[test]
    fn published_limits_are_mirror_images() {
        for joint in Joint::ALL {
            let [least, greatest] = JOINT_RANGES_DEG[joint.index()];
            let [mirrored_least, mirrored_greatest] = JOINT_RANGES_DEG[joint.mirrored().index()];
            // A rotation vector's x and z change sign in the mirror y = 0, its y does not.
            assert_eq!([-greatest[0], least[1], -greatest[2]], mirrored_least, "{}", joint.name());
            assert_eq!([-least[0], greatest[1], -least[2]], mirrored_greatest, "{}", joint.name());
            let radius = SEGMENT_RADII_PER_STATURE[joint.index()];
            assert_eq!(radius, SEGMENT_RADII_PER_STATURE[joint.mirrored().index()]);
        }
    }
}

//! Skeleton and velocity sets in a header of version 1.

use glam::{Vec2, Vec3};
use motiondb::body::{Foot, Skeleton};
use motiondb::velocity_sets::velocity_hull::{Construction, VelocityHull};
use serde::Deserialize;

/// Number of joints of version 1.
const JOINT_COUNT_V1: usize = 22;

#[derive(Deserialize)]
pub(super) struct SkeletonV1 {
    offsets_m: [Vec3; JOINT_COUNT_V1],
    segment_ends_m: [Vec3; JOINT_COUNT_V1],
    segment_radii_m: [f32; JOINT_COUNT_V1],
    limits_rad: [[Vec3; 2]; JOINT_COUNT_V1],
    feet: [FootV1; 2],
}

#[derive(Deserialize)]
struct FootV1 {
    heel_m: Vec3,
    ball_m: Vec3,
    toe_tip_m: Vec3,
    measured_m: [Vec3; 3],
}

#[derive(Deserialize)]
pub(super) struct VelocityHullV1 {
    construction: ConstructionV1,
    turning_mps: Vec<Vec2>,
    holding_mps: Vec<Vec2>,
    sharp_turn_edges_mps: Vec<[Vec2; 2]>,
}

#[derive(Deserialize)]
enum ConstructionV1 {
    TurningAndHolding,
    Paper,
}

impl From<SkeletonV1> for Skeleton {
    fn from(skeleton: SkeletonV1) -> Self {
        let SkeletonV1 { offsets_m, segment_ends_m, segment_radii_m, limits_rad, feet } = skeleton;
        let feet = feet.map(|foot| {
            let FootV1 { heel_m, ball_m, toe_tip_m, measured_m } = foot;
            Foot { heel_m, ball_m, toe_tip_m, measured_m }
        });
        Self { offsets_m, segment_ends_m, segment_radii_m, limits_rad, feet }
    }
}

impl From<VelocityHullV1> for VelocityHull {
    fn from(hull: VelocityHullV1) -> Self {
        let VelocityHullV1 { construction, turning_mps, holding_mps, sharp_turn_edges_mps } = hull;
        let construction = match construction {
            ConstructionV1::TurningAndHolding => Construction::TurningAndHolding,
            ConstructionV1::Paper => Construction::Paper,
        };
        Self { construction, turning_mps, holding_mps, sharp_turn_edges_mps }
    }
}

//! How far two motions are from each other, whoever's bodies they are: the angle between their bones over one cycle.
//!
//! Both are cycles of a database, at the same 64 phases (right mid-stance to right mid-stance). A bone's direction is
//! taken relative to the pelvis, in the pelvis's own frame, so neither body size nor heading nor the place of the root
//! counts:
//!
//! ```text
//! D(a, b) = √( mean over 64 phases and 18 bones of ∠(d_a, d_b)² ),
//! ```
//!
//! degrees. The bones from the pelvis to its three children cannot turn against it and are left out.

use glam::Vec3;
use motiondb::body::{JOINT_COUNT, Joint, Joints};
use motiondb::motion::{MotionDb, PHASE_COUNT};

/// Bones that turn against the pelvis.
const BONES: usize = JOINT_COUNT - 4;

/// Unit vectors along the bones of one cycle in the pelvis's frame; a bone without length is zero and counts for
/// nothing.
#[derive(Clone, Debug)]
pub(crate) struct PoseSequence {
    directions: Vec<[Vec3; BONES]>,
}

impl PoseSequence {
    /// Of one example of a database.
    pub(crate) fn of(db: &MotionDb, example: usize) -> Self {
        Self { directions: db.posed_rows(example).iter().map(directions).collect() }
    }

    /// D, degrees.
    pub(crate) fn distance_deg(&self, other: &Self) -> f32 {
        let sum: f64 = self.directions.iter().zip(&other.directions).map(|(a, b)| squared_deg2(a, b)).sum();
        (sum / (PHASE_COUNT * BONES) as f64).sqrt() as f32
    }

    /// D of one pose to the nearest of the cycle, degrees.
    pub(crate) fn to_pose_deg(&self, joints: &Joints) -> f32 {
        let pose = directions(joints);
        let nearest = self.directions.iter().map(|row| squared_deg2(row, &pose)).fold(f64::INFINITY, f64::min);
        (nearest / BONES as f64).sqrt() as f32
    }
}

fn directions(joints: &Joints) -> [Vec3; BONES] {
    let to_pelvis = joints.orientations[Joint::Pelvis.index()].inverse();
    let mut bones = Joint::ALL.iter().filter_map(|joint| {
        let parent = joint.parent().filter(|parent| *parent != Joint::Pelvis)?;
        let bone_m = joints.positions_m[joint.index()] - joints.positions_m[parent.index()];
        Some((to_pelvis * bone_m).normalize_or_zero())
    });
    std::array::from_fn(|_| bones.next().unwrap_or_default())
}

/// Σ over bones of ∠(d_a, d_b)².
fn squared_deg2(a: &[Vec3; BONES], b: &[Vec3; BONES]) -> f64 {
    let squared = |(a, b): (&Vec3, &Vec3)| {
        let angle_deg = if *a == Vec3::ZERO || *b == Vec3::ZERO { 0.0 } else { a.angle_between(*b).to_degrees() };
        f64::from(angle_deg * angle_deg)
    };
    a.iter().zip(b).map(squared).sum()
}

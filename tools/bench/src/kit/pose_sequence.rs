//! Distance of two motions: the angle between their bones over one cycle.
//!
//! Both are cycles of a database, at the same 64 phases (right mid-stance to right mid-stance). The direction of a bone
//! is taken in the pelvis's frame. So neither body size nor heading nor root position counts:
//!
//! ```text
//! D(a, b) = √( mean over 64 phases and 18 bones of ∠(d_a, d_b)² ),
//! ```
//!
//! in degrees. The bones from the pelvis to its three children cannot turn in the pelvis's frame and are left out.

use glam::Vec3;
use motiondb::body::{JOINT_COUNT, Joint, Joints};
use motiondb::motion::{MotionDb, PHASE_COUNT};

/// Number of bones that turn in the pelvis's frame.
const BONES: usize = JOINT_COUNT - 4;

/// Directions of the bones of one cycle, in the pelvis's frame.
#[derive(Clone, Debug)]
pub(crate) struct PoseSequence {
    /// Unit vectors for each phase; zero for a bone without length, which does not count.
    directions: Vec<[Vec3; BONES]>,
}

impl PoseSequence {
    /// The cycle of one example of a database.
    pub(crate) fn of(db: &MotionDb, example: usize) -> Self {
        Self { directions: db.posed_rows(example).iter().map(directions).collect() }
    }

    /// Distance D of two cycles, degrees.
    pub(crate) fn distance_deg(&self, other: &Self) -> f32 {
        let sum: f64 = self.directions.iter().zip(&other.directions).map(|(a, b)| squared_deg2(a, b)).sum();
        (sum / (PHASE_COUNT * BONES) as f64).sqrt() as f32
    }

    /// Distance of one pose to the nearest pose of the cycle, degrees.
    pub(crate) fn distance_to_pose_deg(&self, joints: &Joints) -> f32 {
        let pose = directions(joints);
        let nearest = self.directions.iter().map(|row| squared_deg2(row, &pose)).fold(f64::INFINITY, f64::min);
        (nearest / BONES as f64).sqrt() as f32
    }
}

/// Directions of the bones of one pose.
fn directions(joints: &Joints) -> [Vec3; BONES] {
    let to_pelvis = joints.orientations[Joint::Pelvis.index()].inverse();
    let mut bones = Joint::ALL.iter().filter_map(|joint| {
        let parent = joint.parent().filter(|parent| *parent != Joint::Pelvis)?;
        let bone_m = joints.positions_m[joint.index()] - joints.positions_m[parent.index()];
        Some((to_pelvis * bone_m).normalize_or_zero())
    });
    std::array::from_fn(|_| bones.next().unwrap_or_default())
}

/// Sum over bones of ∠(d_a, d_b)², degrees².
fn squared_deg2(a: &[Vec3; BONES], b: &[Vec3; BONES]) -> f64 {
    let squared = |(a, b): (&Vec3, &Vec3)| {
        let angle_deg = if *a == Vec3::ZERO || *b == Vec3::ZERO { 0.0 } else { a.angle_between(*b).to_degrees() };
        f64::from(angle_deg * angle_deg)
    };
    a.iter().zip(b).map(squared).sum()
}

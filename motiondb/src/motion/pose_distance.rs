//! How far apart two examples' poses are, at every stored phase of one against every stored phase of the other
//! (`FbCrowd` §5: "pairs of times where the two clips' poses are most alike").
//!
//! With x_j(φ) the place of joint j in the root frame and v_j(φ) = dx_j/dt its velocity there, the distance of phase φ
//! of one to phase φ' of the other is
//!
//! ```text
//! D(φ, φ') = √( mean over joints of |x_j(φ) − x'_j(φ')|² + w²·|v_j(φ) − v'_j(φ')|² ),
//! ```
//!
//! metres; w is [`VELOCITY_WEIGHT_S`].

use glam::Vec3;

use crate::body::skeleton::JOINT_COUNT;
use crate::motion::motion_db::{MotionDb, PHASE_COUNT};

/// w: weight of a joint's velocity beside its place: as far as it gets in this time, a transition's first instants,
/// seconds.
pub(crate) const VELOCITY_WEIGHT_S: f32 = 0.1;

/// D of all pairs of stored phases, metres: `[phase of one][phase of the other]`.
pub type Distances = Vec<[f32; PHASE_COUNT]>;

/// D between two examples.
pub fn distances_m(db: &MotionDb, one: usize, other: usize) -> Distances {
    let (one, other) = (features_m(db, one), features_m(db, other));
    one.iter().map(|a| std::array::from_fn(|row| distance_m(a, &other[row]))).collect()
}

fn distance_m(a: &[Vec3], b: &[Vec3]) -> f32 {
    let squared: f32 = a.iter().zip(b).map(|(a, b)| a.distance_squared(*b)).sum();
    (squared / JOINT_COUNT as f32).sqrt()
}

/// Places and weighted velocities of all joints at each stored phase, metres.
fn features_m(db: &MotionDb, example: usize) -> Vec<Vec<Vec3>> {
    let places = |row: usize| db.rows.pose(example, row).forward_kinematics(&db.skeleton).positions_m;
    let places_m: Vec<_> = (0..PHASE_COUNT).map(places).collect();
    let time_s = |row: f32| db.examples[example].phase_map.time_s(row / PHASE_COUNT as f32);
    let row = |row: usize| {
        let (before, after) = (&places_m[(row + PHASE_COUNT - 1) % PHASE_COUNT], &places_m[(row + 1) % PHASE_COUNT]);
        let weight = VELOCITY_WEIGHT_S / (time_s(row as f32 + 1.0) - time_s(row as f32 - 1.0));
        let velocities = after.iter().zip(before).map(|(after, before)| (*after - *before) * weight);
        places_m[row].iter().copied().chain(velocities).collect()
    };
    (0..PHASE_COUNT).map(row).collect()
}

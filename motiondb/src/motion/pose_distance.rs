//! Distance of the poses of two examples, for all pairs of stored phases (`FbCrowd` §5: "pairs of times where the two
//! clips' poses are most alike").
//!
//! With the position x_j(φ) of joint j in the root frame and its velocity v_j(φ) = dx_j/dt there, the distance of phase
//! φ of one example to phase φ' of the other is
//!
//! ```text
//! D(φ, φ') = √( mean over joints of |x_j(φ) − x'_j(φ')|² + w²·|v_j(φ) − v'_j(φ')|² ),
//! ```
//!
//! in metres, with w = [`VELOCITY_WEIGHT_S`].

use glam::Vec3;

use crate::body::skeleton::JOINT_COUNT;
use crate::motion::motion_db::{MotionDb, PHASE_COUNT};

/// w: weight of a joint's velocity relative to its position, seconds: the first instants of a transition.
pub(crate) const VELOCITY_WEIGHT_S: f32 = 0.1;

/// D of all pairs of stored phases, metres: `[phase of one][phase of the other]`.
pub type Distances = Vec<[f32; PHASE_COUNT]>;

/// D of all pairs of stored phases of two examples, given by index.
pub fn distances_m(db: &MotionDb, one: usize, other: usize) -> Distances {
    let (one, other) = (features_m(db, one), features_m(db, other));
    one.iter().map(|a| std::array::from_fn(|row| distance_m(a, &other[row]))).collect()
}

fn distance_m(a: &[Vec3], b: &[Vec3]) -> f32 {
    let squared: f32 = a.iter().zip(b).map(|(a, b)| a.distance_squared(*b)).sum();
    (squared / JOINT_COUNT as f32).sqrt()
}

/// Positions and weighted velocities of all joints at each stored phase, root frame, metres.
fn features_m(db: &MotionDb, example: usize) -> Vec<Vec<Vec3>> {
    let rows = db.posed_rows(example);
    let time_s = |row: f32| db.examples[example].phase_map.time_s(row / PHASE_COUNT as f32);
    let features = |row: usize| {
        let [before, after] = [row + PHASE_COUNT - 1, row + 1].map(|row| &rows[row % PHASE_COUNT].positions_m);
        let weight = VELOCITY_WEIGHT_S / (time_s(row as f32 + 1.0) - time_s(row as f32 - 1.0));
        let velocities = after.iter().zip(before).map(|(after, before)| (*after - *before) * weight);
        rows[row].positions_m.iter().copied().chain(velocities).collect()
    };
    (0..PHASE_COUNT).map(features).collect()
}

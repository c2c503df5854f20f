//! How far a change of weights moves a pose: the root mean square displacement of its ankles and wrists over the cycle.
//!
//! Landmarks are ankles and wrists at quarters of the cycle. Root frame (x forward, y left, z up), metres.

use std::array::from_fn;

use glam::Vec3;
use motiondb::body::Joint;
use motiondb::motion::{MotionDb, PHASE_COUNT};

const LANDMARK_JOINTS: [Joint; 4] = [Joint::FEET[0], Joint::FEET[1], Joint::LeftHand, Joint::RightHand];
/// Uniform phases at which landmarks are taken.
const LANDMARK_PHASES: usize = 4;
const LANDMARKS: usize = LANDMARK_JOINTS.len() * LANDMARK_PHASES;

type Landmarks = [Vec3; LANDMARKS];

/// Landmarks of all examples.
#[derive(Clone, Debug)]
pub(crate) struct PoseLandmarks {
    /// Landmarks of each example, m.
    of_examples_m: Vec<Landmarks>,
    /// Greatest distance of an example's landmarks from the mean of all examples, root mean square, m.
    radius_m: f32,
}

impl PoseLandmarks {
    /// The landmarks of a database.
    pub(crate) fn new(db: &MotionDb) -> Self {
        let of_examples_m: Vec<Landmarks> = (0..db.examples.len()).map(|example| landmarks_m(db, example)).collect();
        Self { radius_m: radius_m(&of_examples_m), of_examples_m }
    }

    /// Displacement of the landmarks for changes of weights (example, change), root mean square, m.
    pub(crate) fn change_m(&self, changes: impl Iterator<Item = (u32, f32)>) -> f32 {
        let mut sum_m = [Vec3::ZERO; LANDMARKS];
        for (example, change) in changes {
            for (sum_m, landmark_m) in sum_m.iter_mut().zip(&self.of_examples_m[example as usize]) {
                *sum_m += change * *landmark_m;
            }
        }
        root_mean_square_m(&sum_m)
    }

    /// Upper bound of that displacement where `changed` of the weights move from some examples to others, m.
    pub(crate) fn change_max_m(&self, changed: f32) -> f32 {
        2.0 * changed * self.radius_m
    }
}

/// Changes of weights sum to 0, so the origin of landmarks is free; about the mean of all examples they are smallest.
fn radius_m(of_examples_m: &[Landmarks]) -> f32 {
    let count = of_examples_m.len() as f32;
    let mean_m: Landmarks = from_fn(|at| of_examples_m.iter().map(|of_one_m| of_one_m[at] / count).sum());
    let off_m = |of_one_m: &Landmarks| root_mean_square_m(&from_fn(|at| of_one_m[at] - mean_m[at]));
    of_examples_m.iter().map(off_m).fold(0.0, f32::max)
}

fn root_mean_square_m(landmarks_m: &Landmarks) -> f32 {
    libm::sqrtf(landmarks_m.iter().map(|landmark_m| landmark_m.length_squared()).sum::<f32>() / LANDMARKS as f32)
}

fn landmarks_m(db: &MotionDb, example: usize) -> Landmarks {
    let mut landmarks_m = [Vec3::ZERO; LANDMARKS];
    for (quarter, of_one_m) in landmarks_m.chunks_exact_mut(LANDMARK_JOINTS.len()).enumerate() {
        let row = quarter * PHASE_COUNT / LANDMARK_PHASES;
        let joints = db.rows.pose(example, row).forward_kinematics(&db.skeleton);
        for (landmark_m, joint) in of_one_m.iter_mut().zip(LANDMARK_JOINTS) {
            *landmark_m = joints.positions_m[joint.index()];
        }
    }
    landmarks_m
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::test_db::test_db;

    #[test]
    fn the_change_grows_with_that_of_the_pose() {
        let landmarks = PoseLandmarks::new(&test_db());
        let change_m = |to: u32| landmarks.change_m([(1, -1.0), (to, 1.0)].into_iter());
        assert!(change_m(1) == 0.0 && change_m(2) > 0.02 && change_m(3) > change_m(2));
    }
}

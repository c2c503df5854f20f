//! The blend space of a database, ready for queries, with what standing still means in it.
//!
//! Parameters are (v_f, ω_t, ω_s), m/s and rad/s; an example without steps *stands*.

use std::array::from_fn;

use glam::{Vec2, Vec3};
use motiondb::blend_space::{Locator, MAX_CORNERS, Shares};
use motiondb::body::Joint;
use motiondb::motion::{MotionDb, PHASE_COUNT, Parameters};
use motiondb::velocity_sets::velocity_hull::is_holding;

use crate::synthesis::blending::mix::Mix;

/// Where an example is looked at, to tell how much a change of shares changes the pose: ankles and wrists, at
/// quarters of the cycle.
const LANDMARK_JOINTS: [Joint; 4] = [Joint::FEET[0], Joint::FEET[1], Joint::LeftHand, Joint::RightHand];
const LANDMARK_PHASES: usize = 4;
const LANDMARKS: usize = LANDMARK_JOINTS.len() * LANDMARK_PHASES;
/// Rounds by which shares of steps and standing are found; where the steps lie behind the query from standing, two
/// suffice.
const BESIDE_ROUNDS: usize = 16;
type Landmarks = [Vec3; LANDMARKS];

/// The blend space of one database.
#[derive(Clone, Debug)]
pub struct Space {
    locator: Locator,
    points: Vec<Parameters>,
    stands: Vec<bool>,
    landmarks_m: Vec<Landmarks>,
    /// Greatest distance of an example's landmarks from their mean, root mean square, metres.
    landmarks_reach_m: f32,
    /// What an axis is divided by in distances; 0 drops it.
    scale: Vec3,
    /// The example that stands though it belongs to no simplex ([`crate::synthesis::library::standing`]).
    standing_apart: Option<u32>,
    /// Greatest |ω_t| of the examples, rad/s.
    pub turn_rate_max_rad_s: f32,
    /// Greatest speed of the examples, m/s.
    pub speed_max_mps: f32,
    /// Greatest side speeds without a turn, to the right (not positive) and to the left, m/s.
    pub strafe_mps: [f32; 2],
    /// Standing still, or whatever the database has that is slowest.
    pub standing: Nearest,
    /// The balls of the feet of a standing body in the root frame, `[left, right]`, metres.
    pub standing_balls_m: [Vec3; 2],
}

/// What the database has nearest to a query.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Nearest {
    /// The query itself, where it lies inside the hull.
    pub parameters: Parameters,
    /// Share of standing examples in it.
    pub idle_share: f32,
    /// Of the examples that make it.
    pub shares: Shares,
}

impl Space {
    /// Of one database.
    pub fn new(db: &MotionDb) -> Self {
        let points: Vec<Parameters> = db.examples.iter().map(|example| example.parameters).collect();
        let greatest = |of: fn(&Parameters) -> f32| points.iter().map(of).fold(0.0, f32::max);
        let stands: Vec<bool> = db.examples.iter().map(|example| example.key_times_s.is_none()).collect();
        let landmarks_m: Vec<Landmarks> = (0..db.examples.len()).map(|example| landmarks_m(db, example)).collect();
        let mut space = Self {
            standing: Nearest::default(),
            standing_balls_m: Default::default(),
            standing_apart: standing_apart(db, &stands),
            stands,
            scale: db.blend_space.scaled(Parameters::from_vec3(Vec3::ONE)),
            strafe_mps: strafe_mps(&points),
            turn_rate_max_rad_s: greatest(|point| point.turn_rate_rad_s.abs()),
            speed_max_mps: greatest(|point| Vec2::new(point.speed_mps, point.strafe_mps).length()),
            landmarks_reach_m: landmarks_reach_m(&landmarks_m),
            landmarks_m,
            locator: Locator::new(&db.blend_space, &points),
            points,
        };
        space.standing = space.nearest(Parameters::default());
        let standing = Mix::new(&space.standing.shares).weights(db, 0.0).pose(db, 0.0);
        let joints = standing.forward_kinematics(&db.skeleton);
        space.standing_balls_m = [0, 1].map(|side| joints.sole_points_m(&db.skeleton, side)[1]);
        space
    }

    /// How far ankles and wrists move in the root frame when shares change: root mean square over the cycle, metres.
    pub fn pose_change_m(&self, changes: impl Iterator<Item = (u32, f32)>) -> f32 {
        let mut sum_m = [Vec3::ZERO; LANDMARKS];
        for (example, change) in changes {
            for (sum_m, landmark_m) in sum_m.iter_mut().zip(&self.landmarks_m[example as usize]) {
                *sum_m += change * *landmark_m;
            }
        }
        root_mean_square_m(&sum_m)
    }

    /// More than that cannot be, where so many shares change hands.
    pub fn pose_change_max_m(&self, changed: f32) -> f32 {
        2.0 * changed * self.landmarks_reach_m
    }

    /// Shares at a point, or at the nearest one that the database has.
    pub fn locate(&self, parameters: Parameters) -> Shares {
        match self.standing_apart {
            Some(standing) => self.locate_beside(parameters, standing),
            None => self.locator.locate(parameters),
        }
    }

    /// Shares where standing is a point beside the simplices: the nearest point to p of all that lie between it and
    /// them, f·q with q theirs. The nearest q to p/f and the best f for q are found by turns.
    fn locate_beside(&self, parameters: Parameters, standing: u32) -> Shares {
        let scaled = parameters.to_vec3() * self.scale;
        let mut share = 1.0;
        let mut shares = self.locator.locate(parameters);
        for _ in 0..BESIDE_ROUNDS {
            let found = self.sum(&shares) * self.scale;
            share = (scaled.dot(found) / found.length_squared().max(f32::MIN_POSITIVE)).clamp(0.0, 1.0);
            if share == 0.0 || share == 1.0 {
                break;
            }
            shares = self.locator.locate(Parameters::from_vec3(parameters.to_vec3() / share));
        }
        with_standing(&shares, share, standing)
    }

    /// Root velocity of some shares.
    fn sum(&self, shares: &Shares) -> Vec3 {
        let examples = shares.examples.into_iter().zip(shares.shares);
        examples.map(|(example, share)| share * self.points[example as usize].to_vec3()).sum()
    }

    /// The nearest point that the database has.
    pub fn nearest(&self, parameters: Parameters) -> Nearest {
        let shares = self.locate(parameters);
        let idle = shares.examples.into_iter().zip(shares.shares).filter(|entry| self.stands[entry.0 as usize]);
        let idle_share = idle.map(|entry| entry.1).sum();
        Nearest { parameters: Parameters::from_vec3(self.sum(&shares)), idle_share, shares }
    }
}

fn root_mean_square_m(landmarks_m: &Landmarks) -> f32 {
    libm::sqrtf(landmarks_m.iter().map(|landmark_m| landmark_m.length_squared()).sum::<f32>() / LANDMARKS as f32)
}

/// Shares that change hands sum to none, so where landmarks are counted from makes no difference: from the mean of all
/// examples they are nearest.
fn landmarks_reach_m(landmarks_m: &[Landmarks]) -> f32 {
    let count = landmarks_m.len() as f32;
    let mean_m: Landmarks = from_fn(|at| landmarks_m.iter().map(|of_one_m| of_one_m[at] / count).sum());
    let off_m = |of_one_m: &Landmarks| root_mean_square_m(&from_fn(|at| of_one_m[at] - mean_m[at]));
    landmarks_m.iter().map(off_m).fold(0.0, f32::max)
}

fn strafe_mps(points: &[Parameters]) -> [f32; 2] {
    let aside_mps = points.iter().filter(|point| is_holding(point)).map(|point| point.strafe_mps);
    aside_mps.fold([0.0; 2], |[right, left], aside_mps| [aside_mps.min(right), aside_mps.max(left)])
}

/// An example that stands where no corner of a simplex does.
fn standing_apart(db: &MotionDb, stands: &[bool]) -> Option<u32> {
    let standing = stands.iter().rposition(|&stands| stands)?;
    let mut corners = db.blend_space.simplices.iter();
    (!corners.any(|&corner| stands[corner as usize])).then_some(standing as u32)
}

/// A share of some steps, the rest standing, which takes the place of the least corner: steps at the hull's border have
/// one to spare.
fn with_standing(steps: &Shares, share: f32, standing: u32) -> Shares {
    let mut mixed = *steps;
    let least = (0..MAX_CORNERS).min_by(|&a, &b| steps.shares[a].total_cmp(&steps.shares[b])).unwrap_or(0);
    mixed.shares[least] = 0.0;
    let kept: f32 = mixed.shares.iter().sum();
    mixed.shares.iter_mut().for_each(|corner| *corner *= share / kept);
    (mixed.examples[least], mixed.shares[least]) = (standing, 1.0 - share);
    mixed
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
    use std::sync::Arc;

    use super::*;
    use crate::synthesis::library::standing;
    use crate::test_db::test_db;

    /// The test database without its idle, which is its first example.
    fn without_idle() -> MotionDb {
        let mut db = test_db();
        db.examples.remove(0);
        db.rows.pelvis_m.drain(..PHASE_COUNT);
        db.rows.contacts.drain(..PHASE_COUNT);
        db.rows.rotations.drain(..PHASE_COUNT * motiondb::body::JOINT_COUNT);
        db.examples.truncate(3);
        let parameters: Vec<Parameters> = db.examples.iter().map(|example| example.parameters).collect();
        db.blend_space = motiondb::blend_space::triangulation::build(&parameters);
        db
    }

    #[test]
    fn between_standing_and_the_slowest_walk_shares_are_those_of_time() {
        let db = standing::provided(Arc::new(without_idle()));
        let space = Space::new(&db);
        for (speed_mps, idle_share) in [(0.0, 1.0), (0.1, 0.8), (0.3, 0.4), (0.5, 0.0), (1.2, 0.0)] {
            let asked = Parameters { speed_mps, ..Parameters::default() };
            let nearest = space.nearest(asked);
            assert!((nearest.idle_share - idle_share).abs() < 1e-4, "{speed_mps}: {nearest:?}");
            assert!(nearest.parameters.to_vec3().distance(asked.to_vec3()) < 1e-4, "{speed_mps}: {nearest:?}");
        }
    }

    #[test]
    fn a_way_that_no_walk_leads_is_stood() {
        let db = standing::provided(Arc::new(without_idle()));
        let back = Parameters { speed_mps: -0.4, ..Parameters::default() };
        assert_eq!(Space::new(&db).nearest(back).idle_share, 1.0);
    }

    #[test]
    fn a_change_of_shares_is_as_great_as_that_of_the_pose() {
        let db = test_db();
        let space = Space::new(&db);
        let moved_m = |to: u32| space.pose_change_m([(1, -1.0), (to, 1.0)].into_iter());
        assert!(moved_m(1) == 0.0 && moved_m(2) > 0.02 && moved_m(3) > moved_m(2));
    }
}

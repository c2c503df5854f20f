//! The blend domain: the blend space of a database, ready for queries, with standing as a part of it.
//!
//! A query is (v_f, ω_t, ω_s), m/s and rad/s. The answer holds the nearest parameters that the examples reach and the
//! shares of the examples (`FbCrowd` §5, App. 10). An example without steps *stands*.

use glam::Vec3;
use motiondb::blend_space::{Locator, MAX_CORNERS, Shares};
use motiondb::motion::{MotionDb, Parameters};
use motiondb::velocity_sets::velocity_hull::is_holding;

use crate::synthesis::blending::cadence_curve::CadenceCurve;
use crate::synthesis::blending::example_mix::ExampleMix;
use crate::synthesis::blending::pose_landmarks::PoseLandmarks;

/// Greatest number of iterations for the shares of steps and standing. Two suffice where the steps lie straight beyond
/// the query.
const BESIDE_ITERATIONS: usize = 16;
/// Greatest number of iterations for the least rate at which the examples reach a query. One suffices where the border
/// of the hull is flat between the first found point and the query's ray.
const RATE_ITERATIONS: usize = 3;
/// Distance from a query, divided by its length, below which the examples reach it.
const REACHED: f32 = 1e-4;

/// The blend domain of one database.
#[derive(Clone, Debug)]
pub struct BlendDomain {
    locator: Locator,
    /// Parameters of each example.
    parameters: Vec<Parameters>,
    /// Whether each example stands.
    stands: Vec<bool>,
    /// Landmarks that measure how far a change of weights moves the pose.
    pub(crate) landmarks: PoseLandmarks,
    /// Cadence of straight walks over speed.
    cadence: CadenceCurve,
    /// Factor of each axis of (v_f, ω_t, ω_s) in distances; 0 for an axis without range.
    axis_scale: Vec3,
    /// Example that stands and belongs to no simplex ([`crate::synthesis::library::standing`]).
    standing_apart: Option<u32>,
    /// Greatest |ω_t| of the examples, rad/s.
    pub turn_rate_max_rad_s: f32,
    /// Greatest speed of the examples, m/s.
    pub speed_max_mps: f32,
    /// Range of ω_s without a turn, m/s: to the right (not positive) and to the left (not negative).
    pub strafe_range_mps: [f32; 2],
    /// The answer for (0, 0, 0): standing, or the slowest that the database has.
    pub standing: Reachable,
    /// Balls of the feet of a standing body in the root frame, `[left, right]`, m.
    pub standing_balls_m: [Vec3; 2],
}

/// The nearest point to a query that the examples reach.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Reachable {
    /// Its parameters: the query itself where that lies inside the hull.
    pub parameters: Parameters,
    /// Share of standing examples.
    pub idle_share: f32,
    /// Shares of time of the examples.
    pub shares: Shares,
    /// Rate at which the examples play, divided by that of the clips.
    pub playback_rate: f32,
}

impl BlendDomain {
    /// The blend domain of a database.
    pub fn new(db: &MotionDb) -> Self {
        let parameters: Vec<Parameters> = db.examples.iter().map(|example| example.parameters).collect();
        let greatest = |of: fn(&Parameters) -> f32| parameters.iter().map(of).fold(0.0, f32::max);
        let stands: Vec<bool> = db.examples.iter().map(|example| example.key_times_s.is_none()).collect();
        let mut domain = Self {
            standing: Reachable::default(),
            cadence: CadenceCurve::new(|_| 1.0),
            standing_balls_m: Default::default(),
            standing_apart: standing_apart(db, &stands),
            stands,
            landmarks: PoseLandmarks::new(db),
            axis_scale: db.blend_space.scaled(Parameters::from_vec3(Vec3::ONE)),
            strafe_range_mps: strafe_range_mps(&parameters),
            turn_rate_max_rad_s: greatest(|point| point.turn_rate_rad_s.abs()),
            speed_max_mps: greatest(|point| point.velocity_mps().length()),
            locator: Locator::new(&db.blend_space, &parameters),
            parameters,
        };
        let strides_hz = |example: usize| 1.0 / db.examples[example].phase_map.period_s;
        domain.cadence = CadenceCurve::new(|parameters| {
            let Shares { examples, shares } = domain.locate(parameters);
            examples.into_iter().zip(shares).map(|(example, share)| share * strides_hz(example as usize)).sum()
        });
        domain.standing = domain.reachable(Parameters::default());
        let standing = ExampleMix::new(&domain.standing.shares).weights(db, 0.0).pose(db, 0.0);
        let joints = standing.forward_kinematics(&db.skeleton);
        domain.standing_balls_m = [0, 1].map(|side| joints.sole_points_m(&db.skeleton, side)[1]);
        domain
    }

    /// The nearest point to a query that the examples reach.
    pub fn reachable(&self, query: Parameters) -> Reachable {
        self.played(query, 1.0)
    }

    /// The nearest point to a query that a body reaches with `cadence` times the cadence of others. Where the examples
    /// reach it only at a greater rate than that body's, they play at that one, up to 1: long strides yield first.
    pub(crate) fn reachable_with(&self, query: Parameters, cadence: f32) -> Reachable {
        let speed_mps = query.velocity_mps().length();
        let mut reachable = self.played(query, self.cadence.playback_rate(speed_mps, cadence));
        for _ in 0..RATE_ITERATIONS {
            if reachable.playback_rate >= 1.0 {
                break;
            }
            let wanted = query.to_vec3() * self.axis_scale;
            let found = reachable.parameters.to_vec3() * self.axis_scale;
            let beyond = wanted - found;
            if beyond.length() < REACHED * wanted.length() {
                break;
            }
            // The border of the hull at the found point meets the ray of the query at this rate.
            let quicker = reachable.playback_rate * beyond.dot(wanted) / beyond.dot(found);
            let playback_rate = if quicker > reachable.playback_rate { quicker.min(1.0) } else { 1.0 };
            reachable = self.played(query, playback_rate);
        }
        reachable
    }

    /// The nearest point to a query that the examples reach at exactly this rate.
    fn played(&self, query: Parameters, playback_rate: f32) -> Reachable {
        let shares = self.locate(Parameters::from_vec3(query.to_vec3() / playback_rate));
        let idle = shares.examples.into_iter().zip(shares.shares).filter(|entry| self.stands[entry.0 as usize]);
        let idle_share = idle.map(|entry| entry.1).sum();
        let parameters = Parameters::from_vec3(playback_rate * self.weighted_sum(&shares));
        Reachable { parameters, idle_share, shares, playback_rate }
    }

    /// Shares of time of the examples at that point.
    pub fn locate(&self, query: Parameters) -> Shares {
        match self.standing_apart {
            Some(standing) => self.locate_beside(query, standing),
            None => self.locator.locate(query),
        }
    }

    /// Shares where standing lies beside the simplices. The domain then also holds every point f·q with q in a simplex
    /// and f in [0, 1]. For the nearest of them to p, the nearest q to p/f and the best f for q are found in turns.
    fn locate_beside(&self, query: Parameters, standing: u32) -> Shares {
        let scaled = query.to_vec3() * self.axis_scale;
        let mut share = 1.0;
        let mut shares = self.locator.locate(query);
        for _ in 0..BESIDE_ITERATIONS {
            let found = self.weighted_sum(&shares) * self.axis_scale;
            share = (scaled.dot(found) / found.length_squared().max(f32::MIN_POSITIVE)).clamp(0.0, 1.0);
            if share == 0.0 || share == 1.0 {
                break;
            }
            shares = self.locator.locate(Parameters::from_vec3(query.to_vec3() / share));
        }
        with_standing(&shares, share, standing)
    }

    /// (v_f, ω_t, ω_s) of a root that moves by these shares.
    fn weighted_sum(&self, shares: &Shares) -> Vec3 {
        let examples = shares.examples.into_iter().zip(shares.shares);
        examples.map(|(example, share)| share * self.parameters[example as usize].to_vec3()).sum()
    }
}

fn strafe_range_mps(parameters: &[Parameters]) -> [f32; 2] {
    let strafes_mps = parameters.iter().filter(|point| is_holding(point)).map(|point| point.strafe_mps);
    strafes_mps.fold([0.0; 2], |[right, left], strafe_mps| [strafe_mps.min(right), strafe_mps.max(left)])
}

/// The last example that stands, if no corner of a simplex stands.
fn standing_apart(db: &MotionDb, stands: &[bool]) -> Option<u32> {
    let standing = stands.iter().rposition(|&stands| stands)?;
    let mut corners = db.blend_space.simplices.iter();
    (!corners.any(|&corner| stands[corner as usize])).then_some(standing as u32)
}

/// `share` of some steps and the rest of standing, which replaces the corner of the least share: at the border of the
/// hull one corner has no share.
fn with_standing(steps: &Shares, share: f32, standing: u32) -> Shares {
    let mut mixed = *steps;
    let least = (0..MAX_CORNERS).min_by(|&a, &b| steps.shares[a].total_cmp(&steps.shares[b])).unwrap_or(0);
    mixed.shares[least] = 0.0;
    let kept: f32 = mixed.shares.iter().sum();
    mixed.shares.iter_mut().for_each(|corner| *corner *= share / kept);
    (mixed.examples[least], mixed.shares[least]) = (standing, 1.0 - share);
    mixed
}

#[cfg(test)]
mod tests {
    use std::sync::Arc;

    use motiondb::motion::PHASE_COUNT;

    use super::*;
    use crate::synthesis::library::standing;
    use crate::test_db::test_db;

    /// The test database with its three straight walks alone.
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
    fn shares_between_standing_and_the_slowest_walk_are_linear() {
        let db = standing::with_standing(Arc::new(without_idle()));
        let domain = BlendDomain::new(&db);
        for (speed_mps, idle_share) in [(0.0, 1.0), (0.1, 0.8), (0.3, 0.4), (0.5, 0.0), (1.2, 0.0)] {
            let query = Parameters { speed_mps, ..Parameters::default() };
            let reachable = domain.reachable(query);
            assert!((reachable.idle_share - idle_share).abs() < 1e-4, "{speed_mps}: {reachable:?}");
            assert!(reachable.parameters.to_vec3().distance(query.to_vec3()) < 1e-4, "{speed_mps}: {reachable:?}");
        }
    }

    #[test]
    fn standing_is_nearest_where_no_walk_goes() {
        let db = standing::with_standing(Arc::new(without_idle()));
        let back = Parameters { speed_mps: -0.4, ..Parameters::default() };
        assert_eq!(BlendDomain::new(&db).reachable(back).idle_share, 1.0);
    }
}

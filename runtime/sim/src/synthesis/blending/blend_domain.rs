//! The blend domain: the blend space of a database, ready for queries, with standing as a part of it.
//!
//! A query is (v_f, ω_t, ω_s), m/s and rad/s. The answer holds the nearest parameters that the examples reach and the
//! shares of the examples (`FbCrowd` §5, App. 10). An example without steps *stands*.

use glam::{Vec2, Vec3};
use motiondb::blend_space::{Locator, MAX_CORNERS, Shares};
use motiondb::motion::{MotionDb, Parameters};
use motiondb::velocity_sets::velocity_hull::is_holding;

use crate::synthesis::blending::cadence_curve::CadenceCurve;
use crate::synthesis::blending::example_mix::ExampleMix;
use crate::synthesis::blending::pose_landmarks::PoseLandmarks;
use crate::synthesis::blending::pose_weights::PoseWeights;
use crate::synthesis::pose::lean::balance::lean_in_curve_rad;
use crate::synthesis::pose::upper_body::curve_look::curve_look_rad;

/// Greatest number of iterations for the shares of steps and standing. Two suffice where the steps lie straight beyond
/// the query.
const BESIDE_ITERATIONS: usize = 16;
/// Greatest number of iterations for the least rate at which the examples reach a query. One suffices where the border
/// of the hull is flat between the first found point and the query's ray.
const RATE_ITERATIONS: usize = 3;
/// Distance from a query, divided by its length, below which the examples reach it.
const REACHED: f32 = 1e-4;
/// Planted share of an example, mean of both feet, below which it runs: at times no foot is on the ground.
const RUN_PLANTED_SHARE: f32 = 0.5;
/// Greatest rate at which walks play so that a curve needs no run: the cadence of slow walks becomes that of brisk ones.
const CURVE_RATE_MAX: f32 = 1.35;
/// Least speed to which a body slows down so that a curve needs no run, m/s: in a set without tight walks it still comes
/// round the corner.
const CURVE_MIN_MPS: f32 = 0.5;
/// Share of the speed of the slowest run from which on a body may begin to run in curves and aside.
const RUN_NEARLY: f32 = 0.75;
/// Turn rate from which on a body goes in a curve, rad/s: 10 °/s.
const CURVE_RAD_S: f32 = 0.175;
/// Speed to the side from which on a body goes aside, m/s.
const ASIDE_MPS: f32 = 0.1;
/// Share of running above the usual one that is none: rounding.
const RUN_TOLERANCE: f32 = 1e-3;
/// Halvings of the interval in which the rate, or the speed, of a curve lies: to less than 1 %.
const CURVE_HALVINGS: usize = 6;

/// The blend domain of one database.
#[derive(Clone, Debug)]
pub struct BlendDomain {
    locator: Locator,
    /// Parameters of each example.
    parameters: Vec<Parameters>,
    /// Lean of each example by itself, forward and left, rad.
    leans_rad: Vec<Vec2>,
    /// Look of the head of each example into its curve, rad.
    curve_looks_rad: Vec<f32>,
    /// Whether each example stands.
    stands: Vec<bool>,
    /// Whether each example runs.
    runs: Vec<bool>,
    /// Speed of the slowest run, m/s.
    run_min_mps: f32,
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
    /// Balls of the feet of a standing body on the ground in the root frame, `[left, right]`, m.
    pub standing_balls_m: [Vec2; 2],
}

/// The nearest point to a query that a body reaches.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Reachable {
    /// Its parameters: the query itself where that lies inside the hull, and needs no run at the speed of a walk.
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
        let runs: Vec<bool> = db.examples.iter().map(|example| example.planted_share < RUN_PLANTED_SHARE).collect();
        let run_speeds_mps =
            parameters.iter().zip(&runs).filter(|entry| *entry.1).map(|entry| entry.0.velocity_mps().length());
        let run_min_mps = run_speeds_mps.fold(f32::INFINITY, f32::min);
        let stands: Vec<bool> = db.examples.iter().map(|example| example.key_times_s.is_none()).collect();
        let curve_look_rad = |(example, point): (usize, &Parameters)| {
            curve_look_rad(&db.rows.mean_pose(example), point.turn_rate_rad_s, &db.skeleton)
        };
        let mut domain = Self {
            standing: Reachable::default(),
            cadence: CadenceCurve::new(|_| 1.0),
            standing_balls_m: Default::default(),
            standing_apart: standing_apart(db, &stands),
            curve_looks_rad: parameters.iter().enumerate().map(curve_look_rad).collect(),
            leans_rad: parameters.iter().map(lean_in_curve_rad).collect(),
            stands,
            runs,
            run_min_mps,
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
        domain.standing_balls_m = [0, 1].map(|side| joints.sole_points_m(&db.skeleton, side)[1].truncate());
        domain
    }

    /// The nearest point to a query that a body reaches.
    pub fn reachable(&self, query: Parameters) -> Reachable {
        self.reachable_with(query, 1.0)
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
        self.in_gait_of_speed(query, reachable)
    }

    /// What is reached of a query in the gait of its speed. Tight walks are slow, so the examples reach a quicker curve
    /// only by running, at speeds at which nobody runs straight on. There walks of the same curve play more quickly
    /// instead, and where these do not reach it, the body slows down, both within bounds.
    fn in_gait_of_speed(&self, query: Parameters, reachable: Reachable) -> Reachable {
        let fits = |found: &Reachable| {
            let run_share = self.run_share(found);
            run_share < RUN_TOLERANCE || run_share < self.usual_run_share(found.parameters) + RUN_TOLERANCE
        };
        if fits(&reachable) {
            return reachable;
        }
        let (rate, quick) = (reachable.playback_rate, CURVE_RATE_MAX * reachable.playback_rate);
        if fits(&self.played(query, quick)) {
            return halved([rate, quick], |rate| self.played(query, rate), fits);
        }
        let slowed = |share: f32| Parameters {
            speed_mps: share * query.speed_mps,
            strafe_mps: share * query.strafe_mps,
            ..query
        };
        let least = (CURVE_MIN_MPS / query.velocity_mps().length()).min(1.0);
        halved([1.0, least], |share| self.played(slowed(share), quick), fits)
    }

    /// Greatest share of running at some parameters: that of a body that goes straight on at their speed. In curves and
    /// aside there is more near the speed of the slowest run, and all from its speed on.
    fn usual_run_share(&self, parameters: Parameters) -> f32 {
        let speed_mps = parameters.velocity_mps().length();
        let straight_on = self.played(Parameters { speed_mps, ..Parameters::default() }, 1.0);
        let near_run = ((speed_mps / self.run_min_mps - RUN_NEARLY) / (1.0 - RUN_NEARLY)).clamp(0.0, 1.0);
        let Parameters { turn_rate_rad_s, strafe_mps, .. } = parameters;
        let off_straight = turn_rate_rad_s.abs() / CURVE_RAD_S + strafe_mps.abs() / ASIDE_MPS;
        self.run_share(&straight_on).max(near_run * off_straight.min(1.0))
    }

    /// Share of the examples that run.
    fn run_share(&self, reachable: &Reachable) -> f32 {
        let Shares { examples, shares } = reachable.shares;
        examples.into_iter().zip(shares).filter(|entry| self.runs[entry.0 as usize]).map(|entry| entry.1).sum()
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

    /// Lean of a mix by itself, forward and left, rad.
    pub(crate) fn lean_rad(&self, mix: &ExampleMix) -> Vec2 {
        mix.entries().iter().map(|&(example, share)| share * self.leans_rad[example as usize]).sum()
    }

    /// Look of the head of a blended pose into the curves of its examples, rad.
    pub(crate) fn curve_look_rad(&self, weights: &PoseWeights) -> f32 {
        weights.entries().iter().map(|&(example, weight)| weight * self.curve_looks_rad[example as usize]).sum()
    }

    /// (v_f, ω_t, ω_s) of a root that moves by these shares.
    fn weighted_sum(&self, shares: &Shares) -> Vec3 {
        let examples = shares.examples.into_iter().zip(shares.shares);
        examples.map(|(example, share)| share * self.parameters[example as usize].to_vec3()).sum()
    }
}

/// What is found at the first value from one end to the other that fits, or else at the other end.
fn halved(
    [mut unfit, mut fit]: [f32; 2],
    find: impl Fn(f32) -> Reachable,
    fits: impl Fn(&Reachable) -> bool,
) -> Reachable {
    let mut found = find(fit);
    for _ in 0..CURVE_HALVINGS {
        let middle = 0.5 * (unfit + fit);
        let between = find(middle);
        if fits(&between) {
            (fit, found) = (middle, between);
        } else {
            unfit = middle;
        }
    }
    found
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
    /// The test database, in which the spins are runs of 1.8 m/s.
    fn with_tight_runs() -> MotionDb {
        let mut db = test_db();
        for (index, turn_rate_rad_s) in [(6, 1.6), (7, -1.6)] {
            db.examples[index].parameters = Parameters { speed_mps: 1.8, turn_rate_rad_s, strafe_mps: 0.0 };
            db.examples[index].planted_share = 0.35;
        }
        let parameters: Vec<Parameters> = db.examples.iter().map(|example| example.parameters).collect();
        db.blend_space = motiondb::blend_space::triangulation::build(&parameters);
        db
    }

    #[test]
    fn nobody_runs_round_a_corner_at_the_speed_of_a_walk() {
        let domain = BlendDomain::new(&with_tight_runs());
        let reached = |speed_mps: f32, turn_rate_rad_s: f32| {
            let found = domain.reachable(Parameters { speed_mps, turn_rate_rad_s, strafe_mps: 0.0 });
            let Parameters { speed_mps, turn_rate_rad_s, .. } = found.parameters;
            (speed_mps, turn_rate_rad_s, found.playback_rate, domain.run_share(&found))
        };
        // The walks lead straight on, or round a curve at 0.7 m/s and 1.2 rad/s.
        let (speed_mps, turn_rate_rad_s, rate, run_share) = reached(0.85, 1.3);
        assert!((speed_mps - 0.85).abs() < 1e-3 && (turn_rate_rad_s - 1.3).abs() < 1e-3);
        assert!(rate > 1.05 && rate < CURVE_RATE_MAX && run_share < 0.01, "{rate}, {run_share}");
        let (speed_mps, turn_rate_rad_s, rate, run_share) = reached(1.2, 1.55);
        assert!((0.8..1.1).contains(&speed_mps) && (turn_rate_rad_s - 1.55).abs() < 0.02, "{speed_mps}");
        assert!(rate == CURVE_RATE_MAX && run_share < 0.02, "{rate}, {run_share}");
        let (speed_mps, _, rate, run_share) = reached(1.8, 1.6);
        assert!((speed_mps - 1.8).abs() < 1e-3 && rate == 1.0 && run_share > 0.99);
    }
}

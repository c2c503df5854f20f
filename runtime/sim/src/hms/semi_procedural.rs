//! Semi-procedural locomotion (`FbCrowd` §5; Juarez-Perez et al. 2014; recipe: `motion.md` §2): one cycle, m_sp,
//! deformed so that the body walks at any nearby (v_f, ω_t, ω_s) exactly.
//!
//! The feet of m_sp are taken apart into places on the ground and times for which the root has carried them
//! ([`super::foot_path`]). To walk otherwise, the same places are carried along the arc of *those* parameters, for since /
//! cadence: planted feet hold by construction, whatever the speed, direction and turn, and the swing stretches with the
//! stride.
//!
//! - The cadence shares a change of speed with the stride: both grow with its root, so their ratio keeps (walk ratio).
//! - Backward gait is nearly forward gait in reversed time (`motion.md` §5). Phases 0 and ½ are mid-stances, so −φ is the
//!   cycle reversed; walking backward plays it, and the mean of both, whose legs swing neither way, steps aside.
//! - The places move apart for side-steps and turns, so that legs do not cross, and outward where the body leans.
//! - Hips, trunk and arms swing as much as the stride is long.
//!
//! Root frame: x forward, y left, z up, metres; seconds; radians.

use std::f32::consts::FRAC_PI_2;

use glam::{Quat, Vec2, Vec3};
use motiondb::motion_db::{MotionDb, PHASE_COUNT};
use motiondb::parameters::Parameters;
use motiondb::phase_map::PhaseMap;
use motiondb::pose::{Pose, Root};
use motiondb::skeleton::{Foot, JOINT_COUNT, Joint, Side, Skeleton};

use super::blending::two_rows;
use super::foot_path::{Foothold, foot_path};
use super::ik::{self, FootTarget};
use super::leg::legs;
use super::{moved, pelvis};

/// Side-steps are short and quick: a m/s aside counts this much more towards the cadence than one ahead. The bundled
/// side-steps of 0.35 and 0.6 m/s, 99 and 132 steps a minute, say 3.1 and 3.2.
const ASIDE: f32 = 3.2;
/// Backward strides are 0.7 of forward ones, at the same cadence (`motion.md` §5).
const BACKWARD: f32 = 1.4;
/// Turning on the spot at 1 rad/s takes the steps of a walk at this speed, m: the bundled turns of 90 and 170 °/s, 119
/// and 178 steps a minute, say 1.0 and 1.2; turns in walking less.
const TURNING_M: f32 = 1.0;
/// Cadence over that of m_sp: from a stroll's to a shuffle's.
const CADENCE: [f32; 2] = [0.6, 2.2];
/// Greatest speeds ahead, back and aside, over that of m_sp; `fbcrowd bench reach` measures where legs would cross,
/// over-stretch or crouch, which is further out in every direction.
const AHEAD_MAX: f32 = 2.0;
const BACKWARD_MAX: f32 = 1.1;
const ASIDE_MAX: f32 = 1.1;
/// The body leans into a turn, and its feet stand outward: at this turn rate the greatest speeds are halved, rad/s …
const TURN_HALF_RAD_S: f32 = 2.5;
/// … and it turns no faster than this, rad/s: 170 °/s.
const TURN_MAX_RAD_S: f32 = 3.0;
/// Least clearance between ankles that pass each other aside, m: a foot's width.
const GAP_M: f32 = 0.1;
/// From ankle to toe tip, m: what reaches across where a foot points inward.
const FOOT_M: f32 = 0.2;
/// Share of half the turn between two landings by which feet point outward.
const TOE_OUT: f32 = 0.7;
/// Share of a foot's yaw that its knee follows; the ankle does the rest.
const KNEE_YAW: f32 = 0.7;
/// Share of the angle between travel and facing by which hips twist towards the travel.
const HIP_TWIST: f32 = 0.3;
/// Swing of hips, trunk and arms over that of m_sp, at least and at most.
const SWING: [f32; 2] = [0.3, 1.3];
/// A change of the shares of time by more than this within a step is one of pose: at 1 m/s nobody turns his travel so far.
const TURN_ABOUT: f32 = 0.1;
/// Gravity, m/s²: a body on an arc leans by atan(v·ω/g).
const GRAVITY_MPS2: f32 = 9.81;
/// Nobody leans further, rad: about 20°.
const LEAN_MAX_RAD: f32 = 0.35;

/// m_sp, taken apart.
#[derive(Clone, Debug)]
pub struct SemiProcedural {
    /// Index of m_sp.
    pub example: usize,
    parameters: Parameters,
    phase_map: PhaseMap,
    feet: Vec<[Foothold; 2]>,
    /// Phases from mid-stance to each foot's landing, and to its leaving; the former negative.
    contacts: [[f32; 2]; 2],
    /// Mean height of the hips, m.
    hips_m: f32,
    /// Mean of each joint over the cycle.
    mean: [Quat; JOINT_COUNT],
    /// Greatest difference between the times since of both feet, s.
    apart_s: f32,
    /// Least distance between the places of both feet, m.
    track_m: f32,
}

/// One instant of m_sp, played forward and backward at once.
struct Instant {
    phases: [f32; 2],
    shares: [f32; 2],
}

impl SemiProcedural {
    /// Takes an example apart; none for one that stands or does not walk ahead.
    pub fn new(db: &MotionDb, example: usize) -> Option<Self> {
        let found = &db.examples[example];
        let key_times_s = found.key_times_s.filter(|_| found.parameters.speed_mps > 0.0)?;
        let rows = db.posed_rows(example);
        let [left, right] = [0, 1].map(|side| foot_path(found, key_times_s, side, &rows));
        let feet: Vec<[Foothold; 2]> = left.into_iter().zip(right).map(|(left, right)| [left, right]).collect();
        let greatest = |value: fn(&[Foothold; 2]) -> f32| feet.iter().map(value).fold(f32::NEG_INFINITY, f32::max);
        Some(Self {
            example,
            parameters: found.parameters,
            phase_map: found.phase_map,
            hips_m: (0..PHASE_COUNT).map(|row| db.rows.pose(example, row).pelvis_m.z).sum::<f32>() / PHASE_COUNT as f32,
            contacts: [[key_times_s[3], key_times_s[2]], [key_times_s[1], key_times_s[0]]].map(|[strike_s, off_s]| {
                let phase = |time_s| found.phase_map.phase(time_s);
                [phase(strike_s), phase(off_s)]
            }),
            mean: mean(db, example),
            apart_s: greatest(|[left, right]| (left.since_s - right.since_s).abs()),
            track_m: -greatest(|[left, right]| right.place_m.y - left.place_m.y),
            feet,
        })
    }

    /// Cadence for some parameters, over that of m_sp.
    pub fn cadence(&self, parameters: Parameters) -> f32 {
        let Parameters { speed_mps, turn_rate_rad_s, strafe_mps } = parameters;
        let ahead_mps = if speed_mps < 0.0 { BACKWARD * speed_mps } else { speed_mps };
        let effort_mps = Vec3::new(ahead_mps, ASIDE * strafe_mps, TURNING_M * turn_rate_rad_s).length();
        libm::sqrtf(effort_mps / self.parameters.speed_mps).clamp(CADENCE[0], CADENCE[1])
    }

    /// Phase to time for some parameters. Reversed time exchanges the half-strides.
    pub fn phase_map(&self, parameters: Parameters) -> PhaseMap {
        let [forward, reversed] = directions(parameters);
        PhaseMap {
            period_s: self.phase_map.period_s / self.cadence(parameters),
            left_share: 0.5 + (self.phase_map.left_share - 0.5) * (forward - reversed),
        }
    }

    /// Contact of each foot, `[left, right]`: a foot is planted that stands in the cycle and in its reverse.
    pub fn contacts(&self, db: &MotionDb, parameters: Parameters, phase: f32) -> [f32; 2] {
        let Instant { phases, shares } = Instant::new(parameters, phase);
        let of_one = |index: usize| {
            let (rows, shares) = two_rows(phases[index]);
            let row = |row: usize| Vec2::from(db.rows.contacts[self.example * PHASE_COUNT + row]);
            (shares[0] * row(rows[0]) + shares[1] * row(rows[1])).to_array()
        };
        let [forward, reversed] = [0, 1].map(of_one);
        [0, 1].map(|side| libm::powf(forward[side], shares[0]) * libm::powf(reversed[side], shares[1]))
    }

    /// Seconds until a swinging foot lands: where it does in the cycle or, in reversed time, where it leaves.
    pub fn time_to_landing_s(&self, parameters: Parameters, phase: f32, side: usize) -> f32 {
        let [forward, reversed] = directions(parameters);
        let [strike, off] = self.contacts[side];
        let ahead = |landing: f32| (landing - phase).rem_euclid(1.0);
        (forward * ahead(strike) + reversed * ahead(1.0 - off)) / self.phase_map(parameters).rate_hz(phase)
    }

    /// The nearest parameters that m_sp is deformed to: an ellipse of speeds, the smaller the faster it turns.
    pub fn reachable(&self, parameters: Parameters) -> Parameters {
        let turn_rate_rad_s = parameters.turn_rate_rad_s.clamp(-TURN_MAX_RAD_S, TURN_MAX_RAD_S);
        let scale_mps = self.parameters.speed_mps / (1.0 + turn_rate_rad_s.abs() / TURN_HALF_RAD_S);
        let end_mps = if parameters.speed_mps < 0.0 { BACKWARD_MAX } else { AHEAD_MAX } * scale_mps;
        let aside_end_mps = ASIDE_MAX * scale_mps;
        let reach = Vec2::new(parameters.speed_mps / end_mps, parameters.strafe_mps / aside_end_mps).length().max(1.0);
        Parameters {
            speed_mps: parameters.speed_mps / reach,
            turn_rate_rad_s,
            strafe_mps: parameters.strafe_mps / reach,
        }
    }

    /// The deformed pose.
    pub fn pose(&self, db: &MotionDb, parameters: Parameters, phase: f32) -> Pose {
        let instant = Instant::new(parameters, phase);
        let mut pose = self.mixed_pose(db, &instant);
        self.calm(&mut pose, parameters);
        twist(&mut pose, parameters);
        let lean_rad = lean_rad(parameters);
        lean(&mut pose, lean_rad);
        let outward_m = -self.hips_m * libm::tanf(lean_rad);
        let contacts = self.contacts(db, parameters, phase);
        let feet = [0, 1].map(|side| {
            let mut foot = self.mixed_foot(&instant, side);
            foot.place_m += contacts[side] * instant.slip() * self.slip_m(&db.skeleton, &foot, side);
            self.carried_foot(parameters, &foot, side, outward_m)
        });
        for (thigh, (_, yaw_rad)) in Joint::THIGHS.into_iter().zip(feet) {
            let rotation = &mut pose.rotations[thigh.index()];
            *rotation = Quat::from_rotation_z(KNEE_YAW * yaw_rad) * *rotation;
        }
        let mut legs = legs(&pose, &db.skeleton);
        let targets = feet.map(|(target, _)| target);
        pelvis::lower(&mut pose, &mut legs, &db.skeleton, &targets);
        for (side, (leg, target)) in legs.iter_mut().zip(&targets).enumerate() {
            ik::reach(&mut pose, leg, &db.skeleton, side, target);
        }
        pose
    }

    fn mixed_pose(&self, db: &MotionDb, instant: &Instant) -> Pose {
        let mut pose = Pose { pelvis_m: Vec3::ZERO, rotations: [Quat::from_xyzw(0.0, 0.0, 0.0, 0.0); JOINT_COUNT] };
        for (row, weight) in instant.rows() {
            pose.pelvis_m += weight * db.rows.pelvis_m[self.example * PHASE_COUNT + row];
            for (sum, rotation) in pose.rotations.iter_mut().zip(db.rows.rotations(self.example, row)) {
                *sum += *rotation * weight;
            }
        }
        // Rows share a hemisphere, so a sum is never near zero.
        pose.rotations.iter_mut().for_each(|rotation| *rotation = rotation.normalize());
        pose
    }

    /// Hips, trunk and arms swing less about their means where strides are shorter, and more where they are longer.
    fn calm(&self, pose: &mut Pose, parameters: Parameters) {
        let travel_mps = Vec2::new(parameters.speed_mps, parameters.strafe_mps).length();
        let stride = (travel_mps / (self.parameters.speed_mps * self.cadence(parameters))).clamp(SWING[0], SWING[1]);
        for joint in 0..Joint::LeftThigh.index() {
            pose.rotations[joint] = (self.mean[joint] * (1.0 - stride) + pose.rotations[joint] * stride).normalize();
        }
    }

    fn mixed_foot(&self, instant: &Instant, side: usize) -> Foothold {
        let nothing = Quat::from_xyzw(0.0, 0.0, 0.0, 0.0);
        let mut mixed = Foothold { since_s: 0.0, place_m: Vec3::ZERO, orientation: nothing };
        for (index, (row, weight)) in instant.rows().into_iter().enumerate() {
            let foot = &self.feet[row][side];
            mixed.since_s += if index < 2 { weight } else { -weight } * foot.since_s;
            mixed.place_m += weight * foot.place_m;
            mixed.orientation += foot.orientation * weight;
        }
        Foothold { orientation: mixed.orientation.normalize(), ..mixed }
    }

    /// A foot's roll and its reverse turn about ball and heel: their mean slips. This far back to where the lower of
    /// both was at mid-stance.
    fn slip_m(&self, skeleton: &Skeleton, foot: &Foothold, side: usize) -> Vec3 {
        let Foot { heel_m, ball_m, .. } = skeleton.feet[side];
        let [heel_off_m, ball_off_m] = [heel_m, ball_m].map(|point_m| foot.orientation * point_m);
        let (point_m, off_m) = if heel_off_m.z < ball_off_m.z { (heel_m, heel_off_m) } else { (ball_m, ball_off_m) };
        let resting = self.resting(side);
        let slip_m = resting.place_m + resting.orientation * point_m - foot.place_m - off_m;
        Vec3::new(slip_m.x, slip_m.y, 0.0)
    }

    /// A foot at its mid-stance.
    fn resting(&self, side: usize) -> &Foothold {
        &self.feet[if side == 0 { PHASE_COUNT / 2 } else { 0 }][side]
    }

    /// Where a foot's place has been carried to, and the yaw that its foot has got by it.
    fn carried_foot(&self, parameters: Parameters, foot: &Foothold, side: usize, outward_m: f32) -> (FootTarget, f32) {
        let sign = Side::BOTH[side].sign();
        let carried = moved(&Root::default(), &parameters, foot.since_s / self.cadence(parameters));
        let toe_out_rad = sign * self.toe_out_rad(parameters);
        let yaw_rad = toe_out_rad - carried.facing_rad;
        let middle_m = self.resting(side).place_m;
        let place_m = middle_m
            + Quat::from_rotation_z(toe_out_rad) * (foot.place_m - middle_m)
            + Vec3::new(0.0, outward_m + sign * self.widening_m(parameters), 0.0);
        let target = FootTarget {
            ankle_m: carried.frame().to_local(place_m),
            orientation: Quat::from_rotation_z(yaw_rad) * foot.orientation,
        };
        (target, yaw_rad)
    }

    /// Angle by which the root turns between the landings of both feet, at most.
    fn turn_apart_rad(&self, parameters: Parameters) -> f32 {
        self.apart_s * parameters.turn_rate_rad_s.abs() / self.cadence(parameters)
    }

    /// How far each place moves outward, so that the legs do not cross where they step aside or turn.
    fn widening_m(&self, parameters: Parameters) -> f32 {
        let aside_m = self.apart_s * parameters.strafe_mps.abs() / self.cadence(parameters);
        let turning_m = FOOT_M * libm::sinf((0.5 * self.turn_apart_rad(parameters)).min(FRAC_PI_2));
        (0.5 * (aside_m + turning_m + GAP_M - self.track_m)).max(0.0)
    }

    /// In a turn feet open and close rather than point inward.
    fn toe_out_rad(&self, parameters: Parameters) -> f32 {
        TOE_OUT * 0.5 * self.turn_apart_rad(parameters)
    }
}

/// Rows share a hemisphere, so a sum is never near zero.
fn mean(db: &MotionDb, example: usize) -> [Quat; JOINT_COUNT] {
    let mut mean = [Quat::from_xyzw(0.0, 0.0, 0.0, 0.0); JOINT_COUNT];
    for row in 0..PHASE_COUNT {
        mean.iter_mut().zip(db.rows.rotations(example, row)).for_each(|(sum, rotation)| *sum += *rotation);
    }
    mean.map(Quat::normalize)
}

/// Whether a step from one to the other turns the gait about: where the travel passes through rest, or near it, what is
/// played forward is all at once played backward.
pub fn turns_about(from: Parameters, to: Parameters) -> bool {
    let [from, to] = [from, to].map(directions);
    (to[0] - from[0]).abs() > TURN_ABOUT
}

/// Shares of time played forward and backward: the nearer to backward, the more of reversed time.
fn directions(parameters: Parameters) -> [f32; 2] {
    let travel = Vec2::new(parameters.speed_mps, parameters.strafe_mps);
    let ahead = if travel == Vec2::ZERO { 1.0 } else { travel.x / travel.length() };
    [0.5 + 0.5 * ahead, 0.5 - 0.5 * ahead]
}

impl Instant {
    fn new(parameters: Parameters, phase: f32) -> Self {
        let reversed = 1.0 - phase;
        Self { phases: [phase, reversed - libm::floorf(reversed)], shares: directions(parameters) }
    }

    /// How much of a slip there is to take back: 0 in either direction of time alone, 1 between both.
    fn slip(&self) -> f32 {
        4.0 * self.shares[0] * self.shares[1]
    }

    /// The stored rows about the phase, then those about the reversed one, and their weights.
    fn rows(&self) -> [(usize, f32); 4] {
        let [forward, reversed] = [0, 1].map(|index| {
            let (rows, shares) = two_rows(self.phases[index]);
            [0, 1].map(|row| (rows[row], shares[row] * self.shares[index]))
        });
        [forward[0], forward[1], reversed[0], reversed[1]]
    }
}

/// Hips turn towards the travel, or against a travel behind; the spine turns back, so that the chest keeps the facing.
fn twist(pose: &mut Pose, parameters: Parameters) {
    let travel = Vec2::new(parameters.speed_mps, parameters.strafe_mps);
    let twice = 2.0 * travel.x * travel.y / travel.length_squared().max(f32::MIN_POSITIVE);
    let hips = Quat::from_rotation_z(0.5 * HIP_TWIST * twice);
    let [pelvis, spine] = [Joint::Pelvis, Joint::SpineLower].map(Joint::index);
    pose.rotations[pelvis] = hips * pose.rotations[pelvis];
    pose.rotations[spine] = hips.inverse() * pose.rotations[spine];
}

/// Positive to the left.
fn lean_rad(parameters: Parameters) -> f32 {
    libm::atanf(parameters.speed_mps * parameters.turn_rate_rad_s / GRAVITY_MPS2).clamp(-LEAN_MAX_RAD, LEAN_MAX_RAD)
}

/// The body leans about its hips, which stay over the root: the feet stand outward.
fn lean(pose: &mut Pose, lean_rad: f32) {
    pose.rotations[0] = Quat::from_rotation_x(-lean_rad) * pose.rotations[0];
    pose.pelvis_m.z *= libm::cosf(lean_rad);
}

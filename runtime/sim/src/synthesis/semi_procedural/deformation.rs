//! m_sp deformed to some (v_f, ω_t, ω_s): phases, contacts and poses of the walk at exactly these (`FbCrowd` §5;
//! [`crate::synthesis::semi_procedural::base_walk`] tells how).
//!
//! - The cadence shares a change of speed with the stride: both grow with its root, so their ratio keeps (walk ratio).
//! - Backward gait is nearly forward gait in reversed time (Winter, Pluck, Yang 1989). Phases 0 and ½ are mid-stances,
//!   so −φ is the cycle reversed; walking backward plays it, and the mean of both, whose legs swing neither way, steps
//!   aside.
//! - Hips swing down to where each foot lands ([`crate::synthesis::semi_procedural::landing`]), and are as high over the straighter leg as in m_sp.
//! - The places move apart for side-steps and turns, so that legs do not cross, and outward where the body leans.
//! - Hips, trunk and arms swing as much as the stride is long.
//!
//! Root frame: x forward, y left, z up, metres; seconds; radians.

use std::f32::consts::FRAC_PI_2;

use glam::{Quat, Vec2, Vec3};
use motiondb::body::{Foot, Joint, Joints, Pose, Side, Skeleton};
use motiondb::motion::{MotionDb, PHASE_COUNT, Parameters, PhaseMap, wrapped};
use motiondb::quality::planted_feet::CycleFeet;

use crate::maths::angle::{direction, yaw};
use crate::maths::arc::carried;
use crate::synthesis::blending::mix::two_rows;
use crate::synthesis::pose::leg::FootPose;
use crate::synthesis::pose::pelvis;
use crate::synthesis::pose::posture::Posture;
use crate::synthesis::semi_procedural::base_walk::SemiProcedural;
use crate::synthesis::semi_procedural::foot_path::Foothold;
use crate::synthesis::semi_procedural::landing::lowering;

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
/// Of what hips must come down by for a foot that lands: they are low in time, and low until the other foot leaves.
const LANDING_SHARE: f32 = 1.15;
/// Sizes of side speeds and turn rates are rounded off below about this, m/s and rad/s: |x| has an edge at 0, and feet
/// that move apart by it would jerk where a body changes sides.
const ROUNDING: f32 = 0.1;
/// Gravity, m/s²: a body on an arc leans by atan(v·ω/g).
const GRAVITY_MPS2: f32 = 9.81;
/// Nobody leans further: the tangent of 20°.
const LEAN_MAX: f32 = 0.365;

/// m_sp at some parameters: all that a walk depends on besides its phase.
#[derive(Clone, Copy, Debug)]
pub struct Deformation<'a> {
    tempo: Tempo<'a>,
    parameters: Parameters,
    /// Swing of hips, trunk and arms over that of m_sp.
    swing: f32,
    /// The lean's cosine and sine, the latter positive to the left.
    lean: Vec2,
    /// Of either foot: in a turn feet open and close rather than point inward.
    toe_out_rad: f32,
    /// How much lower than in m_sp the hips are where a foot lands, m.
    lowered_m: f32,
    /// How far each place moves outward, so that the legs do not cross where they step aside or turn, m.
    widening_m: f32,
}

/// When m_sp is played, at some parameters.
#[derive(Clone, Copy, Debug)]
pub struct Tempo<'a> {
    of: &'a SemiProcedural,
    /// Over that of m_sp.
    cadence: f32,
    /// Direction of travel; shorter than 1 while it turns about.
    way: Vec2,
    /// Shares of time played forward and backward: the nearer to backward, the more of reversed time.
    directions: [f32; 2],
}

/// One instant of m_sp, played forward and backward at once.
struct Instant {
    phases: [f32; 2],
    shares: [f32; 2],
}

impl<'a> Deformation<'a> {
    /// To parameters that [`SemiProcedural::reachable`] would leave as they are.
    pub fn new(of: &'a SemiProcedural, parameters: Parameters) -> Self {
        Self::going(of, parameters, travel(parameters, Vec2::X))
    }

    /// The same for a body that turns about: its gait still goes another way than its root.
    pub fn going(of: &'a SemiProcedural, parameters: Parameters, way: Vec2) -> Self {
        let tempo = Tempo::new(of, parameters, way);
        let travel_mps = Vec2::new(parameters.speed_mps, parameters.strafe_mps).length();
        // Angle by which the root turns between the landings of both feet, at most.
        let turn_apart_rad = of.apart_s * rounded_size(parameters.turn_rate_rad_s) / tempo.cadence;
        let aside_m = of.apart_s * rounded_size(parameters.strafe_mps) / tempo.cadence;
        let turning_m = FOOT_M * direction((0.5 * turn_apart_rad).min(FRAC_PI_2)).y;
        let level = Self {
            tempo,
            parameters,
            swing: (travel_mps / (of.parameters.speed_mps * tempo.cadence)).clamp(SWING[0], SWING[1]),
            lean: lean(parameters),
            toe_out_rad: TOE_OUT * 0.5 * turn_apart_rad,
            lowered_m: 0.0,
            widening_m: (0.5 * (aside_m + turning_m + GAP_M - of.track_m)).max(0.0),
        };
        let lower_m = LANDING_SHARE * pelvis::softly_positive_m(level.landing_lower_m());
        Self { lowered_m: lower_m.min(pelvis::DROP_MAX_M), ..level }
    }

    /// How much lower than in m_sp the hips must be where feet land, m, as if the root went straight on over them.
    fn landing_lower_m(&self) -> f32 {
        let went_mps = Vec2::new(self.parameters.speed_mps, self.parameters.strafe_mps) / self.tempo.cadence;
        let aside_m = Vec2::new(0.0, self.leaning_m());
        let [forward, reversed] =
            self.tempo.of.landings.map(|foot| foot.lower_m(foot.ahead_s * went_mps + aside_m, self.widening_m));
        self.tempo.directions[0] * forward + self.tempo.directions[1] * reversed
    }

    /// How far feet stand to the left, as the body leans over them.
    fn leaning_m(&self) -> f32 {
        -self.tempo.of.hips_m * self.lean.y / self.lean.x
    }

    /// Phase to time.
    pub fn phase_map(&self) -> PhaseMap {
        self.tempo.phase_map()
    }

    /// The whole cycle: its postures at each stored phase.
    pub fn cycle(&self, db: &MotionDb) -> Vec<Posture> {
        let row = |row: usize| {
            let mut posture = self.posture(db, row as f32 / PHASE_COUNT as f32);
            posture.bend_legs(&db.skeleton);
            posture
        };
        (0..PHASE_COUNT).map(row).collect()
    }

    /// Its joints and feet, to be measured.
    pub fn measurable(&self, skeleton: &Skeleton, cycle: &[Posture]) -> (Vec<Joints>, CycleFeet) {
        let posed = |posture: &Posture| (posture.pose.forward_kinematics(skeleton), posture.contacts);
        let (joints, contacts): (Vec<Joints>, Vec<[f32; 2]>) = cycle.iter().map(posed).unzip();
        let feet = CycleFeet::new(skeleton, &joints, &contacts, self.phase_map());
        (joints, feet)
    }

    /// Contact of each foot, `[left, right]`: a foot is planted that stands in the cycle and in its reverse.
    pub fn contacts(&self, db: &MotionDb, phase: f32) -> [f32; 2] {
        let Instant { phases, shares } = self.instant(phase);
        let of_one = |index: usize| {
            let (rows, shares) = two_rows(phases[index]);
            let row = |row: usize| Vec2::from(db.rows.contacts[self.tempo.of.example * PHASE_COUNT + row]);
            (shares[0] * row(rows[0]) + shares[1] * row(rows[1])).to_array()
        };
        let [forward, reversed] = [0, 1].map(of_one);
        // Mostly both stand, or neither does.
        [0, 1].map(|side| match [forward[side], reversed[side]] {
            [both, same] if both == same => both,
            [forward, reversed] => libm::powf(forward, shares[0]) * libm::powf(reversed, shares[1]),
        })
    }

    /// Seconds until a swinging foot lands: where it does in the cycle or, in reversed time, where it leaves.
    pub fn time_to_landing_s(&self, phase: f32, side: usize) -> f32 {
        let [forward, reversed] = self.tempo.directions;
        let [strike, off] = self.tempo.of.contacts[side];
        let ahead = |landing: f32| (landing - phase).rem_euclid(1.0);
        (forward * ahead(strike) + reversed * ahead(1.0 - off)) / self.phase_map().rate_hz(phase)
    }

    /// Planted-foot slide of m_sp, at the cadence at which it is played, cm/s.
    pub fn examples_slide_cm_s(&self, db: &MotionDb) -> f32 {
        self.tempo.cadence * db.examples[self.tempo.of.example].planted_slide_cm_s
    }

    /// The pose before its legs have bent, and its feet.
    pub fn posture(&self, db: &MotionDb, phase: f32) -> Posture {
        let instant = self.instant(phase);
        let mut pose = db.rows.blended(instant.rows().map(|(row, weight)| (self.tempo.of.example, row, weight)));
        self.calm(&mut pose);
        twist(&mut pose, self.tempo.way);
        self.lean_over(&mut pose);
        pose.pelvis_m.z -= self.lowered_m * lowering(2.0 * (phase - self.tempo.of.lowest));
        let contacts = self.contacts(db, phase);
        let feet = [0, 1].map(|side| {
            let (foot, yaw_rad) = self.foot(&db.skeleton, contacts[side], &instant, side);
            let thigh = &mut pose.rotations[Joint::THIGHS[side].index()];
            *thigh = yaw(KNEE_YAW * yaw_rad) * *thigh;
            foot
        });
        let mut posture = Posture::new(pose, contacts, &db.skeleton);
        posture.move_feet(feet, &db.skeleton);
        posture
    }

    /// Where a foot is to be, and its yaw.
    fn foot(&self, skeleton: &Skeleton, contact: f32, instant: &Instant, side: usize) -> (FootPose, f32) {
        let mut foot = self.mixed_foot(instant, side);
        foot.place_m += instant.slip() * contact * self.slip_m(skeleton, &foot, side);
        self.carried_foot(&foot, side)
    }

    fn instant(&self, phase: f32) -> Instant {
        Instant { phases: [phase, wrapped(1.0 - phase)], shares: self.tempo.directions }
    }

    /// Hips, trunk and arms swing less about their means where strides are shorter, and more where they are longer.
    fn calm(&self, pose: &mut Pose) {
        for (rotation, mean) in pose.rotations.iter_mut().zip(&self.tempo.of.mean).take(Joint::LeftThigh.index()) {
            *rotation = (*mean * (1.0 - self.swing) + *rotation * self.swing).normalize();
        }
    }

    /// The body leans about its hips, which stay over the root: the feet stand outward.
    fn lean_over(&self, pose: &mut Pose) {
        let half = (self.lean + Vec2::X).normalize();
        pose.rotations[0] = Quat::from_xyzw(-half.y, 0.0, 0.0, half.x) * pose.rotations[0];
        pose.pelvis_m.z *= self.lean.x;
    }

    fn mixed_foot(&self, instant: &Instant, side: usize) -> Foothold {
        let nothing = Quat::from_xyzw(0.0, 0.0, 0.0, 0.0);
        let mut mixed = Foothold { since_s: 0.0, place_m: Vec3::ZERO, orientation: nothing };
        for (index, (row, weight)) in instant.rows().into_iter().enumerate() {
            let foot = &self.tempo.of.feet[row][side];
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
        let resting = self.tempo.of.resting(side);
        let slip_m = resting.place_m + resting.orientation * point_m - foot.place_m - off_m;
        Vec3::new(slip_m.x, slip_m.y, 0.0)
    }

    /// Where a foot's place has been carried to, and the yaw that its foot has got by it.
    fn carried_foot(&self, foot: &Foothold, side: usize) -> (FootPose, f32) {
        let sign = Side::BOTH[side].sign();
        let since_s = foot.since_s / self.tempo.cadence;
        let (carried, half_turn) = carried(&self.parameters, since_s);
        let toe_out_rad = sign * self.toe_out_rad;
        // A rotation is made of the direction at half its angle: here out by the toes, and back by the turn.
        let half_toe_out = direction(0.5 * toe_out_rad);
        let half_yaw = Vec2::new(half_turn.x, -half_turn.y).rotate(half_toe_out);
        let middle_m = self.tempo.of.resting(side).place_m;
        let off_m = foot.place_m - middle_m;
        let place_m = middle_m
            + half_toe_out.rotate(half_toe_out).rotate(off_m.truncate()).extend(off_m.z)
            + Vec3::new(0.0, self.leaning_m() + sign * self.widening_m, 0.0);
        let orientation = Quat::from_xyzw(0.0, 0.0, half_yaw.y, half_yaw.x) * foot.orientation;
        let target = FootPose { ankle_m: carried.to_local(place_m), orientation };
        (target, toe_out_rad - since_s * self.parameters.turn_rate_rad_s)
    }
}

impl<'a> Tempo<'a> {
    /// Of m_sp at some parameters.
    pub fn new(of: &'a SemiProcedural, parameters: Parameters, way: Vec2) -> Self {
        // A spring may swing beyond its end.
        let way = way.clamp_length_max(1.0);
        let directions = [0.5 + 0.5 * way.x, 0.5 - 0.5 * way.x];
        Self { of, cadence: of.cadence(parameters), way, directions }
    }

    /// Phase to time. Reversed time exchanges the half-strides.
    pub fn phase_map(&self) -> PhaseMap {
        let ([forward, reversed], map) = (self.directions, &self.of.phase_map);
        PhaseMap {
            period_s: map.period_s / self.cadence,
            left_share: 0.5 + (map.left_share - 0.5) * (forward - reversed),
        }
    }
}

impl Instant {
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

/// Direction of travel; `resting` where there is none.
pub(crate) fn travel(parameters: Parameters, resting: Vec2) -> Vec2 {
    Vec2::new(parameters.speed_mps, parameters.strafe_mps).normalize_or(resting)
}

/// Hips turn towards the travel, or against a travel behind; the spine turns back, so that the chest keeps the facing.
fn twist(pose: &mut Pose, way: Vec2) {
    let hips = yaw(HIP_TWIST * way.x * way.y);
    let [pelvis, spine] = [Joint::Pelvis, Joint::SpineLower].map(Joint::index);
    pose.rotations[pelvis] = hips * pose.rotations[pelvis];
    pose.rotations[spine] = hips.conjugate() * pose.rotations[spine];
}

/// The size of a value, without an edge at none.
fn rounded_size(value: f32) -> f32 {
    value * value / libm::sqrtf(value * value + ROUNDING * ROUNDING)
}

/// Cosine and sine of the lean, the latter positive to the left.
fn lean(parameters: Parameters) -> Vec2 {
    let tangent = parameters.speed_mps * parameters.turn_rate_rad_s / GRAVITY_MPS2;
    Vec2::new(1.0, tangent.clamp(-LEAN_MAX, LEAN_MAX)).normalize()
}

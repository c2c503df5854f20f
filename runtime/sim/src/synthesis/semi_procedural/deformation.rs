//! Deformation of m_sp to (v_f, ω_t, ω_s): phase map, contacts and poses of a walk at exactly these (`FbCrowd` §5).
//!
//! - Cadence and stride share a change of speed: each grows with its square root, so their ratio is constant (walk
//!   ratio).
//! - Backward gait is nearly forward gait in reversed time (Winter, Pluck, Yang 1989). Phases 0 and ½ are mid-stances,
//!   so −φ is the reversed cycle. A body that walks backward plays it. A body that side-steps plays the mean of both,
//!   in which legs swing neither forward nor backward.
//! - Hips oscillate down to the landing of each foot ([`crate::synthesis::semi_procedural::landing`]); otherwise they
//!   keep their height above the straighter leg.
//! - Foot positions move apart in side-steps and turns, so that legs do not cross, and outward where the body leans.
//! - The amplitude of hips, trunk and arms grows with the stride.
//! - In shorter strides of the toes feet roll and lift less, and stand under the hips as in a body that stands. The hips
//!   rise and fall by the square of that stride, as on a pendulum. In wide side-steps feet roll more: otherwise the hips
//!   would drop between legs that spread.
//!
//! [`crate::synthesis::semi_procedural::base_walk`] describes how the feet are carried.
//!
//! Root frame (x forward, y left, z up); metres, seconds, radians. Pairs of sides are `[left, right]`, pairs of
//! directions of time `[forward, reversed]`.

use std::f32::consts::FRAC_PI_2;

use glam::{Quat, Vec2, Vec3};
use motiondb::body::{Foot, Joint, Joints, Pose, Side, Skeleton};
use motiondb::motion::{MotionDb, PHASE_COUNT, Parameters, PhaseMap, wrapped};
use motiondb::quality::planted_feet::CycleFeet;

use crate::maths::angle::{unit_vector, yaw};
use crate::maths::arc::arc_frame;
use crate::synthesis::blending::pose_weights::rows_at;
use crate::synthesis::pose::lean::incline::{TRUNK_SHARE, incline};
use crate::synthesis::pose::upper_body::curve_look::turn_ahead;
use crate::synthesis::pose::{FootPose, Posture, pelvis};
use crate::synthesis::semi_procedural::base_walk::{BaseWalk, lean_rad};
use crate::synthesis::semi_procedural::foot_path::FootPathPoint;
use crate::synthesis::semi_procedural::landing::drop_share;

/// Least lateral distance between ankles that pass each other, m: a foot's width.
const ANKLE_GAP_M: f32 = 0.1;
/// Distance from ankle to toe tip, m: how far an inward foot reaches across.
const FOOT_LENGTH_M: f32 = 0.2;
/// Share of half the turn between two landings by which feet point outward.
const TOE_OUT_SHARE: f32 = 0.7;
/// Share of a foot's yaw that the thigh follows; the ankle does the rest.
const KNEE_YAW_SHARE: f32 = 0.7;
/// Share of the angle between travel and facing by which hips twist towards the travel.
const HIP_TWIST_SHARE: f32 = 0.3;
/// Share by which a side-step at the speed of m_sp counts as a longer stride of the toes; slower ones count as longer by
/// less (docs/tuning.md).
const WIDE_STRIDE: f32 = 0.7;
/// Stride of the toes from which on feet roll in full, divided by that of m_sp.
const FULL_STRIDE: f32 = 0.85;
/// Least stride by which feet roll, divided by that from which on they roll in full.
const STRIDE_MIN: f32 = 0.15;
/// Lift of the feet in the shortest stride, divided by that of m_sp: a short step still clears the ground.
const LIFT_MIN: f32 = 0.4;
/// Least and greatest amplitude of hips, trunk and arms, divided by that of m_sp.
const AMPLITUDE_RANGE: [f32; 2] = [0.3, 1.3];
/// Factor on the drop of the hips at a landing: they are low early enough, and stay low until the other foot leaves.
const LANDING_DROP_FACTOR: f32 = 1.15;
/// Softness of |ω_s| and |ω_t| near 0, m/s and rad/s: an edge would jerk the feet where a body changes sides.
const SOFT_SIZE: f32 = 0.1;

/// m_sp at some parameters: all that the walk depends on besides its phase.
#[derive(Clone, Copy, Debug)]
pub struct Deformation<'a> {
    tempo: Tempo<'a>,
    parameters: Parameters,
    /// Amplitude of hips, trunk and arms, divided by that of m_sp.
    amplitude: f32,
    /// Stride of the toes, divided by that from which on feet roll in full, within [`STRIDE_MIN`] and 1.
    stride: f32,
    /// Lean to the left, rad.
    lean_rad: f32,
    /// Its cosine and sine.
    lean: Vec2,
    /// Outward yaw of each foot, rad: in a turn feet open and close rather than point inward.
    toe_out_rad: f32,
    /// Drop of the hips against m_sp where a foot lands, m.
    landing_drop_m: f32,
    /// Outward displacement of each foot, m: legs do not cross in side-steps and turns.
    widening_m: f32,
}

/// The timing of m_sp at some parameters.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Tempo<'a> {
    base: &'a BaseWalk,
    /// Cadence, divided by that of m_sp.
    cadence: f32,
    /// Direction of travel; shorter than 1 while it turns about.
    travel: Vec2,
    /// Weights of forward and reversed time: the further backward the travel, the more of reversed time.
    time_weights: [f32; 2],
}

/// One instant of m_sp in forward and reversed time.
struct Instant {
    phases: [f32; 2],
    weights: [f32; 2],
}

impl<'a> Deformation<'a> {
    /// m_sp at parameters that [`BaseWalk::reachable`] leaves unchanged.
    pub fn new(base: &'a BaseWalk, parameters: Parameters) -> Self {
        Self::travelling(base, parameters, travel_direction(parameters, Vec2::X), 1.0)
    }

    /// m_sp of a body whose gait travels in another direction than its root, because it turns about; its cadence is
    /// `quickness` times that of other bodies.
    pub fn travelling(base: &'a BaseWalk, parameters: Parameters, travel: Vec2, quickness: f32) -> Self {
        let tempo = Tempo::new(base, parameters, travel, quickness);
        let travel_mps = parameters.velocity_mps().length();
        // Greatest turn and side displacement of the root between the landings of both feet.
        let turn_apart_rad = base.carried_apart_s * soft_size(parameters.turn_rate_rad_s) / tempo.cadence;
        let strafe_apart_m = base.carried_apart_s * soft_size(parameters.strafe_mps) / tempo.cadence;
        let turn_apart_m = FOOT_LENGTH_M * unit_vector((0.5 * turn_apart_rad).min(FRAC_PI_2)).y;
        let lean_rad = lean_rad(&parameters);
        let Parameters { speed_mps, turn_rate_rad_s, strafe_mps } = parameters;
        let base_mps = base.parameters.speed_mps;
        let wide_mps = strafe_mps * (1.0 + WIDE_STRIDE * strafe_mps.abs() / base_mps);
        let toe_mps = Vec2::new(speed_mps, wide_mps).length() + FOOT_LENGTH_M * soft_size(turn_rate_rad_s);
        // Strides of the hips and of the toes, divided by that of m_sp.
        let [hip_stride, toe_stride] = [travel_mps, toe_mps].map(|mps| mps / (base_mps * tempo.cadence));
        let level = Self {
            tempo,
            parameters,
            amplitude: hip_stride.clamp(AMPLITUDE_RANGE[0], AMPLITUDE_RANGE[1]),
            stride: (toe_stride / FULL_STRIDE).clamp(STRIDE_MIN, 1.0),
            lean_rad,
            lean: unit_vector(lean_rad),
            toe_out_rad: TOE_OUT_SHARE * 0.5 * turn_apart_rad,
            landing_drop_m: 0.0,
            widening_m: (0.5 * (strafe_apart_m + turn_apart_m + ANKLE_GAP_M - base.track_m)).max(0.0),
        };
        let drop_m = LANDING_DROP_FACTOR * pelvis::soft_positive_m(level.needed_landing_drop_m());
        Self { landing_drop_m: drop_m.min(pelvis::DROP_MAX_M), ..level }
    }

    /// Drop of the hips against m_sp at which landing feet are in reach, m, as if the root moved straight over them.
    fn needed_landing_drop_m(&self) -> f32 {
        let stride_mps = self.parameters.velocity_mps() / self.tempo.cadence;
        let lean_m = Vec2::new(0.0, self.lean_offset_m());
        let [forward, reversed] =
            self.tempo.base.landings.map(|foot| foot.drop_m(foot.ahead_s * stride_mps + lean_m, self.widening_m));
        self.tempo.time_weights[0] * forward + self.tempo.time_weights[1] * reversed
    }

    /// Displacement of the feet to the left under a leaning body, m.
    fn lean_offset_m(&self) -> f32 {
        -self.tempo.base.mean_hips_m * self.lean.y
    }

    /// Phase to time.
    pub fn phase_map(&self) -> PhaseMap {
        self.tempo.phase_map()
    }

    /// The postures of the whole cycle, at each stored phase.
    pub fn cycle(&self, db: &MotionDb) -> Vec<Posture> {
        let row = |row: usize| {
            let mut posture = self.posture(db, row as f32 / PHASE_COUNT as f32);
            posture.bend_legs(&db.skeleton);
            posture
        };
        (0..PHASE_COUNT).map(row).collect()
    }

    /// Joints and feet of a cycle, for measurements.
    pub fn measurable(&self, skeleton: &Skeleton, cycle: &[Posture]) -> (Vec<Joints>, CycleFeet) {
        let posed = |posture: &Posture| (posture.pose.forward_kinematics(skeleton), posture.contacts);
        let (joints, contacts): (Vec<Joints>, Vec<[f32; 2]>) = cycle.iter().map(posed).unzip();
        let feet = CycleFeet::new(skeleton, &joints, &contacts, self.phase_map());
        (joints, feet)
    }

    /// Contact of each foot: a foot is planted that stands in forward and in reversed time.
    pub fn contacts(&self, db: &MotionDb, phase: f32) -> [f32; 2] {
        let Instant { phases, weights } = self.instant(phase);
        let in_time = |time: usize| {
            let (rows, shares) = rows_at(phases[time]);
            let row = |row: usize| Vec2::from(db.rows.contacts[self.tempo.base.example * PHASE_COUNT + row]);
            (shares[0] * row(rows[0]) + shares[1] * row(rows[1])).to_array()
        };
        let [forward, reversed] = [0, 1].map(in_time);
        // Both usually agree.
        [0, 1].map(|side| match [forward[side], reversed[side]] {
            [both, same] if both == same => both,
            [forward, reversed] => libm::powf(forward, weights[0]) * libm::powf(reversed, weights[1]),
        })
    }

    /// Time until a swinging foot lands, s: at its strike or, in reversed time, at its toe-off.
    pub(crate) fn time_to_landing_s(&self, phase: f32, side: usize) -> f32 {
        let [forward, reversed] = self.tempo.time_weights;
        let [strike, off] = self.tempo.base.contact_phases[side];
        let ahead = |landing: f32| (landing - phase).rem_euclid(1.0);
        (forward * ahead(strike) + reversed * ahead(1.0 - off)) / self.phase_map().rate_hz(phase)
    }

    /// Planted-foot slide of m_sp at the cadence at which it plays, cm/s.
    pub(crate) fn examples_slide_cm_s(&self, db: &MotionDb) -> f32 {
        self.tempo.cadence * db.examples[self.tempo.base.example].planted_slide_cm_s
    }

    /// The pose before its legs bend, with the targets of its feet.
    pub fn posture(&self, db: &MotionDb, phase: f32) -> Posture {
        let instant = self.instant(phase);
        let mut pose = db.rows.blended(instant.rows().map(|(row, weight)| (self.tempo.base.example, row, weight)));
        self.scale_amplitude(&mut pose);
        twist_hips(&mut pose, self.tempo.travel);
        turn_ahead(&mut pose, self.tempo.base.curve_look_rad, &db.skeleton);
        self.lean_body(&mut pose);
        pose.pelvis_m.z -= self.landing_drop_m * drop_share(2.0 * (phase - self.tempo.base.lowest_phase));
        let contacts = self.contacts(db, phase);
        let feet = [0, 1].map(|side| {
            let (foot, yaw_rad) = self.foot(&db.skeleton, contacts[side], &instant, side);
            let thigh = &mut pose.rotations[Joint::THIGHS[side].index()];
            *thigh = yaw(KNEE_YAW_SHARE * yaw_rad) * *thigh;
            foot
        });
        let mut posture = Posture::new(pose, contacts, &db.skeleton);
        posture.move_feet(feet, &db.skeleton);
        posture
    }

    /// Rows of the extra joints of m_sp, in forward and in reversed time, and their weights.
    pub(crate) fn extra_rows<'db>(&self, db: &'db MotionDb, phase: f32) -> [(&'db [Quat], f32); 4] {
        self.instant(phase).rows().map(|(row, weight)| (db.extra.row(self.tempo.base.example, row), weight))
    }

    /// Target of a foot, and its yaw, rad.
    fn foot(&self, skeleton: &Skeleton, contact: f32, instant: &Instant, side: usize) -> (FootPose, f32) {
        let foot = self.mixed_foot(instant, side);
        self.carried_foot(&self.rolled_foot(skeleton, &foot, instant.mixture() * contact, side), side)
    }

    fn instant(&self, phase: f32) -> Instant {
        Instant { phases: [phase, wrapped(1.0 - phase)], weights: self.tempo.time_weights }
    }

    /// Scales the deviations of hips, trunk and arms from their means, the rise and fall of the hips, and the bend of the
    /// toes.
    fn scale_amplitude(&self, pose: &mut Pose) {
        let upper = pose.rotations.iter_mut().zip(&self.tempo.base.mean_rotations).take(Joint::LeftThigh.index());
        for (rotation, mean) in upper {
            *rotation = scaled_turn(*mean, *rotation, self.amplitude);
        }
        pose.pelvis_m.z += (1.0 - self.stride * self.stride) * (self.tempo.base.top_hips_m - pose.pelvis_m.z);
        for toe in Joint::TOES.map(Joint::index) {
            let bent = pose.rotations[toe];
            // ±1 are the same rotation; the nearer one is level.
            let level = if bent.w < 0.0 { -Quat::IDENTITY } else { Quat::IDENTITY };
            pose.rotations[toe] = scaled_turn(level, bent, self.stride);
        }
    }

    /// Leans the body about its hips, which stay over the root; the feet stand outward. m_sp leans by itself.
    fn lean_body(&self, pose: &mut Pose) {
        let base = self.tempo.base;
        let beyond_rad = Vec2::new(0.0, self.lean_rad - base.lean_rad);
        incline(pose, beyond_rad, TRUNK_SHARE * beyond_rad);
        pose.pelvis_m.z *= self.lean.x / unit_vector(base.lean_rad).x;
    }

    /// A foot of m_sp, mixed of forward and reversed time.
    fn mixed_foot(&self, instant: &Instant, side: usize) -> FootPathPoint {
        let zero = Quat::from_xyzw(0.0, 0.0, 0.0, 0.0);
        let mut mixed = FootPathPoint { carried_s: 0.0, position_m: Vec3::ZERO, orientation: zero };
        for (index, (row, weight)) in instant.rows().into_iter().enumerate() {
            let foot = &self.tempo.base.feet[row][side];
            mixed.carried_s += if index < 2 { weight } else { -weight } * foot.carried_s;
            mixed.position_m += weight * foot.position_m;
            mixed.orientation += foot.orientation * weight;
        }
        FootPathPoint { orientation: mixed.orientation.normalize(), ..mixed }
    }

    /// A foot whose roll and lift fit the stride. It turns about the lower of its heel and ball.
    ///
    /// m_sp's roll and the reversed roll turn about ball and heel, so their mean slips: where they mix, a foot that stands
    /// loses `held_share` of its displacement from mid-stance.
    fn rolled_foot(&self, skeleton: &Skeleton, foot: &FootPathPoint, held_share: f32, side: usize) -> FootPathPoint {
        let base = self.tempo.base;
        let (middle, soles) = (base.mid_stance(side), &skeleton.feet[side]);
        let point_m = lower_end_m(soles, foot.orientation);
        let from_ankle_m = foot.orientation * point_m;
        let middle_m = middle.position_m + middle.orientation * point_m;
        let ground_m = middle.position_m.z + (middle.orientation * lower_end_m(soles, middle.orientation)).z;
        let lifted_m = foot.position_m.z + from_ankle_m.z - ground_m;
        let off_middle_m = (foot.position_m + from_ankle_m - middle_m).truncate();
        let orientation = scaled_turn(middle.orientation, foot.orientation, self.stride);
        let to_standing_m = (1.0 - self.stride) * base.to_standing_m[side];
        let along_m = middle_m.truncate() + Vec2::X * to_standing_m + self.stride * (1.0 - held_share) * off_middle_m
            - (orientation * point_m).truncate();
        let lift = LIFT_MIN + (1.0 - LIFT_MIN) * self.stride;
        let up_m = ground_m + lift * lifted_m - (orientation * lower_end_m(soles, orientation)).z;
        FootPathPoint { position_m: along_m.extend(up_m), orientation, ..*foot }
    }

    /// Target of a foot, carried along the arc of the parameters, and its yaw, rad.
    fn carried_foot(&self, foot: &FootPathPoint, side: usize) -> (FootPose, f32) {
        let sign = Side::BOTH[side].sign();
        let carried_s = foot.carried_s / self.tempo.cadence;
        let (carrier, half_turn) = arc_frame(&self.parameters, carried_s);
        let toe_out_rad = sign * self.toe_out_rad;
        // A quaternion is made of the direction at half its angle: here toe-out less turn.
        let half_toe_out = unit_vector(0.5 * toe_out_rad);
        let half_yaw = Vec2::new(half_turn.x, -half_turn.y).rotate(half_toe_out);
        let middle_m = self.tempo.base.mid_stance(side).position_m;
        let off_m = foot.position_m - middle_m;
        let position_m = middle_m
            + half_toe_out.rotate(half_toe_out).rotate(off_m.truncate()).extend(off_m.z)
            + Vec3::new(0.0, self.lean_offset_m() + sign * self.widening_m, 0.0);
        let orientation = Quat::from_xyzw(0.0, 0.0, half_yaw.y, half_yaw.x) * foot.orientation;
        let target = FootPose { ankle_m: carrier.to_local(position_m), orientation };
        (target, toe_out_rad - carried_s * self.parameters.turn_rate_rad_s)
    }
}

impl<'a> Tempo<'a> {
    /// The timing of m_sp at some parameters, at `quickness` times its cadence there.
    pub(crate) fn new(base: &'a BaseWalk, parameters: Parameters, travel: Vec2, quickness: f32) -> Self {
        // The spring of the travel may overshoot.
        let travel = travel.clamp_length_max(1.0);
        let time_weights = [0.5 + 0.5 * travel.x, 0.5 - 0.5 * travel.x];
        Self { base, cadence: quickness * base.cadence(parameters), travel, time_weights }
    }

    /// Phase to time; reversed time exchanges the half-strides.
    pub(crate) fn phase_map(&self) -> PhaseMap {
        let ([forward, reversed], map) = (self.time_weights, &self.base.phase_map);
        PhaseMap {
            period_s: map.period_s / self.cadence,
            left_share: 0.5 + (map.left_share - 0.5) * (forward - reversed),
        }
    }
}

impl Instant {
    /// How much both directions of time mix: 0 for either alone, 1 for their mean.
    fn mixture(&self) -> f32 {
        4.0 * self.weights[0] * self.weights[1]
    }

    /// (row, weight): the stored rows next to the phase, then those next to the reversed one.
    fn rows(&self) -> [(usize, f32); 4] {
        let [forward, reversed] = [0, 1].map(|time| {
            let (rows, shares) = rows_at(self.phases[time]);
            [0, 1].map(|row| (rows[row], shares[row] * self.weights[time]))
        });
        [forward[0], forward[1], reversed[0], reversed[1]]
    }
}

/// The lower of heel and ball of a foot with an orientation, relative to the ankle in the foot's frame, m.
fn lower_end_m(foot: &Foot, orientation: Quat) -> Vec3 {
    let [heel_m, ball_m] = [foot.heel_m, foot.ball_m];
    if (orientation * heel_m).z < (orientation * ball_m).z { heel_m } else { ball_m }
}

/// The rotation from one orientation towards another, by a share of the angle, which may exceed 1.
fn scaled_turn(from: Quat, to: Quat, share: f32) -> Quat {
    (from * (1.0 - share) + to * share).normalize()
}

/// Direction of travel, a unit vector; `at_rest` where there is none.
pub(crate) fn travel_direction(parameters: Parameters, at_rest: Vec2) -> Vec2 {
    parameters.velocity_mps().normalize_or(at_rest)
}

/// Turns the hips towards the travel, or against a backward one; the spine turns back, so that the chest keeps facing
/// forward.
fn twist_hips(pose: &mut Pose, travel: Vec2) {
    let hips = yaw(HIP_TWIST_SHARE * travel.x * travel.y);
    let [pelvis, spine] = [Joint::Pelvis, Joint::SpineLower].map(Joint::index);
    pose.rotations[pelvis] = hips * pose.rotations[pelvis];
    pose.rotations[spine] = hips.conjugate() * pose.rotations[spine];
}

/// |x| without an edge at 0.
fn soft_size(x: f32) -> f32 {
    x * x / libm::sqrtf(x * x + SOFT_SIZE * SOFT_SIZE)
}

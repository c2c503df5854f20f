//! Secondary motion: head, forearms and hands of a walking body move a little, and so do pelvis and head of one that
//! stands, each body in its own manner. `FbCrowd` does not have it.
//!
//! In captures of walks the head rolls with the stride (0.6 to 1.3 Hz hold half of the energy and more) and drifts (a
//! quarter below 0.6 Hz); it pitches with drift, stride and step; wrists flex with the stride and tremble a little.
//! Clips that were made by hand, or on few joints, lack this. Here noise n(t) adds what the base walk lacks of it:
//!
//! ```text
//! drift        A·n₁(t)
//! with the gait A·(n₂(t)·cos 2πkθ + n₃(t)·sin 2πkθ)     k = 1 with the stride, 2 with the step
//! tremor       A·n₄(t)
//! ```
//!
//! n is a cubic B-spline through drawn coefficients, which have a mean of their own for each body: twice continuously
//! differentiable, of unit variance. θ is the gait phase φ without its jumps: a difference decays softly. The motion
//! fades with the speed. People who stand sway over their feet, and so do most idles. Where a set has none, or one that is
//! still, pelvis and head of a body at rest drift instead.
//!
//! Frames of the parent joints; radians, metres, seconds, rad/s².

use std::f32::consts::TAU;

use glam::{Vec2, Vec3};
use motiondb::body::{Joint, Pose, Skeleton};
use motiondb::motion::{Action, MotionDb, PHASE_COUNT};

use crate::maths::angle::{rotation, unit_vector};
use crate::maths::random::SplitMix64;
use crate::synthesis::TimeStep;

/// Deviations of the head's roll and pitch in walks, rad (1°): in captures 0.4 to 2.3° and 0.4 to 3.1°.
const HEAD_RAD: [f32; 2] = [0.0175; 2];
/// Root mean square of the angular acceleration of hands in walks, rad/s²: in captures 11 to 52.
const HAND_RAD_S2: f32 = 18.0;
/// Deviation of a forearm's rotation about its axis, rad (2°).
const FOREARM_RAD: f32 = 0.035;
/// Deviations of a hand that flexes with the stride, with the step, and trembles about either axis, rad.
const HAND_RAD: [f32; 3] = [0.07, 0.035, 0.045];
/// Deviations of the pelvis of a body at rest, forward and to the left, m: in a capture of a person who stands (GAMES-105)
/// the pelvis stays in a box with a diagonal of 13 mm for 6 s.
const SWAY_M: Vec2 = Vec2::new(0.0045, 0.003);
/// Speed from which on a body does not rest, divided by that of a walk.
const RESTING_MAX: f32 = 0.3;
/// Shares of drift, stride and step in the variance of roll and pitch of the head.
const HEAD_SHARES: [[f32; 3]; 2] = [[0.25, 0.65, 0.1], [0.5, 0.3, 0.2]];
/// Intervals between the coefficients of drift, gait and tremor, s.
const KNOTS_S: [f64; 3] = [0.9, 2.5, 0.1];
/// Share of a body's own mean in the variance of a coefficient.
const OWN_SHARE: f32 = 0.4;
/// Deviation of a coefficient that is uniform in [−1, 1), and of a B-spline through such coefficients.
const DEVIATIONS: [f32; 2] = [0.577_350_26, 0.399_8];

/// What base walk and idles of a database lack of secondary motion: shares of the amplitudes, 0 to 1.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct LackingMotion {
    /// Of roll and pitch of the head.
    pub head: [f32; 2],
    /// Of forearms and hands.
    pub hands: f32,
    /// Of pelvis and head at rest.
    pub rest: f32,
}

impl LackingMotion {
    /// Compares an example, and the idles, with captures.
    pub fn of(db: &MotionDb, example: usize) -> Self {
        let joints = db.posed_rows(example);
        let deviation_rad = |axis: Vec3| {
            let tips = joints.iter().map(|joints| (joints.orientations[Joint::Head.index()] * axis).z);
            let (sum, squares) = tips.fold((0.0, 0.0), |(sum, squares), tip| (sum + tip, squares + tip * tip));
            let mean = sum / PHASE_COUNT as f32;
            libm::sqrtf((squares / PHASE_COUNT as f32 - mean * mean).max(0.0))
        };
        let map = &db.examples[example].phase_map;
        let dt_s = map.period_s / PHASE_COUNT as f32;
        let hand = |side: usize, row: usize| db.rows.pose(example, row % PHASE_COUNT).rotations[HANDS[side].index()];
        let turn = |side: usize, row: usize| {
            let between = hand(side, row + 1) * hand(side, row).conjugate();
            if between.w < 0.0 { -between } else { between }.to_scaled_axis() / dt_s
        };
        let accelerations = [0, 1].into_iter().flat_map(|side| {
            (0..PHASE_COUNT).map(move |row| ((turn(side, row + 1) - turn(side, row)) / dt_s).length_squared())
        });
        let own_rad_s2 = libm::sqrtf(accelerations.sum::<f32>() / (2 * PHASE_COUNT) as f32);
        let lacking = |own: f32, whole: f32| libm::sqrtf((1.0 - (own / whole) * (own / whole)).max(0.0));
        Self {
            head: [lacking(deviation_rad(Vec3::Y), HEAD_RAD[0]), lacking(deviation_rad(Vec3::X), HEAD_RAD[1])],
            hands: lacking(own_rad_s2, HAND_RAD_S2),
            rest: lacking(db.idles().map(pelvis_deviation_m).fold(0.0, f32::max), SWAY_M.length()),
        }
    }
}

const HANDS: [Joint; 2] = [Joint::LeftHand, Joint::RightHand];
const FOREARMS: [Joint; 2] = [Joint::LeftForearm, Joint::RightForearm];

/// The secondary motion of a body.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(crate) struct SecondaryMotion {
    /// Time since the body was made, s.
    time_s: f64,
    /// φ after the last step.
    phase: f32,
    /// φ − θ, its rate of change, 1/s, and its acceleration, 1/s².
    jump: [f32; 3],
    /// Share of the amplitude, 0 at rest to 1 in a walk.
    activity: f32,
}

impl SecondaryMotion {
    /// Follows a gait over one step that has advanced its phase by `advanced`, and may have let it jump, to `phase`.
    /// `walking` is the speed, divided by that of a walk.
    pub(crate) fn follow(&mut self, phase: f32, advanced: f32, walking: f32, step: &TimeStep) {
        let jumped = phase - self.phase - advanced;
        self.time_s += f64::from(step.dt_s);
        self.phase = phase;
        self.jump = step.secondary.decayed(self.jump);
        self.jump[0] += jumped - jumped.round();
        self.activity = walking.min(1.0);
    }

    /// Displacement of the pelvis of a body at rest, forward and to the left, m.
    pub(crate) fn sway_m(&self, seed: u64, amplitude: f32, lacking: &LackingMotion) -> Vec2 {
        let rest = self.rest(amplitude, lacking);
        if rest == 0.0 {
            return Vec2::ZERO;
        }
        let drift = noises(seed, 0, self.time_s / KNOTS_S[0]);
        rest * SWAY_M * Vec2::new(drift[4], drift[5])
    }

    /// Share of the amplitudes that pelvis and head have at rest: it fades in slow steps.
    fn rest(&self, amplitude: f32, lacking: &LackingMotion) -> f32 {
        let resting = (1.0 - self.activity / RESTING_MAX).max(0.0);
        amplitude * lacking.rest * resting * resting
    }

    /// Moves head, forearms and hands of a pose.
    pub(crate) fn add_to(
        &self,
        pose: &mut Pose,
        seed: u64,
        amplitude: f32,
        lacking: &LackingMotion,
        skeleton: &Skeleton,
    ) {
        let scale = amplitude * self.activity;
        let rest = self.rest(amplitude, lacking);
        if scale == 0.0 && rest == 0.0 {
            return;
        }
        let [drift, gait, tremor] = [0, 1, 2].map(|band| noises(seed, band as u64, self.time_s / KNOTS_S[band]));
        let stride = unit_vector(TAU * (self.phase - self.jump[0]));
        let step = Vec2::new(stride.x * stride.x - stride.y * stride.y, 2.0 * stride.x * stride.y);
        let with = |circle: Vec2, first: usize| circle.dot(Vec2::new(gait[first], gait[first + 1]));
        let tips_rad = [0, 1].map(|axis: usize| {
            let [of_drift, of_stride, of_step] = HEAD_SHARES[axis].map(libm::sqrtf);
            let first = 4 * axis;
            let whole = of_drift * drift[axis] + of_stride * with(stride, first) + of_step * with(step, first + 2);
            scale * lacking.head[axis] * HEAD_RAD[axis] * whole + rest * HEAD_RAD[axis] * drift[axis]
        });
        let head = &mut pose.rotations[Joint::Head.index()];
        *head = rotation(Vec3::new(tips_rad[0], tips_rad[1], 0.0)) * *head;
        let scale = scale * lacking.hands;
        for side in 0..2 {
            let axis = skeleton.offsets_m[HANDS[side].index()].normalize_or(Vec3::Y);
            let across = axis.any_orthonormal_vector();
            let forearm = &mut pose.rotations[FOREARMS[side].index()];
            *forearm *= rotation(scale * FOREARM_RAD * drift[2 + side] * axis);
            let [of_stride, of_step, of_tremor] = HAND_RAD;
            let trembling = Vec2::new(tremor[2 * side], tremor[2 * side + 1]);
            let flexing = of_stride * with(stride, 2 * side) + of_step * with(step, 4 + 2 * side);
            let turn_rad = (flexing + of_tremor * trembling.x) * across + of_tremor * trembling.y * axis.cross(across);
            let hand = &mut pose.rotations[HANDS[side].index()];
            *hand = rotation(scale * turn_rad) * *hand;
        }
    }
}

/// Deviation of the pelvis of an idle from its mean position on the ground, m.
fn pelvis_deviation_m(idle: &Action) -> f32 {
    let positions_m = || idle.frames.iter().map(|frame| frame.pose.pelvis_m.truncate());
    let mean_m = positions_m().sum::<Vec2>() / idle.frames.len() as f32;
    let squares_m2 = positions_m().map(|position_m| position_m.distance_squared(mean_m));
    libm::sqrtf(squares_m2.sum::<f32>() / idle.frames.len() as f32)
}

/// Eight noises of one band, of unit variance, at a time in intervals between its coefficients.
fn noises(seed: u64, band: u64, time: f64) -> [f32; 8] {
    let knot = libm::floor(time);
    let weights = spline_weights((time - knot) as f32);
    let of_seed = SplitMix64::new(seed, band).next_u64();
    let [own_deviation, spline_deviation] = DEVIATIONS;
    let own = libm::sqrtf(OWN_SHARE) / own_deviation;
    let drawn = libm::sqrtf(1.0 - OWN_SHARE) / spline_deviation;
    let mut sums = coefficients(of_seed, 0).map(|value| own * value);
    for (weight, index) in weights.into_iter().zip(1..) {
        let values = coefficients(of_seed, knot as u64 + index);
        sums.iter_mut().zip(values).for_each(|(sum, value)| *sum += drawn * weight * value);
    }
    sums
}

/// Eight coefficients, uniform in [−1, 1).
fn coefficients(seed: u64, index: u64) -> [f32; 8] {
    let mut random = SplitMix64::new(seed, index);
    let pairs = [(); 4].map(|()| random.next_u64());
    let uniform = |bits: u64| (bits >> 40) as f32 / (1_u64 << 23) as f32 - 1.0;
    std::array::from_fn(|which| uniform(pairs[which / 2] << (32 * (which % 2))))
}

/// Weights of four coefficients of a cubic B-spline, at a share of the interval between the middle ones.
fn spline_weights(share: f32) -> [f32; 4] {
    let (rest, square, cube) = (1.0 - share, share * share, share * share * share);
    [
        rest * rest * rest / 6.0,
        (3.0 * cube - 6.0 * square + 4.0) / 6.0,
        (3.0 * (share + square - cube) + 1.0) / 6.0,
        cube / 6.0,
    ]
}

#[cfg(test)]
mod tests {
    use std::sync::Arc;

    use glam::Quat;
    use motiondb::body::{JOINT_COUNT, Root};
    use motiondb::motion::{ActionEnd, ActionFrame, ActionKind};

    use super::*;
    use crate::planning::plan::Plan;
    use crate::synthesis::{Body, HmsParams, SynthesisContext, Traits};
    use crate::test_db::test_db;

    const DT_S: f32 = 1.0 / 60.0;

    /// Poses of a body that walks, or stands, after each step of 20 s.
    fn poses(context: &SynthesisContext, traits: Traits, speed_mps: f32) -> Vec<Pose> {
        let (mut body, _) = Body::standing_with(context, Root::default(), 0.3, traits);
        let (plan, step) = (Plan { velocity_mps: Vec2::new(speed_mps, 0.0), ..Plan::default() }, TimeStep::new(DT_S));
        let mut after_step = || {
            body.advance(context, &plan, &step);
            body.synthesize(context, &step).pose
        };
        (0..1200).map(|_| after_step()).collect()
    }

    /// Deviation of roll and pitch of the head, degrees, and acceleration of the left hand, rad/s².
    fn measured(context: &SynthesisContext, poses: &[Pose]) -> [f32; 3] {
        let heads = poses.iter().map(|pose| pose.forward_kinematics(&context.db.skeleton));
        let heads: Vec<Quat> = heads.map(|joints| joints.orientations[Joint::Head.index()]).collect();
        let deviation_deg = |axis: Vec3| {
            let tips: Vec<f32> = heads.iter().map(|head| libm::asinf((*head * axis).z).to_degrees()).collect();
            let mean = tips.iter().sum::<f32>() / tips.len() as f32;
            (tips.iter().map(|tip| (tip - mean) * (tip - mean)).sum::<f32>() / tips.len() as f32).sqrt()
        };
        let hand = |pose: &Pose| pose.rotations[HANDS[0].index()];
        let turn = |pair: &[Pose]| (hand(&pair[1]) * hand(&pair[0]).conjugate()).to_scaled_axis() / DT_S;
        let turns: Vec<Vec3> = poses.windows(2).map(turn).collect();
        let squares = turns.windows(2).map(|pair| ((pair[1] - pair[0]) / DT_S).length_squared());
        let mean = squares.sum::<f32>() / (turns.len() - 1) as f32;
        [deviation_deg(Vec3::Y), deviation_deg(Vec3::X), mean.sqrt()]
    }

    #[test]
    fn heads_and_hands_move_as_in_captures() {
        let context = SynthesisContext::new(Arc::new(test_db()), HmsParams::default());
        for secondary_seed in [1, 2, 3, 4] {
            let traits = Traits { secondary_motion: 1.0, secondary_seed, ..Traits::default() };
            let [roll_deg, pitch_deg, hand_rad_s2] = measured(&context, &poses(&context, traits, 1.1)[120..]);
            assert!((0.4..2.3).contains(&roll_deg) && (0.4..3.1).contains(&pitch_deg), "{roll_deg}° {pitch_deg}°");
            assert!((11.0..52.0).contains(&hand_rad_s2), "{hand_rad_s2} rad/s²");
        }
    }

    /// A set with an idle whose pelvis moves to and fro by `amplitude_m`; without an idle where there is none.
    fn context_with_idle(amplitude_m: Option<f32>) -> SynthesisContext {
        let mut db = test_db();
        let frame = |index: u16| {
            let mut pose = db.rows.pose(0, 0);
            pose.pelvis_m.x += amplitude_m.unwrap_or_default() * libm::sinf(TAU * f32::from(index) / 120.0);
            ActionFrame { pose, contacts: [1.0; 2], root: Root::default() }
        };
        let end = ActionEnd { example: 0, phase: 0.0 };
        let idle = Action {
            name: "idle".to_owned(),
            kind: ActionKind::Idle,
            source: 0,
            window_s: [0.0, 2.0],
            mirrored: false,
            entry: end,
            exit: end,
            frames: (0..=120).map(frame).collect(),
        };
        db.actions = amplitude_m.map(|_| idle).into_iter().collect();
        SynthesisContext::new(Arc::new(db), HmsParams::default())
    }

    /// Poses of a body without and with secondary motion.
    fn plain_and_moved(context: &SynthesisContext, speed_mps: f32) -> [Vec<Pose>; 2] {
        [0.0, 1.0].map(|secondary_motion| {
            poses(context, Traits { secondary_motion, secondary_seed: 5, ..Traits::default() }, speed_mps)
        })
    }

    #[test]
    fn bodies_sway_at_rest_unless_their_idle_does() {
        for still in [None, Some(0.0)] {
            let [plain, swaying] = plain_and_moved(&context_with_idle(still), 0.0);
            assert!(plain.windows(2).all(|pair| pair[0].pelvis_m.distance(pair[1].pelvis_m) < 1e-6));
            let off_mm = |pose: &Pose| 1e3 * (pose.pelvis_m - plain[0].pelvis_m).truncate();
            let none = (Vec2::INFINITY, Vec2::NEG_INFINITY);
            let (low_mm, high_mm) = swaying[120..480]
                .iter()
                .map(off_mm)
                .fold(none, |(low_mm, high_mm), off_mm| (low_mm.min(off_mm), high_mm.max(off_mm)));
            assert!((5.0..25.0).contains(&high_mm.distance(low_mm)), "{low_mm} to {high_mm} mm in 6 s");
        }
        let [plain, moved] = plain_and_moved(&context_with_idle(Some(0.02)), 0.0);
        assert_eq!(plain, moved);
    }

    #[test]
    fn legs_keep_their_motion_in_walks() {
        let [plain, moved] = plain_and_moved(&context_with_idle(Some(0.02)), 1.1);
        let legs = Joint::LeftThigh.index()..;
        let mut both = plain.iter().zip(&moved);
        assert!(both.all(|(plain, moved)| plain.rotations[legs.clone()] == moved.rotations[legs.clone()]));
    }

    #[test]
    fn clips_that_have_their_own_motion_keep_it() {
        let mut db = test_db();
        let still = LackingMotion::of(&db, 2);
        assert!(still.head == [1.0; 2] && still.hands == 1.0, "{still:?}");
        for row in 0..PHASE_COUNT {
            let nod_rad = 0.03 * libm::sinf(TAU * row as f32 / PHASE_COUNT as f32);
            let head = (2 * PHASE_COUNT + row) * JOINT_COUNT + Joint::Head.index();
            db.rows.rotations[head] *= Quat::from_rotation_y(nod_rad);
        }
        let nodding = LackingMotion::of(&db, 2);
        assert_eq!((nodding.head[1], nodding.hands), (0.0, 1.0));
    }

    #[test]
    fn noise_has_unit_variance_and_does_not_jump() {
        let (mut squares, mut count) = (0.0, 0);
        for seed in 0..200 {
            let values: Vec<[f32; 8]> = (0..400).map(|index| noises(seed, 1, 0.05 * f64::from(index))).collect();
            squares += values.iter().flatten().map(|value| value * value).sum::<f32>();
            count += 8 * values.len();
            // The third difference of a cubic is constant within an interval: it grows with the cube of the step.
            let thirds =
                values.windows(4).map(|four| (four[3][0] - 3.0 * four[2][0] + 3.0 * four[1][0] - four[0][0]).abs());
            assert!(thirds.fold(0.0, f32::max) < 0.01);
        }
        assert!((squares / count as f32 - 1.0).abs() < 0.05, "{}", squares / count as f32);
    }

    #[test]
    fn a_jump_of_the_phase_does_not_show() {
        let context = SynthesisContext::new(Arc::new(test_db()), HmsParams::default());
        let (mut secondary, step) = (SecondaryMotion::default(), TimeStep::new(DT_S));
        let mut phase = 0.0;
        let mut rolls = Vec::new();
        for index in 0..240 {
            let jump = if index == 100 { 0.45 } else { 0.0 };
            phase = (phase + 0.9 * DT_S + jump) % 1.0;
            secondary.follow(phase, 0.9 * DT_S, 1.0, &step);
            let mut pose = context.db.rows.pose(0, 0);
            secondary.add_to(&mut pose, 9, 1.0, &context.lacking, &context.db.skeleton);
            rolls.push(pose.rotations[Joint::Head.index()].x);
        }
        let speeds = rolls.windows(2).map(|pair| (pair[1] - pair[0]).abs());
        let greatest_rad_s = 2.0 * speeds.fold(0.0, f32::max) / DT_S; // x is the sine of half the angle
        assert!(greatest_rad_s < 0.6, "{greatest_rad_s} rad/s"); // a roll that jumps: 2
    }
}

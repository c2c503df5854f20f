//! HumanClip → the performance that it shows: what is left of a clip when the performer's size, the place, the skeleton
//! and the frame rate are taken away, and how far two of these are apart.
//!
//! A performance is the course of eight unit vectors (thighs, shanks, upper arms, trunk, where the head faces) in the
//! frame of the facing, z up, and the course of the facing itself. Forearms and feet are left out: exporters differ by
//! 10° in them. With d_s(t) the vectors of one clip, d'_s(t + lag) those of another and ‾ the mean over the time that
//! both show, the unlikeness is
//!
//! ```text
//! r² = Σ_s,t |(d_s − d‾_s) − (d'_s − d'‾_s)|² / √( Σ|d_s − d‾_s|² · Σ|d'_s − d'‾_s|² ),
//! ```
//!
//! 0 for a copy, 1 and more for what has nothing in common. The means fall out because retargeting tilts a limb by the
//! same 2–6° all along.

use std::f64::consts::{PI, TAU};

use glam::{DQuat, DVec3};
use motiondb::body::Joint;

use crate::retarget::human_clip::{HumanBody, HumanClip, HumanPose};

/// Directions compared.
pub(crate) const DIRECTION_COUNT: usize = 8;
/// Of them the first are those of the legs.
pub(crate) const LEG_DIRECTION_COUNT: usize = 4;
/// From and to which joint each points, left before right; the last is where the head faces.
const BONES: [[Joint; 2]; DIRECTION_COUNT - 1] = [
    [Joint::LeftThigh, Joint::LeftShank],
    [Joint::RightThigh, Joint::RightShank],
    [Joint::LeftShank, Joint::LeftFoot],
    [Joint::RightShank, Joint::RightFoot],
    [Joint::LeftUpperArm, Joint::LeftForearm],
    [Joint::RightUpperArm, Joint::RightForearm],
    [Joint::Pelvis, Joint::Neck],
];
/// Which direction each becomes in a mirror.
pub(crate) const MIRRORED: [usize; DIRECTION_COUNT] = [1, 0, 3, 2, 5, 4, 6, 7];

/// Unit vectors at one time.
pub(crate) type Directions = [DVec3; DIRECTION_COUNT];

/// The course of a clip's directions and facing.
#[derive(Clone, Debug)]
pub(crate) struct Performance {
    pub rate_hz: f64,
    pub directions: Vec<Directions>,
    /// Without jumps of a whole turn, radians.
    pub facing_rad: Vec<f64>,
}

impl Performance {
    pub(crate) fn of(clip: &HumanClip) -> Self {
        let (directions, mut facing_rad): (Vec<Directions>, Vec<f64>) =
            clip.frames.iter().map(|pose| seen(pose, &clip.body)).unzip();
        for frame in 1..facing_rad.len() {
            let jump = facing_rad[frame] - facing_rad[frame - 1];
            facing_rad[frame] -= TAU * libm::floor((jump + PI) / TAU);
        }
        Self { rate_hz: clip.frame_rate_hz, directions, facing_rad }
    }

    /// Left and right exchanged.
    pub(crate) fn mirrored(&self) -> Self {
        let across = DVec3::new(1.0, -1.0, 1.0);
        Self {
            rate_hz: self.rate_hz,
            directions: self.directions.iter().map(|row| MIRRORED.map(|index| row[index] * across)).collect(),
            facing_rad: self.facing_rad.iter().map(|angle| -angle).collect(),
        }
    }

    /// At another rate.
    pub(crate) fn sampled(&self, rate_hz: f64) -> Self {
        let last = self.directions.len() - 1;
        let count = libm::floor(last as f64 * rate_hz / self.rate_hz + 1e-6) as usize + 1;
        let place = |sample: usize| {
            let frame = sample as f64 * self.rate_hz / rate_hz;
            let before = (frame as usize).min(last);
            (before, (before + 1).min(last), (frame - before as f64).clamp(0.0, 1.0))
        };
        let direction = |sample: usize| {
            let (before, after, share) = place(sample);
            let (before, after) = (&self.directions[before], &self.directions[after]);
            std::array::from_fn(|index| before[index].lerp(after[index], share))
        };
        let facing_rad = |sample: usize| {
            let (before, after, share) = place(sample);
            self.facing_rad[before] * (1.0 - share) + self.facing_rad[after] * share
        };
        Self {
            rate_hz,
            directions: (0..count).map(direction).collect(),
            facing_rad: (0..count).map(facing_rad).collect(),
        }
    }
}

/// The directions in the frame of the facing, and the facing.
fn seen(pose: &HumanPose, body: &HumanBody) -> (Directions, f64) {
    let joints = pose.forward_kinematics(body);
    let facing_rad = joints.facing_rad();
    let turn_back = DQuat::from_rotation_z(-facing_rad);
    let place_m = |joint: Joint| joints.positions_m[joint.index()];
    let direction = |index: usize| match BONES.get(index) {
        Some([from, to]) => (place_m(*to) - place_m(*from)).normalize_or_zero(),
        None => joints.orientations[Joint::Head.index()] * DVec3::X,
    };
    (std::array::from_fn(|index| turn_back * direction(index)), facing_rad)
}

/// Two performances, laid over each other.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Likeness {
    /// r, above.
    pub unlikeness: f64,
    /// The time that both show, s.
    pub overlap_s: f64,
    /// Root mean square over time and directions by which they leave their means, geometric mean of both, rad.
    pub movement_rad: f64,
    /// Correlation of the facings about their own steady turning; none where neither swings by as much as
    /// [`SWING_MIN_RAD`].
    pub facing_correlation: Option<f64>,
    /// Difference of the steady turning, rad/s.
    pub turn_difference_rad_s: f64,
}

/// A facing that swings less shows noise, not a performer, rad: 1°.
const SWING_MIN_RAD: f64 = PI / 180.0;

/// Lays `other` over `one`, sampled alike, so that its sample 0 meets `one`'s sample `lag`; none where they have not
/// three samples in common.
pub(crate) fn compare(one: &Performance, other: &Performance, lag: isize) -> Option<Likeness> {
    let (from, other_from, count) = overlap(one.directions.len(), other.directions.len(), lag)?;
    let (a, b) = (&one.directions[from..from + count], &other.directions[other_from..other_from + count]);
    let (mean_a, mean_b) = (mean(a), mean(b));
    let (mut of_a, mut of_b, mut between) = (0.0, 0.0, 0.0);
    for (a, b) in a.iter().zip(b) {
        for index in 0..DIRECTION_COUNT {
            let (a, b) = (a[index] - mean_a[index], b[index] - mean_b[index]);
            of_a += a.length_squared();
            of_b += b.length_squared();
            between += a.distance_squared(b);
        }
    }
    let geometric = libm::sqrt(of_a * of_b);
    let turning = |performance: &Performance, from: usize| swing(&performance.facing_rad[from..from + count]);
    let ((turn_a, swing_a), (turn_b, swing_b)) = (turning(one, from), turning(other, other_from));
    Some(Likeness {
        unlikeness: if geometric > 0.0 { libm::sqrt(between / geometric) } else { f64::INFINITY },
        overlap_s: (count - 1) as f64 / one.rate_hz,
        movement_rad: libm::sqrt(geometric / (count * DIRECTION_COUNT) as f64),
        facing_correlation: correlation(&swing_a, &swing_b),
        turn_difference_rad_s: (turn_a - turn_b).abs() * one.rate_hz,
    })
}

/// First samples of both, and how many they share; none where they are fewer than three.
pub(crate) fn overlap(one: usize, other: usize, lag: isize) -> Option<(usize, usize, usize)> {
    let (from, other_from) = (lag.max(0) as usize, (-lag).max(0) as usize);
    let count = one.saturating_sub(from).min(other.saturating_sub(other_from));
    (count > 2).then_some((from, other_from, count))
}

fn mean(rows: &[Directions]) -> Directions {
    std::array::from_fn(|index| rows.iter().map(|row| row[index]).sum::<DVec3>() / rows.len() as f64)
}

/// The steady turning by least squares, rad a sample, and what is left of the facing.
fn swing(facing_rad: &[f64]) -> (f64, Vec<f64>) {
    let middle = 0.5 * (facing_rad.len() - 1) as f64;
    let mean = facing_rad.iter().sum::<f64>() / facing_rad.len() as f64;
    let at = |sample: usize| sample as f64 - middle;
    let (mut along, mut across) = (0.0, 0.0);
    for (sample, angle) in facing_rad.iter().enumerate() {
        along += at(sample) * at(sample);
        across += at(sample) * (angle - mean);
    }
    let turn = across / along;
    (turn, facing_rad.iter().enumerate().map(|(sample, angle)| angle - mean - turn * at(sample)).collect())
}

fn correlation(a: &[f64], b: &[f64]) -> Option<f64> {
    let product = |a: &[f64], b: &[f64]| a.iter().zip(b).map(|(a, b)| a * b).sum::<f64>();
    let least = SWING_MIN_RAD * SWING_MIN_RAD * a.len() as f64;
    let (of_a, of_b) = (product(a, a), product(b, b));
    (of_a.max(of_b) > least).then(|| product(a, b) / libm::sqrt((of_a * of_b).max(f64::MIN_POSITIVE)))
}

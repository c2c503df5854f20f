//! HumanClip → its motion signature: 20 rows a second of what does not depend on the performer's size, the skeleton,
//! the place, the heading or the frame rate.
//!
//! A row holds eight unit vectors (thighs, shanks, upper arms, trunk, the head's forward axis) in the frame of the
//! facing, x forward, y left, z up: first all x, then all y, then all z. The facing itself comes last, radians in the
//! world. Forearms and feet are left out: exporters differ by 10° in them. A row is the mean over its twentieth of a
//! second, so noise and the frame rate of the source hardly show.

use std::f64::consts::{PI, TAU};

use glam::{DQuat, DVec3};
use motiondb::body::Joint;

use crate::retarget::human_clip::{HumanBody, HumanClip, HumanPose};

/// Rows a second.
pub(crate) const RATE_HZ: f64 = 20.0;
/// Unit vectors of a row; the first are those of the legs.
pub(crate) const DIRECTION_COUNT: usize = 8;
pub(crate) const LEG_COUNT: usize = 4;
/// Where the facing is in a row: after the coordinates of the unit vectors.
pub(crate) const FACING: usize = 3 * DIRECTION_COUNT;
/// Points in time that a row is the mean of: 120 a second.
const POINTS_A_ROW: usize = 6;
/// From and to which joint each direction points, left before right; the last is the head's forward axis.
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
const MIRRORED: [usize; DIRECTION_COUNT] = [1, 0, 3, 2, 5, 4, 6, 7];

/// A twentieth of a second.
pub(crate) type Row = [f32; FACING + 1];

/// The rows of a clip.
pub(crate) fn rows(clip: &HumanClip) -> Vec<Row> {
    let mut frames: Vec<Row> = clip.frames.iter().map(|pose| row(pose, &clip.body)).collect();
    for frame in 1..frames.len() {
        let jump = f64::from(frames[frame][FACING] - frames[frame - 1][FACING]);
        frames[frame][FACING] -= (TAU * libm::floor((jump + PI) / TAU)) as f32;
    }
    means(&frames, 0.0, clip.frame_rate_hz / RATE_HZ)
}

/// The rows of the same motion, so many times as fast; at least 1.
pub(crate) fn faster(rows: &[Row], pace: f64) -> Vec<Row> {
    // A row stands for the middle of its twentieth of a second.
    means(rows, -0.5, pace)
}

/// Left and right exchanged.
pub(crate) fn mirrored(rows: &[Row]) -> Vec<Row> {
    let coordinate = |row: &Row, at: usize| match at / DIRECTION_COUNT {
        axis @ (0 | 2) => row[DIRECTION_COUNT * axis + MIRRORED[at % DIRECTION_COUNT]],
        1 => -row[DIRECTION_COUNT + MIRRORED[at % DIRECTION_COUNT]],
        _ => -row[FACING],
    };
    rows.iter().map(|row| std::array::from_fn(|at| coordinate(row, at))).collect()
}

/// Between each two rows, linearly: at 0 the first, at 1 the second.
pub(crate) fn between(rows: &[Row], share: f64) -> Vec<Row> {
    rows.windows(2).map(|pair| lerp(&pair[0], &pair[1], share as f32)).collect()
}

/// The directions in the frame of the facing, and the facing.
fn row(pose: &HumanPose, body: &HumanBody) -> Row {
    let joints = pose.forward_kinematics(body);
    let facing_rad = joints.facing_rad();
    let turn_back = DQuat::from_rotation_z(-facing_rad);
    let position_m = |joint: Joint| joints.positions_m[joint.index()];
    let direction = |index: usize| match BONES.get(index) {
        Some([from, to]) => (position_m(*to) - position_m(*from)).normalize_or_zero(),
        None => joints.orientations[Joint::Head.index()] * DVec3::X,
    };
    let directions: [DVec3; DIRECTION_COUNT] = std::array::from_fn(|index| turn_back * direction(index));
    let coordinate = |at: usize| directions[at % DIRECTION_COUNT][at / DIRECTION_COUNT];
    std::array::from_fn(|at| if at == FACING { facing_rad } else { coordinate(at) } as f32)
}

/// Means of rows over stretches of `step` rows, end to end; the first begins at row `first`.
fn means(rows: &[Row], first: f64, step: f64) -> Vec<Row> {
    let last = rows.len().saturating_sub(1);
    let count = libm::floor((last as f64 - 2.0 * first) / step + 1e-6) as usize;
    let at = |place: f64| {
        let place = place.clamp(0.0, last as f64);
        let before = place as usize;
        lerp(&rows[before], &rows[(before + 1).min(last)], (place - before as f64) as f32)
    };
    let mean = |stretch: usize| {
        let mut mean = [0.0; FACING + 1];
        for point in 0..POINTS_A_ROW {
            let share = (point as f64 + 0.5) / POINTS_A_ROW as f64;
            let row = at(first + step * (stretch as f64 + share));
            mean.iter_mut().zip(&row).for_each(|(mean, value)| *mean += value / POINTS_A_ROW as f32);
        }
        mean
    };
    (0..count).map(mean).collect()
}

fn lerp(a: &Row, b: &Row, share: f32) -> Row {
    std::array::from_fn(|at| a[at] + share * (b[at] - a[at]))
}

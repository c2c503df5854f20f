//! Motion signature: 20 rows a second of a clip, free of the performer's size, the skeleton, the position, the heading
//! and the frame rate.
//!
//! A row holds eight unit vectors (thighs, shanks, upper arms, trunk, forward axis of the head) in the frame of the
//! facing: x forward, y left, z up; first all x, then all y, then all z. Then come the facing in the world, radians,
//! and the unit vectors of both forearms, of which only the mean is compared: exporters differ by 10° in them. Feet are
//! left out for the same reason. A row is the mean over its twentieth of a second, so noise and the source's frame rate
//! hardly show.

use std::f64::consts::{PI, TAU};

use glam::{DQuat, DVec3, Vec3};
use motiondb::body::Joint;

use crate::retarget::human_clip::{HumanBody, HumanClip, HumanPose};
use crate::rig::carriage::Carriage;

/// Rows a second.
pub(crate) const RATE_HZ: f64 = 20.0;
/// Number of unit vectors in a row.
pub(crate) const DIRECTION_COUNT: usize = 8;
/// Number of unit vectors of the legs; they come first.
pub(crate) const LEG_COUNT: usize = 4;
/// Index of the facing in a row, after the coordinates of the unit vectors.
pub(crate) const FACING: usize = 3 * DIRECTION_COUNT;
/// Index of the first coordinate of the forearms in a row: both x, both y, both z.
const FOREARMS: usize = FACING + 1;
/// Number of values in a row.
pub(crate) const WIDTH: usize = FOREARMS + 3 * 2;
/// Points in time that a row is the mean of: 120 a second.
const POINTS_PER_ROW: usize = 6;
/// Index of the left upper arm among the directions; the right one follows.
const UPPER_ARM: usize = 4;
/// Index of the trunk among the directions.
const TRUNK: usize = 6;
/// Joints that each direction points from and to, left before right. The eighth direction is the head's forward axis.
const BONES: [[Joint; 2]; DIRECTION_COUNT - 1] = [
    [Joint::LeftThigh, Joint::LeftShank],
    [Joint::RightThigh, Joint::RightShank],
    [Joint::LeftShank, Joint::LeftFoot],
    [Joint::RightShank, Joint::RightFoot],
    [Joint::LeftUpperArm, Joint::LeftForearm],
    [Joint::RightUpperArm, Joint::RightForearm],
    [Joint::Pelvis, Joint::Neck],
];
/// Joints that the directions of the forearms point from and to, left before right.
const FOREARM_BONES: [[Joint; 2]; 2] = [[Joint::LeftForearm, Joint::LeftHand], [Joint::RightForearm, Joint::RightHand]];
/// Index of each direction in a mirror.
const MIRRORED: [usize; DIRECTION_COUNT] = [1, 0, 3, 2, 5, 4, 6, 7];

/// Directions and facing of a twentieth of a second.
pub(crate) type Row = [f32; WIDTH];

/// The rows of a clip.
pub(crate) fn rows(clip: &HumanClip) -> Vec<Row> {
    let mut frames: Vec<Row> = clip.frames.iter().map(|pose| row(pose, &clip.body)).collect();
    for frame in 1..frames.len() {
        let jump = f64::from(frames[frame][FACING] - frames[frame - 1][FACING]);
        frames[frame][FACING] -= (TAU * libm::floor((jump + PI) / TAU)) as f32;
    }
    means(&frames, 0.0, clip.frame_rate_hz / RATE_HZ)
}

/// The rows of the same motion at a multiple of its speed, at least 1.
pub(crate) fn faster(rows: &[Row], pace: f64) -> Vec<Row> {
    // A row stands for the middle of its twentieth of a second.
    means(rows, -0.5, pace)
}

/// The rows of the mirror image.
pub(crate) fn mirrored(rows: &[Row]) -> Vec<Row> {
    let value = |row: &Row, at: usize| {
        let (axis, source) = match at {
            FACING => (1, FACING),
            FOREARMS.. => ((at - FOREARMS) / 2, FOREARMS + ((at - FOREARMS) ^ 1)),
            _ => (at / DIRECTION_COUNT, at - at % DIRECTION_COUNT + MIRRORED[at % DIRECTION_COUNT]),
        };
        if axis == 1 { -row[source] } else { row[source] }
    };
    rows.iter().map(|row| std::array::from_fn(|at| value(row, at))).collect()
}

/// The carriage that a mean row shows.
pub(crate) fn carriage(row: &Row) -> Carriage {
    let vector = |first: usize, count: usize| Vec3::from_array([0, 1, 2].map(|axis| row[first + axis * count]));
    let upper_arm = |side: usize| vector(UPPER_ARM + side, DIRECTION_COUNT);
    let forearm = |side: usize| vector(FOREARMS + side, 2);
    Carriage { arms: [upper_arm(0), upper_arm(1), forearm(0), forearm(1)], trunk: vector(TRUNK, DIRECTION_COUNT) }
}

/// Interpolates between each two rows; `share` 0 gives the first, 1 the second.
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
    let forearms = [0, 1].map(|side| {
        let [elbow, wrist] = FOREARM_BONES[side];
        turn_back * (position_m(wrist) - position_m(elbow)).normalize_or_zero()
    });
    let coordinate = |at: usize| match at {
        FACING => facing_rad,
        FOREARMS.. => forearms[(at - FOREARMS) % 2][(at - FOREARMS) / 2],
        _ => directions[at % DIRECTION_COUNT][at / DIRECTION_COUNT],
    };
    std::array::from_fn(|at| coordinate(at) as f32)
}

/// Means over successive intervals of `step` rows; the first interval begins at row `first`.
fn means(rows: &[Row], first: f64, step: f64) -> Vec<Row> {
    let last = rows.len().saturating_sub(1);
    let count = libm::floor((last as f64 - 2.0 * first) / step + 1e-6) as usize;
    let at = |position: f64| {
        let position = position.clamp(0.0, last as f64);
        let before = position as usize;
        lerp(&rows[before], &rows[(before + 1).min(last)], (position - before as f64) as f32)
    };
    let mean = |interval: usize| {
        let mut mean = [0.0; WIDTH];
        for point in 0..POINTS_PER_ROW {
            let share = (point as f64 + 0.5) / POINTS_PER_ROW as f64;
            let row = at(first + step * (interval as f64 + share));
            mean.iter_mut().zip(&row).for_each(|(mean, value)| *mean += value / POINTS_PER_ROW as f32);
        }
        mean
    };
    (0..count).map(mean).collect()
}

fn lerp(a: &Row, b: &Row, share: f32) -> Row {
    std::array::from_fn(|at| a[at] + share * (b[at] - a[at]))
}

//! The path of a foot in one cycle, taken apart into what the root does and what the foot does.
//!
//! Where a foot is, is told as a *place*, on the ground under the body at mid-stance, and a time *since* then, for
//! which the root has carried it back along its arc:
//!
//! ```text
//! ankle(φ) = arc⁻¹(since(φ)) · place(φ)
//! ```
//!
//! A foot that stands has a place that rests (it rolls about it) and a since that runs with time. Carried along another
//! arc, the same places make another walk, and planted feet hold in it by construction.
//!
//! Root frame: x forward, y left, z up, metres; seconds.

use glam::{Quat, Vec3};
use motiondb::body::{Joint, Joints, Root};
use motiondb::motion::{MotionExample, PHASE_COUNT};

use crate::maths::arc::moved;

/// One foot at one phase.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Foothold {
    /// How long the root has carried it back from its place, s; negative for a foot ahead.
    pub since_s: f32,
    /// The ankle, were it not carried back.
    pub place_m: Vec3,
    /// Of the foot joint, likewise.
    pub orientation: Quat,
}

/// One foot row by row; `rows` are the example's.
pub(crate) fn foot_path(example: &MotionExample, key_times_s: [f32; 4], side: usize, rows: &[Joints]) -> Vec<Foothold> {
    let foot = Joint::FEET[side].index();
    let ankles_m: Vec<Vec3> = rows.iter().map(|joints| joints.positions_m[foot]).collect();
    let foothold = |(joints, since_s): (&Joints, f32)| {
        let carried = moved(&Root::default(), &example.parameters, since_s);
        Foothold {
            since_s,
            place_m: carried.to_world(joints.positions_m[foot]),
            orientation: Quat::from_rotation_z(carried.facing_rad) * joints.orientations[foot],
        }
    };
    rows.iter().zip(times_since_s(example, key_times_s, side, &ankles_m)).map(foothold).collect()
}

/// Times for which a foot has been carried back from its place, row by row of the example, s.
///
/// While the foot stands, the time after mid-stance. Less than that by which its ankle has been carried back, it has
/// rolled: that much of its path is its own. In the swing the roll goes from what it was at toe-off to what it will be
/// at the strike, on a cubic that meets both speeds; all the rest is carried.
fn times_since_s(example: &MotionExample, key_times_s: [f32; 4], side: usize, ankles_m: &[Vec3]) -> Vec<f32> {
    let [right_off_s, right_strike_s, left_off_s, left_strike_s] = key_times_s;
    let (middle, off_s, strike_s) =
        if side == 0 { (PHASE_COUNT / 2, left_off_s, left_strike_s) } else { (0, right_off_s, right_strike_s) };
    let (map, speed_mps) = (&example.phase_map, example.parameters.speed_mps);
    let middle_s = map.time_s(middle as f32 / PHASE_COUNT as f32);
    let after_middle_s = |time_s: f32| (time_s - middle_s).rem_euclid(map.period_s);
    let row_s = |row: usize| map.time_s((middle + row) as f32 / PHASE_COUNT as f32) - middle_s;
    let carried_m = |row: usize| (ankles_m[middle] - ankles_m[(middle + row) % PHASE_COUNT]).x;
    // Rows from here on count from mid-stance to the next one. The roll begins with two, however early the foot leaves.
    let last = (0..PHASE_COUNT).take_while(|&row| row_s(row) <= after_middle_s(off_s)).count().max(2) - 1;
    let first = (0..PHASE_COUNT).take_while(|&row| row_s(row) < after_middle_s(strike_s)).count();
    let roll_at = |row: usize| {
        let since_s = if row <= last { row_s(row) } else { row_s(row) - map.period_s };
        speed_mps * since_s - carried_m(row)
    };
    let roll = Cubic::through(
        [row_s(last - 1), row_s(last)],
        [row_s(first), row_s(first + 1)],
        [roll_at(last - 1), roll_at(last), roll_at(first), roll_at(first + 1)],
    );
    let since_s = |row: usize| match row {
        row if row <= last => row_s(row),
        row if row >= first => row_s(row) - map.period_s,
        row => (roll.at(row_s(row)) + carried_m(row)) / speed_mps,
    };
    (0..PHASE_COUNT).map(|row| since_s((row + PHASE_COUNT - middle) % PHASE_COUNT)).collect()
}

/// A cubic between two times, by its values and slopes there.
struct Cubic {
    ends_s: [f32; 2],
    ends: [f32; 2],
    slopes: [f32; 2],
}

impl Cubic {
    /// From the second of the first pair of times to the first of the second pair, with the slopes of both pairs.
    fn through(before_s: [f32; 2], after_s: [f32; 2], values: [f32; 4]) -> Self {
        let slope = |times_s: [f32; 2], from: f32, to: f32| (to - from) / (times_s[1] - times_s[0]);
        Self {
            ends_s: [before_s[1], after_s[0]],
            ends: [values[1], values[2]],
            slopes: [slope(before_s, values[0], values[1]), slope(after_s, values[2], values[3])],
        }
    }

    fn at(&self, time_s: f32) -> f32 {
        let length_s = self.ends_s[1] - self.ends_s[0];
        let share = (time_s - self.ends_s[0]) / length_s;
        let (s2, s3) = (share * share, share * share * share);
        self.ends[0] * (1.0 - 3.0 * s2 + 2.0 * s3)
            + self.ends[1] * (3.0 * s2 - 2.0 * s3)
            + length_s * (self.slopes[0] * (share - 2.0 * s2 + s3) + self.slopes[1] * (s3 - s2))
    }
}

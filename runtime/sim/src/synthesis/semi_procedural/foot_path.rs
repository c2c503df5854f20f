//! The path of a foot in one cycle, split into what the root does and what the foot does.
//!
//! A point of the path has two parts. The *position* lies on the ground under the body at mid-stance. The *carried
//! time* is the time for which the root has carried the foot back from there along its arc:
//!
//! ```text
//! ankle(φ) = arc⁻¹(carried(φ)) · position(φ)
//! ```
//!
//! The position of a standing foot is constant except for its roll, and its carried time runs with the clock. The same
//! positions, carried along another arc, make another walk in which planted feet hold by construction.
//!
//! Root frame (x forward, y left, z up); metres, seconds.

use glam::{Quat, Vec3};
use motiondb::body::{Joint, Joints, Root};
use motiondb::motion::{MotionExample, PHASE_COUNT};

use crate::maths::arc::moved_root;

/// One foot at one phase.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct FootPathPoint {
    /// Time for which the root has carried the foot back from its position, s; negative for a foot ahead.
    pub carried_s: f32,
    /// Position of the ankle before the root carries it, m.
    pub position_m: Vec3,
    /// Orientation of the foot joint before the root carries it.
    pub orientation: Quat,
}

/// The path of one foot, row by row of the example; `rows` are its joints.
pub(crate) fn foot_path(
    example: &MotionExample,
    key_times_s: [f32; 4],
    side: usize,
    rows: &[Joints],
) -> Vec<FootPathPoint> {
    let foot = Joint::FEET[side].index();
    let ankles_m: Vec<Vec3> = rows.iter().map(|joints| joints.positions_m[foot]).collect();
    let point = |(joints, carried_s): (&Joints, f32)| {
        let carrier = moved_root(&Root::default(), &example.parameters, carried_s);
        FootPathPoint {
            carried_s,
            position_m: carrier.to_world(joints.positions_m[foot]),
            orientation: Quat::from_rotation_z(carrier.facing_rad) * joints.orientations[foot],
        }
    };
    rows.iter().zip(carried_times_s(example, key_times_s, side, &ankles_m)).map(point).collect()
}

/// Carried times of a foot, row by row of the example, s.
///
/// While the foot stands, it is the time since mid-stance; the difference between root and ankle displacement is the
/// foot's roll. In the swing the roll changes from its value at toe-off to that at the strike, on a cubic that meets
/// both rates. The remaining displacement is carried.
fn carried_times_s(example: &MotionExample, key_times_s: [f32; 4], side: usize, ankles_m: &[Vec3]) -> Vec<f32> {
    let [right_off_s, right_strike_s, left_off_s, left_strike_s] = key_times_s;
    let (middle, off_s, strike_s) =
        if side == 0 { (PHASE_COUNT / 2, left_off_s, left_strike_s) } else { (0, right_off_s, right_strike_s) };
    let (map, speed_mps) = (&example.phase_map, example.parameters.speed_mps);
    let middle_s = map.time_s(middle as f32 / PHASE_COUNT as f32);
    let after_middle_s = |time_s: f32| (time_s - middle_s).rem_euclid(map.period_s);
    // From here on rows count from this foot's mid-stance to the next one.
    let row_s = |row: usize| map.time_s((middle + row) as f32 / PHASE_COUNT as f32) - middle_s;
    let back_m = |row: usize| (ankles_m[middle] - ankles_m[(middle + row) % PHASE_COUNT]).x;
    // The stance has at least two rows, which give the rate of the roll.
    let last = (0..PHASE_COUNT).take_while(|&row| row_s(row) <= after_middle_s(off_s)).count().max(2) - 1;
    let first = (0..PHASE_COUNT).take_while(|&row| row_s(row) < after_middle_s(strike_s)).count();
    let roll_m = |row: usize| {
        let stance_s = if row <= last { row_s(row) } else { row_s(row) - map.period_s };
        speed_mps * stance_s - back_m(row)
    };
    let swing_roll = Cubic::through(
        [row_s(last - 1), row_s(last)],
        [row_s(first), row_s(first + 1)],
        [roll_m(last - 1), roll_m(last), roll_m(first), roll_m(first + 1)],
    );
    let carried_s = |row: usize| match row {
        row if row <= last => row_s(row),
        row if row >= first => row_s(row) - map.period_s,
        row => (swing_roll.at(row_s(row)) + back_m(row)) / speed_mps,
    };
    (0..PHASE_COUNT).map(|row| carried_s((row + PHASE_COUNT - middle) % PHASE_COUNT)).collect()
}

/// A cubic between two times, by its values and slopes there.
struct Cubic {
    ends_s: [f32; 2],
    values: [f32; 2],
    slopes: [f32; 2],
}

impl Cubic {
    /// From the second of `before_s` to the first of `after_s`. `values` belong to the four times; each pair gives a
    /// slope.
    fn through(before_s: [f32; 2], after_s: [f32; 2], values: [f32; 4]) -> Self {
        let slope = |times_s: [f32; 2], from: f32, to: f32| (to - from) / (times_s[1] - times_s[0]);
        Self {
            ends_s: [before_s[1], after_s[0]],
            values: [values[1], values[2]],
            slopes: [slope(before_s, values[0], values[1]), slope(after_s, values[2], values[3])],
        }
    }

    fn at(&self, time_s: f32) -> f32 {
        let length_s = self.ends_s[1] - self.ends_s[0];
        let share = (time_s - self.ends_s[0]) / length_s;
        let (s2, s3) = (share * share, share * share * share);
        self.values[0] * (1.0 - 3.0 * s2 + 2.0 * s3)
            + self.values[1] * (3.0 * s2 - 2.0 * s3)
            + length_s * (self.slopes[0] * (share - 2.0 * s2 + s3) + self.slopes[1] * (s3 - s2))
    }
}

//! Measures of gait science for one example: cadence, stride, stance, double support, and the angles of a leg.

use clipgen::reference::{LegFlexion, published_walk};
use motiondb::body::{Joint, Joints, Side};
use motiondb::motion::{MotionDb, MotionExample, PHASE_COUNT};
use schemars::JsonSchema;
use serde::Serialize;

/// Published ranges of a group of adults: name, speed m/s, cadence steps/min, stride m, share of double support.
type AdultRanges = (&'static str, [f64; 2], [f64; 2], [f64; 2], [f64; 2]);

/// Adults of 18 to 29 years, means ± 1 standard deviation.
const ADULTS: [AdultRanges; 5] = [
    ("men, slow", [0.85, 1.20], [86.0, 101.0], [1.18, 1.48], [0.25, 0.34]),
    ("men, normal", [1.20, 1.65], [99.0, 113.0], [1.35, 1.66], [0.22, 0.31]),
    ("women, normal", [1.20, 1.65], [107.0, 124.0], [1.31, 1.53], [0.20, 0.28]),
    ("men, fast", [1.65, 2.20], [118.0, 141.0], [1.70, 1.98], [0.17, 0.24]),
    ("women, fast", [1.65, 2.25], [129.0, 156.0], [1.56, 1.84], [0.14, 0.22]),
];

/// Measures of a cycle that steps.
#[derive(Clone, Debug, JsonSchema, Serialize)]
pub struct GaitFigures {
    /// Cadence, steps per minute.
    pub cadence_steps_per_min: f64,
    /// Length of a stride, m.
    pub stride_m: f64,
    /// Share of the cycle from strike to toe-off of the left and the right foot, 0 to 1.
    pub stance_shares: [f64; 2],
    /// Share of the cycle with both feet on the ground, 0 to 1; 0 in running.
    pub double_support_share: f64,
    /// Share of the cycle with no foot on the ground, 0 to 1; 0 in walking.
    pub flight_share: f64,
}

impl GaitFigures {
    /// The measures of an example; none where it stands.
    pub(crate) fn of(example: &MotionExample) -> Option<Self> {
        let [right_off, right_strike, left_off, left_strike] = example.key_times_s?.map(f64::from);
        let period_s = f64::from(example.phase_map.period_s);
        let share = |strike_s: f64, off_s: f64| (off_s - strike_s).rem_euclid(period_s) / period_s;
        let stance_shares = [share(left_strike, left_off), share(right_strike, right_off)];
        let overlap = stance_shares[0] + stance_shares[1] - 1.0;
        let parameters = &example.parameters;
        Some(Self {
            cadence_steps_per_min: 120.0 / period_s,
            stride_m: f64::from(libm::hypotf(parameters.speed_mps, parameters.strafe_mps)) * period_s,
            stance_shares,
            double_support_share: overlap.max(0.0),
            flight_share: (-overlap).max(0.0),
        })
    }

    /// The group of adults with such a walk at this speed, if there is one.
    pub(crate) fn adults(&self, speed_mps: f64) -> Option<&'static str> {
        let within = |[low, high]: [f64; 2], value: f64| (low..=high).contains(&value);
        let found = ADULTS.iter().find(|(_, speeds_mps, cadences, strides_m, double_supports)| {
            within(*speeds_mps, speed_mps)
                && within(*cadences, self.cadence_steps_per_min)
                && within(*strides_m, self.stride_m)
                && within(*double_supports, self.double_support_share)
        });
        found.map(|(name, ..)| *name)
    }
}

/// Root mean square distance of both legs' hip, knee and ankle angles from the published walk at the example's speed,
/// degrees.
pub(crate) fn off_published_walk_deg(db: &MotionDb, index: usize) -> Option<[f64; 3]> {
    let example = &db.examples[index];
    let figures = GaitFigures::of(example)?;
    let strikes_s = [example.key_times_s?[3], example.key_times_s?[1]];
    let mut squares = [0.0; 3];
    for (row, joints) in db.posed_rows(index).iter().enumerate() {
        let time_s = example.phase_map.time_s(row as f32 / PHASE_COUNT as f32);
        for side in Side::BOTH.map(Side::index) {
            let since_strike = f64::from((time_s - strikes_s[side]) / example.phase_map.period_s).rem_euclid(1.0);
            let speed_mps = f64::from(example.parameters.speed_mps);
            let wanted = published_walk(speed_mps, since_strike, figures.stance_shares[side]);
            let found = leg_angles(db, joints, side);
            let off_deg = [
                found.thigh_deg - wanted.thigh_deg,
                found.knee_deg - wanted.knee_deg,
                found.ankle_deg - wanted.ankle_deg,
            ];
            squares.iter_mut().zip(off_deg).for_each(|(sum, off)| *sum += off * off / (2 * PHASE_COUNT) as f64);
        }
    }
    Some(squares.map(f64::sqrt))
}

/// Angles of a leg in the vertical plane of the root's facing.
fn leg_angles(db: &MotionDb, joints: &Joints, side: usize) -> LegFlexion {
    let at = |joint: Joint| joints.positions_m[joint.index()];
    let pitch_deg =
        |from: glam::Vec3, to: glam::Vec3| f64::from(libm::atan2f(to.x - from.x, from.z - to.z)).to_degrees();
    let thigh_deg = pitch_deg(at(Joint::THIGHS[side]), at(Joint::SHANKS[side]));
    let shank_deg = pitch_deg(at(Joint::SHANKS[side]), at(Joint::FEET[side]));
    let [heel_m, ball_m, _] = joints.sole_points_m(&db.skeleton, side);
    let sole_deg = pitch_deg(heel_m, ball_m) - 90.0;
    LegFlexion { thigh_deg, knee_deg: thigh_deg - shank_deg, ankle_deg: sole_deg - shank_deg }
}

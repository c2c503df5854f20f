//! What a stride leaves open between its ends, and how a pose of it is closed.
//!
//! The gap of pelvis and joints is spread evenly over the stride. A foot that did the same would slide all through its
//! stance, by the gap over the period: 10 to 30 cm/s in a lone stride of a curved walk. So a foot makes up its own gap
//! while it swings, as a walker does, and stands in between; leg inverse kinematics brings it there, no farther from
//! the hip than the clip has it, so that no knee is straighter than it was. Root frame, metres.

use glam::{DQuat, DVec3};
use motiondb::body::{JOINT_COUNT, Joint};
use motiondb::motion::PHASE_COUNT;

use crate::ground::leg_ik::place_ankle;
use crate::retarget::human_clip::{HumanBody, HumanPose};

/// A foot that swings for less than this share of the stride makes up its gap evenly.
const SWING_MIN_SHARE: f64 = 0.05;

/// A stride's last pose against its first.
pub(crate) struct Gap {
    pelvis_m: DVec3,
    rotations: [DVec3; JOINT_COUNT],
    feet: [FootGap; 2],
}

/// What one foot has to make up.
struct FootGap {
    ankle_m: DVec3,
    rotation: DVec3,
    /// How much of it is made up, −½ at the stride's beginning and ½ at its end, at rows of a cycle from a cycle before
    /// the stride to one after it.
    shares: Vec<f64>,
}

impl Gap {
    /// `contacts` tells of each foot how planted it is, 0 to 1, from −1 (a cycle before the stride) to 2.
    pub(crate) fn between(
        first: &HumanPose,
        last: &HumanPose,
        body: &HumanBody,
        contacts: impl Fn(f64) -> [f64; 2],
    ) -> Self {
        let (from, to) = (first.forward_kinematics(body), last.forward_kinematics(body));
        let rows: Vec<[f64; 2]> = (0..=3 * PHASE_COUNT).map(|row| contacts(along(row))).collect();
        let feet = [0, 1].map(|side| {
            let foot = Joint::FEET[side].index();
            FootGap {
                ankle_m: to.positions_m[foot] - from.positions_m[foot],
                rotation: rotation_between(from.orientations[foot], to.orientations[foot]),
                shares: shares(&rows.iter().map(|contacts| 1.0 - contacts[side]).collect::<Vec<f64>>()),
            }
        });
        let rotations = std::array::from_fn(|joint| rotation_between(first.rotations[joint], last.rotations[joint]));
        Self { pelvis_m: last.pelvis_m - first.pelvis_m, rotations, feet }
    }

    /// A pose without its part of the gap, `along` the stride: 0 at its beginning, 1 at its end.
    pub(crate) fn taken_out(&self, pose: &HumanPose, along: f64, body: &HumanBody) -> HumanPose {
        let mut closed = pose.clone();
        closed.pelvis_m -= self.pelvis_m * (along - 0.5);
        for (rotation, gap) in closed.rotations.iter_mut().zip(&self.rotations) {
            *rotation = DQuat::from_scaled_axis(*gap * (0.5 - along)) * *rotation;
        }
        for (side, foot) in self.feet.iter().enumerate() {
            foot.take_out(&mut closed, pose, along, body, side);
        }
        closed
    }
}

impl FootGap {
    /// Puts the foot of a closed pose where it was in the clip, but for what it has made up of its gap.
    fn take_out(&self, closed: &mut HumanPose, pose: &HumanPose, along: f64, body: &HumanBody, side: usize) {
        let [thigh, shank, foot] = [Joint::THIGHS[side], Joint::SHANKS[side], Joint::FEET[side]].map(Joint::index);
        let row = ((along + 1.0) * PHASE_COUNT as f64 + 0.5) as usize;
        let share = self.shares[row.min(self.shares.len() - 1)];
        let clip = pose.forward_kinematics(body);
        let hip_m = closed.forward_kinematics(body).positions_m[thigh];
        let leg_m = clip.positions_m[foot] - self.ankle_m * share - hip_m;
        let reach_m = clip.positions_m[foot].distance(clip.positions_m[thigh]);
        place_ankle(closed, body, side, hip_m + leg_m.clamp_length_max(reach_m));
        let orientation = DQuat::from_scaled_axis(self.rotation * -share) * clip.orientations[foot];
        closed.rotations[foot] = closed.forward_kinematics(body).orientations[shank].inverse() * orientation;
    }
}

/// The place of a row along the stride; rows begin a cycle before it.
fn along(row: usize) -> f64 {
    row as f64 / PHASE_COUNT as f64 - 1.0
}

/// How much of a gap is made up at each row by a foot that swings so much at each: −½ where the stride begins, ½ where
/// it ends.
fn shares(swings: &[f64]) -> Vec<f64> {
    let mut sums = vec![0.0];
    for pair in swings.windows(2) {
        sums.push(sums[sums.len() - 1] + 0.5 * (pair[0] + pair[1]));
    }
    let [first, last] = [PHASE_COUNT, 2 * PHASE_COUNT].map(|row| sums[row]);
    if last - first < SWING_MIN_SHARE * PHASE_COUNT as f64 {
        return (0..sums.len()).map(|row| along(row) - 0.5).collect();
    }
    sums.iter().map(|sum| (sum - first) / (last - first) - 0.5).collect()
}

/// The shorter way from one rotation to another, as a rotation vector.
fn rotation_between(from: DQuat, to: DQuat) -> DVec3 {
    let gap = to * from.inverse();
    (if gap.w < 0.0 { -gap } else { gap }).to_scaled_axis()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_foot_makes_up_its_gap_while_it_swings_and_only_then() {
        let swings: Vec<f64> =
            (0..=3 * PHASE_COUNT).map(|row| if (20..44).contains(&(row % PHASE_COUNT)) { 1.0 } else { 0.0 }).collect();
        let shares = shares(&swings);
        let at = |row: usize| shares[PHASE_COUNT + row];
        assert!((at(0) + 0.5).abs() < 1e-12 && (at(18) + 0.5).abs() < 1e-12);
        assert!((at(46) - 0.5).abs() < 1e-12 && (at(PHASE_COUNT) - 0.5).abs() < 1e-12);
        assert!(at(32).abs() < 0.03);
    }

    #[test]
    fn a_foot_that_never_swings_makes_up_its_gap_evenly() {
        let shares = shares(&[0.0; 3 * PHASE_COUNT + 1]);
        assert!((shares[PHASE_COUNT] + 0.5).abs() < 1e-12 && shares[PHASE_COUNT + 32].abs() < 1e-12);
    }
}

//! Loop closure: the gap that a stride leaves between its ends, and a pose of the stride without its part of the gap.
//!
//! The gap of pelvis and joints is spread evenly over the stride. A foot that did the same would slide all through its
//! stance, by the gap divided by the period. So a foot makes up its own gap during its swing, as a walker does, and
//! stands in between. Leg inverse kinematics brings it there, no farther from the hip than in the clip, so that no knee
//! is straighter than it was. Root frame: metres, rotation vectors in radians.

use glam::{DQuat, DVec3};
use motiondb::body::{JOINT_COUNT, Joint};
use motiondb::motion::PHASE_COUNT;

use crate::ground::leg_ik::place_foot;
use crate::ground::rotations::rotation_vector;
use crate::retarget::human_clip::{HumanBody, HumanPose};

/// Least share of the stride that a foot swings; a foot that swings less makes up its gap evenly.
const SWING_MIN_SHARE: f64 = 0.05;

/// Difference of a stride's last pose from its first.
pub(crate) struct StrideGap {
    /// Displacement of the pelvis, m.
    pelvis_m: DVec3,
    /// Rotation of each joint against its parent, as a rotation vector, rad.
    rotations: [DVec3; JOINT_COUNT],
    /// Gaps of both feet.
    feet: [FootGap; 2],
}

/// Difference of one foot at the end of a stride from its beginning.
struct FootGap {
    /// Displacement of the ankle, m.
    ankle_m: DVec3,
    /// Rotation of the foot in the root frame, as a rotation vector, rad.
    rotation: DVec3,
    /// Share of the gap that is made up at each row, −½ at the stride's beginning and ½ at its end; rows begin a cycle
    /// before the stride and end a cycle after it.
    shares: Vec<f64>,
}

impl StrideGap {
    /// The gap between two poses. `contacts` gives the contact of each foot, 0 to 1, at a share of the stride from −1
    /// (a cycle before it) to 2.
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

    /// A pose without its part of the gap; `along` is 0 at the beginning of the stride, 1 at its end.
    pub(crate) fn closed_pose(&self, pose: &HumanPose, along: f64, body: &HumanBody) -> HumanPose {
        let mut closed = pose.clone();
        closed.pelvis_m -= self.pelvis_m * (along - 0.5);
        for (rotation, gap) in closed.rotations.iter_mut().zip(&self.rotations) {
            *rotation = DQuat::from_scaled_axis(*gap * (0.5 - along)) * *rotation;
        }
        for (side, foot) in self.feet.iter().enumerate() {
            foot.close_foot(&mut closed, pose, along, body, side);
        }
        closed
    }
}

impl FootGap {
    /// Puts the foot of a closed pose to its position in the clip, less the part of its gap that it has made up.
    fn close_foot(&self, closed: &mut HumanPose, pose: &HumanPose, along: f64, body: &HumanBody, side: usize) {
        let [thigh, foot] = [Joint::THIGHS[side], Joint::FEET[side]].map(Joint::index);
        let row = ((along + 1.0) * PHASE_COUNT as f64 + 0.5) as usize;
        let share = self.shares[row.min(self.shares.len() - 1)];
        let clip = pose.forward_kinematics(body);
        let hip_m = closed.forward_kinematics(body).positions_m[thigh];
        let leg_m = clip.positions_m[foot] - self.ankle_m * share - hip_m;
        let reach_m = clip.positions_m[foot].distance(clip.positions_m[thigh]);
        let orientation = DQuat::from_scaled_axis(self.rotation * -share) * clip.orientations[foot];
        place_foot(closed, body, side, hip_m + leg_m.clamp_length_max(reach_m), orientation);
    }
}

/// Position of a row along the stride; rows begin a cycle before it.
fn along(row: usize) -> f64 {
    row as f64 / PHASE_COUNT as f64 - 1.0
}

/// Share of a gap that is made up at each row, in proportion to the swing of the foot up to there: −½ where the stride
/// begins, ½ where it ends.
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

/// The rotation from one orientation to another by the shorter arc, as a rotation vector, rad.
fn rotation_between(from: DQuat, to: DQuat) -> DVec3 {
    rotation_vector(to * from.inverse())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn feet_make_up_their_gap_only_as_they_swing() {
        let swings: Vec<f64> =
            (0..=3 * PHASE_COUNT).map(|row| if (20..44).contains(&(row % PHASE_COUNT)) { 1.0 } else { 0.0 }).collect();
        let shares = shares(&swings);
        let at = |row: usize| shares[PHASE_COUNT + row];
        assert!((at(0) + 0.5).abs() < 1e-12 && (at(18) + 0.5).abs() < 1e-12);
        assert!((at(46) - 0.5).abs() < 1e-12 && (at(PHASE_COUNT) - 0.5).abs() < 1e-12);
        assert!(at(32).abs() < 0.03);
    }

    #[test]
    fn feet_that_never_swing_make_it_up_evenly() {
        let shares = shares(&[0.0; 3 * PHASE_COUNT + 1]);
        assert!((shares[PHASE_COUNT] + 0.5).abs() < 1e-12 && shares[PHASE_COUNT + 32].abs() < 1e-12);
    }
}

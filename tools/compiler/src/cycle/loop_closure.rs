//! Loop closure: the gap that a stride leaves between its ends, and a pose of the stride without its part of the gap.
//!
//! The gap of pelvis and joints is spread evenly over the stride. A foot that did the same would slide all through its
//! stance, by the gap divided by the period. So a foot makes up its own gap during its swing, as a walker does, and
//! stands in between. Leg inverse kinematics brings it there, no farther from the hip than in the clip, so that no knee is
//! straighter than it was; at an end of the stride no farther than at either end, so that both ends meet. Root frame:
//! metres, rotation vectors in radians.

use glam::{DQuat, DVec3};
use motiondb::body::{JOINT_COUNT, Joint};
use motiondb::motion::PHASE_COUNT;

use crate::ground::leg_ik::place_foot;
use crate::ground::rotations::rotation_vector;
use crate::retarget::human_clip::{HumanBody, HumanJoints, HumanPose};

/// Least share of the stride that a foot swings; a foot that swings less makes up its gap evenly.
const SWING_MIN_SHARE: f64 = 0.05;

/// Difference of a stride's last pose from its first.
pub(crate) struct StrideGap {
    /// Gap of pelvis and joints.
    pose: PoseGap,
    /// Gaps of both feet.
    feet: [FootGap; 2],
}

/// Difference of a stride's last pose from its first, in pelvis and joints.
struct PoseGap {
    /// Displacement of the pelvis, m.
    pelvis_m: DVec3,
    /// Rotation of each joint against its parent, as a rotation vector, rad.
    rotations: [DVec3; JOINT_COUNT],
    /// The same of the extra joints.
    extra: Box<[DVec3]>,
}

/// Difference of one foot at the end of a stride from its beginning.
struct FootGap {
    /// Displacement of the ankle, m.
    ankle_m: DVec3,
    /// Rotation of the foot in the root frame, as a rotation vector, rad.
    rotation: DVec3,
    /// How much farther than in the clip the leg may reach at the beginning and at the end, m. In between the gain
    /// changes evenly from one to the other.
    reach_gains_m: [f64; 2],
    /// How far the leg reaches at both ends, m.
    end_reach_m: f64,
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
        let rotations = std::array::from_fn(|joint| rotation_between(first.rotations[joint], last.rotations[joint]));
        let extra = first.extra.iter().zip(&last.extra).map(|(from, to)| rotation_between(*from, *to)).collect();
        let pose = PoseGap { pelvis_m: last.pelvis_m - first.pelvis_m, rotations, extra };
        let closed = pose.closed(first, 0.0).forward_kinematics(body);
        let feet = [0, 1].map(|side| {
            let [thigh, foot] = [Joint::THIGHS[side], Joint::FEET[side]].map(Joint::index);
            let ankle_m = to.positions_m[foot] - from.positions_m[foot];
            let leg_m = from.positions_m[foot] + 0.5 * ankle_m - closed.positions_m[thigh];
            let reaches_m = [&from, &to].map(|joints| reach_m(joints, side));
            let end_reach_m = leg_m.length().min(reaches_m[0].max(reaches_m[1]));
            FootGap {
                ankle_m,
                rotation: rotation_between(from.orientations[foot], to.orientations[foot]),
                reach_gains_m: reaches_m.map(|reach_m| (end_reach_m - reach_m).max(0.0)),
                end_reach_m,
                shares: shares(&rows.iter().map(|contacts| 1.0 - contacts[side]).collect::<Vec<f64>>()),
            }
        });
        Self { pose, feet }
    }

    /// A pose without its part of the gap; `along` is 0 at the beginning of the stride, 1 at its end.
    pub(crate) fn closed_pose(&self, pose: &HumanPose, along: f64, body: &HumanBody) -> HumanPose {
        let mut closed = self.pose.closed(pose, along);
        for (side, foot) in self.feet.iter().enumerate() {
            foot.close_foot(&mut closed, pose, along, body, side);
        }
        closed
    }
}

impl PoseGap {
    /// A pose whose pelvis and joints are without their part of the gap.
    fn closed(&self, pose: &HumanPose, along: f64) -> HumanPose {
        let mut closed = pose.clone();
        closed.pelvis_m -= self.pelvis_m * (along - 0.5);
        let roles = closed.rotations.iter_mut().zip(&self.rotations);
        for (rotation, gap) in roles.chain(closed.extra.iter_mut().zip(&self.extra)) {
            *rotation = DQuat::from_scaled_axis(*gap * (0.5 - along)) * *rotation;
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
        let reach_m = self.greatest_reach_m(reach_m(&clip, side), along);
        let orientation = DQuat::from_scaled_axis(self.rotation * -share) * clip.orientations[foot];
        place_foot(closed, body, side, hip_m + leg_m.clamp_length_max(reach_m), orientation);
    }

    /// How far the leg may reach that reaches so far in the clip, m: its knee gets no straighter than in the clip, or
    /// than at the ends.
    fn greatest_reach_m(&self, own_m: f64, along: f64) -> f64 {
        let [at_first_m, at_last_m] = self.reach_gains_m;
        let gain_m = at_first_m + (at_last_m - at_first_m) * along.clamp(0.0, 1.0);
        (own_m + gain_m).min(own_m.max(self.end_reach_m))
    }
}

/// Distance of an ankle from its hip, m.
fn reach_m(joints: &HumanJoints, side: usize) -> f64 {
    let [thigh, foot] = [Joint::THIGHS[side], Joint::FEET[side]].map(|joint| joints.positions_m[joint.index()]);
    thigh.distance(foot)
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
    use crate::synthetic;

    /// Both feet stand still while the hips move forward, so that the legs end straighter than they begin.
    #[test]
    fn legs_of_different_reach_close() {
        let body = synthetic::body(1.0);
        let mut first = synthetic::idle("idle", 1.0).frames[0].clone();
        first.pelvis_m.z -= 0.04;
        let mut last = first.clone();
        last.pelvis_m += DVec3::new(0.12, 0.0, 0.03);
        let ankles = first.forward_kinematics(&body);
        for side in [0, 1] {
            let foot = Joint::FEET[side].index();
            place_foot(&mut last, &body, side, ankles.positions_m[foot], ankles.orientations[foot]);
        }
        let gap = StrideGap::between(&first, &last, &body, |_| [1.0; 2]);
        let [begins, ends] =
            [(&first, 0.0), (&last, 1.0)].map(|(pose, along)| gap.closed_pose(pose, along, &body).rotations);
        for joint in 0..JOINT_COUNT {
            let seam_rad = begins[joint].angle_between(ends[joint]);
            assert!(seam_rad < 1e-6, "joint {joint} jumps by {seam_rad} rad");
        }
    }

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

//! Weighted means of poses whose feet stand where the mean of their feet stands.
//!
//! Used between the frames of a clip and over the strides of a window. The mean of joint rotations alone moves a foot
//! that is planted in every pose: hip, knee and ankle turn through large angles that cancel at the foot, and their
//! means cancel only nearly. So pelvis and joints are averaged by themselves, the orientation and the contact point of
//! each foot in the frame of the poses, and leg inverse kinematics puts the foot there. Weights sum to 1 and may be
//! negative (Catmull–Rom). Poses enter and leave in one common frame: metres, Z up.

use glam::{DQuat, DVec3};
use motiondb::body::Joint;

use crate::ground::leg_ik;
use crate::retarget::human_clip::{HumanBody, HumanJoints, HumanPose};

/// Height above the foot's lowest point at which a sole point counts 1/e for the position of the foot, m. A point that
/// stands counts fully, a lifted one hardly.
const STANDING_HEIGHT_M: f64 = 0.005;

/// The weighted mean of poses.
pub(crate) fn pose_mean(parts: &[(f64, HumanPose)], body: &HumanBody) -> HumanPose {
    let feet = |joints: &[(f64, HumanJoints)], side: usize| {
        joints.iter().fold([DVec3::ZERO; 3], |sums, (weight, joints)| {
            let points_m = joints.measured_points_m(body, side);
            std::array::from_fn(|point| sums[point] + points_m[point] * *weight)
        })
    };
    mean_with_feet(parts, body, feet)
}

/// The pose between the second and the third of four successive poses: joints by Catmull–Rom, feet by a monotone cubic.
///
/// With the monotone cubic a foot that stands in both poses does not move because it is about to leave.
pub(crate) fn pose_between(poses: [HumanPose; 4], share: f64, body: &HumanBody) -> HumanPose {
    let weights = catmull_rom(share);
    let parts: Vec<(f64, HumanPose)> = weights.into_iter().zip(poses).collect();
    let feet = |joints: &[(f64, HumanJoints)], side: usize| {
        let points_m: Vec<[DVec3; 3]> = joints.iter().map(|(_, joints)| joints.measured_points_m(body, side)).collect();
        std::array::from_fn(|point| {
            let along = |axis: usize| monotone([0, 1, 2, 3].map(|part: usize| points_m[part][point][axis]), share);
            DVec3::new(along(0), along(1), along(2))
        })
    };
    mean_with_feet(&parts, body, feet)
}

/// The weighted mean of poses, the measured points of each foot where `feet_m` puts them.
fn mean_with_feet(
    parts: &[(f64, HumanPose)],
    body: &HumanBody,
    feet_m: impl Fn(&[(f64, HumanJoints)], usize) -> [DVec3; 3],
) -> HumanPose {
    let pelvis_m = parts.iter().map(|(weight, pose)| pose.pelvis_m * *weight).sum();
    let rotations =
        std::array::from_fn(|joint| mean_rotation(parts.iter().map(|(weight, pose)| (*weight, pose.rotations[joint]))));
    let joints_beside = parts.first().map_or(0, |(_, pose)| pose.extra.len());
    let extra = |joint: usize| mean_rotation(parts.iter().map(|(weight, pose)| (*weight, pose.extra[joint])));
    let mut pose = HumanPose { pelvis_m, rotations, extra: (0..joints_beside).map(extra).collect() };
    let joints: Vec<(f64, HumanJoints)> =
        parts.iter().map(|(weight, pose)| (*weight, pose.forward_kinematics(body))).collect();
    for side in 0..2 {
        place_foot(&mut pose, &joints, body, side, feet_m(&joints, side));
    }
    pose
}

/// Gives a foot the mean orientation of the poses' feet and puts its points at the target.
fn place_foot(pose: &mut HumanPose, parts: &[(f64, HumanJoints)], body: &HumanBody, side: usize, target_m: [DVec3; 3]) {
    let [foot, toe] = [Joint::FEET[side].index(), Joint::TOES[side].index()];
    let turn = |joint: usize| mean_rotation(parts.iter().map(|(weight, joints)| (*weight, joints.orientations[joint])));
    let (foot_turn, toe_turn) = (turn(foot), turn(toe));
    let mut turned = pose.forward_kinematics(body);
    (turned.orientations[foot], turned.orientations[toe]) = (foot_turn, toe_turn);
    turned.positions_m[toe] = turned.positions_m[foot] + foot_turn * body.offsets_m[toe];
    let ankle_m = turned.positions_m[foot] + standing_offset_m(&turned, body, side, target_m);
    leg_ik::place_foot(pose, body, side, ankle_m, foot_turn);
    pose.rotations[toe] = foot_turn.inverse() * toe_turn;
}

/// Displacement from the points that a foot stands on to their targets.
fn standing_offset_m(joints: &HumanJoints, body: &HumanBody, side: usize, target_m: [DVec3; 3]) -> DVec3 {
    let (soles_m, points_m) = (joints.sole_points_m(body, side), joints.measured_points_m(body, side));
    let lowest_m = soles_m.iter().map(|point| point.z).fold(f64::INFINITY, f64::min);
    let standing = soles_m.map(|point| libm::exp((lowest_m - point.z) / STANDING_HEIGHT_M));
    let sum: DVec3 = (0..3).map(|point| (target_m[point] - points_m[point]) * standing[point]).sum();
    sum / standing.iter().sum::<f64>()
}

fn catmull_rom(t: f64) -> [f64; 4] {
    let (t2, t3) = (t * t, t * t * t);
    [0.5 * (-t + 2.0 * t2 - t3), 0.5 * (2.0 - 5.0 * t2 + 3.0 * t3), 0.5 * (t + 4.0 * t2 - 3.0 * t3), 0.5 * (t3 - t2)]
}

/// A cubic between the second and the third of four successive values that never goes beyond them.
///
/// Its slopes are the harmonic means of the differences on both sides of a value, 0 where those change sign or vanish
/// (Fritsch and Butland 1984).
fn monotone([before, from, to, after]: [f64; 4], share: f64) -> f64 {
    let slope = |a: f64, b: f64| if a * b > 0.0 { 2.0 * a * b / (a + b) } else { 0.0 };
    let (start, end) = (slope(from - before, to - from), slope(to - from, after - to));
    let (s2, s3) = (share * share, share * share * share);
    from + (to - from) * (3.0 * s2 - 2.0 * s3) + start * (share - 2.0 * s2 + s3) + end * (s3 - s2)
}

/// The normalised weighted sum of quaternions, each taken in the hemisphere of the first.
pub(crate) fn mean_rotation(rotations: impl Iterator<Item = (f64, DQuat)>) -> DQuat {
    let mut sum: Option<(DQuat, DQuat)> = None;
    for (weight, rotation) in rotations {
        let (reference, so_far) = sum.unwrap_or((rotation, DQuat::from_xyzw(0.0, 0.0, 0.0, 0.0)));
        let rotation = if rotation.dot(reference) < 0.0 { -rotation } else { rotation };
        sum = Some((reference, so_far + rotation * weight));
    }
    sum.map_or(DQuat::IDENTITY, |(_, sum)| sum.normalize())
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::synthetic::{self, SyntheticWalk};

    #[test]
    fn feet_planted_before_and_after_are_planted_between() {
        let clip = synthetic::walk("walk", SyntheticWalk { frame_rate_hz: 30.0, ..SyntheticWalk::default() });
        let points_m =
            |pose: &HumanPose, side: usize| pose.forward_kinematics(&clip.body).sole_points_m(&clip.body, side);
        let mut planted = 0;
        for poses in clip.frames.windows(4) {
            let between = pose_between([0, 1, 2, 3].map(|pose| poses[pose].clone()), 0.4, &clip.body);
            for side in 0..2 {
                let [from, to] = [&poses[1], &poses[2]].map(|pose| points_m(pose, side)[0]);
                if from.distance(to) < 1e-6 {
                    planted += 1;
                    let moved_m = points_m(&between, side)[0].distance(from);
                    assert!(moved_m < 2e-4, "{moved_m} m");
                }
            }
        }
        assert!(planted > 100, "{planted}");
    }

    #[test]
    fn monotone_cubics_meet_their_values_and_stay_between() {
        for values in [[0.0, 1.0, 2.0, 3.0], [5.0, 1.0, 1.0, 9.0], [0.0, 1.0, 1.1, 8.0], [2.0, 1.0, 3.0, 0.0]] {
            let [_, from, to, _] = values;
            assert_eq!([monotone(values, 0.0), monotone(values, 1.0)], [from, to]);
            for step in 0..=20 {
                let value = monotone(values, f64::from(step) / 20.0);
                assert!((from.min(to)..=from.max(to)).contains(&value), "{values:?}: {value}");
            }
        }
    }
}

//! Grounds the feet of poses on the target skeleton: planted soles lie on the ground at z = 0, no sole sinks.
//!
//! First the clip is shifted so that the median height of planted soles is 0. A foot of other proportions, or one whose
//! rig cannot bend its toes, pushes its toes through the ground at push-off, where human toes bend. So three
//! corrections follow for each foot of each pose:
//! 1. The ankle rises until heel and ball are on the ground; the knee bends.
//! 2. The toes bend up until their tip is on the ground. They begin before they must and straighten gradually after
//!    toe-off: else a pose whose toes bend by 50° is followed by one whose toes are straight.
//! 3. If the toes cannot bend so far, the ankle rises by the remaining depth.
//!
//! World frame: Z up, metres, radians.

use std::collections::BTreeMap;
use std::ops::Range;

use glam::{DQuat, DVec3};
use motiondb::body::Joint;
use motiondb::statistics::percentile;

use crate::ground::leg_ik;
use crate::retarget::human_clip::{HumanBody, HumanJoints, HumanPose};

/// Depth that a sole may sink, m: compression of heel pad and shoe sole under body weight.
const SOLE_DEPTH_MAX_M: f64 = 0.01;
/// Greatest bend of the toes upward, rad: 60°, published range of the first metatarsophalangeal joint: 60–70°.
const TOE_BEND_MAX_RAD: f64 = 60.0 * std::f64::consts::PI / 180.0;

/// Duration in which toes bend before they must, and straighten after they may, s: about that from toe-off to straight
/// toes in people.
const TOE_BEND_S: f64 = 0.08;

/// Indices of heel and ball in `sole_points_m` (heel, ball, toe tip).
const HEEL_AND_BALL: Range<usize> = 0..2;
/// Indices of all three sole points.
const WHOLE_SOLE: Range<usize> = 0..3;

/// Height of the lowest of heel, ball and toe tip of one foot, m.
pub(crate) fn lowest_sole_m(joints: &HumanJoints, body: &HumanBody, side: usize) -> f64 {
    joints.sole_points_m(body, side).map(|point| point.z).into_iter().fold(f64::INFINITY, f64::min)
}

/// Shifts a clip so that its planted feet stand at z = 0, by `is_planted(side, frame)`.
pub(crate) fn shift_to_ground(poses: &mut [HumanPose], body: &HumanBody, is_planted: impl Fn(usize, usize) -> bool) {
    let mut heights_m = Vec::new();
    for (frame, pose) in poses.iter().enumerate() {
        let joints = pose.forward_kinematics(body);
        let planted = [0, 1].into_iter().filter(|&side| is_planted(side, frame));
        heights_m.extend(planted.map(|side| lowest_sole_m(&joints, body, side)));
    }
    let ground_m = percentile(heights_m, 0.5).unwrap_or(0.0);
    poses.iter_mut().for_each(|pose| pose.pelvis_m.z -= ground_m);
}

/// Corrects heels, balls and toe tips that lie deeper than [`SOLE_DEPTH_MAX_M`], in poses at `rate_hz`. The first pose
/// of a cycle follows the last.
pub(crate) fn keep_soles_above_ground(poses: &mut [HumanPose], body: &HumanBody, rate_hz: f64, is_cycle: bool) {
    // Most poses need no correction, and one pose of the joints shows it.
    let sinks = |pose: &HumanPose| {
        let joints = pose.forward_kinematics(body);
        (0..2).any(|side| lowest_sole_m(&joints, body, side) < -SOLE_DEPTH_MAX_M)
    };
    let sunk: Vec<usize> = (0..poses.len()).filter(|&index| sinks(&poses[index])).collect();
    for side in 0..2 {
        for &index in &sunk {
            raise_foot(&mut poses[index], body, side, HEEL_AND_BALL);
        }
        let bends_rad: Vec<(usize, f64)> =
            sunk.iter().map(|&index| (index, toe_bend_rad(&poses[index], body, side))).collect();
        for (index, bend_rad) in gradual_bends_rad(&bends_rad, poses.len(), rate_hz, is_cycle) {
            let toe = &mut poses[index].rotations[Joint::TOES[side].index()];
            *toe = DQuat::from_rotation_y(bend_rad) * *toe;
        }
        for &index in &sunk {
            raise_foot(&mut poses[index], body, side, WHOLE_SOLE);
        }
    }
}

/// Bends of toes by pose, rad: the given ones, each approached and left within [`TOE_BEND_S`].
fn gradual_bends_rad(bends_rad: &[(usize, f64)], count: usize, rate_hz: f64, is_cycle: bool) -> BTreeMap<usize, f64> {
    let span = TOE_BEND_S * rate_hz;
    let mut gradual = BTreeMap::new();
    for &(index, bend_rad) in bends_rad.iter().filter(|(_, bend_rad)| *bend_rad < 0.0) {
        let reach = (span as usize).min(count / 2) as isize;
        for step in -reach..=reach {
            let at = index as isize + step;
            let at = if is_cycle { at.rem_euclid(count as isize) } else { at };
            if (0..count as isize).contains(&at) {
                let share = 0.5 + 0.5 * libm::cos(std::f64::consts::PI * step as f64 / span);
                let bend = gradual.entry(at as usize).or_insert(0.0_f64);
                *bend = bend.min(share * bend_rad);
            }
        }
    }
    gradual
}

/// Raises an ankle until none of the given sole points, by index, lies too deep.
fn raise_foot(pose: &mut HumanPose, body: &HumanBody, side: usize, points: Range<usize>) {
    let joints = pose.forward_kinematics(body);
    let lowest_m = joints.sole_points_m(body, side)[points].iter().map(|point| point.z).fold(f64::INFINITY, f64::min);
    let sunk_m = -SOLE_DEPTH_MAX_M - lowest_m;
    if sunk_m > 0.0 {
        let ankle_m = joints.positions_m[Joint::FEET[side].index()];
        leg_ik::place_ankle(pose, body, side, ankle_m + DVec3::Z * sunk_m);
    }
}

/// Angle by which the toes of one foot bend up until their tip does not lie too deep, rad; negative is up.
fn toe_bend_rad(pose: &HumanPose, body: &HumanBody, side: usize) -> f64 {
    let joints = pose.forward_kinematics(body);
    let [foot, toe] = [Joint::FEET[side].index(), Joint::TOES[side].index()];
    let tip_m = joints.sole_points_m(body, side)[2];
    if tip_m.z >= -SOLE_DEPTH_MAX_M {
        return 0.0;
    }
    let (toes_m, across) = (tip_m - joints.positions_m[toe], joints.orientations[foot] * DVec3::Y);
    bend_to_height_rad(toes_m, across, -SOLE_DEPTH_MAX_M - joints.positions_m[toe].z)
}

/// The least turn of a vector about an axis, toes up, that brings its end to a height, or to the nearest reachable
/// height.
fn bend_to_height_rad(vector_m: DVec3, axis: DVec3, height_m: f64) -> f64 {
    // Turned by θ, the vector has the height p + a·cos θ + b·sin θ = p + r·cos(θ − δ).
    let parallel_m = axis * axis.dot(vector_m);
    let (a, b) = (vector_m.z - parallel_m.z, axis.cross(vector_m).z);
    let (r, highest_rad) = (libm::hypot(a, b), libm::atan2(b, a));
    let bend_rad = highest_rad + libm::acos(((height_m - parallel_m.z) / r).clamp(-1.0, 1.0));
    bend_rad.clamp(-TOE_BEND_MAX_RAD, 0.0)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::retarget::human_clip::HumanClip;
    use crate::synthetic::{self, SyntheticWalk};

    fn walk() -> HumanClip {
        synthetic::walk("walk", SyntheticWalk::default())
    }

    /// Height of the lowest of all soles after [`keep_soles_above_ground`], m.
    fn lowest_lifted_m(clip: &HumanClip) -> f64 {
        let mut poses = clip.frames.clone();
        keep_soles_above_ground(&mut poses, &clip.body, clip.frame_rate_hz, false);
        let soles_m = poses.iter().flat_map(|pose| {
            let joints = pose.forward_kinematics(&clip.body);
            [0, 1].map(|side| lowest_sole_m(&joints, &clip.body, side))
        });
        soles_m.fold(f64::INFINITY, f64::min)
    }

    #[test]
    fn grounded_feet_do_not_change() {
        let clip = walk();
        let mut poses = clip.frames.clone();
        keep_soles_above_ground(&mut poses, &clip.body, clip.frame_rate_hz, false);
        assert_eq!(poses, clip.frames);
    }

    #[test]
    fn sunken_feet_rise_to_the_ground() {
        let mut clip = walk();
        clip.frames.iter_mut().for_each(|pose| pose.pelvis_m.z -= 0.05);
        assert!(lowest_lifted_m(&clip) > -SOLE_DEPTH_MAX_M - 1e-3, "{}", lowest_lifted_m(&clip));
    }

    #[test]
    fn sunken_toes_bend_up() {
        for pitch_rad in [0.2, 0.4, 0.6, 1.5] {
            let mut clip = walk();
            for pose in &mut clip.frames {
                Joint::TOES.iter().for_each(|toe| pose.rotations[toe.index()] = DQuat::from_rotation_y(pitch_rad));
            }
            assert!(lowest_lifted_m(&clip) > -SOLE_DEPTH_MAX_M - 1e-3, "{pitch_rad}: {}", lowest_lifted_m(&clip));
        }
    }

    #[test]
    fn toes_bend_gradually_also_around_a_cycle() {
        let bends = |is_cycle: bool| gradual_bends_rad(&[(1, -0.8), (2, -0.4), (7, 0.0)], 40, 60.0, is_cycle);
        let [open, closed] = [false, true].map(bends);
        assert_eq!(open[&1], -0.8);
        assert!((-0.8..-0.4).contains(&open[&2]) && open[&6] < 0.0 && !open.contains_key(&7), "{open:?}");
        assert!(!open.contains_key(&39) && closed[&39] < 0.0, "{closed:?}");
        let steepest = (0..6).map(|at| (closed[&at] - closed.get(&(at + 1)).unwrap_or(&0.0)).abs()).fold(0.0, f64::max);
        assert!(steepest < 0.3, "{steepest}");
    }
}

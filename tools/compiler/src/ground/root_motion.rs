//! HumanClip → GroundedClip: the performer's motion on the target body, on the ground at z = 0, with its real travel.
//!
//! 1. Proportions ([`crate::ground::target_body`]): the whole motion is scaled by the ratio of leg lengths and joint
//!    rotations are kept. Where bones differ, leg inverse kinematics puts the ankles back to their scaled positions.
//! 2. The clip is shifted so that its soles stand at z = 0.
//! 3. A clip in place (on a treadmill) gets the ground speed at which its stance feet stand still.
//!
//! World frame: metres, radians, Z up.

use glam::{DQuat, DVec2, DVec3};
use motiondb::body::Joint;
use motiondb::statistics::percentile;

use crate::ground::foot_grounding::lowest_sole_m;
use crate::ground::grounded_clip::GroundedClip;
use crate::ground::grounded_poses::GroundedPoses;
use crate::ground::leg_ik;
use crate::ground::rotations::align_successive;
use crate::retarget::human_clip::{HumanBody, HumanClip, HumanPose};

/// Distance, after scaling, below which two bones count as equal, m: rounding needs no inverse kinematics.
const SAME_BONE_M: f64 = 5e-4;
/// Difference in length of every bone below which two bodies count as one performer, m.
const SAME_PERFORMER_M: f64 = 5e-3;
/// Duration over which a facing is averaged, s: about a stride, over which its sway has mean zero.
const FACING_SPAN_S: f64 = 1.0;
/// Share of frames whose lowest sole lies below the floor: flight lifts many soles, noise drops a few.
const FLOOR_PERCENTILE: f64 = 0.1;

/// A clip on a target body and on the ground; loops are not unrolled yet.
pub fn grounded_clip<'a>(clip: &'a HumanClip, body: &HumanBody) -> GroundedClip<'a> {
    let scale = body.leg_length_m() / clip.body.leg_length_m();
    let poses = match has_bones_of(&clip.body, body, scale) {
        true => GroundedPoses::Moved {
            poses: &clip.frames,
            pelvis_m: clip.frames.iter().map(|pose| pose.pelvis_m * scale).collect(),
        },
        false => GroundedPoses::Own(clip.frames.iter().map(|pose| on_target(pose, &clip.body, body, scale)).collect()),
    };
    on_ground(poses, clip, body, scale)
}

/// As [`grounded_clip`], with poses of its own, which take the memory of the clip's: the clip has none afterwards.
pub(crate) fn grounded_in_place(clip: &mut HumanClip, body: &HumanBody) -> GroundedClip<'static> {
    let scale = body.leg_length_m() / clip.body.leg_length_m();
    let has_same_bones = has_bones_of(&clip.body, body, scale);
    let mut poses = std::mem::take(&mut clip.frames);
    for pose in &mut poses {
        *pose = if has_same_bones { pose.scaled(scale) } else { on_target(pose, &clip.body, body, scale) };
    }
    on_ground(GroundedPoses::Own(poses), clip, body, scale)
}

/// Whether the bones of a body, scaled, are the target's.
fn has_bones_of(source: &HumanBody, target: &HumanBody, scale: f64) -> bool {
    let is_same = |(own, other): (&DVec3, &DVec3)| (*own * scale - *other).length() <= SAME_BONE_M;
    source.offsets_m.iter().zip(&target.offsets_m).all(is_same)
}

/// Puts poses of a clip, `scale` times as large, on the ground.
fn on_ground<'a>(mut poses: GroundedPoses<'a>, clip: &HumanClip, body: &HumanBody, scale: f64) -> GroundedClip<'a> {
    lower_to_floor(&mut poses, body);
    if let Some(ground_speed) = clip.in_place_mps {
        travel(&mut poses, body, ground_speed * scale, clip.frame_rate_hz);
    }
    if let GroundedPoses::Own(poses) = &mut poses {
        align_successive(poses);
    }
    GroundedClip { frame_rate_hz: clip.frame_rate_hz, poses, rounds: None }
}

/// The pose with the target's bones: scaled, rotations kept, ankles at their scaled positions over the target's soles.
/// The hips rise with the ankles, so that legs stay as straight as they were.
fn on_target(pose: &HumanPose, source: &HumanBody, target: &HumanBody, scale: f64) -> HumanPose {
    let recorded = pose.forward_kinematics(source);
    let mut posed = pose.scaled(scale);
    let raised_m = [0, 1].map(|side| source.soles_m[side][0].z * scale - target.soles_m[side][0].z);
    posed.pelvis_m.z += 0.5 * (raised_m[0] + raised_m[1]);
    for (side, raised_m) in raised_m.into_iter().enumerate() {
        let foot = Joint::FEET[side].index();
        let ankle_m = recorded.positions_m[foot] * scale + DVec3::Z * raised_m;
        leg_ik::place_ankle(&mut posed, target, side, ankle_m);
        if is_same_performer(source, target) {
            align_foot(&mut posed, source, target, side);
        }
    }
    posed
}

fn is_same_performer(source: &HumanBody, target: &HumanBody) -> bool {
    let difference_m = |(a, b): (&DVec3, &DVec3)| (a.length() - b.length()).abs();
    source.offsets_m.iter().zip(&target.offsets_m).all(|bones| difference_m(bones) <= SAME_PERFORMER_M)
}

/// Turns foot and toes of the same performer as in the source.
///
/// How a foot lies in its frame is measured in every clip, from the frames in which it is flattest. In a run no
/// foot is flat, and that frame is a few degrees off.
fn align_foot(pose: &mut HumanPose, source: &HumanBody, target: &HumanBody, side: usize) {
    let [foot, toe] = [Joint::FEET[side].index(), Joint::TOES[side].index()];
    let arc = |from: DVec3, to: DVec3| DQuat::from_rotation_arc(from.normalize_or(DVec3::X), to.normalize_or(DVec3::X));
    let of_foot = arc(target.offsets_m[toe], source.offsets_m[toe]);
    let of_toe = arc(target.measured_m[side][2], source.measured_m[side][2]);
    pose.rotations[foot] *= of_foot;
    pose.rotations[toe] = of_foot.inverse() * pose.rotations[toe] * of_toe;
}

/// Shifts the clip so that the lowest soles of most frames lie at z = 0.
fn lower_to_floor(poses: &mut GroundedPoses, body: &HumanBody) {
    let lowest_m = (0..poses.len()).map(|frame| {
        let joints = poses.pose(frame).forward_kinematics(body);
        lowest_sole_m(&joints, body, 0).min(lowest_sole_m(&joints, body, 1))
    });
    let floor_m = percentile(lowest_m, FLOOR_PERCENTILE).unwrap_or(0.0);
    poses.pelvis_mut().for_each(|pelvis_m| pelvis_m.z -= floor_m);
}

/// Adds the ground speed of a clip in place (forward, left, m/s), along the facing of each moment without its sway.
fn travel(poses: &mut GroundedPoses, body: &HumanBody, ground_speed_mps: DVec2, frame_rate_hz: f64) {
    let facing = |frame: usize| DVec2::from_angle(poses.pose(frame).forward_kinematics(body).facing_rad());
    let facings: Vec<DVec2> = (0..poses.len()).map(facing).collect();
    let half = (0.5 * FACING_SPAN_S * frame_rate_hz) as usize;
    let mut travelled_m = DVec2::ZERO;
    for (frame, pelvis_m) in poses.pelvis_mut().enumerate() {
        *pelvis_m += travelled_m.extend(0.0);
        // The same span before and after the frame, or a turn would be late at one end and early at the other.
        let half = half.min(frame).min(facings.len() - 1 - frame);
        let forward = facings[frame - half..=frame + half].iter().sum::<DVec2>().normalize_or(facings[frame]);
        travelled_m += forward.rotate(ground_speed_mps) / frame_rate_hz;
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::ground::root_arc::{Rates, RootArc};
    use crate::synthetic::{self, SyntheticWalk, cycle_of};

    fn poses(clip: &GroundedClip) -> Vec<HumanPose> {
        (0..clip.frame_count()).map(|frame| clip.pose(frame)).collect()
    }

    #[test]
    fn a_clip_grounded_in_place_has_the_same_poses() {
        let mut clip = synthetic::walk("walk", SyntheticWalk::default());
        clip.in_place_mps = Some(DVec2::new(1.0, 0.0));
        let mut other = synthetic::body(0.9);
        other.offsets_m[Joint::LeftThigh.index()].y += 0.03;
        for body in [clip.body.scaled(0.7), other] {
            let grounded = grounded_clip(&clip, &body);
            let is_moved = matches!(grounded.poses, GroundedPoses::Moved { .. });
            assert_eq!(is_moved, body != synthetic::body(0.9) && body.leg_length_m() < 0.7);
            let in_place = grounded_in_place(&mut clip.clone(), &body);
            for (found, wanted) in poses(&in_place).iter().zip(poses(&grounded)) {
                assert_eq!(found.forward_kinematics(&body).positions_m, wanted.forward_kinematics(&body).positions_m);
            }
        }
    }

    #[test]
    fn clips_in_place_travel_at_their_ground_speed() {
        let rates = Rates { speed_mps: 1.1, turn_rate_rad_s: 0.0, strafe_mps: 0.1 };
        let mut clip = synthetic::walk("walk", SyntheticWalk { rates, ..SyntheticWalk::default() });
        let arc = RootArc { facing_rad: 0.4, rates, ..RootArc::default() };
        for (frame, pose) in clip.frames.iter_mut().enumerate() {
            pose.pelvis_m -= arc.at(frame as f64 / clip.frame_rate_hz).0.extend(0.0);
        }
        clip.in_place_mps = Some(glam::DVec2::new(1.1, 0.1));
        let found = cycle_of(&clip).rates;
        assert!((found.speed_mps - 1.1).abs() < 0.02 && (found.strafe_mps - 0.1).abs() < 0.02, "{found:?}");
    }

    #[test]
    fn higher_ankles_keep_legs_as_straight() {
        let clip = synthetic::walk("walk", SyntheticWalk::default());
        let mut target = clip.body.clone();
        target.soles_m.iter_mut().flatten().for_each(|sole_m| sole_m.z -= 0.05);
        target.offsets_m[Joint::Head.index()].z += 0.05; // With the same bones no ankle is moved.
        let reaches_m = |body: &HumanBody| -> Vec<f64> {
            let reach_m = |pose: &HumanPose| {
                let joints = pose.forward_kinematics(body);
                joints.positions_m[Joint::THIGHS[0].index()].distance(joints.positions_m[Joint::FEET[0].index()])
            };
            poses(&grounded_clip(&clip, body)).iter().map(reach_m).collect()
        };
        let errors_m =
            reaches_m(&clip.body).into_iter().zip(reaches_m(&target)).map(|(own, found)| (own - found).abs());
        assert!(errors_m.fold(0.0, f64::max) < 2e-3);
    }

    #[test]
    fn feet_stand_at_zero_whatever_the_clips_floor() {
        let mut clip = synthetic::walk("walk", SyntheticWalk::default());
        clip.frames.iter_mut().for_each(|pose| pose.pelvis_m.z += 0.4);
        let grounded = grounded_clip(&clip, &clip.body);
        let lowest_m = |pose: &HumanPose| {
            let joints = pose.forward_kinematics(&clip.body);
            lowest_sole_m(&joints, &clip.body, 0).min(lowest_sole_m(&joints, &clip.body, 1))
        };
        assert!(poses(&grounded).iter().all(|pose| lowest_m(pose).abs() < 0.005));
    }

    #[test]
    fn ankles_keep_their_scaled_positions_on_another_body() {
        let clip = synthetic::walk("walk", SyntheticWalk::default());
        let mut body = synthetic::body(0.9);
        body.offsets_m[Joint::LeftThigh.index()].y += 0.03;
        body.offsets_m[Joint::RightThigh.index()].y -= 0.03;
        for (pose, source) in poses(&grounded_clip(&clip, &body)).iter().zip(&clip.frames) {
            let (placed, recorded) = (pose.forward_kinematics(&body), source.forward_kinematics(&clip.body));
            for foot in Joint::FEET.map(Joint::index) {
                let error_m = placed.positions_m[foot] - recorded.positions_m[foot] * 0.9;
                assert!(error_m.length() < 0.01, "{error_m}");
            }
        }
    }
}

//! HumanClip → GroundedClip: the performer's motion on the target skeleton, over the ground at z = 0, travelling as it
//! was meant.
//!
//! Proportions ([`crate::ground::target_skeleton`]): the whole motion is scaled by the ratio of leg lengths, joint rotations
//! are kept, and where the bones differ leg inverse kinematics puts the ankles back to their scaled places. Clips that
//! tread on the spot get the ground speed at which their stance feet stand still. World frame, metres, radians, Z up.

use glam::{DQuat, DVec2, DVec3};
use motiondb::body::{JOINT_COUNT, Joint};

use crate::cycle::pose_mean::pose_between;
use crate::ground::leg_ik;
use crate::retarget::human_clip::{HumanBody, HumanClip, HumanJoints, HumanPose};

/// Bones nearer than this, once scaled, are the same bones: no inverse kinematics for rounding errors.
const SAME_BONE_M: f64 = 5e-4;
/// A performer whose bones are all as long as the target's, to this much, is the target himself in another clip.
const SAME_LENGTH_M: f64 = 5e-3;
/// A facing is taken over this time: about a stride, over which its sway has no mean.
const FACING_SPAN_S: f64 = 1.0;
/// Of the lowest sole points of all frames, the share that lies below the floor: flight lifts many, noise drops a few.
const FLOOR_PERCENTILE: f64 = 0.1;

/// A clip on the target skeleton.
#[derive(Clone, Debug)]
pub struct GroundedClip {
    /// Frames a second.
    pub frame_rate_hz: f64,
    /// One pose a frame in the world; successive rotations lie in one hemisphere.
    pub poses: Vec<HumanPose>,
    /// The clip is a loop, here unrolled: frames of one round. The frames `loop_frames..2·loop_frames` are its middle
    /// copy.
    pub loop_frames: Option<usize>,
}

/// Puts a clip on the target body and on the ground.
pub fn ground(clip: &HumanClip, body: &HumanBody) -> GroundedClip {
    let scale = leg_length_m(body) / leg_length_m(&clip.body);
    let is_same = |(own, other): (&DVec3, &DVec3)| (*own * scale - *other).length() <= SAME_BONE_M;
    let same_bones = clip.body.offsets_m.iter().zip(&body.offsets_m).all(is_same);
    let posed = |pose: &HumanPose| {
        if same_bones { pose.scaled(scale) } else { retarget(pose, &clip.body, body, scale) }
    };
    let mut poses: Vec<HumanPose> = clip.frames.iter().map(posed).collect();
    lower_to_floor(&mut poses, body);
    if let Some(ground_speed) = clip.in_place_mps {
        travel(&mut poses, body, ground_speed * scale, clip.frame_rate_hz);
    }
    align_hemispheres(&mut poses);
    GroundedClip { frame_rate_hz: clip.frame_rate_hz, poses, loop_frames: None }
}

/// Thigh plus shank, mean of both sides.
pub(crate) fn leg_length_m(body: &HumanBody) -> f64 {
    let leg = |side: usize| {
        body.offsets_m[Joint::SHANKS[side].index()].length() + body.offsets_m[Joint::FEET[side].index()].length()
    };
    0.5 * (leg(0) + leg(1))
}

/// The pose with the target's bones: scaled, rotations kept, ankles at their scaled places over their own soles. The
/// hips rise with the ankles, so that legs stay as straight as they were.
fn retarget(pose: &HumanPose, source: &HumanBody, target: &HumanBody, scale: f64) -> HumanPose {
    let wanted = pose.forward_kinematics(source);
    let mut posed = pose.scaled(scale);
    let raised_m = [0, 1].map(|side| source.soles_m[side][0].z * scale - target.soles_m[side][0].z);
    posed.pelvis_m.z += 0.5 * (raised_m[0] + raised_m[1]);
    for (side, raised_m) in raised_m.into_iter().enumerate() {
        let foot = Joint::FEET[side].index();
        let ankle_m = wanted.positions_m[foot] * scale + DVec3::Z * raised_m;
        leg_ik::place_ankle(&mut posed, target, side, ankle_m);
        if is_same_performer(source, target) {
            align_foot(&mut posed, source, target, side);
        }
    }
    posed
}

fn is_same_performer(source: &HumanBody, target: &HumanBody) -> bool {
    let off_m = |(a, b): (&DVec3, &DVec3)| (a.length() - b.length()).abs();
    source.offsets_m.iter().zip(&target.offsets_m).all(|bones| off_m(bones) <= SAME_LENGTH_M)
}

/// Turns foot and toes of the same performer as his are turned. How a foot lies in its frame is found anew in every
/// clip, from the frames in which it is flattest; in a run none is flat, and the frame is a few degrees off.
fn align_foot(pose: &mut HumanPose, source: &HumanBody, target: &HumanBody, side: usize) {
    let [foot, toe] = [Joint::FEET[side].index(), Joint::TOES[side].index()];
    let arc = |from: DVec3, to: DVec3| DQuat::from_rotation_arc(from.normalize_or(DVec3::X), to.normalize_or(DVec3::X));
    let of_foot = arc(target.offsets_m[toe], source.offsets_m[toe]);
    let of_toe = arc(target.measured_m[side][2], source.measured_m[side][2]);
    pose.rotations[foot] *= of_foot;
    pose.rotations[toe] = of_foot.inverse() * pose.rotations[toe] * of_toe;
}

/// Shifts the clip so that planted soles lie at z = 0.
fn lower_to_floor(poses: &mut [HumanPose], body: &HumanBody) {
    let mut lowest: Vec<f64> = poses.iter().map(|pose| lowest_sole_m(&pose.forward_kinematics(body), body)).collect();
    let floor_m = percentile(&mut lowest, FLOOR_PERCENTILE);
    for pose in poses {
        pose.pelvis_m.z -= floor_m;
    }
}

fn lowest_sole_m(joints: &HumanJoints, body: &HumanBody) -> f64 {
    let points = (0..2).flat_map(|side| joints.sole_points_m(body, side));
    points.map(|point| point.z).fold(f64::INFINITY, f64::min)
}

/// Adds the ground speed of a clip that treads on the spot, along the facing of each moment; its sway within a stride
/// falls out.
fn travel(poses: &mut [HumanPose], body: &HumanBody, ground_speed_mps: DVec2, frame_rate_hz: f64) {
    let facing = |pose: &HumanPose| DVec2::from_angle(pose.forward_kinematics(body).facing_rad());
    let facings: Vec<DVec2> = poses.iter().map(facing).collect();
    let half = (0.5 * FACING_SPAN_S * frame_rate_hz) as usize;
    let mut place_m = DVec2::ZERO;
    for (frame, pose) in poses.iter_mut().enumerate() {
        pose.pelvis_m += place_m.extend(0.0);
        // The same span before and after, or a turn would be late at one end and early at the other.
        let half = half.min(frame).min(facings.len() - 1 - frame);
        let forward = facings[frame - half..=frame + half].iter().sum::<DVec2>().normalize_or(facings[frame]);
        place_m += forward.rotate(ground_speed_mps) / frame_rate_hz;
    }
}

/// Flips quaternions so that each lies in the hemisphere of its predecessor and may be interpolated component by
/// component.
pub(crate) fn align_hemispheres(poses: &mut [HumanPose]) {
    for frame in 1..poses.len() {
        let (before, after) = poses.split_at_mut(frame);
        align_to(&mut after[0].rotations, &before[frame - 1].rotations);
    }
}

/// Flips quaternions into the hemispheres of others.
pub(crate) fn align_to(rotations: &mut [DQuat; JOINT_COUNT], reference: &[DQuat; JOINT_COUNT]) {
    for (rotation, reference) in rotations.iter_mut().zip(reference) {
        if rotation.dot(*reference) < 0.0 {
            *rotation = -*rotation;
        }
    }
}

/// The value below which a share of all values lies; sorts them.
pub(crate) fn percentile(values: &mut [f64], share: f64) -> f64 {
    values.sort_by(f64::total_cmp);
    let index = (share * values.len() as f64) as usize;
    values.get(index.min(values.len().saturating_sub(1))).copied().unwrap_or(0.0)
}

impl GroundedClip {
    /// The pose at a fractional frame, clamped to the clip.
    pub fn pose_at(&self, frame: f64, body: &HumanBody) -> HumanPose {
        let last = self.poses.len() - 1;
        let base = (frame.max(0.0) as usize).min(last.saturating_sub(1));
        let neighbours = [base.saturating_sub(1), base, (base + 1).min(last), (base + 2).min(last)];
        pose_between(neighbours.map(|frame| &self.poses[frame]), (frame - base as f64).clamp(0.0, 1.0), body)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::ground::arc::{Arc, Rates};
    use crate::synthetic::{self, Walk, cycle_of};

    #[test]
    fn a_clip_on_the_spot_travels_at_its_ground_speed() {
        let rates = Rates { speed_mps: 1.1, turn_rate_rad_s: 0.0, strafe_mps: 0.1 };
        let mut clip = synthetic::walk("walk", Walk { rates, ..Walk::default() });
        let arc = Arc { facing_rad: 0.4, rates, ..Arc::default() };
        for (frame, pose) in clip.frames.iter_mut().enumerate() {
            pose.pelvis_m -= arc.at(frame as f64 / clip.frame_rate_hz).0.extend(0.0);
        }
        clip.in_place_mps = Some(glam::DVec2::new(1.1, 0.1));
        let found = cycle_of(&clip).rates;
        assert!((found.speed_mps - 1.1).abs() < 0.02 && (found.strafe_mps - 0.1).abs() < 0.02, "{found:?}");
    }

    #[test]
    fn a_target_with_higher_ankles_keeps_the_legs_as_straight_as_they_were() {
        let clip = synthetic::walk("walk", Walk::default());
        let mut target = clip.body.clone();
        target.soles_m.iter_mut().flatten().for_each(|sole_m| sole_m.z -= 0.05);
        target.offsets_m[Joint::Head.index()].z += 0.05; // other bones, or nothing is retargeted
        let reaches_m = |body: &HumanBody| -> Vec<f64> {
            let reach_m = |pose: &HumanPose| {
                let joints = pose.forward_kinematics(body);
                joints.positions_m[Joint::THIGHS[0].index()].distance(joints.positions_m[Joint::FEET[0].index()])
            };
            ground(&clip, body).poses.iter().map(reach_m).collect()
        };
        let off_m = reaches_m(&clip.body).into_iter().zip(reaches_m(&target)).map(|(own, found)| (own - found).abs());
        assert!(off_m.fold(0.0, f64::max) < 2e-3);
    }

    #[test]
    fn feet_stand_at_zero_wherever_the_clip_had_its_floor() {
        let mut clip = synthetic::walk("walk", Walk::default());
        clip.frames.iter_mut().for_each(|pose| pose.pelvis_m.z += 0.4);
        let grounded = ground(&clip, &clip.body);
        let lowest = |pose: &HumanPose| lowest_sole_m(&pose.forward_kinematics(&clip.body), &clip.body);
        assert!(grounded.poses.iter().all(|pose| lowest(pose).abs() < 0.005));
    }

    #[test]
    fn another_body_puts_its_ankles_at_the_scaled_places() {
        let clip = synthetic::walk("walk", Walk::default());
        let mut body = synthetic::body(0.9);
        body.offsets_m[Joint::LeftThigh.index()].y += 0.03;
        body.offsets_m[Joint::RightThigh.index()].y -= 0.03;
        for (pose, source) in ground(&clip, &body).poses.iter().zip(&clip.frames) {
            let (placed, wanted) = (pose.forward_kinematics(&body), source.forward_kinematics(&clip.body));
            for foot in Joint::FEET.map(Joint::index) {
                let off_m = placed.positions_m[foot] - wanted.positions_m[foot] * 0.9;
                assert!(off_m.length() < 0.01, "{off_m}");
            }
        }
    }
}

//! A source clip in metres, z up → [`HumanClip`]: the canonical humanoid, its joints where the source's joints are.
//!
//! The body's bones are the source's mean bones in the calibrated joint frames (`calibration`). In each frame, every
//! joint with one child is turned by the shortest arc until its bone points at that child's position in the source. So
//! twist bones between roles, trunks that are divided otherwise and joints with position channels do not matter. Last,
//! the body is moved vertically until its soles stand on z = 0.

use glam::{DQuat, DVec2, DVec3};
use motiondb::body::{JOINT_COUNT, Joint};
use motiondb::motion::SourceRecord;

use crate::read::source_clip::SourceClip;
use crate::retarget::anchors::{JointAnchor, anchors};
use crate::retarget::calibration::calibrated;
use crate::retarget::facing_frame::facing_rad;
use crate::retarget::human_clip::{Choices, HumanBody, HumanClip, HumanPose};
use crate::retarget::joint_tracks::JointTracks;
use crate::retarget::soles::{Soles, soles};
use crate::retarget::source_parameters::SourceParameters;
use crate::retarget::units::{SourceUnits, leg_length, middle};
use crate::rig::roles::Roles;

/// Least length of a bone that is aimed, m: a millimetre of error would turn a shorter one by degrees.
const SHORTEST_AIMED_M: f64 = 0.02;
/// Height of the crown above the head joint, divided by leg length, as adults have it.
const CROWN_OVER_LEG: f64 = 0.24;
/// Distance of the fingertips from the wrist where the source has no such joint, over leg length, as adults have it.
const HAND_OVER_LEG: f64 = 0.21;

/// The clip on the canonical humanoid. The source is freed before the poses are made: a clip of an hour has gigabytes.
pub(crate) fn to_human(
    clip: SourceClip,
    roles: &Roles,
    units: &SourceUnits,
    parameters: SourceParameters,
    name: String,
) -> HumanClip {
    let leg_m = leg_length(&clip, roles);
    let forward = forward(&clip, roles);
    let anchors = anchors(&clip, roles, &forward, leg_m);
    let positions_m: Vec<[DVec3; JOINT_COUNT]> =
        (0..clip.frame_count()).map(|frame| positions(&clip, roles, &anchors, frame)).collect();
    let tracks = JointTracks { clip: &clip, roles, anchors: &anchors, positions_m: &positions_m, forward: &forward };
    let mut orientations = calibrated(&tracks);
    for (turns, positions) in orientations.iter_mut().zip(&positions_m) {
        aim_pelvis(turns, positions);
    }
    let offsets_m = mean_offsets(&positions_m, &orientations);
    let soles = soles(&tracks, &orientations, leg_m);
    let ground_m = soles.ground_m;
    let body = body(&tracks, &orientations, offsets_m, soles, leg_m);
    let source = record(&clip, units, parameters);
    let (first_frame, frame_rate_hz) = (clip.first_frame, clip.frame_rate_hz);
    drop(clip);
    HumanClip {
        name,
        source,
        first_frame,
        frame_rate_hz,
        body,
        frames: poses(&offsets_m, &positions_m, &orientations, ground_m),
        in_place_mps: parameters.is_in_place.then(|| DVec2::new(parameters.speed_mps, parameters.strafe_mps)),
        unfit: None,
        choices: Choices::default(),
    }
}

/// Unit vectors of the body's facing on the ground, one for each frame.
fn forward(clip: &SourceClip, roles: &Roles) -> Vec<DVec3> {
    let facing = |frame: usize| DVec2::from_angle(facing_rad(clip, roles, frame)).extend(0.0);
    (0..clip.frame_count()).map(facing).collect()
}

/// Positions of all canonical joints in one frame, m. The pelvis is the hips' midpoint even where the hips are not
/// rigid.
fn positions(
    clip: &SourceClip,
    roles: &Roles,
    anchors: &[JointAnchor; JOINT_COUNT],
    frame: usize,
) -> [DVec3; JOINT_COUNT] {
    let mut positions = anchors.each_ref().map(|anchor| anchor.position_m(clip, frame));
    positions[Joint::Pelvis.index()] = middle(clip, roles, Joint::THIGHS, frame);
    positions
}

/// Turns the pelvis until its y axis is the hip line. Hips may move in the pelvis: CMU's hip helpers turn, drawn
/// characters stretch.
fn aim_pelvis(turns: &mut [DQuat; JOINT_COUNT], positions_m: &[DVec3; JOINT_COUNT]) {
    let [left, right] = Joint::THIGHS.map(|hip| positions_m[hip.index()]);
    if let Some(line) = (left - right).try_normalize() {
        let pelvis = &mut turns[Joint::Pelvis.index()];
        *pelvis = (DQuat::from_rotation_arc(*pelvis * DVec3::Y, line) * *pelvis).normalize();
    }
}

/// Offsets of all joints from their parents, means over the clip, m.
fn mean_offsets(positions_m: &[[DVec3; JOINT_COUNT]], orientations: &[[DQuat; JOINT_COUNT]]) -> [DVec3; JOINT_COUNT] {
    Joint::ALL.map(|joint| {
        let Some(parent) = joint.parent().map(Joint::index) else { return DVec3::ZERO };
        let local = |(positions, turns): (&[DVec3; JOINT_COUNT], &[DQuat; JOINT_COUNT])| {
            turns[parent].inverse() * (positions[joint.index()] - positions[parent])
        };
        positions_m.iter().zip(orientations).map(local).sum::<DVec3>() / positions_m.len() as f64
    })
}

/// The poses of all frames, with the ground at z = 0.
fn poses(
    offsets_m: &[DVec3; JOINT_COUNT],
    positions_m: &[[DVec3; JOINT_COUNT]],
    orientations: &[[DQuat; JOINT_COUNT]],
    ground_m: f64,
) -> Vec<HumanPose> {
    let posed = |(positions, turns): (&[DVec3; JOINT_COUNT], &[DQuat; JOINT_COUNT])| {
        let mut pose = pose(offsets_m, positions, turns);
        pose.pelvis_m.z -= ground_m;
        pose
    };
    positions_m.iter().zip(orientations).map(posed).collect()
}

/// One pose: bones of joints with one child are aimed at `targets_m`, parents first.
fn pose(
    offsets_m: &[DVec3; JOINT_COUNT],
    targets_m: &[DVec3; JOINT_COUNT],
    calibrated: &[DQuat; JOINT_COUNT],
) -> HumanPose {
    let mut positions = *targets_m;
    let mut orientations = *calibrated;
    for joint in Joint::ALL {
        let index = joint.index();
        if let Some(parent) = joint.parent().map(Joint::index) {
            positions[index] = positions[parent] + orientations[parent] * offsets_m[index];
        }
        if let Some(child) = only_child(joint) {
            let (bone, target) = (orientations[index] * offsets_m[child], targets_m[child] - positions[index]);
            if bone.length().min(target.length()) > SHORTEST_AIMED_M {
                let arc = DQuat::from_rotation_arc(bone.normalize(), target.normalize());
                orientations[index] = (arc * orientations[index]).normalize();
            }
        }
    }
    let local = |joint: Joint| {
        let parent = joint.parent().map_or(DQuat::IDENTITY, |parent| orientations[parent.index()]);
        let turn = (parent.inverse() * orientations[joint.index()]).normalize();
        // A rotation has two quaternions. This one turns by less than half.
        if turn.w < 0.0 { -turn } else { turn }
    };
    HumanPose { pelvis_m: targets_m[Joint::Pelvis.index()], rotations: Joint::ALL.map(local) }
}

/// Index of the child of a joint that has exactly one.
fn only_child(joint: Joint) -> Option<usize> {
    let mut children = Joint::ALL.into_iter().filter(|child| child.parent() == Some(joint));
    match (children.next(), children.next()) {
        (Some(child), None) => Some(child.index()),
        _ => None,
    }
}

fn record(clip: &SourceClip, units: &SourceUnits, parameters: SourceParameters) -> SourceRecord {
    SourceRecord {
        file: clip.file.clone(),
        clip: clip.clip.clone(),
        speed_mps: parameters.speed_mps as f32,
        turn_rate_rad_s: parameters.turn_rate_rad_s as f32,
        strafe_mps: parameters.strafe_mps as f32,
        up_axis: units.up_axis.clone(),
        metres_per_unit: units.metres_per_unit as f32,
        frame_rate_hz: clip.frame_rate_hz as f32,
        diagnostics: clip.diagnostics.clone(),
    }
}

fn body(
    tracks: &JointTracks,
    orientations: &[[DQuat; JOINT_COUNT]],
    offsets_m: [DVec3; JOINT_COUNT],
    soles: Soles,
    leg_m: f64,
) -> HumanBody {
    let mut segment_ends_m = Joint::ALL.map(|joint| only_child(joint).map_or(DVec3::ZERO, |child| offsets_m[child]));
    segment_ends_m[Joint::Pelvis.index()] = offsets_m[Joint::SpineLower.index()];
    segment_ends_m[Joint::SpineUpper.index()] = offsets_m[Joint::Neck.index()];
    segment_ends_m[Joint::Head.index()] = CROWN_OVER_LEG * leg_m * DVec3::Z;
    for (side, hand) in [Joint::LeftHand, Joint::RightHand].into_iter().enumerate() {
        let sign = if side == 0 { 1.0 } else { -1.0 };
        let adult = HAND_OVER_LEG * leg_m * sign * DVec3::Y;
        segment_ends_m[hand.index()] = tracks.mean_end(hand, orientations).unwrap_or(adult);
        segment_ends_m[Joint::TOES[side].index()] = soles.points_m[side][2];
    }
    HumanBody { offsets_m, segment_ends_m, soles_m: soles.points_m, measured_m: soles.measured_m }
}

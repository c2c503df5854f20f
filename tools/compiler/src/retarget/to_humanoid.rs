//! A source clip in metres, z up → [`HumanClip`]: the canonical humanoid, its joints where the source's joints are.
//!
//! The body's bones are the source's mean bones in the calibrated joint frames (`calibration`). In each frame, every
//! joint with one child is turned by the shortest arc until its bone points at that child's position in the source. So
//! twist bones between roles, trunks that are divided otherwise and joints with position channels do not matter. Last,
//! the body is moved vertically until its soles stand on z = 0.

use glam::{DQuat, DVec2, DVec3};
use motiondb::body::{JOINT_COUNT, Joint};
use motiondb::motion::SourceRecord;

use crate::error::RejectionReason;
use crate::extra_joints::extra_tracks::ExtraTracks;
use crate::extra_joints::palm::turn_to_palms;
use crate::read::source_clip::{SourceClip, with_room};
use crate::retarget::anchors::anchors;
use crate::retarget::calibration::calibration;
use crate::retarget::facing_frame::facing_rad;
use crate::retarget::human_clip::{Choices, HumanBody, HumanClip, HumanPose};
use crate::retarget::joint_tracks::{CalibratedTracks, JointTracks};
use crate::retarget::posture::{self, LowPart};
use crate::retarget::soles::{Soles, soles};
use crate::retarget::source_parameters::SourceParameters;
use crate::retarget::units::{SourceUnits, leg_length};
use crate::rig::rig_head::RigHead;
use crate::rig::roles::Roles;

/// Least length of a bone that is aimed, m: a millimetre of error would turn a shorter one by degrees.
const SHORTEST_AIMED_M: f64 = 0.02;
/// Number of frames of the source that are freed at once.
const FREED_FRAMES: usize = 4096;
/// Height of the crown above the head joint, divided by leg length, as adults have it.
const CROWN_OVER_LEG: f64 = 0.24;
/// Distance of the fingertips from the wrist where the source has no such joint, over leg length, as adults have it.
const HAND_OVER_LEG: f64 = 0.21;

/// The clip on the canonical humanoid. The source's frames are freed as poses replace them.
pub(crate) fn to_human(
    mut clip: SourceClip,
    roles: &Roles,
    units: &SourceUnits,
    parameters: SourceParameters,
    low_parts: Vec<LowPart>,
    name: String,
) -> Result<HumanClip, RejectionReason> {
    let leg_m = leg_length(&clip, roles);
    let forward = forward(&clip, roles);
    let anchors = anchors(&clip, roles, &forward, leg_m);
    let upright = posture::upright_frames(&clip, &low_parts);
    let tracks = JointTracks { clip: &clip, roles, anchors: &anchors, forward: &forward, upright: &upright };
    let mut constants = calibration(&tracks);
    turn_to_palms(&tracks, &mut constants);
    let calibrated = CalibratedTracks { tracks, constants: &constants };
    let offsets_m = mean_offsets(&calibrated);
    let soles = soles(&calibrated, leg_m);
    let ground_m = soles.ground_m;
    let body = body(&calibrated, offsets_m, soles, leg_m);
    let extra_tracks = ExtraTracks::of(&calibrated);
    let extra_offsets_m = extra_tracks.offsets_m(&calibrated);
    let rig_head = RigHead::of(&clip, roles, leg_m, constants[Joint::Head.index()]);
    let mut frames = with_room(clip.frame_count())?;
    // From the last frame to the first: a list is cut at its end.
    while clip.frame_count() > 0 {
        let first = clip.frame_count().saturating_sub(FREED_FRAMES);
        let tracks = JointTracks { clip: &clip, roles, anchors: &anchors, forward: &forward, upright: &upright };
        let calibrated = CalibratedTracks { tracks, constants: &constants };
        frames.extend((first..clip.frame_count()).rev().map(|frame| HumanPose {
            extra: extra_tracks.rotations(&calibrated, frame),
            ..pose(&calibrated, &offsets_m, frame, ground_m)
        }));
        clip.free_from(first);
    }
    frames.reverse();
    Ok(HumanClip {
        name,
        source: record(&clip, units, parameters),
        first_frame: clip.first_frame,
        frame_rate_hz: clip.frame_rate_hz,
        body,
        extra: extra_tracks.clip_extra(&extra_offsets_m, frames.iter().map(|pose: &HumanPose| &*pose.extra)),
        frames,
        in_place_mps: parameters.is_in_place.then(|| DVec2::new(parameters.speed_mps, parameters.strafe_mps)),
        low_parts,
        spread_parts: Vec::new(),
        seems_to_crawl: false,
        jumps: Vec::new(),
        unfit: None,
        rig_head: Some(rig_head),
        choices: Choices::default(),
        style: String::new(),
        stored: None,
    })
}

/// Unit vectors of the body's facing on the ground, one for each frame.
fn forward(clip: &SourceClip, roles: &Roles) -> Vec<DVec3> {
    let facing = |frame: usize| DVec2::from_angle(facing_rad(clip, roles, frame)).extend(0.0);
    (0..clip.frame_count()).map(facing).collect()
}

/// Offsets of all joints from their parents, means over the clip, m.
fn mean_offsets(calibrated: &CalibratedTracks) -> [DVec3; JOINT_COUNT] {
    let frames = calibrated.tracks.frame_count();
    let mut sums_m = [DVec3::ZERO; JOINT_COUNT];
    for frame in 0..frames {
        let positions_m = Joint::ALL.map(|joint| calibrated.tracks.position_m(joint, frame));
        let inverses = Joint::ALL.map(|joint| calibrated.orientation(joint, frame).inverse());
        for joint in Joint::ALL {
            let Some(parent) = joint.parent().map(Joint::index) else { continue };
            let local_m = inverses[parent] * (positions_m[joint.index()] - positions_m[parent]);
            sums_m[joint.index()] += local_m;
        }
    }
    sums_m.map(|sum_m| sum_m / frames as f64)
}

/// The pose of a frame, without extra joints, over ground at `ground_m`, which lies at z = 0 afterwards. Bones of joints with one child are
/// aimed at their child's position in the source, parents first.
fn pose(calibrated: &CalibratedTracks, offsets_m: &[DVec3; JOINT_COUNT], frame: usize, ground_m: f64) -> HumanPose {
    let targets_m = Joint::ALL.map(|joint| calibrated.tracks.position_m(joint, frame));
    let mut positions = targets_m;
    let mut orientations = Joint::ALL.map(|joint| calibrated.orientation(joint, frame));
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
    let pelvis_m = targets_m[Joint::Pelvis.index()];
    let pelvis_m = pelvis_m.with_z(pelvis_m.z - ground_m);
    HumanPose { pelvis_m, rotations: Joint::ALL.map(local), extra: Box::default() }
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

fn body(calibrated: &CalibratedTracks, offsets_m: [DVec3; JOINT_COUNT], soles: Soles, leg_m: f64) -> HumanBody {
    let mut segment_ends_m = Joint::ALL.map(|joint| only_child(joint).map_or(DVec3::ZERO, |child| offsets_m[child]));
    segment_ends_m[Joint::Pelvis.index()] = offsets_m[Joint::SpineLower.index()];
    segment_ends_m[Joint::SpineUpper.index()] = offsets_m[Joint::Neck.index()];
    segment_ends_m[Joint::Head.index()] = CROWN_OVER_LEG * leg_m * DVec3::Z;
    for (side, hand) in [Joint::LeftHand, Joint::RightHand].into_iter().enumerate() {
        let sign = if side == 0 { 1.0 } else { -1.0 };
        let adult = HAND_OVER_LEG * leg_m * sign * DVec3::Y;
        segment_ends_m[hand.index()] = calibrated.mean_end(hand).unwrap_or(adult);
        segment_ends_m[Joint::TOES[side].index()] = soles.points_m[side][2];
    }
    let Soles { points_m: soles_m, measured_m, shows_toe_ends, .. } = soles;
    HumanBody { offsets_m, segment_ends_m, soles_m, measured_m, shows_toe_ends }
}

//! Extra joints of a source: constant calibration, and their rotations relative to their parents in each frame.
//!
//! As for the 22 roles ([`crate::retarget::calibration`]), R(t) = G(t)·K, with G the source joint's global orientation.
//! K matches directions that are constant in the source joint's frame with those of the rest pose:
//!
//! | joint | first direction, matched exactly | second direction |
//! |---|---|---|
//! | finger | to the next joint or the tip, ±y | the palm's x; after the first joint, that of the joint before |
//! | thumb | to the next joint or the tip, ±y | the palm's z; after the first joint, that of the joint before |
//! | toe | to the tip, +x | the foot's z |
//! | twist bone, joint without a bone | as its parent in the mean | |
//!
//! Joints of a finger after the first are hinges: their second direction is that of the joint before, turned by the
//! shortest arc from bone to bone, which no bend of the finger changes. A curled finger that is spread would turn the
//! palm's x by 17°.
//!
//! Fingers are relative to the hand, whose axes are those of its palm ([`crate::extra_joints::palm`]): so clips of different rigs
//! share a frame. World frame of the clip: metres, z up.

use glam::{DQuat, DVec3};
use motiondb::body::{ExtraJoint, ExtraParent, ExtraPart};
use motiondb::statistics::mean;

use crate::extra_joints::clip_extra::ClipExtra;
use crate::ground::pose_mean::mean_rotation;
use crate::retarget::calibration::basis;
use crate::retarget::joint_tracks::CalibratedTracks;
use crate::rig::roles::SourceExtra;
use crate::rig::sampled_frames;

/// Length below which a bone of a finger has no direction, m.
const SHORTEST_BONE_M: f64 = 1e-3;

/// The extra joints of a source, calibrated.
pub(crate) struct ExtraTracks {
    joints: Vec<ExtraTrack>,
}

/// An extra joint, calibrated.
struct ExtraTrack {
    extra: SourceExtra,
    /// K, in the frame of the source joint.
    constant: DQuat,
    /// Position in the list of the parent that is an extra joint.
    parent: Option<usize>,
}

impl ExtraTracks {
    /// Calibrates the extra joints of a clip.
    pub(crate) fn of(calibrated: &CalibratedTracks) -> Self {
        let extra = &calibrated.tracks.roles.extra;
        let mut found = Self { joints: Vec::with_capacity(extra.len()) };
        let mut bones: Vec<Option<DVec3>> = Vec::with_capacity(extra.len());
        for joint in extra {
            let parent = match joint.joint.parent() {
                ExtraParent::Role(_) => None,
                ExtraParent::Extra(parent) => found.joints.iter().position(|other| other.extra.joint == parent),
            };
            // The bones of a finger usually point along one axis of their joints.
            let bone = bone(calibrated, joint).or_else(|| parent.and_then(|parent| bones[parent]));
            let constant = found.constant(calibrated, joint, bone);
            bones.push(bone);
            found.joints.push(ExtraTrack { extra: *joint, constant, parent });
        }
        found
    }

    /// Rotation of each joint in its parent's frame.
    pub(crate) fn rotations(&self, calibrated: &CalibratedTracks, frame: usize) -> Box<[DQuat]> {
        let turn = |track: &ExtraTrack| {
            let turn =
                (self.parent_turn(calibrated, track, frame).inverse() * track.turn(calibrated, frame)).normalize();
            if !turn.is_finite() {
                return DQuat::IDENTITY;
            }
            if turn.w < 0.0 { -turn } else { turn }
        };
        self.joints.iter().map(turn).collect()
    }

    /// Orientations of each joint's parent and of the joint itself, `[parent, own]`.
    pub(crate) fn axes(&self, calibrated: &CalibratedTracks, frame: usize) -> Vec<[DQuat; 2]> {
        let axes = |track: &ExtraTrack| [self.parent_turn(calibrated, track, frame), track.turn(calibrated, frame)];
        self.joints.iter().map(axes).collect()
    }

    /// Mean position of each joint relative to its parent, m.
    pub(crate) fn offsets_m(&self, calibrated: &CalibratedTracks) -> Vec<DVec3> {
        let tracks = &calibrated.tracks;
        let offset_m = |track: &ExtraTrack, frame: usize| {
            let parent_m = match (track.parent, track.extra.joint.parent()) {
                (Some(parent), _) => tracks.clip.position(frame, self.joints[parent].extra.source),
                (None, ExtraParent::Role(role)) => tracks.position_m(role, frame),
                (None, ExtraParent::Extra(_)) => return DVec3::ZERO,
            };
            let position_m = tracks.clip.position(frame, track.extra.source);
            self.parent_turn(calibrated, track, frame).inverse() * (position_m - parent_m)
        };
        let frames = sampled_frames(tracks.frame_count());
        let mean_m = |track| mean(frames.iter().map(|&frame| offset_m(track, frame))).unwrap_or_default();
        self.joints.iter().map(mean_m).collect()
    }

    /// The joints with the means of their rotations in some poses.
    pub(crate) fn clip_extra<'a>(
        &self,
        offsets_m: &[DVec3],
        poses: impl Iterator<Item = &'a [DQuat]> + Clone,
    ) -> Vec<ClipExtra> {
        let of_joint = |(index, (track, offset_m)): (usize, (&ExtraTrack, &DVec3))| ClipExtra {
            joint: track.extra.joint,
            offset_m: *offset_m,
            mean: mean_rotation(poses.clone().map(|pose| (1.0, pose[index]))),
        };
        self.joints.iter().zip(offsets_m).enumerate().map(of_joint).collect()
    }

    /// K of a joint whose bone points along `bone` in its own frame.
    fn constant(&self, calibrated: &CalibratedTracks, extra: &SourceExtra, bone: Option<DVec3>) -> DQuat {
        let sign = f64::from(extra.joint.side().sign());
        let (along, across) = match extra.joint.part() {
            ExtraPart::Finger { finger: 0, .. } => (sign * DVec3::Y, DVec3::Z),
            ExtraPart::Finger { .. } => (sign * DVec3::Y, DVec3::X),
            ExtraPart::Toe { .. } => (DVec3::X, DVec3::Z),
            ExtraPart::Twist { .. } => return self.as_base(calibrated, extra),
        };
        let Some(bone) = bone else { return self.as_base(calibrated, extra) };
        let parent = self.parent_of(extra.joint);
        let in_source = |frame| {
            let turn = calibrated.tracks.clip.orientation(frame, extra.source);
            let axes = match parent {
                Some(parent) => parent.aimed(calibrated, frame, along, turn * bone),
                None => self.base(calibrated, extra.joint, frame),
            };
            turn.inverse() * (axes * across)
        };
        let across_in_source = sampled_frames(calibrated.tracks.frame_count()).into_iter().map(in_source).sum();
        let (source, rest) = (basis(bone, across_in_source), basis(along, across));
        DQuat::from_mat3(&(source * rest.transpose()))
    }

    /// The extra joint that an extra joint hangs from.
    fn parent_of(&self, joint: ExtraJoint) -> Option<&ExtraTrack> {
        match joint.parent() {
            ExtraParent::Role(_) => None,
            ExtraParent::Extra(parent) => self.joints.iter().find(|other| other.extra.joint == parent),
        }
    }

    /// K of a joint that is turned as its hand or limb in the mean.
    fn as_base(&self, calibrated: &CalibratedTracks, extra: &SourceExtra) -> DQuat {
        let in_source = |frame| {
            let turn = calibrated.tracks.clip.orientation(frame, extra.source);
            (1.0, turn.inverse() * self.base(calibrated, extra.joint, frame))
        };
        mean_rotation(sampled_frames(calibrated.tracks.frame_count()).into_iter().map(in_source))
    }

    /// Orientation of the role that a joint hangs from, over other extra joints.
    fn base(&self, calibrated: &CalibratedTracks, joint: ExtraJoint, frame: usize) -> DQuat {
        calibrated.orientation(joint.role(), frame)
    }

    fn parent_turn(&self, calibrated: &CalibratedTracks, track: &ExtraTrack, frame: usize) -> DQuat {
        match track.parent {
            Some(parent) => self.joints[parent].turn(calibrated, frame),
            None => self.base(calibrated, track.extra.joint, frame),
        }
    }
}

impl ExtraTrack {
    /// Orientation of the joint, R(t) = G(t)·K.
    fn turn(&self, calibrated: &CalibratedTracks, frame: usize) -> DQuat {
        (calibrated.tracks.clip.orientation(frame, self.extra.source) * self.constant).normalize()
    }

    /// Orientation of the joint, turned by the shortest arc so that its bone, `along` at rest, points along another one.
    fn aimed(&self, calibrated: &CalibratedTracks, frame: usize, along: DVec3, bone: DVec3) -> DQuat {
        let turn = self.turn(calibrated, frame);
        DQuat::from_rotation_arc(turn * along, bone.normalize()) * turn
    }
}

/// Direction of a joint's bone in the frame of its source joint; `None` where it has none.
fn bone(calibrated: &CalibratedTracks, extra: &SourceExtra) -> Option<DVec3> {
    let clip = calibrated.tracks.clip;
    let end = extra.end?;
    let in_source = |frame| {
        let bone_m = clip.position(frame, end) - clip.position(frame, extra.source);
        clip.orientation(frame, extra.source).inverse() * bone_m
    };
    let bone_m = mean(sampled_frames(clip.frame_count()).into_iter().map(in_source))?;
    (bone_m.length() > SHORTEST_BONE_M).then(|| bone_m.normalize())
}

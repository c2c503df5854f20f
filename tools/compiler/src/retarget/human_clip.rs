//! A clip on the canonical humanoid, with the performer's own proportions, still moving through the world.
//!
//! Metres, z up, right-handed, f64. A body's frame: x forward, y left. Pairs of sides are `[left, right]`.

use std::ops::Range;

use glam::{DQuat, DVec2, DVec3};
use motiondb::body::{JOINT_COUNT, Joint};
use motiondb::diagnostic::Unfit;
use motiondb::motion::{ActionKind, SourceRecord};
use serde::{Deserialize, Serialize};
use sha2::{Digest as _, Sha256};

use crate::extra_joints::clip_extra::ClipExtra;
use crate::retarget::posture::LowPart;
use crate::rig::rig_head::RigHead;

/// A clip after import.
#[derive(Clone, Debug, Serialize, Deserialize)]
pub struct HumanClip {
    /// Name of the example: the file's stem; of one clip of several, with the clip's name appended.
    pub name: String,
    /// Record of the source, with its whole-clip parameters and diagnostics.
    pub source: SourceRecord,
    /// Number of the file's frames before the first frame of this clip.
    pub first_frame: usize,
    /// Frame rate, Hz, as the file or the manifest states it.
    pub frame_rate_hz: f64,
    /// Bones of the performer.
    pub body: HumanBody,
    /// Joints beside the 22 roles, in order.
    pub extra: Vec<ClipExtra>,
    /// One pose for each frame; none where `stored` stands for them.
    #[serde(skip)]
    pub frames: Vec<HumanPose>,
    /// Velocity (forward, left) of the body over the ground on which its stance feet stand still, m/s, of a clip in
    /// place; none of a clip that travels.
    pub in_place_mps: Option<DVec2>,
    /// Parts in which the body is not upright, in order of time.
    pub low_parts: Vec<LowPart>,
    /// Parts in which the body stands with its arms spread, as in a bind pose, in order of time.
    pub spread_parts: Vec<Range<usize>>,
    /// Frames in which the pose jumps, in order of time.
    pub jumps: Vec<Range<usize>>,
    /// Whether the body moves along its length, as in a crawl if the rest pose shows which axis is up.
    pub seems_to_crawl: bool,
    /// Why the clip gives no example, where import finds a reason.
    pub unfit: Option<Unfit>,
    /// The rig, and the offset of its head as the clip alone shows it; none of a clip that is made.
    pub rig_head: Option<RigHead>,
    /// What a manifest states about the clip's part in the set.
    pub choices: Choices,
    /// The style, such as `elderly`; empty where none is stated or found.
    pub style: String,
    /// What a cache knows of the frames.
    pub stored: Option<StoredFrames>,
}

/// SHA-256.
pub(crate) type Digest = [u8; 32];

/// What a cache knows of the frames of a clip.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct StoredFrames {
    /// Key of the clip: of its file, the settings and the program.
    pub(crate) key: Digest,
    /// Number of frames.
    pub(crate) count: usize,
    /// Digest of the frame rate and of all poses.
    pub(crate) digest: Digest,
}

/// What a manifest states about a clip's part in the set.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, PartialOrd, Ord, Serialize, Deserialize)]
pub struct Choices {
    /// Whether the example is mirrored; where `None`, when its mirror image adds to the set.
    pub mirror: Option<bool>,
    /// Whether the clip's example is the base walk, m_sp.
    pub is_semi_procedural: bool,
    /// The example that is m_sp, by the tenth of a second of the file at which it begins; the first one where `None`.
    pub semi_procedural_tenth: Option<u32>,
    /// Whether all examples have this clip's body.
    pub is_target_skeleton: bool,
    /// Whether the manifest states the name.
    pub is_name_stated: bool,
    /// Whether the manifest selects the frames.
    pub is_cut: bool,
    /// Whether parts in which the body is not upright give examples, too.
    pub takes_any_posture: bool,
    /// Whether the manifest states the up axis.
    pub is_up_stated: bool,
    /// Whether the manifest states the frame rate.
    pub is_frame_rate_stated: bool,
    /// The kind of transition that the clip shows; it then gives no example.
    pub transition: Option<ActionKind>,
}

/// Bones of one performer in the canonical rest pose (see [`motiondb::body::Skeleton`]), m.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct HumanBody {
    /// Offset of each joint from its parent; zero for the first joint.
    pub offsets_m: [DVec3; JOINT_COUNT],
    /// Far end of each joint's segment relative to the joint: crown, fingertips, toe tips; for other joints their
    /// child.
    pub segment_ends_m: [DVec3; JOINT_COUNT],
    /// `[left, right]`: heel and ball (relative to the foot joint) and toe tip (relative to the toe joint) on the sole.
    pub soles_m: [[DVec3; 3]; 2],
    /// Points at which slide is measured, in the same frames: the soles, or the joints over them (see
    /// [`motiondb::body::Foot`]).
    pub measured_m: [[DVec3; 3]; 2],
    /// `[left, right]`: whether the source shows the end of the toe; else the toe tip is estimated.
    pub shows_toe_ends: [bool; 2],
}

/// Pose of one frame.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct HumanPose {
    /// World position of the pelvis joint (the midpoint of the hips), m.
    pub pelvis_m: DVec3,
    /// Rotation of each joint in its parent's frame; of the pelvis in the world.
    pub rotations: [DQuat; JOINT_COUNT],
    /// Rotation of each of the clip's extra joints in its parent's frame; of a mirrored pose, of each mirrored joint.
    pub extra: Box<[DQuat]>,
}

/// World positions and orientations of all joints in one frame.
#[derive(Clone, Debug, PartialEq)]
pub struct HumanJoints {
    /// Positions, m.
    pub positions_m: [DVec3; JOINT_COUNT],
    /// Rotations from the rest pose.
    pub orientations: [DQuat; JOINT_COUNT],
}

impl HumanClip {
    /// Parts that give no examples: those in which the body is not upright, unless a manifest takes them.
    pub fn left_out_parts(&self) -> &[LowPart] {
        if self.choices.takes_any_posture { &[] } else { &self.low_parts }
    }

    /// Frames of which no example and no transition is made: those of the parts that are left out, of bind poses, and
    /// jumps.
    pub(crate) fn left_out_frames(&self) -> Vec<Range<usize>> {
        let low = self.left_out_parts().iter().map(|part| &part.frames);
        low.chain(&self.spread_parts).chain(&self.jumps).cloned().collect()
    }

    /// Whether the body is upright from one second of the file to another.
    pub(crate) fn is_upright_in(&self, window_s: [f64; 2]) -> bool {
        let [first, last] = window_s.map(|time_s| time_s * self.frame_rate_hz - self.first_frame as f64);
        !self.low_parts.iter().any(|part| first < part.frames.end as f64 && part.frames.start as f64 <= last)
    }

    /// Number of frames, also where a cache stands for them.
    pub(crate) fn frame_count(&self) -> usize {
        self.stored.as_ref().map_or(self.frames.len(), |stored| stored.count)
    }

    /// What orders clips by their content, which names and folders do not change.
    pub(crate) fn content_order(&self) -> impl Ord + use<> {
        let digest = self.stored.as_ref().map_or_else(|| self.digest(), |stored| stored.digest);
        (self.frame_count(), self.first_frame, self.choices, digest)
    }

    /// Digest of the frame rate and of all poses.
    pub(crate) fn digest(&self) -> Digest {
        let mut hasher = Sha256::new();
        self.values().for_each(|bits| hasher.update(bits.to_le_bytes()));
        hasher.finalize().into()
    }

    /// Bits of the frame rate and of all poses.
    fn values(&self) -> impl Iterator<Item = u64> {
        std::iter::once(self.frame_rate_hz).chain(self.frames.iter().flat_map(HumanPose::values)).map(f64::to_bits)
    }
}

impl HumanBody {
    /// Thigh plus shank, mean of both sides, m.
    pub fn leg_length_m(&self) -> f64 {
        let leg_m = |side: usize| {
            self.offsets_m[Joint::SHANKS[side].index()].length() + self.offsets_m[Joint::FEET[side].index()].length()
        };
        0.5 * (leg_m(0) + leg_m(1))
    }

    /// The body of the same proportions, `scale` times as large.
    pub fn scaled(&self, scale: f64) -> Self {
        let points = |feet: [[DVec3; 3]; 2]| feet.map(|foot| foot.map(|point| point * scale));
        Self {
            offsets_m: self.offsets_m.map(|offset| offset * scale),
            segment_ends_m: self.segment_ends_m.map(|end| end * scale),
            soles_m: points(self.soles_m),
            measured_m: points(self.measured_m),
            shows_toe_ends: self.shows_toe_ends,
        }
    }
}

impl HumanPose {
    /// The pose of a body that is `scale` times as large.
    pub fn scaled(&self, scale: f64) -> Self {
        Self { pelvis_m: self.pelvis_m * scale, ..self.clone() }
    }

    /// Position of the pelvis, then all rotations.
    fn values(&self) -> impl Iterator<Item = f64> {
        let turns = self.rotations.iter().chain(&self.extra).flat_map(|turn| turn.to_array());
        self.pelvis_m.to_array().into_iter().chain(turns)
    }

    /// World positions and orientations of all joints.
    pub fn forward_kinematics(&self, body: &HumanBody) -> HumanJoints {
        let mut joints = HumanJoints { positions_m: [self.pelvis_m; JOINT_COUNT], orientations: self.rotations };
        for joint in &Joint::ALL[1..] {
            let index = joint.index();
            let Some(parent) = joint.parent().map(Joint::index) else { continue };
            joints.positions_m[index] =
                joints.positions_m[parent] + joints.orientations[parent] * body.offsets_m[index];
            joints.orientations[index] = joints.orientations[parent] * self.rotations[index];
        }
        joints
    }
}

impl HumanJoints {
    /// Position of a joint, m.
    pub(crate) fn position_m(&self, joint: Joint) -> DVec3 {
        self.positions_m[joint.index()]
    }

    /// World positions of heel, ball and toe tip on the sole of one foot, m.
    pub fn sole_points_m(&self, body: &HumanBody, side: usize) -> [DVec3; 3] {
        self.foot_points_m(side, body.soles_m[side])
    }

    /// World positions of the points of one foot at which slide is measured, m.
    pub fn measured_points_m(&self, body: &HumanBody, side: usize) -> [DVec3; 3] {
        self.foot_points_m(side, body.measured_m[side])
    }

    /// World positions of the points of one foot that touch and leave the ground, m: the heel on the sole, ball and toe
    /// tip where slide is measured.
    pub fn landing_points_m(&self, body: &HumanBody, side: usize) -> [DVec3; 3] {
        let ([heel, ..], [_, ball, tip]) = (body.soles_m[side], body.measured_m[side]);
        self.foot_points_m(side, [heel, ball, tip])
    }

    fn foot_points_m(&self, side: usize, [heel, ball, tip]: [DVec3; 3]) -> [DVec3; 3] {
        let (foot, toe) = (Joint::FEET[side].index(), Joint::TOES[side].index());
        let on_foot = |offset: DVec3| self.positions_m[foot] + self.orientations[foot] * offset;
        [on_foot(heel), on_foot(ball), self.positions_m[toe] + self.orientations[toe] * tip]
    }

    /// Facing: the mean of the left → right unit vectors of hips and shoulders, turned by 90° and projected on the
    /// ground, rad.
    pub fn facing_rad(&self) -> f64 {
        let across = |pair: [Joint; 2]| {
            (self.positions_m[pair[1].index()] - self.positions_m[pair[0].index()]).normalize_or_zero()
        };
        let right = across(Joint::THIGHS) + across(Joint::UPPER_ARMS);
        libm::atan2(right.x, -right.y)
    }

    /// Mean distance of the joints from those of another pose, m.
    pub fn mean_distance_m(&self, other: &Self) -> f64 {
        let distances = self.positions_m.iter().zip(&other.positions_m).map(|(from, to)| from.distance(*to));
        distances.sum::<f64>() / JOINT_COUNT as f64
    }

    /// Midpoint of the hips, m.
    pub fn hips_m(&self) -> DVec3 {
        0.5 * (self.positions_m[Joint::THIGHS[0].index()] + self.positions_m[Joint::THIGHS[1].index()])
    }

    /// Height of each hip over its ankle, `[left, right]`, m.
    pub(crate) fn hip_heights_m(&self) -> [f64; 2] {
        [0, 1].map(|side| self.position_m(Joint::THIGHS[side]).z - self.position_m(Joint::FEET[side]).z)
    }
}

//! A clip on the canonical humanoid: metres, Z up, the performer's own proportions, still travelling through the world.

use std::cmp::Ordering;

use glam::{DQuat, DVec2, DVec3};
use motiondb::body::{JOINT_COUNT, Joint};
use motiondb::diagnostic::Unfit;
use motiondb::motion::SourceRecord;

/// A clip after import: canonical joints, metres, Z up, right-handed, f64.
#[derive(Clone, Debug)]
pub struct HumanClip {
    /// The name an example made from it gets: the file's stem, with ` clip` appended where a file holds several.
    pub name: String,
    /// What was found in the source, whole-clip parameters included.
    pub source: SourceRecord,
    /// Frames of the file before the first that is kept (a T-pose, what a manifest leaves out).
    pub first_frame: usize,
    /// Frames a second, after any correction.
    pub frame_rate_hz: f64,
    /// The performer's bones.
    pub body: HumanBody,
    /// One pose a frame; a separate first frame (T-pose and jump) is already dropped.
    pub frames: Vec<HumanPose>,
    /// The clip treads on the spot: the ground speed (forward, left, in the body's frame, m/s) at which its stance feet
    /// stand still.
    pub in_place_mps: Option<DVec2>,
    /// Why it gives no example, where import found a reason.
    pub unfit: Option<Unfit>,
    /// What a manifest makes of it.
    pub choices: Choices,
}

/// What a manifest makes of a clip; by default the set decides.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, PartialOrd, Ord)]
pub struct Choices {
    /// Whether its example is mirrored; where none, when that adds to the set.
    pub mirror: Option<bool>,
    /// Its example is m_sp.
    pub is_semi_procedural: bool,
    /// Which of its examples that is: the one that begins at this tenth of a second of the file; the first where none.
    pub semi_procedural_tenth: Option<u32>,
    /// All examples have its body.
    pub is_target_skeleton: bool,
    /// It is the part of its file that the manifest cuts out.
    pub is_cut: bool,
}

/// Bones of one performer in the canonical rest pose (see [`motiondb::body::Skeleton`]), metres.
#[derive(Clone, Debug, PartialEq)]
pub struct HumanBody {
    /// Joint relative to its parent; entry 0 is zero.
    pub offsets_m: [DVec3; JOINT_COUNT],
    /// Far ends of the leaf joints' segments (crown, fingertips, toe tips) and of the others (their child), relative to
    /// the joint.
    pub segment_ends_m: [DVec3; JOINT_COUNT],
    /// `[left, right]`: heel, ball (relative to the foot joint) and toe tip (relative to the toe joint) on the sole.
    pub soles_m: [[DVec3; 3]; 2],
    /// Where slide is measured, in the same frames: the soles themselves or the joints over them (see
    /// [`motiondb::body::Foot`]).
    pub measured_m: [[DVec3; 3]; 2],
}

/// One frame.
#[derive(Clone, Debug, PartialEq)]
pub struct HumanPose {
    /// The pelvis joint (midpoint of the hips) in the world.
    pub pelvis_m: DVec3,
    /// Local rotations; the pelvis's against the world.
    pub rotations: [DQuat; JOINT_COUNT],
}

/// Every joint in the world.
#[derive(Clone, Debug, PartialEq)]
pub struct HumanJoints {
    /// Metres.
    pub positions_m: [DVec3; JOINT_COUNT],
    /// Against the rest pose.
    pub orientations: [DQuat; JOINT_COUNT],
}

impl HumanClip {
    /// An order of clips that no name and no folder changes.
    pub fn by_content(&self, other: &Self) -> Ordering {
        let heads = [self, other].map(|clip| (clip.frames.len(), clip.first_frame, clip.choices));
        heads[0].cmp(&heads[1]).then_with(|| self.values().cmp(other.values()))
    }

    /// All that its frames hold, bit by bit.
    fn values(&self) -> impl Iterator<Item = u64> {
        let of_pose = |pose: &HumanPose| {
            let turns = pose.rotations.map(|turn| turn.to_array());
            pose.pelvis_m.to_array().into_iter().chain(turns.into_iter().flatten())
        };
        std::iter::once(self.frame_rate_hz).chain(self.frames.iter().flat_map(of_pose)).map(f64::to_bits)
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

    /// The same proportions in another size.
    pub fn scaled(&self, scale: f64) -> Self {
        let points = |feet: [[DVec3; 3]; 2]| feet.map(|foot| foot.map(|point| point * scale));
        Self {
            offsets_m: self.offsets_m.map(|offset| offset * scale),
            segment_ends_m: self.segment_ends_m.map(|end| end * scale),
            soles_m: points(self.soles_m),
            measured_m: points(self.measured_m),
        }
    }
}

impl HumanPose {
    /// The same pose of a body in another size.
    pub fn scaled(&self, scale: f64) -> Self {
        Self { pelvis_m: self.pelvis_m * scale, rotations: self.rotations }
    }

    /// Every joint in the frame of the pelvis's position.
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
    /// Heel, ball and toe tip on the sole of one foot.
    pub fn sole_points_m(&self, body: &HumanBody, side: usize) -> [DVec3; 3] {
        self.foot_points_m(side, body.soles_m[side])
    }

    /// The points of one foot at which its slide is measured.
    pub fn measured_points_m(&self, body: &HumanBody, side: usize) -> [DVec3; 3] {
        self.foot_points_m(side, body.measured_m[side])
    }

    /// The points of one foot that touch and leave the ground: the heel on the sole, ball and toe tip where slide is
    /// measured.
    pub fn landing_points_m(&self, body: &HumanBody, side: usize) -> [DVec3; 3] {
        let ([heel, ..], [_, ball, tip]) = (body.soles_m[side], body.measured_m[side]);
        self.foot_points_m(side, [heel, ball, tip])
    }

    fn foot_points_m(&self, side: usize, [heel, ball, tip]: [DVec3; 3]) -> [DVec3; 3] {
        let (foot, toe) = (Joint::FEET[side].index(), Joint::TOES[side].index());
        let on_foot = |offset: DVec3| self.positions_m[foot] + self.orientations[foot] * offset;
        [on_foot(heel), on_foot(ball), self.positions_m[toe] + self.orientations[toe] * tip]
    }

    /// The facing of the definitions: mean of the left→right unit vectors of hip pair and shoulder pair, turned 90°, on
    /// the ground; radians.
    pub fn facing_rad(&self) -> f64 {
        let across = |pair: [Joint; 2]| {
            (self.positions_m[pair[1].index()] - self.positions_m[pair[0].index()]).normalize_or_zero()
        };
        let right = across(Joint::THIGHS) + across(Joint::UPPER_ARMS);
        libm::atan2(right.x, -right.y)
    }

    /// How far the joints have gone to another pose, in the mean, metres.
    pub fn mean_distance_m(&self, other: &Self) -> f64 {
        let distances = self.positions_m.iter().zip(&other.positions_m).map(|(from, to)| from.distance(*to));
        distances.sum::<f64>() / JOINT_COUNT as f64
    }

    /// Midpoint of the hips.
    pub fn hips_m(&self) -> DVec3 {
        0.5 * (self.positions_m[Joint::THIGHS[0].index()] + self.positions_m[Joint::THIGHS[1].index()])
    }
}

//! Roles of source joints in the canonical humanoid.

use motiondb::body::{ExtraJoint, JOINT_COUNT, Joint};

use crate::read::source_clip::KeptJoints;

/// Source joint of each role; none where the role is open.
pub type JointMap = [Option<usize>; JOINT_COUNT];

/// Roles of the legs, `[left, right]`, from hip to ankle.
pub(crate) const LEGS: [[Joint; 3]; 2] =
    [[Joint::LeftThigh, Joint::LeftShank, Joint::LeftFoot], [Joint::RightThigh, Joint::RightShank, Joint::RightFoot]];
/// Roles of the arms, `[left, right]`, from shoulder to wrist.
pub(crate) const ARMS: [[Joint; 3]; 2] = [
    [Joint::LeftUpperArm, Joint::LeftForearm, Joint::LeftHand],
    [Joint::RightUpperArm, Joint::RightForearm, Joint::RightHand],
];

/// Source joints by role.
#[derive(Clone, Debug, PartialEq)]
pub struct Roles {
    /// The source joint that rotates as the canonical joint does; none where the source has no such joint.
    pub joints: JointMap,
    /// The far end of head, hands and toes; none where the source has no such joint.
    pub ends: JointMap,
    /// `[left, right]`: heel, ball and toe tip on the sole, where the clip has joints named `…Sole`.
    pub soles: [Option<[usize; 3]>; 2],
    /// `[left, right]`: joint of the heel, where the clip has one.
    pub heels: [Option<usize>; 2],
    /// The joints beside the 22 roles, in order; none before they are searched.
    pub extra: Vec<SourceExtra>,
    /// Whether names call left what stands on the right. The file is mirrored; roles are as the body stands.
    pub are_names_mirrored: bool,
}

/// An extra joint of a source.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub struct SourceExtra {
    /// What the joint is.
    pub joint: ExtraJoint,
    /// The source joint.
    pub source: usize,
    /// Joint at the far end of its bone; `None` where the source has none.
    pub end: Option<usize>,
}

impl Roles {
    /// The source joint of a role that every clip has: pelvis, thigh, shank, foot, upper arm, forearm or hand.
    pub fn required(&self, joint: Joint) -> usize {
        self.joints[joint.index()].expect("find_roles assigns this role or rejects the clip")
    }

    /// The source joints that roles name. Only joints that rotate as a canonical joint need an orientation.
    pub(crate) fn source_joints(&self) -> KeptJoints {
        let extra = self.extra.iter().map(|extra| extra.source);
        let mut oriented: Vec<usize> = self.joints.iter().flatten().copied().chain(extra).collect();
        let of_feet = self.soles.iter().flatten().flatten().chain(self.heels.iter().flatten());
        let of_extra = self.extra.iter().filter_map(|extra| extra.end);
        let points = self.ends.iter().flatten().chain(of_feet).copied().chain(of_extra);
        let mut points: Vec<usize> = points.filter(|joint| !oriented.contains(joint)).collect();
        for joints in [&mut oriented, &mut points] {
            joints.sort_unstable();
            joints.dedup();
        }
        KeptJoints { oriented, points }
    }

    /// The same roles in a clip that has only `kept`, which are those of [`Roles::source_joints`].
    pub(crate) fn renumber(&mut self, kept: &KeptJoints) {
        let of_feet = self.soles.iter_mut().flatten().flatten().chain(self.heels.iter_mut().flatten());
        let of_extra = self.extra.iter_mut().flat_map(|extra| [Some(&mut extra.source), extra.end.as_mut()]).flatten();
        for joint in self.joints.iter_mut().chain(&mut self.ends).flatten().chain(of_feet).chain(of_extra) {
            *joint = kept.iter().take_while(|kept| kept != joint).count();
        }
    }

    /// Exchanges left and right.
    pub(crate) fn exchange_sides(&mut self) {
        let mirrored = |found: &JointMap| Joint::ALL.map(|joint| found[joint.mirrored().index()]);
        (self.joints, self.ends) = (mirrored(&self.joints), mirrored(&self.ends));
        self.soles.swap(0, 1);
        self.heels.swap(0, 1);
        self.extra.iter_mut().for_each(|extra| extra.joint = extra.joint.mirrored());
        self.extra.sort();
    }
}

//! The extra joints of a skeleton: fingers below the hands, toes below the feet, twist bones of the limbs, by their names.
//!
//! Enters: a clip with the roles of its joints. Leaves: the source joint of each [`ExtraJoint`] that it has, at most
//! [`EXTRA_JOINTS_MAX`], and the number of moving joints that are not kept. The side is that of the limb, whatever the
//! name says.

use motiondb::body::extra_joint::FINGER_JOINTS;
use motiondb::body::{EXTRA_JOINTS_MAX, ExtraJoint, ExtraPart, Joint, Side};

use crate::extra_joints::extra_names::{Digit, finger, is_twist, last_number, toe};
use crate::read::source_clip::SourceClip;
use crate::rig::joint_names::{BodyPart, hints};
use crate::rig::roles::{ARMS, LEGS, Roles, SourceExtra};

/// Number of fingers of a hand and of toes of a foot.
const DIGITS: usize = 5;
/// Cosine of half the angle by which a joint that moves turns against its parent: 2°.
const MOVING_COSINE: f64 = 0.99985;

/// The extra joints of a source.
#[derive(Clone, Debug, Default, PartialEq)]
pub(crate) struct ExtraJoints {
    /// The joints that are kept, in order.
    pub(crate) kept: Vec<SourceExtra>,
    /// Number of joints below hands and feet, and of twist bones, that turn and are not kept.
    pub(crate) left_out: usize,
}

/// The extra joints of a clip of all its joints.
pub(crate) fn extra_joints(clip: &SourceClip, roles: &Roles) -> ExtraJoints {
    let search = ExtraSearch::new(clip, roles);
    let mut kept = Vec::new();
    for side in Side::BOTH {
        kept.extend(search.fingers(side));
        kept.extend(search.toes(side));
        kept.extend(search.twists(side));
    }
    kept.sort();
    kept.truncate(EXTRA_JOINTS_MAX);
    let is_kept = |joint: usize| kept.iter().any(|extra| extra.source == joint);
    let left_out = (0..clip.joints.len()).filter(|&joint| search.may_be_extra(joint) && !is_kept(joint));
    let left_out = left_out.filter(|&joint| search.turns(joint)).count();
    ExtraJoints { kept, left_out }
}

/// A skeleton in which extra joints are searched.
struct ExtraSearch<'a> {
    clip: &'a SourceClip,
    roles: &'a Roles,
    /// The role that each joint has or hangs from.
    role_above: Vec<Option<Joint>>,
}

impl<'a> ExtraSearch<'a> {
    fn new(clip: &'a SourceClip, roles: &'a Roles) -> Self {
        let mut role_of = vec![None; clip.joints.len()];
        // Of two roles of one joint the one nearer to the pelvis, as its bone is the joint's.
        for joint in Joint::ALL.into_iter().rev() {
            roles.joints[joint.index()].into_iter().for_each(|source| role_of[source] = Some(joint));
        }
        let mut role_above: Vec<Option<Joint>> = Vec::with_capacity(clip.joints.len());
        for (index, joint) in clip.joints.iter().enumerate() {
            let above = joint.parent.and_then(|parent| role_above[parent]);
            role_above.push(role_of[index].or(above));
        }
        Self { clip, roles, role_above }
    }

    /// Whether a joint hangs from one of some roles, and has no role itself.
    fn hangs_from(&self, joint: usize, roles: &[Joint]) -> bool {
        let is_free = !self.roles.joints.contains(&Some(joint)) && !self.clip.joints[joint].is_end;
        is_free && self.role_above[joint].is_some_and(|above| roles.contains(&above))
    }

    fn name(&self, joint: usize) -> &str {
        &self.clip.joints[joint].name
    }

    /// Whether a joint is below a hand or a foot, or a twist bone.
    fn may_be_extra(&self, joint: usize) -> bool {
        use Joint as J;
        let ends = [J::LeftHand, J::RightHand, J::LeftFoot, J::RightFoot, J::LeftToe, J::RightToe];
        let is_helper = || hints(self.name(joint)).parts == [BodyPart::Helper];
        (self.hangs_from(joint, &ends) && !is_helper()) || (is_twist(self.name(joint)) && self.limb(joint).is_some())
    }

    /// Whether a joint turns against its parent.
    fn turns(&self, joint: usize) -> bool {
        let Some(parent) = self.clip.joints[joint].parent else { return false };
        let local = |frame| self.clip.orientation(frame, parent).inverse() * self.clip.orientation(frame, joint);
        (1..self.clip.frame_count()).any(|frame| local(frame).dot(local(0)).abs() < MOVING_COSINE)
    }

    /// The joints of the fingers of a hand; none of a hand with fewer than two fingers beside the thumb, whose palm is not
    /// known: the one finger of CMU's skeletons stays straight. A finger without a bone has no direction, and is none.
    fn fingers(&self, side: Side) -> Vec<SourceExtra> {
        // Bones of the palm may hang from the forearm, one of them in the role of the hand.
        let [_, forearm, hand] = ARMS[side.index()];
        let mut of_digits: [Vec<usize>; DIGITS] = Default::default();
        for (joint, digit) in self.digits(&[hand, forearm], finger) {
            of_digits[digit].push(joint);
        }
        let mut found: Vec<SourceExtra> = Vec::new();
        for (digit, joints) in of_digits.iter().enumerate() {
            let chain = self.chain(joints, digit == 0);
            if chain.len() == 1 && !self.has_bone(chain[0]) {
                continue;
            }
            let kept = chain.iter().take(FINGER_JOINTS).enumerate();
            found.extend(kept.map(|(number, &source)| {
                let end = chain.get(number + 1).copied().or_else(|| self.first_child(source));
                SourceExtra { joint: ExtraJoint::finger(side, digit, number), source, end }
            }));
        }
        let is_knuckle =
            |extra: &&SourceExtra| matches!(extra.joint.part(), ExtraPart::Finger { finger: 1.., joint: 0 });
        if found.iter().filter(is_knuckle).count() < 2 { Vec::new() } else { found }
    }

    /// Whether a joint's bone to its first child has a length.
    fn has_bone(&self, joint: usize) -> bool {
        self.first_child(joint).is_some_and(|end| self.clip.position(0, end) != self.clip.position(0, joint))
    }

    /// The toes of a foot; none of a foot of which only one is named.
    fn toes(&self, side: Side) -> Vec<SourceExtra> {
        let foot = [LEGS[side.index()][2], Joint::TOES[side.index()]];
        let mut found: Vec<SourceExtra> = Vec::new();
        for (source, digit) in self.digits(&foot, toe) {
            let joint = ExtraJoint::toe(side, digit);
            if found.iter().all(|extra| extra.joint != joint) {
                found.push(SourceExtra { joint, source, end: self.first_child(source) });
            }
        }
        if found.len() < 2 { Vec::new() } else { found }
    }

    /// The twist bones of the limbs of one side, the first of each limb.
    fn twists(&self, side: Side) -> Vec<SourceExtra> {
        let mut found: Vec<SourceExtra> = Vec::new();
        for source in (0..self.clip.joints.len()).filter(|&joint| is_twist(self.name(joint))) {
            let Some(joint) = self.limb(source).and_then(ExtraJoint::twist) else { continue };
            if joint.side() == side && found.iter().all(|extra| extra.joint != joint) {
                found.push(SourceExtra { joint, source, end: None });
            }
        }
        found
    }

    /// The limb that a joint without role hangs from.
    fn limb(&self, joint: usize) -> Option<Joint> {
        let limb = self.role_above[joint].filter(|limb| ExtraJoint::twist(*limb).is_some())?;
        self.hangs_from(joint, &[limb]).then_some(limb)
    }

    /// The joints below some roles that belong to fingers or toes, each with its finger or toe.
    fn digits(&self, roles: &[Joint], of_name: fn(&str) -> Option<Digit>) -> Vec<(usize, usize)> {
        let mut stated: Vec<Option<Digit>> = vec![None; self.clip.joints.len()];
        for joint in (0..stated.len()).filter(|&joint| self.hangs_from(joint, roles)) {
            let above = self.ancestors(joint).find_map(|above| stated[above]);
            stated[joint] = match (of_name(self.name(joint)), above) {
                // Numbers of joints that follow one another count joints, not fingers.
                (Some(Digit::Numbered(_)), Some(above)) => Some(above),
                (own, _) => own,
            };
        }
        let found: Vec<(usize, Digit)> =
            stated.into_iter().enumerate().filter_map(|(joint, digit)| Some((joint, digit?))).collect();
        let has_number = |number: usize| found.iter().any(|(_, digit)| *digit == Digit::Numbered(number));
        let has_thumb = found.iter().any(|(_, digit)| *digit == Digit::Named(0));
        let counts_from_one = !has_number(0) && (!has_thumb || has_number(DIGITS));
        let digit = |digit: Digit| match digit {
            Digit::Named(digit) => Some(digit),
            Digit::Numbered(number) => number.checked_sub(usize::from(counts_from_one)),
        };
        let known = found.iter().filter_map(|&(joint, stated)| Some((joint, digit(stated)?)));
        known.filter(|(_, digit)| *digit < DIGITS).collect()
    }

    /// The joints of one finger from the palm outwards; without a bone of the palm that is named as the finger.
    fn chain(&self, joints: &[usize], is_thumb: bool) -> Vec<usize> {
        let mut chain: Vec<usize> = Vec::new();
        for &joint in joints {
            if chain.last().is_none_or(|&last| self.is_above(last, joint)) {
                chain.push(joint);
            }
        }
        let number = |at: usize| chain.get(at).and_then(|&joint| last_number(self.name(joint)));
        let is_repeated = number(0).is_some() && number(0) == number(1);
        let is_metacarpal = !is_thumb && number(0) == Some(0) && chain.len() > FINGER_JOINTS;
        if is_repeated || is_metacarpal {
            chain.remove(0);
        }
        chain
    }

    fn is_above(&self, above: usize, joint: usize) -> bool {
        self.ancestors(joint).take_while(|&at| at >= above).any(|at| at == above)
    }

    /// The joints above a joint, the nearest first.
    fn ancestors(&self, joint: usize) -> impl Iterator<Item = usize> + '_ {
        std::iter::successors(self.clip.joints[joint].parent, |&at| self.clip.joints[at].parent)
    }

    fn first_child(&self, joint: usize) -> Option<usize> {
        self.clip.joints.iter().position(|child| child.parent == Some(joint))
    }
}

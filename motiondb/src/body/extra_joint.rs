//! Extra joints: those that a body may have beside the 22 roles. Planning and inverse kinematics do not use them; poses
//! carry them along.
//!
//! They are fingers, twist bones and toes, each by a name of its own. A set keeps those that its clips have, at most
//! [`EXTRA_JOINTS_MAX`].
//!
//! Rest pose, as that of the roles ([`Skeleton`](crate::body::Skeleton)): fingers and thumbs point straight along the hand, palms
//! down, so that a finger curls about x; toes point forward; a twist bone is turned as its limb. Finger joints are
//! relative to the palm, that is to the hand.

use serde::{Deserialize, Serialize};

use crate::body::skeleton::{JOINT_COUNT, Joint, Side};

/// Greatest number of extra joints of a set: 60 joints with the 22 roles.
pub const EXTRA_JOINTS_MAX: usize = 60 - JOINT_COUNT;

/// Number of joints of a finger.
pub const FINGER_JOINTS: usize = 3;
/// Name of each finger.
const FINGERS: [&str; 5] = ["thumb", "index", "middle", "ring", "little"];
/// Number of finger joints of a hand.
const FINGERS_OF_HAND: usize = FINGERS.len() * FINGER_JOINTS;
/// Limbs of the left side that have a twist bone; those of the right side are their mirror images.
const TWISTED: [Joint; 4] = [Joint::LeftUpperArm, Joint::LeftForearm, Joint::LeftThigh, Joint::LeftShank];
/// Number of toes of a foot.
const TOES: usize = 5;
/// Number of extra joints of one side.
const PARTS: usize = FINGERS_OF_HAND + TWISTED.len() + TOES;

/// A joint beside the 22 roles. In order, a parent precedes its children, and left precedes right.
///
/// ```
/// use motiondb::body::{ExtraJoint, ExtraParent, Joint, Side};
///
/// let knuckle = ExtraJoint::finger(Side::Left, 1, 0);
/// assert_eq!(knuckle.name(), "left_index_1");
/// assert_eq!(knuckle.mirrored().name(), "right_index_1");
/// assert_eq!(knuckle.parent(), ExtraParent::Role(Joint::LeftHand));
/// assert_eq!(ExtraJoint::finger(Side::Left, 1, 1).parent(), ExtraParent::Extra(knuckle));
/// ```
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash, Serialize, Deserialize)]
#[serde(try_from = "u8", into = "u8")]
pub struct ExtraJoint(u8);

/// What an extra joint hangs from.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum ExtraParent {
    /// A joint of the 22 roles.
    Role(Joint),
    /// Another extra joint.
    Extra(ExtraJoint),
}

/// What an extra joint is.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum ExtraPart {
    /// A joint of a finger.
    Finger {
        /// 0 for the thumb, 4 for the little finger.
        finger: usize,
        /// 0 next to the palm, 2 next to the tip.
        joint: usize,
    },
    /// A bone that shares the twist of a limb.
    Twist {
        /// The joint of the limb.
        limb: Joint,
    },
    /// A toe.
    Toe {
        /// 0 for the great toe, 4 for the little one.
        toe: usize,
    },
}

impl ExtraJoint {
    /// Number of extra joints that have names.
    pub const COUNT: usize = 2 * PARTS;

    /// Every extra joint, in order.
    pub fn all() -> impl Iterator<Item = Self> {
        (0..Self::COUNT as u8).map(Self)
    }

    /// A joint of a finger: fingers from 0 (thumb) to 4 (little finger), joints from 0 (next to the palm) to 2.
    ///
    /// # Panics
    /// If there is no such joint.
    pub fn finger(side: Side, finger: usize, joint: usize) -> Self {
        assert!(finger < FINGERS.len() && joint < FINGER_JOINTS, "finger {finger} has no joint {joint}");
        Self::of_part(side, FINGER_JOINTS * finger + joint)
    }

    /// The twist bone of a limb; `None` for a joint that is no upper arm, forearm, thigh or shank.
    pub fn twist(limb: Joint) -> Option<Self> {
        let of = |side: Side, joint: Joint| {
            let found = TWISTED.iter().position(|twisted| *twisted == joint)?;
            Some(Self::of_part(side, FINGERS_OF_HAND + found))
        };
        of(Side::Left, limb).or_else(|| of(Side::Right, limb.mirrored()))
    }

    /// A toe, from 0 (great toe) to 4 (little toe).
    ///
    /// # Panics
    /// If there is no such toe.
    pub fn toe(side: Side, toe: usize) -> Self {
        assert!(toe < TOES, "there is no toe {toe}");
        Self::of_part(side, FINGERS_OF_HAND + TWISTED.len() + toe)
    }

    fn of_part(side: Side, part: usize) -> Self {
        Self((2 * part + side.index()) as u8)
    }

    /// What the joint is.
    pub fn part(self) -> ExtraPart {
        let part = usize::from(self.0 / 2);
        match part.checked_sub(FINGERS_OF_HAND) {
            None => ExtraPart::Finger { finger: part / FINGER_JOINTS, joint: part % FINGER_JOINTS },
            Some(part) => match (part.checked_sub(TWISTED.len()), self.side()) {
                (Some(toe), _) => ExtraPart::Toe { toe },
                (None, Side::Left) => ExtraPart::Twist { limb: TWISTED[part] },
                (None, Side::Right) => ExtraPart::Twist { limb: TWISTED[part].mirrored() },
            },
        }
    }

    /// Position among all extra joints.
    pub const fn index(self) -> usize {
        self.0 as usize
    }

    /// The side of the body.
    pub const fn side(self) -> Side {
        if self.0.is_multiple_of(2) { Side::Left } else { Side::Right }
    }

    /// The same joint of the other side.
    #[must_use]
    pub const fn mirrored(self) -> Self {
        Self(self.0 ^ 1)
    }

    /// What the joint hangs from.
    pub fn parent(self) -> ExtraParent {
        let side = self.side().index();
        match self.part() {
            ExtraPart::Finger { joint: 0, .. } => ExtraParent::Role([Joint::LeftHand, Joint::RightHand][side]),
            ExtraPart::Finger { finger, joint } => ExtraParent::Extra(Self::finger(self.side(), finger, joint - 1)),
            ExtraPart::Twist { limb } => ExtraParent::Role(limb),
            ExtraPart::Toe { .. } => ExtraParent::Role(Joint::TOES[side]),
        }
    }

    /// The role that the joint hangs from, over other extra joints.
    pub fn role(self) -> Joint {
        match self.parent() {
            ExtraParent::Role(role) => role,
            ExtraParent::Extra(parent) => parent.role(),
        }
    }

    /// The joint of a name.
    pub fn named(name: &str) -> Option<Self> {
        Self::all().find(|joint| joint.name() == name)
    }

    /// The joint's name in files and reports: `left_index_1`, `right_forearm_twist`, `left_toe_1`. Numbers count from the
    /// palm, and from the great toe.
    pub fn name(self) -> String {
        let side = ["left", "right"][self.side().index()];
        match self.part() {
            ExtraPart::Finger { finger, joint } => format!("{side}_{}_{}", FINGERS[finger], joint + 1),
            ExtraPart::Twist { limb } => format!("{}_twist", limb.name()),
            ExtraPart::Toe { toe } => format!("{side}_toe_{}", toe + 1),
        }
    }
}

impl TryFrom<u8> for ExtraJoint {
    type Error = String;

    fn try_from(index: u8) -> Result<Self, String> {
        let exists = usize::from(index) < Self::COUNT;
        if exists { Ok(Self(index)) } else { Err(format!("there is no extra joint {index}")) }
    }
}

impl From<ExtraJoint> for u8 {
    fn from(joint: ExtraJoint) -> Self {
        joint.0
    }
}

#[cfg(test)]
mod tests {
    use std::collections::BTreeSet;

    use super::*;

    #[test]
    fn parents_precede_children_and_names_are_unique() {
        let names: BTreeSet<String> = ExtraJoint::all().map(ExtraJoint::name).collect();
        assert_eq!(names.len(), ExtraJoint::COUNT);
        for joint in ExtraJoint::all() {
            assert_eq!(joint.mirrored().mirrored(), joint);
            assert_eq!(ExtraJoint::named(&joint.name()), Some(joint));
            assert_eq!(joint.mirrored().side(), joint.side().other());
            match (joint.parent(), joint.mirrored().parent()) {
                (ExtraParent::Role(parent), ExtraParent::Role(other)) => assert_eq!(parent.mirrored(), other),
                (ExtraParent::Extra(parent), ExtraParent::Extra(other)) => {
                    assert_eq!(parent.mirrored(), other);
                    assert!(parent < joint);
                }
                unlike => panic!("{}: {unlike:?}", joint.name()),
            }
        }
    }

    #[test]
    fn joints_are_found_by_their_part() {
        for joint in ExtraJoint::all() {
            let found = match joint.part() {
                ExtraPart::Finger { finger, joint: number } => ExtraJoint::finger(joint.side(), finger, number),
                ExtraPart::Twist { limb } => ExtraJoint::twist(limb).unwrap(),
                ExtraPart::Toe { toe } => ExtraJoint::toe(joint.side(), toe),
            };
            assert_eq!(found, joint, "{}", joint.name());
        }
        assert_eq!(ExtraJoint::twist(Joint::Head), None);
        assert!(ExtraJoint::try_from(ExtraJoint::COUNT as u8).is_err());
    }
}

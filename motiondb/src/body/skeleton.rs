//! The canonical humanoid: 22 joints in one fixed order. So a pose is an array, and blending is arithmetic.
//!
//! Rest pose: the body stands at the origin and faces +x; +y is left, +z is up; the arms point straight out along ±y
//! with palms down; the feet are flat on z = 0. The rest orientation of every joint is the identity, so the offset of a
//! joint is its parent's bone in body axes. Metres, radians.

use std::borrow::Cow;

use glam::Vec3;
use serde::{Deserialize, Serialize};

/// Number of joints of the canonical humanoid.
pub const JOINT_COUNT: usize = 22;

/// Greatest coordinate of a bone or of a foot's point, and greatest radius of a segment, m; none of a body comes near.
pub const BONE_MAX_M: f32 = 10.0;
/// Greatest limit of a joint, rad; none of a body comes near.
pub const LIMIT_MAX_RAD: f32 = 10.0;

/// A side of the body; indexes every `[left, right]` pair.
///
/// ```
/// use motiondb::{Joint, Side};
///
/// assert_eq!(Joint::FEET[Side::Left.index()], Joint::LeftFoot);
/// assert_eq!(Side::Left.other().sign(), -1.0);
/// ```
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Serialize, Deserialize)]
#[repr(u8)]
pub enum Side {
    /// The body's left (+y in its own frame).
    Left = 0,
    /// The body's right (−y).
    Right = 1,
}

impl Side {
    /// Left, then right.
    pub const BOTH: [Self; 2] = [Self::Left, Self::Right];

    /// 0 for left, 1 for right.
    pub const fn index(self) -> usize {
        self as usize
    }

    /// The other side.
    pub const fn other(self) -> Self {
        match self {
            Self::Left => Self::Right,
            Self::Right => Self::Left,
        }
    }

    /// +1 for left, −1 for right: the sign of y, of turning, of strafing towards this side.
    pub const fn sign(self) -> f32 {
        match self {
            Self::Left => 1.0,
            Self::Right => -1.0,
        }
    }
}

/// A joint of the canonical humanoid. In storage order, a parent precedes its children.
///
/// ```
/// use motiondb::Joint;
///
/// assert_eq!(Joint::LeftShank.parent(), Some(Joint::LeftThigh));
/// assert_eq!(Joint::LeftShank.mirrored(), Joint::RightShank);
/// assert_eq!(Joint::ALL[Joint::LeftShank.index()].name(), "left_shank");
/// ```
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Serialize, Deserialize)]
#[repr(u8)]
#[expect(missing_docs, reason = "the names are the anatomy")]
pub enum Joint {
    Pelvis,
    SpineLower,
    SpineMiddle,
    SpineUpper,
    Neck,
    Head,
    LeftClavicle,
    LeftUpperArm,
    LeftForearm,
    LeftHand,
    RightClavicle,
    RightUpperArm,
    RightForearm,
    RightHand,
    LeftThigh,
    LeftShank,
    LeftFoot,
    LeftToe,
    RightThigh,
    RightShank,
    RightFoot,
    RightToe,
}

impl Joint {
    /// Every joint, in storage order.
    pub const ALL: [Self; JOINT_COUNT] = [
        Self::Pelvis,
        Self::SpineLower,
        Self::SpineMiddle,
        Self::SpineUpper,
        Self::Neck,
        Self::Head,
        Self::LeftClavicle,
        Self::LeftUpperArm,
        Self::LeftForearm,
        Self::LeftHand,
        Self::RightClavicle,
        Self::RightUpperArm,
        Self::RightForearm,
        Self::RightHand,
        Self::LeftThigh,
        Self::LeftShank,
        Self::LeftFoot,
        Self::LeftToe,
        Self::RightThigh,
        Self::RightShank,
        Self::RightFoot,
        Self::RightToe,
    ];
    /// Hip joints, `[left, right]`.
    pub const THIGHS: [Self; 2] = [Self::LeftThigh, Self::RightThigh];
    /// Knees, `[left, right]`.
    pub const SHANKS: [Self; 2] = [Self::LeftShank, Self::RightShank];
    /// Ankles, `[left, right]`.
    pub const FEET: [Self; 2] = [Self::LeftFoot, Self::RightFoot];
    /// Balls of the feet, `[left, right]`.
    pub const TOES: [Self; 2] = [Self::LeftToe, Self::RightToe];
    /// Shoulders, `[left, right]`.
    pub const UPPER_ARMS: [Self; 2] = [Self::LeftUpperArm, Self::RightUpperArm];

    /// Position in storage order.
    pub const fn index(self) -> usize {
        self as usize
    }

    /// The parent joint; `None` for the pelvis.
    pub const fn parent(self) -> Option<Self> {
        match PARENTS[self as usize] {
            NO_PARENT => None,
            parent => Some(Self::ALL[parent as usize]),
        }
    }

    /// The same joint of the other side. Joints of the trunk and head are their own mirror image.
    pub const fn mirrored(self) -> Self {
        let index = self as usize;
        Self::ALL[match index {
            0..=5 => index,
            6..=9 | 14..=17 => index + 4,
            _ => index - 4,
        }]
    }

    /// The joint's name in files, reports and pictures.
    pub const fn name(self) -> &'static str {
        NAMES[self as usize]
    }
}

/// Entry of [`PARENTS`] for a joint without a parent.
const NO_PARENT: u8 = u8::MAX;
/// Index of each joint's parent; [`NO_PARENT`] for the pelvis.
const PARENTS: [u8; JOINT_COUNT] = [NO_PARENT, 0, 1, 2, 3, 4, 3, 6, 7, 8, 3, 10, 11, 12, 0, 14, 15, 16, 0, 18, 19, 20];
/// Name of each joint, in storage order.
const NAMES: [&str; JOINT_COUNT] = [
    "pelvis",
    "spine_lower",
    "spine_middle",
    "spine_upper",
    "neck",
    "head",
    "left_clavicle",
    "left_upper_arm",
    "left_forearm",
    "left_hand",
    "right_clavicle",
    "right_upper_arm",
    "right_forearm",
    "right_hand",
    "left_thigh",
    "left_shank",
    "left_foot",
    "left_toe",
    "right_thigh",
    "right_shank",
    "right_foot",
    "right_toe",
];

/// Bones, girths, joint limits and soles of one body. Every vector is in the rest pose's body axes, metres.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Skeleton {
    /// Position of each joint relative to its parent joint. The pelvis's is (0, 0, height above the ground at rest).
    pub offsets_m: [Vec3; JOINT_COUNT],
    /// Far end of each joint's segment, relative to the joint: the child's offset, or fingertips, crown and toe tips.
    pub segment_ends_m: [Vec3; JOINT_COUNT],
    /// Radius of the capsule from each joint to its segment's end, metres. Pictures and collision tests use it.
    pub segment_radii_m: [f32; JOINT_COUNT],
    /// Least and greatest rotation of each joint relative to its rest, as rotation vectors (axis × angle), radians.
    pub limits_rad: [[Vec3; 2]; JOINT_COUNT],
    /// Points of the feet, `[left, right]`.
    pub feet: [Foot; 2],
}

/// The three points of a foot that touch the ground, and the three at which its slide is measured.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct Foot {
    /// Heel on the sole, relative to the foot joint (the ankle), metres.
    pub heel_m: Vec3,
    /// Ball on the sole, under the toe joint, relative to the foot joint, metres.
    pub ball_m: Vec3,
    /// Toe tip on the sole, relative to the toe joint, metres.
    pub toe_tip_m: Vec3,
    /// Heel, ball and toe tip where slide is measured, relative to the same joints as above, metres. Clips with `…Sole`
    /// joints: the points above. Other clips: the joints over those points, since the points are estimated.
    pub measured_m: [Vec3; 3],
}

impl Skeleton {
    /// Length of thigh plus shank, mean of both sides, metres.
    pub fn leg_length_m(&self) -> f32 {
        let leg = |side: usize| {
            self.offsets_m[Joint::SHANKS[side].index()].length() + self.offsets_m[Joint::FEET[side].index()].length()
        };
        0.5 * (leg(0) + leg(1))
    }

    /// Height of the crown at rest, metres.
    pub fn height_m(&self) -> f32 {
        let up_to_head = std::iter::successors(Some(Joint::Head), |joint| joint.parent());
        let head_m: f32 = up_to_head.map(|joint| self.offsets_m[joint.index()].z).sum();
        head_m + self.segment_ends_m[Joint::Head.index()].z
    }

    /// The skeleton of a body that is `size` times as large: all lengths grow, angles stay.
    pub fn sized(&self, size: f32) -> Cow<'_, Self> {
        if size == 1.0 {
            return Cow::Borrowed(self);
        }
        let foot = |foot: &Foot| Foot {
            heel_m: size * foot.heel_m,
            ball_m: size * foot.ball_m,
            toe_tip_m: size * foot.toe_tip_m,
            measured_m: foot.measured_m.map(|point_m| size * point_m),
        };
        Cow::Owned(Self {
            offsets_m: self.offsets_m.map(|offset_m| size * offset_m),
            segment_ends_m: self.segment_ends_m.map(|end_m| size * end_m),
            segment_radii_m: self.segment_radii_m.map(|radius_m| size * radius_m),
            limits_rad: self.limits_rad,
            feet: self.feet.each_ref().map(foot),
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn parents_precede_children_and_mirrors_come_in_pairs() {
        for joint in Joint::ALL {
            assert_eq!(joint.mirrored().mirrored(), joint);
            if let Some(parent) = joint.parent() {
                assert!(parent < joint);
                assert_eq!(parent.mirrored(), joint.mirrored().parent().unwrap());
            }
        }
    }
}

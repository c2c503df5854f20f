//! The body: the canonical humanoid, its poses and forward kinematics, and the ranges of its joints.
//!
//! Enters: bones and rotations. Leaves: positions and orientations of joints and soles, root frame or world.
//!
//! Read `skeleton`, then `pose`, then `extra_joint` (fingers, toes, twist bones), then `joint_ranges`, then
//! `two_bone_reach` (inverse kinematics of a leg).

pub mod extra_joint;
pub(crate) mod joint_ranges;
pub(crate) mod pose;
pub(crate) mod skeleton;
pub mod two_bone_reach;

pub use extra_joint::{EXTRA_JOINTS_MAX, ExtraJoint, ExtraParent, ExtraPart};
pub use joint_ranges::JOINT_RANGES_DEG;
pub use pose::{Joints, Pose, Root, RootFrame};
pub use skeleton::{BONE_MAX_M, Foot, JOINT_COUNT, Joint, LIMIT_MAX_RAD, Side, Skeleton};

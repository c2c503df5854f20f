//! The drawn pose: locks planted feet, lowers the pelvis, bends the legs, turns the head.
//!
//! Enters: a sampled pose, the root, foot contacts. Leaves: the pose after inverse kinematics.
//!
//! Read `leg`, `posture` and `ik`, then what moves feet and pelvis: `heel_rise`, `pelvis`, `leg_clearance`,
//! `foot_lock`, all held by `contact_state`. `look_at` turns head and chest, `squeeze` the shoulders in narrow gaps,
//! both as far as `yaw_limit` allows. `lean` tilts the trunk; `weight_shift` moves the pelvis before a first step;
//! `secondary_motion` moves head, forearms and hands.

pub(crate) mod contact_state;
pub(crate) mod foot_lock;
pub(crate) mod heel_rise;
pub(crate) mod ik;
pub(crate) mod lean;
pub(crate) mod leg;
pub(crate) mod leg_clearance;
pub(crate) mod look_at;
pub(crate) mod pelvis;
pub(crate) mod posture;
pub(crate) mod secondary_motion;
pub(crate) mod squeeze;
pub(crate) mod weight_shift;
pub(crate) mod yaw_limit;

pub(crate) use contact_state::{ContactState, FootMotion};
pub(crate) use foot_lock::FootLock;
pub(crate) use lean::Lean;
pub use leg::FootPose;
pub(crate) use leg::PosedLeg;
pub(crate) use look_at::LookAt;
pub use posture::Posture;
pub use secondary_motion::LackingMotion;
pub(crate) use secondary_motion::SecondaryMotion;
pub(crate) use squeeze::Squeeze;
pub(crate) use weight_shift::WeightShift;

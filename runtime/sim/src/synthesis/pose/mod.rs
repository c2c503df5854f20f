//! The drawn pose: locks planted feet, lowers the pelvis, bends the legs, turns the head.
//!
//! Enters: a sampled pose, the root, foot contacts. Leaves: the pose after inverse kinematics.
//!
//! Read `leg`, `leg_length`, `posture` and `ik`, then what moves feet and pelvis: `heel_rise`, `pelvis`, `foot_room`,
//! `leg_clearance`, `settling_step`, `foot_lock`, all held by `contact_state`. `weight_shift` moves the pelvis before a
//! first step, `centring` over the feet of a standing body; `lean` tilts the body where it accelerates; `upper_body` holds
//! what trunk, head and arms do.

pub(crate) mod centring;
pub(crate) mod contact_state;
pub(crate) mod foot_lock;
pub(crate) mod foot_room;
pub(crate) mod heel_rise;
pub(crate) mod ik;
pub(crate) mod lean;
pub(crate) mod leg;
pub(crate) mod leg_clearance;
pub(crate) mod leg_length;
pub(crate) mod pelvis;
pub(crate) mod posture;
pub(crate) mod settling_step;
pub(crate) mod upper_body;
pub(crate) mod weight_shift;

pub(crate) use centring::Centring;
pub(crate) use contact_state::{ContactState, FootMotion};
pub(crate) use foot_lock::FootLock;
pub(crate) use lean::ExcessLean;
pub use leg::FootPose;
pub(crate) use leg::PosedLeg;
pub use posture::Posture;
pub use upper_body::LackingMotion;
pub(crate) use upper_body::{BodyClearance, LookAt, SecondaryMotion, Squeeze};
pub(crate) use weight_shift::WeightShift;

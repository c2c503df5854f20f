//! Retargeting: a [`SourceClip`](crate::read::SourceClip) with roles becomes a [`HumanClip`], the canonical humanoid.
//!
//! Enters: joints in source units and axes, and their roles. Leaves: the performer's body; poses in world coordinates
//! (metres, z up, soles at z = 0); the mean speed, turn rate and side speed of the clip.
//!
//! Read `stated_facing`, `foot_passings` and `units`; then `facing_frame`, `treadmill_speed` and `source_parameters`
//! (whole-clip parameters), `trim_t_poses` and `posture`; then `anchors`, `joint_tracks`, `calibration` and `soles`; last
//! `to_humanoid`, which makes the `human_clip`, with its [`crate::extra_joints`].

pub(crate) mod anchors;
pub(crate) mod calibration;
pub(crate) mod facing_frame;
pub(crate) mod foot_passings;
pub(crate) mod human_clip;
pub(crate) mod joint_tracks;
pub(crate) mod posture;
pub(crate) mod soles;
pub(crate) mod source_parameters;
pub(crate) mod stated_facing;
pub(crate) mod to_humanoid;
pub(crate) mod treadmill_speed;
pub(crate) mod trim_t_poses;
pub mod units;

pub use human_clip::{Choices, HumanBody, HumanClip, HumanJoints, HumanPose};
pub use posture::LowPart;
pub use source_parameters::{SourceParameters, source_parameters};

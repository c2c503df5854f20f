//! Extra joints: those of fingers and toes and twist bones, beside the 22 roles. Planning, contacts and inverse kinematics
//! do not use them; poses carry them along ([`HumanPose::extra`](crate::retarget::HumanPose)).
//!
//! Enters: a source clip with the roles of its joints. Leaves: the extra joints of each clip, their rotations relative to
//! palm and limbs, and the motion of those of a set ([`motiondb::motion::ExtraMotion`]).
//!
//! Read `extra_names` and `extra_search` (which source joint is which), `palm` (the hand's axes), `extra_tracks` (calibration,
//! and rotations in each frame) with `clip_extra`, then `set_extra` (the joints of a set in its examples and actions).

pub(crate) mod clip_extra;
pub(crate) mod extra_names;
pub(crate) mod extra_search;
pub(crate) mod extra_tracks;
pub(crate) mod palm;
pub(crate) mod set_extra;

pub use clip_extra::ClipExtra;

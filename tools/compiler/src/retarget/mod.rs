//! Retargeting: a `SourceClip` with roles becomes a `HumanClip`, the canonical humanoid in metres, z up.
//!
//! Read `units` and `axis`, then `source_parameters` and `treadmill_speed` (whole-clip parameters), `trim_t_poses`, then
//! `anchors`, `calibration`, `soles`, and last `to_humanoid`, which puts the `human_clip` together.

pub(crate) mod anchors;
pub(crate) mod axis;
pub(crate) mod calibration;
pub(crate) mod human_clip;
pub(crate) mod soles;
pub(crate) mod source_parameters;
pub(crate) mod to_humanoid;
pub(crate) mod treadmill_speed;
pub(crate) mod trim_t_poses;
pub mod units;

pub use axis::Axis;
pub use human_clip::{Choices, HumanBody, HumanClip, HumanJoints, HumanPose};
pub use source_parameters::{WholeClip, measure};

//! Motion clips in, motion database out: one file per stage, in `compile.rs` one line per stage.
//!
//! [`manifest`] → [`take`] → import ([`bvh`], [`gltf`]) → [`source_clip::SourceClip`] → [`skeleton_map`] →
//! [`human_clip::HumanClip`] → [`target_skeleton`], [`root_motion`], [`unroll`] → [`root_motion::GroundedClip`] →
//! [`contacts`], [`stance`], [`gait`], [`stride`], [`steady_window`], [`stride_alignment`], [`performer`] →
//! [`pose_mean`], `closing`, [`cycle::GaitCycle`] (or [`standing`]) → [`foot_slide`], [`duplicates`], `selection` →
//! `named_cycles`, [`mirror`] → [`parameterize`], [`rows`], [`velocity_hull`], [`blend_space`], [`correspondence`] →
//! [`motiondb::motion_db::MotionDb`]

pub mod alignment;
mod analysis;
mod anchors;
pub mod anthropometry;
pub mod arc;
pub mod axis;
pub mod blend_space;
mod body_plan;
pub mod bvh;
mod bvh_prepass;
mod calibration;
mod carried;
mod closing;
pub mod compile;
pub mod compile_error;
pub mod contacts;
pub mod correspondence;
pub mod cycle;
mod decimal;
pub mod duplicates;
pub mod error;
mod facing;
mod first_pose;
pub mod foot_slide;
mod footing;
mod frame_times;
pub mod gait;
pub mod gltf;
mod gltf_accessor;
mod gltf_buffers;
mod gltf_document;
mod gltf_plan;
mod gltf_track;
mod gltf_tree;
pub mod human_clip;
pub mod import;
mod joint_names;
pub mod leg_ik;
mod limb;
pub mod manifest;
pub mod manifest_error;
mod manifest_table;
pub mod mirror;
pub mod mutation;
mod named_cycles;
mod names;
pub mod near_names;
mod outline;
pub mod parameterize;
mod performance;
pub mod performer;
mod plausibility;
pub mod pose_mean;
pub mod progress;
mod quiet_unwind;
pub mod reading_speed;
pub mod refused;
pub mod remark;
mod retarget;
pub mod root_motion;
pub mod rows;
mod same_take;
mod selection;
mod shape;
mod shared_stretches;
pub mod skeleton_map;
mod soles;
pub mod source_clip;
pub mod source_parameters;
pub mod stance;
pub mod standing;
pub mod steady_window;
mod stir;
pub mod stride;
pub mod stride_alignment;
pub mod survey;
#[cfg(test)]
mod synthetic;
pub mod take;
mod take_search;
pub mod target_skeleton;
mod tread;
pub mod truth;
mod two_bodies;
pub mod units;
pub mod unroll;
pub mod velocity_hull;

//! Motion clips in, motion database out: one file per stage, in `compile.rs` one line per stage.
//!
//! [`manifest`] → [`take`] → [`clip_set`], [`mod@import`] ([`bvh`], [`gltf`]) → [`source_clip::SourceClip`] →
//! [`skeleton_map`] → [`human_clip::HumanClip`] → [`target_skeleton`], [`root_motion`], [`unroll`] →
//! [`root_motion::GroundedClip`] → [`contacts`], [`stance`], [`gait`], [`stride`], [`steady_window`],
//! [`stride_alignment`], [`performer`] → [`pose_mean`], `closing`, [`cycle::GaitCycle`] (or [`standing`]) →
//! [`foot_slide`], [`duplicates`], `selection` → `named_cycles`, [`mirror`] → [`parameterize`], [`rows`],
//! [`motiondb::velocity_hull`], `twins` → [`motiondb::triangulation`], [`correspondence`] →
//! [`motiondb::motion_db::MotionDb`]
//!
//! The modules below stand in this order, a paragraph for each part of the way.

// The pipeline, and what it tells while it runs and where it fails.
pub mod compile;
pub mod compile_error;
pub mod progress;
pub mod refused;

// What is to be compiled: a manifest's tables, or every clip of a folder.
pub mod clip_set;
pub mod manifest;
mod names;
pub mod near_names;
pub mod take;

// Files → SourceClip: global positions and orientations of named joints.
pub mod bvh;
mod decimal;
pub mod error;
pub mod gltf;
pub mod import;
pub mod quiet_unwind;
pub mod source_clip;

// Whose joints they are: the roles of a human body, by shape and motion first, by names second.
mod body_plan;
mod facing;
mod joint_names;
mod limb;
mod shape;
pub mod skeleton_map;
mod two_bodies;

// SourceClip → HumanClip: metres, Z up, the motion alone, whole-clip parameters, doubts, the canonical humanoid.
mod anchors;
pub mod axis;
mod calibration;
mod carried;
mod first_pose;
pub mod human_clip;
mod plausibility;
mod retarget;
mod soles;
pub mod source_parameters;
mod tread;
pub mod units;

// One body for all, and a root that travels on it.
pub mod anthropometry;
pub mod arc;
pub mod leg_ik;
pub mod root_motion;
pub mod target_skeleton;
pub mod unroll;

// Gait: contacts, stances, strides and the steady windows of them.
pub mod contacts;
mod footing;
pub mod gait;
pub mod performer;
pub mod stance;
pub mod standing;
pub mod steady_window;
pub mod stride;

// A window's mean stride as a closed cycle, phase 0 at right mid-stance.
mod analysis;
mod closing;
pub mod cycle;
pub mod foot_slide;
pub mod pose_mean;
pub mod stride_alignment;

// Which windows give examples: of one take one copy, of near-equal ones the best, by name, with mirrors.
pub mod alignment;
pub mod duplicates;
mod frame_times;
pub mod mirror;
mod named_cycles;
mod outline;
mod performance;
mod same_take;
mod selection;
mod shared_stretches;
mod stir;
mod take_search;

// Cycles → MotionDb.
pub mod correspondence;
pub mod parameterize;
pub mod rows;
mod twins;

// What is told of clips without a database.
pub mod survey;
#[cfg(test)]
mod synthetic;

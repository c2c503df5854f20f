//! The camera view: a recording as a sequence of frames, seen from a camera in the scene.
//!
//! Enters: a recording, and a camera of its scenario or none. Leaves: PNG (by the tone curve) and EXR files (scene-linear).
//!
//! Read `options`, `placement` (where a camera is at a time), `default_camera` (where no camera is stated),
//! `blocks` (walls as solids), `bodies` (agents as parts, and their colours), `view` (one frame), `captions`, `take` (lens
//! and agents at any time), `exr_passes`, `memory_need`, and `sequence` (all frames).

pub(crate) mod blocks;
pub(crate) mod bodies;
pub(crate) mod captions;
pub(crate) mod colour_by;
pub(crate) mod default_camera;
pub(crate) mod exr_passes;
mod memory_need;
pub(crate) mod options;
pub(crate) mod placement;
pub(crate) mod sequence;
pub(crate) mod take;
pub(crate) mod view;
pub(crate) mod worn;

pub use colour_by::ColourBy;
pub use options::{CameraOptions, Quality};
pub use sequence::{camera_picture_paths, draw_camera_sequence, render_camera_sequence};
pub use view::{CameraView, Shot};

//! The top view: a recording becomes a sequence of frames.
//!
//! Enters: a recording and a view. Leaves: PNG or EXR files.
//!
//! Read `sequence`, then `playback` (poses between steps), `framing` and `frame`; `ground`, `trails`, `shade`
//! and `overlay` are the layers of a frame; `frame_range` reads `--frames`.

pub mod frame;
pub mod frame_range;
pub mod framing;
pub mod ground;
pub mod overlay;
pub mod playback;
pub mod sequence;
pub mod shade;
pub mod trails;

//! The top view: a recording becomes a sequence of frames.
//!
//! Enters: a recording and a view. Leaves: PNG or EXR files.
//!
//! Read `sequence`, then `playback` (poses between steps), `framing` and `frame`; `ground`, `trails`, `shade`
//! and `overlay` are the layers of a frame; `frame_range` reads `--frames`.

pub(crate) mod frame;
pub(crate) mod frame_range;
pub(crate) mod framing;
pub(crate) mod ground;
pub(crate) mod overlay;
pub(crate) mod playback;
pub(crate) mod sequence;
pub(crate) mod shade;
pub(crate) mod trails;

pub use frame::{FrameBuffers, TopView};
pub use frame_range::FrameRange;
pub use framing::Framing;
pub use overlay::Overlay;
pub use playback::{read_tracks, sample};
pub use sequence::{Format, SequenceOptions, render_sequence};
pub use shade::ShadeMask;
pub use trails::{Tracks, Trail};

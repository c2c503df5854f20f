//! The top view: a recording becomes a sequence of frames, seen from straight above.
//!
//! Enters: a recording, which holds its view. Leaves: pictures, or PNG or EXR files.
//!
//! Read `sequence`, then `playback` (tracks), `framing` and `frame`. The layers of a frame are `ground`
//! with `markings`, `doors`, `signals`, `trails`, `shade` and `captions`. `frame_range` reads `--frames`.

pub(crate) mod captions;
pub(crate) mod doors;
pub(crate) mod frame;
pub(crate) mod frame_range;
pub(crate) mod framing;
pub(crate) mod ground;
pub(crate) mod markings;
pub(crate) mod playback;
pub(crate) mod sequence;
pub(crate) mod shade;
pub(crate) mod signals;
pub(crate) mod trails;

pub use fbcrowd_sim::recording::sample;
pub use frame::{FrameBuffers, TopView};
pub use frame_range::FrameRange;
pub use framing::Framing;
pub use playback::read_tracks;
pub use sequence::{PictureFormat, SequenceOptions, draw_sequence, frame_times, picture_paths, render_sequence};
pub use trails::{Track, Tracks};

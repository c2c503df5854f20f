//! Playback: a recording at any time. Frames of a picture have a rate of their own, recorded frames the step's.
//!
//! Enters: a recording and a time. Leaves: the bodies then, and the rotations of their extra joints. Read `times`, `bodies`,
//! then `extra_frame`.

pub(crate) mod bodies;
pub(crate) mod extra_frame;
pub(crate) mod times;

pub use bodies::sample;
pub use extra_frame::{ExtraFrame, sample_extra};
pub use times::{FrameTimes, duration_s};

//! Duplicate detection: of the same take twice only one copy gives examples.

pub(crate) mod alignment;
pub(crate) mod duplicates;
pub(crate) mod frame_times;
pub(crate) mod outline;
pub(crate) mod performance;
pub(crate) mod same_take;
pub(crate) mod shared_stretches;
pub(crate) mod stir;
pub(crate) mod take_search;

pub use alignment::Alignment;
pub use duplicates::{Pair, pairs};

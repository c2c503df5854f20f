//! Benches of the compiler: what it finds in clips, how good the bundled clips are, and how long it takes.
//!
//! Enters: folders of clips, or the bundled ones. Leaves: differences from published measurements ([`import`], with
//! [`ground_truth`] and [`reading_speed`]; [`gait`]); durations and bytes ([`compile`]); how well an example can be
//! blended from the others ([`leave_one_out`], and how well at best: `least_blend`); whether bundled clips have the speeds
//! in their names and resemble real clips ([`clips`], with [`gait_figures`] and [`similarity`]).

pub mod clips;
pub mod compile;
pub mod gait;
pub mod gait_figures;
pub mod ground_truth;
pub mod import;
pub(crate) mod least_blend;
pub mod leave_one_out;
pub(crate) mod reading_speed;
pub mod similarity;

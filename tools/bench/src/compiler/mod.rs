//! Benches of the compiler: what it finds in clips, how good the bundled clips are, and how long it takes.
//!
//! In: folders of clips, or the bundled ones. Out: differences from measurements of others ([`import`], with
//! [`ground_truth`] and [`reading_speed`]; [`gait`]), durations and bytes ([`compile`]), how well examples stand in for each other ([`leave_one_out`]), and how near the
//! bundled clips are to their claims and to real ones ([`clips`], with [`gait_figures`] and [`similarity`]).

pub mod clips;
pub mod compile;
pub mod gait;
pub mod gait_figures;
pub mod ground_truth;
pub mod import;
pub mod leave_one_out;
pub(crate) mod reading_speed;
pub mod similarity;

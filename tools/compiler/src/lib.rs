//! Motion clips in, motion database out.
//!
//! [`compile`] tells the pipeline, one line a stage. Chapters, in the order of the pipeline: [`input`] → [`read`] →
//! [`rig`] → [`retarget`] with [`checks`] → [`ground`] → [`gait`] → [`cycle`] → [`dedup`], [`select`] → [`database`].
//! [`mod@import`] runs the stages up to a human clip for one file; [`survey`] reports on clips without a database.

pub mod checks;
pub mod compile;
pub mod compile_error;
pub mod cycle;
pub mod database;
pub mod dedup;
pub mod error;
mod frame_runs;
pub mod gait;
pub mod ground;
pub mod import;
pub mod input;
pub mod mutation;
pub mod progress;
pub mod read;
pub mod reading_speed;
pub mod refused;
pub mod retarget;
pub mod rig;
pub mod select;
pub mod survey;
#[cfg(test)]
mod synthetic;
pub mod truth;

//! In progress.

pub mod params;

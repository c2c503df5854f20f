//! The database: examples, blend space, velocity sets, skeleton, rows and correspondence of the selected cycles.
//!
//! Enters: named cycles in the order of the examples, and the records of all sources. Leaves:
//! [`motiondb::motion::MotionDb`].
//!
//! Read `assembly` (the chapter's steps), then `example`, `coincident_examples`, `skeleton` with `segment_radii`,
//! `rows`, `actions`.

pub(crate) mod actions;
pub(crate) mod assembly;
pub(crate) mod coincident_examples;
pub(crate) mod example;
pub(crate) mod rows;
pub(crate) mod segment_radii;
pub(crate) mod skeleton;

pub use skeleton::body_skeleton;

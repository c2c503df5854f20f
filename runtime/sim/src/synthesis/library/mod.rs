//! What all bodies share: the database, completed for crowds, and what synthesis derives from it once.
//!
//! Enters: a motion database and the tunables. Leaves: the `context` that every step of every body reads.
//!
//! Read `context`, then `augmented_database`, then `standing`.

pub mod augmented_database;
pub(crate) mod context;
pub(crate) mod standing;

pub use context::Studio;

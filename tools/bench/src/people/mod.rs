//! Bench of people: whether bodies move as people do, and differ as people do.
//!
//! Enters: databases, and captures of people. Leaves: each measure of [`fbcrowd_sim::measures::people`] beside the range
//! of the captures, measured by the same code.
//!
//! Read [`people_scenes`] (what is simulated), [`captures`] (clips as bodies over time), [`people_rows`] (measures and
//! goals), then the bench: [`as_people`].

pub mod as_people;
pub(crate) mod captures;
pub mod people_rows;
pub(crate) mod people_scenes;

//! Texts of scenarios, simulations and recordings.
//!
//! Read [`scene_text`] (before a simulation), [`timings_text`] (its durations), [`measures_text`], [`people_text`] and
//! [`places_text`] (its recording).

pub(crate) mod measures_text;
pub(crate) mod people_text;
pub(crate) mod places_text;
pub(crate) mod scene_text;
pub(crate) mod timings_text;

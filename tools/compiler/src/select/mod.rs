//! Selection: which steady cycles become examples, under which names, with which mirrors.
//!
//! Enters: for each clip its steady cycles. Leaves: named cycles (not yet sorted), and a note for each cycle left
//! out.
//!
//! Read in the order of the pipeline: `best_windows`, `clean_cycles` (by `rate_hull`), `unlike_carriages`, `named_cycles`,
//! `one_standing`, `limited_set`, `mirror`; `base_walk` chooses m_sp, by `posture_penalty` among others.

pub(crate) mod base_walk;
pub(crate) mod best_windows;
pub(crate) mod clean_cycles;
pub(crate) mod limited_set;
pub(crate) mod mirror;
pub(crate) mod named_cycles;
pub(crate) mod one_standing;
pub(crate) mod posture_penalty;
mod rate_hull;
pub(crate) mod unlike_carriages;

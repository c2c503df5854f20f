//! Input: which clips are compiled, and what the user states about them.
//!
//! Enters: a manifest, folders, files. Leaves: one `ClipSettings` per clip, and the imported clips with unique names.
//!
//! Read `clip_settings`, then `manifest`, then `clip_set`; `unique_names` and `name_suggestions` serve both.

pub mod clip_set;
pub(crate) mod clip_settings;
pub mod manifest;
pub(crate) mod name_suggestions;
pub(crate) mod options;
pub(crate) mod unique_names;

pub use clip_settings::{JointMap, Places, Settings, Take};
pub use name_suggestions::nearest_first;
pub use options::Options;

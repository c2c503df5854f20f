//! Input: which clips are compiled, and what the user states about them.
//!
//! Enters: files, folders, a manifest. Leaves: one [`ClipSettings`] for each clip and the [`Options`] of the whole set;
//! then, as [`ClipSet`], the imported clips in the order of a database, each with a unique name.
//!
//! Read `clip_settings` and `options`, then `manifest`, then `clip_set` with `rig_units`. `clip_files` finds clips in
//! folders; `style_names` finds styles in paths, by `style_words`; `unique_names` and `name_suggestions` help with names.

pub(crate) mod clip_files;
pub(crate) mod clip_set;
pub(crate) mod clip_settings;
pub mod manifest;
pub(crate) mod name_suggestions;
pub(crate) mod options;
pub(crate) mod rig_units;
pub(crate) mod style_names;
mod style_words;
pub(crate) mod unique_names;

pub use clip_files::{clip_files, foreign_files, linked_files};
pub use clip_set::{ClipSet, import_clip_set};
pub use clip_settings::{ClipSettings, ManifestSpans};
pub use manifest::Manifest;
pub use name_suggestions::nearest_first;
pub use options::Options;

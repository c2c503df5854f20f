//! Characters that bodies are drawn as: `[[characters]]`, and which agent wears which.
//!
//! Enters: the tables of a scenario file, and the names that agents, sources and profiles state. Leaves: specs without
//! paths, sets of them as bits, and apart from both the files.
//!
//! Read `character_spec`, then `character_tables`, then `character_check` and `character_choice`.

pub(crate) mod character_check;
mod character_choice;
pub(crate) mod character_spec;
pub(crate) mod character_tables;

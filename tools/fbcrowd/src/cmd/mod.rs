//! One file for each subcommand: its arguments, and `run`, which calls the jobs in order.
//!
//! Enters: the arguments. Leaves: an answer, or why the command could not do its work. The commands that read clips
//! share [`outside_arg`] and [`rejected`], those that draw one picture [`png_path`].

pub(crate) mod bench;
pub(crate) mod check;
pub(crate) mod clips;
pub(crate) mod compile;
pub(crate) mod completions;
pub(crate) mod convert;
pub(crate) mod inspect;
pub(crate) mod measure;
mod outside_arg;
mod png_path;
mod rejected;
pub(crate) mod render;
pub(crate) mod run;
pub(crate) mod simulate;
pub(crate) mod validate;

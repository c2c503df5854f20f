//! One file a subcommand: its arguments, and a `run` that leads from one stage to the next.
//!
//! Enters: the arguments. Leaves: an answer, or why the command could not do its work. [`rejected`] is shared by the commands
//! that read clips.

pub(crate) mod bench;
pub(crate) mod clips;
pub(crate) mod compile;
pub(crate) mod completions;
pub(crate) mod inspect;
pub(crate) mod measure;
mod rejected;
pub(crate) mod render;
pub(crate) mod run;
pub(crate) mod simulate;
pub(crate) mod validate;

//! One file a subcommand: its arguments, and a `run` that does nothing but lead from one stage to the next.

pub(crate) mod bench;
pub(crate) mod clips;
pub(crate) mod compile;
pub(crate) mod completions;
pub(crate) mod inspect;
pub(crate) mod measure;
pub(crate) mod render;
pub(crate) mod run;
pub(crate) mod simulate;
pub(crate) mod validate;

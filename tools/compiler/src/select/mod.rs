//! Selection: which windows become examples, under which names, with which mirrors.
//!
//! Read `selection`, then `named_cycles`, `mirror`, `coincident_examples`.

pub(crate) mod coincident_examples;
pub(crate) mod mirror;
pub(crate) mod named_cycles;
pub(crate) mod selection;

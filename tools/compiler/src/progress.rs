//! What a compilation has come to, told to whoever watches it: the library itself has no clock and prints nothing.

use std::path::Path;

/// One thing to tell.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Event<'a> {
    /// A stage begins, and the one before it is done; the names stand in [`crate::compile`], in its order.
    Stage(&'static str),
    /// A file is imported; told from any thread, in any order.
    Imported(&'a Path),
}

/// Whoever watches.
pub type Observer<'a> = dyn Fn(Event) + Sync + 'a;

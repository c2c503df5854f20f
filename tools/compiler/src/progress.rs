//! Progress of a compilation as events. The crate itself reads no clock and prints nothing.

use std::path::Path;

/// One step of progress.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum CompileEvent<'a> {
    /// A stage of this name begins, and the stage before it ends. [`mod@crate::compile`] names the stages in their
    /// order.
    Stage(&'static str),
    /// This file has been imported. The event comes from any thread, in any order.
    Imported(&'a Path),
}

/// A function that receives the events of a compilation; `&|_| ()` ignores them.
pub type Observer<'a> = dyn Fn(CompileEvent) + Sync + 'a;

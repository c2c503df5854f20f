//! What ends a compilation, and why a file or a clip is not used.
//!
//! A [`CompileError`] ends the work. A [`Rejection`] does not: the other clips are compiled, and the report lists it.
//! Each message states what is wrong, where (file, line, key) and how to mend it.

mod compile_error;
mod rejection;

pub use compile_error::CompileError;
pub(crate) use compile_error::transition_remedy;
pub use rejection::{ManifestKey, Rejection, RejectionReason};

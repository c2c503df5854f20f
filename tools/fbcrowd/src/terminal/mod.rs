//! The terminal: results to standard output, all else to standard error.
//!
//! In: texts and values to print ([`output`]), the events of a job ([`progress`]), and errors ([`failure`]). Out:
//! lines, a progress bar, and the exit code. Read [`output`] first; `signals` ends a process that is interrupted.

pub(crate) mod failure;
pub(crate) mod output;
pub(crate) mod progress;
#[cfg(unix)]
pub(crate) mod signals;

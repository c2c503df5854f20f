//! What breaks a file's format: [`RejectionReason::Malformed`] with its position and its remedy.

use crate::error::RejectionReason;

/// Fails at a part of a file.
pub(crate) fn malformed<T>(
    position: impl Into<String>,
    problem: impl Into<String>,
    remedy: &'static str,
) -> Result<T, RejectionReason> {
    Err(RejectionReason::Malformed { position: position.into(), problem: problem.into(), remedy })
}

/// Fails at a line of a text, counted from 1.
pub(crate) fn malformed_line<T>(
    line: usize,
    problem: impl Into<String>,
    remedy: &'static str,
) -> Result<T, RejectionReason> {
    malformed(format!("line {line}"), problem, remedy)
}

//! Standard output: results only, as text or JSON.

use std::io::{self, ErrorKind, Write};

use serde::Serialize;

use crate::failure::Failure;

/// Prints a result.
pub(crate) fn print(text: &str) -> Result<(), Failure> {
    match writeln!(io::stdout(), "{}", text.trim_end()) {
        Ok(()) => Ok(()),
        Err(error) if error.kind() == ErrorKind::BrokenPipe => Err(Failure::ReaderGone),
        Err(error) => Err(Failure::bad(format!("cannot write to standard output: {error}"))),
    }
}

/// Prints a result as JSON.
pub(crate) fn print_json(result: &impl Serialize) -> Result<(), Failure> {
    print(&to_json(result))
}

/// Indented JSON.
pub(crate) fn to_json(result: &impl Serialize) -> String {
    serde_json::to_string_pretty(result).expect("plain structs with string keys serialise")
}

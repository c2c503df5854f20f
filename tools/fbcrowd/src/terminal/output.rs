//! Standard output: results only, as text or JSON. Standard error: all else.

use std::io::{self, ErrorKind, Write};

use serde::Serialize;

use crate::report::plain_text::{one_line, without_control_characters};

/// Why standard output takes no more.
pub(crate) enum PrintError {
    /// The program that read standard output has ended (`| head -1`).
    ReaderGone,
    /// The operating system reports an error.
    Io(io::Error),
}

/// Prints one line on standard error. Where no program reads it (`2>&1 | head -1`), the work goes on.
pub(crate) fn say(line: &str) {
    say_text(&one_line(line));
}

/// Prints lines on standard error as they are; they must not contain control characters.
pub(crate) fn say_text(lines: &str) {
    let _ = writeln!(io::stderr(), "{lines}");
}

/// Prints a result.
pub(crate) fn print(text: &str) -> Result<(), PrintError> {
    match writeln!(io::stdout(), "{}", without_control_characters(text.trim_end())) {
        Ok(()) => Ok(()),
        Err(error) if error.kind() == ErrorKind::BrokenPipe => Err(PrintError::ReaderGone),
        Err(error) => Err(PrintError::Io(error)),
    }
}

/// Prints a result as JSON.
pub(crate) fn print_json(result: &impl Serialize) -> Result<(), PrintError> {
    print(&to_json(result))
}

/// Indented JSON.
pub(crate) fn to_json(result: &impl Serialize) -> String {
    serde_json::to_string_pretty(result).expect("plain structs with string keys serialise")
}

//! Standard output: results only, as text or JSON. Standard error: all else.

use std::io::{self, ErrorKind, Write};
use std::path::Path;

use serde::Serialize;

use crate::failure::Failure;

/// Says something on standard error; where nobody reads it (`2>&1 | head -1`), the work goes on.
pub(crate) fn say(message: &str) {
    say_styled(&printable(message));
}

/// As [`say`], with colours.
pub(crate) fn say_styled(message: &str) {
    let _ = writeln!(io::stderr(), "{message}");
}

/// Without the control characters that a file's name may hold: a terminal would obey them.
fn printable(text: &str) -> String {
    let is_harmless = |c: char| !c.is_control() || c == '\n' || c == '\t';
    text.chars().map(|c| if is_harmless(c) { c } else { char::REPLACEMENT_CHARACTER }).collect()
}

/// That a file to be written is none of those to be read, which it would replace.
pub(crate) fn spare<'a>(output: &Path, inputs: impl IntoIterator<Item = &'a Path>) -> Result<(), Failure> {
    let Ok(existing) = output.canonicalize() else { return Ok(()) };
    let mut inputs = inputs.into_iter();
    if inputs.any(|input| input.canonicalize().is_ok_and(|input| input == existing)) {
        let message =
            format!("{}: is to be read and cannot be written as well; choose another place", output.display());
        return Err(Failure::bad(message));
    }
    Ok(())
}

/// Prints a result.
pub(crate) fn print(text: &str) -> Result<(), Failure> {
    match writeln!(io::stdout(), "{}", printable(text.trim_end())) {
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

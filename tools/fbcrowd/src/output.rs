//! Standard output: results only, as text or JSON. Standard error: all else.

use std::io::{self, ErrorKind, Write};
use std::path::Path;

use serde::Serialize;

use crate::failure::Failure;

/// Says one line on standard error; where nobody reads it (`2>&1 | head -1`), the work goes on.
pub(crate) fn say(line: &str) {
    say_text(&one_line(line));
}

/// As [`say`], of lines that a terminal may have as they are.
pub(crate) fn say_text(lines: &str) {
    let _ = writeln!(io::stderr(), "{lines}");
}

/// A name, or a sentence that tells one, on one line: see [`harmless`].
pub(crate) fn one_line(text: &str) -> String {
    harmless(text, &[])
}

/// Control characters that a file's name may hold, but for those that are `kept`, as JSON escapes them (`\u001b`): a
/// terminal would obey them.
fn harmless(text: &str, kept: &[char]) -> String {
    let escaped = |letter: char| match letter.is_control() && !kept.contains(&letter) {
        true => format!("\\u{:04x}", u32::from(letter)),
        false => letter.to_string(),
    };
    text.chars().map(escaped).collect()
}

/// That a file to be written is none of those to be read, which it would replace.
pub(crate) fn spare(output: &Path, inputs: impl IntoIterator<Item = impl AsRef<Path>>) -> Result<(), Failure> {
    let Ok(existing) = output.canonicalize() else { return Ok(()) };
    let mut inputs = inputs.into_iter();
    if inputs.any(|input| input.as_ref().canonicalize().is_ok_and(|input| input == existing)) {
        let message =
            format!("{}: is to be read and cannot be written as well; choose another place", output.display());
        return Err(Failure::bad(message));
    }
    Ok(())
}

/// Whether two files to be written are one, however spelt; none need be there yet.
pub(crate) fn is_same_place(one: &Path, other: &Path) -> bool {
    let [one, other] = [one, other].map(|path| {
        let folder = path.parent().filter(|folder| !folder.as_os_str().is_empty()).unwrap_or(Path::new("."));
        (folder.canonicalize().unwrap_or_else(|_| folder.to_owned()), path.file_name().map(ToOwned::to_owned))
    });
    one == other
}

/// Prints a result.
pub(crate) fn print(text: &str) -> Result<(), Failure> {
    match writeln!(io::stdout(), "{}", harmless(text.trim_end(), &['\n', '\t'])) {
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

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn no_name_moves_the_cursor_or_begins_a_line() {
        assert_eq!(one_line("a\nb\u{1b}[31m\u{9b}é"), "a\\u000ab\\u001b[31m\\u009bé");
        assert_eq!(harmless("a\nb\r", &['\n']), "a\nb\\u000d");
    }
}

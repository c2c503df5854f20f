//! Lines and words of a BVH text.

use crate::error::RejectionReason;
use crate::read::decimal;
use crate::read::malformed::malformed_line;

/// Greatest magnitude of any number: a kilometre in hundredths of a millimetre.
const MAX_VALUE: f64 = 1e8;
/// Letters of a word that a message quotes.
const QUOTED_LETTERS: usize = 40;

/// The lines that are not blank, with their numbers from 1. LF, CRLF and bare CR end a line.
pub(crate) fn numbered_lines(text: &str) -> impl Iterator<Item = (usize, &str)> {
    let lines = text.split('\n').flat_map(|line| line.strip_suffix('\r').unwrap_or(line).split('\r'));
    (1..).zip(lines.map(str::trim)).filter(|(_, line)| !line.is_empty())
}

/// The number that a word spells.
pub(crate) fn number(line: usize, word: &str) -> Result<f64, RejectionReason> {
    match decimal::number(word) {
        Some(value) if value.abs() <= MAX_VALUE => Ok(value),
        _ => malformed_line(
            line,
            format!("`{}` is not a finite, sensible number", quoted(word)),
            number_remedy(word, "repair the value"),
        ),
    }
}

/// Remedy for a word that is not a number. Some programs write decimal commas.
pub(crate) fn number_remedy(word: &str, otherwise: &'static str) -> &'static str {
    if word.contains(',') { "write numbers with points, not commas" } else { otherwise }
}

/// The beginning of a word, short enough for a message.
pub(crate) fn quoted(word: &str) -> String {
    word.chars().take(QUOTED_LETTERS).collect()
}

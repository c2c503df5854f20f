//! Names, sentences and numbers as a terminal may print them: names of files can hold characters that it would obey.

/// A name, or a sentence that quotes one, on one line; control characters as JSON escapes them (`\u001b`).
pub(crate) fn one_line(text: &str) -> String {
    escaped(text, &[])
}

/// As [`one_line`], of a text of several lines.
pub(crate) fn without_control_characters(text: &str) -> String {
    escaped(text, &['\n', '\t'])
}

/// Escapes all control characters but those that are `kept`.
fn escaped(text: &str, kept: &[char]) -> String {
    let escaped = |letter: char| match letter.is_control() && !kept.contains(&letter) {
        true => format!("\\u{:04x}", u32::from(letter)),
        false => letter.to_string(),
    };
    text.chars().map(escaped).collect()
}

/// A file and its clip as one name.
pub(crate) fn title(file: &str, clip: &str) -> String {
    format!("{file} {clip}").trim_end().to_owned()
}

/// 0 without sign for a value that is printed as 0 with this number of decimals.
pub(crate) fn unsigned_zero(value: f32, decimals: usize) -> f32 {
    let last_digits = (0..decimals).fold(value.abs(), |digits, _| 10.0 * digits);
    if last_digits <= 0.5 { 0.0 } else { value }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn control_characters_are_escaped() {
        assert_eq!(one_line("a\nb\u{1b}[31m\u{9b}é"), "a\\u000ab\\u001b[31m\\u009bé");
        assert_eq!(without_control_characters("a\nb\r"), "a\nb\\u000d");
    }
}

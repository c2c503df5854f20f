//! Lines and words of a BVH text.

use std::borrow::Cow;
use std::io::{self, BufRead, ErrorKind};

use crate::error::RejectionReason;
use crate::read::decimal;
use crate::read::malformed::malformed_line;

/// Greatest magnitude of any number: a kilometre in hundredths of a millimetre.
const MAX_VALUE: f64 = 1e8;
/// Greatest length of a line, bytes: 4096 joints with six channels of 40 digits.
pub(crate) const LINE_MAX_BYTES: usize = 1 << 20;
/// Letters of a word that a message quotes.
const QUOTED_LETTERS: usize = 40;

/// A text, read line by line. LF, CRLF and bare CR end a line.
pub(crate) struct TextLines<R> {
    reader: R,
    /// Bytes of the last line.
    bytes: Vec<u8>,
    /// Number of the last line, from 1.
    number: usize,
    /// Whether a CR ended the last line: an LF after it belongs to it.
    is_after_cr: bool,
}

/// A line that is not blank.
pub(crate) struct TextLine<'a> {
    /// Number of the line, from 1.
    pub number: usize,
    /// The line; its first [`LINE_MAX_BYTES`] where it is longer.
    text: Cow<'a, str>,
    /// Whether the line is longer.
    is_cut: bool,
}

impl TextLine<'_> {
    /// The line without blanks at its ends.
    pub(crate) fn text(&self) -> &str {
        self.text.trim()
    }

    /// Fails unless the line has at most `most_bytes`.
    pub(crate) fn check_length(&self, most_bytes: usize) -> Result<(), RejectionReason> {
        if self.is_cut || self.text.len() > most_bytes {
            let problem = format!("the line is longer than {most_bytes} bytes");
            return malformed_line(self.number, problem, "is it a BVH file? check its name");
        }
        Ok(())
    }
}

impl<R: BufRead> TextLines<R> {
    /// The lines of a text.
    pub(crate) fn new(reader: R) -> Self {
        Self { reader, bytes: Vec::new(), number: 0, is_after_cr: false }
    }

    /// The next line that is not blank; none after the last.
    pub(crate) fn next(&mut self) -> Result<Option<TextLine<'_>>, RejectionReason> {
        self.next_unless(|_| false)
    }

    /// The next line that is neither blank nor a comment. BVH has no comments, but some programs write lines that begin
    /// with `#` or `//` before the rows of motion.
    pub(crate) fn next_statement(&mut self) -> Result<Option<TextLine<'_>>, RejectionReason> {
        self.next_unless(is_comment)
    }

    /// The next line that is neither blank nor left out.
    fn next_unless(&mut self, is_left_out: fn(&[u8]) -> bool) -> Result<Option<TextLine<'_>>, RejectionReason> {
        loop {
            if !self.read_line().map_err(|error| RejectionReason::unreadable(&error))? {
                return Ok(None);
            }
            self.number += 1;
            // A line that is too long ends the reading, also if its beginning is blank.
            if self.bytes.len() > LINE_MAX_BYTES || !(is_blank(&self.bytes) || is_left_out(&self.bytes)) {
                break;
            }
        }
        let is_cut = self.bytes.len() > LINE_MAX_BYTES;
        Ok(Some(TextLine { number: self.number, text: String::from_utf8_lossy(&self.bytes), is_cut }))
    }

    /// Reads the bytes of a line without its end, but no more than one beyond [`LINE_MAX_BYTES`]; false after the last.
    fn read_line(&mut self) -> io::Result<bool> {
        self.bytes.clear();
        let mut has_any = false;
        loop {
            let found = match self.reader.fill_buf() {
                Err(error) if error.kind() == ErrorKind::Interrupted => continue,
                found => found?,
            };
            if found.is_empty() {
                return Ok(has_any);
            }
            if self.is_after_cr {
                self.is_after_cr = false;
                if found[0] == b'\n' {
                    self.reader.consume(1);
                    continue;
                }
            }
            has_any = true;
            let room = LINE_MAX_BYTES + 1 - self.bytes.len();
            let found = &found[..found.len().min(room)];
            let end = found.iter().position(|byte| matches!(byte, b'\n' | b'\r'));
            self.bytes.extend_from_slice(&found[..end.unwrap_or(found.len())]);
            self.is_after_cr = end.is_some_and(|end| found[end] == b'\r');
            let used = end.map_or(found.len(), |end| end + 1);
            self.reader.consume(used);
            if end.is_some() || self.bytes.len() > LINE_MAX_BYTES {
                return Ok(true);
            }
        }
    }
}

/// Whether a line has blanks alone. A letter, digit or sign of ASCII decides at once.
fn is_blank(line: &[u8]) -> bool {
    !line.iter().any(u8::is_ascii_graphic) && String::from_utf8_lossy(line).trim().is_empty()
}

fn is_comment(line: &[u8]) -> bool {
    let text = line.trim_ascii_start();
    text.starts_with(b"#") || text.starts_with(b"//")
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

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn lines_end_with_lf_crlf_or_cr() {
        let text = "a\r\n\n b \rc\r\r\nd\re\n\rf";
        for capacity in 1..=text.len() {
            let mut lines = TextLines::new(std::io::BufReader::with_capacity(capacity, text.as_bytes()));
            let mut found = Vec::new();
            while let Some(line) = lines.next().unwrap() {
                found.push((line.number, line.text().to_owned()));
            }
            let expected = [(1, "a"), (3, "b"), (4, "c"), (6, "d"), (7, "e"), (9, "f")];
            assert_eq!(found, expected.map(|(number, line)| (number, line.to_owned())), "{capacity}");
        }
    }

    #[test]
    fn comments_are_no_statements() {
        let mut lines = TextLines::new("# a\n // b\nc # d\n\n#e\nf\n# g".as_bytes());
        let mut next = || lines.next_statement().unwrap().map(|line| (line.number, line.text().to_owned()));
        assert_eq!([next(), next(), next()], [Some((3, "c # d".into())), Some((6, "f".into())), None]);
    }

    #[test]
    fn a_line_without_end_is_cut() {
        let mut endless = TextLines::new(io::BufReader::new(io::repeat(0)));
        let line = endless.next().unwrap().unwrap();
        assert!(line.is_cut && line.text.len() == LINE_MAX_BYTES + 1);
        assert_eq!(line.check_length(10).unwrap_err().to_string().split(':').next(), Some("line 1"));
    }
}

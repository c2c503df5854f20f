//! A text that a user wrote (a scenario, a manifest), and a mistake in it with its position, so that a report can point
//! at it.

use std::io::{self, ErrorKind, Read};
use std::ops::Range;
use std::path::{Path, PathBuf};

use crate::files::input_file;
use crate::files::list_entries;
use crate::files::parser_words::in_plain_words;

/// Greatest length of a text, bytes: ten thousand obstacles of a hundred corners. The TOML parser takes up to 80 times
/// the text's length in memory.
const TEXT_MAX_BYTES: u64 = 16 << 20;
/// Greatest length of a message, characters; longer ones are cut.
const MESSAGE_MAX_LETTERS: usize = 1_000;

/// A text and its file.
///
/// ```
/// use motiondb::files::SourceText;
///
/// let text = SourceText { path: "scene.toml".into(), text: "dt_s = 0.1\nagents = 0\n".to_owned() };
/// let mistake = text.invalid(20..21, "there is no agent", "add one");
/// assert_eq!(mistake.to_string(), "scene.toml:2: there is no agent; add one");
/// ```
#[derive(Clone, Debug, Default)]
pub struct SourceText {
    /// Path of the file.
    pub path: PathBuf,
    /// The whole text, without byte order mark.
    pub text: String,
}

/// A mistake in a text.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[error("{}:{}: {message}; {help}", path.display(), self.line())]
pub struct Invalid {
    /// Path of the file.
    pub path: PathBuf,
    /// The whole text of the file.
    pub text: String,
    /// Bytes of the text that are wrong.
    pub span: Range<usize>,
    /// The mistake.
    pub message: String,
    /// The remedy.
    pub help: String,
    /// Whether a report may show the text around the mistake: the file is of the expected kind. Any other file is one
    /// that its owner may not want to show.
    pub is_quotable: bool,
}

impl Invalid {
    /// Line of the mistake, from 1.
    pub fn line(&self) -> usize {
        let before = &self.text.as_bytes()[..self.span.start.min(self.text.len())];
        1 + before.iter().filter(|&&byte| byte == b'\n').count()
    }
}

impl SourceText {
    /// Reads a regular file of text.
    ///
    /// # Errors
    /// If the system cannot read the file, or the file is not UTF-8 or too long.
    pub fn read(path: &Path) -> io::Result<Self> {
        let file = input_file::open(path)?;
        let invalid = |message: String| io::Error::new(ErrorKind::InvalidData, message);
        let mut bytes = Vec::new();
        // A file may become longer while it is read.
        if file.metadata()?.len() > TEXT_MAX_BYTES
            || file.take(TEXT_MAX_BYTES + 1).read_to_end(&mut bytes)? as u64 > TEXT_MAX_BYTES
        {
            return Err(invalid(format!("the text is longer than {} MiB", TEXT_MAX_BYTES >> 20)));
        }
        let text = in_utf8(bytes).map_err(invalid)?;
        // Some editors begin a text with a byte order mark.
        let text = text.strip_prefix('\u{feff}').map(str::to_owned).unwrap_or(text);
        Ok(Self { path: path.to_owned(), text })
    }

    /// A path relative to this file's folder, as a path.
    pub fn beside(&self, path: &Path) -> PathBuf {
        self.path.parent().unwrap_or(Path::new("")).join(path)
    }

    /// A mistake in this text.
    pub fn invalid(&self, span: Range<usize>, message: impl Into<String>, help: &str) -> Invalid {
        let (path, text) = (self.path.clone(), self.text.clone());
        // The message may quote a part of the text of any length.
        let message = message.into().chars().take(MESSAGE_MAX_LETTERS).collect();
        Invalid { path, text, span, message, help: help.to_owned(), is_quotable: true }
    }

    /// A mistake that the TOML parser found, in plain words. The text is quoted only where it is of the expected kind:
    /// its name ends in `.toml`, and a line begins with one of the kind's `keys`.
    pub fn unparsed(&self, span: Option<Range<usize>>, message: &str, keys: &[&str]) -> Invalid {
        let span = span.unwrap_or(0..0);
        if self.path.extension().is_some_and(|extension| extension == "toml") && self.has_a_key(keys) {
            let (message, help) = in_plain_words(message);
            return self.invalid(span, message, help);
        }
        // What the parser found is the file's own text, what it expected is ours.
        let expected = match message.rsplit_once(", expected one of ") {
            Some((_, expected)) => expected.to_owned(),
            None => format!("`{}`", keys.join("`, `")),
        };
        let message = format!("this is a file of another kind, expected one of {expected}");
        Invalid { is_quotable: false, ..self.invalid(span, message, "name another file") }
    }

    /// Whether a line of the text begins with one of some keys.
    pub fn has_a_key(&self, keys: &[&str]) -> bool {
        let is_end = |letter: char| letter.is_whitespace() || "=.]".contains(letter);
        let mut begins = self.text.lines().map(|line| line.trim_start_matches(['[', ' ', '\t']));
        begins.any(|line| line.split(is_end).next().is_some_and(|key| keys.contains(&key)))
    }

    /// The bytes at which an entry of a list of tables begins that follows some others; `name` is the list's key. The text
    /// is not parsed.
    pub fn entry_after(&self, name: &str, others: usize) -> Option<Range<usize>> {
        list_entries::entry_after(&self.text, name, others)
    }
}

/// The text of some bytes; an error that names another encoding, or the line that is not text in UTF-8.
fn in_utf8(bytes: Vec<u8>) -> Result<String, String> {
    if input_file::is_utf16(&bytes) {
        return Err("the text is UTF-16, two bytes a letter".into());
    }
    let line_of = |byte: usize| 1 + bytes[..byte].iter().filter(|&&byte| byte == b'\n').count();
    if let Some(zero) = bytes.iter().position(|&byte| byte == 0) {
        return Err(format!("line {} holds a zero byte, so this is no text", line_of(zero)));
    }
    String::from_utf8(bytes).map_err(|error| {
        let before = &error.as_bytes()[..error.utf8_error().valid_up_to()];
        let line = 1 + before.iter().filter(|&&byte| byte == b'\n').count();
        format!("line {line} is not UTF-8")
    })
}

#[cfg(test)]
mod tests {
    use std::fs;

    use super::*;

    #[test]
    fn only_the_expected_kind_is_quoted() {
        let check = |path: &str, text: &str, is_quotable: bool| {
            let source = SourceText { path: path.into(), text: text.to_owned() };
            let invalid = source.unparsed(Some(0..1), "unknown field `token`", &["clips", "agents"]);
            assert_eq!(invalid.is_quotable, is_quotable, "{path}");
            assert_eq!(invalid.message.contains("token"), is_quotable);
        };
        check("scene.toml", "token = 1\n[[agents]]\n", true);
        check("scene.toml", "token = 1\nclips = 3", true);
        check("scene.txt", "clips = 3\ntoken = 1", false);
        check("credentials.toml", "[registry]\ntoken = 1\n", false);
    }

    #[test]
    fn a_longer_text_is_not_read() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("long.toml");
        fs::File::create(&path).unwrap().set_len(1 << 40).unwrap();
        let error = SourceText::read(&path).unwrap_err();
        assert_eq!(
            (error.kind(), error.to_string()),
            (ErrorKind::InvalidData, "the text is longer than 16 MiB".into())
        );
    }

    #[test]
    fn another_encoding_is_named_with_its_line() {
        let wide = |bytes: fn(u16) -> [u8; 2]| "# a\n".encode_utf16().flat_map(bytes).collect::<Vec<u8>>();
        for bytes in
            [wide(u16::to_le_bytes), wide(u16::to_be_bytes), [vec![0xff, 0xfe], wide(u16::to_le_bytes)].concat()]
        {
            assert!(in_utf8(bytes).unwrap_err().contains("UTF-16"));
        }
        assert_eq!(in_utf8(b"a\n# caf\xe9\n".to_vec()), Err("line 2 is not UTF-8".to_owned()));
        assert_eq!(in_utf8(b"a\nb\0".to_vec()), Err("line 2 holds a zero byte, so this is no text".to_owned()));
        assert_eq!(in_utf8("é".into()), Ok("é".to_owned()));
    }
}

//! A text that a user wrote (a scenario, a manifest), and a mistake in it with its position, so that a report can point
//! at it.

use std::fs;
use std::io;
use std::ops::Range;
use std::path::{Path, PathBuf};

use crate::files::input_file;
use crate::files::parser_words::in_plain_words;

/// Greatest length of a text, bytes; a million agents take a tenth of it.
const TEXT_MAX_BYTES: u64 = 1 << 30;
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
        if fs::metadata(path)?.len() > TEXT_MAX_BYTES {
            return Err(io::Error::other("the text is longer than 1 GiB"));
        }
        let text = in_utf8(input_file::read(path)?).map_err(io::Error::other)?;
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
        Invalid { path, text, span, message, help: help.to_owned() }
    }

    /// A mistake that the parser found, in plain words.
    pub fn unparsed(&self, span: Option<Range<usize>>, message: &str) -> Invalid {
        let (message, help) = in_plain_words(message);
        self.invalid(span.unwrap_or(0..0), message, help)
    }
}

/// The text of some bytes; an error that names another encoding, or the line that is not UTF-8.
fn in_utf8(bytes: Vec<u8>) -> Result<String, String> {
    if input_file::is_utf16(&bytes) {
        return Err("the text is UTF-16, two bytes a letter".into());
    }
    String::from_utf8(bytes).map_err(|error| {
        let before = &error.as_bytes()[..error.utf8_error().valid_up_to()];
        let line = 1 + before.iter().filter(|&&byte| byte == b'\n').count();
        format!("line {line} is not UTF-8")
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn another_encoding_is_named_with_its_line() {
        let wide = |bytes: fn(u16) -> [u8; 2]| "# a\n".encode_utf16().flat_map(bytes).collect::<Vec<u8>>();
        for bytes in
            [wide(u16::to_le_bytes), wide(u16::to_be_bytes), [vec![0xff, 0xfe], wide(u16::to_le_bytes)].concat()]
        {
            assert!(in_utf8(bytes).unwrap_err().contains("UTF-16"));
        }
        assert_eq!(in_utf8(b"a\n# caf\xe9\n".to_vec()), Err("line 2 is not UTF-8".to_owned()));
        assert_eq!(in_utf8("é".into()), Ok("é".to_owned()));
    }
}

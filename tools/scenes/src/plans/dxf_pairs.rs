//! Pairs of a DXF file in text: a line with a group code, a line with its value.

use std::io::{ErrorKind, Read};
use std::path::Path;

use motiondb::files::{Invalid, SourceText, input_file};

use crate::error::SceneError;

/// Greatest length of a file, bytes: a building with its furniture.
const TEXT_MAX_BYTES: u64 = 64 << 20;
/// First bytes of a DXF file in binary form.
const BINARY: &[u8] = b"AutoCAD Binary DXF";

/// One pair.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Pair<'a> {
    pub(crate) code: i32,
    pub(crate) value: &'a str,
    /// Line of the value, from 1.
    pub(crate) line: usize,
}

/// Reads a file; letters of old code pages, which only names hold, become signs.
pub(crate) fn read_text(path: &Path) -> Result<SourceText, SceneError> {
    let unreadable = |source| SceneError::Unreadable { path: path.to_owned(), source };
    let file = input_file::open(path).map_err(unreadable)?;
    let mut bytes = Vec::new();
    file.take(TEXT_MAX_BYTES + 1).read_to_end(&mut bytes).map_err(unreadable)?;
    let invalid = |message: &str| unreadable(std::io::Error::new(ErrorKind::InvalidData, message));
    if bytes.len() as u64 > TEXT_MAX_BYTES {
        return Err(invalid("it is longer than 64 MiB"));
    }
    if bytes.starts_with(BINARY) {
        return Err(invalid("it is a binary DXF; save it as text"));
    }
    Ok(SourceText { path: path.to_owned(), text: String::from_utf8_lossy(&bytes).into_owned() })
}

/// The pairs of a text, to its EOF.
pub(crate) fn pairs(source: &SourceText) -> Result<Vec<Pair<'_>>, SceneError> {
    let mut pairs = Vec::new();
    let mut lines = source.text.lines().enumerate();
    while let Some((index, code)) = lines.next() {
        if code.trim().is_empty() && pairs.last().is_some_and(|pair: &Pair<'_>| pair.value == "EOF") {
            break;
        }
        let Ok(code) = code.trim().parse() else {
            return Err(fault(
                source,
                index + 1,
                "this is no group code of DXF".into(),
                "name a DXF file in text form",
            ));
        };
        let Some((index, value)) = lines.next() else { break };
        pairs.push(Pair { code, value: value.trim(), line: index + 1 });
    }
    if !pairs.last().is_some_and(|pair| pair.code == 0 && pair.value == "EOF") {
        let line = source.text.lines().count().max(1);
        return Err(fault(source, line, "the drawing ends early, without EOF".into(), "export it anew"));
    }
    Ok(pairs)
}

/// A mistake at a line, which is not quoted: the file may be of another kind.
pub(crate) fn fault(source: &SourceText, line: usize, message: String, help: &str) -> SceneError {
    let begin = source.text.split_inclusive('\n').take(line - 1).map(str::len).sum::<usize>();
    Invalid { is_quotable: false, ..source.invalid(begin..begin, message, help) }.into()
}

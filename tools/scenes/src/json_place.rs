//! Positions of values in a JSON text, for messages: the parsers of GeoJSON and of Vadere's scenarios keep none.

use std::fmt::Write;
use std::ops::Range;

/// A step from a value to one that it holds.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum JsonStep {
    /// The value of a key of an object.
    Key(&'static str),
    /// An item of a list.
    Item(usize),
}

/// The steps in words: `features[2].geometry`.
pub(crate) fn shown(path: &[JsonStep]) -> String {
    let mut text = String::new();
    for step in path {
        // Writing to a string cannot fail.
        let _ = match step {
            JsonStep::Key(key) if text.is_empty() => write!(text, "{key}"),
            JsonStep::Key(key) => write!(text, ".{key}"),
            JsonStep::Item(index) => write!(text, "[{index}]"),
        };
    }
    text
}

/// The first byte of the value at the end of the steps, in a text that a parser has read; as far as the steps lead.
pub(crate) fn place(text: &str, path: &[JsonStep]) -> Range<usize> {
    let mut scan = JsonScan { bytes: text.as_bytes(), at: 0 };
    scan.blank();
    for step in path {
        let before = scan.at;
        let is_found = match *step {
            JsonStep::Key(key) => scan.enter_key(key),
            JsonStep::Item(index) => scan.enter_item(index),
        };
        if is_found.is_none() {
            scan.at = before;
            break;
        }
    }
    let begin = scan.at.min(text.len());
    begin..begin
}

/// A walk through a text; none where it is no JSON.
struct JsonScan<'a> {
    bytes: &'a [u8],
    at: usize,
}

impl JsonScan<'_> {
    fn peek(&self) -> Option<u8> {
        self.bytes.get(self.at).copied()
    }

    fn blank(&mut self) {
        while self.peek().is_some_and(|byte| byte.is_ascii_whitespace() || byte == b'\xef') {
            // A byte order mark has three bytes.
            self.at += if self.peek() == Some(b'\xef') { 3 } else { 1 };
        }
    }

    /// Passes a byte and the blanks behind it.
    fn take(&mut self, byte: u8) -> Option<()> {
        (self.peek() == Some(byte)).then(|| self.at += 1)?;
        self.blank();
        Some(())
    }

    fn enter_key(&mut self, key: &str) -> Option<()> {
        self.take(b'{')?;
        loop {
            let begin = self.at;
            self.pass_string()?;
            let is_key = self.bytes[begin..self.at]
                .strip_prefix(b"\"")
                .is_some_and(|rest| rest.strip_prefix(key.as_bytes()).is_some_and(|rest| rest == b"\""));
            self.blank();
            self.take(b':')?;
            if is_key {
                return Some(());
            }
            self.pass_value()?;
            self.take(b',')?;
        }
    }

    fn enter_item(&mut self, index: usize) -> Option<()> {
        self.take(b'[')?;
        for _ in 0..index {
            self.pass_value()?;
            self.take(b',')?;
        }
        Some(())
    }

    fn pass_string(&mut self) -> Option<()> {
        (self.peek()? == b'"').then_some(())?;
        self.at += 1;
        loop {
            match self.peek()? {
                b'"' => break self.at += 1,
                b'\\' => self.at += 2,
                _ => self.at += 1,
            }
        }
        Some(())
    }

    /// Passes a value and the blanks behind it: brackets are counted, strings passed whole.
    fn pass_value(&mut self) -> Option<()> {
        let mut depth = 0_usize;
        loop {
            match self.peek()? {
                b'"' => self.pass_string()?,
                b'{' | b'[' => {
                    depth += 1;
                    self.at += 1;
                }
                b'}' | b']' => {
                    depth = depth.checked_sub(1)?;
                    self.at += 1;
                }
                b',' | b':' => self.at += 1,
                byte if byte.is_ascii_whitespace() => self.at += 1,
                _ => {
                    let ends = |byte: &u8| b",:]}\"".contains(byte) || byte.is_ascii_whitespace();
                    self.at += self.bytes[self.at..].iter().position(ends).unwrap_or(1).max(1);
                }
            }
            if depth == 0 {
                self.blank();
                return Some(());
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const TEXT: &str =
        "\u{feff} {\n \"a\": [1, {\"x\": \"]}\\\"\"}, [2]],\n \"b\" : {\"a\": null,\n  \"c\": [ [], true ]}}";

    fn check(path: &[JsonStep], begins: &str) {
        let at = place(TEXT, path);
        assert!(TEXT[at.start..].starts_with(begins), "{} leads to {}", shown(path), &TEXT[at.start..]);
    }

    #[test]
    fn steps_lead_to_their_value() {
        use JsonStep::{Item, Key};
        check(&[], "{");
        check(&[Key("a"), Item(1), Key("x")], "\"]}");
        check(&[Key("a"), Item(2), Item(0)], "2]");
        check(&[Key("b")], "{\"a\": null");
        check(&[Key("b"), Key("c"), Item(1)], "true");
        // As far as they lead.
        check(&[Key("b"), Key("d")], "{\"a\": null");
        check(&[Key("a"), Item(7)], "[1, ");
        assert_eq!(shown(&[Key("b"), Key("c"), Item(1), Item(0)]), "b.c[1][0]");
    }

    #[test]
    fn broken_texts_end_the_walk() {
        for length in 0..TEXT.len() {
            if let Some(text) = TEXT.get(..length) {
                place(text, &[JsonStep::Key("b"), JsonStep::Key("c"), JsonStep::Item(1)]);
            }
        }
    }
}

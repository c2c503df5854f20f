//! Entries of a list of tables in a TOML text, found without parsing it, which takes up to 80 times its length in memory.

use std::ops::Range;

/// A text, as far as it is read.
struct Reader<'a> {
    text: &'a str,
    at: usize,
    /// Number of brackets and braces that are open.
    depth: usize,
    /// Whether only blanks precede in the line.
    is_line_start: bool,
    /// Whether no header precedes: keys belong to the whole file.
    is_root: bool,
    /// Whether the value of the list's key is being read.
    is_list: bool,
}

/// The bytes at which an entry of a list begins that follows some others: a header `[[name]]`, or an inline table of
/// `name = […]` before all headers.
pub(super) fn entry_after(text: &str, name: &str, others: usize) -> Option<Range<usize>> {
    let mut reader = Reader { text, at: 0, depth: 0, is_line_start: true, is_root: true, is_list: false };
    std::iter::from_fn(|| reader.next_entry(name)).nth(others)
}

impl Reader<'_> {
    fn next_entry(&mut self, name: &str) -> Option<Range<usize>> {
        while let Some(byte) = self.text.as_bytes().get(self.at).copied() {
            let start = self.at;
            let is_key = self.is_line_start && self.depth == 0;
            match byte {
                b'#' => self.at += self.text[start..].find('\n').unwrap_or(self.text.len() - start),
                b'\n' => {
                    self.is_line_start = true;
                    self.is_list &= self.depth > 0;
                    self.at += 1;
                }
                b' ' | b'\t' | b'\r' => self.at += 1,
                b'[' if is_key => {
                    let line = self.text[start..].lines().next().unwrap_or_default();
                    (self.at, self.is_root, self.is_line_start) = (start + line.len(), false, false);
                    let inner = line.strip_prefix("[[").and_then(|line| line.split_once("]]"));
                    if inner.is_some_and(|(inner, _)| unquoted(inner.trim()) == name) {
                        return Some(start..self.at);
                    }
                }
                b'[' | b'{' => {
                    (self.depth, self.at) = (self.depth + 1, start + 1);
                    if self.is_list && self.depth == 2 && byte == b'{' {
                        return Some(start..self.at);
                    }
                }
                b']' | b'}' => (self.depth, self.at) = (self.depth.saturating_sub(1), start + 1),
                _ => {
                    self.at = if matches!(byte, b'"' | b'\'') { self.string_end() } else { self.word_end() };
                    self.is_list |= is_key && self.is_root && unquoted(&self.text[start..self.at]) == name;
                    self.is_line_start = false;
                }
            }
        }
        None
    }

    /// The byte after a string.
    fn string_end(&self) -> usize {
        let rest = &self.text[self.at..];
        let quotes = ["\"\"\"", "'''", "\"", "'"];
        let quote = quotes.into_iter().find(|quote| rest.starts_with(quote)).unwrap_or("'");
        let (mut end, is_escaping) = (quote.len(), quote.starts_with('"'));
        while end < rest.len() && !rest.as_bytes()[end..].starts_with(quote.as_bytes()) {
            end += if is_escaping && rest.as_bytes()[end] == b'\\' { 2 } else { 1 };
        }
        (self.at + end + quote.len()).min(self.text.len())
    }

    /// The byte after a word: a bare key, a number, or a sign.
    fn word_end(&self) -> usize {
        let is_end = |letter: char| letter.is_whitespace() || "=.,[]{}#\"'".contains(letter);
        let letters = self.text[self.at..].char_indices().skip(1);
        letters.into_iter().find(|(_, letter)| is_end(*letter)).map_or(self.text.len(), |(end, _)| self.at + end)
    }
}

fn unquoted(key: &str) -> &str {
    key.trim_matches(['"', '\''])
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn entries_are_headers_and_inline_tables_of_the_list() {
        let check = |text: &str, count: usize| {
            assert!((0..count).all(|others| entry_after(text, "cameras", others).is_some()), "{text}");
            assert_eq!(entry_after(text, "cameras", count), None, "{text}");
        };
        check("", 0);
        check("[[cameras]]\n a = 1\n[[ cameras ]] # two\n[[\"cameras\"]]\n[[other]]\n[cameras.x]", 3);
        check("cameras = [{a = [{b = 1}]}, {c = \"}{\\\"{\"},\n # {\n{d = '''\n{ ''', e = {f = 1}}]", 3);
        check("\"cameras\"=[{},{}]\nothers = [{}, {}]", 2);
        check("others = [{}]\n[view]\ncameras = [{}]", 0);
        check("text = '''\n[[cameras]]\n'''\nkeys = \"\"\"\ncameras = [{\"\"\"", 0);
        check("cameras = [{", 1);
        check("a = \"\\", 0);
        check("cameras.x = 1\ny = 'é{'", 0);
    }

    #[test]
    fn an_entry_is_where_it_begins() {
        assert_eq!(entry_after("cameras = [{}, {a = 1}]", "cameras", 1), Some(15..16));
        assert_eq!(entry_after("x = 1\n[[cameras]]\ny = 2", "cameras", 0), Some(6..17));
    }
}

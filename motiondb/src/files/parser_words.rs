//! Messages of the TOML parser in plain words: no names of types, and a remedy.

/// Expectations of the parser: its words, and plain words.
const EXPECTED: [(&str, &str); 15] = [
    ("a nonzero usize", "a whole number from 1 on"),
    ("a nonzero u32", "a whole number from 1 on"),
    ("usize", "a whole number from 0 on"),
    ("u64", "a whole number from 0 on"),
    ("u32", "a whole number from 0 on"),
    ("u16", "a whole number from 0 to 65535"),
    ("i64", "a whole number"),
    ("f64", "a number"),
    ("f32", "a number"),
    ("a boolean", "true or false"),
    ("a string", "a text in quotes"),
    ("path string", "a text in quotes"),
    ("string or table", "a text in quotes"),
    ("a sequence", "a list in brackets"),
    ("a map", "a table of keys and values"),
];
/// Mistakes of syntax: the beginning of the parser's message, the mistake in plain words, and the remedy.
const SYNTAX: [(&str, &str, &str); 9] = [
    ("string values must be quoted", "this is not a value", "write a number, true, false, or a text in quotes"),
    ("invalid basic string", "the text does not end in its line", "close it with a quote: \""),
    ("invalid literal string", "the text does not end in its line", "close it with a quote: '"),
    ("missing escaped value", "a \\ in a text begins an escape", "write paths with /, or with \\\\"),
    ("key with no value", "a key is here without a value", "write key = value"),
    ("duplicate key", "the key is here twice", "keep one of both"),
    ("unclosed inline table", "the table is not closed", "close it with }"),
    ("unclosed", "the bracket is not closed", "close it with ] as often as it is opened"),
    ("unexpected key or value", "the line should have ended here", "begin a new line, or remove the rest of this one"),
];

/// A message of the parser in plain words, and the remedy.
pub(crate) fn in_plain_words(message: &str) -> (String, &'static str) {
    if let Some((_, mistake, help)) = SYNTAX.iter().find(|(begin, ..)| message.starts_with(begin)) {
        return ((*mistake).to_owned(), help);
    }
    if message.starts_with("unknown field") {
        return (message.to_owned(), "correct the key or remove it");
    }
    if let Some(key) = message.strip_prefix("missing field ") {
        return (format!("the key {key} is missing"), "add the key");
    }
    let after = |begin: &str| message.strip_prefix(begin)?.split_once(", expected ");
    if let Some((count, expected)) = after("invalid length ") {
        return (format!("{} expected here, not {count} values", plainly_expected(expected)), "correct the value");
    }
    match after("invalid type: ").or_else(|| after("invalid value: ")) {
        Some(("map", "a sequence")) => {
            ("a list of tables is expected here, not one table".to_owned(), "begin each with double brackets: [[ ]]")
        }
        Some((found, expected)) => {
            (format!("{} expected here, not {}", plainly_expected(expected), plainly_found(found)), "correct the value")
        }
        None => (message.replacen("unknown variant", "unknown value", 1), "correct the value"),
    }
}

/// The expected value in plain words, with its verb.
fn plainly_expected(expected: &str) -> String {
    let is_of_several = expected.starts_with("the ");
    let plain = match EXPECTED.iter().find(|(words, _)| *words == expected) {
        Some((_, plain)) => plain,
        None if expected.starts_with("struct ") => "a table of keys and values",
        None => expected,
    };
    format!("{plain} {}", if is_of_several { "are" } else { "is" })
}

/// The value that was found, in plain words.
fn plainly_found(found: &str) -> &str {
    let kinds = ["integer ", "floating point ", "boolean ", "string "];
    match found {
        "map" => "a table",
        "sequence" => "a list",
        _ => kinds.iter().find_map(|kind| found.strip_prefix(kind)).unwrap_or(found),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn plain_words_name_no_types() {
        let check = |message: &str, plain: &str| assert_eq!(in_plain_words(message).0, plain);
        check(
            "invalid value: integer `0`, expected a nonzero usize",
            "a whole number from 1 on is expected here, not `0`",
        );
        check("invalid type: string \"cm\", expected f64", "a number is expected here, not \"cm\"");
        check("invalid type: map, expected a sequence", "a list of tables is expected here, not one table");
        check(
            "invalid type: string \"a\", expected struct Table",
            "a table of keys and values is expected here, not \"a\"",
        );
        check("invalid length 3, expected an array of length 2", "an array of length 2 is expected here, not 3 values");
        check("missing field `path`", "the key `path` is missing");
        check("unknown variant `papper`, expected `paper`", "unknown value `papper`, expected `paper`");
    }

    #[test]
    fn each_syntax_mistake_has_its_remedy() {
        let help = |message: &str| in_plain_words(message).1;
        assert_eq!(help("unclosed array table, expected `]`"), "close it with ] as often as it is opened");
        assert_eq!(help("invalid basic string, expected `\"`"), "close it with a quote: \"");
        assert_eq!(help("key with no value, expected `=`"), "write key = value");
    }
}

//! Words of TOML: numbers as short as in a source, names, comments, lists that break at 120 characters.

use crate::scene::{DrawnNumber, Point, Shape};

/// Greatest length of a line, characters.
pub(crate) const LINE_MAX: usize = 120;
/// Greatest number that is written without a point.
const WHOLE_MAX: f64 = 1e15;
/// Decimals of a number: micrometres.
const DECIMALS: usize = 6;

/// A number in decimals, without trailing zeros.
pub(crate) fn number(value: f64) -> String {
    let text = format!("{value:.DECIMALS$}");
    let short = text.trim_end_matches('0').trim_end_matches('.');
    match short {
        "-0" => "0".to_owned(),
        // Whole numbers of TOML have 64 bits.
        short if value.abs() > WHOLE_MAX => format!("{short}.0"),
        short => short.to_owned(),
    }
}

pub(crate) fn point([x, y]: Point) -> String {
    format!("[{}, {}]", number(x), number(y))
}

pub(crate) fn drawn(value: DrawnNumber) -> String {
    match value {
        DrawnNumber::Constant(value) => number(value),
        DrawnNumber::Uniform { from, to } => format!("{{ uniform = [{}, {}] }}", number(from), number(to)),
        DrawnNumber::Normal { mean, deviation, min, max } => {
            let bound = |name: &str, value: Option<f64>| {
                value.map_or_else(String::new, |value| format!(", {name} = {}", number(value)))
            };
            let bounds = bound("min", min) + &bound("max", max);
            format!("{{ normal = [{}, {}]{bounds} }}", number(mean), number(deviation))
        }
    }
}

/// The key of a shape and its value.
pub(crate) fn shape(shape: &Shape) -> String {
    match shape {
        Shape::Point(at_m) => format!("point_m = {}", point(*at_m)),
        Shape::Circle([x, y], radius_m) => {
            format!("circle_m = [{}, {}, {}]", number(*x), number(*y), number(*radius_m))
        }
        Shape::Rect([left, low], [right, high]) => {
            format!("rect_m = [{}, {}, {}, {}]", number(*left), number(*low), number(*right), number(*high))
        }
        Shape::Polygon(corners_m) => {
            let corners: Vec<String> = corners_m.iter().map(|&corner_m| point(corner_m)).collect();
            format!("polygon_m = [{}]", corners.join(", "))
        }
    }
}

/// A text in quotes.
pub(crate) fn quoted(text: &str) -> String {
    let mut quoted = String::from("\"");
    for letter in text.chars() {
        match letter {
            '"' => quoted.push_str("\\\""),
            '\\' => quoted.push_str("\\\\"),
            letter if letter.is_control() => quoted.push_str(&format!("\\u{:04X}", letter as u32)),
            letter => quoted.push(letter),
        }
    }
    quoted.push('"');
    quoted
}

/// A name as a key.
pub(crate) fn key(name: &str) -> String {
    let is_bare = |letter: char| letter.is_ascii_alphanumeric() || "_-".contains(letter);
    if !name.is_empty() && name.chars().all(is_bare) { name.to_owned() } else { quoted(name) }
}

/// Words for a comment, on one line.
pub(crate) fn plain(text: &str) -> String {
    text.chars().map(|letter| if letter.is_control() { ' ' } else { letter }).collect()
}

/// A line with a comment behind it, from the same column on where it fits.
pub(crate) fn commented(line: &str, comment: &str) -> String {
    const COLUMN: usize = 39;
    if comment.is_empty() {
        return format!("{line}\n");
    }
    format!("{line:<COLUMN$} # {}\n", plain(comment))
}

/// `key = [items]`: on one line, or on lines of as many items as fit.
pub(crate) fn list(key: &str, items: &[String]) -> String {
    let one_line = format!("{key} = [{}]", items.join(", "));
    if one_line.chars().count() <= LINE_MAX {
        return one_line + "\n";
    }
    format!("{key} = [\n{}]\n", packed(items, 4))
}

/// Items with commas, as many on each indented line as fit.
pub(crate) fn packed(items: &[String], indent: usize) -> String {
    let mut text = String::new();
    let mut line = String::new();
    for item in items {
        if !line.is_empty() && indent + line.chars().count() + item.chars().count() + 2 > LINE_MAX {
            text += &format!("{:indent$}{}\n", "", line.trim_end());
            line.clear();
        }
        line += &format!("{item}, ");
    }
    text + &format!("{:indent$}{}\n", "", line.trim_end())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn numbers_are_short() {
        for (value, text) in
            [(1.333, "1.333"), (-4.5, "-4.5"), (6.0, "6"), (-0.0, "0"), (1e-9, "0"), (22.041396, "22.041396")]
        {
            assert_eq!(number(value), text);
        }
    }

    #[test]
    fn names_are_quoted_where_needed() {
        assert_eq!(key("Walk_2"), "Walk_2");
        assert_eq!(key("to the \"bar\"\n"), "\"to the \\\"bar\\\"\\u000A\"");
    }

    #[test]
    fn long_lists_break() {
        let items: Vec<String> = (0..40).map(|index| format!("[{index}, {index}]")).collect();
        let text = list("polygon_m", &items);
        assert!(text.lines().count() > 3 && text.lines().all(|line| line.len() <= LINE_MAX), "{text}");
    }
}

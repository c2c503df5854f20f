//! `schedule_file` of a source: the rows of a schedule in a CSV file beside the scenario. Seconds.
//!
//! A line is a row: `time_s,count`, or `from_s,to_s,rate_per_s`. The first line may be a header of these names. `#`
//! begins a comment. The lengths of the file and of its lines are limited before it is read.

use std::io::ErrorKind;
use std::ops::Range;
use std::path::{Component, Path, PathBuf};

use motiondb::files::{Invalid, SourceText, input_file};
use toml::Spanned;

use crate::scenario::error::ScenarioError;
use crate::scenario::file::sources::schedule_value::schedule;
use crate::scenario::rules::schedule_check::ROWS_MAX;
use crate::scenario::schedule::Schedule;

/// First lines that name the columns.
const HEADERS: [&[&str]; 2] = [&["time_s", "count"], &["from_s", "to_s", "rate_per_s"]];
/// Greatest number of words that are read of a line: more than a row has.
const WORDS_MAX: usize = 5;
/// How to write a line.
const LINES: &str = "write lines `time_s,count`, or lines `from_s,to_s,rate_per_s`, with decimal points";

/// The path of a schedule file; none where it leads out of the scenario's folder.
pub(crate) fn schedule_path(source: &SourceText, name: &str) -> Option<PathBuf> {
    let is_inside = |part| matches!(part, Component::Normal(_) | Component::CurDir);
    Path::new(name).components().all(is_inside).then(|| source.beside(Path::new(name)))
}

/// The schedule of a file; a mistake is shown at its line.
pub(super) fn read_schedule(source: &SourceText, name: &Spanned<String>) -> Result<Schedule, ScenarioError> {
    let at_name = |message, help| ScenarioError::from(source.invalid(name.span(), message, help));
    let path = schedule_path(source, name.get_ref()).ok_or_else(|| {
        let message = format!("`{}` leads out of the scenario's folder", name.get_ref());
        at_name(message, "keep the file in that folder or below it, and give its path from there")
    })?;
    let text = SourceText::read(&path).map_err(|error| {
        if input_file::is_of_machine(&error) {
            return ScenarioError::Unreadable { path: path.clone(), source: error };
        }
        let message = match error.kind() {
            ErrorKind::NotFound => format!("{} does not exist", path.display()),
            _ => format!("{} cannot be read: {error}", path.display()),
        };
        at_name(message, "give a path relative to the scenario file")
    })?;
    schedule_of(&text).map_err(ScenarioError::from)
}

/// The schedule of a text.
fn schedule_of(text: &SourceText) -> Result<Schedule, Invalid> {
    let (mut rows, mut spans): (Vec<Vec<f32>>, Vec<Range<usize>>) = Default::default();
    for (index, (span, line)) in lines(&text.text).enumerate() {
        let words: Vec<&str> = line.splitn(WORDS_MAX, ',').map(str::trim).collect();
        if index == 0 && HEADERS.contains(&words.as_slice()) {
            continue;
        }
        if rows.len() == ROWS_MAX {
            let message = format!("with this line the schedule has more than {ROWS_MAX} rows");
            return Err(text.invalid(span, message, "write rates for longer times, or use several sources"));
        }
        // Any other text than rows is not shown.
        let is_quotable = !rows.is_empty();
        rows.push(numbers(&words).map_err(|word| {
            let message = if is_quotable { format!("`{word}` is not a number") } else { "this is no row".to_owned() };
            Invalid { is_quotable, ..text.invalid(span.clone(), message, LINES) }
        })?);
        spans.push(span);
    }
    if rows.is_empty() {
        return Err(text.invalid(0..0, "the file has no rows", LINES));
    }
    let rows: Vec<&[f32]> = rows.iter().map(Vec::as_slice).collect();
    schedule(&rows).map_err(|(row, (message, help))| text.invalid(spans[row].clone(), message, help))
}

/// The numbers of a line, or the first word that is none.
fn numbers<'a>(words: &[&'a str]) -> Result<Vec<f32>, &'a str> {
    words.iter().map(|word| word.parse().map_err(|_| *word)).collect()
}

/// Each line that holds more than a comment: its bytes and its content.
fn lines(text: &str) -> impl Iterator<Item = (Range<usize>, &str)> {
    let mut end = 0;
    let lines = text.split_inclusive('\n').map(move |line| {
        let begin = end;
        end += line.len();
        let content = line.split('#').next().unwrap_or_default().trim();
        (begin..begin + line.trim_end().len(), content)
    });
    lines.filter(|(_, content)| !content.is_empty())
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::scenario::schedule::TimeRow;

    fn read(text: &str) -> Result<Schedule, String> {
        let source = SourceText { path: "trains.csv".into(), text: text.to_owned() };
        schedule_of(&source).map_err(|mistake| mistake.to_string())
    }

    #[test]
    fn headers_comments_and_line_ends_are_read() {
        let row = |time_s, count| TimeRow { time_s, count };
        let expected = Ok(Schedule::Times(vec![row(0.0, 2), row(7.5, 30)]));
        assert_eq!(read("time_s,count\n0,2\n7.5,30\n"), expected);
        assert_eq!(read("# trains\r\n\r\ntime_s, count\r\n0, 2 # the first\r\n7.5, 30"), expected);
        assert!(
            matches!(read("from_s,to_s,rate_per_s\n0,2,1\n2,4,0.5\n"), Ok(Schedule::Rates(rows)) if rows.len() == 2)
        );
    }

    #[test]
    fn a_mistake_is_shown_at_its_line() {
        for (text, part) in [
            ("time_s,count\n0,2\n7,many\n", "trains.csv:3: `many` is not a number"),
            ("0,2\n7,1\n6,1\n", "trains.csv:3: the row is at 6 s, after one at 7 s"),
            ("0,2\n7,1.5\n", "trains.csv:2: 1.5 is no number of agents"),
            ("0,2\n7,1,3\n", "trains.csv:2: the row has 3 numbers, but the first row has 2"),
            ("0,2\n7,\n", "trains.csv:2: `` is not a number"),
            ("0;2\n7;1\n", "trains.csv:1: this is no row"),
            ("0,5,inf\n", "trains.csv:1: the rate is inf"),
            ("# nothing\n", "trains.csv:1: the file has no rows"),
            ("time_s,count\ntime_s,count\n", "trains.csv:2: this is no row"),
        ] {
            let message = read(text).expect_err(text);
            assert!(message.contains(part), "{message}");
        }
        let message = read(&"1,1\n".repeat(ROWS_MAX + 1)).expect_err("too many");
        assert!(message.contains("trains.csv:10001: with this line"), "{message}");
    }

    #[test]
    fn other_files_are_not_quoted() {
        let source = SourceText { path: "key.pem".into(), text: "secret\n1,2\n".to_owned() };
        let mistake = schedule_of(&source).expect_err("no rows");
        assert!(!mistake.is_quotable && !mistake.message.contains("secret"));
    }
}

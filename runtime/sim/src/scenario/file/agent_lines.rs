//! Agent files: lines `x y goal_x goal_y` in metres, one agent each; `#` begins a comment. Where agents have a state,
//! lines `x y` are enough.
//!
//! A file is read line by line. Its length, the length of its lines and the number of its agents are limited, so the
//! memory that a file takes is limited too.

use std::io::{self, BufRead, BufReader, ErrorKind, Read};
use std::ops::Range;
use std::path::Path;

use glam::Vec2;
use motiondb::files::{SourceText, input_file};

use crate::scenario::file::agent_groups::Journey;
use crate::scenario::ranges::{AGENTS_MAX, COORDINATE_MAX_M};

/// Greatest length of a line, bytes: four numbers of twenty digits, and a long comment.
const LINE_MAX_BYTES: u64 = 4096;
/// Greatest length of the agent files of a scenario together, bytes: 64 for each of a million agents.
const TEXT_MAX_BYTES: usize = 64 << 20;

/// What the agent files of a scenario may still hold.
#[derive(Clone, Copy)]
pub(crate) struct LineRoom {
    /// Number of agents.
    pub(crate) agents: usize,
    /// Bytes that the files before took.
    pub(crate) used_bytes: usize,
    /// Whether lines may state no goal.
    pub(crate) without_goals: bool,
}

/// An agent file as far as it was read.
pub(crate) struct AgentLines {
    /// The lines, the first wrong one included.
    pub(crate) source: SourceText,
    /// The journeys of all lines, or the bytes of the first wrong line and what is wrong with it.
    pub(crate) journeys: Result<Vec<Journey>, (Range<usize>, String)>,
}

impl AgentLines {
    /// Reads an agent file up to its end, its first wrong line or the first agent that has no room.
    ///
    /// # Errors
    /// Where the system cannot read it, or it is not text in UTF-8.
    pub(crate) fn read(path: &Path, room: LineRoom) -> io::Result<Self> {
        let mut reader = BufReader::new(input_file::open(path)?);
        let (mut text, mut journeys) = (String::new(), Vec::new());
        let mut bytes = Vec::new();
        for number in 1.. {
            bytes.clear();
            if reader.by_ref().take(LINE_MAX_BYTES + 1).read_until(b'\n', &mut bytes)? == 0 {
                break;
            }
            let begin = text.len();
            text.push_str(line_text(&bytes, number)?);
            let span = begin..begin + text[begin..].trim_end().len();
            let wrong = if bytes.len() as u64 > LINE_MAX_BYTES {
                Some(format!("the line is longer than {LINE_MAX_BYTES} bytes"))
            } else if text.len() > TEXT_MAX_BYTES.saturating_sub(room.used_bytes) {
                Some(format!("up to here the agent files are longer than {} MiB", TEXT_MAX_BYTES >> 20))
            } else {
                push_journey(&mut journeys, content(&text[begin..]), room).err()
            };
            if let Some(wrong) = wrong {
                let source = SourceText { path: path.to_owned(), text };
                return Ok(Self { source, journeys: Err((span, wrong)) });
            }
        }
        Ok(Self { source: SourceText { path: path.to_owned(), text }, journeys: Ok(journeys) })
    }
}

/// The text of a line's bytes, without the byte order mark of the first line.
fn line_text(bytes: &[u8], number: usize) -> io::Result<&str> {
    let invalid = |message: String| io::Error::new(ErrorKind::InvalidData, message);
    if number == 1 && input_file::is_utf16(bytes) {
        return Err(invalid("the text is UTF-16, two bytes a letter".into()));
    }
    if bytes.contains(&0) {
        return Err(invalid(format!("line {number} holds a zero byte, so this is no text")));
    }
    let text = match str::from_utf8(bytes) {
        Ok(text) => text,
        // A line that is too long may end within a letter.
        Err(error) if error.error_len().is_none() && bytes.len() as u64 > LINE_MAX_BYTES => {
            str::from_utf8(&bytes[..error.valid_up_to()]).unwrap_or_default()
        }
        Err(_) => return Err(invalid(format!("line {number} is not UTF-8"))),
    };
    Ok(if number == 1 { text.strip_prefix('\u{feff}').unwrap_or(text) } else { text })
}

fn push_journey(journeys: &mut Vec<Journey>, content: &str, room: LineRoom) -> Result<(), String> {
    if content.is_empty() {
        return Ok(());
    }
    journeys.push(parse_line(content, room.without_goals)?);
    if journeys.len() > room.agents {
        return Err(format!("with this line the scenario has more than {AGENTS_MAX} agents"));
    }
    Ok(())
}

/// The journeys of all lines of a text.
///
/// # Errors
/// The bytes of the first line that is not valid, and what is wrong with it.
pub(crate) fn parse_lines(text: &str) -> Result<Vec<Journey>, (Range<usize>, String)> {
    lines(text).map(|(span, content)| parse_line(content, false).map_err(|message| (span, message))).collect()
}

/// Whether the first line is an agent's. Any other text is no agent file, and no message quotes it.
pub(crate) fn is_agent_file(text: &str) -> bool {
    lines(text).next().is_some_and(|(_, content)| parse_line(content, true).is_ok())
}

/// The bytes of an agent's line.
pub(crate) fn line_span(text: &str, agent: usize) -> Range<usize> {
    lines(text).nth(agent).map_or(0..0, |(span, _)| span)
}

/// Each line that holds more than a comment: its bytes and its content.
fn lines(text: &str) -> impl Iterator<Item = (Range<usize>, &str)> {
    let mut end = 0;
    let lines = text.split_inclusive('\n').map(move |line| {
        let begin = end;
        end += line.len();
        (begin..begin + line.trim_end().len(), content(line))
    });
    lines.filter(|(_, content)| !content.is_empty())
}

/// A line without its comment.
fn content(line: &str) -> &str {
    line.split('#').next().unwrap_or_default().trim()
}

fn parse_line(content: &str, without_goals: bool) -> Result<Journey, String> {
    let number = |word: &str| match word.parse::<f32>() {
        Ok(metres) if metres.abs() <= COORDINATE_MAX_M => Ok(metres),
        Ok(_) => Err(format!("`{word}` is not within 10 km of the origin")),
        Err(_) => Err(format!("`{word}` is not a number")),
    };
    let numbers = content.split_whitespace().map(number).collect::<Result<Vec<f32>, String>>()?;
    match numbers[..] {
        [x, y, goal_x, goal_y] => Ok((Vec2::new(x, y), vec![Vec2::new(goal_x, goal_y)])),
        [x, y] if without_goals => Ok((Vec2::new(x, y), Vec::new())),
        [_, _] => Err("the line states no goal, and the agents have no `state`".to_owned()),
        _ => Err(format!("the line has {} numbers, not the four of `x y goal_x goal_y`", numbers.len())),
    }
}

//! Agent files: lines `x y goal_x goal_y` in metres, one agent each; `#` begins a comment.

use std::ops::Range;

use glam::Vec2;

use crate::scenario::file::agent_groups::Journey;
use crate::scenario::ranges::COORDINATE_MAX_M;

/// The journeys of all lines.
///
/// # Errors
/// The bytes of the first line that is not valid, and what is wrong with it.
pub(crate) fn parse_lines(text: &str) -> Result<Vec<Journey>, (Range<usize>, String)> {
    lines(text).map(|(span, content)| parse_line(content).map_err(|message| (span, message))).collect()
}

/// Whether the first line is an agent's. Any other text is no agent file, and no message quotes it.
pub(crate) fn is_agent_file(text: &str) -> bool {
    lines(text).next().is_some_and(|(_, content)| parse_line(content).is_ok())
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
        (begin..begin + line.trim_end().len(), line.split('#').next().unwrap_or_default().trim())
    });
    lines.filter(|(_, content)| !content.is_empty())
}

fn parse_line(content: &str) -> Result<Journey, String> {
    let number = |word: &str| match word.parse::<f32>() {
        Ok(metres) if metres.abs() <= COORDINATE_MAX_M => Ok(metres),
        Ok(_) => Err(format!("`{word}` is not within 10 km of the origin")),
        Err(_) => Err(format!("`{word}` is not a number")),
    };
    let numbers = content.split_whitespace().map(number).collect::<Result<Vec<f32>, String>>()?;
    match numbers[..] {
        [x, y, goal_x, goal_y] => Ok((Vec2::new(x, y), vec![Vec2::new(goal_x, goal_y)])),
        _ => Err(format!("the line has {} numbers, not the four of `x y goal_x goal_y`", numbers.len())),
    }
}

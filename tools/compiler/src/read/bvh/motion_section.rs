//! The MOTION section of a BVH text: frame time and rows of numbers, each row as long as the hierarchy has channels.

use std::ops::RangeInclusive;

use motiondb::diagnostic::{Diagnostic, Note, Warning};

use crate::error::RejectionReason;
use crate::read::bvh::hierarchy::CheckedJoint;
use crate::read::bvh::lines::{number, number_remedy, quoted};
use crate::read::decimal;
use crate::read::malformed::malformed_line;

/// Greatest number of joint-frames for each number of the section, so that memory stays proportional to the file. A
/// joint has at least one channel in practice; end sites add a third.
const MAX_JOINT_FRAMES_PER_VALUE: usize = 4;
/// Accepted frame times, s: from the fastest motion capture to a frame a second, which shows no gait.
const FRAME_TIME_S: RangeInclusive<f64> = 1e-3..=1.0;

/// A checked MOTION section.
#[derive(Debug)]
pub(crate) struct MotionSection {
    /// Time between two frames, s.
    pub frame_time_s: f64,
    /// All rows, one after the other; a row holds the joints' channels in the order of the hierarchy.
    pub values: Vec<f64>,
    /// Number of rows, at least one.
    pub rows: usize,
}

/// Reads the section. `lines` begin after the line that holds `MOTION`, which is `motion_line`.
pub(crate) fn checked_motion<'a>(
    mut lines: impl Iterator<Item = (usize, &'a str)>,
    motion_line: usize,
    joints: &[CheckedJoint],
    diagnostics: &mut Vec<Diagnostic>,
) -> Result<MotionSection, RejectionReason> {
    let (_, stated_frames) = header(lines.next(), motion_line, &["FRAMES"])?;
    let (line, frame_time_s) = header(lines.next(), motion_line, &["FRAME", "TIME"])?;
    if !FRAME_TIME_S.contains(&frame_time_s) {
        let [least, greatest] = [FRAME_TIME_S.start(), FRAME_TIME_S.end()];
        let problem = format!("Frame Time is {frame_time_s} s, not between {least} and {greatest}");
        return malformed_line(line, problem, "write the seconds between two frames");
    }
    let channel_count: usize = joints.iter().map(|joint| joint.channels.len()).sum();
    let values = row_values(lines, channel_count, stated_frames, diagnostics)?;
    let row_count = values.len().checked_div(channel_count).unwrap_or(0);
    if row_count == 0 {
        return malformed_line(motion_line, "there is not one whole row of motion", "export the clip with its motion");
    }
    if joints.len() * row_count > MAX_JOINT_FRAMES_PER_VALUE * values.len() {
        return malformed_line(motion_line, "most joints have no channels", "export a skeleton whose joints move");
    }
    if row_count as f64 != stated_frames {
        let wrong = Warning::FrameCountWrong { stated: stated_frames, rows: row_count as u32 };
        diagnostics.push(Diagnostic::Warning(wrong));
    }
    Ok(MotionSection { frame_time_s, values, rows: row_count })
}

/// Line and number of a header such as `Frames: 12`, `Frame Time:<tab>0.03` or `Frames :12`.
fn header(line: Option<(usize, &str)>, motion_line: usize, words: &[&str]) -> Result<(usize, f64), RejectionReason> {
    let remedy = "after MOTION come `Frames: N` and `Frame Time: seconds`";
    let Some((line, text)) = line else { return malformed_line(motion_line, "the motion section is empty", remedy) };
    let missing = || malformed_line(line, format!("`{}:` is missing", words.join(" ")), remedy);
    let Some((head, value)) = text.split_once(':') else { return missing() };
    if !head.split_whitespace().map(str::to_ascii_uppercase).eq(words.iter().copied()) {
        return missing();
    }
    match value.trim().parse::<f64>() {
        Ok(value) if value.is_finite() => Ok((line, value)),
        _ => {
            let problem = format!("`{}` is not a number", quoted(value.trim()));
            malformed_line(line, problem, number_remedy(value, remedy))
        }
    }
}

/// All values of whole rows.
///
/// Two deviations are noted and left out: a last row that is cut short, and text after the stated number of rows, which
/// editors and exporters append. A row of another length is an error.
fn row_values<'a>(
    lines: impl Iterator<Item = (usize, &'a str)>,
    channels: usize,
    stated_frames: f64,
    diagnostics: &mut Vec<Diagnostic>,
) -> Result<Vec<f64>, RejectionReason> {
    let mut values = Vec::new();
    let mut lines = lines.peekable();
    while let Some((line, text)) = lines.next() {
        let before = values.len();
        let is_complete = before > 0 && before as f64 >= stated_frames * channels as f64;
        if is_complete && text.split_ascii_whitespace().next().is_some_and(|word| decimal::number(word).is_none()) {
            diagnostics.push(Diagnostic::Note(Note::TextAfterMotion { line: line as u32 }));
            break;
        }
        for word in text.split_ascii_whitespace() {
            values.push(number(line, word)?);
        }
        let found = values.len() - before;
        if found < channels && before > 0 && lines.peek().is_none() {
            values.truncate(before);
            diagnostics.push(Diagnostic::Note(Note::LastRowIncomplete { line: line as u32 }));
        } else if found != channels {
            let problem = format!("a row of {found} values where the hierarchy has {channels} channels");
            return malformed_line(line, problem, "write one row for each frame");
        }
    }
    Ok(values)
}

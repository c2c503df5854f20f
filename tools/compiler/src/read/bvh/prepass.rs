//! Reads a BVH text strictly: the motion's numbers at once, the hierarchy (`hierarchy`) into a canonical one for
//! `bvh_anim`.
//!
//! `bvh_anim` cuts joint names at blanks and colons, drops leaves without an End Site, panics on a BOM or a nameless
//! joint and allocates whatever `Frames:` claims. Here every statement is checked first; joints are renamed `j0`, `j1`
//! … (the real names are kept), every leaf gets an End Site, and nothing is larger than the bytes of the file pay for.
//! Its numbers are f32, and it would read each a second time: those are kept as they are checked.

use std::fmt::Write as _;

use motiondb::diagnostic::{Diagnostic, Note, Warning};
use motiondb::files::input_file;

use crate::read::bvh::hierarchy::{CheckedJoint, canonical, hierarchy};
use crate::read::decimal;

/// Joint-frames for each number of the motion section. A joint has at least one channel in practice, end sites add one
/// in three; this keeps the decoded clip proportional to the file.
const MAX_JOINT_FRAMES_PER_VALUE: usize = 4;
/// From the fastest motion capture to where no gait is left between two frames.
const FRAME_TIME_S: std::ops::RangeInclusive<f64> = 1e-3..=1.0;
/// Largest magnitude of any number: a kilometre in hundredths of a millimetre.
const MAX_VALUE: f64 = 1e8;

/// A checked BVH.
#[derive(Debug)]
pub(crate) struct CheckedBvh {
    /// The canonical hierarchy.
    pub hierarchy: String,
    /// Joints and end sites in file order; joint `j<N>` of the text is the N-th that is no end site.
    pub joints: Vec<CheckedJoint>,
    /// The motion section.
    pub motion: Motion,
    /// Wrong counts, and what is not used.
    pub diagnostics: Vec<Diagnostic>,
}

/// What is wrong, and where.
#[derive(Debug)]
pub(crate) struct Flaw {
    /// From 1.
    pub line: usize,
    /// The problem.
    pub problem: String,
    /// The way out.
    pub remedy: &'static str,
}

pub(crate) fn flaw<T>(line: usize, problem: impl Into<String>, remedy: &'static str) -> Result<T, Flaw> {
    Err(Flaw { line, problem: problem.into(), remedy })
}

/// Checks the bytes of a BVH file and rewrites them canonically.
pub(crate) fn check(bytes: &[u8]) -> Result<CheckedBvh, Flaw> {
    if bytes.is_empty() {
        return flaw(1, "the file is empty", "export the clip again");
    }
    if input_file::is_utf16(bytes) {
        return flaw(1, "the text is UTF-16, two bytes a letter", "save it as UTF-8 or plain ASCII");
    }
    let text = String::from_utf8_lossy(bytes.strip_prefix(b"\xef\xbb\xbf").unwrap_or(bytes));
    let mut lines = numbered_lines(&text);
    let (joints, motion_line) = hierarchy(&mut lines)?;
    let mut diagnostics = Vec::new();
    let motion = motion(lines, motion_line, &joints, &mut diagnostics)?;
    Ok(CheckedBvh { hierarchy: canonical(&joints), joints, motion, diagnostics })
}

impl CheckedBvh {
    /// The canonical text of the first frames.
    pub(crate) fn text(&self, frames: usize) -> String {
        let Motion { frame_time_s, values, rows } = &self.motion;
        let frames = frames.min(*rows);
        let mut text = format!("{}MOTION\nFrames: {frames}\nFrame Time: {frame_time_s}\n", self.hierarchy);
        for row in values.chunks(values.len() / rows).take(frames) {
            for value in row {
                let _ = write!(text, "{value} ");
            }
            text.push('\n');
        }
        text
    }
}

/// The lines that are not blank, with their numbers from 1; LF, CRLF and bare CR all end a line.
fn numbered_lines(text: &str) -> impl Iterator<Item = (usize, &str)> {
    let lines = text.split('\n').flat_map(|line| line.strip_suffix('\r').unwrap_or(line).split('\r'));
    (1..).zip(lines.map(str::trim)).filter(|(_, line)| !line.is_empty())
}

pub(crate) fn number(line: usize, word: &str) -> Result<f64, Flaw> {
    match decimal::number(word) {
        Some(value) if value.abs() <= MAX_VALUE => Ok(value),
        _ => flaw(
            line,
            format!("`{}` is not a finite, sensible number", shown(word)),
            remedy_of(word, "repair the value"),
        ),
    }
}

/// What to do about what is no number; programs that write as their user's language does set commas.
fn remedy_of(word: &str, otherwise: &'static str) -> &'static str {
    if word.contains(',') { "write numbers with points, not commas" } else { otherwise }
}

/// A word of the file, short enough for a message.
pub(crate) fn shown(word: &str) -> String {
    word.chars().take(40).collect()
}

/// The motion section.
#[derive(Debug)]
pub(crate) struct Motion {
    /// Seconds.
    pub frame_time_s: f64,
    /// Row by row, in the order of the joints' channels.
    pub values: Vec<f64>,
    /// At least one.
    pub rows: usize,
}

fn motion<'a>(
    mut lines: impl Iterator<Item = (usize, &'a str)>,
    motion_line: usize,
    joints: &[CheckedJoint],
    diagnostics: &mut Vec<Diagnostic>,
) -> Result<Motion, Flaw> {
    let (_, claimed) = header(lines.next(), motion_line, &["FRAMES"])?;
    let (line, frame_time_s) = header(lines.next(), motion_line, &["FRAME", "TIME"])?;
    if !FRAME_TIME_S.contains(&frame_time_s) {
        let [least, greatest] = [FRAME_TIME_S.start(), FRAME_TIME_S.end()];
        let problem = format!("Frame Time is {frame_time_s} s, not between {least} and {greatest}");
        return flaw(line, problem, "write the seconds between two frames");
    }
    let channel_count: usize = joints.iter().map(|joint| joint.channels.len()).sum();
    let values = row_values(lines, channel_count, claimed, diagnostics)?;
    let row_count = values.len().checked_div(channel_count).unwrap_or(0);
    if row_count == 0 {
        return flaw(motion_line, "there is not one whole row of motion", "export the clip with its motion");
    }
    if joints.len() * row_count > MAX_JOINT_FRAMES_PER_VALUE * values.len() {
        return flaw(motion_line, "most joints have no channels", "export a skeleton whose joints move");
    }
    if row_count as f64 != claimed {
        let wrong = Warning::FrameCountWrong { stated: claimed, rows: row_count as u32 };
        diagnostics.push(Diagnostic::Warning(wrong));
    }
    Ok(Motion { frame_time_s, values, rows: row_count })
}

/// `Frames: 12`, `Frame Time:<tab>0.03`, `Frames :12`: the words up to the colon, then a number; with its line.
fn header(line: Option<(usize, &str)>, motion_line: usize, words: &[&str]) -> Result<(usize, f64), Flaw> {
    let remedy = "after MOTION come `Frames: N` and `Frame Time: seconds`";
    let Some((line, text)) = line else { return flaw(motion_line, "the motion section is empty", remedy) };
    let Some((head, value)) = text.split_once(':') else {
        return flaw(line, format!("`{}:` is missing", words.join(" ")), remedy);
    };
    let found = head.split_whitespace().map(str::to_ascii_uppercase);
    if !found.eq(words.iter().copied()) {
        return flaw(line, format!("`{}:` is missing", words.join(" ")), remedy);
    }
    match value.trim().parse::<f64>() {
        Ok(value) if value.is_finite() => Ok((line, value)),
        _ => flaw(line, format!("`{}` is not a number", shown(value.trim())), remedy_of(value, remedy)),
    }
}

/// All values, whole rows only: a last row cut short is dropped with a note, as are words after the `claimed` rows
/// (what editors and exporters leave at the end); any other odd row is an error.
fn row_values<'a>(
    lines: impl Iterator<Item = (usize, &'a str)>,
    channels: usize,
    claimed: f64,
    diagnostics: &mut Vec<Diagnostic>,
) -> Result<Vec<f64>, Flaw> {
    let mut values = Vec::new();
    let mut lines = lines.peekable();
    while let Some((line, text)) = lines.next() {
        let before = values.len();
        let is_complete = before > 0 && before as f64 >= claimed * channels as f64;
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
            return flaw(line, problem, "one row holds one frame");
        }
    }
    Ok(values)
}

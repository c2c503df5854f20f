//! The MOTION section of a BVH text: frame time and rows of numbers, each row as long as the hierarchy has channels.

use std::io::BufRead;
use std::ops::RangeInclusive;

use motiondb::diagnostic::{Diagnostic, Note, Warning};

use crate::error::RejectionReason;
use crate::read::bvh::hierarchy::CheckedJoint;
use crate::read::bvh::lines::{LINE_MAX_BYTES, TextLine, TextLines, number, number_remedy, quoted};
use crate::read::decimal;
use crate::read::malformed::malformed_line;
use crate::read::source_clip::{MAX_FRAMES, MAX_JOINT_FRAMES};

/// Greatest number of joint-frames for each number of the section, so that memory stays proportional to the file. A
/// joint has at least one channel in practice; end sites add a third.
const MAX_JOINT_FRAMES_PER_VALUE: usize = 4;
/// Greatest number of values of a section, 480 MB: three for each joint-frame.
const MAX_VALUES: usize = 3 * MAX_JOINT_FRAMES;
/// Number of values in a block, 40 MB: the allocator returns so large a block to the system when it is freed.
const BLOCK_VALUES: usize = 5_000_000;
/// Accepted frame times, s: from the fastest motion capture to a frame a second, which shows no gait.
const FRAME_TIME_S: RangeInclusive<f64> = 1e-3..=1.0;

/// A checked MOTION section.
#[derive(Debug)]
pub(crate) struct MotionSection {
    /// Time between two frames, s.
    pub frame_time_s: f64,
    /// All rows, one after the other, in blocks of equally many, so that the clip's poses can replace them one by one. A
    /// row holds the joints' channels in the order of the hierarchy.
    blocks: Vec<Vec<f64>>,
    /// Number of values in a row.
    pub channels: usize,
    /// Number of rows, at least one.
    pub row_count: usize,
}

impl MotionSection {
    /// All rows in order.
    pub(crate) fn rows(&self) -> impl Iterator<Item = &[f64]> {
        self.blocks.iter().flat_map(|block| block.chunks_exact(self.channels))
    }

    /// One row.
    pub(crate) fn row(&self, row: usize) -> &[f64] {
        let rows = rows_per_block(self.channels);
        let start = row % rows * self.channels;
        &self.blocks[row / rows][start..start + self.channels]
    }

    /// Frees the blocks that hold only rows before this one.
    pub(crate) fn free_before(&mut self, row: usize) {
        let rows = rows_per_block(self.channels);
        if row.is_multiple_of(rows) {
            self.blocks[..row / rows].iter_mut().for_each(|block| *block = Vec::new());
        }
    }
}

/// Reads the section. `lines` begin after the line that holds `MOTION`, which is `motion_line`.
pub(crate) fn checked_motion<R: BufRead>(
    lines: &mut TextLines<R>,
    motion_line: usize,
    joints: &[CheckedJoint],
    diagnostics: &mut Vec<Diagnostic>,
) -> Result<MotionSection, RejectionReason> {
    let (_, stated_frames) = header(lines.next_statement()?, motion_line, &["Frames"])?;
    let (line, frame_time_s) = header(lines.next_statement()?, motion_line, &["Frame", "Time"])?;
    if !FRAME_TIME_S.contains(&frame_time_s) {
        let [least, greatest] = [FRAME_TIME_S.start(), FRAME_TIME_S.end()];
        let problem = format!("Frame Time is {frame_time_s} s, not between {least} and {greatest}");
        return malformed_line(line, problem, "write the seconds between two frames");
    }
    let channels: usize = joints.iter().map(|joint| joint.channels.len()).sum();
    let mut rows = RowReader { channels, most: most_rows(joints.len(), channels), stated_frames, blocks: Vec::new() };
    rows.read(lines, diagnostics)?;
    let row_count = rows.count();
    if row_count == 0 {
        return malformed_line(motion_line, "there is not one whole row of motion", "export the clip with its motion");
    }
    if joints.len() > MAX_JOINT_FRAMES_PER_VALUE * channels {
        return malformed_line(motion_line, "most joints have no channels", "export a skeleton whose joints move");
    }
    if row_count as f64 != stated_frames {
        let wrong = Warning::FrameCountWrong { stated: stated_frames, rows: row_count as u32 };
        diagnostics.push(Diagnostic::Warning(wrong));
    }
    Ok(MotionSection { frame_time_s, blocks: rows.blocks, channels, row_count })
}

/// Number of rows in a block.
fn rows_per_block(channels: usize) -> usize {
    (BLOCK_VALUES / channels.max(1)).max(1)
}

/// Greatest number of rows.
fn most_rows(joints: usize, channels: usize) -> usize {
    MAX_FRAMES.min(MAX_JOINT_FRAMES / joints.max(1)).min(MAX_VALUES / channels.max(1))
}

/// Line and number of a header such as `Frames: 12`, `Frame Time:<tab>0.03` or `Frames :12`.
fn header(line: Option<TextLine>, motion_line: usize, words: &[&str]) -> Result<(usize, f64), RejectionReason> {
    let remedy = "after MOTION come `Frames: N` and `Frame Time: seconds`";
    let Some(line) = line else { return malformed_line(motion_line, "the motion section is empty", remedy) };
    line.check_length(LINE_MAX_BYTES)?;
    let (line, text) = (line.number, line.text());
    let missing = || malformed_line(line, format!("`{}:` is missing", words.join(" ")), remedy);
    let Some((head, value)) = text.split_once(':') else { return missing() };
    let lower = |word: &str| word.to_ascii_lowercase();
    if !head.split_whitespace().map(lower).eq(words.iter().copied().map(lower)) {
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

/// The rows so far.
struct RowReader {
    /// Number of values in a row.
    channels: usize,
    /// Greatest number of rows.
    most: usize,
    /// Number of rows that the header states.
    stated_frames: f64,
    blocks: Vec<Vec<f64>>,
}

impl RowReader {
    /// Reads all rows.
    ///
    /// Two deviations are noted and left out: a last row that is cut short, and text after the stated number of rows,
    /// which editors and exporters append. A row of another length is an error.
    fn read<R: BufRead>(
        &mut self,
        lines: &mut TextLines<R>,
        diagnostics: &mut Vec<Diagnostic>,
    ) -> Result<(), RejectionReason> {
        let mut count = 0;
        while let Some(line) = lines.next()? {
            let is_complete = count > 0 && count as f64 >= self.stated_frames;
            let first = line.text().split_ascii_whitespace().next();
            if is_complete && first.is_some_and(|word| decimal::number(word).is_none()) {
                diagnostics.push(Diagnostic::Note(Note::TextAfterMotion { line: line.number as u32 }));
                return Ok(());
            }
            line.check_length(LINE_MAX_BYTES)?;
            if count == self.most {
                let problem = format!("more than {} frames of this skeleton", self.most);
                return malformed_line(line.number, problem, "cut the clip into shorter ones");
            }
            let found = self.push_row(&line)?;
            let line = line.number;
            if found < self.channels && count > 0 && lines.next()?.is_none() {
                self.drop_last(found);
                diagnostics.push(Diagnostic::Note(Note::LastRowIncomplete { line: line as u32 }));
                return Ok(());
            } else if found != self.channels {
                let problem = format!("a row of {found} values where the hierarchy has {} channels", self.channels);
                return malformed_line(line, problem, "write one row for each frame");
            }
            count += usize::from(self.channels > 0);
        }
        Ok(())
    }

    /// Appends the values of a line; returns their number.
    fn push_row(&mut self, line: &TextLine) -> Result<usize, RejectionReason> {
        let most = rows_per_block(self.channels) * self.channels;
        if self.blocks.last().is_none_or(|block| block.len() >= most) {
            self.blocks.push(Vec::new());
        }
        let Some(block) = self.blocks.last_mut() else { return Ok(0) };
        let before = block.len();
        for word in line.text().split_ascii_whitespace() {
            block.push(number(line.number, word)?);
        }
        Ok(block.len() - before)
    }

    fn drop_last(&mut self, values: usize) {
        if let Some(block) = self.blocks.last_mut() {
            block.truncate(block.len() - values);
        }
    }

    fn count(&self) -> usize {
        let values: usize = self.blocks.iter().map(Vec::len).sum();
        values.checked_div(self.channels).unwrap_or(0)
    }
}

#[cfg(test)]
mod tests {
    use std::io::{BufReader, Cursor, Read, repeat};

    use crate::read::bvh::prepass;

    const HEAD: &str = "HIERARCHY\nROOT Hips\n{\nOFFSET 0 0 0\nCHANNELS 1 Xposition\n}\nMOTION\nFrames: 1\n\
                        Frame Time: 0.01\n";

    #[test]
    fn an_endless_clip_is_refused_at_its_limit() {
        let rows = Cursor::new(b"7\n".repeat(300_000));
        let problem = prepass::check(BufReader::new(HEAD.as_bytes().chain(rows))).unwrap_err().to_string();
        assert!(problem.starts_with("line 250010: more than 250000 frames"), "{problem}");
    }

    #[test]
    fn an_endless_row_is_refused() {
        let problem = prepass::check(BufReader::new(HEAD.as_bytes().chain(repeat(b' ')))).unwrap_err().to_string();
        assert!(problem.starts_with("line 10: "), "{problem}");
    }
}

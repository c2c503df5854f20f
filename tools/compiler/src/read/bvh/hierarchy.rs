//! The HIERARCHY section of a BVH text → checked joints. Each statement is checked against the joints that are open.

use std::io::BufRead;

use glam::DVec3;

use crate::error::RejectionReason;
use crate::read::bvh::lines::{TextLines, number, quoted};
use crate::read::malformed::malformed_line;
use crate::read::source_clip::MAX_JOINTS;

/// Greatest nesting of joints; the deepest rig of the development set, with face and fingers, has 24.
const MAX_DEPTH: usize = 256;
/// Greatest length of a line of the hierarchy, bytes.
const LINE_MAX_BYTES: usize = 4096;
/// Names of all channels.
const CHANNELS: [&str; 6] = ["Xposition", "Yposition", "Zposition", "Xrotation", "Yrotation", "Zrotation"];

/// A joint or an end site.
#[derive(Debug)]
pub(crate) struct CheckedJoint {
    /// Name in the file; of an end site its parent's name with `_end` appended.
    pub name: String,
    /// Index of the parent.
    pub parent: Option<usize>,
    /// OFFSET from the parent, source units.
    pub offset: DVec3,
    /// Channels in the file's order, spelt as in [`CHANNELS`].
    pub channels: Vec<&'static str>,
    /// Whether this is an end site.
    pub is_end: bool,
}

/// The joints in file order, and the number of the line that holds `MOTION`.
pub(crate) fn checked_hierarchy<R: BufRead>(
    lines: &mut TextLines<R>,
) -> Result<(Vec<CheckedJoint>, usize), RejectionReason> {
    let mut reader = HierarchyReader::default();
    let mut last_line = 1;
    while let Some(line) = lines.next_statement()? {
        line.check_length(LINE_MAX_BYTES)?;
        let (line, text) = (line.number, line.text());
        if text.eq_ignore_ascii_case("MOTION") {
            reader.finish(line)?;
            return Ok((reader.joints, line));
        }
        for statement in statements(text) {
            reader.read(line, statement)?;
        }
        last_line = line;
    }
    malformed_line(last_line, "the file ends without a MOTION section", "export the clip with its motion")
}

/// The statements of a line: a brace is a statement of its own.
fn statements(line: &str) -> impl Iterator<Item = &str> {
    line.split_inclusive(['{', '}']).flat_map(|piece| match piece.strip_suffix(['{', '}']) {
        Some(head) => [head.trim(), &piece[head.len()..]],
        None => [piece.trim(), ""],
    })
}

/// The joints so far, and which statements may follow.
#[derive(Default)]
struct HierarchyReader {
    joints: Vec<CheckedJoint>,
    /// Indices of the open joints, outermost first.
    open: Vec<usize>,
    /// The last joint's opening brace is still to come.
    is_brace_due: bool,
    /// HIERARCHY has been read.
    has_begun: bool,
}

impl HierarchyReader {
    fn read(&mut self, line: usize, statement: &str) -> Result<(), RejectionReason> {
        let mut words = statement.split_whitespace();
        let Some(keyword) = words.next() else { return Ok(()) };
        match keyword.to_ascii_uppercase().as_str() {
            "HIERARCHY" if !self.has_begun => {
                self.has_begun = true;
                Ok(())
            }
            _ if !self.has_begun => {
                malformed_line(line, "the file does not begin with HIERARCHY", "is it a BVH file? check its name")
            }
            "ROOT" => self.root(line, statement[keyword.len()..].trim()),
            "JOINT" => self.child(line, statement[keyword.len()..].trim().to_owned(), false),
            "END" => self.end_site(line),
            "{" => self.open_brace(line),
            "}" => self.close_brace(line),
            "OFFSET" => self.offset(line, words),
            "CHANNELS" => self.channels(line, words),
            _ => {
                let problem = format!("`{}` is not a statement of a BVH hierarchy", quoted(keyword));
                malformed_line(line, problem, "repair the line")
            }
        }
    }

    fn root(&mut self, line: usize, name: &str) -> Result<(), RejectionReason> {
        if let Some(first) = self.joints.first() {
            let problem = format!("a second ROOT, `{}`, beside `{}`: two bodies", quoted(name), quoted(&first.name));
            return malformed_line(line, problem, "export each to a file of its own");
        }
        self.add_joint(line, name.to_owned(), None, false)
    }

    fn child(&mut self, line: usize, name: String, is_end: bool) -> Result<(), RejectionReason> {
        let Some(&parent) = self.open.last() else {
            return malformed_line(line, "a joint outside the ROOT's braces", "repair the braces");
        };
        if self.joints[parent].is_end {
            return malformed_line(line, "a joint within an End Site", "repair the braces");
        }
        self.add_joint(line, name, Some(parent), is_end)
    }

    fn end_site(&mut self, line: usize) -> Result<(), RejectionReason> {
        let parent = self.open.last().map_or_else(String::new, |&parent| self.joints[parent].name.clone());
        self.child(line, parent + "_end", true)
    }

    fn add_joint(
        &mut self,
        line: usize,
        name: String,
        parent: Option<usize>,
        is_end: bool,
    ) -> Result<(), RejectionReason> {
        if self.is_brace_due || self.open.len() >= MAX_DEPTH {
            let problem = "a joint where `{` was expected, or joints nested too deeply";
            return malformed_line(line, problem, "repair the braces");
        }
        if self.joints.len() >= MAX_JOINTS {
            return malformed_line(line, format!("more than {MAX_JOINTS} joints"), "export the body's own skeleton");
        }
        self.is_brace_due = true;
        self.joints.push(CheckedJoint { name, parent, offset: DVec3::ZERO, channels: Vec::new(), is_end });
        Ok(())
    }

    fn open_brace(&mut self, line: usize) -> Result<(), RejectionReason> {
        if !self.is_brace_due {
            return malformed_line(line, "`{` without a joint", "repair the braces");
        }
        self.is_brace_due = false;
        self.open.push(self.joints.len() - 1);
        Ok(())
    }

    fn close_brace(&mut self, line: usize) -> Result<(), RejectionReason> {
        if self.is_brace_due || self.open.pop().is_none() {
            return malformed_line(line, "`}` without an open joint", "repair the braces");
        }
        Ok(())
    }

    fn offset<'a>(&mut self, line: usize, words: impl Iterator<Item = &'a str>) -> Result<(), RejectionReason> {
        let joint = self.open_joint(line)?;
        let numbers = words.map(|word| number(line, word)).collect::<Result<Vec<f64>, RejectionReason>>()?;
        match numbers[..] {
            [x, y, z] => joint.offset = DVec3::new(x, y, z),
            _ => {
                return malformed_line(line, format!("OFFSET has {} numbers, not 3", numbers.len()), "repair the line");
            }
        }
        Ok(())
    }

    fn channels<'a>(&mut self, line: usize, mut words: impl Iterator<Item = &'a str>) -> Result<(), RejectionReason> {
        let joint = self.open_joint(line)?;
        let stated = words.next().and_then(|word| word.parse::<usize>().ok());
        let channels = words.map(|word| channel(line, word)).collect::<Result<Vec<&str>, RejectionReason>>()?;
        if stated != Some(channels.len()) || !joint.channels.is_empty() || joint.is_end {
            let problem = format!("CHANNELS does not state how many it names ({}), or stands twice", channels.len());
            return malformed_line(line, problem, "repair the line");
        }
        joint.channels = channels;
        Ok(())
    }

    /// The joint that OFFSET and CHANNELS belong to.
    fn open_joint(&mut self, line: usize) -> Result<&mut CheckedJoint, RejectionReason> {
        match self.open.last() {
            Some(&joint) if !self.is_brace_due => Ok(&mut self.joints[joint]),
            _ => malformed_line(line, "OFFSET or CHANNELS outside a joint", "repair the braces"),
        }
    }

    fn finish(&self, line: usize) -> Result<(), RejectionReason> {
        if self.joints.is_empty() || self.is_brace_due || !self.open.is_empty() {
            return malformed_line(line, "MOTION before the hierarchy is closed", "repair the braces before it");
        }
        Ok(())
    }
}

fn channel(line: usize, word: &str) -> Result<&'static str, RejectionReason> {
    match CHANNELS.iter().find(|known| known.eq_ignore_ascii_case(word)) {
        Some(known) => Ok(known),
        None => {
            malformed_line(line, format!("`{}` is not a channel", quoted(word)), "channels are Xposition … Zrotation")
        }
    }
}

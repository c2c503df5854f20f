//! Reads a BVH text strictly: the motion's numbers at once, the hierarchy into a canonical one for `bvh_anim`.
//!
//! `bvh_anim` cuts joint names at blanks and colons, drops leaves without an End Site, panics on a BOM or a nameless
//! joint and allocates whatever `Frames:` claims. Here every statement is checked first; joints are renamed `j0`, `j1` …
//! (the real names are kept), every leaf gets an End Site, and nothing is larger than the bytes of the file pay for. Its
//! numbers are f32, and it would read each a second time: those are kept as they are checked.

use std::fmt::Write as _;

use glam::DVec3;

use crate::decimal;
use crate::skeleton_map::MAX_JOINTS;

/// Deepest nesting of joints: deeper is no skeleton (the deepest real one, with face and fingers: 24).
const MAX_DEPTH: usize = 256;
/// Joint-frames for each number of the motion section. A joint has at least one channel in practice, end sites add one in three; this
/// keeps the decoded clip proportional to the file.
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
    /// Lying or missing counts.
    pub warnings: Vec<String>,
}

/// A joint or an end site.
#[derive(Debug)]
pub(crate) struct CheckedJoint {
    /// The real name.
    pub name: String,
    /// Index of its parent.
    pub parent: Option<usize>,
    /// From its parent, source units.
    pub offset: DVec3,
    /// In the file's spelling, canonicalised (`Xposition` … `Zrotation`).
    pub channels: Vec<&'static str>,
    /// An End Site.
    pub is_end: bool,
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

fn flaw<T>(line: usize, problem: impl Into<String>, remedy: &'static str) -> Result<T, Flaw> {
    Err(Flaw { line, problem: problem.into(), remedy })
}

/// Checks the bytes of a BVH file and rewrites them canonically.
pub(crate) fn check(bytes: &[u8]) -> Result<CheckedBvh, Flaw> {
    if bytes.is_empty() {
        return flaw(1, "the file is empty", "export the clip again");
    }
    if bytes.starts_with(b"\xff\xfe") || bytes.starts_with(b"\xfe\xff") {
        return flaw(1, "the text is UTF-16", "save it as UTF-8 or plain ASCII");
    }
    let text = String::from_utf8_lossy(bytes.strip_prefix(b"\xef\xbb\xbf").unwrap_or(bytes));
    let mut lines = numbered_lines(&text);
    let (joints, motion_line) = hierarchy(&mut lines)?;
    let mut warnings = Vec::new();
    let motion = motion(lines, motion_line, &joints, &mut warnings)?;
    Ok(CheckedBvh { hierarchy: canonical_hierarchy(&joints), joints, motion, warnings })
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

/// The hierarchy and the number of the line that says `MOTION`.
fn hierarchy<'a>(lines: impl Iterator<Item = (usize, &'a str)>) -> Result<(Vec<CheckedJoint>, usize), Flaw> {
    let mut reader = HierarchyReader::default();
    let mut last_line = 1;
    for (line, text) in lines {
        if text.eq_ignore_ascii_case("MOTION") {
            reader.finish(line)?;
            return Ok((reader.joints, line));
        }
        for statement in statements(text) {
            reader.read(line, statement)?;
        }
        last_line = line;
    }
    flaw(last_line, "the file ends without a MOTION section", "export the clip with its motion")
}

/// Braces stand by themselves, whatever line they share.
fn statements(line: &str) -> impl Iterator<Item = &str> {
    line.split_inclusive(['{', '}']).flat_map(|piece| match piece.strip_suffix(['{', '}']) {
        Some(head) => [head.trim(), &piece[head.len()..]],
        None => [piece.trim(), ""],
    })
}

#[derive(Default)]
struct HierarchyReader {
    joints: Vec<CheckedJoint>,
    /// Open joints, outermost first.
    open: Vec<usize>,
    /// Named, its brace still to come.
    announced: bool,
    started: bool,
}

impl HierarchyReader {
    fn read(&mut self, line: usize, statement: &str) -> Result<(), Flaw> {
        let mut words = statement.split_whitespace();
        let Some(keyword) = words.next() else { return Ok(()) };
        match keyword.to_ascii_uppercase().as_str() {
            "HIERARCHY" if !self.started => {
                self.started = true;
                Ok(())
            }
            _ if !self.started => {
                flaw(line, "the file does not begin with HIERARCHY", "is it a BVH file? check its name")
            }
            "ROOT" => self.root(line, statement[keyword.len()..].trim()),
            "JOINT" => self.child(line, statement[keyword.len()..].trim().to_owned(), false),
            "END" => self.end_site(line),
            "{" => self.open_brace(line),
            "}" => self.close_brace(line),
            "OFFSET" => self.offset(line, words),
            "CHANNELS" => self.channels(line, words),
            _ => flaw(line, format!("`{}` is no statement of a BVH hierarchy", shown(keyword)), "repair the line"),
        }
    }

    fn root(&mut self, line: usize, name: &str) -> Result<(), Flaw> {
        if let Some(first) = self.joints.first() {
            let problem = format!("a second ROOT, `{}`, beside `{}`: two bodies", shown(name), shown(&first.name));
            return flaw(line, problem, "export each to a file of its own");
        }
        self.announce(line, name.to_owned(), None, false)
    }

    fn child(&mut self, line: usize, name: String, is_end: bool) -> Result<(), Flaw> {
        let Some(&parent) = self.open.last() else {
            return flaw(line, "a joint outside the ROOT's braces", "repair the braces");
        };
        if self.joints[parent].is_end {
            return flaw(line, "a joint within an End Site", "repair the braces");
        }
        self.announce(line, name, Some(parent), is_end)
    }

    fn end_site(&mut self, line: usize) -> Result<(), Flaw> {
        let parent = self.open.last().map_or_else(String::new, |&parent| self.joints[parent].name.clone());
        self.child(line, parent + "_end", true)
    }

    fn announce(&mut self, line: usize, name: String, parent: Option<usize>, is_end: bool) -> Result<(), Flaw> {
        if self.announced || self.open.len() >= MAX_DEPTH {
            return flaw(line, "a joint where `{` was expected, or joints nested too deeply", "repair the braces");
        }
        if self.joints.len() >= MAX_JOINTS {
            return flaw(line, format!("more than {MAX_JOINTS} joints"), "export the body's own skeleton");
        }
        self.announced = true;
        self.joints.push(CheckedJoint { name, parent, offset: DVec3::ZERO, channels: Vec::new(), is_end });
        Ok(())
    }

    fn open_brace(&mut self, line: usize) -> Result<(), Flaw> {
        if !self.announced {
            return flaw(line, "`{` without a joint", "repair the braces");
        }
        self.announced = false;
        self.open.push(self.joints.len() - 1);
        Ok(())
    }

    fn close_brace(&mut self, line: usize) -> Result<(), Flaw> {
        if self.announced || self.open.pop().is_none() {
            return flaw(line, "`}` without an open joint", "repair the braces");
        }
        Ok(())
    }

    fn offset<'a>(&mut self, line: usize, words: impl Iterator<Item = &'a str>) -> Result<(), Flaw> {
        let joint = self.current(line)?;
        let numbers = words.map(|word| number(line, word)).collect::<Result<Vec<f64>, Flaw>>()?;
        match numbers[..] {
            [x, y, z] => joint.offset = DVec3::new(x, y, z),
            _ => return flaw(line, format!("OFFSET has {} numbers, not 3", numbers.len()), "repair the line"),
        }
        Ok(())
    }

    fn channels<'a>(&mut self, line: usize, mut words: impl Iterator<Item = &'a str>) -> Result<(), Flaw> {
        let joint = self.current(line)?;
        let claimed = words.next().and_then(|word| word.parse::<usize>().ok());
        let channels = words.map(|word| channel(line, word)).collect::<Result<Vec<&str>, Flaw>>()?;
        if claimed != Some(channels.len()) || !joint.channels.is_empty() || joint.is_end {
            let problem = format!("CHANNELS does not say how many it names ({}), or stands twice", channels.len());
            return flaw(line, problem, "repair the line");
        }
        joint.channels = channels;
        Ok(())
    }

    fn current(&mut self, line: usize) -> Result<&mut CheckedJoint, Flaw> {
        match self.open.last() {
            Some(&joint) if !self.announced => Ok(&mut self.joints[joint]),
            _ => flaw(line, "OFFSET or CHANNELS outside a joint", "repair the braces"),
        }
    }

    fn finish(&self, line: usize) -> Result<(), Flaw> {
        if self.joints.is_empty() || self.announced || !self.open.is_empty() {
            return flaw(line, "MOTION before the hierarchy is closed", "repair the braces before it");
        }
        Ok(())
    }
}

const CHANNELS: [&str; 6] = ["Xposition", "Yposition", "Zposition", "Xrotation", "Yrotation", "Zrotation"];

fn channel(line: usize, word: &str) -> Result<&'static str, Flaw> {
    match CHANNELS.iter().find(|known| known.eq_ignore_ascii_case(word)) {
        Some(known) => Ok(known),
        None => flaw(line, format!("`{}` is no channel", shown(word)), "channels are Xposition … Zrotation"),
    }
}

fn number(line: usize, word: &str) -> Result<f64, Flaw> {
    match decimal::number(word) {
        Some(value) if value.abs() <= MAX_VALUE => Ok(value),
        _ => flaw(line, format!("`{}` is not a finite, sensible number", shown(word)), "repair the value"),
    }
}

/// A word of the file, short enough for a message.
fn shown(word: &str) -> String {
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
    warnings: &mut Vec<String>,
) -> Result<Motion, Flaw> {
    let (_, claimed) = header(lines.next(), motion_line, &["FRAMES"])?;
    let (line, frame_time_s) = header(lines.next(), motion_line, &["FRAME", "TIME"])?;
    if !FRAME_TIME_S.contains(&frame_time_s) {
        let [least, greatest] = [FRAME_TIME_S.start(), FRAME_TIME_S.end()];
        let problem = format!("Frame Time is {frame_time_s} s, not between {least} and {greatest}");
        return flaw(line, problem, "write the seconds between two frames");
    }
    let channel_count: usize = joints.iter().map(|joint| joint.channels.len()).sum();
    let values = row_values(lines, channel_count, warnings)?;
    let row_count = values.len().checked_div(channel_count).unwrap_or(0);
    if row_count == 0 {
        return flaw(motion_line, "there is not one whole row of motion", "export the clip with its motion");
    }
    if joints.len() * row_count > MAX_JOINT_FRAMES_PER_VALUE * values.len() {
        return flaw(motion_line, "most joints have no channels", "export a skeleton whose joints move");
    }
    if row_count as f64 != claimed {
        warnings.push(format!("`Frames:` says {claimed}, but there are {row_count} rows: the rows are used"));
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
        _ => flaw(line, format!("`{}` is not a number", shown(value.trim())), remedy),
    }
}

/// All values, whole rows only: a last row cut short is dropped with a warning, any other odd row is an error.
fn row_values<'a>(
    lines: impl Iterator<Item = (usize, &'a str)>,
    channels: usize,
    warnings: &mut Vec<String>,
) -> Result<Vec<f64>, Flaw> {
    let mut values = Vec::new();
    let mut lines = lines.peekable();
    while let Some((line, text)) = lines.next() {
        let before = values.len();
        for word in text.split_ascii_whitespace() {
            values.push(number(line, word)?);
        }
        let found = values.len() - before;
        if found < channels && before > 0 && lines.peek().is_none() {
            values.truncate(before);
            warnings.push(format!("line {line}: the last row is cut short and is not used"));
        } else if found != channels {
            let problem = format!("a row of {found} values where the hierarchy has {channels} channels");
            return flaw(line, problem, "one row holds one frame");
        }
    }
    Ok(values)
}

fn canonical_hierarchy(joints: &[CheckedJoint]) -> String {
    let mut text = String::from("HIERARCHY\n");
    let mut open: Vec<usize> = Vec::new();
    let mut is_leaf = vec![true; joints.len()];
    for joint in joints.iter().filter(|joint| !joint.is_end) {
        joint.parent.into_iter().for_each(|parent| is_leaf[parent] = false);
    }
    for (index, joint) in joints.iter().enumerate().filter(|(_, joint)| !joint.is_end) {
        while open.last().copied() != joint.parent {
            close(&mut text, open.pop().is_some_and(|joint| is_leaf[joint]));
        }
        let keyword = if joint.parent.is_none() { "ROOT" } else { "JOINT" };
        let _ =
            writeln!(text, "{keyword} j{index}\n{{\nOFFSET {} {} {}", joint.offset.x, joint.offset.y, joint.offset.z);
        let _ = writeln!(text, "CHANNELS {} {}", joint.channels.len(), joint.channels.join(" "));
        open.push(index);
    }
    while let Some(joint) = open.pop() {
        close(&mut text, is_leaf[joint]);
    }
    text
}

/// Closes a joint; a leaf gets the End Site that `bvh_anim` wants (the real ones are kept aside).
fn close(text: &mut String, is_leaf: bool) {
    if is_leaf {
        text.push_str("End Site\n{\nOFFSET 0 0 0\n}\n");
    }
    text.push_str("}\n");
}

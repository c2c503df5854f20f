//! The hierarchy of a BVH text: its statements, one by one, into joints, and those into a hierarchy that `bvh_anim`
//! reads without a surprise.

use std::fmt::Write as _;

use glam::DVec3;

use crate::read::bvh::prepass::{Flaw, flaw, number, shown};
use crate::rig::roles::MAX_JOINTS;

/// Deepest nesting of joints: deeper is no skeleton (the deepest real one, with face and fingers: 24).
const MAX_DEPTH: usize = 256;
const CHANNELS: [&str; 6] = ["Xposition", "Yposition", "Zposition", "Xrotation", "Yrotation", "Zrotation"];

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

/// The hierarchy and the number of the line that says `MOTION`.
pub(crate) fn hierarchy<'a>(lines: impl Iterator<Item = (usize, &'a str)>) -> Result<(Vec<CheckedJoint>, usize), Flaw> {
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

fn channel(line: usize, word: &str) -> Result<&'static str, Flaw> {
    match CHANNELS.iter().find(|known| known.eq_ignore_ascii_case(word)) {
        Some(known) => Ok(known),
        None => flaw(line, format!("`{}` is no channel", shown(word)), "channels are Xposition … Zrotation"),
    }
}

/// The hierarchy as `bvh_anim` reads it: joints `j0`, `j1` …, an End Site on every leaf.
pub(crate) fn canonical(joints: &[CheckedJoint]) -> String {
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

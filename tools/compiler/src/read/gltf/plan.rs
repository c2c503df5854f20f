//! Which clips a glTF document holds: every animation of every body that it moves, its name and how long it lasts.

use std::collections::BTreeMap;

use crate::input::unique_names;
use crate::read::gltf::document::{Document, Flaw, flaw};
use crate::read::gltf::track::{self, Source};
use crate::read::gltf::tree::{Body, Tree};
use crate::read::gltf::{FRAME_RATE_HZ, accessor};

/// Most node-frames of a file, besides one for each of its bytes: 50 nodes for three minutes. A two-key track can claim
/// any duration.
const FREE_NODE_FRAMES: usize = 300_000;

/// One clip to be read.
pub(crate) struct Plan {
    pub name: String,
    pub animation: usize,
    pub body: usize,
    pub span: Result<Span, Flaw>,
}

/// When a clip begins (its first key) and how many frames it lasts.
#[derive(Clone, Copy)]
pub(crate) struct Span {
    pub start_s: f64,
    pub frames: usize,
}

/// Every clip of a document: each animation of each body that it moves, told apart by name.
pub(crate) fn plans(document: &Document, tree: &Tree, bodies: &[Body]) -> Result<Vec<Plan>, Flaw> {
    let is_in: Vec<Vec<bool>> = bodies.iter().map(|body| body.is_in(tree)).collect();
    let animations = &document.root.animations;
    let mut spans = Spans { document, by_input: BTreeMap::new(), node_frames: 0 };
    let mut plans = Vec::new();
    for (index, animation) in animations.iter().enumerate() {
        let unnamed = if animations.len() > 1 { format!("animation {index}") } else { String::new() };
        let name = animation.name.clone().unwrap_or(unnamed);
        let moved: Vec<usize> = (0..bodies.len()).filter(|&body| moves(document, index, &is_in[body])).collect();
        // One that moves nothing is told as such.
        for &body in if moved.is_empty() { &[0][..] } else { &moved } {
            let name = if moved.len() > 1 { format!("{name} {}", bodies[body].name) } else { name.clone() };
            let span = spans.span(index, &is_in[body], bodies[body].places.len());
            plans.push(Plan { name: name.trim().to_owned(), animation: index, body, span });
        }
    }
    if plans.is_empty() {
        return flaw("document", "it holds no animation", "export it with its animations");
    }
    unique_names::tell_apart(plans.iter_mut().map(|plan| &mut plan.name));
    Ok(plans)
}

/// The channels of an animation that move these nodes.
pub(crate) fn sources(document: &Document, animation: usize, is_in: &[bool]) -> Result<Vec<Source>, Flaw> {
    let animation = &document.root.animations[animation];
    let mut sources = Vec::new();
    for channel in &animation.channels {
        let Some(source) = track::source(animation, channel)? else { continue };
        match is_in.get(source.node) {
            Some(true) => sources.push(source),
            Some(false) => {}
            None => return flaw("channel", "its node is not there", "check the file with the glTF validator"),
        }
    }
    Ok(sources)
}

fn moves(document: &Document, animation: usize, is_in: &[bool]) -> bool {
    sources(document, animation, is_in).is_ok_and(|sources| !sources.is_empty())
}

/// How long clips last, as long as the file pays for it.
struct Spans<'a> {
    document: &'a Document<'a>,
    /// First and last key of accessors of times.
    by_input: BTreeMap<usize, [f64; 2]>,
    node_frames: usize,
}

impl Spans<'_> {
    fn span(&mut self, animation: usize, is_in: &[bool], nodes: usize) -> Result<Span, Flaw> {
        let (mut start_s, mut end_s) = (f64::INFINITY, f64::NEG_INFINITY);
        for source in sources(self.document, animation, is_in)? {
            let [first_s, last_s] = self.ends(source.input)?;
            (start_s, end_s) = (start_s.min(first_s), end_s.max(last_s));
        }
        // Where nothing moves, start and end are infinite.
        let frames =
            if start_s <= end_s { (((end_s - start_s) * FRAME_RATE_HZ).round() as usize).saturating_add(1) } else { 0 };
        self.node_frames = self.node_frames.saturating_add(frames.saturating_mul(nodes));
        if self.node_frames > FREE_NODE_FRAMES.saturating_add(self.document.byte_count) {
            self.node_frames -= frames.saturating_mul(nodes).min(self.node_frames);
            let place = format!("animation {animation}");
            return flaw(
                place,
                "it lasts longer than the file's bytes pay for",
                "repair its key times, or split the file",
            );
        }
        Ok(Span { start_s, frames })
    }

    /// The first and the last of an accessor of times.
    fn ends(&mut self, input: usize) -> Result<[f64; 2], Flaw> {
        if let Some(&ends) = self.by_input.get(&input) {
            return Ok(ends);
        }
        let times = accessor::numbers(self.document, input, false)?.values;
        let [Some(&first), Some(&last)] = [times.first(), times.last()] else {
            return flaw(format!("accessor {input}"), "it holds no key times", "export the animation again");
        };
        let ends = [first, last].map(f64::from);
        self.by_input.insert(input, ends);
        Ok(ends)
    }
}

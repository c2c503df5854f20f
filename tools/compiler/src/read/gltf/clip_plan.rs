//! The clips of a glTF document: each animation of each body that it moves, with its name, its start and its length.

use std::collections::BTreeMap;

use gltf::json::animation::Animation;

use crate::error::RejectionReason;
use crate::input::unique_names;
use crate::read::gltf::accessor;
use crate::read::gltf::document::Document;
use crate::read::gltf::node_channel::moving_channels;
use crate::read::gltf::node_tree::{BodyNodes, NodeTree};
use crate::read::malformed::malformed;
use crate::read::source_clip::{MAX_FRAMES, MAX_JOINT_FRAMES};

/// Sampling rate, Hz: that of most recorded clips. Keys of animated characters are not denser.
pub(crate) const FRAME_RATE_HZ: f64 = 30.0;
/// Greatest number of node-frames of a file, beside one for each of its bytes: 50 nodes for three minutes. Two keys can
/// span any time.
const FREE_NODE_FRAMES: usize = 300_000;

/// One clip that can be read.
pub(crate) struct ClipPlan {
    /// Unique name.
    pub name: String,
    /// Index of the animation.
    pub animation: usize,
    /// Index of the body.
    pub body: usize,
    /// Start and length, or why the clip cannot be read.
    pub span: Result<ClipSpan, RejectionReason>,
}

/// Start and length of a clip.
#[derive(Clone, Copy)]
pub(crate) struct ClipSpan {
    /// Time of the first key, s.
    pub start_s: f64,
    /// Number of frames; 0 where nothing moves.
    pub frames: usize,
}

/// All clips of a document.
pub(crate) fn clip_plans(
    document: &Document,
    tree: &NodeTree,
    bodies: &[BodyNodes],
) -> Result<Vec<ClipPlan>, RejectionReason> {
    let is_member: Vec<Vec<bool>> = bodies.iter().map(|body| body.is_member(tree)).collect();
    let animations = &document.root.animations;
    let mut budget = SpanBudget { document, ends_of_input: BTreeMap::new(), node_frames: 0 };
    let mut plans = Vec::new();
    for (index, animation) in animations.iter().enumerate() {
        let unnamed = if animations.len() > 1 { format!("animation {index}") } else { String::new() };
        let name = animation.name.clone().unwrap_or(unnamed);
        let moved: Vec<usize> = (0..bodies.len()).filter(|&body| moves(animation, &is_member[body])).collect();
        // An animation that moves nothing is a clip of the first body, which import rejects.
        for &body in if moved.is_empty() { &[0][..] } else { &moved } {
            let name = if moved.len() > 1 { format!("{name} {}", bodies[body].name) } else { name.clone() };
            let span = budget.span(index, &is_member[body], bodies[body].slots.len());
            plans.push(ClipPlan { name: name.trim().to_owned(), animation: index, body, span });
        }
    }
    if plans.is_empty() {
        return malformed("document", "it holds no animation", "export it with its animations");
    }
    unique_names::make_unique(plans.iter_mut().map(|plan| &mut plan.name));
    Ok(plans)
}

fn moves(animation: &Animation, is_member: &[bool]) -> bool {
    moving_channels(animation, is_member).is_ok_and(|channels| !channels.is_empty())
}

/// Lengths of clips, as long as the file has bytes for their frames.
struct SpanBudget<'a> {
    document: &'a Document,
    /// First and last key time of each accessor that was read, s.
    ends_of_input: BTreeMap<usize, [f64; 2]>,
    /// Node-frames of all clips so far.
    node_frames: usize,
}

impl SpanBudget<'_> {
    fn span(&mut self, animation: usize, is_member: &[bool], nodes: usize) -> Result<ClipSpan, RejectionReason> {
        let (mut start_s, mut end_s) = (f64::INFINITY, f64::NEG_INFINITY);
        for channel in moving_channels(&self.document.root.animations[animation], is_member)? {
            let [first_s, last_s] = self.ends_s(channel.input)?;
            (start_s, end_s) = (start_s.min(first_s), end_s.max(last_s));
        }
        // Where nothing moves, start and end are infinite.
        let frames =
            if start_s <= end_s { (((end_s - start_s) * FRAME_RATE_HZ).round() as usize).saturating_add(1) } else { 0 };
        self.node_frames = self.node_frames.saturating_add(frames.saturating_mul(nodes));
        if self.node_frames > FREE_NODE_FRAMES.saturating_add(self.document.byte_count) {
            self.node_frames -= frames.saturating_mul(nodes).min(self.node_frames);
            let problem = "it lasts longer than the file's bytes justify";
            return malformed(format!("animation {animation}"), problem, "repair its key times, or split the file");
        }
        if frames > MAX_FRAMES || frames.saturating_mul(nodes) > MAX_JOINT_FRAMES {
            let problem = format!("it lasts {frames} frames of {nodes} nodes, longer than any clip that is read");
            return malformed(format!("animation {animation}"), problem, "cut it into shorter ones");
        }
        Ok(ClipSpan { start_s, frames })
    }

    /// First and last key time of an accessor, s.
    fn ends_s(&mut self, input: usize) -> Result<[f64; 2], RejectionReason> {
        if let Some(&ends) = self.ends_of_input.get(&input) {
            return Ok(ends);
        }
        let times = accessor::numbers(self.document, input, false)?.values;
        let [Some(&first), Some(&last)] = [times.first(), times.last()] else {
            return malformed(format!("accessor {input}"), "it holds no key times", "export the animation again");
        };
        let ends = [first, last].map(f64::from);
        self.ends_of_input.insert(input, ends);
        Ok(ends)
    }
}

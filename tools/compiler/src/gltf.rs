//! glTF → [`SourceClip`]s, one an animation, sampled at 30 frames a second from its first key.
//!
//! All nodes count as joints, skinned or not. Scales above the joints (Mixamo 0.01, Blender 100) are multiplied into the positions; a
//! joint's orientation is the rotation in its global matrix. glTF is metres, Y up by definition; up is measured all the same.

use std::collections::BTreeMap;
use std::path::Path;

use glam::{DMat3, DMat4, DQuat, DVec3};
use gltf::animation::Interpolation;

use crate::error::ImportError;
use crate::gltf_document::{Animation, Flaw, Node, Track, Transform, Values, parse};
use crate::source_clip::{SourceClip, SourceJoint};

/// Sampling rate: that of most recorded clips; keys of animated characters are no denser.
const FRAME_RATE_HZ: f64 = 30.0;
/// Key times are rounded to f32 in the file; a sample this short before a key is at it (matters where values step).
const KEY_ROUNDING_S: f64 = 1e-5;
/// Most node-frames of one animation: 50 nodes for three quarters of an hour. A two-key track can claim any duration.
const MAX_NODE_FRAMES: f64 = 4e6;
/// Animations are sampled one after another and kept together: their sum is bounded too.
const MAX_FILE_NODE_FRAMES: f64 = 1.6e7;

/// Reads every animation of a glTF or GLB file from its bytes; `file` is for names, messages and buffers beside it.
///
/// # Errors
/// [`ImportError::Gltf`] with the part of the document that is malformed.
pub fn read(file: &Path, bytes: &[u8]) -> Result<Vec<SourceClip>, ImportError> {
    clips(file, bytes).map_err(|flaw| ImportError::Gltf {
        file: file.to_owned(),
        place: flaw.place,
        problem: flaw.problem,
        remedy: flaw.remedy,
    })
}

fn clips(file: &Path, bytes: &[u8]) -> Result<Vec<SourceClip>, Flaw> {
    let (nodes, animations) = parse(file, bytes)?;
    let tree = Tree::new(&nodes)?;
    let file_name = file.file_name().map_or_else(String::new, |name| name.to_string_lossy().into_owned());
    let names = clip_names(&animations);
    let mut node_frames = 0.0;
    let mut clips = Vec::new();
    for (animation, name) in animations.iter().zip(names) {
        let span = span(animation, nodes.len(), &name)?;
        node_frames += (span.frames * nodes.len()) as f64;
        if node_frames > MAX_FILE_NODE_FRAMES {
            return flaw(&name, "the file's animations are too long together", "split the file");
        }
        clips.push(sampled(&tree, &nodes, animation, &span, &file_name, name));
    }
    if clips.is_empty() {
        return flaw("document", "it holds no animation", "export it with its animations");
    }
    Ok(clips)
}

fn flaw<T>(place: &str, problem: &str, remedy: &'static str) -> Result<T, Flaw> {
    Err(Flaw { place: place.to_owned(), problem: problem.to_owned(), remedy })
}

/// The animations' names, told apart by numbers where several share one; a single unnamed one stays unnamed.
fn clip_names(animations: &[Animation]) -> Vec<String> {
    let mut seen: BTreeMap<String, usize> = BTreeMap::new();
    let name = |(index, animation): (usize, &Animation)| {
        let fallback = if animations.len() > 1 { format!("animation {index}") } else { String::new() };
        let name = animation.name.clone().unwrap_or(fallback);
        let count = seen.entry(name.clone()).and_modify(|count| *count += 1).or_insert(1);
        if *count > 1 { format!("{name} {count}") } else { name }
    };
    animations.iter().enumerate().map(name).collect()
}

fn span(animation: &Animation, nodes: usize, name: &str) -> Result<Span, Flaw> {
    let start_s = animation.tracks.iter().map(|track| track.times_s[0]).fold(f64::INFINITY, f64::min);
    let end_s = animation.tracks.iter().map(|track| track.times_s[track.times_s.len() - 1]).fold(0.0, f64::max);
    let frames = if start_s <= end_s { ((end_s - start_s) * FRAME_RATE_HZ).round() + 1.0 } else { 0.0 };
    if frames * nodes as f64 > MAX_NODE_FRAMES {
        return flaw(name, "the animation lasts too long", "repair its key times");
    }
    Ok(Span { start_s, frames: frames as usize })
}

/// The nodes in an order in which parents stand before their children.
struct Tree {
    order: Vec<usize>,
    /// Position in `order` of each node's parent, by position.
    parents: Vec<Option<usize>>,
}

impl Tree {
    fn new(nodes: &[Node]) -> Result<Self, Flaw> {
        let mut is_child = vec![false; nodes.len()];
        for &child in nodes.iter().flat_map(|node| &node.children) {
            if std::mem::replace(&mut is_child[child], true) {
                return flaw("nodes", "a node has two parents", "check the file with the glTF validator");
            }
        }
        let roots = (0..nodes.len()).filter(|&node| !is_child[node]);
        let mut waiting: Vec<(usize, Option<usize>)> = roots.map(|root| (root, None)).collect();
        waiting.reverse();
        let mut tree = Self { order: Vec::new(), parents: Vec::new() };
        while let Some((node, parent)) = waiting.pop() {
            let place = tree.order.len();
            tree.order.push(node);
            tree.parents.push(parent);
            waiting.extend(nodes[node].children.iter().rev().map(|&child| (child, Some(place))));
        }
        if tree.order.len() < nodes.len() {
            return flaw("nodes", "a node is its own ancestor", "check the file with the glTF validator");
        }
        Ok(tree)
    }
}

/// When an animation begins (its first key) and how many frames it lasts.
struct Span {
    start_s: f64,
    frames: usize,
}

fn sampled(tree: &Tree, nodes: &[Node], animation: &Animation, span: &Span, file: &str, clip: String) -> SourceClip {
    let mut locals: Vec<Transform> = nodes.iter().map(|node| node.rest).collect();
    let mut globals = Vec::with_capacity(span.frames * nodes.len());
    for frame in 0..span.frames {
        let time_s = span.start_s + frame as f64 / FRAME_RATE_HZ;
        for track in &animation.tracks {
            apply(track, time_s, &mut locals[track.node]);
        }
        push_globals(tree, &locals, &mut globals);
    }
    let joint = |(place, &node): (usize, &usize)| SourceJoint {
        name: nodes[node].name.clone(),
        parent: tree.parents[place],
        is_end: false,
    };
    SourceClip {
        file: file.to_owned(),
        clip,
        joints: tree.order.iter().enumerate().map(joint).collect(),
        first_frame: 0,
        frame_rate_hz: FRAME_RATE_HZ,
        positions: globals.iter().map(|global| global.w_axis.truncate()).collect(),
        orientations: globals.iter().map(|global| orientation(DMat3::from_mat4(*global))).collect(),
        up_axis: None,
        metres_per_unit: Some(1.0),
        warnings: Vec::new(),
    }
}

/// Appends one frame's global matrices, in the tree's order.
fn push_globals(tree: &Tree, locals: &[Transform], globals: &mut Vec<DMat4>) {
    let start = globals.len();
    for (&node, &parent) in tree.order.iter().zip(&tree.parents) {
        let Transform { translation, rotation, scale } = locals[node];
        let local = DMat4::from_scale_rotation_translation(scale, rotation, translation);
        globals.push(parent.map_or(local, |parent| globals[start + parent] * local));
    }
}

/// The right-handed frame along a matrix's first two axes: fixed to the bone, also under scales and mirrors.
fn orientation(matrix: DMat3) -> DQuat {
    let x = matrix.x_axis.try_normalize().unwrap_or(DVec3::X);
    let y = matrix.y_axis.reject_from_normalized(x).try_normalize().unwrap_or_else(|| x.any_orthonormal_vector());
    DQuat::from_mat3(&DMat3::from_cols(x, y, x.cross(y))).normalize()
}

/// Sets what a track drives in its node's transform.
fn apply(track: &Track, time_s: f64, local: &mut Transform) {
    let next = track.times_s.partition_point(|&key_s| key_s <= time_s + KEY_ROUNDING_S);
    let last = track.times_s.len() - 1;
    let (from, to) = (next.saturating_sub(1).min(last), next.min(last));
    let span_s = track.times_s[to] - track.times_s[from];
    let share = if span_s > 0.0 { ((time_s - track.times_s[from]) / span_s).clamp(0.0, 1.0) } else { 0.0 };
    let key = Key { from, to, share, span_s, interpolation: track.interpolation };
    match &track.values {
        Values::Translations(values) => local.translation = key.vector(values),
        Values::Scales(values) => local.scale = key.vector(values),
        Values::Rotations(values) => local.rotation = key.rotation(values),
    }
}

/// Where a time lies between two keys.
struct Key {
    from: usize,
    to: usize,
    share: f64,
    span_s: f64,
    interpolation: Interpolation,
}

impl Key {
    fn vector(&self, values: &[DVec3]) -> DVec3 {
        match self.interpolation {
            Interpolation::Step => values[self.from],
            Interpolation::Linear => values[self.from].lerp(values[self.to], self.share),
            Interpolation::CubicSpline => {
                let weights = self.hermite();
                let [value, out] = [values[3 * self.from + 1], values[3 * self.from + 2]];
                let [into, next] = [values[3 * self.to], values[3 * self.to + 1]];
                weights[0] * value + weights[1] * out + weights[2] * next + weights[3] * into
            }
        }
    }

    fn rotation(&self, values: &[DQuat]) -> DQuat {
        let rotation = match self.interpolation {
            Interpolation::Step => values[self.from],
            Interpolation::Linear => normal(values[self.from]).slerp(normal(values[self.to]), self.share),
            Interpolation::CubicSpline => {
                let weights = self.hermite();
                let [value, out] = [values[3 * self.from + 1], values[3 * self.from + 2]];
                let [into, next] = [values[3 * self.to], values[3 * self.to + 1]];
                value * weights[0] + out * weights[1] + next * weights[2] + into * weights[3]
            }
        };
        normal(rotation)
    }

    /// Weights of value, out-tangent, next value, its in-tangent (glTF 2.0, Appendix C).
    fn hermite(&self) -> [f64; 4] {
        let (t, t2, t3) = (self.share, self.share * self.share, self.share * self.share * self.share);
        let span = self.span_s;
        [2.0 * t3 - 3.0 * t2 + 1.0, span * (t3 - 2.0 * t2 + t), 3.0 * t2 - 2.0 * t3, span * (t3 - t2)]
    }
}

fn normal(rotation: DQuat) -> DQuat {
    let length = rotation.length();
    if length > 1e-12 { rotation / length } else { DQuat::IDENTITY }
}

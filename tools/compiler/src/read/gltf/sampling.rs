//! Key tracks → global positions and orientations of a body's joints, frame by frame.

use glam::{DMat3, DMat4, DQuat, DVec3};

use crate::error::RejectionReason;
use crate::read::gltf::accessor;
use crate::read::gltf::clip_plan::FRAME_RATE_HZ;
use crate::read::gltf::document::Document;
use crate::read::gltf::key_track::{self, KeyTrack};
use crate::read::gltf::node_channel::moving_channels;
use crate::read::gltf::node_transform::NodeTransform;
use crate::read::gltf::node_tree::{BodyNodes, NodeTree};
use crate::read::malformed::malformed;
use crate::read::source_motion::{FramePoser, JointPoses};

/// Greatest count of numbers in the keys of one clip, beside [`NUMBERS_PER_BYTE`]; tracks may share their keys.
const FREE_NUMBERS: usize = 16_000_000;
/// Further numbers in the keys of one clip for each byte that was read.
const NUMBERS_PER_BYTE: usize = 2;

/// The tracks of the nodes that `is_member` marks, unless they have far more keys than the file has bytes.
pub(crate) fn key_tracks(
    document: &Document,
    animation: usize,
    is_member: &[bool],
) -> Result<Vec<KeyTrack>, RejectionReason> {
    let channels = moving_channels(&document.root.animations[animation], is_member)?;
    let mut numbers = 0_usize;
    for channel in &channels {
        for accessor in [channel.input, channel.output] {
            numbers = numbers.saturating_add(accessor::number_count(document, accessor)?);
        }
    }
    if numbers > FREE_NUMBERS.saturating_add(NUMBERS_PER_BYTE.saturating_mul(document.byte_count)) {
        let position = format!("animation {animation}");
        return malformed(position, "its tracks share their keys beyond measure", "export it with keys of their own");
    }
    channels.iter().map(|channel| key_track::read(document, channel)).collect()
}

/// Poses the nodes of one body at the frames of one clip.
pub(crate) struct KeyPoser<'a> {
    tree: &'a NodeTree,
    body: &'a BodyNodes,
    /// Parent of each node of the body, as an index into the body.
    parents: Vec<Option<usize>>,
    tracks: Vec<KeyTrack>,
    /// Time of the first frame, s.
    start_s: f64,
    /// Transforms of all nodes of the document at rest, in their parents' frames.
    rest: Vec<NodeTransform>,
    /// The same in the frame that was posed last.
    locals: Vec<NodeTransform>,
    /// Global matrices of the body's nodes.
    globals: Vec<DMat4>,
}

impl<'a> KeyPoser<'a> {
    /// `rest` holds the transforms of all nodes at rest.
    pub(crate) fn new(
        tree: &'a NodeTree,
        body: &'a BodyNodes,
        tracks: Vec<KeyTrack>,
        start_s: f64,
        rest: Vec<NodeTransform>,
    ) -> Self {
        let parents = body.parents(tree);
        let globals = vec![DMat4::IDENTITY; parents.len()];
        Self { tree, body, parents, tracks, start_s, locals: rest.clone(), rest, globals }
    }

    /// Node of a joint of the body.
    fn node(&self, joint: usize) -> usize {
        self.tree.order[self.body.slots[joint]]
    }

    /// Poses a node of the body, whose parent is posed.
    fn pose_joint(&mut self, joint: usize, transform: &NodeTransform, poses: &mut JointPoses) {
        let NodeTransform { translation, rotation, scale } = *transform;
        let local = DMat4::from_scale_rotation_translation(scale, rotation, translation);
        let global = self.parents[joint].map_or(local, |parent| self.globals[parent] * local);
        self.globals[joint] = global;
        poses.positions[joint] = global.w_axis.truncate();
        poses.orientations[joint] = orientation(DMat3::from_mat4(global));
    }
}

impl FramePoser for KeyPoser<'_> {
    fn pose(&mut self, frame: usize, is_needed: &[bool], poses: &mut JointPoses) {
        let time_s = self.start_s + frame as f64 / FRAME_RATE_HZ;
        self.tracks.iter().for_each(|track| track.apply(time_s, &mut self.locals[track.node]));
        for joint in (0..self.parents.len()).filter(|joint| is_needed[*joint]) {
            let transform = self.locals[self.node(joint)];
            self.pose_joint(joint, &transform, poses);
        }
    }

    fn pose_at_rest(&mut self, poses: &mut JointPoses) {
        for joint in 0..self.parents.len() {
            let transform = self.rest[self.node(joint)];
            self.pose_joint(joint, &transform, poses);
        }
    }
}

/// The right-handed frame along a matrix's first two axes. It stays fixed to the bone under scales and mirrors.
fn orientation(matrix: DMat3) -> DQuat {
    let x = matrix.x_axis.try_normalize().unwrap_or(DVec3::X);
    let y = matrix.y_axis.reject_from_normalized(x).try_normalize().unwrap_or_else(|| x.any_orthonormal_vector());
    DQuat::from_mat3(&DMat3::from_cols(x, y, x.cross(y))).normalize()
}

//! Key tracks → global positions and orientations of a body's joints in every frame.

use glam::{DMat3, DMat4, DQuat, DVec3};

use crate::error::RejectionReason;
use crate::read::gltf::accessor;
use crate::read::gltf::clip_plan::{ClipSpan, FRAME_RATE_HZ};
use crate::read::gltf::document::Document;
use crate::read::gltf::key_track::{self, KeyTrack};
use crate::read::gltf::node_channel::moving_channels;
use crate::read::gltf::node_transform::NodeTransform;
use crate::read::gltf::node_tree::{BodyNodes, NodeTree};
use crate::read::malformed::malformed;
use crate::read::source_clip::with_room;

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

/// All that the poses of one clip depend on.
pub(crate) struct PoseSampler<'a> {
    pub tree: &'a NodeTree,
    pub body: &'a BodyNodes,
    /// Parent of each node of the body, as an index into the body.
    pub parents: &'a [Option<usize>],
    pub tracks: &'a [KeyTrack],
}

impl PoseSampler<'_> {
    /// Global positions (metres) and orientations at index frame · joint count + joint. `locals` are the transforms of
    /// all nodes at rest.
    pub(crate) fn sample(
        &self,
        mut locals: Vec<NodeTransform>,
        span: &ClipSpan,
    ) -> Result<(Vec<DVec3>, Vec<DQuat>), RejectionReason> {
        let node_frames = span.frames * self.parents.len();
        let (mut positions, mut orientations) = (with_room(node_frames)?, with_room(node_frames)?);
        for frame in 0..span.frames {
            let time_s = span.start_s + frame as f64 / FRAME_RATE_HZ;
            self.tracks.iter().for_each(|track| track.apply(time_s, &mut locals[track.node]));
            for global in self.global_matrices(&locals) {
                positions.push(global.w_axis.truncate());
                orientations.push(orientation(DMat3::from_mat4(global)));
            }
        }
        Ok((positions, orientations))
    }

    /// Global matrices of the body's nodes, in its order.
    fn global_matrices(&self, locals: &[NodeTransform]) -> Vec<DMat4> {
        let mut globals: Vec<DMat4> = Vec::with_capacity(self.parents.len());
        for (&slot, &parent) in self.body.slots.iter().zip(self.parents) {
            let NodeTransform { translation, rotation, scale } = locals[self.tree.order[slot]];
            let local = DMat4::from_scale_rotation_translation(scale, rotation, translation);
            globals.push(parent.map_or(local, |parent| globals[parent] * local));
        }
        globals
    }
}

/// The right-handed frame along a matrix's first two axes. It stays fixed to the bone under scales and mirrors.
fn orientation(matrix: DMat3) -> DQuat {
    let x = matrix.x_axis.try_normalize().unwrap_or(DVec3::X);
    let y = matrix.y_axis.reject_from_normalized(x).try_normalize().unwrap_or_else(|| x.any_orthonormal_vector());
    DQuat::from_mat3(&DMat3::from_cols(x, y, x.cross(y))).normalize()
}

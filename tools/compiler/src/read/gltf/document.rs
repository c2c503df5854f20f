//! A glTF document and the buffers of its animations.

use std::collections::BTreeSet;
use std::io::{Read, Seek};
use std::path::Path;

use gltf::json::{Index, Root, buffer::View};

use crate::error::RejectionReason;
use crate::read::gltf::buffers::{self, Outside};
use crate::read::gltf::chunks::{self, BYTES_MAX, Chunks};
use crate::read::gltf::document_json::{self, ParsedDocument};
use crate::read::gltf::node_channel::moving_channel;
use crate::read::gltf::node_transform::NodeTransform;
use crate::read::malformed::malformed;

/// A document whose nodes and skins are valid. Other parts are checked where they are read: a flaw of meshes does not
/// matter.
pub(crate) struct Document {
    pub root: Root,
    /// Bytes of the buffers that animations use.
    buffers: Vec<Option<Vec<u8>>>,
    /// Number of bytes that were read: of the JSON and of these buffers.
    pub byte_count: usize,
    /// Whether channels without a node were left out.
    pub has_nodeless_channels: bool,
}

impl Document {
    /// Reads a file and the buffers outside it; `path` is the file's.
    pub(crate) fn open(path: &Path, file: &mut (impl Read + Seek), outside: Outside) -> Result<Self, RejectionReason> {
        let Chunks { json, binary } = chunks::read(file)?;
        let ParsedDocument { root, has_nodeless_channels } = document_json::parse(&json)?;
        let buffers = vec![None; root.buffers.len()];
        let mut document = Self { root, buffers, byte_count: json.len(), has_nodeless_channels };
        drop(json);
        for index in document.animation_buffers() {
            let Some(buffer) = document.root.buffers.get(index) else { continue };
            let bytes = buffers::read(path, index, buffer, binary.map(|chunk| (&mut *file, chunk)), outside)?;
            document.byte_count += bytes.len();
            if document.byte_count > BYTES_MAX {
                let problem = format!("its animations take more than {} MiB", BYTES_MAX >> 20);
                return malformed(format!("buffer {index}"), problem, "export its clips to several files");
            }
            document.buffers[index] = Some(bytes);
        }
        Ok(document)
    }

    /// Bytes of a buffer view, and its stride; none where the view lies outside its buffer.
    pub(crate) fn view(&self, index: Index<View>) -> Option<(&[u8], Option<usize>)> {
        let view = self.root.buffer_views.get(index.value())?;
        let bytes = self.buffers.get(view.buffer.value())?.as_deref()?;
        let start = usize::try_from(view.byte_offset.map_or(0, |offset| offset.0)).ok()?;
        let end = start.checked_add(usize::try_from(view.byte_length.0).ok()?)?;
        Some((bytes.get(start..end)?, view.byte_stride.map(|stride| stride.0)))
    }

    /// Transforms of all nodes at rest.
    pub(crate) fn rest_transforms(&self) -> Vec<NodeTransform> {
        self.root.nodes.iter().map(NodeTransform::of_node).collect()
    }

    /// Indices of the buffers that hold keys of moving channels.
    fn animation_buffers(&self) -> BTreeSet<usize> {
        let mut views = BTreeSet::new();
        for animation in &self.root.animations {
            let channels = animation.channels.iter().filter_map(|channel| moving_channel(animation, channel).ok()?);
            for accessor in channels.flat_map(|channel| [channel.input, channel.output]) {
                let Some(accessor) = self.root.accessors.get(accessor) else { continue };
                let sparse = accessor.sparse.iter();
                let sparse = sparse.flat_map(|sparse| [sparse.indices.buffer_view, sparse.values.buffer_view]);
                views.extend(accessor.buffer_view.into_iter().chain(sparse).map(|view| view.value()));
            }
        }
        views.into_iter().filter_map(|view| Some(self.root.buffer_views.get(view)?.buffer.value())).collect()
    }
}

//! A glTF document and the buffers that are needed of it.

use std::collections::BTreeSet;
use std::io::{Read, Seek};
use std::path::Path;

use gltf::json::{Index, Root, buffer::View};

use crate::error::RejectionReason;
use crate::read::gltf::buffers::{self, Outside};
use crate::read::gltf::chunks::{self, BYTES_MAX, BinaryChunk, Chunks};
use crate::read::gltf::document_json::{self, ParsedDocument};
use crate::read::gltf::node_channel::moving_channel;
use crate::read::gltf::node_transform::NodeTransform;
use crate::read::malformed::malformed;

/// A document whose nodes and skins are valid. Other parts are checked where they are read: a flaw of meshes does not
/// matter.
pub(crate) struct Document {
    pub root: Root,
    /// Bytes of the buffers that were read.
    buffers: Vec<Option<Vec<u8>>>,
    /// Number of bytes that were read: of the JSON and of these buffers.
    pub byte_count: usize,
    /// Whether channels without a node were left out.
    pub has_nodeless_channels: bool,
}

impl Document {
    /// Reads a file and the buffers of its animations; `path` is the file's.
    pub(crate) fn open(path: &Path, file: &mut (impl Read + Seek), outside: Outside) -> Result<Self, RejectionReason> {
        let Chunks { json, binary } = chunks::read(file)?;
        let mut document = Self::parse(&json)?;
        drop(json);
        let needed = document.animation_buffers();
        document.read_buffers(path, file, binary, outside, &needed)?;
        Ok(document)
    }

    /// The document of a file's JSON, without buffers.
    pub(crate) fn parse(json: &[u8]) -> Result<Self, RejectionReason> {
        let ParsedDocument { root, has_nodeless_channels } = document_json::parse(json)?;
        let buffers = vec![None; root.buffers.len()];
        Ok(Self { root, buffers, byte_count: json.len(), has_nodeless_channels })
    }

    /// Reads some buffers, by index.
    pub(crate) fn read_buffers(
        &mut self,
        path: &Path,
        file: &mut (impl Read + Seek),
        binary: Option<BinaryChunk>,
        outside: Outside,
        needed: &BTreeSet<usize>,
    ) -> Result<(), RejectionReason> {
        for &index in needed {
            let Some(buffer) = self.root.buffers.get(index) else { continue };
            let bytes = buffers::read(path, index, buffer, binary.map(|chunk| (&mut *file, chunk)), outside)?;
            self.byte_count += bytes.len();
            if self.byte_count > BYTES_MAX {
                let problem = format!("its content takes more than {} MiB", BYTES_MAX >> 20);
                return malformed(format!("buffer {index}"), problem, "export its clips to several files");
            }
            self.buffers[index] = Some(bytes);
        }
        Ok(())
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
        let channels = self.root.animations.iter().flat_map(|animation| {
            animation.channels.iter().filter_map(|channel| moving_channel(animation, channel).ok()?)
        });
        self.buffers_of(channels.flat_map(|channel| [channel.input, channel.output]))
    }

    /// Indices of the buffers of some accessors.
    pub(crate) fn buffers_of(&self, accessors: impl Iterator<Item = usize>) -> BTreeSet<usize> {
        let mut views = BTreeSet::new();
        for accessor in accessors {
            let Some(accessor) = self.root.accessors.get(accessor) else { continue };
            let sparse = accessor.sparse.iter();
            let sparse = sparse.flat_map(|sparse| [sparse.indices.buffer_view, sparse.values.buffer_view]);
            views.extend(accessor.buffer_view.into_iter().chain(sparse).map(|view| view.value()));
        }
        views.into_iter().filter_map(|view| Some(self.root.buffer_views.get(view)?.buffer.value())).collect()
    }
}

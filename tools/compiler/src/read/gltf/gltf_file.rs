//! An open glTF file and its clips.

use std::io::{Read, Seek};
use std::path::Path;

use motiondb::diagnostic::{Diagnostic, Note};

use crate::error::RejectionReason;
use crate::read::gltf::buffers::Outside;
use crate::read::gltf::clip_plan::{ClipPlan, ClipSpan, FRAME_RATE_HZ, clip_plans};
use crate::read::gltf::document::Document;
use crate::read::gltf::node_tree::{BodyNodes, NodeTree};
use crate::read::gltf::sampling::{KeyPoser, key_tracks};
use crate::read::source_clip::{SourceClip, SourceJoint};
use crate::read::source_motion::SourceMotion;

/// A glTF or GLB file, open for reading its clips.
pub struct GltfFile<'a> {
    path: &'a Path,
    document: Document,
    tree: NodeTree,
    bodies: Vec<BodyNodes>,
    plans: Vec<ClipPlan>,
}

/// All clips of a glTF or GLB file; `path` gives the clips' file name and the folder of its buffers.
///
/// # Errors
/// [`RejectionReason::Malformed`] at the part of the document that breaks the format.
pub fn read(path: &Path, file: impl Read + Seek) -> Result<Vec<SourceClip>, RejectionReason> {
    let open = GltfFile::open(path, file, Outside::Refused)?;
    (0..open.len()).map(|index| open.clip(index)).collect()
}

impl<'a> GltfFile<'a> {
    /// Reads the document. Its clips are read one by one by [`GltfFile::clip`].
    ///
    /// # Errors
    /// [`RejectionReason::Malformed`] where the document breaks the format or holds no animation.
    pub fn open(path: &'a Path, mut file: impl Read + Seek, outside: Outside) -> Result<Self, RejectionReason> {
        let document = Document::open(path, &mut file, outside)?;
        let tree = NodeTree::new(&document.root)?;
        let bodies = tree.bodies(&document.root);
        let plans = clip_plans(&document, &tree, &bodies)?;
        Ok(Self { path, document, tree, bodies, plans })
    }

    /// Number of clips.
    #[expect(clippy::len_without_is_empty, reason = "a file without clips does not open")]
    pub fn len(&self) -> usize {
        self.plans.len()
    }

    /// Name of a clip; empty where it is the only clip of the file and has no name.
    pub fn name(&self, index: usize) -> &str {
        &self.plans[index].name
    }

    /// One clip.
    ///
    /// # Errors
    /// [`RejectionReason::Malformed`] if the clip's part of the file breaks the format.
    pub fn clip(&self, index: usize) -> Result<SourceClip, RejectionReason> {
        self.motion(index)?.into_whole_clip()
    }

    /// The motion of one clip, as [`GltfFile::clip`], before its frames are posed.
    pub(crate) fn motion(&self, index: usize) -> Result<SourceMotion<'_>, RejectionReason> {
        let plan = &self.plans[index];
        let ClipSpan { start_s, frames } = plan.span.clone()?;
        let body = &self.bodies[plan.body];
        let tracks = key_tracks(&self.document, plan.animation, &body.is_member(&self.tree))?;
        let joint = |(slot, parent): (&usize, Option<usize>)| SourceJoint {
            name: self.document.root.nodes[self.tree.order[*slot]].name.clone().unwrap_or_default(),
            parent,
            is_end: false,
        };
        let pointers = self.document.has_nodeless_channels.then_some(Diagnostic::Note(Note::PointersNotRead));
        let head = SourceClip {
            file: self.path.file_name().map_or_else(String::new, |name| name.to_string_lossy().into_owned()),
            clip: plan.name.clone(),
            joints: body.slots.iter().zip(body.parents(&self.tree)).map(joint).collect(),
            first_frame: 0,
            frame_rate_hz: FRAME_RATE_HZ,
            positions: Vec::new(),
            oriented: 0,
            orientations: Vec::new(),
            up_axis: None,
            metres_per_unit: Some(1.0),
            diagnostics: pointers.into_iter().collect(),
        };
        let poser = KeyPoser::new(&self.tree, body, tracks, start_s, self.document.rest_transforms());
        Ok(SourceMotion::new(head, frames, poser))
    }
}

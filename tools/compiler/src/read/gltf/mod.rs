//! glTF → [`SourceClip`]s, one for an animation of a body, sampled at 30 frames a second from its first key.
//!
//! All nodes of a body count as joints, skinned or not. Scales above the joints (Mixamo 0.01, Blender 100) are
//! multiplied into the positions; a joint's orientation is the rotation in its global matrix. glTF is metres, Y up by
//! definition; up is measured all the same.
//!
//! Clips are read one by one from the open file: a file of thousands of animations is never held as thousands of clips.

pub(crate) mod accessor;
pub(crate) mod buffers;
pub(crate) mod document;
pub(crate) mod plan;
pub(crate) mod track;
pub(crate) mod tree;

use std::path::Path;

use glam::{DMat3, DMat4, DQuat, DVec3};
use motiondb::diagnostic::{Diagnostic, Note};

use crate::error::ImportError;
use crate::read::gltf::document::{Document, Flaw, Transform, flaw};
use crate::read::gltf::plan::{Plan, Span, plans, sources};
use crate::read::gltf::track::Track;
use crate::read::gltf::tree::{Body, Tree};
use crate::read::source_clip::{SourceClip, SourceJoint};

/// Sampling rate: that of most recorded clips; keys of animated characters are no denser.
pub(crate) const FRAME_RATE_HZ: f64 = 30.0;
/// Most keys that the tracks of one clip read, besides eight for each byte of the file: tracks may share their keys.
const FREE_KEYS: usize = 4_000_000;
const KEYS_PER_BYTE: usize = 8;

/// A glTF or GLB file, open for reading its clips.
pub struct GltfFile<'a> {
    file: &'a Path,
    document: Document<'a>,
    tree: Tree,
    rest: Vec<Transform>,
    bodies: Vec<Body>,
    plans: Vec<Plan>,
}

/// Reads every clip of a glTF or GLB file from its bytes; `file` is for names, messages and buffers beside it.
///
/// # Errors
/// [`ImportError::Gltf`] with the part of the document that is malformed.
pub fn read(file: &Path, bytes: &[u8]) -> Result<Vec<SourceClip>, ImportError> {
    let open = GltfFile::open(file, bytes)?;
    (0..open.len()).map(|index| open.clip(index)).collect()
}

fn import_error(file: &Path, flaw: Flaw) -> ImportError {
    ImportError::Gltf { file: file.to_owned(), place: flaw.place, problem: flaw.problem, remedy: flaw.remedy }
}

impl<'a> GltfFile<'a> {
    /// Reads the document; the clips are read one by one.
    ///
    /// # Errors
    /// [`ImportError::Gltf`] where the document is malformed or holds no animation.
    pub fn open(file: &'a Path, bytes: &'a [u8]) -> Result<Self, ImportError> {
        let opened = Document::open(file, bytes).and_then(|document| {
            let tree = Tree::new(&document.root)?;
            let bodies = tree.bodies(&document.root);
            let plans = plans(&document, &tree, &bodies)?;
            Ok(Self { file, rest: document.rest(), document, tree, bodies, plans })
        });
        opened.map_err(|flaw| import_error(file, flaw))
    }

    /// Number of clips.
    #[expect(clippy::len_without_is_empty, reason = "a file without clips does not open")]
    pub fn len(&self) -> usize {
        self.plans.len()
    }

    /// A clip's name; empty for the only one of a file if it has none.
    pub fn name(&self, index: usize) -> &str {
        &self.plans[index].name
    }

    /// Reads one clip.
    ///
    /// # Errors
    /// [`ImportError::Gltf`] where its part of the file is malformed.
    pub fn clip(&self, index: usize) -> Result<SourceClip, ImportError> {
        self.sampled(&self.plans[index]).map_err(|flaw| import_error(self.file, flaw))
    }

    fn sampled(&self, plan: &Plan) -> Result<SourceClip, Flaw> {
        let span = plan.span.clone()?;
        let body = &self.bodies[plan.body];
        let tracks = tracks(&self.document, plan.animation, &body.is_in(&self.tree))?;
        let local_parents = body.parents(&self.tree);
        let (positions, orientations) = self.frames(body, &local_parents, &tracks, &span);
        let joint = |(place, &parent): (&usize, &Option<usize>)| SourceJoint {
            name: self.document.root.nodes[self.tree.order[*place]].name.clone().unwrap_or_default(),
            parent,
            is_end: false,
        };
        Ok(SourceClip {
            file: self.file.file_name().map_or_else(String::new, |name| name.to_string_lossy().into_owned()),
            clip: plan.name.clone(),
            joints: body.places.iter().zip(&local_parents).map(joint).collect(),
            first_frame: 0,
            frame_rate_hz: FRAME_RATE_HZ,
            positions,
            orientations,
            up_axis: None,
            metres_per_unit: Some(1.0),
            diagnostics: self
                .document
                .left_out
                .then_some(Diagnostic::Note(Note::PointersNotRead))
                .into_iter()
                .collect(),
        })
    }

    /// Global positions and orientations, frame-major.
    fn frames(
        &self,
        body: &Body,
        parents: &[Option<usize>],
        tracks: &[Track],
        span: &Span,
    ) -> (Vec<DVec3>, Vec<DQuat>) {
        let (mut positions, mut orientations) = (Vec::new(), Vec::new());
        positions.reserve_exact(span.frames * parents.len());
        orientations.reserve_exact(span.frames * parents.len());
        let mut locals = self.rest.clone();
        for frame in 0..span.frames {
            let time_s = span.start_s + frame as f64 / FRAME_RATE_HZ;
            tracks.iter().for_each(|track| track.apply(time_s, &mut locals[track.node]));
            for global in self.globals(body, parents, &locals) {
                positions.push(global.w_axis.truncate());
                orientations.push(orientation(DMat3::from_mat4(global)));
            }
        }
        (positions, orientations)
    }

    /// One frame's global matrices, in the body's order.
    fn globals(&self, body: &Body, parents: &[Option<usize>], locals: &[Transform]) -> Vec<DMat4> {
        let mut globals: Vec<DMat4> = Vec::with_capacity(parents.len());
        for (&place, &parent) in body.places.iter().zip(parents) {
            let Transform { translation, rotation, scale } = locals[self.tree.order[place]];
            let local = DMat4::from_scale_rotation_translation(scale, rotation, translation);
            globals.push(parent.map_or(local, |parent| globals[parent] * local));
        }
        globals
    }
}

/// Reads the tracks of a clip, as long as the file pays for their keys.
fn tracks(document: &Document, animation: usize, is_in: &[bool]) -> Result<Vec<Track>, Flaw> {
    let sources = sources(document, animation, is_in)?;
    let mut keys = 0_usize;
    for source in &sources {
        keys = keys.saturating_add(accessor::count(document, source.input)?);
        keys = keys.saturating_add(accessor::count(document, source.output)?);
    }
    if keys > FREE_KEYS.saturating_add(KEYS_PER_BYTE.saturating_mul(document.byte_count)) {
        let name = format!("animation {animation}");
        return flaw(name, "its tracks share their keys beyond measure", "export it with keys of their own");
    }
    sources.iter().map(|source| track::read(document, source)).collect()
}

/// The right-handed frame along a matrix's first two axes: fixed to the bone, also under scales and mirrors.
fn orientation(matrix: DMat3) -> DQuat {
    let x = matrix.x_axis.try_normalize().unwrap_or(DVec3::X);
    let y = matrix.y_axis.reject_from_normalized(x).try_normalize().unwrap_or_else(|| x.any_orthonormal_vector());
    DQuat::from_mat3(&DMat3::from_cols(x, y, x.cross(y))).normalize()
}

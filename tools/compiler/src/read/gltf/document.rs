//! The bytes of a glTF or GLB file as a document whose indices hold, with the buffers that its animations use.
//!
//! The `gltf` crate reads the JSON; its wrappers are not used: they panic on hostile documents, and look each accessor
//! up from the first one on. Only what moves joints counts: what is wrong with meshes, or compressed there, is no
//! matter.

use std::borrow::Cow;
use std::collections::BTreeSet;
use std::path::Path;

use glam::{DMat4, DQuat, DVec3};
use gltf::json::validation::{Error, Validate};
use gltf::json::{self, Index, Root, buffer::View};
use motiondb::files::input_file;
use serde::Deserialize;

use crate::read::catch_panic;
use crate::read::gltf::buffers;
use crate::read::gltf::track::{self, normal};

/// Flaws of one document that a message lists, and the letters of any other message.
const SHOWN_FLAWS: usize = 3;
const SHOWN_LETTERS: usize = 500;
/// The parts of a document in which flaws spoil every animation; what one animation uses is checked where it is read.
const PARTS: [&str; 2] = ["nodes", "skins"];

/// What is wrong, and where.
#[derive(Clone, Debug)]
pub(crate) struct Flaw {
    pub place: String,
    pub problem: String,
    pub remedy: &'static str,
}

pub(crate) fn flaw<T>(place: impl Into<String>, problem: impl Into<String>, remedy: &'static str) -> Result<T, Flaw> {
    Err(Flaw { place: place.into(), problem: problem.into(), remedy })
}

/// A document and the bytes behind it.
pub(crate) struct Document<'a> {
    pub root: Root,
    /// Those that animations use.
    buffers: Vec<Option<Cow<'a, [u8]>>>,
    /// Of the file and of all buffers beside it.
    pub byte_count: usize,
    /// Channels were left out that name no node.
    pub left_out: bool,
}

/// Translation, rotation, scale: applied in the order scale, rotation, translation.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Transform {
    pub translation: DVec3,
    pub rotation: DQuat,
    pub scale: DVec3,
}

impl<'a> Document<'a> {
    /// Reads a file's bytes, and the buffers beside it.
    pub(crate) fn open(file: &Path, bytes: &'a [u8]) -> Result<Self, Flaw> {
        check_is_gltf(bytes)?;
        let unwound = || flaw("document", "the document contradicts itself", "check it with the glTF validator");
        let Parsed { root, chunk, left_out } = catch_panic::catch(|| parse(bytes)).unwrap_or_else(unwound)?;
        let mut document = Self { buffers: vec![None; root.buffers.len()], root, byte_count: bytes.len(), left_out };
        for index in document.used_buffers() {
            let Some(buffer) = document.root.buffers.get(index) else { continue };
            let read = buffers::read(file, index, buffer, chunk.as_ref())?;
            document.byte_count += if let Cow::Owned(read) = &read { read.len() } else { 0 };
            document.buffers[index] = Some(read);
        }
        Ok(document)
    }

    /// The bytes of a view, and its stride.
    pub(crate) fn view(&self, index: Index<View>) -> Option<(&[u8], Option<usize>)> {
        let view = self.root.buffer_views.get(index.value())?;
        let bytes = self.buffers.get(view.buffer.value())?.as_deref()?;
        let start = usize::try_from(view.byte_offset.map_or(0, |offset| offset.0)).ok()?;
        let end = start.checked_add(usize::try_from(view.byte_length.0).ok()?)?;
        Some((bytes.get(start..end)?, view.byte_stride.map(|stride| stride.0)))
    }

    /// The nodes' own transforms.
    pub(crate) fn rest(&self) -> Vec<Transform> {
        self.root.nodes.iter().map(rest).collect()
    }

    fn used_buffers(&self) -> BTreeSet<usize> {
        let mut views = BTreeSet::new();
        for animation in &self.root.animations {
            let sources = animation.channels.iter().filter_map(|channel| track::source(animation, channel).ok()?);
            for accessor in sources.flat_map(|source| [source.input, source.output]) {
                let Some(accessor) = self.root.accessors.get(accessor) else { continue };
                let sparse = accessor.sparse.iter();
                let sparse = sparse.flat_map(|sparse| [sparse.indices.buffer_view, sparse.values.buffer_view]);
                views.extend(accessor.buffer_view.into_iter().chain(sparse).map(|view| view.value()));
            }
        }
        views.into_iter().filter_map(|view| Some(self.root.buffer_views.get(view)?.buffer.value())).collect()
    }
}

/// What is no glTF at all, by its first bytes: an upload that was cut off, a download that was never unpacked.
fn check_is_gltf(bytes: &[u8]) -> Result<(), Flaw> {
    if bytes.is_empty() {
        return flaw("byte 0", "the file is empty", "export the clip again");
    }
    if let [b'g', b'l', b'T', b'F', _, _, _, _, length @ ..] = bytes
        && let Some(&length) = length.first_chunk()
        && u32::from_le_bytes(length) as usize > bytes.len()
    {
        let problem = format!("the file is cut short: {} of {} bytes", bytes.len(), u32::from_le_bytes(length));
        return flaw(format!("byte {}", bytes.len()), problem, "copy or export it again");
    }
    if bytes.starts_with(b"PK\x03\x04") {
        return flaw("byte 0", "the file is a zip archive", "unpack it");
    }
    if input_file::is_utf16(bytes) {
        return flaw("byte 0", "the text is UTF-16, two bytes a letter", "save it as UTF-8");
    }
    if bytes.starts_with(b"\xef\xbb\xbf") {
        return flaw("byte 0", "the text begins with a byte order mark", "save it as UTF-8 without one");
    }
    Ok(())
}

/// What a file's own bytes hold.
struct Parsed<'a> {
    root: Root,
    /// The binary one of a GLB file.
    chunk: Option<Cow<'a, [u8]>>,
    /// Channels were left out that name no node.
    left_out: bool,
}

fn parse(bytes: &[u8]) -> Result<Parsed<'_>, Flaw> {
    let shown = |error: &dyn std::error::Error| Flaw {
        place: "document".to_owned(),
        problem: error.to_string().trim_end_matches([';', ' ']).chars().take(SHOWN_LETTERS).collect(),
        remedy: "check it with the glTF validator, or export it again",
    };
    let (json, chunk) = chunks(bytes).map_err(|error| shown(&error))?;
    check_version(&json)?;
    let (root, left_out) = match json::deserialize::from_slice::<Root>(&json) {
        Ok(root) => (root, false),
        Err(error) => (without_nodeless_channels(&json).ok_or_else(|| shown(&error))?, true),
    };
    check(&root)?;
    Ok(Parsed { root, chunk, left_out })
}

/// The part of a document that says which glTF it is.
#[derive(Deserialize)]
struct Versioned {
    asset: json::Asset,
}

/// That it is glTF 2: a later 2.x too, unless it says that a reader of 2.0 cannot read it.
fn check_version(json: &[u8]) -> Result<(), Flaw> {
    // What else is wrong with it, reading all of it tells.
    let Ok(Versioned { asset }) = json::deserialize::from_slice(json) else { return Ok(()) };
    let is_read = match &asset.min_version {
        Some(least) => least == "2.0",
        None => asset.version.split('.').next() == Some("2"),
    };
    let needed = asset.min_version.unwrap_or(asset.version);
    if is_read { Ok(()) } else { flaw("asset", format!("it needs a reader of glTF {needed}"), "export it as glTF 2.0") }
}

/// The JSON of a file, and the binary chunk of a GLB file.
type Chunks<'a> = (Cow<'a, [u8]>, Option<Cow<'a, [u8]>>);

fn chunks(bytes: &[u8]) -> Result<Chunks<'_>, gltf::Error> {
    if !bytes.starts_with(b"glTF") {
        return Ok((Cow::Borrowed(bytes), None));
    }
    gltf::Glb::from_slice(bytes).map(|glb| (glb.json, glb.bin))
}

/// Where the buffers and pictures of a file lie, unless within it; none of what is no document.
pub(crate) fn uris(bytes: &[u8]) -> Vec<String> {
    let json = catch_panic::catch(|| chunks(bytes)).and_then(Result::ok);
    let document: json::Value =
        json.and_then(|(json, _)| json::deserialize::from_slice(&json).ok()).unwrap_or_default();
    let parts = ["buffers", "images"].iter().filter_map(|part| document.get(part)?.as_array()).flatten();
    parts.filter_map(|part| Some(part.get("uri")?.as_str()?.to_owned())).collect()
}

/// The document without the channels that name no node, as those of KHR_animation_pointer; none where it has no such
/// channel, or another flaw.
fn without_nodeless_channels(json: &[u8]) -> Option<Root> {
    let mut document: json::Value = json::deserialize::from_slice(json).ok()?;
    let mut left_out = false;
    for animation in document.get_mut("animations")?.as_array_mut()? {
        let channels = animation.get_mut("channels")?.as_array_mut()?;
        let count = channels.len();
        channels.retain(|channel| channel.get("target").is_some_and(|target| target.get("node").is_some()));
        left_out |= channels.len() < count;
    }
    left_out.then(|| json::deserialize::from_value(document).ok())?
}

/// That indices and types hold where they matter.
fn check(root: &Root) -> Result<(), Flaw> {
    let mut flaws: Vec<String> = Vec::new();
    let mut count = 0;
    root.validate(root, json::Path::new, &mut |path, error: Error| {
        let path = path();
        if PARTS.iter().any(|part| path.as_str().starts_with(part)) {
            count += 1;
            if count <= SHOWN_FLAWS {
                flaws.push(format!("{path}: {error}"));
            }
        }
    });
    if count > SHOWN_FLAWS {
        flaws.push(format!("and {} more", count - SHOWN_FLAWS));
    }
    if flaws.is_empty() {
        return Ok(());
    }
    flaw("document", flaws.join("; "), "check it with the glTF validator, or export it again")
}

/// A node's own transform. One given as a matrix keeps no shear, which glTF does not allow in it.
fn rest(node: &json::Node) -> Transform {
    let vector =
        |value: Option<[f32; 3]>, default| value.map_or(default, |value| DVec3::from_array(value.map(f64::from)));
    if let Some(matrix) = node.matrix {
        let matrix = DMat4::from_cols_array(&matrix.map(f64::from));
        let (scale, rotation, translation) = matrix.to_scale_rotation_translation();
        return Transform { translation, rotation: finite(rotation), scale };
    }
    let rotation = node.rotation.map_or(DQuat::IDENTITY, |turn| DQuat::from_array(turn.0.map(f64::from)));
    Transform {
        translation: vector(node.translation, DVec3::ZERO),
        rotation: finite(rotation),
        scale: vector(node.scale, DVec3::ONE),
    }
}

fn finite(rotation: DQuat) -> DQuat {
    if rotation.is_finite() { normal(rotation) } else { DQuat::IDENTITY }
}

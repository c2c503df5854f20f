//! The bytes of a glTF or GLB file as plain nodes and key-frame tracks.
//!
//! The `gltf` crate panics on hostile documents, so all use of it is in here and runs under `catch_unwind`; what comes out is owned and
//! checked. Buffers are read here too (GLB chunk, `data:` URI, file beside the document): never more bytes than are there, and no accessor
//! whose count its bytes do not pay for.

use std::io::Read;
use std::path::Path;

use base64::Engine;
use base64::engine::general_purpose::STANDARD;
use glam::{DQuat, DVec3};
use gltf::accessor::{Accessor, DataType, Dimensions};
use gltf::animation::util::ReadOutputs;
use gltf::animation::{Channel, Interpolation};
use gltf::json::validation;
use motiondb::input_file;

/// Flaws of one document that a message lists, and the letters of any other message.
const SHOWN_FLAWS: usize = 3;
const SHOWN_LETTERS: usize = 500;

/// What is wrong, and where.
#[derive(Debug)]
pub(crate) struct Flaw {
    pub place: String,
    pub problem: String,
    pub remedy: &'static str,
}

/// A node in its parent's frame.
#[derive(Clone, Debug)]
pub(crate) struct Node {
    pub name: String,
    pub children: Vec<usize>,
    pub rest: Transform,
}

/// Translation, rotation, scale: applied in the order scale, rotation, translation.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Transform {
    pub translation: DVec3,
    pub rotation: DQuat,
    pub scale: DVec3,
}

/// One animation.
#[derive(Debug)]
pub(crate) struct Animation {
    pub name: Option<String>,
    pub tracks: Vec<Track>,
}

/// Keys of one property of one node.
#[derive(Debug)]
pub(crate) struct Track {
    pub node: usize,
    /// Seconds, increasing.
    pub times_s: Vec<f64>,
    pub interpolation: Interpolation,
    pub values: Values,
}

/// One value a key; three (in-tangent, value, out-tangent) where the interpolation is cubic.
#[derive(Debug)]
pub(crate) enum Values {
    Translations(Vec<DVec3>),
    Rotations(Vec<DQuat>),
    Scales(Vec<DVec3>),
}

impl Values {
    fn len(&self) -> usize {
        match self {
            Self::Translations(values) | Self::Scales(values) => values.len(),
            Self::Rotations(values) => values.len(),
        }
    }

    fn all_finite(&self) -> bool {
        match self {
            Self::Translations(values) | Self::Scales(values) => values.iter().all(|value| value.is_finite()),
            Self::Rotations(values) => values.iter().all(|value| value.is_finite()),
        }
    }
}

/// Nodes and animations of a file.
pub(crate) fn parse(file: &Path, bytes: &[u8]) -> Result<(Vec<Node>, Vec<Animation>), Flaw> {
    let unwound = || flaw("document", "the document contradicts itself", "check it with the glTF validator");
    crate::quiet_unwind::catch(|| parse_unguarded(file, bytes)).unwrap_or_else(unwound)
}

fn flaw<T>(place: impl Into<String>, problem: impl Into<String>, remedy: &'static str) -> Result<T, Flaw> {
    Err(Flaw { place: place.into(), problem: problem.into(), remedy })
}

fn parse_unguarded(file: &Path, bytes: &[u8]) -> Result<(Vec<Node>, Vec<Animation>), Flaw> {
    let document = gltf::Gltf::from_slice(bytes).or_else(|error| flaw("document", shown(&error), remedy(&error)))?;
    let chunk = document.blob.as_deref();
    let buffers =
        document.buffers().map(|buffer| read_buffer(file, &buffer, chunk)).collect::<Result<Vec<_>, Flaw>>()?;
    let nodes = document.nodes().map(|node| own_node(&node)).collect();
    let animations = document
        .animations()
        .map(|animation| {
            let tracks = animation.channels().filter_map(|channel| track(&channel, &buffers).transpose());
            Ok(Animation { name: animation.name().map(str::to_owned), tracks: tracks.collect::<Result<_, Flaw>>()? })
        })
        .collect::<Result<_, Flaw>>()?;
    Ok((nodes, animations))
}

/// What is wrong in a document, in short: one slip at its start may put thousands of indices out of bounds.
fn shown(error: &gltf::Error) -> String {
    match error {
        gltf::Error::Validation(flaws) if flaws.len() > SHOWN_FLAWS => {
            let first: Vec<String> =
                flaws[..SHOWN_FLAWS].iter().map(|(path, flaw)| format!("{path}: {flaw}")).collect();
            format!("{}; and {} more", first.join("; "), flaws.len() - SHOWN_FLAWS)
        }
        _ => error.to_string().trim_end_matches([';', ' ']).chars().take(SHOWN_LETTERS).collect(),
    }
}

fn remedy(error: &gltf::Error) -> &'static str {
    match error {
        gltf::Error::Validation(flaws) if flaws.iter().any(|(_, flaw)| *flaw == validation::Error::Unsupported) => {
            "export it without the extension that it requires, uncompressed"
        }
        _ => "check it with the glTF validator, or export it again",
    }
}

fn own_node(node: &gltf::Node) -> Node {
    let (translation, rotation, scale) = node.transform().decomposed();
    let rotation = DQuat::from_array(rotation.map(f64::from));
    Node {
        name: node.name().unwrap_or_default().to_owned(),
        children: node.children().map(|child| child.index()).collect(),
        rest: Transform {
            translation: DVec3::from_array(translation.map(f64::from)),
            rotation: if rotation.is_finite() && rotation.length() > 0.0 {
                rotation.normalize()
            } else {
                DQuat::IDENTITY
            },
            scale: DVec3::from_array(scale.map(f64::from)),
        },
    }
}

fn read_buffer(file: &Path, buffer: &gltf::Buffer, chunk: Option<&[u8]>) -> Result<Vec<u8>, Flaw> {
    let place = format!("buffer {}", buffer.index());
    let bytes = match buffer.source() {
        gltf::buffer::Source::Bin => chunk.map(<[u8]>::to_vec),
        gltf::buffer::Source::Uri(uri) => match uri.strip_prefix("data:") {
            Some(data) => data.split_once(";base64,").and_then(|(_, text)| STANDARD.decode(text).ok()),
            None => read_beside(file, uri, buffer.length()),
        },
    };
    match bytes {
        Some(bytes) if bytes.len() >= buffer.length() => Ok(bytes),
        Some(bytes) => {
            let problem = format!("{} bytes where the document claims {}", bytes.len(), buffer.length());
            flaw(place, problem, "the file is cut short: copy or export it again")
        }
        None => flaw(place, "its bytes cannot be read", "keep the .bin file beside the .gltf file, or export a .glb"),
    }
}

/// At most `length` bytes of a file named relative to the document.
fn read_beside(file: &Path, uri: &str, length: usize) -> Option<Vec<u8>> {
    let path = file.parent()?.join(percent_decoded(uri)?);
    let mut bytes = Vec::new();
    input_file::open(&path).ok()?.take(length as u64).read_to_end(&mut bytes).ok()?;
    Some(bytes)
}

fn percent_decoded(uri: &str) -> Option<String> {
    let mut pieces = uri.split('%');
    let mut bytes = pieces.next()?.as_bytes().to_vec();
    for piece in pieces {
        bytes.push(u8::from_str_radix(piece.get(..2)?, 16).ok()?);
        bytes.extend(piece.get(2..)?.as_bytes());
    }
    String::from_utf8(bytes).ok()
}

fn track(channel: &Channel, buffers: &[Vec<u8>]) -> Result<Option<Track>, Flaw> {
    let sampler = channel.sampler();
    let place = format!("animation {}, channel {}", channel.animation().index(), channel.index());
    for (accessor, shapes) in [
        (sampler.input(), &[Dimensions::Scalar][..]),
        (sampler.output(), &[Dimensions::Scalar, Dimensions::Vec3, Dimensions::Vec4]),
    ] {
        if !is_paid_for(&accessor, buffers) || !shapes.contains(&accessor.dimensions()) {
            let problem = format!("accessor {} asks for what its buffer does not hold", accessor.index());
            return flaw(place, problem, "check the file with the glTF validator");
        }
    }
    if sampler.input().data_type() != DataType::F32 {
        return flaw(place, "key times are not floats", "check the file with the glTF validator");
    }
    let reader = channel.reader(|buffer| buffers.get(buffer.index()).map(Vec::as_slice));
    let (Some(inputs), Some(outputs)) = (reader.read_inputs(), reader.read_outputs()) else {
        return flaw(place, "its accessors cannot be read", "check the file with the glTF validator");
    };
    let Some(values) = values(outputs) else { return Ok(None) };
    let times_s: Vec<f64> = inputs.map(f64::from).collect();
    let interpolation = sampler.interpolation();
    let per_key = if interpolation == Interpolation::CubicSpline { 3 } else { 1 };
    let increasing = times_s.windows(2).all(|pair| pair[0] < pair[1]) && times_s.iter().all(|time| time.is_finite());
    if times_s.is_empty() || !increasing || values.len() != per_key * times_s.len() || !values.all_finite() {
        return flaw(place, "keys are not finite, in order and one value each", "export the animation again");
    }
    Ok(Some(Track { node: channel.target().node().index(), times_s, interpolation, values }))
}

/// Whether an accessor's elements lie within the bytes that are there.
fn is_paid_for(accessor: &Accessor, buffers: &[Vec<u8>]) -> bool {
    let Some(view) = accessor.view() else { return false };
    let bytes = buffers.get(view.buffer().index()).map_or(0, Vec::len);
    let stride = view.stride().unwrap_or(accessor.size()).max(1);
    let end = accessor.count().checked_mul(stride).and_then(|size| size.checked_add(accessor.offset()));
    let view_end = view.offset().checked_add(view.length());
    accessor.count() > 0
        && accessor.sparse().is_none()
        && view_end.is_some_and(|end| end <= bytes)
        && end.is_some_and(|end| end <= view.length() + stride)
}

/// None for morph targets: they move no joint.
fn values(outputs: ReadOutputs) -> Option<Values> {
    let vector = |value: [f32; 3]| DVec3::from_array(value.map(f64::from));
    match outputs {
        ReadOutputs::Translations(values) => Some(Values::Translations(values.map(vector).collect())),
        ReadOutputs::Scales(values) => Some(Values::Scales(values.map(vector).collect())),
        ReadOutputs::Rotations(values) => {
            Some(Values::Rotations(values.into_f32().map(|value| DQuat::from_array(value.map(f64::from))).collect()))
        }
        ReadOutputs::MorphTargetWeights(_) => None,
    }
}

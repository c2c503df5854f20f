//! The bytes behind a glTF document: the chunk of a GLB file, `data:` URIs, files beside it.
//!
//! Never more bytes than are there, and nothing from outside the document's folder: a clip is no way to read another's
//! files.

use std::borrow::Cow;
use std::io::Read;
use std::path::{Component, Path, PathBuf};

use base64::Engine;
use base64::alphabet::STANDARD;
use base64::engine::{DecodePaddingMode, GeneralPurpose, GeneralPurposeConfig};
use gltf::json;
use motiondb::files::input_file;

use crate::read::gltf::document::{Flaw, flaw};

/// Some exporters leave the padding out.
const BASE64: GeneralPurpose = GeneralPurpose::new(
    &STANDARD,
    GeneralPurposeConfig::new().with_decode_padding_mode(DecodePaddingMode::Indifferent),
);

/// The bytes of one buffer; `chunk` is the GLB file's, which belongs to the first.
pub(crate) fn read<'a>(
    file: &Path,
    index: usize,
    buffer: &json::Buffer,
    chunk: Option<&Cow<'a, [u8]>>,
) -> Result<Cow<'a, [u8]>, Flaw> {
    let place = format!("buffer {index}");
    let length = usize::try_from(buffer.byte_length.0).unwrap_or(usize::MAX);
    let bytes = match (buffer.uri.as_deref(), chunk) {
        (Some(uri), _) => Cow::Owned(from_uri(file, &place, uri, length)?),
        (None, Some(chunk)) if index == 0 => chunk.clone(),
        // As of views that EXT_meshopt_compression packs.
        (None, _) => {
            return flaw(place, "it has no bytes: its animations are compressed", "export the animations uncompressed");
        }
    };
    if bytes.len() < length {
        let problem = format!("{} bytes where the document claims {length}", bytes.len());
        return flaw(place, problem, "the file is cut short: copy or export it again");
    }
    Ok(bytes)
}

/// The files beside a document that its URIs name.
pub(crate) fn files_of(file: &Path, uris: &[String]) -> Vec<PathBuf> {
    let linked = uris.iter().filter(|uri| !uri.starts_with("data:"));
    linked.filter_map(|uri| beside(file, &percent_decoded(uri)?)).collect()
}

fn from_uri(file: &Path, place: &str, uri: &str, length: usize) -> Result<Vec<u8>, Flaw> {
    if let Some(data) = uri.strip_prefix("data:") {
        let decoded = data.split_once(";base64,").and_then(|(_, text)| BASE64.decode(text).ok());
        return decoded.map_or_else(|| flaw(place, "its data URI is no base64", "export it as .glb"), Ok);
    }
    let Some(name) = percent_decoded(uri) else {
        return flaw(place, "its URI is not percent-encoded text", "export it as .glb");
    };
    let Some(path) = beside(file, &name) else {
        let problem = format!("`{name}` lies outside the document's folder");
        return flaw(place, problem, "keep the .bin file beside the .gltf file, or export a .glb");
    };
    let mut bytes = Vec::new();
    let read = input_file::open(&path).and_then(|open| open.take(length as u64).read_to_end(&mut bytes));
    match read {
        Ok(_) => Ok(bytes),
        Err(error) => {
            let problem = format!("`{name}` cannot be read: {error}");
            flaw(place, problem, "keep the .bin file beside the .gltf file, or export a .glb")
        }
    }
}

/// A file in the document's folder or below; none for whatever leads elsewhere.
fn beside(file: &Path, name: &str) -> Option<PathBuf> {
    let is_plain = Path::new(name).components().all(|part| matches!(part, Component::Normal(_) | Component::CurDir));
    // Drives, schemes and other systems' separators.
    let is_foreign = name.contains(['\\', ':', '\0']);
    (is_plain && !is_foreign && !name.is_empty()).then(|| file.parent().unwrap_or(Path::new("")).join(name))
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

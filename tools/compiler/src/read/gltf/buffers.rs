//! Bytes of a glTF document's buffers: the chunk of a GLB file, `data:` URIs, files beside the document.
//!
//! Never more bytes than exist, and nothing outside the document's folder: a clip must not make us read other files.

use std::borrow::Cow;
use std::io::Read;
use std::path::{Component, Path, PathBuf};

use base64::Engine;
use base64::alphabet::STANDARD;
use base64::engine::{DecodePaddingMode, GeneralPurpose, GeneralPurposeConfig};
use gltf::json;
use motiondb::files::input_file;

use crate::error::RejectionReason;
use crate::read::malformed::malformed;

/// Base64 with or without padding: some exporters leave it out.
const BASE64: GeneralPurpose = GeneralPurpose::new(
    &STANDARD,
    GeneralPurposeConfig::new().with_decode_padding_mode(DecodePaddingMode::Indifferent),
);
/// Remedy for a buffer in a file that cannot be read.
const KEEP_BESIDE: &str = "keep the .bin file beside the .gltf file, or export a .glb";

/// Bytes of one buffer. `chunk` is the binary chunk of a GLB file, which belongs to the first buffer.
pub(crate) fn read<'a>(
    file: &Path,
    index: usize,
    buffer: &json::Buffer,
    chunk: Option<&Cow<'a, [u8]>>,
) -> Result<Cow<'a, [u8]>, RejectionReason> {
    let position = format!("buffer {index}");
    let length = usize::try_from(buffer.byte_length.0).unwrap_or(usize::MAX);
    let bytes = match (buffer.uri.as_deref(), chunk) {
        (Some(uri), _) => Cow::Owned(from_uri(file, &position, uri, length)?),
        (None, Some(chunk)) if index == 0 => chunk.clone(),
        // Such are the buffers that EXT_meshopt_compression replaces.
        (None, _) => {
            let problem = "it has no bytes: its animations are compressed";
            return malformed(position, problem, "export the animations uncompressed");
        }
    };
    if bytes.len() < length {
        let problem = format!("{} bytes where the document states {length}", bytes.len());
        return malformed(position, problem, "the file is cut short: copy or export it again");
    }
    Ok(bytes)
}

/// Paths of the files in the document's folder that URIs name.
pub(crate) fn linked_paths(file: &Path, uris: &[String]) -> Vec<PathBuf> {
    let linked = uris.iter().filter(|uri| !uri.starts_with("data:"));
    linked.filter_map(|uri| path_beside(file, &percent_decoded(uri)?)).collect()
}

fn from_uri(file: &Path, position: &str, uri: &str, length: usize) -> Result<Vec<u8>, RejectionReason> {
    if let Some(data) = uri.strip_prefix("data:") {
        let decoded = data.split_once(";base64,").and_then(|(_, text)| BASE64.decode(text).ok());
        return decoded.map_or_else(|| malformed(position, "its data URI is not base64", "export it as .glb"), Ok);
    }
    let Some(name) = percent_decoded(uri) else {
        return malformed(position, "its URI is not percent-encoded text", "export it as .glb");
    };
    let Some(path) = path_beside(file, &name) else {
        return malformed(position, format!("`{name}` lies outside the document's folder"), KEEP_BESIDE);
    };
    let mut bytes = Vec::new();
    match input_file::open(&path).and_then(|open| open.take(length as u64).read_to_end(&mut bytes)) {
        Ok(_) => Ok(bytes),
        Err(error) => malformed(position, format!("`{name}` cannot be read: {error}"), KEEP_BESIDE),
    }
}

/// Path of a file in the document's folder or below; none for a name that leads elsewhere.
fn path_beside(file: &Path, name: &str) -> Option<PathBuf> {
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

//! Bytes of a glTF document's buffers: the chunk of a GLB file, `data:` URIs, files beside the document.
//!
//! Never more bytes than exist, and nothing outside the document's folder unless the user allows it: neither a path nor
//! a link of a clip makes us read other files.

use std::io::{Read, Seek, SeekFrom};
use std::path::{Component, Path, PathBuf};

use base64::Engine;
use base64::alphabet::STANDARD;
use base64::engine::{DecodePaddingMode, GeneralPurpose, GeneralPurposeConfig};
use gltf::json;
use motiondb::files::input_file;

use crate::error::RejectionReason;
use crate::read::gltf::chunks::{self, BYTES_MAX, BinaryChunk};
use crate::read::malformed::malformed;

/// Base64 with or without padding: some exporters leave it out.
const BASE64: GeneralPurpose = GeneralPurpose::new(
    &STANDARD,
    GeneralPurposeConfig::new().with_decode_padding_mode(DecodePaddingMode::Indifferent),
);
/// Remedy for a buffer outside the document's folder.
const MOVE_OR_ALLOW: &str = "move the file beside the .gltf file, or allow it with --allow-outside";
/// Remedy for a buffer in a file that cannot be read.
const KEEP_BESIDE: &str = "keep the file beside the .gltf file, or export a .glb";

/// Bytes of one buffer, as many as the document states. `chunk` is the file and its binary chunk, which belongs to the
/// first buffer.
pub(crate) fn read<F: Read + Seek>(
    path: &Path,
    index: usize,
    buffer: &json::Buffer,
    chunk: Option<(&mut F, BinaryChunk)>,
    outside: Outside,
) -> Result<Vec<u8>, RejectionReason> {
    let position = format!("buffer {index}");
    let length = usize::try_from(buffer.byte_length.0).unwrap_or(usize::MAX);
    let bytes = match (buffer.uri.as_deref(), chunk) {
        (Some(uri), _) => from_uri(path, &position, uri, length, outside)?,
        (None, Some((file, chunk))) if index == 0 => from_chunk(file, chunk, length)?,
        // Such are the buffers that EXT_meshopt_compression replaces.
        (None, _) => {
            let problem = "it has no bytes: its content is compressed";
            return malformed(position, problem, "export the file uncompressed");
        }
    };
    if bytes.len() < length.min(BYTES_MAX) {
        let problem = format!("{} bytes where the document states {length}", bytes.len());
        return malformed(position, problem, "the file is cut short: copy or export it again");
    }
    Ok(bytes)
}

/// The beginning of a binary chunk. One byte more than a document may have shows that it has more.
fn from_chunk(file: &mut (impl Read + Seek), chunk: BinaryChunk, length: usize) -> Result<Vec<u8>, RejectionReason> {
    file.seek(SeekFrom::Start(chunk.start)).map_err(|error| RejectionReason::unreadable(&error))?;
    chunks::read_up_to(file, chunk.length.min(length as u64).min(BYTES_MAX as u64 + 1))
}

/// Whether a document's buffers may lie outside its folder.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Outside {
    /// A path or a link that leads outside is an error.
    #[default]
    Refused,
    /// Every path is read.
    Allowed,
}

/// Paths of the files that URIs name, also outside the document's folder.
pub(crate) fn linked_paths(file: &Path, uris: &[String]) -> Vec<PathBuf> {
    let linked = uris.iter().filter(|uri| !uri.starts_with("data:"));
    linked.filter_map(|uri| named_path(file, &percent_decoded(uri)?)).collect()
}

/// Up to `length` bytes of a URI that a part of a document states.
pub(crate) fn from_uri(
    file: &Path,
    position: &str,
    uri: &str,
    length: usize,
    outside: Outside,
) -> Result<Vec<u8>, RejectionReason> {
    if let Some(data) = uri.strip_prefix("data:") {
        let decoded = data.split_once(";base64,").and_then(|(_, text)| BASE64.decode(text).ok());
        let Some(mut bytes) = decoded else {
            return malformed(position, "its data URI is not base64", "export it as .glb");
        };
        bytes.truncate(length);
        return Ok(bytes);
    }
    let Some(name) = percent_decoded(uri) else {
        return malformed(position, "its URI is not percent-encoded text", "export it as .glb");
    };
    let Some(path) = named_path(file, &name) else {
        return malformed(position, format!("`{name}` is no path of a file beside the document"), KEEP_BESIDE);
    };
    if outside == Outside::Refused && !is_beside(file, &name, &path) {
        return malformed(position, format!("`{name}` lies outside the document's folder"), MOVE_OR_ALLOW);
    }
    let most = (length as u64).min(BYTES_MAX as u64 + 1);
    let mut bytes = Vec::new();
    match input_file::open(&path).and_then(|open| open.take(most).read_to_end(&mut bytes)) {
        Ok(_) => Ok(bytes),
        Err(error) if input_file::is_of_machine(&error) => Err(RejectionReason::unreadable(&error)),
        Err(error) => malformed(position, format!("`{name}` cannot be read: {error}"), KEEP_BESIDE),
    }
}

/// Path of a file that a document names; none for a name with a drive, a scheme or other systems' separators.
fn named_path(file: &Path, name: &str) -> Option<PathBuf> {
    let is_foreign = name.contains(['\\', ':', '\0']);
    (!is_foreign && !name.is_empty()).then(|| file.parent().unwrap_or(Path::new("")).join(name))
}

/// Whether a named path is in the document's folder or below, also after its links are followed.
fn is_beside(file: &Path, name: &str, path: &Path) -> bool {
    let is_plain = Path::new(name).components().all(|part| matches!(part, Component::Normal(_) | Component::CurDir));
    let folder = file.parent().filter(|folder| !folder.as_os_str().is_empty()).unwrap_or(Path::new("."));
    // A file that does not exist leads nowhere.
    let leads_outside = || match (folder.canonicalize(), path.canonicalize()) {
        (Ok(folder), Ok(path)) => !path.starts_with(folder),
        _ => false,
    };
    is_plain && !leads_outside()
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

#[cfg(all(test, unix))]
mod tests {
    use std::fs;
    use std::os::unix::fs::symlink;

    use super::*;

    #[test]
    fn nothing_outside_is_read_unless_allowed() {
        let folder = tempfile::tempdir().unwrap();
        let (outside, inside) = (folder.path().join("outside"), folder.path().join("inside"));
        fs::create_dir_all(inside.join("bin")).unwrap();
        fs::create_dir(&outside).unwrap();
        fs::write(outside.join("a.bin"), "that").unwrap();
        fs::write(inside.join("bin/a.bin"), "this").unwrap();
        symlink("bin/a.bin", inside.join("near.bin")).unwrap();
        symlink("../outside/a.bin", inside.join("far.bin")).unwrap();
        symlink("../outside", inside.join("folder")).unwrap();
        let read = |uri: &str, outside| from_uri(&inside.join("a.gltf"), "buffer 0", uri, 4, outside);
        for uri in ["bin/a.bin", "near.bin"] {
            assert_eq!(read(uri, Outside::Refused).unwrap(), b"this");
        }
        for uri in ["far.bin", "folder/a.bin", "../outside/a.bin", "bin/../../outside/a.bin"] {
            let refused = read(uri, Outside::Refused).unwrap_err().to_string();
            assert!(refused.contains("lies outside") && refused.contains("--allow-outside"), "{refused}");
            assert_eq!(read(uri, Outside::Allowed).unwrap(), b"that");
        }
        for uri in ["http://example.org/a.bin", "file:///etc/passwd", "C:\\a.bin"] {
            let refused = read(uri, Outside::Allowed).unwrap_err().to_string();
            assert!(refused.contains("no path") && !refused.contains("--allow-outside"), "{refused}");
        }
        assert!(read("missing.bin", Outside::Refused).unwrap_err().to_string().contains("cannot be read"));
    }
}

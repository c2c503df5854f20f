//! Bytes of a glTF or GLB file → the parsed document and the binary chunk.

use std::borrow::Cow;

use gltf::json::validation::{Error, Validate};
use gltf::json::{self, Root};
use motiondb::files::input_file;
use serde::Deserialize;

use crate::error::RejectionReason;
use crate::read::catch_panic;
use crate::read::malformed::malformed;

/// Flaws of a document that a message lists.
const LISTED_FLAWS: usize = 3;
/// Letters of the parser's message that our message quotes.
const QUOTED_LETTERS: usize = 500;
/// Parts of a document in which a flaw affects every animation.
const CHECKED_PARTS: [&str; 2] = ["nodes", "skins"];
/// Remedy for a document that cannot be parsed.
const VALIDATE_OR_EXPORT: &str = "check it with the glTF validator, or export it again";

/// The content of a file's own bytes.
pub(crate) struct ParsedDocument<'a> {
    pub root: Root,
    /// Binary chunk of a GLB file.
    pub chunk: Option<Cow<'a, [u8]>>,
    /// Whether channels without a node were left out.
    pub has_nodeless_channels: bool,
}

/// Parses a file and checks its version, its nodes and its skins.
pub(crate) fn parse(bytes: &[u8]) -> Result<ParsedDocument<'_>, RejectionReason> {
    check_is_gltf(bytes)?;
    let panicked = || malformed("document", "the document contradicts itself", "check it with the glTF validator");
    catch_panic::catch(|| parse_unguarded(bytes)).unwrap_or_else(panicked)
}

/// Addresses of the buffers and pictures that lie outside a file; empty if the file is not a document.
pub(crate) fn uris(bytes: &[u8]) -> Vec<String> {
    let json = catch_panic::catch(|| chunks(bytes)).and_then(Result::ok);
    let document: json::Value =
        json.and_then(|(json, _)| json::deserialize::from_slice(&json).ok()).unwrap_or_default();
    let parts = ["buffers", "images"].iter().filter_map(|part| document.get(part)?.as_array()).flatten();
    parts.filter_map(|part| Some(part.get("uri")?.as_str()?.to_owned())).collect()
}

/// Rejects, by the first bytes, files that are not glTF: cut short, packed, or in another encoding.
fn check_is_gltf(bytes: &[u8]) -> Result<(), RejectionReason> {
    if bytes.is_empty() {
        return malformed("byte 0", "the file is empty", "export the clip again");
    }
    if let [b'g', b'l', b'T', b'F', _, _, _, _, length @ ..] = bytes
        && let Some(&length) = length.first_chunk()
        && u32::from_le_bytes(length) as usize > bytes.len()
    {
        let problem = format!("the file is cut short: {} of {} bytes", bytes.len(), u32::from_le_bytes(length));
        return malformed(format!("byte {}", bytes.len()), problem, "copy or export it again");
    }
    if bytes.starts_with(b"PK\x03\x04") {
        return malformed("byte 0", "the file is a zip archive", "unpack it");
    }
    if input_file::is_utf16(bytes) {
        return malformed("byte 0", "the text is UTF-16, two bytes a letter", "save it as UTF-8");
    }
    if bytes.starts_with(b"\xef\xbb\xbf") {
        return malformed("byte 0", "the text begins with a byte order mark", "save it as UTF-8 without one");
    }
    Ok(())
}

fn parse_unguarded(bytes: &[u8]) -> Result<ParsedDocument<'_>, RejectionReason> {
    let (json, chunk) = chunks(bytes).or_else(|error| unparsed(&error))?;
    check_version(&json)?;
    let (root, has_nodeless_channels) = match json::deserialize::from_slice::<Root>(&json) {
        Ok(root) => (root, false),
        Err(error) => (without_nodeless_channels(&json).map_or_else(|| unparsed(&error), Ok)?, true),
    };
    check_structure(&root)?;
    Ok(ParsedDocument { root, chunk, has_nodeless_channels })
}

/// Fails with the beginning of the parser's message.
fn unparsed<T>(error: &dyn std::error::Error) -> Result<T, RejectionReason> {
    let problem: String = error.to_string().trim_end_matches([';', ' ']).chars().take(QUOTED_LETTERS).collect();
    malformed("document", problem, VALIDATE_OR_EXPORT)
}

/// JSON of a file, and the binary chunk of a GLB file.
type Chunks<'a> = (Cow<'a, [u8]>, Option<Cow<'a, [u8]>>);

fn chunks(bytes: &[u8]) -> Result<Chunks<'_>, gltf::Error> {
    if !bytes.starts_with(b"glTF") {
        return Ok((Cow::Borrowed(bytes), None));
    }
    gltf::Glb::from_slice(bytes).map(|glb| (glb.json, glb.bin))
}

/// The part of a document that states its version.
#[derive(Deserialize)]
struct VersionedDocument {
    asset: json::Asset,
}

/// Checks that a reader of glTF 2.0 can read the document: version 2.x, unless it states a later `minVersion`.
fn check_version(json: &[u8]) -> Result<(), RejectionReason> {
    // Parsing the whole document finds all other mistakes.
    let Ok(VersionedDocument { asset }) = json::deserialize::from_slice(json) else { return Ok(()) };
    let is_readable = match &asset.min_version {
        Some(least) => least == "2.0",
        None => asset.version.split('.').next() == Some("2"),
    };
    if is_readable {
        return Ok(());
    }
    let needed = asset.min_version.unwrap_or(asset.version);
    malformed("asset", format!("it needs a reader of glTF {needed}"), "export it as glTF 2.0")
}

/// The document without channels that name no node (KHR_animation_pointer); none where it has no such channel, or
/// another mistake.
fn without_nodeless_channels(json: &[u8]) -> Option<Root> {
    let mut document: json::Value = json::deserialize::from_slice(json).ok()?;
    let mut has_any = false;
    for animation in document.get_mut("animations")?.as_array_mut()? {
        let channels = animation.get_mut("channels")?.as_array_mut()?;
        let count = channels.len();
        channels.retain(|channel| channel.get("target").is_some_and(|target| target.get("node").is_some()));
        has_any |= channels.len() < count;
    }
    has_any.then(|| json::deserialize::from_value(document).ok())?
}

/// Checks indices and enumerations in [`CHECKED_PARTS`].
fn check_structure(root: &Root) -> Result<(), RejectionReason> {
    let mut flaws: Vec<String> = Vec::new();
    let mut count = 0;
    root.validate(root, json::Path::new, &mut |path, error: Error| {
        let path = path();
        if CHECKED_PARTS.iter().any(|part| path.as_str().starts_with(part)) {
            count += 1;
            if count <= LISTED_FLAWS {
                flaws.push(format!("{path}: {error}"));
            }
        }
    });
    if count > LISTED_FLAWS {
        flaws.push(format!("and {} more", count - LISTED_FLAWS));
    }
    if flaws.is_empty() {
        return Ok(());
    }
    malformed("document", flaws.join("; "), VALIDATE_OR_EXPORT)
}

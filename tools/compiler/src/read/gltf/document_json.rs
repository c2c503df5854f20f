//! JSON of a glTF or GLB file → the parsed document.

use gltf::json::validation::{Error, Validate};
use gltf::json::{self, Root};
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

/// A parsed document.
pub(crate) struct ParsedDocument {
    pub root: Root,
    /// Whether channels without a node were left out.
    pub has_nodeless_channels: bool,
}

/// Parses the JSON of a file and checks its version, its nodes and its skins.
pub(crate) fn parse(json: &[u8]) -> Result<ParsedDocument, RejectionReason> {
    let panicked = || malformed("document", "the document contradicts itself", "check it with the glTF validator");
    catch_panic::catch(|| parse_unguarded(json)).unwrap_or_else(panicked)
}

/// The buffers and pictures of a document.
#[derive(Default, Deserialize)]
struct LinkedDocument {
    #[serde(default)]
    buffers: Vec<Link>,
    #[serde(default)]
    images: Vec<Link>,
}

/// A buffer or a picture.
#[derive(Deserialize)]
struct Link {
    uri: Option<String>,
}

/// Addresses of the buffers and pictures that lie outside a file; empty if the JSON is not a document.
pub(crate) fn uris(json: &[u8]) -> Vec<String> {
    let LinkedDocument { buffers, images } = json::deserialize::from_slice(json).unwrap_or_default();
    buffers.into_iter().chain(images).filter_map(|link| link.uri).collect()
}

fn parse_unguarded(json: &[u8]) -> Result<ParsedDocument, RejectionReason> {
    check_version(json)?;
    let (root, has_nodeless_channels) = match json::deserialize::from_slice::<Root>(json) {
        Ok(root) => (root, false),
        Err(error) => readable(json).map_or_else(|| unparsed(&error), Ok)?,
    };
    check_structure(&root)?;
    Ok(ParsedDocument { root, has_nodeless_channels })
}

/// Fails with the beginning of the parser's message.
pub(crate) fn unparsed<T>(error: &dyn std::error::Error) -> Result<T, RejectionReason> {
    let problem: String = error.to_string().trim_end_matches([';', ' ']).chars().take(QUOTED_LETTERS).collect();
    malformed("document", problem, VALIDATE_OR_EXPORT)
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

/// The document without what is valid, but which the parser refuses: channels that name no node (KHR_animation_pointer),
/// and scenes without nodes. States whether it has such channels; none where it has neither, or another mistake.
fn readable(json: &[u8]) -> Option<(Root, bool)> {
    let mut document: json::Value = json::deserialize::from_slice(json).ok()?;
    let mut has_nodeless_channels = false;
    for animation in list(&mut document, "animations") {
        if let Some(channels) = animation.get_mut("channels").and_then(json::Value::as_array_mut) {
            let count = channels.len();
            channels.retain(|channel| channel.get("target").is_some_and(|target| target.get("node").is_some()));
            has_nodeless_channels |= channels.len() < count;
        }
    }
    let scenes = list(&mut document, "scenes").iter_mut().filter_map(json::Value::as_object_mut);
    let mut has_any = has_nodeless_channels;
    for scene in scenes.filter(|scene| !scene.contains_key("nodes")) {
        scene.insert("nodes".into(), json::Value::Array(Vec::new()));
        has_any = true;
    }
    if !has_any {
        return None;
    }
    Some((json::deserialize::from_value(document).ok()?, has_nodeless_channels))
}

/// A list of a document; empty where it has none.
fn list<'a>(document: &'a mut json::Value, name: &str) -> &'a mut [json::Value] {
    document.get_mut(name).and_then(json::Value::as_array_mut).map_or(&mut [], Vec::as_mut_slice)
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

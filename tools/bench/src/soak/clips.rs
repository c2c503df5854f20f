//! Clips: mutated BVH and GLB files. A clip that is imported is compiled, as the only clip of a database.

use std::path::Path;

use motiondb_compiler::import::import_bytes;
use motiondb_compiler::{Options, compile};

use crate::soak::databases::check_invariants;
use crate::soak::draw::Draw;
use crate::soak::mutation::mutated;
use crate::soak::tally::CopyOutcome;

/// Length of a GLB file's magic, version and length, and of the length and type of its JSON chunk, bytes.
const GLB_HEAD: usize = 20;

/// The bundled clips of a format.
pub(crate) fn bundled(extension: &str) -> Vec<Vec<u8>> {
    let clips = clipgen::generate().into_iter().filter(|clip| clip.name.ends_with(extension));
    clips.map(|clip| clip.bytes).collect()
}

/// Mutates a BVH file, every other edit in its hierarchy.
pub(crate) fn bvh(clips: &[Vec<u8>], draw: &mut Draw) -> CopyOutcome {
    let clip = draw.one(clips);
    compiled("clip.bvh", &mutated(clip, &draw.edits(clip.len())))
}

/// Mutates a GLB file anywhere, or only its JSON, with right lengths.
pub(crate) fn glb(clips: &[Vec<u8>], draw: &mut Draw) -> CopyOutcome {
    let clip = draw.one(clips);
    if draw.flip() {
        return compiled("clip.glb", &mutated(clip, &draw.edits(clip.len())));
    }
    let length = u32::from_le_bytes([clip[12], clip[13], clip[14], clip[15]]) as usize;
    let (json, buffer) = clip[GLB_HEAD..].split_at(length);
    compiled("clip.glb", &sealed(mutated(json, &draw.edits(json.len())), buffer))
}

/// A GLB file of a JSON chunk and of the chunk after it, with right lengths.
fn sealed(mut json: Vec<u8>, buffer: &[u8]) -> Vec<u8> {
    json.resize(json.len().next_multiple_of(4), b' ');
    let length = (GLB_HEAD + json.len() + buffer.len()) as u32;
    let head = [u32::from_le_bytes(*b"glTF"), 2, length, json.len() as u32, u32::from_le_bytes(*b"JSON")];
    let head: Vec<u8> = head.iter().flat_map(|word| word.to_le_bytes()).collect();
    [&head, &json, buffer].concat()
}

/// Imports and compiles a clip.
fn compiled(name: &str, bytes: &[u8]) -> CopyOutcome {
    let Ok(imports) = import_bytes(Path::new(name), bytes) else {
        return CopyOutcome::Rejected;
    };
    let clips = imports.into_iter().filter_map(|import| import.outcome.ok()).collect();
    compile(clips, &Options::default(), &|_| ()).map_or(CopyOutcome::Rejected, |db| check_invariants(&db))
}

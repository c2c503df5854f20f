//! Keys of stored results: SHA-256 of all that a result follows from.

use std::io::{self, Read};
use std::path::Path;

use motiondb::files::input_file;
use sha2::{Digest as _, Sha256};

use crate::input::clip_files::linked_files;
use crate::input::clip_settings::{ClipSettings, ManifestSpans};
use crate::retarget::human_clip::{Digest, HumanBody, HumanClip};

/// Digest of the sources of the compiler and of the libraries that it uses, made when this program was built.
const SOURCES: &str = env!("COMPILER_SOURCES");
/// Number of bytes that are read of a file at once.
const READ_BYTES: usize = 1 << 16;

/// Key of the clips of a file: its bytes and those of the files that it links to, its name and the settings. Folders do
/// not count. `None` where a file cannot be read.
pub(crate) fn of_file(settings: &ClipSettings) -> Option<Digest> {
    let name = settings.path.file_name().unwrap_or_default().into();
    // The style and the position in a manifest change nothing about the clips themselves.
    let settings_alone = ClipSettings { path: name, style: None, spans: ManifestSpans::default(), ..settings.clone() };
    let mut parts = vec![SOURCES.as_bytes().to_vec(), format!("{settings_alone:?}").into_bytes()];
    parts.push(file_digest(&settings.path).ok()?.to_vec());
    for linked in linked_files(&settings.path) {
        // A picture that is missing is no fault of the motion.
        parts.push(file_digest(&linked).map_or_else(|_| Vec::new(), |digest| digest.to_vec()));
    }
    Some(of_parts(&parts.iter().map(Vec::as_slice).collect::<Vec<&[u8]>>()))
}

/// Key of a clip of a file.
pub(crate) fn of_clip(file: &Digest, index: usize) -> Digest {
    of_parts(&[file, &index.to_le_bytes()])
}

/// Key of the analysis of a clip on a body.
pub(crate) fn of_analysis(clip: &HumanClip, stored: &Digest, body: &HumanBody) -> Digest {
    // The set may add warnings to a clip, and these count as flaws.
    let state = format!("{} {:?} {:?} {body:?}", clip.name, clip.choices, clip.source.diagnostics);
    of_parts(&[b"analysis", stored, state.as_bytes()])
}

/// Key of the comparisons of a set. The last set counts.
pub(crate) fn of_comparisons() -> Digest {
    of_parts(&[b"comparisons", SOURCES.as_bytes()])
}

/// Digest of parts and of their lengths.
fn of_parts(parts: &[&[u8]]) -> Digest {
    let mut hasher = Sha256::new();
    for part in parts {
        hasher.update((part.len() as u64).to_le_bytes());
        hasher.update(part);
    }
    hasher.finalize().into()
}

fn file_digest(path: &Path) -> io::Result<Digest> {
    let mut file = input_file::open(path)?;
    let (mut hasher, mut buffer) = (Sha256::new(), vec![0; READ_BYTES]);
    loop {
        match file.read(&mut buffer)? {
            0 => return Ok(hasher.finalize().into()),
            count => hasher.update(&buffer[..count]),
        }
    }
}

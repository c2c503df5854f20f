//! Clips to a database, with progress and a line for all that was refused: what `compile`, `inspect` and `run` share.

use std::num::NonZeroUsize;
use std::path::{Path, PathBuf};

use motiondb::velocity_sets::velocity_hull::Construction;
use motiondb_compiler::{
    ClipSet, CompileEvent, Compiled, Manifest, Rejection, clip_files, compile_manifest, import_clip_set, linked_files,
};

use crate::failure::{Answer, Failure};
use crate::output;
use crate::progress::Progress;
use crate::stages::Stopwatch;

/// A folder's file of this name says what of its clips need not be found.
const MANIFEST: &str = "manifest.toml";

/// The clips that paths mean, each once: files as they are, folders by their manifest, else by what lies below them.
fn manifest(paths: &[PathBuf]) -> Result<Manifest, Failure> {
    let (files, manifests) = files_and_manifests(paths)?;
    let mut manifest = match &manifests[..] {
        [] => Manifest::default(),
        [only] => Manifest::read(only)?,
        [one, another, ..] => {
            let both = format!("{} and {} are two manifests", one.display(), another.display());
            return Err(Failure::bad(format!("{both}; write one that names the folders of both")));
        }
    };
    manifest.add_files(&files);
    if !manifest.clips.is_empty() {
        return Ok(manifest);
    }
    Err(Failure::bad(match (&manifests[..], paths) {
        ([manifest, ..], _) => format!("{}: leaves no clip to use; skip fewer", manifest.display()),
        ([], [folder, ..]) => {
            let folder = folder.display();
            format!("{folder}: no *.bvh, *.glb or *.gltf below it; name another folder or the clips themselves")
        }
        ([], []) => "no clips; name files or folders".to_owned(),
    }))
}

/// What paths mean, sorted.
fn files_and_manifests(paths: &[PathBuf]) -> Result<(Vec<PathBuf>, Vec<PathBuf>), Failure> {
    let (mut files, mut manifests) = (Vec::new(), Vec::new());
    for path in paths {
        let inside = path.join(MANIFEST);
        if path.extension().is_some_and(|extension| extension == "toml") {
            manifests.push(path.clone());
        } else if inside.is_file() {
            manifests.push(inside);
        } else if path.is_dir() {
            files.extend(clip_files(path).map_err(|error| Failure::bad(error.to_string()))?);
        } else {
            files.push(path.clone());
        }
    }
    for paths in [&mut files, &mut manifests] {
        paths.sort();
        paths.dedup();
    }
    Ok((files, manifests))
}

/// What the command line wants of the whole set; it counts more than a manifest.
#[derive(Default)]
pub(crate) struct Overrides {
    pub(crate) velocity_hull: Option<Construction>,
    pub(crate) max_examples: Option<NonZeroUsize>,
}

/// Compiles clips for a database that goes to `output`, which must be none of them; `stopwatch` takes the time of each
/// stage.
pub(crate) fn compile(
    paths: &[PathBuf],
    output: &Path,
    overrides: &Overrides,
    stopwatch: &Stopwatch,
) -> Result<Compiled, Failure> {
    let mut manifest = manifest(paths)?;
    let manifests: Vec<PathBuf> = paths.iter().map(|path| path.join(MANIFEST)).collect();
    let clips = manifest.clips.iter().map(|clip| &clip.path);
    output::spare(output, paths.iter().chain(&manifests).chain(clips.clone()))?;
    output::spare(output, clips.flat_map(|clip| linked_files(clip)))?;
    if let Some(construction) = overrides.velocity_hull {
        manifest.options.velocity_hull = construction;
    }
    manifest.options.max_examples = overrides.max_examples.or(manifest.options.max_examples);
    let progress = Progress::new("files", manifest.clips.len());
    let compiled = compile_manifest(&manifest, &|event| {
        stopwatch.watch(event);
        advance(&progress, event);
    });
    progress.finish();
    Ok(compiled?)
}

/// Imports clips without making a database of them.
pub(crate) fn import(paths: &[PathBuf]) -> Result<ClipSet, Failure> {
    let manifest = manifest(paths)?;
    let progress = Progress::new("files", manifest.clips.len());
    let imported = import_clip_set(&manifest, &|event| advance(&progress, event));
    progress.finish();
    Ok(imported?)
}

/// Progress counts imported files: what comes after takes no time worth a bar.
fn advance(progress: &Progress, event: CompileEvent) {
    if let CompileEvent::Imported(_) = event {
        progress.advance();
    }
}

/// Says on standard error what was refused.
pub(crate) fn say_refused(refused: &[Rejection]) {
    for message in refused {
        output::say(&format!("refused: {message}"));
    }
}

/// Whether all was used.
pub(crate) fn answer(refused: &[Rejection]) -> Answer {
    if refused.is_empty() { Answer::Yes } else { Answer::No }
}

//! Paths of clips, folders and manifests → the clips that they stand for.
//!
//! A file stands for itself. A folder stands for what its `manifest.toml` names, or else for every clip below it.

use std::path::{Path, PathBuf};

use motiondb_compiler::{Manifest, clip_files, foreign_files, linked_files};

use crate::error::JobError;
use crate::output_path::check_is_no_input;

/// A folder's manifest has this file name.
const MANIFEST: &str = "manifest.toml";

/// All clips that the paths stand for, each once.
///
/// # Errors
/// If a path or a manifest cannot be read, there are two manifests, or no clip is left.
pub fn manifest(paths: &[PathBuf]) -> Result<Manifest, JobError> {
    let Sorted { files, manifests } = sorted(paths)?;
    let mut manifest = match &manifests[..] {
        [] => Manifest::default(),
        [only] => Manifest::read(only)?,
        [first, second, ..] => {
            return Err(JobError::TwoManifests { first: first.clone(), second: second.clone() });
        }
    };
    manifest.add_files(&files);
    match (manifest.clips.is_empty(), &manifests[..], paths) {
        (false, ..) => Ok(manifest),
        (true, [manifest, ..], _) => Err(JobError::AllSkipped { manifest: manifest.clone() }),
        (true, [], [folder, ..]) => Err(JobError::NoClips { folder: folder.clone(), instead: instead(folder)? }),
        (true, [], []) => Err(JobError::NoPaths),
    }
}

/// What a folder without clips holds in their place: `, but 3 files of other formats: walk.fbx, an FBX file …`.
fn instead(folder: &Path) -> Result<String, JobError> {
    Ok(others(folder)?.map_or(String::new(), |others| format!(", but {others}")))
}

/// What the folders hold beside their clips that cannot be read, a line each. The manifest of a folder decides itself.
///
/// # Errors
/// If a folder cannot be read.
pub fn passed_over(paths: &[PathBuf]) -> Result<Vec<String>, JobError> {
    let folders = paths.iter().filter(|path| path.is_dir() && !path.join(MANIFEST).is_file());
    let line = |folder: &PathBuf| {
        let others = others(folder)?;
        Ok(others.map(|others| format!("passed over in {}: {others}", folder.display())))
    };
    folders.filter_map(|folder| line(folder).transpose()).collect()
}

/// The files of other formats below a folder: their number, and what the first is.
fn others(folder: &Path) -> Result<Option<String>, JobError> {
    let others = foreign_files(folder)?;
    let Some((first, format)) = others.first() else { return Ok(None) };
    let count = if others.len() == 1 { "a file" } else { &format!("{} files", others.len()) };
    let name = first.file_name().unwrap_or_default().display();
    Ok(Some(format!("{count} of other formats: `{name}` is {}; {}", format.name, format.remedy)))
}

/// Checks that a database written to `output` replaces neither a clip, nor a file that a clip links to, nor a manifest.
///
/// # Errors
/// [`JobError::OutputIsInput`].
pub fn check_output(output: &Path, paths: &[PathBuf], manifest: &Manifest) -> Result<(), JobError> {
    check_is_no_input(output, inputs(paths, manifest))
}

/// Every file that is read for the clips of a manifest that `paths` stand for.
pub fn inputs(paths: &[PathBuf], manifest: &Manifest) -> Vec<PathBuf> {
    let clips = || manifest.clips.iter().map(|clip| clip.path.clone());
    let manifests = paths.iter().map(|path| path.join(MANIFEST));
    let linked = clips().flat_map(|clip| linked_files(&clip));
    paths.iter().cloned().chain(manifests).chain(clips()).chain(linked).collect()
}

/// Clips and manifests, each list in order and without repetition.
struct Sorted {
    files: Vec<PathBuf>,
    manifests: Vec<PathBuf>,
}

fn sorted(paths: &[PathBuf]) -> Result<Sorted, JobError> {
    let (mut files, mut manifests) = (Vec::new(), Vec::new());
    for path in paths {
        let inside = path.join(MANIFEST);
        if path.extension().is_some_and(|extension| extension == "toml") {
            manifests.push(path.clone());
        } else if inside.is_file() {
            manifests.push(inside);
        } else if path.is_dir() {
            files.extend(clip_files(path)?);
        } else {
            files.push(path.clone());
        }
    }
    for paths in [&mut files, &mut manifests] {
        paths.sort();
        paths.dedup();
    }
    Ok(Sorted { files, manifests })
}

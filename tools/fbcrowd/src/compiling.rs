//! Clips to a database, with progress and a line for all that was refused: what `compile`, `inspect` and `run` share.

use std::path::PathBuf;

use motiondb::motion_db::MotionDb;
use motiondb_compiler::compile::{self, Compiled};
use motiondb_compiler::human_clip::HumanClip;
use motiondb_compiler::import;

use crate::failure::{Answer, Failure};
use crate::output;
use crate::progress::Progress;

/// The clip files that paths mean, each once: files as they are, folders by what lies below them.
pub(crate) fn clip_files(paths: &[PathBuf]) -> Result<Vec<PathBuf>, Failure> {
    let mut files = Vec::new();
    for path in paths {
        if path.is_dir() {
            files.extend(import::clip_files(path).map_err(|error| Failure::bad(error.to_string()))?);
        } else {
            files.push(path.clone());
        }
    }
    files.sort();
    files.dedup();
    match (files.is_empty(), paths.first()) {
        (true, Some(folder)) => Err(Failure::bad(format!(
            "{}: no *.bvh, *.glb or *.gltf below it; name another folder or the clips themselves",
            folder.display()
        ))),
        _ => Ok(files),
    }
}

/// Compiles clips; what was refused is said on standard error, and makes the answer no.
pub(crate) fn compile(paths: &[PathBuf]) -> Result<(MotionDb, Answer), Failure> {
    let files = clip_files(paths)?;
    let progress = Progress::new("clips", files.len());
    let compiled = compile::compile_files(&files, &|_| progress.advance());
    progress.finish();
    let Compiled { db, refused } = compiled.map_err(|error| Failure::bad(error.to_string()))?;
    Ok((db, say_refused(&refused)))
}

/// Imports clips without making a database of them.
pub(crate) fn import(paths: &[PathBuf]) -> Result<(Vec<HumanClip>, Answer), Failure> {
    let files = clip_files(paths)?;
    let progress = Progress::new("clips", files.len());
    let (clips, refused) = compile::import_files(&files, &|_| progress.advance());
    progress.finish();
    if clips.is_empty() {
        return Err(Failure::bad(refused.join("\n")));
    }
    Ok((clips, say_refused(&refused)))
}

fn say_refused(refused: &[String]) -> Answer {
    for message in refused {
        output::say(&format!("refused: {message}"));
    }
    if refused.is_empty() { Answer::Yes } else { Answer::No }
}

//! Clips → a motion database, or the clips alone, with progress.

use std::num::NonZeroUsize;
use std::path::{Path, PathBuf};

use motiondb::files::database_file;
use motiondb::motion::MotionDb;
use motiondb::velocity_sets::velocity_hull::Construction;
use motiondb_compiler::{
    Cache, ClipSet, CompileEvent, Compiled, Manifest, Outside, compile_manifest, compile_with_cache, import_clip_set,
};

use crate::clip_paths::{check_output, manifest};
use crate::error::JobError;
use crate::observer::{JobEvent, Observer, Work};
use crate::output_path::is_wrong_path;

/// Options that override those of a manifest.
#[derive(Default)]
pub struct Overrides {
    /// How examples bound the velocities; by default as the manifest states.
    pub velocity_hull: Option<Construction>,
    /// Most examples, mirrors not counted; by default as the manifest states.
    pub max_examples: Option<NonZeroUsize>,
    /// The styles whose clips are used; empty for all.
    pub styles: Vec<String>,
    /// Whether the buffers of glTF files may lie outside their folders; by default they may not.
    pub outside: Outside,
    /// Folder of the results of earlier compilations; by default none are used.
    pub cache: Option<PathBuf>,
}

/// Compiles the clips that `paths` stand for. The database is to be written to `output`, which must be no input.
///
/// # Errors
/// If the paths name no clips, `output` is an input, or the clips give no valid database.
pub fn compile(
    paths: &[PathBuf],
    output: &Path,
    overrides: &Overrides,
    observer: &Observer,
) -> Result<Compiled, JobError> {
    let mut manifest = manifest(paths)?;
    allow(&mut manifest, overrides.outside);
    check_output(output, paths, &manifest)?;
    if let Some(construction) = overrides.velocity_hull {
        manifest.options.velocity_hull = construction;
    }
    if !overrides.styles.is_empty() {
        manifest.keep_styles(&overrides.styles)?;
    }
    manifest.options.max_examples = overrides.max_examples.or(manifest.options.max_examples);
    let cache = overrides.cache.as_deref().map(open_cache).transpose()?;
    let work = Work::begin(observer, "files", manifest.clips.len());
    let observe = |event: CompileEvent| forward(event, observer);
    let compiled = match &cache {
        Some(cache) => compile_with_cache(&manifest, cache, &observe),
        None => compile_manifest(&manifest, &observe),
    };
    work.end();
    Ok(compiled?)
}

/// Opens the cache in a folder.
fn open_cache(folder: &Path) -> Result<Cache, JobError> {
    Cache::open(folder).map_err(|error| match is_wrong_path(&error) {
        true if folder.is_file() => {
            JobError::UnfitCache { folder: folder.to_owned(), fault: "it is a file".to_owned() }
        }
        true => JobError::UnfitCache { folder: folder.to_owned(), fault: error.to_string() },
        false => JobError::Unwritable { path: folder.to_owned(), source: error },
    })
}

/// Writes a database, as a stage of its own; returns the checksum of its file.
///
/// # Errors
/// If the system does not allow it.
pub fn write_database(path: &Path, db: &MotionDb, observer: &Observer) -> Result<u32, JobError> {
    observer(JobEvent::Stage("writing"));
    Ok(database_file::write(path, db)?)
}

/// Imports the clips that `paths` stand for, without a database.
///
/// # Errors
/// Where the paths name no clips, or a manifest cannot be followed.
pub fn import(paths: &[PathBuf], outside: Outside, observer: &Observer) -> Result<ClipSet, JobError> {
    let mut manifest = manifest(paths)?;
    allow(&mut manifest, outside);
    let work = Work::begin(observer, "files", manifest.clips.len());
    let imported = import_clip_set(&manifest, &|event| forward(event, observer));
    work.end();
    Ok(imported?)
}

/// States for every clip whether its buffers may lie outside its folder.
fn allow(manifest: &mut Manifest, outside: Outside) {
    manifest.clips.iter_mut().for_each(|clip| clip.outside = outside);
}

/// Passes an event of the compiler on. Units of work are imported files: all later stages are short.
pub fn forward(event: CompileEvent, observer: &Observer) {
    match event {
        CompileEvent::Stage(name) => observer(JobEvent::Stage(name)),
        CompileEvent::Imported(_) => observer(JobEvent::Advance),
    }
}

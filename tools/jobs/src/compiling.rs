//! Clips → a motion database, or the clips alone, with progress.

use std::num::NonZeroUsize;
use std::path::{Path, PathBuf};

use motiondb::file;
use motiondb::motion_db::MotionDb;
use motiondb::velocity_hull::Construction;
use motiondb_compiler::clip_set;
use motiondb_compiler::compile::{self, Compiled};
use motiondb_compiler::human_clip::HumanClip;
use motiondb_compiler::progress::Event;
use motiondb_compiler::refused::Refused;

use crate::clip_paths::{check_output, manifest};
use crate::error::JobError;
use crate::observer::{JobEvent, Observer, Work};

/// Options that override those of a manifest.
#[derive(Default)]
pub struct Overrides {
    /// How examples bound the velocities; by default as the manifest states.
    pub velocity_hull: Option<Construction>,
    /// Most examples, mirrors not counted; by default as the manifest states.
    pub max_examples: Option<NonZeroUsize>,
}

/// Clips that were imported, and those that were refused.
pub struct ImportedClips {
    /// Clips of human motion.
    pub clips: Vec<HumanClip>,
    /// Files and clips that were refused, each with its reason.
    pub refused: Vec<Refused>,
}

/// Compiles the clips that `paths` stand for. The database is to be written to `output`, which must be no input.
///
/// # Errors
/// Where the paths name no clips, `output` is an input, or the clips give no sound database.
pub fn compile(
    paths: &[PathBuf],
    output: &Path,
    overrides: &Overrides,
    observer: &Observer,
) -> Result<Compiled, JobError> {
    let mut manifest = manifest(paths)?;
    check_output(output, paths, &manifest)?;
    if let Some(construction) = overrides.velocity_hull {
        manifest.options.velocity_hull = construction;
    }
    manifest.options.max_examples = overrides.max_examples.or(manifest.options.max_examples);
    let work = Work::begin(observer, "files", manifest.takes.len());
    let compiled = compile::compile_manifest(&manifest, &|event| forward(event, observer));
    work.end();
    Ok(compiled?)
}

/// Writes a database, as a stage of its own; returns the checksum of its file.
///
/// # Errors
/// Where the system does not allow it.
pub fn write_database(path: &Path, db: &MotionDb, observer: &Observer) -> Result<u32, JobError> {
    observer(JobEvent::Stage("writing"));
    Ok(file::write(path, db)?)
}

/// Imports the clips that `paths` stand for, without a database.
///
/// # Errors
/// Where the paths name no clips, or a manifest cannot be followed.
pub fn import(paths: &[PathBuf], observer: &Observer) -> Result<ImportedClips, JobError> {
    let manifest = manifest(paths)?;
    let work = Work::begin(observer, "files", manifest.takes.len());
    let imported = clip_set::import(&manifest, &|event| forward(event, observer));
    work.end();
    let (clips, refused) = imported?;
    Ok(ImportedClips { clips, refused })
}

/// Passes an event of the compiler on. Units of work are imported files: all later stages are short.
pub fn forward(event: Event<'_>, observer: &Observer) {
    match event {
        Event::Stage(name) => observer(JobEvent::Stage(name)),
        Event::Imported(_) => observer(JobEvent::Advance),
    }
}

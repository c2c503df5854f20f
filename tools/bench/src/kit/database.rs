//! The motion database of a bench: a file, or that of the bundled clips.
//!
//! The clips are generated in memory, so a bench runs in any working directory.

use std::path::Path;

use motiondb::files::database_file;
use motiondb::motion::MotionDb;
use motiondb_compiler::compile;
use motiondb_compiler::import::import_bytes;

use crate::error::BenchError;
use crate::kit::args::DatabaseArg;

/// The database that the arguments name, or that of the bundled clips.
pub(crate) fn database(arg: &DatabaseArg) -> Result<MotionDb, BenchError> {
    arg.database.as_deref().map_or_else(bundled, |path| Ok(database_file::load(path)?.0))
}

/// The database of the bundled clips, compiled with the default options.
///
/// # Errors
/// If the clips give no valid database.
pub fn bundled() -> Result<MotionDb, BenchError> {
    let mut clips = Vec::new();
    for clip in clipgen::generate().into_iter().filter(|file| !file.name.ends_with(".md")) {
        let imports = import_bytes(Path::new(&clip.name), &clip.bytes)?;
        clips.extend(imports.into_iter().filter_map(|import| import.outcome.ok()));
    }
    Ok(compile::compile(clips, &motiondb_compiler::Options::default(), &|_| ())?)
}

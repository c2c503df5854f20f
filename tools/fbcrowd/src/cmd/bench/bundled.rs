//! The database of a bench: a file, or that of the bundled clips, as the generator writes them, so that no bench
//! depends on the folder it is run in.

use std::path::Path;

use motiondb::files::database_file;
use motiondb::motion::MotionDb;
use motiondb_compiler::compile;
use motiondb_compiler::import::import_bytes;

use crate::failure::Failure;

/// The database at a path, or that of the bundled clips.
pub(super) fn database(path: Option<&Path>) -> Result<MotionDb, Failure> {
    path.map_or_else(bundled, |path| Ok(database_file::load(path)?.0))
}

/// Compiled with the compiler's own choices.
pub(super) fn bundled() -> Result<MotionDb, Failure> {
    let mut clips = Vec::new();
    for clip in clipgen::generate().into_iter().filter(|file| !file.name.ends_with(".md")) {
        let imports = import_bytes(Path::new(&clip.name), &clip.bytes);
        let imports = imports.map_err(|error| Failure::bad(error.to_string()))?;
        clips.extend(imports.into_iter().filter_map(|import| import.outcome.ok()));
    }
    Ok(compile::compile(clips, &motiondb_compiler::Options::default(), &|_| ())?)
}

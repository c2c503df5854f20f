//! Databases for tests: of the bundled clips, and of real motion capture where it is at hand.
#![allow(unreachable_pub, reason = "each test target uses it as its own")]
#![allow(dead_code, reason = "each test target uses its own part")]

use std::path::{Path, PathBuf};

use motiondb::motion_db::MotionDb;
use motiondb_compiler::compile::compile_files;
use motiondb_compiler::truth::marine_files;

/// The bundled clips that are BVH.
pub fn bundled() -> MotionDb {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../assets/clips");
    let files = std::fs::read_dir(&folder).unwrap().map(|entry| entry.unwrap().path());
    compiled(files.filter(|file| file.extension().is_some_and(|extension| extension == "bvh")).collect())
}

/// The paper's clips; none where they are not at hand.
pub fn marine(test: &str) -> Option<MotionDb> {
    marine_clips(test).map(compiled)
}

/// The paper's clips but for those whose file names hold a word.
pub fn marine_without(test: &str, word: &str) -> Option<MotionDb> {
    let files = marine_clips(test)?;
    let is_kept = |file: &PathBuf| !file.file_name().is_some_and(|name| name.to_string_lossy().contains(word));
    Some(compiled(files.into_iter().filter(is_kept).collect()))
}

fn marine_clips(test: &str) -> Option<Vec<PathBuf>> {
    let mocap = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../../shared/mocap");
    if !mocap.is_dir() {
        println!("SKIPPED {test}: no recordings at {}", mocap.display());
        return None;
    }
    Some(marine_files(&mocap))
}

fn compiled(files: Vec<PathBuf>) -> MotionDb {
    compile_files(&files, &|_| {}).unwrap().db
}

//! Databases for tests: of the bundled clips, and of real motion capture where it is at hand.
#![allow(unreachable_pub, reason = "each test target uses it as its own")]
#![allow(dead_code, reason = "each test target uses its own part")]

use std::path::{Path, PathBuf};

use motiondb::motion::MotionDb;
use motiondb_compiler::compile::compile_files;
use motiondb_compiler::truth::marine_files;

/// The bundled clips that are BVH.
pub fn bundled() -> MotionDb {
    let files = std::fs::read_dir(bundled_folder()).unwrap().map(|entry| entry.unwrap().path());
    compiled(files.filter(|file| file.extension().is_some_and(|extension| extension == "bvh")).collect())
}

/// One of the bundled clips.
pub fn bundled_alone(file: &str) -> MotionDb {
    compiled(vec![bundled_folder().join(file)])
}

fn bundled_folder() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("../../assets/clips")
}

/// Other people's clips below a folder of the recordings, or in one file; none where they are not at hand.
pub fn recorded(test: &str, path: &str) -> Option<MotionDb> {
    let path = mocap(test)?.join(path);
    let mut files = vec![path.clone()];
    if path.is_dir() {
        files = std::fs::read_dir(path).unwrap().map(|entry| entry.unwrap().path()).collect();
    }
    Some(compiled(files))
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
    mocap(test).map(|mocap| marine_files(&mocap))
}

fn mocap(test: &str) -> Option<PathBuf> {
    let mocap = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../../shared/mocap");
    if !mocap.is_dir() {
        println!("SKIPPED {test}: no recordings at {}", mocap.display());
        return None;
    }
    Some(mocap)
}

fn compiled(files: Vec<PathBuf>) -> MotionDb {
    compile_files(&files, &|_| {}).unwrap().db
}

//! Databases for tests: of the bundled clips, and of clips of others.

use std::path::PathBuf;

use fbcrowd_bench::compiler::ground_truth::marine_files;
use motiondb::motion::MotionDb;
use motiondb_compiler::compile_files;

use super::support::{bundled_folder, mocap};

/// The bundled clips that are BVH.
pub(super) fn bundled() -> MotionDb {
    compiled(bundled_files())
}

/// The same, without the clips whose names begin so.
pub(super) fn bundled_without(beginning: &str) -> MotionDb {
    let begins = |file: &PathBuf| file.file_name().is_some_and(|name| name.to_string_lossy().starts_with(beginning));
    compiled(bundled_files().into_iter().filter(|file| !begins(file)).collect())
}

fn bundled_files() -> Vec<PathBuf> {
    let files = std::fs::read_dir(bundled_folder()).unwrap().map(|entry| entry.unwrap().path());
    files.filter(|file| file.extension().is_some_and(|extension| extension == "bvh")).collect()
}

/// One of the bundled clips.
pub(super) fn bundled_alone(file: &str) -> MotionDb {
    compiled(vec![bundled_folder().join(file)])
}

/// The bundled walk at 1.1 m/s and the idle.
pub(super) fn bundled_walk_and_idle() -> MotionDb {
    compiled(["walk_110.bvh", "idle.bvh"].map(|file| bundled_folder().join(file)).to_vec())
}

/// Clips of others: those of a folder, or one file.
pub(super) fn recorded(path: &str) -> MotionDb {
    let path = mocap().join(path);
    let mut files = vec![path.clone()];
    if path.is_dir() {
        files = std::fs::read_dir(path).unwrap().map(|entry| entry.unwrap().path()).collect();
    }
    compiled(files)
}

/// The paper's clips.
pub(super) fn marine() -> MotionDb {
    compiled(marine_files(&mocap()))
}

/// The paper's clips except those whose file names hold a word.
pub(super) fn marine_without(word: &str) -> MotionDb {
    let is_kept = |file: &PathBuf| !file.file_name().is_some_and(|name| name.to_string_lossy().contains(word));
    compiled(marine_files(&mocap()).into_iter().filter(is_kept).collect())
}

fn compiled(files: Vec<PathBuf>) -> MotionDb {
    compile_files(&files, &|_| {}).unwrap().db
}

//! Databases for tests: of the bundled clips, and of real motion capture where it is at hand.
#![allow(unreachable_pub, reason = "each test target uses it as its own")]

use std::path::{Path, PathBuf};

use motiondb::motion_db::MotionDb;
use motiondb_compiler::compile::compile_files;

/// The recordings that make the paper's 19 examples (`motion.md` §1).
const MARINE: [&str; 12] = [
    "Idle01",
    "Meander01",
    "Walk01",
    "Jog01",
    "Run01",
    "WalkCircleRt01",
    "WalkTightCircleRt01",
    "RunCircleRt01",
    "RunTightCircleRt01",
    "Turn360Rt01",
    "StrafeSlowRt01",
    "StrafeFastRt01",
];

/// The bundled clips that are BVH.
pub fn bundled() -> MotionDb {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../assets/clips");
    let files = std::fs::read_dir(&folder).unwrap().map(|entry| entry.unwrap().path());
    compiled(files.filter(|file| file.extension().is_some_and(|extension| extension == "bvh")).collect())
}

/// The paper's clips; none where they are not at hand.
pub fn marine(test: &str) -> Option<MotionDb> {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../../shared/mocap/smartbody_converted");
    if !folder.is_dir() {
        println!("SKIPPED {test}: no recordings at {}", folder.display());
        return None;
    }
    Some(compiled(MARINE.iter().map(|clip| folder.join(format!("ChrMarine_{clip}.bvh"))).collect()))
}

fn compiled(files: Vec<PathBuf>) -> MotionDb {
    compile_files(&files, &|_| {}).unwrap().db
}

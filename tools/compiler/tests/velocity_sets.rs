//! The paper's construction of the velocity sets (`FbCrowd` §4.1) beside ours, on its own recordings and on the bundled
//! clips.

mod support;

use std::path::{Path, PathBuf};

use motiondb::motion::MotionDb;
use motiondb::velocity_sets::velocity_hull::{Construction, is_turning, turning_point_mps};
use motiondb_compiler::{Manifest, clip_files, compile_manifest};
use support::mocap;

const BUNDLED: &str = concat!(env!("CARGO_MANIFEST_DIR"), "/../../assets/clips");

/// The clips of a folder whose names start alike, compiled by a construction.
fn compiled(folder: &Path, prefix: &str, construction: Construction) -> MotionDb {
    let starts = |file: &PathBuf| file.file_name().is_some_and(|name| name.to_string_lossy().starts_with(prefix));
    let files: Vec<PathBuf> = clip_files(folder).unwrap().into_iter().filter(starts).collect();
    let mut manifest = Manifest::of_files(&files);
    manifest.options.velocity_hull = construction;
    compile_manifest(&manifest, &|_| ()).unwrap().db
}

/// The paper's set bounds all velocities; what turns is bounded as in ours.
fn check(folder: &Path, prefix: &str) -> MotionDb {
    let paper = compiled(folder, prefix, Construction::Paper);
    let both = compiled(folder, prefix, Construction::TurningAndHolding);
    let (found, ours) = (&paper.velocity_hull, &both.velocity_hull);
    assert_eq!((found.construction, ours.construction), (Construction::Paper, Construction::TurningAndHolding));
    assert_eq!((&found.turning_mps, &found.sharp_turn_edges_mps), (&ours.turning_mps, &ours.sharp_turn_edges_mps));
    assert_eq!(found.holding_mps, found.turning_mps);
    assert_ne!(ours.holding_mps, ours.turning_mps);
    assert_eq!(paper.examples, both.examples);
    paper
}

#[test]
#[ignore = "needs other people's clips: set FBCROWD_MOCAP"]
fn paper_construction_gives_one_set_for_its_recordings() {
    let paper = check(&mocap().join("smartbody_converted"), "ChrMarine");
    let sets = &paper.velocity_hull;
    assert_eq!((sets.turning_mps.len(), sets.sharp_turn_edges_mps.len()), (5, 7));
    for corner in &sets.turning_mps {
        let spans = |example: &&motiondb::motion::MotionExample| {
            is_turning(&example.parameters) && turning_point_mps(&example.parameters) == *corner
        };
        assert!(paper.examples.iter().any(|example| spans(&example)), "{corner} is no example");
    }
}

#[test]
fn paper_construction_ignores_side_steps() {
    let paper = check(Path::new(BUNDLED), "");
    assert!(paper.examples.iter().any(|example| example.parameters.speed_mps < -0.5));
}

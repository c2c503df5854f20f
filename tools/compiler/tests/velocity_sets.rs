//! The paper's own construction of the velocity sets, beside ours, on its own recordings and on the bundled clips.

use std::path::{Path, PathBuf};

use motiondb::motion::MotionDb;
use motiondb::velocity_sets::velocity_hull::{Construction, is_turning, turning_point_mps};
use motiondb_compiler::clip_files;
use motiondb_compiler::compile::compile_manifest;
use motiondb_compiler::input::manifest::Manifest;

const BUNDLED: &str = concat!(env!("CARGO_MANIFEST_DIR"), "/../../assets/clips");
const MARINE: &str = concat!(env!("CARGO_MANIFEST_DIR"), "/../../../shared/mocap/smartbody_converted");

/// The clips of a folder whose names start alike, compiled by a construction; none where the folder is missing.
fn compiled(folder: &str, prefix: &str, construction: Construction) -> Option<MotionDb> {
    let starts = |file: &PathBuf| file.file_name().is_some_and(|name| name.to_string_lossy().starts_with(prefix));
    let files: Vec<PathBuf> = clip_files(Path::new(folder)).ok()?.into_iter().filter(starts).collect();
    let mut manifest = Manifest::of_files(&files);
    manifest.options.velocity_hull = construction;
    Some(compile_manifest(&manifest, &|_| ()).unwrap().db)
}

/// The paper's set bounds all velocities; what turns is bounded as in ours.
fn check(folder: &str, prefix: &str) -> Option<MotionDb> {
    let paper = compiled(folder, prefix, Construction::Paper)?;
    let both = compiled(folder, prefix, Construction::TurningAndHolding)?;
    let (found, ours) = (&paper.velocity_hull, &both.velocity_hull);
    assert_eq!((found.construction, ours.construction), (Construction::Paper, Construction::TurningAndHolding));
    assert_eq!((&found.turning_mps, &found.sharp_turn_edges_mps), (&ours.turning_mps, &ours.sharp_turn_edges_mps));
    assert_eq!(found.holding_mps, found.turning_mps);
    assert_ne!(ours.holding_mps, ours.turning_mps);
    assert_eq!(paper.examples, both.examples);
    Some(paper)
}

#[test]
fn by_the_papers_construction_its_own_recordings_have_one_set_with_seven_sharp_turn_edges() {
    let test = "by_the_papers_construction_its_own_recordings_have_one_set_with_seven_sharp_turn_edges";
    let Some(paper) = check(MARINE, "ChrMarine") else { return println!("SKIPPED {test}: {MARINE} is missing") };
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
fn by_the_papers_construction_side_stepping_and_backward_examples_bound_nothing() {
    let paper = check(BUNDLED, "").expect("the bundled clips are part of the repository");
    assert!(paper.examples.iter().any(|example| example.parameters.speed_mps < -0.5));
}

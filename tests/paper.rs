//! The paper's antipodal circle (§7, Fig. 7), with the bundled clips and with the paper's own.

mod support;

use std::path::Path;

use serde_json::Value;
use support::{compile, fbcrowd, folder, marine_clips, text};

fn measured(database: &Path, folder: &Path) -> Value {
    let recording = folder.join("antipodal.fbrec");
    let scene = "assets/scenarios/antipodal.toml";
    fbcrowd(&["simulate", scene, "--db", text(database), "-o", text(&recording)]).expect_code(0);
    fbcrowd(&["measure", text(&recording), "--json"]).expect_code(0).json()
}

fn check_all_arrive(measures: &Value) {
    assert_eq!(measures["agents"], 17);
    assert_eq!(measures["arrived"], 17, "{measures}");
    assert_eq!(measures["stalled"], 0, "{measures}");
}

#[test]
fn with_bundled_clips_all_arrive_and_feet_hold() {
    let folder = folder("antipodal_bundled");
    let database = compile(&["assets/clips".to_owned()], &folder);
    let measures = measured(&database, &folder);
    check_all_arrive(&measures);
    assert!(measures["planted_slide_cm_s"].as_f64().unwrap() <= 3.0, "{measures}");
    assert!(measures["planted_share"].as_f64().unwrap() >= 0.4, "{measures}");
}

#[test]
#[ignore = "needs other people's clips: set FBCROWD_MOCAP"]
fn with_the_papers_clips_all_arrive_and_feet_hold() {
    let folder = folder("antipodal_marine");
    let measures = measured(&compile(&marine_clips(), &folder), &folder);
    check_all_arrive(&measures);
    let slide = |key: &str| measures[key].as_f64().unwrap();
    assert!(slide("planted_slide_cm_s") <= slide("examples_slide_cm_s"), "{measures}");
}

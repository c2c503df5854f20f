//! Databases through the built binary: the bundled clips, the paper's own set, glTF beside BVH.

mod support;

use std::sync::Arc;

use fbcrowd_sim::recording::Recording;
use fbcrowd_sim::synthesis::library;
use motiondb::files::database_file;
use serde_json::Value;
use support::{compile, fbcrowd, folder, marine_clips, mocap, text};

fn inspect(database: &std::path::Path) -> Value {
    fbcrowd(&["inspect", text(database), "--json"]).expect_code(0).json()
}

fn number(value: &Value, key: &str) -> f64 {
    value[key].as_f64().unwrap_or_else(|| panic!("{key} is missing from {value}"))
}

fn within(found: f64, wanted: f64, share: f64, absolute: f64) -> bool {
    (found - wanted).abs() <= f64::max(share * wanted.abs(), absolute)
}

#[test]
fn the_bundled_clips_are_what_the_generator_makes() {
    let folder = folder("clips");
    let made = folder.join("clips");
    fbcrowd(&["clips", "--out", text(&made)]).expect_code(0);
    let bundled = support::repository().join("assets/clips");
    for name in support::files(&made) {
        let read = |folder: &std::path::Path| std::fs::read(folder.join(&name)).unwrap_or_default();
        assert!(read(&made) == read(&bundled), "{name} differs: run `fbcrowd clips --out assets/clips`");
    }
}

#[test]
fn planted_feet_of_the_bundled_clips_hold() {
    let database = compile(&["assets/clips".to_owned()], &folder("bundled"));
    fbcrowd(&["validate", text(&database)]).expect_code(0);
    let report = inspect(&database);
    let examples = report["examples"].as_array().unwrap();
    assert!(examples.len() >= 20, "{}", examples.len());
    for example in examples {
        let name = example["name"].as_str().unwrap();
        let runs = name.starts_with("jog") || name.starts_with("run");
        let limit = if runs { 3.0 } else { 1.0 };
        assert!(number(example, "planted_slide_cm_s") <= limit, "{example}");
    }
    assert!((number(&report["blend_space"], "covered_share") - 1.0).abs() < 1e-3);
    assert!(!report["correspondence"]["pairs_s"].as_array().unwrap().is_empty());
}

#[test]
#[ignore = "needs other people's clips: set FBCROWD_MOCAP"]
fn marine_clips_make_the_papers_19_examples() {
    let database = compile(&marine_clips(), &folder("marine"));
    fbcrowd(&["validate", text(&database)]).expect_code(0);
    let report = inspect(&database);
    let examples = report["examples"].as_array().unwrap();
    let mirrors = examples.iter().filter(|example| example["mirrored"] == true).count();
    assert_eq!((report["sources"].as_array().unwrap().len(), examples.len(), mirrors), (12, 19, 7));
}

#[test]
#[ignore = "needs other people's clips: set FBCROWD_MOCAP"]
fn a_mirror_negates_turning_and_strafing_only() {
    let report = inspect(&compile(&marine_clips(), &folder("mirrors")));
    let examples = report["examples"].as_array().unwrap();
    for mirror in examples.iter().filter(|example| example["mirrored"] == true) {
        let same_source = |example: &&Value| example["source"] == mirror["source"] && example["mirrored"] == false;
        let original = examples.iter().find(same_source).expect("every mirror has its original");
        assert_eq!(number(mirror, "speed_mps"), number(original, "speed_mps"));
        assert_eq!(number(mirror, "turn_rate_rad_s"), -number(original, "turn_rate_rad_s"));
        assert_eq!(number(mirror, "strafe_mps"), -number(original, "strafe_mps"));
        assert_eq!(number(mirror, "duration_s"), number(original, "duration_s"));
    }
}

#[test]
#[ignore = "needs other people's clips: set FBCROWD_MOCAP"]
fn an_in_place_gltf_clip_has_its_feets_speed() {
    let mut clips = marine_clips();
    clips.push(text(&mocap().join("gltf/Soldier.glb")).to_owned());
    let database = compile(&clips, &folder("soldier"));
    fbcrowd(&["validate", text(&database)]).expect_code(0);
    let report = inspect(&database);
    let sources = report["sources"].as_array().unwrap();
    // In place: three times the tolerances of other clips (`fbcrowd_bench::compiler::ground_truth`).
    for (clip, speed) in [("Walk", 1.70), ("Run", 4.22)] {
        let found = sources.iter().find(|source| source["clip"] == clip).expect("the clip is listed");
        assert!(within(number(found, "speed_mps"), speed, 0.09, 0.09), "{found}");
        let from =
            |example: &&Value| example["source"] == "Soldier.glb" && example["name"].as_str().unwrap().contains(clip);
        let example = report["examples"].as_array().unwrap().iter().find(from).expect("it gives an example");
        assert!(number(example, "planted_share") > 0.2, "{example}");
    }
}

#[test]
fn inspecting_clips_needs_no_database() {
    let report = fbcrowd(&["inspect", "assets/clips/walk_110.bvh", "--json"]).expect_code(0).json();
    let sources = report["sources"].as_array().unwrap();
    assert_eq!(sources.len(), 1);
    assert!(within(number(&sources[0], "speed_mps"), 1.1, 0.01, 0.01), "{}", sources[0]);
}

#[test]
fn one_clip_makes_a_database_without_correspondences() {
    let database = compile(&["assets/clips/walk_110.bvh".to_owned()], &folder("one_clip"));
    fbcrowd(&["validate", text(&database)]).expect_code(0);
    let report = inspect(&database);
    assert_eq!(report["examples"].as_array().unwrap().len(), 1);
    assert!(report["correspondence"].is_null());
}

#[test]
fn an_example_is_left_out_with_its_mirror() {
    let walks = ["idle.bvh", "walk_080.bvh", "walk_110.bvh", "walk_140.glb"];
    let turns = ["turn_030_left.glb", "turn_060_left.bvh", "turn_090_left.bvh"];
    let clips = [&walks[..], &turns].concat().into_iter().map(|clip| format!("assets/clips/{clip}"));
    let database = compile(&clips.collect::<Vec<_>>(), &folder("leave_one_out"));
    let report = fbcrowd(&["inspect", text(&database), "--leave-one-out", "--json"]).expect_code(0).json();
    let found = &report["leave_one_out"];
    let examples = found["examples"].as_array().unwrap();
    let names: Vec<&str> = examples.iter().map(|example| example["name"].as_str().unwrap()).collect();
    assert_eq!(names, ["turn_030_left", "turn_060_left", "walk_080", "walk_110"]);
    for example in examples {
        let name = example["name"].as_str().unwrap();
        let mix = example["mix"].as_array().unwrap();
        assert!((mix.iter().map(|part| number(part, "share")).sum::<f64>() - 1.0).abs() < 1e-5);
        assert!(!mix.iter().any(|part| part["name"].as_str().unwrap().starts_with(name)), "{example}");
        assert!(!example["nearest"].as_str().unwrap().starts_with(name), "{example}");
        assert!(number(example, "blended_rmse_m") < 0.05, "{example}");
        let joints_m = example["joint_blended_rmse_m"].as_array().unwrap().iter().map(|joint| joint.as_f64().unwrap());
        let mean_square_m2 = joints_m.map(|joint_m| joint_m * joint_m).sum::<f64>() / 22.0;
        assert!((mean_square_m2.sqrt() - number(example, "blended_rmse_m")).abs() < 1e-6, "{example}");
    }
    assert!(number(found, "blended_better_share") >= 0.75, "{found}");
}

#[test]
fn corners_of_the_hull_are_not_left_out() {
    let database = compile(&["assets/clips/walk_110.bvh".to_owned()], &folder("leave_one_out_alone"));
    let report = fbcrowd(&["inspect", text(&database), "--leave-one-out", "--json"]).expect_code(0).json();
    assert_eq!(report["leave_one_out"]["outside"][0], "walk_110");
    assert!(report["leave_one_out"]["median_blended_rmse_m"].is_null());
    assert_eq!(report["leave_one_out"]["per_joint"].as_array().unwrap().len(), 0);
    let shown = fbcrowd(&["inspect", text(&database), "--leave-one-out"]).expect_code(0).stdout;
    assert!(shown.contains("no example can be left out"), "{shown}");
    fbcrowd(&["inspect", "assets/clips/walk_110.bvh", "--leave-one-out"]).expect_code(2).says(&["fbcrowd compile"]);
}

#[test]
fn a_simulation_completes_a_set() {
    let folder = folder("completed");
    let database = compile(&["assets/clips/jog_turn_110_left.bvh".to_owned()], &folder);
    let given = Arc::new(database_file::read(&database).unwrap().0);
    let complete = library::augmented(Arc::clone(&given));
    let again = library::augmented(Arc::clone(&complete));
    assert!(Arc::ptr_eq(&complete, &again));
    let (_, count) = library::deformed_walk(&given, &complete).unwrap();

    let (scene, recording) = (folder.join("scene.toml"), folder.join("scene.fbrec"));
    let one = "database = \"motion.fbdb\"\nduration_s = 0.1\nagents = { at_m = [0, 0], goals_m = [[2, 0]] }\n";
    std::fs::write(&scene, one).unwrap();
    let simulated = fbcrowd(&["simulate", text(&scene), "-o", text(&recording)]).expect_code(0);
    simulated.says(&[&format!("is deformed to {count} of them")]);
    assert_eq!(*Recording::open(&recording).unwrap().header().velocity_hull(), complete.velocity_hull);
}

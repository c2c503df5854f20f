//! `--json` is a promise: programs read these keys, units in their names.

mod support;

use std::fs;

use serde_json::Value;
use support::{compile, fbcrowd, folder, repository, text};

/// What is told of an example's motion, by `compile` and by `validate`.
const QUALITY: [&str; 10] = [
    "example",
    "planted_slide_cm_s",
    "planted_share",
    "seam_angle_ratio",
    "seam_velocity_ratio",
    "penetration_mm",
    "knee_flexion_min_deg",
    "leg_extension_max",
    "range_excess_deg",
    "range_excess_joint",
];

/// Fails unless an object has exactly these keys.
#[track_caller]
fn check_keys(value: &Value, keys: &[&str]) {
    let mut found: Vec<&str> = value.as_object().expect("an object").keys().map(String::as_str).collect();
    let mut wanted = keys.to_vec();
    found.sort_unstable();
    wanted.sort_unstable();
    assert_eq!(found, wanted);
}

#[test]
fn inspect_lists_examples_sources_velocity_sets_simplices_and_correspondences() {
    let clips = ["walk_080", "walk_110", "jog_240"].map(|clip| format!("assets/clips/{clip}.bvh"));
    let report = fbcrowd(&["inspect", text(&compile(&clips, &folder("inspect_keys"))), "--json"]).expect_code(0).json();
    check_keys(&report, &["examples", "sources", "velocity_hull", "blend_space", "correspondence", "coverage"]);
    let of_example = [
        "name",
        "source",
        "clip",
        "window_s",
        "mirrored",
        "speed_mps",
        "turn_rate_rad_s",
        "strafe_mps",
        "duration_s",
        "key_times_s",
        "planted_slide_cm_s",
        "planted_share",
    ];
    check_keys(&report["examples"][0], &of_example);
    assert_eq!(report["examples"][0]["source"], "jog_240.bvh");
    let of_source = [
        "file",
        "clip",
        "speed_mps",
        "turn_rate_rad_s",
        "strafe_mps",
        "up_axis",
        "metres_per_unit",
        "frame_rate_hz",
        "warnings",
        "diagnostics",
    ];
    check_keys(&report["sources"][0], &of_source);
    check_keys(&report["velocity_hull"], &["construction", "turning_mps", "holding_mps", "sharp_turn_edges_mps"]);
    check_keys(&report["blend_space"], &["dimension", "simplices", "covered_share"]);
    check_keys(&report["correspondence"], &["semi_procedural", "blending", "pairs_s"]);
    check_keys(&report["coverage"][0], &["lack", "sentence"]);
    assert_eq!(report["coverage"][0]["lack"], "standing");
    assert_eq!(report["correspondence"]["semi_procedural"], "walk_110");
    assert_eq!(report["correspondence"]["blending"], "walk_080");
    assert_eq!(report["velocity_hull"]["turning_mps"][0].as_array().map(Vec::len), Some(2));
}

#[test]
fn inspecting_clips_tells_the_gait_of_each_in_its_own_time() {
    let report = fbcrowd(&["inspect", "assets/clips/walk_110.bvh", "assets/clips/idle.bvh", "--json"]);
    let report = report.expect_code(0).json();
    check_keys(&report, &["sources", "refused"]);
    let [idle, walk] = [0, 1].map(|source| &report["sources"][source]["gait"]);
    check_keys(walk, &["kind", "planted_share", "right", "left"]);
    assert_eq!((&idle["kind"], &walk["kind"]), (&Value::from("stands"), &Value::from("steps")));
    for contact in ["right", "left"].iter().flat_map(|side| walk[*side].as_array().unwrap()) {
        check_keys(contact, &["strike_s", "toe_off_s"]);
        let [strike_s, toe_off_s] = ["strike_s", "toe_off_s"].map(|event| contact[event].as_f64());
        assert!(strike_s.is_some() || toe_off_s.is_some(), "{contact}");
        assert!(strike_s.zip(toe_off_s).is_none_or(|(strike_s, toe_off_s)| strike_s < toe_off_s), "{contact}");
    }
}

#[test]
fn leaving_out_keeps_its_keys() {
    let clips = ["walk_050", "walk_080", "walk_110"].map(|clip| format!("assets/clips/{clip}.bvh"));
    let database = compile(&clips, &folder("leave_one_out_keys"));
    let report = fbcrowd(&["inspect", text(&database), "--leave-one-out", "--json"]).expect_code(0).json();
    let found = &report["leave_one_out"];
    let of_all = [
        "examples",
        "outside",
        "blended_better_share",
        "median_blended_rmse_m",
        "median_nearest_rmse_m",
        "median_joint_blended_rmse_m",
        "median_joint_nearest_rmse_m",
        "per_joint",
    ];
    check_keys(found, &of_all);
    let of_example =
        ["name", "blended_rmse_m", "nearest_rmse_m", "joint_blended_rmse_m", "joint_nearest_rmse_m", "nearest", "mix"];
    check_keys(&found["examples"][0], &of_example);
    check_keys(&found["per_joint"][0], &["joint", "median_blended_rmse_m", "median_nearest_rmse_m"]);
    assert_eq!(found["per_joint"][0]["joint"], "pelvis");
    check_keys(&found["examples"][0]["mix"][0], &["name", "share"]);
    assert_eq!(found["examples"][0]["name"], "walk_080");
}

#[test]
fn validate_lists_checks_findings_and_figures() {
    let database = repository().join("tests/golden/version_2.fbdb");
    let report = fbcrowd(&["validate", text(&database), "--json"]).expect_code(0).json();
    check_keys(&report, &["valid", "checks", "findings", "quality"]);
    assert_eq!(report["valid"], true);
    let checks = report["checks"].as_array().unwrap();
    checks.iter().for_each(|check| check_keys(check, &["name", "holds", "detail"]));
    let names: Vec<&str> = checks.iter().map(|check| check["name"].as_str().unwrap()).collect();
    let invariants = [
        "checksum",
        "has_examples",
        "rows_are_complete",
        "indices_are_in_range",
        "names_are_unique",
        "skeleton_is_a_body",
        "sources_are_finite",
        "windows_are_ordered",
        "parameters_are_human",
        "phase_maps_rise",
        "rows_are_finite",
        "rotations_are_unit_and_aligned",
        "cycles_close",
        "landmarks_are_mid_stances",
        "key_times_end_contacts",
        "planted_feet_slide_as_stored",
        "parameters_follow_from_the_motion",
        "hulls_are_clockwise_and_convex",
        "hulls_wrap_their_examples",
        "half_planes_agree_with_the_hulls",
        "sharp_turns_wrap_the_turning_examples",
        "simplices_tile_the_hull",
        "correspondences_are_cyclic",
    ];
    assert_eq!(names, invariants);
    check_keys(&report["quality"][0], &QUALITY);
    assert_eq!(report["quality"][0]["example"], "idle");
}

#[test]
fn measure_and_the_timing_report_keep_their_keys() {
    let folder = folder("measure_keys");
    let database = compile(&["assets/clips/walk_110.bvh".to_owned()], &folder);
    let scene = folder.join("scene.toml");
    let clips = repository().join("assets/clips");
    let content = "duration_s = 1\nagents = { at_m = [0, 0], goals_m = [[5, 0]] }\n";
    fs::write(&scene, format!("clips = \"{}\"\n{content}", text(&clips))).unwrap();
    let (recording, report) = (folder.join("scene.fbrec"), folder.join("report.json"));
    let arguments =
        ["simulate", text(&scene), "--db", text(&database), "-o", text(&recording), "--report", text(&report)];
    fbcrowd(&arguments).expect_code(0);
    let timings: Value = serde_json::from_str(&fs::read_to_string(&report).unwrap()).unwrap();
    let of_timings = [
        "agents",
        "steps",
        "threads",
        "plan_microseconds_per_agent_step",
        "synthesis_microseconds_per_agent_step",
        "coupling_microseconds_per_agent_step",
        "times_real_time",
        "agents_per_core_in_real_time",
    ];
    check_keys(&timings, &of_timings);

    let trajectories = folder.join("roots.txt");
    let table = folder.join("roots.csv");
    let outputs = ["--trajectories", text(&trajectories), "--table", text(&table)];
    let measures = fbcrowd(&[&["measure", text(&recording), "--json"], &outputs[..]].concat()).expect_code(0).json();
    let of_measures = [
        "agents",
        "steps",
        "dt_s",
        "collision_rate",
        "minimum_separation_m",
        "mean_acceleration_mps2",
        "mean_acceleration_before_arrival_mps2",
        "arrived",
        "stalled",
        "mean_time_to_goal_s",
        "path_over_straight_line",
        "strafing_share",
        "stepping_back_share",
        "body_penetration_mm",
        "body_penetration_touching_mm",
        "body_penetration_max_mm",
        "body_touching_share",
        "wall_disc_share",
        "wall_body_share",
        "wall_body_max_mm",
        "planted_slide_cm_s",
        "examples_slide_cm_s",
        "planted_share",
        "root_tracking_error_m",
        "root_tracking_worst_m",
        "heading_error_deg",
        "walking_heading_error_deg",
    ];
    check_keys(&measures, &of_measures);
    assert_eq!((&measures["agents"], &measures["steps"]), (&Value::from(1), &Value::from(30)));
    assert!(measures["mean_time_to_goal_s"].is_null());
    assert_eq!(fs::read_to_string(&trajectories).unwrap().lines().count(), 31);
    assert_eq!(fs::read_to_string(&table).unwrap().lines().count(), 1 + 31);
}

#[test]
fn compile_reports_every_clip_once_with_quality_stages_and_what_to_do() {
    let folder = folder("compile_keys");
    let broken = folder.join("broken.bvh");
    fs::write(&broken, "no clip").unwrap();
    let database = folder.join("motion.fbdb");
    let arguments = ["compile", text(&broken), "assets/clips/side_060_left.bvh", "-o", text(&database), "--json"];
    let report = fbcrowd(&arguments).expect_code(1).json();
    let of_report = [
        "output",
        "example_count",
        "mirror_count",
        "simplex_count",
        "refused",
        "unused",
        "warnings",
        "diagnostics",
        "used",
        "quality",
        "findings",
        "coverage",
        "stages",
        "next",
    ];
    check_keys(&report, &of_report);
    check_keys(&report["refused"][0], &["file", "clip", "reason"]);
    check_keys(&report["used"][0], &["file", "clip", "examples"]);
    let of_example = ["name", "mirrored", "window_s", "speed_mps", "turn_rate_rad_s", "strafe_mps"];
    check_keys(&report["used"][0]["examples"][0], &of_example);
    check_keys(&report["quality"][0], &QUALITY);
    check_keys(&report["stages"][0], &["name", "seconds"]);
    assert_eq!((&report["example_count"], &report["mirror_count"]), (&Value::from(2), &Value::from(1)));
    assert_eq!(report["used"].as_array().map(Vec::len), Some(1));
}

#[test]
fn programs_are_told_why_nothing_was_written() {
    let folder = folder("nothing_written");
    let (broken, walk) = (folder.join("broken.bvh"), folder.join("walk_110.bvh"));
    fs::write(&broken, "no clip").unwrap();
    fs::copy(repository().join("assets/clips/walk_110.bvh"), &walk).unwrap();
    let half_a_step = "[[clips]]\npath = 'walk_110.bvh'\nframes = [1, 15]\n";
    fs::write(folder.join("manifest.toml"), half_a_step).unwrap();
    let database = folder.join("motion.fbdb");
    let compile = |arguments: &[&str]| {
        let outcome = fbcrowd(&[&["compile", "--json", "-o", text(&database)], arguments].concat()).expect_code(2);
        let report = outcome.json();
        assert!(report["output"].is_null() && !database.exists(), "{report}");
        assert_eq!(report["refused"][0]["file"], text(&broken));
        assert!(!report["next"].as_array().unwrap().is_empty());
        outcome.says(&["broken.bvh"]);
        report
    };
    let none = compile(&[text(&folder)]);
    assert_eq!(none["unused"][0]["file"], "walk_110.bvh");
    let diagnostic = &none["diagnostics"][0];
    check_keys(diagnostic, &["file", "clip", "severity", "code", "text"]);
    assert_eq!((&diagnostic["severity"], &diagnostic["code"]), (&"no_example".into(), &"no_step".into()));
    assert_eq!(none["unused"][0]["reason"], diagnostic["text"]);
    let strict = compile(&[text(&broken), text(&walk), "--strict"]);
    assert_eq!((&strict["example_count"], &strict["unused"].as_array().unwrap().len()), (&1.into(), &0));

    let inspected = fbcrowd(&["inspect", text(&folder), "--json"]).expect_code(1).json();
    let source = &inspected["sources"][0];
    check_keys(&source["diagnostics"][0], &["severity", "code", "text"]);
    assert_eq!(source["diagnostics"][0]["text"], diagnostic["text"]);
    assert_eq!(source["warnings"][0], format!("no example: {}", diagnostic["text"].as_str().unwrap()));
    assert_eq!(source["gait"]["reason"], diagnostic["text"]);

    let inspected = fbcrowd(&["inspect", text(&broken), "--json"]).expect_code(2).json();
    check_keys(&inspected, &["sources", "refused"]);
    check_keys(&inspected["refused"][0], &["file", "clip", "reason"]);
}

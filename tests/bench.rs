//! `fbcrowd bench` through the built binary: every bench follows its schema and ends with the right exit code.

mod support;

use std::fs;

use serde_json::Value;
use support::{check_schema, fbcrowd, folder, mocap, repository, text};

/// Fails unless a bench follows its schema, has criteria, and ends with the exit code that they say.
#[track_caller]
fn check_bench(bench: &str, arguments: &[&str]) -> Value {
    let outcome = fbcrowd(&[&["bench", bench, "--json"], arguments].concat());
    let found = outcome.json();
    check_schema(&format!("bench-{bench}"), &found);
    let criteria = found["bars"].as_array().expect("criteria");
    assert!(!criteria.is_empty());
    let all_met = criteria.iter().all(|criterion| criterion["met"] == true);
    outcome.expect_code(if all_met { 0 } else { 1 });
    found
}

#[test]
fn compile_gives_the_same_bytes_for_any_order() {
    let clips = folder("bench_compile");
    for clip in ["walk_080.bvh", "walk_110.bvh", "idle.bvh"] {
        fs::copy(repository().join("assets/clips").join(clip), clips.join(clip)).unwrap();
    }
    let found = check_bench("compile", &["--mocap", text(&clips)]);
    assert_eq!(found["examples"], 3);
    assert!(found["bars"].as_array().unwrap().iter().all(|criterion| criterion["met"] == true), "{found}");
    assert!(found["goals"][0]["measured"].as_f64().unwrap() > 0.0);
}

#[test]
fn import_is_compared_with_an_index() {
    let clips = folder("bench_import");
    fs::copy(repository().join("assets/clips/walk_110.bvh"), clips.join("walk.bvh")).unwrap();
    let index = |speed: &str| {
        let header = "file,clip,duration_s,up,m_per_unit,v_fwd_mps,turn_degps,v_left_mps,implied_fwd_mps,implied_left_mps,locomotion";
        fs::write(clips.join("index.csv"), format!("{header}\nwalk.bvh,,4.8,+Y,0.01,{speed},0.0,0.0,,,yes\n")).unwrap();
        check_bench("import", &["--mocap", text(&clips)])
    };
    let right = index("1.1");
    assert_eq!(right["bars"][0]["met"], true, "{right}");
    let wrong = index("1.3");
    assert_eq!(wrong["bars"][0]["met"], false, "{wrong}");
    assert!(wrong["rows"][0]["excess"].as_f64().unwrap() > 1.0);
}

#[test]
fn a_folder_without_index_is_bad_input() {
    let clips = folder("bench_no_index");
    fbcrowd(&["bench", "import", "--mocap", text(&clips)]).expect_code(2).says(&["index.csv"]);
}

#[test]
#[ignore = "needs other people's clips: set FBCROWD_MOCAP"]
fn leave_one_out_has_three_sets_and_their_styles() {
    let found = check_bench("leave-one-out", &["--mocap", text(&mocap())]);
    let sets = found["sets"].as_array().unwrap();
    let of = |name: &str| sets.iter().filter(|set| set["name"] == name).count();
    assert_eq!(["Marine", "Bandai Namco", "bundled"].map(of), [1, 5, 1]);
}

#[test]
#[ignore = "needs other people's clips: set FBCROWD_MOCAP"]
fn gait_events_are_compared_with_labels() {
    let found = check_bench("gait", &["--mocap", text(&mocap())]);
    assert!(found["events"].as_array().unwrap().len() >= 80);
    assert!(found["sets"][0]["median_error_frames"].as_f64().unwrap() < 2.0, "{}", found["sets"]);
}

#[test]
fn table1_runs_the_scenes_of_a_folder() {
    let folder = folder("bench_table1");
    let scenes = folder.join("scenes");
    fs::create_dir_all(&scenes).unwrap();
    for seed in 1..=3 {
        fs::write(scenes.join(format!("pair_s{seed}.txt")), format!("-3 0.{seed} 3 0.{seed}\n3 0 -3 0\n")).unwrap();
    }
    let (paths, plots) = (folder.join("paths"), folder.join("plots"));
    let outputs = ["--trajectories", text(&paths), "--plots", text(&plots)];
    let found = check_bench("table1", &[&["--scenes", text(&scenes), "--seeds", "1,3"], &outputs[..]].concat());
    assert_eq!((&found["scenes"][0]["scene"], &found["scenes"][0]["agents"]), (&"pair".into(), &2.into()));
    let planners = found["scenes"][0]["planners"].as_array().unwrap();
    let names: Vec<&Value> = planners.iter().map(|planner| &planner["planner"]).collect();
    assert_eq!(names, ["mcn", "orca", "social_force", "social_force_20_substeps"]);
    for planner in planners {
        for key in ["collision_rate", "mean_acceleration_mps2", "mean_acceleration_before_arrival_mps2"] {
            assert!(planner[key].is_f64() && planner[format!("{key}_sd")].is_f64(), "{key} of {planner}");
        }
        for key in ["arrived_share", "mean_time_to_goal_s", "body_penetration_mm", "plan_microseconds_per_agent_step"] {
            assert!(planner[key].is_f64(), "{key} of {planner}");
        }
        assert!(planner["stalled"].is_u64());
        let seeds: Vec<&Value> = planner["runs"].as_array().unwrap().iter().map(|run| &run["seed"]).collect();
        assert_eq!(seeds, [1, 3]);
    }
    let lines = fs::read_to_string(paths.join("pair_s3_orca.txt")).unwrap();
    assert_eq!((lines.lines().count(), fs::read_dir(&paths).unwrap().count()), (601, 8));
    assert_eq!(lines.lines().next().unwrap(), "-3.000000 0.300000 3.000000 0.000000");
    assert!(plots.join("table1.png").is_file() && plots.join("pair_s1.png").is_file());
}

#[test]
fn a_scene_with_overlapping_agents_is_bad_input() {
    let scenes = folder("bench_overlap");
    fs::write(scenes.join("crowded.txt"), "0 0 5 0\n0.2 0 9 0\n").unwrap();
    fbcrowd(&["bench", "table1", "--scenes", text(&scenes)]).expect_code(2).says(&["crowded.txt:2", "overlap"]);
    fs::write(scenes.join("crowded.txt"), "0 0 5\n").unwrap();
    fbcrowd(&["bench", "table1", "--scenes", text(&scenes)]).expect_code(2).says(&["crowded.txt", "x y goal_x goal_y"]);
}

#[test]
fn figure7_draws_three_planners() {
    let picture = folder("bench_figure7").join("figure7.png");
    let found = check_bench("figure7", &["-o", text(&picture)]);
    assert_eq!(found["scenes"][0]["planners"].as_array().unwrap().len(), 3);
    assert!(picture.is_file());
}

#[test]
fn plan_times_mcn_orca_and_its_query() {
    let found = check_bench("plan", &["--largest", "1000"]);
    let crowds = found["crowds"].as_array().unwrap();
    assert_eq!(crowds.iter().map(|crowd| crowd["agents"].as_u64().unwrap()).collect::<Vec<_>>(), [100, 1000]);
    for crowd in crowds {
        let microseconds = |what: &str| crowd[format!("{what}_microseconds_per_agent_step")].as_f64().unwrap();
        assert!(0.0 < microseconds("query") && microseconds("query") < microseconds("orca"), "{crowd}");
        assert!(microseconds("orca") < microseconds("mcn") && microseconds("mcn") < 100.0, "{crowd}");
    }
}

#[test]
fn routes_agree_on_small_grounds() {
    let found = check_bench("routes", &["--largest", "30"]);
    let grounds = found["grounds"].as_array().unwrap();
    assert_eq!(grounds.iter().map(|ground| ground["ground"].as_str().unwrap()).collect::<Vec<_>>(), ["room", "door"]);
    assert!(found["bars"].as_array().unwrap().iter().all(|criterion| criterion["met"] == true), "{found}");
}

#[test]
fn course_is_walked_by_every_synthesis() {
    let picture = folder("bench_course").join("course.png");
    let found = check_bench("course", &["-o", text(&picture)]);
    let mut names: Vec<&str> =
        found["ways"].as_array().unwrap().iter().map(|walk| walk["synthesis"].as_str().unwrap()).collect();
    names.dedup();
    assert_eq!(names, ["blending", "semi_procedural", "hybrid", "hybrid_through_m_mb"]);
    assert!(found["bars"].as_array().unwrap().iter().all(|criterion| criterion["met"] == true), "{found}");
    assert!(picture.is_file());
}

#[test]
fn scenes_of_the_paper_go_on() {
    let plots = folder("bench_scenes");
    let found = check_bench("scenes", &["--largest", "50", "--plots", text(&plots)]);
    let runs = found["runs"].as_array().unwrap();
    let names: Vec<&str> = runs.iter().map(|run| run["scene"].as_str().unwrap()).collect();
    assert_eq!(names, ["shibuya", "tradeshow", "mall", "obstacle_course"]);
    for criterion in found["bars"].as_array().unwrap() {
        let is_crowding = criterion["name"].as_str().unwrap().contains("blocked");
        assert!(is_crowding || criterion["met"] == true, "{criterion}");
    }
    let served = runs[2]["states"].as_array().unwrap().iter().find(|state| state["state"] == "pay_market").unwrap();
    assert!(served["entered"].as_u64().unwrap() > 0, "{served}");
    assert_eq!(fs::read_dir(&plots).unwrap().count(), 3 * runs.len());
}

#[test]
fn coupled_bodies_overlap_and_slide_less() {
    let found = check_bench("coupled", &[]);
    for criterion in found["bars"].as_array().unwrap() {
        let name = criterion["name"].as_str().unwrap();
        if name.contains("bodies") || name.contains("slide") {
            assert_eq!(criterion["met"], true, "{criterion}");
        }
    }
}

#[test]
fn figure6_times_every_circle_and_crowd() {
    let found = check_bench("figure6", &["--largest", "1000"]);
    assert_eq!(found["circles"].as_array().unwrap().len(), 6);
    assert_eq!(found["crowds"].as_array().unwrap().len(), 1);
    assert!(found["crowds"][0]["deformed_share"].as_f64().unwrap() > 0.0, "{found}");
    let growth = found["bars"]
        .as_array()
        .unwrap()
        .iter()
        .filter(|criterion| criterion["name"].as_str().unwrap().contains("over 1,000"));
    assert!(growth.into_iter().all(|criterion| criterion["measured"].is_null()), "{found}");
    assert!(found["bytes_per_agent"].as_u64().unwrap() <= 4096);
}

#[test]
fn bodies_of_three_walks_follow_commands() {
    let clips = folder("bench_blend");
    for clip in ["walk_080.bvh", "walk_110.bvh", "walk_140.glb"] {
        fs::copy(repository().join("assets/clips").join(clip), clips.join(clip)).unwrap();
    }
    let database = clips.join("walks.fbdb");
    fbcrowd(&["compile", text(&clips), "-o", text(&database)]).expect_code(0);
    let blend = check_bench("blend", &["--db", text(&database)]);
    assert_eq!(blend["runs"].as_array().unwrap().len(), 3);
    assert!(blend["runs"][0]["points"].as_array().unwrap().len() > 8);
    let tracking = check_bench("tracking", &["--db", text(&database)]);
    assert!(tracking["changes"].as_array().unwrap().len() >= 3 * 6, "{tracking}");
}

#[test]
fn blend_space_follows_its_schema() {
    assert_eq!(check_bench("blend-space", &[])["sets"].as_array().unwrap().len(), 3);
}

#[test]
fn bodies_follows_its_schema() {
    assert!(check_bench("bodies", &[])["examples_mixed"].as_f64().unwrap() > 1.0);
}

#[test]
fn clips_follows_its_schema() {
    assert!(check_bench("clips", &[])["clips"].as_array().unwrap().len() >= 20);
}

#[test]
#[ignore = "needs other people's clips: set FBCROWD_MOCAP"]
fn clips_compares_with_real_ones() {
    assert_eq!(check_bench("clips", &["--mocap", text(&mocap())])["kinds"].as_array().unwrap().len(), 6);
}

#[test]
fn reach_follows_its_schema() {
    assert_eq!(check_bench("reach", &[])["ways"].as_array().unwrap().len(), 12 * 7);
}

#[test]
fn quality_follows_its_schema() {
    assert_eq!(check_bench("quality", &[])["walks"].as_array().unwrap().len(), 3 * 4 * 13);
}

#[test]
fn rimea_follows_its_schema() {
    let found = check_bench("rimea", &["--tests", "1,6,10,turned"]);
    assert_eq!(found["tests"].as_array().unwrap().len(), 4);
    assert!(found["bars"].as_array().unwrap().iter().all(|criterion| criterion["met"] == true), "{found}");
}

#[test]
fn rimea_names_its_tests() {
    fbcrowd(&["bench", "rimea", "--tests", "1,13"]).expect_code(2).says(&["no test `13`", "9, 10, 11, 12, 15, 16"]);
}

#[test]
fn emergence_follows_its_schema() {
    assert_eq!(check_bench("emergence", &["--seeds", "1"])["planners"].as_array().unwrap().len(), 3);
}

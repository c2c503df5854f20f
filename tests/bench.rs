//! `fbcrowd bench` through the built binary: what it prints, and which exit code it ends with.

mod support;

use std::fs;

use serde_json::Value;
use support::{fbcrowd, folder, repository, shared, text};

/// Fails unless there are bars, each with its keys, and the exit code is what they say.
#[track_caller]
fn check_bars(arguments: &[&str]) -> Value {
    let outcome = fbcrowd(arguments);
    let found = outcome.json();
    let bars = found["bars"].as_array().expect("bars");
    assert!(!bars.is_empty());
    for bar in bars {
        let mut keys: Vec<&str> = bar.as_object().expect("an object").keys().map(String::as_str).collect();
        keys.sort_unstable();
        assert_eq!(keys, ["limit", "measured", "met", "name"]);
    }
    let met = bars.iter().all(|bar| bar["met"] == true);
    outcome.expect_code(if met { 0 } else { 1 });
    found
}

#[test]
fn compiling_a_folder_is_timed_and_gives_the_same_bytes_for_any_threads_and_order() {
    let clips = folder("bench_compile");
    for clip in ["walk_080.bvh", "walk_110.bvh", "idle.bvh"] {
        fs::copy(repository().join("assets/clips").join(clip), clips.join(clip)).unwrap();
    }
    let found = check_bars(&["bench", "compile", "--mocap", text(&clips), "--json"]);
    assert_eq!(found["examples"], 3);
    assert!(found["bars"].as_array().unwrap().iter().all(|bar| bar["met"] == true), "{found}");
    assert!(found["goals"][0]["measured"].as_f64().unwrap() > 0.0);
}

#[test]
fn importing_is_measured_against_an_index_of_truths() {
    let clips = folder("bench_import");
    fs::copy(repository().join("assets/clips/walk_110.bvh"), clips.join("walk.bvh")).unwrap();
    let index = |speed: &str| {
        let header = "file,clip,duration_s,up,m_per_unit,v_fwd_mps,turn_degps,v_left_mps,implied_fwd_mps,implied_left_mps,locomotion";
        fs::write(clips.join("index.csv"), format!("{header}\nwalk.bvh,,4.8,+Y,0.01,{speed},0.0,0.0,,,yes\n")).unwrap();
        check_bars(&["bench", "import", "--mocap", text(&clips), "--json"])
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
fn leaving_out_is_measured_on_three_sets() {
    let Some(mocap) = shared("leaving_out_is_measured_on_three_sets", "mocap") else { return };
    let found = check_bars(&["bench", "leave-one-out", "--mocap", text(&mocap), "--json"]);
    assert_eq!(found["sets"].as_array().unwrap().len(), 3);
}

#[test]
fn gait_events_are_measured_against_hand_labels() {
    let Some(mocap) = shared("gait_events_are_measured_against_hand_labels", "mocap") else { return };
    let found = check_bars(&["bench", "gait", "--mocap", text(&mocap), "--json"]);
    assert!(found["events"].as_array().unwrap().len() >= 80);
    assert!(found["sets"][0]["median_error_frames"].as_f64().unwrap() < 2.0, "{}", found["sets"]);
}

#[test]
fn planners_meet_in_the_scenes_of_a_folder() {
    let folder = folder("bench_table1");
    let scenes = folder.join("scenes");
    fs::create_dir_all(&scenes).unwrap();
    for seed in 1..=3 {
        fs::write(scenes.join(format!("pair_s{seed}.txt")), format!("-3 0.{seed} 3 0.{seed}\n3 0 -3 0\n")).unwrap();
    }
    let (paths, plots) = (folder.join("paths"), folder.join("plots"));
    let outputs = ["--trajectories", text(&paths), "--plots", text(&plots), "--json"];
    let arguments = [&["bench", "table1", "--scenes", text(&scenes), "--seeds", "1,3"], &outputs[..]].concat();
    let found = check_bars(&arguments);
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
fn a_scene_whose_agents_overlap_is_bad_input() {
    let scenes = folder("bench_overlap");
    fs::write(scenes.join("crowded.txt"), "0 0 5 0\n0.2 0 9 0\n").unwrap();
    fbcrowd(&["bench", "table1", "--scenes", text(&scenes)]).expect_code(2).says(&["crowded.txt:2", "overlap"]);
    fs::write(scenes.join("crowded.txt"), "0 0 5\n").unwrap();
    fbcrowd(&["bench", "table1", "--scenes", text(&scenes)]).expect_code(2).says(&["crowded.txt", "x y goal_x goal_y"]);
}

#[test]
fn the_antipodal_circle_is_drawn_for_three_planners() {
    let picture = folder("bench_figure7").join("figure7.png");
    let found = check_bars(&["bench", "figure7", "-o", text(&picture), "--json"]);
    assert_eq!(found["scenes"][0]["planners"].as_array().unwrap().len(), 3);
    assert!(picture.is_file());
}

#[test]
fn planning_is_timed_beside_orca_and_its_neighbour_query() {
    let found = check_bars(&["bench", "plan", "--largest", "1000", "--json"]);
    let crowds = found["crowds"].as_array().unwrap();
    assert_eq!(crowds.iter().map(|crowd| crowd["agents"].as_u64().unwrap()).collect::<Vec<_>>(), [100, 1000]);
    for crowd in crowds {
        let microseconds = |what: &str| crowd[format!("{what}_microseconds_per_agent_step")].as_f64().unwrap();
        assert!(0.0 < microseconds("query") && microseconds("query") < microseconds("orca"), "{crowd}");
        assert!(microseconds("orca") < microseconds("mcn") && microseconds("mcn") < 100.0, "{crowd}");
    }
}

#[test]
fn the_obstacle_course_is_walked_by_every_synthesis_and_drawn() {
    let picture = folder("bench_course").join("course.png");
    let found = check_bars(&["bench", "course", "-o", text(&picture), "--json"]);
    let mut names: Vec<&str> =
        found["ways"].as_array().unwrap().iter().map(|way| way["synthesis"].as_str().unwrap()).collect();
    names.dedup();
    assert_eq!(names, ["blending", "semi_procedural", "hybrid", "hybrid_through_m_mb"]);
    assert!(found["bars"].as_array().unwrap().iter().all(|bar| bar["met"] == true), "{found}");
    assert!(picture.is_file());
}

#[test]
fn coupled_bodies_touch_each_other_less_and_slide_less_than_the_studys_rival() {
    let found = check_bars(&["bench", "coupled", "--json"]);
    for bar in found["bars"].as_array().unwrap() {
        let name = bar["name"].as_str().unwrap();
        if name.contains("bodies") || name.contains("slide") {
            assert_eq!(bar["met"], true, "{bar}");
        }
    }
}

#[test]
fn the_stages_of_a_frame_are_timed_for_each_circle_and_crowd() {
    let found = check_bars(&["bench", "figure6", "--largest", "1000", "--json"]);
    assert_eq!(found["circles"].as_array().unwrap().len(), 6);
    assert_eq!(found["crowds"].as_array().unwrap().len(), 1);
    assert!(found["crowds"][0]["deformed_share"].as_f64().unwrap() > 0.0, "{found}");
    let growth =
        found["bars"].as_array().unwrap().iter().filter(|bar| bar["name"].as_str().unwrap().contains("over 1,000"));
    assert!(growth.into_iter().all(|bar| bar["measured"].is_null()), "{found}");
    assert!(found["bytes_per_agent"].as_u64().unwrap() <= 4096);
}

#[test]
fn bodies_of_three_walks_do_what_is_asked_and_follow() {
    let clips = folder("bench_blend");
    for clip in ["walk_080.bvh", "walk_110.bvh", "walk_140.glb"] {
        fs::copy(repository().join("assets/clips").join(clip), clips.join(clip)).unwrap();
    }
    let database = clips.join("walks.fbdb");
    fbcrowd(&["compile", text(&clips), "-o", text(&database)]).expect_code(0);
    let blend = check_bars(&["bench", "blend", "--db", text(&database), "--json"]);
    assert_eq!(blend["runs"].as_array().unwrap().len(), 3);
    assert!(blend["runs"][0]["points"].as_array().unwrap().len() > 8);
    let tracking = check_bars(&["bench", "tracking", "--db", text(&database), "--json"]);
    assert!(tracking["changes"].as_array().unwrap().len() >= 3 * 6, "{tracking}");
}

//! The JSON of every command has exactly the keys of its schema (`docs/schemas`), and holds what it should. The benches
//! are checked in `bench.rs`.

mod support;

use std::fs;

use serde_json::Value;
use support::{check_schema, compile, fbcrowd, folder, repository, text};

#[test]
fn inspect_of_a_database_follows_its_schema() {
    let clips = ["walk_080", "walk_110", "jog_240"].map(|clip| format!("assets/clips/{clip}.bvh"));
    let database = compile(&clips, &folder("inspect_schema"));
    let options = ["--leave-one-out", "--correspondence", "walk_110", "jog_240", "--json"];
    for options in [&["--json"][..], &options] {
        let report = fbcrowd(&[&["inspect", text(&database)], options].concat()).expect_code(0).json();
        check_schema("inspect", &report);
        assert_eq!(report["examples"][0]["source"], "jog_240.bvh");
        assert_eq!(report["coverage"][0]["lack"], "standing");
        assert_eq!(report["correspondence"]["semi_procedural"], "walk_110");
        assert_eq!(report["correspondence"]["blending"], "walk_080");
        assert_eq!(report["velocity_hull"]["turning_mps"][0].as_array().map(Vec::len), Some(2));
        assert_eq!(report["leave_one_out"].is_object(), options.len() > 1);
    }
}

#[test]
fn inspect_of_clips_follows_its_schema() {
    let report = fbcrowd(&["inspect", "assets/clips/walk_110.bvh", "assets/clips/idle.bvh", "--json"]);
    let report = report.expect_code(0).json();
    check_schema("inspect", &report);
    let [idle, walk] = [0, 1].map(|source| &report["sources"][source]["gait"]);
    assert_eq!((&idle["kind"], &walk["kind"]), (&Value::from("stands"), &Value::from("steps")));
    for contact in ["right", "left"].iter().flat_map(|side| walk[*side].as_array().unwrap()) {
        let [strike_s, toe_off_s] = ["strike_s", "toe_off_s"].map(|event| contact[event].as_f64());
        assert!(strike_s.is_some() || toe_off_s.is_some(), "{contact}");
        assert!(strike_s.zip(toe_off_s).is_none_or(|(strike_s, toe_off_s)| strike_s < toe_off_s), "{contact}");
    }
}

#[test]
fn leave_one_out_lists_examples_and_joints() {
    let clips = ["walk_050", "walk_080", "walk_110"].map(|clip| format!("assets/clips/{clip}.bvh"));
    let database = compile(&clips, &folder("leave_one_out_schema"));
    let report = fbcrowd(&["inspect", text(&database), "--leave-one-out", "--json"]).expect_code(0).json();
    check_schema("inspect", &report);
    let found = &report["leave_one_out"];
    assert_eq!(found["per_joint"][0]["joint"], "pelvis");
    assert_eq!(found["examples"][0]["name"], "walk_080");
    assert!(!found["examples"][0]["mix"].as_array().unwrap().is_empty());
}

#[test]
fn validate_follows_its_schema_and_lists_every_invariant() {
    let database = repository().join("tests/golden/version_3.fbdb");
    let report = fbcrowd(&["validate", text(&database), "--json"]).expect_code(0).json();
    check_schema("validate", &report);
    assert_eq!(report["valid"], true);
    let checks = report["checks"].as_array().unwrap();
    let names: Vec<&str> = checks.iter().map(|check| check["name"].as_str().unwrap()).collect();
    let invariants = [
        "checksum",
        "styles_are_unique",
        "has_examples",
        "rows_are_complete",
        "indices_are_in_range",
        "names_are_unique",
        "actions_are_complete",
        "extra_joints_are_complete",
        "styles_share_the_skeleton",
        "skeleton_is_a_body",
        "sources_are_finite",
        "windows_are_ordered",
        "parameters_are_human",
        "phase_maps_rise",
        "rows_are_finite",
        "rotations_are_unit_and_aligned",
        "action_frames_are_finite",
        "action_rotations_are_unit_and_aligned",
        "extra_rotations_are_unit_and_aligned",
        "cycles_close",
        "landmarks_are_mid_stances",
        "key_times_end_contacts",
        "planted_feet_slide_as_stored",
        "parameters_follow_from_the_motion",
        "idles_are_loops",
        "actions_meet_their_examples",
        "transitions_move_as_their_kind",
        "transitions_have_no_jumps",
        "hulls_are_clockwise_and_convex",
        "hulls_wrap_their_examples",
        "half_planes_agree_with_the_hulls",
        "sharp_turns_wrap_the_turning_examples",
        "simplices_tile_the_hull",
        "correspondences_are_cyclic",
    ];
    assert_eq!(names, invariants);
    assert_eq!(report["quality"][0]["example"], "idle");
}

#[test]
fn measure_and_simulate_follow_their_schemas() {
    let folder = folder("measure_schema");
    let database = compile(&["assets/clips/walk_110.bvh".to_owned()], &folder);
    let scene = folder.join("scene.toml");
    let clips = repository().join("assets/clips");
    let content = "duration_s = 1\nagents = { at_m = [0, 0], goals_m = [[5, 0]] }\n";
    fs::write(&scene, format!("clips = \"{}\"\n{content}", text(&clips))).unwrap();
    let (recording, report) = (folder.join("scene.fbrec"), folder.join("report.json"));
    let arguments =
        ["simulate", text(&scene), "--db", text(&database), "-o", text(&recording), "--report", text(&report)];
    fbcrowd(&arguments).expect_code(0);
    check_schema("simulate", &serde_json::from_str(&fs::read_to_string(&report).unwrap()).unwrap());

    let trajectories = folder.join("roots.txt");
    let table = folder.join("roots.csv");
    let outputs = ["--trajectories", text(&trajectories), "--table", text(&table)];
    let measures = fbcrowd(&[&["measure", text(&recording), "--json"], &outputs[..]].concat()).expect_code(0).json();
    check_schema("measure", &measures);
    let incidents = folder.join("incidents.csv");
    let of_people = ["measure", text(&recording), "--people", "--json", "--incidents", text(&incidents)];
    let people = fbcrowd(&of_people).expect_code(0).json();
    check_schema("measure-people", &people);
    let minutes = people["agent_minutes"].as_f64().unwrap();
    assert!((minutes - 31.0 / 30.0 / 60.0).abs() < 1e-3, "{minutes}");
    assert_eq!((&measures["agents"], &measures["steps"]), (&Value::from(1), &Value::from(30)));
    assert!(measures["mean_time_to_goal_s"].is_null());
    assert_eq!(fs::read_to_string(&trajectories).unwrap().lines().count(), 31);
    let table = fs::read_to_string(&table).unwrap();
    assert_eq!(table.lines().count(), 1 + 31);
    let documented = fs::read_to_string(repository().join("docs/measures.md")).unwrap();
    let incidents = fs::read_to_string(&incidents).unwrap();
    let columns = [&table, &incidents].into_iter().flat_map(|table| table.lines().next().unwrap().split(','));
    let missing: Vec<&str> = columns.filter(|column| !documented.contains(&format!("`{column}`"))).collect();
    assert!(missing.is_empty(), "docs/measures.md lacks {missing:?}");
}

#[test]
fn check_states_agents_passages_and_sizes() {
    let folder = folder("check_schema");
    let (scene, plot) = (folder.join("scene.toml"), folder.join("scene.png"));
    let agents = "[[agents]]\nat_m = [0, 0]\ngoals_m = [[8, 0]]\n[[sources]]\nat_m = [0, 3]\nrate_per_s = 2\ngoals_m = [[8, 3]]\n";
    let wall = |low: f32, high: f32| {
        format!("[[obstacles]]\npolygon_m = [[4, {low}], [4.2, {low}], [4.2, {high}], [4, {high}]]\n")
    };
    let walls = [wall(-9.0, -0.15), wall(0.15, 9.0)].concat();
    let content = format!("duration_s = 10\n{agents}{walls}");
    fs::write(&scene, content).unwrap();
    let checked = fbcrowd(&["check", text(&scene), "--json", "--plot", text(&plot)]).expect_code(0).json();
    check_schema("check", &checked);
    assert_eq!((&checked["agents"], &checked["steps"], &checked["obstacles"]), (&1.into(), &300.into(), &2.into()));
    assert!((5..40).contains(&checked["due_agents"].as_u64().unwrap()), "{checked}");
    let passages = checked["closed_passages"].as_array().unwrap();
    assert_eq!((passages.len(), &passages[0]["separates"]), (1, &false.into()), "{checked}");
    assert!((passages[0]["width_m"].as_f64().unwrap() - 0.3).abs() < 0.01, "{checked}");
    assert!(fs::read(&plot).unwrap().starts_with(b"\x89PNG"));
    let printed = fbcrowd(&["check", text(&scene)]).expect_code(0).stdout;
    assert!(printed.contains("closed passage   [4.00, 0.00], 0.30 m wide"), "{printed}");
    fbcrowd(&["check", text(&scene), "--plot", text(&scene)]).expect_code(2).says(&["is also an input"]);
    let jpg = folder.join("scene.jpg");
    fbcrowd(&["check", text(&scene), "--plot", text(&jpg)]).expect_code(2).says(&["name one *.png"]);
    assert!(!jpg.exists());
}

#[test]
fn check_draws_a_plan_without_agents() {
    let folder = folder("plan");
    let room = "[[walkable]]\npolygon_m = [[0, 0], [8, 0], [8, 6], [0, 6]]\n";
    let walls = "[[obstacles]]\npolygon_m = [[3, 0], [3.2, 0], [3.2, 2.9], [3, 2.9]]\n\
                 [[obstacles]]\npolygon_m = [[3, 3.1], [3.2, 3.1], [3.2, 6], [3, 6]]\n";
    let scene = folder.join("plan.toml");
    fs::write(&scene, format!("duration_s = 10\n{room}{walls}")).unwrap();
    let plot = folder.join("plan.png");
    let checked = fbcrowd(&["check", text(&scene), "--json", "--plot", text(&plot)]).expect_code(0).json();
    check_schema("check", &checked);
    assert_eq!((&checked["agents"], &checked["meshes"][0]["parts"]), (&0.into(), &2.into()));
    assert_eq!(checked["closed_passages"].as_array().unwrap().len(), 1);
    assert!(plot.is_file());
    assert!(fbcrowd(&["check", text(&scene)]).expect_code(0).stdout.contains("no agents: the plan can be checked"));
    fbcrowd(&["simulate", text(&scene), "-o", text(&folder.join("plan.fbrec"))]).expect_code(2).says(&["[[agents]]"]);
}

#[test]
fn check_looks_for_the_files_of_a_scenario() {
    let folder = folder("check_files");
    let scene = folder.join("scene.toml");
    let agents = "duration_s = 10\n[[agents]]\nat_m = [0, 0]\ngoals_m = [[8, 0]]\n";
    fs::write(folder.join("broken.fbdb"), "no database").unwrap();
    let camera = format!("{agents}[camera]\ngltf = 'none.glb'\n");
    for (content, missing) in [
        (format!("database = 'none.fbdb'\n{agents}"), "none.fbdb"),
        (format!("database = 'broken.fbdb'\n{agents}"), "broken.fbdb"),
        (format!("clips = 'none'\n{agents}"), "none"),
        (format!("{agents}[[characters]]\nfile = 'none.fbchar'\n"), "none.fbchar"),
        (camera, "none.glb"),
    ] {
        fs::write(&scene, content).unwrap();
        fbcrowd(&["check", text(&scene)]).expect_code(2).says(&[missing]);
    }
    fs::write(&scene, agents).unwrap();
    fbcrowd(&["check", text(&scene)]).expect_code(0);
}

#[test]
fn compile_follows_its_schema_and_lists_every_clip_once() {
    let folder = folder("compile_schema");
    let broken = folder.join("broken.bvh");
    fs::write(&broken, "no clip").unwrap();
    let database = folder.join("motion.fbdb");
    let arguments = ["compile", text(&broken), "assets/clips/side_060_left.bvh", "-o", text(&database), "--json"];
    let report = fbcrowd(&arguments).expect_code(1).json();
    check_schema("compile", &report);
    assert_eq!(report["refused"].as_array().map(Vec::len), Some(1));
    assert_eq!((&report["example_count"], &report["mirror_count"]), (&Value::from(2), &Value::from(1)));
    assert_eq!(report["used"].as_array().map(Vec::len), Some(1));
    assert!(!report["stages"].as_array().unwrap().is_empty());
}

#[test]
fn compile_and_inspect_list_the_same_actions() {
    let folder = folder("actions_schema");
    let database = folder.join("motion.fbdb");
    let clips = ["assets/clips/idle.bvh", "assets/clips/walk_110.bvh"];
    let report = fbcrowd(&[&["compile", "-o", text(&database), "--json"], &clips[..]].concat()).expect_code(0).json();
    check_schema("compile", &report);
    let idle = &report["actions"][0];
    assert_eq!((&idle["name"], &idle["kind"], &idle["source"]), (&"idle".into(), &"idle".into(), &"idle.bvh".into()));
    assert_eq!((&idle["entry"]["example"], &idle["turn_rad"]), (&"idle".into(), &0.0.into()));
    let [first_s, last_s] = [0, 1].map(|end| idle["window_s"][end].as_f64().unwrap());
    assert!((last_s - first_s - idle["duration_s"].as_f64().unwrap()).abs() < 0.02, "{idle}");
    let inspected = fbcrowd(&["inspect", text(&database), "--json"]).expect_code(0).json();
    check_schema("inspect", &inspected);
    assert_eq!(inspected["actions"], report["actions"]);
    let table = fbcrowd(&["inspect", text(&database)]).expect_code(0).stdout;
    assert!(table.contains("idles, the best first") && table.contains("idle.bvh"), "{table}");
}

#[test]
fn without_output_json_lists_the_reasons() {
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
        check_schema("compile", &report);
        assert!(report["output"].is_null() && !database.exists(), "{report}");
        assert_eq!(report["refused"][0]["file"], text(&broken));
        assert!(!report["next"].as_array().unwrap().is_empty());
        outcome.says(&["broken.bvh"]);
        report
    };
    let none = compile(&[text(&folder)]);
    assert_eq!(none["unused"][0]["file"], "walk_110.bvh");
    let diagnostic = &none["diagnostics"][0];
    assert_eq!((&diagnostic["severity"], &diagnostic["code"]), (&"no_example".into(), &"no_step".into()));
    assert_eq!(none["unused"][0]["reason"], diagnostic["text"]);
    let strict = compile(&[text(&broken), text(&walk), "--strict"]);
    assert_eq!((&strict["example_count"], &strict["unused"].as_array().unwrap().len()), (&1.into(), &0));

    let inspected = fbcrowd(&["inspect", text(&folder), "--json"]).expect_code(1).json();
    let source = &inspected["sources"][0];
    check_schema("inspect", &inspected);
    assert_eq!(source["diagnostics"][0]["text"], diagnostic["text"]);
    assert_eq!(source["warnings"][0], format!("no example: {}", diagnostic["text"].as_str().unwrap()));
    assert_eq!(source["gait"]["reason"], diagnostic["text"]);

    let inspected = fbcrowd(&["inspect", text(&broken), "--json"]).expect_code(2).json();
    check_schema("inspect", &inspected);
    assert_eq!(inspected["refused"].as_array().map(Vec::len), Some(1));
}

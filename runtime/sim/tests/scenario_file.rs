//! Scenario files give the agents that they describe, and every mistake is shown at its position in the text.

mod common;

use std::collections::BTreeMap;
use std::f32::consts::FRAC_PI_2;
use std::fs;
use std::path::{Path, PathBuf};
use std::time::Instant;

use common::folder;
use fbcrowd_sim::planning::Planner;
use fbcrowd_sim::planning::mcn::StanceForm;
use fbcrowd_sim::scenario::{AtGoal, Coupling, Invalid, MotionSource, Scenario, ScenarioError, read};
use fbcrowd_sim::synthesis::{Modes, Transition};
use glam::Vec2;

const HEAD: &str = "clips = \".\"\nduration_s = 10\n";
const BLOCK: &str = "[[20, 20], [22, 20], [22, 22], [20, 22]]";
const ONE: &str = "agents = { at_m = [0, 0], goals_m = [[5, 0]] }\n";

fn write(test: &str, text: &str) -> PathBuf {
    let path = folder(test).join("scene.toml");
    fs::write(&path, text).unwrap();
    path
}

fn scenario(test: &str, body: &str) -> Scenario {
    read(&write(test, &format!("{HEAD}{body}"))).unwrap().0
}

/// Checks that reading fails, at exactly this part of the text, with a message that contains these words.
fn check_rejected(test: &str, text: &str, part: &str, message: &str) {
    match read(&write(test, text)).and_then(|(scenario, motion)| Ok((scenario, motion?))) {
        Err(ScenarioError::Invalid(invalid)) => check_points_at(&invalid, part, message),
        other => panic!("{text} gave {other:?}"),
    }
}

fn check_points_at(invalid: &Invalid, part: &str, message: &str) {
    assert!(invalid.message.contains(message), "{invalid}");
    assert_eq!(&invalid.text[invalid.span.clone()], part, "{invalid}");
    assert!(!invalid.help.is_empty());
}

#[test]
fn a_short_file_gives_everything_its_default() {
    let (scenario, motion) = read(&write("short", &format!("{HEAD}{ONE}"))).unwrap();
    assert_eq!(
        (scenario.name.as_str(), scenario.dt_s, scenario.duration_s, scenario.seed),
        ("scene", 1.0 / 30.0, 10.0, 1)
    );
    let agent = &scenario.agents[0];
    assert_eq!((agent.radius_m, agent.wall_radius_m, agent.preferred_speed_mps), (0.25, 0.2, 1.33));
    assert!(matches!(motion, Ok(MotionSource::Clips(_))));
}

#[test]
fn wall_radius_is_at_most_the_radius() {
    let agents = scenario(
        "wall_radius",
        "agents = [{ at_m = [1, 1], goals_m = [[9, 9]], radius_m = 0.15 }, { at_m = [3, 3], goals_m = [[4, 4]], radius_m = 0.4, wall_radius_m = 0.4 }]",
    )
    .agents;
    assert_eq!([agents[0].wall_radius_m, agents[1].wall_radius_m], [0.15, 0.4]);
}

#[test]
fn agent_faces_first_goal_by_default() {
    let agents = scenario(
        "facing",
        "agents = [{ at_m = [1, 1], goals_m = [[1, 4], [9, 9]] }, { at_m = [3, 3], goals_m = [[4, 4]], facing_deg = 180 }]",
    )
    .agents;
    assert_eq!((agents[0].facing_rad, agents[0].goals_m.len()), (FRAC_PI_2, 2));
    assert_eq!(agents[1].facing_rad, std::f32::consts::PI);
}

#[test]
fn goals_of_a_circle_are_exactly_opposite() {
    let agents = scenario("circle", "agents = { circle = { count = 17, radius_m = 4 } }").agents;
    assert_eq!(agents.len(), 17);
    assert!(agents.iter().all(|agent| agent.goals_m == [-agent.position_m]));
    assert_eq!(agents[0].position_m, Vec2::new(4.0, 0.0));
}

#[test]
fn grid_is_centred_with_seeded_jitter() {
    let grid = |jitter_m: f32, seed: u64| {
        let body = format!(
            "seed = {seed}\nagents = {{ grid = {{ columns = 3, rows = 2, spacing_m = 2, centre_m = [10, 0], jitter_m = {jitter_m} }}, goal_offset_m = [0, 7] }}"
        );
        scenario("grid", &body).agents
    };
    let plain: Vec<Vec2> = grid(0.0, 1).iter().map(|agent| agent.position_m).collect();
    let at = Vec2::new;
    assert_eq!(plain, [at(8.0, -1.0), at(10.0, -1.0), at(12.0, -1.0), at(8.0, 1.0), at(10.0, 1.0), at(12.0, 1.0)]);
    let jittered = grid(0.3, 1);
    assert_eq!(jittered, grid(0.3, 1));
    assert_ne!(jittered, grid(0.3, 2));
    for (agent, position_m) in jittered.iter().zip(plain) {
        assert!((agent.position_m - position_m).abs().max_element() <= 0.3);
        assert_eq!(agent.goals_m, [agent.position_m + Vec2::new(0.0, 7.0)]);
    }
}

#[test]
fn shared_waypoints_come_before_each_agents_own_goal() {
    let grid = "{ columns = 2, rows = 1, spacing_m = 2 }";
    let agents =
        scenario("door", &format!("agents = {{ grid = {grid}, goals_m = [[3, 3]], goal_offset_m = [9, 0] }}")).agents;
    assert_eq!(agents[0].goals_m, [Vec2::new(3.0, 3.0), Vec2::new(8.0, 0.0)]);
    assert_eq!(agents[1].goals_m, [Vec2::new(3.0, 3.0), Vec2::new(10.0, 0.0)]);
}

#[test]
fn obstacles_run_counter_clockwise_in_either_order() {
    let obstacles =
        |corners: &str| scenario("winding", &format!("{ONE}[[obstacles]]\npolygon_m = {corners}")).obstacles_m;
    let counter_clockwise = obstacles("[[2, 2], [3, 2], [3, 3]]");
    assert_eq!(counter_clockwise, [[Vec2::new(2.0, 2.0), Vec2::new(3.0, 2.0), Vec2::new(3.0, 3.0)]]);
    assert_eq!(obstacles("[[3, 3], [3, 2], [2, 2]]"), counter_clockwise);
}

#[test]
fn an_agent_file_gives_an_agent_per_line() {
    let path = write("lines", &format!("{HEAD}agents = {{ file = \"a.txt\", radius_m = 0.3 }}"));
    fs::write(path.with_file_name("a.txt"), "# start and goal\n0 0 5 0\n\n 1.5 2 -3e0 4 # the other\n").unwrap();
    let agents = read(&path).unwrap().0.agents;
    assert_eq!((agents[1].position_m, &agents[1].goals_m[..]), (Vec2::new(1.5, 2.0), &[Vec2::new(-3.0, 4.0)][..]));
    assert_eq!(agents[1].radius_m, 0.3);
}

#[test]
fn agent_file_mistakes_are_shown_there() {
    let path = write("bad_lines", &format!("{HEAD}agents = {{ file = \"a.txt\" }}"));
    fs::write(path.with_file_name("a.txt"), "# x\n0 0 5 0\n1 2 3\n").unwrap();
    let Err(ScenarioError::Invalid(invalid)) = read(&path) else { panic!("accepted") };
    check_points_at(&invalid, "1 2 3", "3 numbers, not the four");
    assert_eq!((invalid.line(), invalid.path.file_name().unwrap().to_str().unwrap()), (3, "a.txt"));
    for (line, message) in [("0 nan 5 0", "`nan` is not within"), ("0 0 1e99 0", "`1e99` is not within")] {
        fs::write(path.with_file_name("a.txt"), format!("1 1 2 2\n{line}\n")).unwrap();
        let Err(ScenarioError::Invalid(invalid)) = read(&path) else { panic!("accepted") };
        check_points_at(&invalid, line, message);
    }
}

#[test]
fn agent_faults_are_shown_at_their_lines() {
    let check = |agents: &str, a: &str, b: &str, file: &str, part: &str, message: &str| {
        let path = write("crowded_lines", &format!("{HEAD}agents = [{agents}]\n[[obstacles]]\npolygon_m = {BLOCK}"));
        fs::write(path.with_file_name("a.txt"), a).unwrap();
        fs::write(path.with_file_name("b.txt"), b).unwrap();
        let Err(ScenarioError::Invalid(invalid)) = read(&path) else { panic!("accepted") };
        check_points_at(&invalid, part, message);
        assert_eq!(invalid.path.file_name().unwrap(), file);
    };
    let agents = "{ file = \"a.txt\" }, { at_m = [9, 9], goals_m = [[5, 0]] }, { file = \"b.txt\" }";
    let two = "0 0 5 0\n# x\n0 1 5 1\n";
    check(agents, "0 0 5 0\n# x\n0 0.2 5 1\n", "0 5 5 5", "a.txt", "0 0.2 5 1", "agents 0 and 1 overlap");
    check(agents, two, "\n0 5 5 5\n0 7 21 21 # in", "b.txt", "0 7 21 21 # in", "a goal of agent 4 lies inside");
    check(agents, "", "\n0 5 5 5\n21 21 1 1", "b.txt", "21 21 1 1", "agent 2 starts inside obstacle 0");
    // A wrong key of the table is shown in the table.
    let broad = "{ file = \"b.txt\", radius_m = 3 }";
    check(&format!("{{ file = \"a.txt\" }}, {broad}"), two, "0 5 5 5", "scene.toml", broad, "radius_m is 3");
}

#[test]
fn wrong_keys_and_types_are_shown_at_their_position() {
    check_rejected("key", &format!("{HEAD}durations = 3\n{ONE}"), "durations", "unknown field `durations`");
    check_rejected("type", "clips = \".\"\nduration_s = \"ten\"\n", "\"ten\"", "a number is expected here");
    check_rejected(
        "group_key",
        &format!("{HEAD}agents = {{ at_m = [0, 0], goal_m = [[5, 0]] }}"),
        "goal_m",
        "unknown field",
    );
    check_rejected(
        "circle_key",
        &format!("{HEAD}[[agents]]\ncircle = {{ count = 3, radius = 4 }}"),
        "radius",
        "unknown field",
    );
    check_rejected("seed", &format!("{HEAD}seed = -1\n{ONE}"), "-1", "a whole number");
    check_rejected("params", &format!("{HEAD}{ONE}[params.planer]\n"), "planer", "unknown field");
    check_rejected("view", &format!("{HEAD}{ONE}[view]\nheight_px = 3\n"), "height_px", "unknown field");
    check_rejected(
        "point",
        &format!("{HEAD}agents = {{ at_m = [0, 0, 1], goals_m = [[5, 0]] }}"),
        "[0, 0, 1]",
        "are expected here, not 3 values",
    );
    check_rejected("centre", &format!("{HEAD}{ONE}[view]\ncentre_m = [1, 2, 3]\n"), "[1, 2, 3]", "not 3 values");
    check_rejected("syntax", "clips = \n", "", "");
}

#[test]
fn numbers_out_of_range_are_shown_at_their_position() {
    check_rejected("dt", &format!("{HEAD}dt_s = 0\n{ONE}"), "0", "dt_s is 0");
    check_rejected("coarse", &format!("{HEAD}dt_s = 0.5\n{ONE}"), "0.5", "dt_s is 0.5");
    check_rejected("nan", &format!("{HEAD}dt_s = nan\n{ONE}"), "nan", "dt_s is NaN");
    check_rejected("duration", &format!("clips = \".\"\nduration_s = -1\n{ONE}"), "-1", "duration_s is -1");
    let radius = "{ at_m = [0, 0], goals_m = [[5, 0]], radius_m = -1 }";
    check_rejected("radius", &format!("{HEAD}agents = {radius}"), radius, "radius_m is -1");
    let wide = "{ at_m = [0, 0], goals_m = [[5, 0]], wall_radius_m = 0.3 }";
    check_rejected("wide", &format!("{HEAD}agents = {wide}"), wide, "wall_radius_m is 0.3, not between 0.1 and 0.25");
    let thin = "{ at_m = [0, 0], goals_m = [[5, 0]], wall_radius_m = 0.05 }";
    check_rejected("thin", &format!("{HEAD}agents = {thin}"), thin, "wall_radius_m is 0.05");
    let spun = "{ at_m = [0, 0], goals_m = [[5, 0]], facing_deg = 100000 }";
    let message = "facing_deg is 100000, not between -3600 and 3600";
    check_rejected("spun", &format!("{HEAD}agents = {spun}"), spun, message);
    let far = "{ at_m = [inf, 0], goals_m = [[5, 0]] }";
    check_rejected("far", &format!("{HEAD}agents = [{far}]"), far, "is not within 10 km");
    let crowd = "{ circle = { count = 9000000000, radius_m = 1 } }";
    check_rejected("crowd", &format!("{HEAD}agents = {crowd}"), crowd, "not between 1 and 1000000");
    let tunables = "[params.planner]\ntime_horizon_s = 0.0\n";
    check_rejected("tunable", &format!("{HEAD}{ONE}{tunables}"), "0.0", "time_horizon_s is 0, not between");
    check_rejected("no_agents", &format!("{HEAD}agents = []"), "[]", "the number of agents is 0");
    for view in ["width = 0", "height = 100000", "width_m = nan", "frame_rate_hz = 0.0"] {
        check_rejected("picture", &format!("{HEAD}{ONE}[view]\n{view}"), "[view]", "not between");
    }
}

#[test]
fn planner_coupling_and_syntheses_follow_the_scenario() {
    let keys = "planner = \"social_force\"\ncoupling = \"discs\"\n";
    let params = "[params.planner.parts]\nhull = false\nstance = \"radial\"\n[params.synthesis]\nmodes = \"blending\"\ntransition = \"through_m_mb\"\n";
    let chosen = scenario("baselines", &format!("{keys}{ONE}{params}"));
    assert_eq!((chosen.planner, chosen.coupling), (Planner::SocialForce, Coupling::Discs));
    let parts = &chosen.params.planner.parts;
    assert!(!parts.hull && parts.stance == StanceForm::Radial && parts.order);
    let synthesis = &chosen.params.synthesis;
    assert_eq!((synthesis.modes, synthesis.transition), (Modes::Blending, Transition::ThroughMMb));
    let decoupled = scenario("decoupled", &format!("planner = \"orca\"\ncoupling = \"decoupled\"\n{ONE}"));
    assert_eq!((decoupled.coupling, decoupled.modes()), (Coupling::Decoupled, Modes::Blending));
    let plain = scenario("plain", ONE);
    assert_eq!((plain.planner, plain.coupling), (Planner::Mcn, Coupling::TwoWay));
}

#[test]
fn unknown_planners_are_rejected_with_the_known_ones() {
    let text = format!("{HEAD}planner = \"rvo\"\n{ONE}");
    check_rejected("rvo", &text, "\"rvo\"", "`mcn`, `orca`, `social_force`");
    let none = "substeps = 0";
    let text = format!("{HEAD}{ONE}[params.social_force]\n{none}\n");
    check_rejected("substeps", &text, "0", "substeps is 0, not between 1 and 1000");
}

#[test]
fn agents_of_no_layout_or_two_are_rejected() {
    let none = "{ goals_m = [[5, 0]] }";
    check_rejected("none", &format!("{HEAD}agents = {none}"), none, "exactly one");
    let aimless = "{ at_m = [0, 0] }";
    check_rejected("aimless", &format!("{HEAD}agents = {aimless}"), aimless, "need a goal");
    let two = "{ at_m = [0, 0], file = \"scene.toml\" }";
    check_rejected("two", &format!("{HEAD}agents = {two}"), two, "exactly one");
}

#[test]
fn agents_start_apart_from_each_other_and_from_obstacles() {
    let second = "{ at_m = [0.3, 0], goals_m = [[5, 0]] }";
    let agents = format!("agents = [{{ at_m = [0, 0], goals_m = [[5, 0]] }}, {second}]");
    check_rejected("overlap", &format!("{HEAD}{agents}"), second, "agents 0 and 1 overlap by 0.20 m");

    let with_obstacle = |polygon: &str| format!("{HEAD}agents = [{second}]\n[[obstacles]]\npolygon_m = {polygon}\n");
    check_rejected(
        "inside",
        &with_obstacle("[[-1, -1], [1, -1], [1, 1], [-1, 1]]"),
        second,
        "agent 0 starts inside obstacle 0",
    );
    check_rejected(
        "grazing",
        &with_obstacle("[[-1, 0.15], [1, 0.15], [0, 1]]"),
        second,
        "agent 0 overlaps obstacle 0 by 0.05 m",
    );
    check_rejected(
        "goal",
        &with_obstacle("[[4, -1], [6, -1], [6, 2]]"),
        second,
        "a goal of agent 0 lies inside obstacle 0",
    );
    let broad = "{ at_m = [0, 0], goals_m = [[5, 0]], radius_m = 0.6, wall_radius_m = 0.6 }";
    check_rejected(
        "goal_beside",
        &format!("{HEAD}agents = [{broad}]\n[[obstacles]]\npolygon_m = [[5.05, -2], [6, -2], [6, 2], [5.05, 2]]\n"),
        broad,
        "agent 0 with a wall radius of 0.60 m cannot come within 0.5 m of its goal, which lies 0.05 m from obstacle 0",
    );
}

#[test]
fn obstacles_must_be_simple_polygons() {
    let check = |test: &str, polygon: &str, message: &str| {
        let obstacle = format!("{{ polygon_m = {polygon} }}");
        check_rejected(test, &format!("{HEAD}{ONE}obstacles = [{obstacle}]"), &obstacle, message);
    };
    check("two_corners", "[[8, 8], [9, 9]]", "obstacle 0 has 2 corners");
    check("bow_tie", "[[8, 8], [9, 9], [9, 8], [8, 9]]", "obstacle 0 crosses or touches itself");
    check("repeated", "[[8, 8], [9, 8], [9, 9], [8, 8]]", "obstacle 0 crosses or touches itself");
    check("sliver", "[[8, 8], [9, 8], [8.5, 8.00001]]", "obstacle 0 has no area");
}

#[test]
fn names_that_cannot_name_a_file_are_rejected() {
    for name in ["../up", "/tmp/away", "", "..", ".hidden", "a\\\\b", "line\\nbreak", &"long".repeat(60)] {
        let quoted = format!("\"{name}\"");
        check_rejected("name", &format!("name = {quoted}\n{HEAD}{ONE}"), &quoted, "cannot name a file");
    }
    assert_eq!(scenario("good_name", &format!("name = \"Straße 7.b\"\n{ONE}")).name, "Straße 7.b");
}

#[test]
fn messages_that_quote_long_text_stay_short() {
    let key = "k".repeat(1 << 20);
    let Err(ScenarioError::Invalid(invalid)) = read(&write("long_key", &format!("{HEAD}{key} = 1\n{ONE}"))) else {
        panic!("accepted")
    };
    assert!(invalid.message.len() < 2_000 && invalid.message.contains("unknown field"));
}

#[test]
fn a_crowd_in_a_line_is_checked_quickly() {
    for (columns, rows) in [(1, 16_000), (16_000, 1), (126, 127)] {
        let grid = format!("{{ columns = {columns}, rows = {rows}, spacing_m = 0.6 }}");
        let start = Instant::now();
        scenario("line", &format!("agents = {{ grid = {grid}, goal_offset_m = [1, 1] }}"));
        assert!(start.elapsed().as_secs_f64() < 0.5, "{columns} × {rows} took {:?}", start.elapsed());
    }
}

#[test]
fn huge_crowd_is_rejected_early() {
    let crowd = "[[agents]]\ngrid = { columns = 800, rows = 1000, spacing_m = 1 }\ngoal_offset_m = [1, 0]\n";
    check_rejected("crowds", &format!("{HEAD}{}", crowd.repeat(50)), "[[agents]]", "1600000 agents");
    let goals = "[1, 2], ".repeat(5_000);
    let table = format!("{{ grid = {{ columns = 800, rows = 1000, spacing_m = 1 }}, goals_m = [{goals}] }}");
    check_rejected("goals", &format!("{HEAD}agents = {table}"), &table, "4000000000 waypoints");
}

/// Fails unless an agent file is rejected at a line of it.
#[track_caller]
fn check_lines_rejected(test: &str, agents: &str, lines: &str, line: usize, message: &str) {
    let path = write(test, &format!("{HEAD}agents = {agents}"));
    fs::write(path.with_file_name("a.txt"), lines).unwrap();
    let Err(ScenarioError::Invalid(invalid)) = read(&path) else { panic!("accepted") };
    assert_eq!(invalid.path.file_name().unwrap(), "a.txt", "{invalid}");
    assert_eq!(invalid.line(), line, "{}", invalid.message);
    assert!(invalid.message.contains(message), "{}", invalid.message);
}

#[test]
fn an_agent_file_is_read_up_to_its_limit() {
    let file = "{ file = \"a.txt\" }";
    let crowd = format!("# crowd\n{}wrong", "0 0 1 1\n".repeat(1_000_001));
    check_lines_rejected("crowd_lines", file, &crowd, 1_000_002, "more than 1000000 agents");
    let two = format!("[{{ circle = {{ count = 999_999, radius_m = 9 }} }}, {file}]");
    check_lines_rejected("crowd_rest", &two, "0 0 1 1\n0 9 9 9\nwrong", 2, "more than 1000000 agents");
    let long = format!("0 0 1 1\n0 9 9 9 # {}\n", "é".repeat(1 << 20));
    check_lines_rejected("long_line", file, &long, 2, "longer than 4096 bytes");
    let comments = format!("0 0 1 1\n{}", format!("#{}\n", "x".repeat(4_000)).repeat(1_000));
    let many = format!("[{}]", [file; 20].join(", "));
    check_lines_rejected("many_lines", &many, &comments, 770, "longer than 64 MiB");
}

#[test]
fn a_file_of_zeros_is_no_agent_file() {
    let path = write("zeros", &format!("{HEAD}agents = {{ file = \"zeros.txt\" }}"));
    fs::File::create(path.with_file_name("zeros.txt")).unwrap().set_len(1 << 40).unwrap();
    let Err(ScenarioError::Invalid(invalid)) = read(&path) else { panic!("accepted") };
    check_points_at(&invalid, "\"zeros.txt\"", "line 1 holds a zero byte");
}

#[test]
fn missing_files_are_named() {
    check_rejected("no_clips", &format!("clips = \"gone\"\nduration_s = 1\n{ONE}"), "\"gone\"", "gone");
    check_rejected("no_motion", &format!("duration_s = 1\n{ONE}"), "", "neither `clips` nor `database`");
    check_rejected("both", &format!("{HEAD}database = \"x\"\n{ONE}"), "\"x\"", "both `clips` and `database`");
    check_rejected("no_lines", &format!("{HEAD}agents = {{ file = \"gone.txt\" }}"), "\"gone.txt\"", "does not exist");
    check_rejected("folder", &format!("{HEAD}agents = {{ file = \".\" }}"), "\".\"", "a folder, not a file");
    let error = read(Path::new("/nowhere/scene.toml")).unwrap_err();
    assert!(
        matches!(&error, ScenarioError::Unreadable { .. }) && error.to_string().starts_with("/nowhere/scene.toml: "),
        "{error}"
    );
}

#[test]
fn the_bundled_scenarios_are_valid() {
    let scenarios = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../assets/scenarios");
    let mut agents = BTreeMap::new();
    for folder in [scenarios.clone(), scenarios.join("rimea")] {
        let files = fs::read_dir(folder).unwrap().map(|entry| entry.unwrap().path());
        for path in files.filter(|path| path.extension().is_some_and(|ending| ending == "toml")) {
            let (scenario, motion) = read(&path).unwrap();
            assert_eq!(scenario.name, path.file_stem().unwrap().to_str().unwrap());
            assert!(matches!(motion, Ok(MotionSource::Clips(_))), "{}", path.display());
            agents.insert(scenario.name.clone(), scenario.agents.len());
        }
    }
    assert!(agents.len() >= 20, "{agents:?}");
    let scenes = ["shibuya", "shibuya_large", "tradeshow", "tradeshow_large", "mall", "mall_large", "obstacle_course"];
    assert_eq!(scenes.map(|name| agents[name]), [32, 320, 50, 500, 15, 200, 1]);
    let others = ["antipodal", "crossing", "bottleneck", "counterflow", "two_exits"];
    assert_eq!(others.map(|name| agents[name]), [17, 30, 72, 180, 0]);
}

/// Keys that every source needs beside its position.
const SOURCE: &str = "rate_per_s = 0.5\ngoals_m = [[9, 9]]\n";

#[test]
fn a_source_has_the_keys_and_defaults_of_agents() {
    let keys = "rect_m = [-2, -1, 2, 1]\nto_s = 4\nfrom_s = 1\ncount = 3\nat_goal = 'leave'\nradius_m = 0.15";
    let body = format!("[[sources]]\nat_m = [1, 2]\n{SOURCE}[[sources]]\n{keys}\n{SOURCE}goal_offset_m = [1, 0]\n");
    let sources = scenario("sources", &body).sources;
    let at_m = Vec2::new(1.0, 2.0);
    assert_eq!([sources[0].low_m, sources[0].high_m], [at_m; 2]);
    assert_eq!((sources[0].from_s, sources[0].to_s, sources[0].count), (0.0, 10.0, None));
    assert_eq!((sources[0].radius_m, sources[0].wall_radius_m, sources[0].at_goal), (0.25, 0.2, AtGoal::Stay));
    assert_eq!((sources[1].from_s, sources[1].to_s, sources[1].count), (1.0, 4.0, Some(3)));
    assert_eq!((sources[1].wall_radius_m, sources[1].at_goal), (0.15, AtGoal::Leave));
    let agent = sources[1].agent(at_m);
    assert_eq!(agent.goals_m, [Vec2::new(9.0, 9.0), Vec2::new(2.0, 2.0)]);
    assert_eq!(agent.facing_rad, libm::atan2f(7.0, 8.0));
}

#[test]
fn broken_sources_are_shown_at_their_table() {
    let check = |test: &str, keys: &str, message: &str| {
        let table = format!("[[sources]]\n{keys}");
        let text = format!("{HEAD}{ONE}{table}\n[[obstacles]]\npolygon_m = {BLOCK}\n");
        match read(&write(test, &text)) {
            Err(ScenarioError::Invalid(invalid)) => {
                assert!(invalid.message.contains(message), "{invalid}");
                assert_eq!(invalid.line(), 4, "{invalid}");
            }
            other => panic!("{keys} gave {other:?}"),
        }
    };
    let at = "at_m = [1, 3]";
    for rate in ["inf", "nan", "-1.0", "0.0", "1e9"] {
        check("rate", &format!("{at}\nrate_per_s = {rate}\ngoals_m = [[9, 9]]"), "rate_per_s is");
    }
    check("two_areas", &format!("{at}\nrect_m = [0, 0, 1, 1]\n{SOURCE}"), "exactly one of `at_m` and `rect_m`");
    check("no_area", SOURCE, "exactly one of `at_m` and `rect_m`");
    check("turned_rect", &format!("rect_m = [1, 0, 0, 1]\n{SOURCE}"), "rect_m has no inside");
    check("no_goal", &format!("{at}\nrate_per_s = 1.0"), "need a goal");
    check("never", &format!("{at}\nfrom_s = 5\nto_s = 4\n{SOURCE}"), "to_s is 4, not between 5");
    check("nobody", &format!("{at}\ncount = 0\n{SOURCE}"), "count is 0");
    check("broad", &format!("{at}\nradius_m = 3\n{SOURCE}"), "radius_m is 3");
    check("inside", &format!("at_m = [21, 21]\n{SOURCE}"), "source 0 has no free ground");
    check("beside", &format!("rect_m = [19.9, 20.5, 19.95, 21]\n{SOURCE}"), "source 0 has no free ground");
    check("walled", &format!("{at}\nrate_per_s = 1.0\ngoals_m = [[21, 21]]"), "a goal of source 0 lies inside");
    let offset = "rect_m = [0, 5, 1, 6]\nrate_per_s = 1.0\ngoal_offset_m = [20.5, 15.5]";
    check("offset", offset, "a goal of source 0 lies inside");
    let broad = "radius_m = 1.0\nwall_radius_m = 1.0\nrate_per_s = 1.0\ngoals_m = [[19.9, 21]]";
    check("too_near", &format!("{at}\n{broad}"), "cannot come within 0.5 m of their goal");
}

#[test]
fn unknown_keys_of_sources_are_rejected() {
    let text = format!("{HEAD}[[sources]]\nat_m = [0, 0]\nrate_per_min = 3\n");
    check_rejected("rate_key", &text, "rate_per_min", "rate_per_min");
    let text = format!("{HEAD}[[sources]]\nat_m = [0, 0]\nat_goal = \"vanish\"\n{SOURCE}");
    check_rejected("at_goal", &text, "\"vanish\"", "vanish");
}

#[test]
fn sources_give_no_more_agents_than_a_scenario_may_have() {
    let begun = Instant::now();
    let long = "clips = \".\"\nduration_s = 86400\n";
    let source = |rate: f32| format!("[[sources]]\nat_m = [1, 3]\nrate_per_s = {rate}\ngoals_m = [[9, 9]]\n");
    let check = |test: &str, text: &str, message: &str| match read(&write(test, text)) {
        Err(ScenarioError::Invalid(invalid)) => assert!(invalid.message.contains(message), "{invalid}"),
        other => panic!("{:?}", other.map(|(scenario, _)| scenario.sources)),
    };
    check("flood", &format!("{long}{}", source(1_000.0)), "more than 1000000 agents");
    check("streams", &format!("{long}{}", source(2.0).repeat(12)), "more than 1000000 agents");
    check("too_many", &format!("{long}{}", source(0.0001).repeat(1_001)), "the number of sources is 1001");
    assert!(read(&write("enough", &format!("{long}{}", source(2.0).repeat(5)))).is_ok());
    assert!(begun.elapsed().as_secs() < 10);
}

#[test]
fn walkable_ground_is_read_from_tables_and_wkt() {
    let ground =
        "[[walkable]]\npolygon_m = [[-2, -2], [9, -2], [9, 2], [-2, 2]]\nholes_m = [[[2, -1], [3, -1], [3, 1]]]\n";
    let enclosure = "[[obstacles]]\nkind = \"enclosure\"\npolygon_m = [[7, 1], [8, 1], [8, 1.5]]\n";
    let inline = scenario("ground", &format!("{ONE}{ground}{enclosure}"));
    assert_eq!((inline.walkable_m.len(), inline.obstacles_m.len(), inline.enclosures_m.len()), (1, 0, 1));
    let path = write("wkt", &format!("{HEAD}{ONE}[[walkable]]\nfile = \"a.wkt\"\n"));
    let wkt = "POLYGON ((-2 -2, 9 -2, 9 2, -2 2, -2 -2), (2 -1, 3 -1, 3 1, 2 -1))";
    fs::write(path.with_file_name("a.wkt"), wkt).unwrap();
    assert_eq!(read(&path).unwrap().0.walkable_m, inline.walkable_m);
}

#[test]
fn mistakes_of_the_ground_are_shown_at_their_table() {
    let walkable = |polygon: &str| format!("{HEAD}{ONE}[[walkable]]\npolygon_m = {polygon}\n");
    let part = "[[walkable]]";
    check_rejected("bow", &walkable("[[-9, -9], [9, 9], [9, -9], [-9, 9]]"), part, "crosses or touches itself");
    check_rejected("far", &walkable("[[-9, -9], [1e9, -9], [9, 9]]"), part, "not within 10 km");
    check_rejected("short", &walkable("[[-9, -9], [9, 9]]"), part, "has 2 corners");
    check_rejected("empty", &format!("{HEAD}{ONE}[[walkable]]\nholes_m = []\n"), part, "either `polygon_m` or `file`");
    let file = format!("{HEAD}{ONE}[[walkable]]\nfile = \"none.wkt\"\n");
    check_rejected("none", &file, "\"none.wkt\"", "cannot be read");
}

#[test]
fn goals_without_a_route_are_errors_at_their_agents() {
    let agents = "{ at_m = [0, 0], goals_m = [[5, 0]] }";
    let scene = |walls: &str| format!("{HEAD}agents = [{agents}]\n{walls}");
    let around = "[[obstacles]]\nkind = \"enclosure\"\npolygon_m = [[4, -2], [7, -2], [7, 2], [4, 2]]\n";
    check_rejected("unreachable", &scene(around), agents, "no route leads agent 0 to the goal [5, 0]");
    let small = "[[walkable]]\npolygon_m = [[-1, -1], [3, -1], [3, 1], [-1, 1]]\n";
    check_rejected("off", &scene(small), agents, "lies inside a wall or off the walkable ground");
    let beside = "[[walkable]]\npolygon_m = [[1, -1], [9, -1], [9, 1], [1, 1]]\n";
    check_rejected("start", &scene(beside), agents, "agent 0 starts at [0, 0], in a wall or off the walkable ground");
}

#[test]
fn wrong_groups_are_shown_at_their_table() {
    let agents = |keys: &str| {
        format!("{HEAD}agents = {{ grid = {{ columns = 2, rows = 2, spacing_m = 1 }}, goals_m = [[9, 9]], {keys} }}\n")
    };
    let cases = [
        ("groups = { 0 = 1 }", "`0` in `groups` is no size of a group"),
        ("groups = { 5 = 1 }", "`5` in `groups` is no size of a group"),
        ("groups = { pairs = 1 }", "`pairs` in `groups` is no size of a group"),
        ("groups = { 1 = 0, 2 = 0 }", "the sum of the shares in `groups` is 0"),
        ("groups = { 1 = -1, 2 = 3 }", "a share in `groups` is -1"),
        ("groups = { 2 = nan }", "the sum of the shares in `groups` is NaN"),
        ("groups = { 2 = inf }", "the sum of the shares in `groups` is inf"),
        ("groups = { 2 = 1 }, group_spacing_m = 0.1", "group_spacing_m is 0.1"),
        ("group_spacing_m = 1", "`group_spacing_m` needs `groups`"),
    ];
    for (keys, message) in cases {
        match read(&write("groups", &agents(keys))) {
            Err(ScenarioError::Invalid(invalid)) => assert!(invalid.message.contains(message), "{keys}: {invalid}"),
            other => panic!("{keys} gave {other:?}"),
        }
        let source = format!("{HEAD}[[sources]]\nat_m = [0, 0]\nrate_per_s = 1\ngoals_m = [[9, 9]]\n");
        let text = source + &keys.replace("}, group", "}\ngroup") + "\n";
        match read(&write("groups", &text)) {
            Err(ScenarioError::Invalid(invalid)) => assert!(invalid.message.contains(message), "{keys}: {invalid}"),
            other => panic!("{text} gave {other:?}"),
        }
    }
}

#[test]
fn wrong_events_are_shown_at_their_line() {
    const STATE: &str = "[states.sit]\nstand = {}\n[signals.door]\ngreen_s = 1\nred_s = 1\n";
    let cases = [
        ("when = { reached_m = 1 }\nto = \"sit\"", "`when` of event `alarm` speaks of one agent"),
        ("when = { not = { inside = \"hall\" } }\nto = \"sit\"", "there is no area `hall`"),
        ("when = { after_s = 1 }", "event `alarm` changes nothing"),
        ("when = { after_s = -1 }\nto = \"sit\"", "after_s"),
        ("when = { after_s = 1 }\nto = \"flee\"", "there is no state `flee`"),
        ("when = { after_s = 1 }\nto = \"sit\"\nfrom = [\"run\"]", "there is no state `run`"),
        ("when = { after_s = 1 }\nsignals = { gate = \"red\" }", "there is no signal `gate`"),
        ("when = { after_s = 1 }\nsignals = { door = \"blue\" }", "unknown value `blue`"),
        ("to = \"sit\"", "the key `when` is missing"),
    ];
    for (keys, message) in cases {
        match read(&write("events", &format!("{HEAD}{ONE}{STATE}[events.alarm]\n{keys}\n"))) {
            Err(ScenarioError::Invalid(invalid)) => assert!(invalid.message.contains(message), "{keys}: {invalid}"),
            other => panic!("{keys} gave {other:?}"),
        }
    }
}

//! Claims about the keys at the top of a scenario file, its planner and motion, and events; and about whole files.

use std::collections::BTreeMap;
use std::fs;
use std::path::Path;

use fbcrowd_sim::planning::Planner;
use fbcrowd_sim::planning::mcn::StanceForm;
use fbcrowd_sim::scenario::{Coupling, MotionSource, ScenarioError, read};
use fbcrowd_sim::synthesis::{Modes, Transition};

use crate::support::{HEAD, ONE, check_rejected, scenario, write};

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
fn files_without_agents_state_what_is_missing() {
    let error = |test: &str, text: &str| match read(&write(test, text)) {
        Err(ScenarioError::Invalid(invalid)) => format!("{}; {}", invalid.message, invalid.help),
        other => panic!("{other:?}"),
    };
    let none = error("no_agents", "duration_s = 5\n");
    assert!(none.contains("the key `agents` is missing") && none.contains("[[sources]]"), "{none}");
    assert!(error("empty", " \n").contains("the file is empty"));
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
        check_rejected("picture", &format!("{HEAD}{ONE}[view]\n{view}"), view, "not between");
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

//! Zones of scenario files that are closed to some agents; every mistake is shown at its position in the text.

mod common;

use std::fs;

use common::folder;
use fbcrowd_sim::scenario::{Scenario, ScenarioError, StateZones, read};

const HEAD: &str = "clips = \".\"\nduration_s = 10\n[profiles.staff]\n[profiles.visitor]\npreferred_speed_mps = 1.2\n";
const STAFF: &str = "{ at_m = [2, 0], goals_m = [[9, 0]], profile = \"staff\" }";

fn scenario(test: &str, agents: &str, zones: &str) -> Result<Scenario, ScenarioError> {
    let path = folder(test).join("scene.toml");
    fs::write(&path, format!("zones = [{zones}]\nagents = [{agents}]\n{HEAD}")).unwrap();
    Ok(read(&path)?.0)
}

fn zone(keys: &str) -> String {
    format!("{{ rect_m = [1, -1, 3, 1]{keys} }}")
}

/// Checks that reading fails, at exactly this part of the text, with a message that contains these words.
fn check_rejected(test: &str, agents: &str, zones: &str, part: &str, message: &str) {
    match scenario(test, agents, zones) {
        Err(ScenarioError::Invalid(invalid)) => {
            assert!(invalid.message.contains(message), "{invalid}");
            assert_eq!(&invalid.text[invalid.span.clone()], part, "{invalid}");
        }
        other => panic!("{zones} gave {other:?}"),
    }
}

#[test]
fn agents_know_the_zones_that_are_closed_to_their_profile() {
    let zones = [zone(", speed_factor = 0.5"), zone(", closed_to = [\"visitor\"]"), zone(", closed_to = [\"staff\"]")];
    let visitor = "{ at_m = [-9, 0], goals_m = [[9, 0]], profile = \"visitor\" }";
    let any = "{ at_m = [-9, 2], goals_m = [[9, 0]] }";
    let agents = format!("{visitor}, {any}, {}", STAFF.replace("2, 0", "-9, 4"));
    let scenario = scenario("masks", &agents, &zones.join(", ")).unwrap();
    let closed: Vec<u32> = scenario.agents.iter().map(|agent| agent.closed_zones).collect();
    assert_eq!(closed, [1, 0, 2]);
    assert_eq!(scenario.zones[1].speed_factor, 1.0);
    assert_eq!(scenario.zone_walls(&[]).sets.len(), 2);
}

#[test]
fn mistakes_of_closed_zones_are_shown_at_their_place() {
    let agent = "{ at_m = [-9, 0], goals_m = [[9, 0]] }";
    let check = |test: &str, keys: &str, part: &str, message: &str| {
        check_rejected(test, agent, &zone(keys), part, message);
    };
    check("neither", "", &zone(""), "a zone needs `speed_factor`, `one_way_deg`, `closed_to` or `closed_in`");
    check("all", ", closed_to = \"all\"", "\"all\"", "a zone that is closed to all agents is an obstacle");
    check("word", ", closed_to = \"staff\"", "\"staff\"", "`closed_to` is `staff`, not a list");
    check("unknown", ", closed_to = [\"stuff\"]", "[\"stuff\"]", "there is no profile `stuff`");
    check("empty", ", closed_to = []", "[]", "names no profile");
    let closed = zone(", closed_to = [\"staff\"]");
    check_rejected("start", STAFF, &closed, STAFF, "agent 0 starts in zone 0, which is closed to it");
    let goal = "{ at_m = [-9, 0], goals_m = [[2, 0]], profile = \"staff\" }";
    check_rejected("goal", goal, &closed, goal, "of agent 0 lies in zone 0");
}

#[test]
fn mistakes_of_one_way_zones_are_shown_at_their_place() {
    let agent = "{ at_m = [-9, 0], goals_m = [[9, 0]] }";
    let check = |test: &str, zone: &str, message: &str| check_rejected(test, agent, zone, zone, message);
    check("slanted", &zone(", one_way_deg = 45"), "two sides along `one_way_deg`; 45° is along none");
    check("circle", "{ circle_m = [2, 0, 1], one_way_deg = 0 }", "a one-way zone is a rectangle");
    check("turn", &zone(", one_way_deg = 1e9"), "one_way_deg is 1000000000");
    let zones = [zone(", one_way_deg = 0"), "{ rect_m = [2, -1, 4, 1], one_way_deg = 0 }".to_owned()];
    check_rejected("overlap", agent, &zones.join(", "), &zones[1], "the one-way zones 0 and 1 overlap");
}

#[test]
fn one_way_zones_are_read() {
    let agent = "{ at_m = [-9, 0], goals_m = [[9, 0]] }";
    let zones =
        [zone(", one_way_deg = -90, speed_factor = 0.5"), "{ rect_m = [3, -1, 5, 1], one_way_deg = 0 }".to_owned()];
    let scenario = scenario("read_one_way", agent, &zones.join(", ")).unwrap();
    assert_eq!((scenario.zones[0].one_way_deg, scenario.zones[0].speed_factor), (Some(-90.0), 0.5));
    assert_eq!(scenario.one_way_zones()[0].heading.to_array().map(f32::round), [0.0, -1.0]);
    assert!(!scenario.is_open());
}

const STATES: &str = "states = { in = { walk_mps = [1, 0], then = [{ when = { after_s = 3 }, to = \"out\" }] }, \
     out = { walk_mps = [-1, 0] } }\n";

#[test]
fn states_close_zones() {
    let agents = "{ at_m = [-9, 0], state = \"in\", profile = \"staff\" }, { at_m = [-9, 3], goals_m = [[-9, 4]] }";
    let zones = [zone(", closed_to = [\"staff\"]"), zone(", closed_in = [\"out\", \"in\"]")];
    let path = folder("closed_in").join("scene.toml");
    fs::write(&path, format!("zones = [{}]\nagents = [{agents}]\n{STATES}{HEAD}", zones.join(", "))).unwrap();
    let (scenario, _) = read(&path).unwrap();
    assert_eq!(scenario.zones[1].closed_in, [2, 1]);
    let zones = StateZones::new(&scenario);
    assert_eq!([0, 1, 2].map(|state| zones.for_routes(1, state)), [1, 3, 3]);
    let sets: Vec<u32> = scenario.zone_walls(&[]).sets.iter().map(|(set, _)| *set).collect();
    assert_eq!(sets, [1, 2, 3]);
}

#[test]
fn mistakes_of_zones_that_states_close_are_shown_at_their_place() {
    let check = |test: &str, states: &str, keys: &str, part: &str, message: &str| {
        let path = folder(test).join("scene.toml");
        let agent = "{ at_m = [-9, 0], goals_m = [[-9, 4]] }";
        fs::write(&path, format!("zones = [{}]\nagents = [{agent}]\n{states}{HEAD}", zone(keys))).unwrap();
        match read(&path) {
            Err(ScenarioError::Invalid(invalid)) => {
                assert!(invalid.message.contains(message), "{invalid}");
                assert_eq!(&invalid.text[invalid.span.clone()], part, "{invalid}");
            }
            other => panic!("{keys} gave {other:?}"),
        }
    };
    check("in_none", STATES, ", closed_in = []", "[]", "`closed_in` names no state");
    check("in_unknown", STATES, ", closed_in = [\"inn\"]", "\"inn\"", "there is no state `inn`");
    check("in_stateless", "", ", closed_in = [\"in\"]", "[\"in\"]", "the scenario has no states");
}

#[test]
fn goals_against_a_one_way_zone_are_shown_at_their_place() {
    let path = folder("against").join("scene.toml");
    let text = "clips = \".\"\nduration_s = 10\n[[walkable]]\npolygon_m = [[0, 0], [20, 0], [20, 4], [0, 4]]\n\
        [[zones]]\nrect_m = [8, 0, 12, 4]\none_way_deg = 180\n[goals.end]\nareas = [{ point_m = [18, 2] }]\n\
        [states.go]\ngo = \"end\"\n[[agents]]\nat_m = [2, 2]\n";
    let check = |agent: &str, line: &str, message: &str| {
        fs::write(&path, format!("{text}{agent}\n")).unwrap();
        match read(&path) {
            Err(ScenarioError::Invalid(invalid)) => {
                assert!(invalid.message.contains(message), "{invalid}");
                assert!(invalid.to_string().contains(line), "{invalid}");
            }
            other => panic!("{agent} gave {other:?}"),
        }
    };
    check(
        "goals_m = [[18, 2]]",
        ":12:",
        "agent 0 reaches the goal [18, 2] only against the direction of the one-way zone 0",
    );
    check("state = \"go\"", ":8:", "reach the area of goals `end` at [18, 2] only against the one-way zone 0");
}

#[test]
fn goals_behind_all_starts_in_a_zone_are_shown_at_their_place() {
    let path = folder("behind").join("scene.toml");
    let check = |side: u32, goal: &str, starts_m: &[u32], is_reached: bool| {
        let agents = starts_m.iter().map(|x| format!("[[agents]]\nat_m = [{x}, 2]\nstate = \"go\"\n"));
        let text = format!(
            "clips = \".\"\nduration_s = 10\n[[walkable]]\npolygon_m = [[0, 0], [20, 0], [20, {side}], [0, {side}]]\n\
             [[zones]]\nrect_m = [4, 0, 16, 4]\none_way_deg = 0\n[goals.end]\nareas = [{{ {goal} }}]\n\
             [states.go]\ngo = \"end\"\n{}",
            agents.collect::<String>()
        );
        fs::write(&path, text).unwrap();
        match read(&path) {
            Ok(_) => assert!(is_reached, "{goal} {starts_m:?}"),
            Err(error) => {
                let message = error.to_string();
                assert!(!is_reached && message.contains(":8:"), "{message}");
                assert!(message.contains("reach the area of goals `end`"), "{message}");
                assert!(message.contains("only against the one-way zone 0"), "{message}");
            }
        }
    };
    check(4, "point_m = [8, 2]", &[12], false);
    check(4, "circle_m = [8, 2, 1]", &[14, 12, 13], false);
    // Ahead of one start, reached in part, at arm's length, or around the zone.
    check(4, "point_m = [8, 2]", &[12, 6], true);
    check(4, "point_m = [8, 2]", &[12, 2], true);
    check(4, "rect_m = [6, 1, 13, 3]", &[12], true);
    check(4, "point_m = [11.6, 2]", &[12], true);
    check(9, "point_m = [8, 2]", &[12], true);
}

#[test]
fn goals_that_zones_close_to_agents_are_named() {
    let path = folder("barred").join("scene.toml");
    let barred = |zones: &str, goal: &str| {
        let text =
            "[states.go]\ngo = \"end\"\n[states.rest]\ngo = \"home\"\n[goals.home]\nareas = [{ point_m = [-9, 0] }]\n";
        let agents = "[[agents]]\nat_m = [-9, 0]\nstate = \"go\"\nprofile = \"staff\"\n[[agents]]\nat_m = [-9, 2]\nstate = \"go\"\n";
        let goals = format!("[goals.end]\nareas = [{goal}]\n");
        fs::write(&path, format!("zones = [{zones}]\n{HEAD}{text}{goals}{agents}")).unwrap();
        read(&path).unwrap().0.barred_goals().iter().map(ToString::to_string).collect::<Vec<_>>()
    };
    let inside = "{ rect_m = [1.5, -0.5, 2.5, 0.5] }";
    let expected = ["agents in state `go` wait: to some, all areas of goals `end` are closed by zone 0"];
    assert_eq!(barred(&zone(", closed_to = [\"staff\"]"), inside), expected);
    assert_eq!(barred(&zone(", closed_in = [\"go\"]"), inside), expected);
    assert!(barred(&zone(", closed_in = [\"rest\"]"), inside).is_empty());
    assert!(barred(&zone(", closed_to = [\"staff\"]"), &format!("{inside}, {{ point_m = [5, 0] }}")).is_empty());
}

#[test]
fn only_agents_that_can_enter_a_state_miss_its_goals() {
    let path = folder("barred_reach").join("scene.toml");
    let barred = |rest: &str| {
        let states = "[goals.staff]\nareas = [{ rect_m = [1.5, -0.5, 2.5, 0.5] }]\n[goals.home]\nareas = [{ point_m = [-9, 0] }]\n\
             [states.learn]\ngo = \"home\"\n[states.teach]\ngo = \"home\"\nthen = [{ when = { after_s = 5 }, to = \"rest\" }]\n\
             [states.rest]\ngo = \"staff\"\n";
        let agents = "[[agents]]\nat_m = [-9, 0]\nstate = \"teach\"\n[[agents]]\nat_m = [-9, 2]\nstate = \"learn\"\nprofile = \"staff\"\n";
        let zones = zone(", closed_to = [\"staff\"]");
        fs::write(&path, format!("zones = [{zones}]\n{HEAD}{states}{rest}{agents}")).unwrap();
        read(&path).unwrap().0.barred_goals().len()
    };
    assert_eq!(barred(""), 0);
    // An event moves all agents, also the pupil to whom the zone is closed.
    assert_eq!(barred("[events.bell]\nwhen = { after_s = 5 }\nto = \"rest\"\n"), 1);
}

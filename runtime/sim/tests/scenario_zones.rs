//! Zones of scenario files that are closed to some agents; every mistake is shown at its position in the text.

mod common;

use std::fs;

use common::folder;
use fbcrowd_sim::scenario::{Scenario, ScenarioError, read};

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
    check("neither", "", &zone(""), "a zone needs `speed_factor`, `closed_to` or both");
    check("all", ", closed_to = \"all\"", "\"all\"", "a zone that is closed to all agents is an obstacle");
    check("word", ", closed_to = \"staff\"", "\"staff\"", "`closed_to` is `staff`, not a list");
    check("unknown", ", closed_to = [\"stuff\"]", "[\"stuff\"]", "there is no profile `stuff`");
    check("empty", ", closed_to = []", "[]", "names no profile");
    let closed = zone(", closed_to = [\"staff\"]");
    check_rejected("start", STAFF, &closed, STAFF, "agent 0 starts in zone 0, which is closed to it");
    let goal = "{ at_m = [-9, 0], goals_m = [[2, 0]], profile = \"staff\" }";
    check_rejected("goal", goal, &closed, goal, "a goal of agent 0 lies in zone 0");
}

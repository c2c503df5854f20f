//! Doors of scenario files; every mistake is shown at its position in the text.

mod common;

use std::fs;
use std::path::PathBuf;

use common::folder;
use fbcrowd_sim::scenario::{Scenario, ScenarioError, read};
use glam::Vec2;

const HEAD: &str = "clips = \".\"\nduration_s = 10\n[signals.gate]\ngreen_s = 5\nred_s = 5\noffset_s = 2\n";
const DOOR: &str = "{ polygon_m = [[2, -1], [2, 1], [2.2, 1], [2.2, -1]], open = \"gate\" }";

fn write(test: &str, agents: &str, obstacles: &str) -> PathBuf {
    let path = folder(test).join("scene.toml");
    fs::write(&path, format!("obstacles = [{obstacles}]\nagents = {agents}\n{HEAD}")).unwrap();
    path
}

fn agent(at_m: &str, goal_m: &str) -> String {
    format!("{{ at_m = {at_m}, goals_m = [{goal_m}] }}")
}

fn scenario(test: &str, agents: &str, obstacles: &str) -> Scenario {
    read(&write(test, agents, obstacles)).unwrap().0
}

/// Checks that reading fails, at exactly this part of the text, with a message that contains these words.
fn check_rejected(test: &str, agents: &str, obstacles: &str, part: &str, message: &str) {
    match read(&write(test, agents, obstacles)) {
        Err(ScenarioError::Invalid(invalid)) => {
            assert!(invalid.message.contains(message), "{invalid}");
            assert_eq!(&invalid.text[invalid.span.clone()], part, "{invalid}");
        }
        other => panic!("{agents} {obstacles} gave {other:?}"),
    }
}

#[test]
fn a_door_is_an_obstacle_with_a_signal() {
    let solid = "{ polygon_m = [[2, 1], [2.2, 1], [2.2, 9], [2, 9]] }";
    let scenario = scenario("door", &agent("[0, 0]", "[5, 0]"), &format!("{DOOR}, {solid}"));
    assert_eq!((scenario.obstacles_m.len(), scenario.doors.len()), (1, 1));
    // The corners run counter-clockwise.
    assert_eq!(scenario.doors[0].polygon_m[0], Vec2::new(2.2, -1.0));
    assert_eq!(scenario.doors_closed_at_start(), [true]);
    let middle_m = Vec2::new(2.1, 0.0);
    assert!(!scenario.walls().contains(middle_m) && scenario.walls_with(&[true]).contains(middle_m));
}

#[test]
fn doors_without_sense_are_shown_at_their_signal() {
    let one = agent("[0, 0]", "[5, 0]");
    check_rejected("unknown", &one, &DOOR.replace("gate", "gat"), "\"gat\"", "no signal `gat`; there are `gate`");
    let enclosure = DOOR.replace(" }", ", kind = \"enclosure\" }");
    check_rejected("enclosure", &one, &enclosure, "\"gate\"", "an enclosure cannot open");
    let crossed = "{ polygon_m = [[2, 2], [3, 3], [3, 2], [2, 3]], open = \"gate\" }";
    check_rejected("crossed", &one, crossed, crossed, "the door crosses or touches itself");
}

#[test]
fn starts_and_goals_in_doors_are_shown_at_their_agents() {
    let inside = agent("[2.1, 0.3]", "[5, 0]");
    check_rejected("start", &inside, DOOR, &inside, "agent 0 starts in a door that is closed at 0 s");
    let beside = agent("[1.9, 0.3]", "[5, 0]");
    check_rejected("beside", &beside, DOOR, &beside, "agent 0 starts in a door");
    let into = agent("[0, 0]", "[2.1, 0]");
    check_rejected("goal", &into, DOOR, &into, "of agent 0 lies in the door of signal `gate`");
    let second = "{ polygon_m = [[7, 0], [8, 0], [8, 1]], open = \"other\" }";
    let path = write("open", &agent("[7.8, 0.2]", "[5, 0]"), second);
    let text = fs::read_to_string(&path).unwrap() + "[signals.other]\ngreen_s = 5\nred_s = 5\n";
    fs::write(&path, text).unwrap();
    // Its signal is green at 0 s.
    assert!(read(&path).is_ok());
}

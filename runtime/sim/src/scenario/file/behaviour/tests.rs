//! Claims about the tables of behaviour.

use std::collections::BTreeMap;
use std::path::PathBuf;

use glam::Vec2;
use serde::Deserialize;

use super::*;
use crate::behaviour::{Area, Choice, Condition, Distribution, Target};
use crate::scenario::file::behaviour::{AreaTable, GoalsTable, SignalTable};

/// The tables of behaviour alone.
#[derive(Deserialize)]
#[serde(deny_unknown_fields, default)]
#[derive(Default)]
struct File {
    signals: BTreeMap<String, Spanned<SignalTable>>,
    areas: BTreeMap<String, Spanned<AreaTable>>,
    goals: BTreeMap<String, Spanned<GoalsTable>>,
    states: BTreeMap<String, Spanned<StateTable>>,
}

fn resolved(text: &str) -> Result<Behaviour, String> {
    let source = SourceText { path: PathBuf::from("x.toml"), text: text.to_owned() };
    let file: File = toml::from_str(text).map_err(|error| error.to_string())?;
    let File { signals, areas, goals, states } = file;
    let events = BTreeMap::new();
    BehaviourTables { signals, areas, goals, states, events }.resolve(&source).map_err(|error| error.to_string())
}

fn check_refused(text: &str, line: usize, part: &str) {
    let message = resolved(text).expect_err(text);
    assert!(message.contains(part) && message.contains(&format!("{line}")), "{message}");
}

const VISIT: &str = "
    [signals.light]
    green_s = 4
    red_s = 6
    [areas.hall]
    rect_m = [9, 9, 0, 0]
    [goals.booths]
    choose = { nearest_of = 3 }
    capacity = 2
    copies_m = [[0, 0], [5, 1]]
    areas = [{ rect_m = [0, 0, 1, 1], facing_deg = 90 }, { circle_m = [0, 3, 0.5], weight = 3, capacity = 1 }]
    [goals.till]
    queue = true
    areas = [{ point_m = [1, 2] }]
    [states.walk]
    go = 'booths'
    remember = true
    set = { speed_factor = { uniform = [0.9, 1.1] } }
    then = [
        { when = { reached_m = 0.2, inside = 'hall' }, to = 'look' },
        { when = { any = [{ after_s = 60 }, { not = { green = 'light' } }] }, to = { walk = 3, gone = 1 } },
    ]
    [states.look]
    stand = { facing = 'goal' }
    then = [{ when = { after_s = { normal = [5, 2], min = 1 }, number = { inside = 'hall', at_most = 4 } }, to = 'back' }]
    [states.pay]
    go = 'till'
    then = [{ when = { served_s = 3, population = { state = 'gone', at_least = 2 } }, to = 'gone' }]
    [states.gone]
    remove = true
";

#[test]
fn names_become_indices() {
    let behaviour = resolved(VISIT).unwrap();
    let names: Vec<&str> = behaviour.states.iter().map(|state| state.name.as_str()).collect();
    assert_eq!(names, ["follow_path", "gone", "look", "pay", "walk"]);
    let walk = &behaviour.states[4];
    assert_eq!(walk.movement, Movement::Goals { set: 0, choice: Choice::NearestOf(3), memory: Some(4) });
    assert_eq!(walk.transitions[0].condition, Condition::All(vec![Condition::Reached(0.2), Condition::Inside(0)]));
    assert_eq!(walk.transitions[1].target, Target::States(vec![(1, 1.0), (4, 3.0)]));
    let Condition::All(parts) = &behaviour.states[2].transitions[0].condition else { panic!() };
    assert_eq!(parts[0], Condition::After(Distribution::Normal { mean: 5.0, deviation: 2.0, min: 1.0, max: 11.0 }));
    assert_eq!(behaviour.states[2].transitions[0].target, Target::Back);
    assert_eq!(behaviour.goals[0].areas.len(), 4);
    assert_eq!(behaviour.goals[0].areas[3].area, Area::Disc { centre_m: Vec2::new(5.0, 4.0), radius_m: 0.5 });
    assert_eq!([0, 1].map(|area| behaviour.goals[0].capacity(area)), [2, 1]);
    assert!(behaviour.areas[0].holds(Vec2::splat(4.0)));
}

#[test]
fn mistakes_are_shown_at_their_line() {
    check_refused("[states.a]\ngo = 'nowhere'", 2, "there is no goals `nowhere`, and none at all");
    check_refused("[states.a]\nstand = {}\nthen = [{ to = 'b' }]", 3, "there is no state `b`; there are `a`");
    check_refused("[states.a]\nstand = {}\nwalk_mps = [1, 0]", 1, "exactly one of `go`");
    check_refused("[states.a]\nstand = {}\nthen = [{ to = 'a' }]", 1, "without end");
    check_refused("[goals.g]\nareas = []", 1, "have no areas");
    check_refused("[goals.g]\nareas = [{ point_m = [0, 0], rect_m = [0, 0, 1, 1] }]", 2, "exactly one of `point_m`");
    check_refused("[goals.g]\nareas = [{ polygon_m = [[0, 0], [1, 1], [1, 0], [0, 1]] }]", 2, "crosses");
    check_refused("[goals.g]\nareas = [{ point_m = [0, 0], weight = -1 }]", 2, "the weight of the area is -1");
    check_refused("[goals.g]\ncapacity = 0\nareas = [{ point_m = [0, 0] }]", 2, "the capacity of goals `g` is 0");
    check_refused("[goals.g]\nareas = [{ point_m = [0, 0], capacity = 0 }]", 2, "the capacity of the area is 0");
    check_refused("[signals.s]\ngreen_s = 0\nred_s = 0", 1, "green for 0 s");
    check_refused(
        "[states.a]\nstand = {}\nthen = [{ when = { after_s = { uniform = [3, 1] } }, to = 'back' }]",
        3,
        "`after_s` falls from 3 to 1",
    );
    check_refused(
        "[states.a]\nstand = {}\nthen = [{ when = { after_s = -3 }, to = 'a' }]",
        3,
        "`after_s` is -3, not within",
    );
    check_refused(
        "[states.a]\nstand = {}\nset = { radius_m = { uniform = [0.2, 5] } }",
        3,
        "lies between 0.2 and 5, not within 0.1 and 1",
    );
    for limits in ["min = 5, max = 6", "max = 1.2", "min = 1.4"] {
        let set = format!("set = {{ preferred_speed_mps = {{ normal = [1.3, 0.01], {limits} }} }}");
        check_refused(&format!("[states.a]\nstand = {{}}\n{set}"), 3, "is 1.3, not between `min` and `max`");
    }
    check_refused("[states.a]\nstand = {}\nthen = [{ when = { soon = 1 }, to = 'back' }]", 3, "soon");
    check_refused("[states.a]\nstand = {}\nremember = true", 3, "only `go` to goals");
    check_refused("[states.a]\ngo = { mirror = [0, 0] }", 2, "`{ mirror_m = [x, y] }`");
    check_refused("[states.a]\nstand = {}\nset = { radius_m = 40 }", 3, "is 40, not within 0.1 and 1");
}

/// States of goals that share one another's choice, as `name = remember`.
fn sharing(states: &[(&str, &str)]) -> String {
    let state = |(name, remember): &(&str, &str)| format!("[states.{name}]\ngo = 'seat'\n{remember}\n");
    "[goals.seat]\nareas = [{ point_m = [0, 0] }]\n".to_owned() + &states.iter().map(state).collect::<String>()
}

#[test]
fn a_state_that_others_name_keeps_its_goal() {
    let text = sharing(&[("again", "remember = 'back_in'"), ("back_in", "remember = 'sit'"), ("sit", "")]);
    let memories = resolved(&text).unwrap().states.into_iter().map(|state| match state.movement {
        Movement::Goals { memory, .. } => memory,
        _ => None,
    });
    assert_eq!(memories.collect::<Vec<_>>(), [None, Some(3), Some(3), Some(3)]);
    let circle = sharing(&[("a", "remember = 'b'"), ("b", "remember = 'a'")]);
    check_refused(&circle, 5, "in a circle");
    let stands = sharing(&[("a", "remember = 'b'")]) + "[states.b]\nstand = {}\n";
    check_refused(&stands, 5, "state `b` has no goal that another state can share");
    check_refused(&sharing(&[("a", "remember = 'follow_path'")]), 5, "state `follow_path` has no goal");
}

#[test]
fn reserved_names_and_ends_are_refused() {
    check_refused("[states.back]\nstand = {}", 1, "every scenario has");
    check_refused("[states.follow_path]\nstand = {}", 1, "every scenario has");
    check_refused("[states.a]\nremove = true\nthen = [{ to = 'a' }]", 1, "no state comes after it");
    check_refused("[states.a]\nremove = false", 1, "exactly one of `go`");
}

#[test]
fn limits_hold_before_anything_is_allocated() {
    let states: String = (0..=4_000).map(|state| format!("[states.s{state}]\nstand = {{}}\n")).collect();
    assert!(resolved(&states).unwrap_err().contains("4001 states"));
    let copies = vec!["[0, 0]"; 60_000].join(", ");
    let goals = format!("[goals.g]\ncopies_m = [{copies}]\nareas = [{{ point_m = [0, 0] }}, {{ point_m = [1, 0] }}]");
    assert!(resolved(&goals).unwrap_err().contains("120000 areas"));
}

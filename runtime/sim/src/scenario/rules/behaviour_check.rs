//! The rules of behaviour: every index names something, every number is in range, every goal has free ground. World,
//! metres, seconds.
//!
//! A scenario file resolves names to indices, so these rules hold for it but for coordinates. A recording's header and a
//! scenario made in code are checked in full: the state machine relies on them.

use std::ops::RangeInclusive;

use glam::Vec2;

use crate::behaviour::{
    Area, Behaviour, Choice, Condition, Distribution, Event, FOLLOWS_PATH, Facing, GoalArea, Movement, Settings,
    Signal, State, Target,
};
use crate::maths::polygon::{closest_distance_m, contains};
use crate::scenario::agent_spec::WALL_RADIUS_M;
use crate::scenario::fault::{ScenarioFault, ScenarioPart};
use crate::scenario::ranges::{COORDINATE_MAX_M, PRIORITY, RADIUS_M, REMOVE, SPEED_MPS, check_points, within};
use crate::scenario::resolved::Scenario;

/// Greatest number of states; the limit of the recording is higher.
const STATES_MAX: usize = 4_001;
/// Greatest duration, s: a day.
const DURATION_S: RangeInclusive<f32> = 0.0..=86_400.0;
/// Factor of a speed.
pub(crate) const FACTOR: RangeInclusive<f32> = 1e-3..=10.0;
/// Weight of an area.
const WEIGHT: RangeInclusive<f32> = 0.0..=1e6;
/// Deepest nesting of conditions.
const DEPTH_MAX: usize = 64;
/// How to mend what a scenario file cannot state.
const RESOLVE: &str = "state it in a scenario file, which resolves names to indices";
/// Positions along each side of an area's box that are searched for free ground.
const LATTICE: u16 = 8;
/// Rounding of positions that are meant to touch, m.
const TOUCH_M: f64 = 1e-4;

/// Checks indices and numbers of the behaviour, and the states of agents and sources.
pub(crate) fn check_behaviour_ranges(scenario: &Scenario) -> Result<(), ScenarioFault> {
    let behaviour = &scenario.behaviour;
    let Behaviour { states, goals, signals, areas, events } = behaviour;
    within(&ScenarioPart::State(0), "the number of states", states.len(), &(0..=STATES_MAX), "give fewer")?;
    if states.first().is_some_and(|first| *first != State::follow_path()) {
        return ScenarioPart::State(0).fault(format!("the first state is not {FOLLOWS_PATH}"), RESOLVE);
    }
    let count = states.len().max(1);
    for (index, agent) in scenario.agents.iter().enumerate() {
        check_index(&ScenarioPart::Agent(index), "state", agent.state as usize, count)?;
    }
    for (index, source) in scenario.sources.iter().enumerate() {
        check_index(&ScenarioPart::Source(index), "state", source.state as usize, count)?;
    }
    for (index, set) in goals.iter().enumerate() {
        let part = ScenarioPart::Goals(index);
        within(&part, "the number of areas", set.areas.len(), &(1..=usize::MAX), "add an area")?;
        set.areas.iter().try_for_each(|area| check_goal_area(&part, area))?;
    }
    for (index, signal) in signals.iter().enumerate() {
        check_signal(&ScenarioPart::Signal(index), signal)?;
    }
    for (index, area) in areas.iter().enumerate() {
        check_area(&ScenarioPart::Area(index), area)?;
    }
    for (index, event) in events.iter().enumerate() {
        check_event(&ScenarioPart::Event(index), event, behaviour)?;
    }
    states.iter().enumerate().try_for_each(|(index, state)| check_state(&ScenarioPart::State(index), state, behaviour))
}

fn check_index(part: &ScenarioPart, what: &str, index: usize, count: usize) -> Result<(), ScenarioFault> {
    if index < count {
        return Ok(());
    }
    part.fault(format!("{what} {index} does not exist; there are {count}"), RESOLVE)
}

fn check_goal_area(part: &ScenarioPart, area: &GoalArea) -> Result<(), ScenarioFault> {
    check_area(part, &area.area)?;
    within(part, "weight", area.weight, &WEIGHT, "give a weight from 0 to a million")?;
    let capacity = area.capacity.unwrap_or(1);
    within(part, "capacity", capacity, &(1..=u32::MAX), "remove the key for any number of agents")?;
    check_finite(part, "facing_deg", area.facing_rad.unwrap_or(0.0))
}

/// Checks that an area lies within range.
pub(crate) fn check_area(part: &ScenarioPart, area: &Area) -> Result<(), ScenarioFault> {
    match area {
        Area::Disc { centre_m, radius_m } => {
            check_points(part, &[*centre_m])?;
            within(part, "the radius", *radius_m, &(0.0..=COORDINATE_MAX_M), "give a radius in metres")
        }
        Area::Polygon(corners_m) => {
            within(part, "the number of corners", corners_m.len(), &(3..=usize::MAX), "give three or more")?;
            check_points(part, corners_m)
        }
    }
}

fn check_signal(part: &ScenarioPart, signal: &Signal) -> Result<(), ScenarioFault> {
    let help = "give durations from 0 s to a day, one of them above 0";
    within(part, "green_s", signal.green_s, &DURATION_S, help)?;
    within(part, "red_s", signal.red_s, &DURATION_S, help)?;
    within(part, "offset_s", signal.offset_s, &(-*DURATION_S.end()..=*DURATION_S.end()), help)?;
    within(part, "green_s + red_s", signal.green_s + signal.red_s, &(f32::MIN_POSITIVE..=f32::MAX), help)
}

fn check_event(part: &ScenarioPart, event: &Event, behaviour: &Behaviour) -> Result<(), ScenarioFault> {
    check_condition(part, &event.condition, behaviour, DEPTH_MAX)?;
    if !event.condition.is_of_crowd() {
        return part.fault(format!("the condition of event `{}` speaks of one agent", event.name), RESOLVE);
    }
    for state in event.from.iter().flatten().chain(&event.to) {
        check_index(part, "state", *state as usize, behaviour.states.len())?;
    }
    event.signals.iter().try_for_each(|(signal, _)| check_index(part, "signal", *signal, behaviour.signals.len()))
}

fn check_state(part: &ScenarioPart, state: &State, behaviour: &Behaviour) -> Result<(), ScenarioFault> {
    check_movement(part, &state.movement, behaviour)?;
    check_settings(part, &state.settings)?;
    for transition in &state.transitions {
        check_condition(part, &transition.condition, behaviour, DEPTH_MAX)?;
        let Target::States(states) = &transition.target else { continue };
        for (state, weight) in states {
            check_index(part, "state", *state as usize, behaviour.states.len())?;
            within(part, "weight", *weight, &(0.0..=f32::MAX), "give a weight of 0 or more")?;
        }
        let sum: f32 = states.iter().map(|(_, weight)| weight).sum();
        within(part, "the sum of the weights", sum, &(f32::MIN_POSITIVE..=f32::MAX), "give a weight above 0")?;
    }
    Ok(())
}

fn check_movement(part: &ScenarioPart, movement: &Movement, behaviour: &Behaviour) -> Result<(), ScenarioFault> {
    match *movement {
        Movement::Goals { set, choice, memory } => {
            check_index(part, "goals", set, behaviour.goals.len())?;
            check_index(part, "state", memory.unwrap_or(0) as usize, behaviour.states.len())?;
            let drawn = if let Choice::NearestOf(count) = choice { count } else { 1 };
            within(part, "nearest_of", drawn, &(1..=100_000), "give the number of areas that are drawn")
        }
        Movement::Mirrored { centre_m: point_m } | Movement::Offset { by_m: point_m } => check_points(part, &[point_m]),
        Movement::Walk { velocity_mps } => {
            within(part, "walk_mps", velocity_mps.length(), &(0.0..=*SPEED_MPS.end()), "give a velocity in m/s")
        }
        Movement::Stand { facing: Facing::At(at_m) } => check_points(part, &[at_m]),
        Movement::Stand { facing: Facing::Towards(facing_rad) } => check_finite(part, "facing_deg", facing_rad),
        Movement::Stand { .. } | Movement::OwnPath | Movement::Leave { .. } => Ok(()),
    }
}

fn check_settings(part: &ScenarioPart, settings: &Settings) -> Result<(), ScenarioFault> {
    let Settings { preferred_speed_mps, speed_factor, radius_m, priority, teleport, remain: _ } = settings;
    within(part, "priority", priority.unwrap_or(0.0), &PRIORITY, REMOVE)?;
    let drawn = [
        ("preferred_speed_mps", preferred_speed_mps, &SPEED_MPS),
        ("speed_factor", speed_factor, &FACTOR),
        ("radius_m", radius_m, &RADIUS_M),
    ];
    for (name, distribution, range) in drawn {
        distribution.map_or(Ok(()), |distribution| check_distribution(part, name, &distribution, range))?;
    }
    teleport.as_ref().map_or(Ok(()), |area| check_area(part, area))
}

/// Checks that all draws lie in a range.
pub(crate) fn check_distribution(
    part: &ScenarioPart,
    name: &str,
    distribution: &Distribution,
    range: &RangeInclusive<f32>,
) -> Result<(), ScenarioFault> {
    let [least, greatest] = distribution.bounds();
    within(part, name, least, range, "give a number in this range")?;
    within(part, name, greatest, &(least..=*range.end()), "write the lower number first")?;
    match *distribution {
        Distribution::Normal { mean, deviation, .. } => {
            check_finite(part, name, mean)?;
            within(part, name, deviation, &(0.0..=f32::MAX), "write `normal = [mean, deviation]`")
        }
        Distribution::Constant(_) | Distribution::Uniform { .. } => Ok(()),
    }
}

fn check_condition(
    part: &ScenarioPart,
    condition: &Condition,
    behaviour: &Behaviour,
    depth: usize,
) -> Result<(), ScenarioFault> {
    let Some(depth) = depth.checked_sub(1) else {
        return part.fault(format!("conditions are nested deeper than {DEPTH_MAX}"), "nest them less");
    };
    let inner = |inner: &Condition| check_condition(part, inner, behaviour, depth);
    match condition {
        Condition::Always => Ok(()),
        Condition::Reached(within_m) => within(part, "reached_m", *within_m, &(0.0..=1e4), "give a distance in metres"),
        Condition::After(duration_s) => check_distribution(part, "after_s", duration_s, &DURATION_S),
        Condition::Served(duration_s) => check_distribution(part, "served_s", duration_s, &DURATION_S),
        Condition::Inside(area) | Condition::Number(area, _) => check_index(part, "area", *area, behaviour.areas.len()),
        Condition::Green(signal) => check_index(part, "signal", *signal, behaviour.signals.len()),
        Condition::Population(state, _) => check_index(part, "state", *state, behaviour.states.len()),
        Condition::All(parts) | Condition::Any(parts) => parts.iter().try_for_each(inner),
        Condition::Not(one) => inner(one),
    }
}

fn check_finite(part: &ScenarioPart, name: &str, value: f32) -> Result<(), ScenarioFault> {
    within(part, name, value, &(f32::MIN..=f32::MAX), "give a number")
}

/// Checks that agents can stand somewhere in each area of the goals.
pub(crate) fn check_goals_clear_of_obstacles(scenario: &Scenario) -> Result<(), ScenarioFault> {
    const HELP: &str = "move it away from the obstacles";
    let boxed: Vec<BoxedObstacle<'_>> = scenario.obstacles_m.iter().map(|polygon_m| boxed(polygon_m)).collect();
    for (index, set) in scenario.behaviour.goals.iter().enumerate() {
        for area in &set.areas {
            if !has_free_ground(&area.area, &boxed) {
                let [x, y] = area.area.centre_m().to_array();
                let message = format!("the area of goals `{}` at [{x}, {y}] has no free ground", set.name);
                return ScenarioPart::Goals(index).fault(message, HELP);
            }
        }
    }
    for (index, state) in scenario.behaviour.states.iter().enumerate() {
        if state.settings.teleport.as_ref().is_some_and(|area| !has_free_ground(area, &boxed)) {
            let message = format!("the area to which state `{}` teleports has no free ground", state.name);
            return ScenarioPart::State(index).fault(message, HELP);
        }
    }
    Ok(())
}

/// Least and greatest corner of an obstacle, m, and its corners.
type BoxedObstacle<'a> = ([Vec2; 2], &'a [Vec2]);

fn boxed(polygon_m: &[Vec2]) -> BoxedObstacle<'_> {
    let low_m = polygon_m.iter().copied().fold(Vec2::INFINITY, Vec2::min);
    ([low_m, polygon_m.iter().copied().fold(Vec2::NEG_INFINITY, Vec2::max)], polygon_m)
}

/// Whether walls leave room for an agent somewhere in an area.
fn has_free_ground(area: &Area, obstacles: &[BoxedObstacle<'_>]) -> bool {
    let [low_m, high_m] = area.bounds_m();
    let is_beside = |([from_m, to_m], _): &&BoxedObstacle<'_>| {
        from_m.cmple(high_m + WALL_RADIUS_M).all() && to_m.cmpge(low_m - WALL_RADIUS_M).all()
    };
    let near: Vec<&[Vec2]> = obstacles.iter().filter(is_beside).map(|(_, polygon_m)| *polygon_m).collect();
    let is_clear = |position_m: Vec2| {
        near.iter().all(|polygon_m| {
            let clear_m = closest_distance_m(polygon_m, position_m);
            !contains(polygon_m, position_m) && clear_m >= f64::from(WALL_RADIUS_M) - TOUCH_M
        })
    };
    near.is_empty() || area.lattice_m(LATTICE).any(is_clear)
}

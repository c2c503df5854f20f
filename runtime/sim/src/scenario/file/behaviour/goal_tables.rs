//! From the tables of signals and goals to [`Signal`] and [`GoalSet`].

use std::collections::BTreeMap;

use glam::Vec2;
use toml::Spanned;

use crate::behaviour::{Choice, GoalArea, GoalSet, Signal};
use crate::scenario::file::behaviour::placed_fault::{At, DURATION_MAX_S, PlacedFault, fault};
use crate::scenario::file::behaviour::tables::{ChooseName, ChooseValue, GoalAreaTable, GoalsTable, SignalTable};
use crate::scenario::point::Point;

/// Greatest number of areas of all goals.
const AREAS_MAX: usize = 100_000;
/// How to mend a capacity of 0.
const CAPACITY_HELP: &str = "give a capacity of 1 or more, or remove the key: any number of agents";
/// Greatest number of corners of all areas, 8 MB.
const CORNERS_MAX: usize = 1_000_000;

/// The signal of a table.
pub(crate) fn signal(name: &str, table: &Spanned<SignalTable>) -> Result<Signal, PlacedFault> {
    let SignalTable { green_s, red_s, offset_s } = *table.get_ref();
    let is_duration = |duration_s: f32| (0.0..=DURATION_MAX_S).contains(&duration_s);
    if is_duration(green_s) && is_duration(red_s) && green_s + red_s > 0.0 && offset_s.abs() <= DURATION_MAX_S {
        return Ok(Signal { name: name.to_owned(), green_s, red_s, offset_s });
    }
    let message = format!("signal `{name}` is green for {green_s} s, red for {red_s} s, offset {offset_s} s");
    Err(fault(&table.span(), message, "give durations from 0 s to a day, one of them above 0"))
}

/// The sets of goals of all tables.
pub(crate) fn goal_sets(tables: &BTreeMap<String, Spanned<GoalsTable>>) -> Result<Vec<GoalSet>, PlacedFault> {
    let (mut sets, mut areas, mut corners) = (Vec::with_capacity(tables.len()), 0, 0);
    for (name, table) in tables {
        let goals = table.get_ref();
        let copies = goals.copies_m.as_ref().map_or(1, Vec::len);
        areas += goals.areas.len().saturating_mul(copies);
        let of_areas: usize = goals.areas.iter().map(|area| area.get_ref().corner_count()).sum();
        corners += of_areas.saturating_mul(copies);
        if areas > AREAS_MAX || corners > CORNERS_MAX {
            let message = format!("with goals `{name}` there are {areas} areas with {corners} corners");
            let help = "give at most 100,000 areas, with a million corners, in all goals together";
            return Err(fault(&table.span(), message, help));
        }
        sets.push(goal_set(name, table)?);
    }
    Ok(sets)
}

fn goal_set(name: &str, table: &Spanned<GoalsTable>) -> Result<GoalSet, PlacedFault> {
    let (span, goals) = (table.span(), table.get_ref());
    let offsets_m: Vec<Vec2> = match &goals.copies_m {
        None => vec![Vec2::ZERO],
        Some(copies_m) => copies_m.iter().map(|&Point(offset_m)| offset_m).collect(),
    };
    let count = goals.areas.len().saturating_mul(offsets_m.len());
    if count == 0 {
        let message = format!("goals `{name}` have no areas");
        return Err(fault(&span, message, "add `areas = [{ point_m = [x, y] }]`"));
    }
    if let Some(capacity) = goals.capacity.as_ref().filter(|capacity| *capacity.get_ref() == 0) {
        return Err(fault(&capacity.span(), format!("the capacity of goals `{name}` is 0"), CAPACITY_HELP));
    }
    let mut areas = Vec::with_capacity(count);
    for offset_m in offsets_m {
        for table in &goals.areas {
            areas.push(goal_area(goals, table, offset_m)?);
        }
    }
    Ok(GoalSet { name: name.to_owned(), areas, queue: goals.queue })
}

fn goal_area(goals: &GoalsTable, table: &Spanned<GoalAreaTable>, offset_m: Vec2) -> Result<GoalArea, PlacedFault> {
    let (span, area) = (table.span(), table.get_ref());
    let capacity = area.capacity.or(goals.capacity.as_ref().map(|capacity| *capacity.get_ref()));
    let weight = area.weight.unwrap_or(1.0);
    if area.capacity == Some(0) {
        return Err(fault(&span, "the capacity of the area is 0".into(), CAPACITY_HELP));
    }
    if !(0.0..=1e6).contains(&weight) {
        let message = format!("the weight of the area is {weight}");
        return Err(fault(&span, message, "give a weight from 0 to a million"));
    }
    if goals.queue && capacity.is_some() {
        return Err(fault(&span, "a place of a queue takes one agent".into(), "remove `capacity`"));
    }
    let facing_rad = area.facing_deg.map(f32::to_radians);
    if facing_rad.is_some_and(|facing_rad| !facing_rad.is_finite()) {
        return Err(fault(&span, "the facing is no number".into(), "give degrees, counter-clockwise from +x"));
    }
    let moved = area.keys().area().at(&span)?.moved(offset_m);
    Ok(GoalArea { area: moved, facing_rad, capacity, weight })
}

/// How agents choose, from its name.
pub(crate) fn choice(value: ChooseValue) -> Choice {
    match value {
        ChooseValue::Named(ChooseName::Nearest) => Choice::Nearest,
        ChooseValue::Named(ChooseName::Farthest) => Choice::Farthest,
        ChooseValue::Named(ChooseName::Random) => Choice::Random,
        ChooseValue::Named(ChooseName::Weighted) => Choice::Weighted,
        ChooseValue::Named(ChooseName::LeastBusy) => Choice::LeastBusy,
        ChooseValue::NearestOf(table) => Choice::NearestOf(table.nearest_of.max(1)),
    }
}

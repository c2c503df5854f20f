//! The rules of sources: their numbers are in range, they give no more agents than a scenario may have, their areas
//! have free ground, and their goals lie outside obstacles. World, metres, seconds.

use std::ops::RangeInclusive;

use glam::Vec2;

use crate::behaviour::Area;
use crate::maths::polygon::{closest_distance_m, contains};
use crate::route::arrival::ARRIVAL_M;
use crate::scenario::fault::{ScenarioFault, ScenarioPart};
use crate::scenario::profile::Profile;
use crate::scenario::ranges::{
    AGENTS_MAX, DURATION_S, GOALS_MAX, PRE_MOVEMENT_S, PRIORITY, RADIUS_M, REMOVE, SPEED_MPS, WAYPOINTS_MAX,
    check_disc_and_speed, check_facing, check_points, check_sizes, within,
};
use crate::scenario::resolved::Scenario;
use crate::scenario::rules::behaviour_check::check_distribution;
use crate::scenario::rules::schedule_check::{RATE_MAX_PER_S, check_schedule};
use crate::scenario::source_spec::SourceSpec;

/// Greatest number of sources.
const SOURCES_MAX: usize = 1_000;
/// Agents per second of a source, from one in a day.
const RATE_PER_S: RangeInclusive<f32> = 1e-5..=RATE_MAX_PER_S;
/// Positions on either side of an area's lattice that is searched for free ground.
const LATTICE: u32 = 16;
/// Rounding of positions that are meant to touch, m.
const TOUCH_M: f64 = 1e-4;

/// Checks that every number of all sources is in range, and how many agents they give.
pub(crate) fn check_source_ranges(scenario: &Scenario) -> Result<(), ScenarioFault> {
    let sources = &scenario.sources;
    within(&ScenarioPart::Source(0), "the number of sources", sources.len(), &(0..=SOURCES_MAX), "give fewer")?;
    for (index, source) in sources.iter().enumerate() {
        check_numbers(&ScenarioPart::Source(index), source)?;
    }
    check_crowd(scenario)
}

fn check_numbers(part: &ScenarioPart, source: &SourceSpec) -> Result<(), ScenarioFault> {
    check_points(part, &[source.low_m, source.high_m])?;
    check_points(part, &source.area.as_ref().map(Area::outline_m).unwrap_or_default())?;
    check_points(part, &source.goals_m)?;
    check_points(part, source.goal_offset_m.as_slice())?;
    if source.low_m.cmpgt(source.high_m).any() {
        return part.fault("rect_m has no inside".into(), "write [least x, least y, greatest x, greatest y]");
    }
    check_times(part, source)?;
    let count = source.count.map_or(1, |count| count as usize);
    within(part, "count", count, &(1..=AGENTS_MAX), REMOVE)?;
    let goals = source.goals_m.len() + usize::from(source.goal_offset_m.is_some());
    let least = usize::from(source.state == 0);
    within(part, "the number of goals", goals, &(least..=GOALS_MAX), "give the goal, and waypoints before it")?;
    within(part, "pre_movement_s", source.pre_movement_s, &PRE_MOVEMENT_S, REMOVE)?;
    within(part, "priority", source.priority, &PRIORITY, REMOVE)?;
    source.groups.as_ref().map_or(Ok(()), |sizes| check_sizes(part, sizes))?;
    source.profiles.iter().try_for_each(|profile| check_profile(part, profile))?;
    check_facing(part, source.facing_rad.unwrap_or(0.0))?;
    check_disc_and_speed(part, source.radius_m, source.wall_radius_m, source.preferred_speed_mps)
}

fn check_times(part: &ScenarioPart, source: &SourceSpec) -> Result<(), ScenarioFault> {
    if let Some(schedule) = &source.schedule {
        return check_schedule(schedule).or_else(|(_, (message, help))| part.fault(message, help));
    }
    within(part, "rate_per_s", source.rate_per_s, &RATE_PER_S, "give the mean number of agents per second")?;
    within(part, "from_s", source.from_s, &(0.0..=*DURATION_S.end()), "remove the key to begin at the start")?;
    let until = source.from_s..=*DURATION_S.end();
    within(part, "to_s", source.to_s, &until, "give a time after from_s, or remove the key")
}

fn check_profile(part: &ScenarioPart, profile: &Profile) -> Result<(), ScenarioFault> {
    within(part, "weight", profile.weight, &(0.0..=f32::MAX), "give shares of 0 or more")?;
    within(part, "priority", profile.priority, &PRIORITY, REMOVE)?;
    let numbers = [
        ("preferred_speed_mps", &profile.preferred_speed_mps, &SPEED_MPS),
        ("radius_m", &profile.radius_m, &RADIUS_M),
        ("pre_movement_s", &profile.pre_movement_s, &PRE_MOVEMENT_S),
    ];
    let mut drawn = numbers.into_iter().filter_map(|(name, number, range)| Some((name, number.as_ref()?, range)));
    drawn.try_for_each(|(name, number, range)| check_distribution(part, name, number, range))
}

/// Checks that the agents of all sources, and their waypoints, are no more than a scenario may have.
fn check_crowd(scenario: &Scenario) -> Result<(), ScenarioFault> {
    let mut agents = scenario.agents.len();
    let mut waypoints: usize = scenario.agents.iter().map(|agent| agent.goals_m.len()).sum();
    let duration_s = f64::from(scenario.duration_s);
    for (index, source) in scenario.sources.iter().enumerate() {
        let due_s = source.due_times(scenario.seed, index).take_while(|due_s| *due_s <= duration_s);
        let due = due_s.take(AGENTS_MAX + 1).count();
        agents += due;
        waypoints += due * (source.goals_m.len() + usize::from(source.goal_offset_m.is_some()));
        let part = ScenarioPart::Source(index);
        if agents > AGENTS_MAX {
            let message = format!("with this source the scenario has more than {AGENTS_MAX} agents");
            return part
                .fault(message, "lower rate_per_s or the numbers of its schedule, or set `count` or an earlier to_s");
        }
        if waypoints > WAYPOINTS_MAX {
            let message = format!("with this source the scenario has more than {WAYPOINTS_MAX} waypoints");
            return part.fault(message, "reduce the number of agents or of goals");
        }
    }
    Ok(())
}

/// Checks every source against the obstacles.
pub(crate) fn check_sources_clear_of_obstacles(scenario: &Scenario) -> Result<(), ScenarioFault> {
    for (index, source) in scenario.sources.iter().enumerate() {
        for &goal_m in &source.goals_m {
            check_goal(scenario, index, goal_m)?;
        }
        if let (Some(goal_m), None) = (source.goals_m.last(), source.goal_offset_m) {
            check_reach(scenario, index, *goal_m)?;
        }
        check_area(scenario, index)?;
    }
    Ok(())
}

fn check_goal(scenario: &Scenario, index: usize, goal_m: Vec2) -> Result<(), ScenarioFault> {
    match scenario.obstacles_m.iter().position(|polygon_m| contains(polygon_m, goal_m)) {
        None => Ok(()),
        Some(obstacle) => ScenarioPart::Source(index).fault(
            format!("the goal {goal_m} of source {index} lies inside obstacle {obstacle}"),
            "move the goal to free ground",
        ),
    }
}

/// Checks that the agents can come near their last goal.
fn check_reach(scenario: &Scenario, index: usize, goal_m: Vec2) -> Result<(), ScenarioFault> {
    let radius_m = f64::from(scenario.sources[index].wall_radius_m);
    let is_too_near = |polygon_m: &Vec<Vec2>| radius_m - closest_distance_m(polygon_m, goal_m) >= ARRIVAL_M;
    match scenario.obstacles_m.iter().position(is_too_near) {
        None => Ok(()),
        Some(obstacle) => ScenarioPart::Source(index).fault(
            format!(
                "agents of source {index} cannot come within {ARRIVAL_M} m of their goal beside obstacle {obstacle}"
            ),
            "move the goal away from the obstacle, or set a smaller `wall_radius_m`",
        ),
    }
}

/// Checks that the area has free ground, and that the goals relative to it lie outside obstacles.
fn check_area(scenario: &Scenario, index: usize) -> Result<(), ScenarioFault> {
    let source = &scenario.sources[index];
    let near: Vec<&Vec<Vec2>> = scenario.obstacles_m.iter().filter(|polygon_m| is_beside(polygon_m, source)).collect();
    let is_clear = |position_m: &Vec2| {
        near.iter().all(|polygon_m| {
            let clear_m = closest_distance_m(polygon_m, *position_m);
            !contains(polygon_m, *position_m) && clear_m >= f64::from(source.wall_radius_m) - TOUCH_M
        })
    };
    let middle_m = std::iter::once(source.middle_m());
    let mut clear_m = middle_m.chain(lattice_m(source)).filter(is_clear).peekable();
    if clear_m.peek().is_none() {
        return ScenarioPart::Source(index).fault(
            format!("source {index} has no free ground: obstacles leave no room for a disc"),
            "move it until it is at least `wall_radius_m` from every obstacle",
        );
    }
    let Some(offset_m) = source.goal_offset_m else { return Ok(()) };
    clear_m.try_for_each(|start_m| check_goal(scenario, index, start_m + offset_m))
}

/// Whether the box of an obstacle comes near a source's area.
fn is_beside(polygon_m: &[Vec2], source: &SourceSpec) -> bool {
    let low_m = polygon_m.iter().copied().fold(Vec2::INFINITY, Vec2::min) - source.wall_radius_m;
    let high_m = polygon_m.iter().copied().fold(Vec2::NEG_INFINITY, Vec2::max) + source.wall_radius_m;
    source.high_m.cmpge(low_m).all() && source.low_m.cmple(high_m).all()
}

/// Positions in the area on a lattice over its box, from corner to corner; a single one of an area without extent.
fn lattice_m(source: &SourceSpec) -> impl Iterator<Item = Vec2> {
    let (low_m, size_m) = (source.low_m, source.high_m - source.low_m);
    let [columns, rows] = [size_m.x, size_m.y].map(|side_m| if side_m > 0.0 { LATTICE } else { 0 });
    let cells = (0..=rows).flat_map(move |row| (0..=columns).map(move |column| Vec2::new(column as f32, row as f32)));
    let positions_m = cells.map(move |cell| low_m + size_m * cell / LATTICE as f32);
    positions_m.filter(|position_m| source.area.is_none() || source.holds(*position_m))
}

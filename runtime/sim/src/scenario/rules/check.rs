//! The rules of every scenario, whether read or made in code: numbers in range (`ranges`), obstacles that are simple
//! polygons, agents that start apart from each other and outside obstacles, and goals outside obstacles that agents can
//! reach. World, metres.

use glam::{DVec2, Vec2};

use crate::maths::polygon::{closest_distance_m, contains};
use crate::maths::sweep::sort_along_longer_side;
use crate::route::arrival::ARRIVAL_M;
use crate::scenario::agent_spec::AgentSpec;
use crate::scenario::characters::character_check::check_characters;
use crate::scenario::fault::{ScenarioFault, ScenarioPart};
use crate::scenario::ranges::{check_has_agents, check_ranges};
use crate::scenario::resolved::Scenario;
use crate::scenario::rules::behaviour_check::{check_behaviour_ranges, check_goals_clear_of_obstacles};
use crate::scenario::rules::camera_check::{check_cameras, check_followed, check_heights};
use crate::scenario::rules::ground_check::{check_ground, check_ground_ranges};
use crate::scenario::rules::marking_check::check_markings;
use crate::scenario::rules::measure_check::{check_measures, check_zones};
use crate::scenario::rules::shot_check::check_shot;
use crate::scenario::rules::source_check::{check_source_ranges, check_sources_clear_of_obstacles};
use crate::scenario::rules::variation_check::check_variation;
use crate::scenario::rules::zone_check::check_closed_zones;

/// Distance from an obstacle's box beyond which no disc touches the obstacle, m.
const NEAR_M: f32 = 1.0;
/// How to mend a goal in a door.
const OUT_OF_DOORS: &str = "move the goal to ground that is free while the door is closed";
/// Rounding of positions that are meant to touch, m.
const TOUCH_M: f64 = 1e-4;

/// Checks every rule, cheapest first.
///
/// # Errors
/// The first broken rule.
pub fn check(scenario: &Scenario) -> Result<(), ScenarioFault> {
    check_has_agents(scenario)?;
    check_plan(scenario)
}

/// As [`check`]; there need not be agents.
pub(crate) fn check_plan(scenario: &Scenario) -> Result<(), ScenarioFault> {
    check_numbers(scenario)?;
    check_ground(scenario)?;
    check_agents_clear_of_obstacles(scenario)?;
    check_agents_clear_of_doors(scenario)?;
    check_closed_zones(scenario)?;
    check_agents_apart(&scenario.agents)?;
    check_sources_clear_of_obstacles(scenario)?;
    check_goals_clear_of_obstacles(scenario)
}

/// Checks that every number is in range.
///
/// # Errors
/// The first number that is not.
pub(crate) fn check_numbers(scenario: &Scenario) -> Result<(), ScenarioFault> {
    check_ranges(scenario)?;
    check_ground_ranges(scenario)?;
    check_behaviour_ranges(scenario)?;
    check_measures(scenario)?;
    check_zones(scenario)?;
    check_markings(scenario)?;
    check_characters(&scenario.characters)?;
    check_heights(&scenario.obstacle_heights_m)?;
    check_cameras(&scenario.cameras)?;
    check_followed(scenario)?;
    scenario.shot.as_ref().map_or(Ok(()), |shot| check_shot(shot, scenario.duration_s))?;
    scenario.variation.as_ref().map_or(Ok(()), check_variation)?;
    check_source_ranges(scenario)
}

/// Checks that agents start outside the doors that are closed then, and that no goal lies in a door.
fn check_agents_clear_of_doors(scenario: &Scenario) -> Result<(), ScenarioFault> {
    if scenario.doors.is_empty() {
        return Ok(());
    }
    let (agents, closed) = (SortedAgents::new(&scenario.agents), scenario.doors_closed_at_start());
    for (door, is_closed) in scenario.doors.iter().zip(closed) {
        let low_m = door.polygon_m.iter().copied().fold(Vec2::INFINITY, Vec2::min) - NEAR_M;
        let high_m = door.polygon_m.iter().copied().fold(Vec2::NEG_INFINITY, Vec2::max) + NEAR_M;
        let signal = &scenario.behaviour.signals[door.signal as usize].name;
        for (index, source) in scenario.sources.iter().enumerate() {
            if let Some(goal_m) = source.goals_m.iter().find(|goal_m| contains(&door.polygon_m, **goal_m)) {
                let message = format!("the goal {goal_m} of source {index} lies in the door of signal `{signal}`");
                return ScenarioPart::Source(index).fault(message, OUT_OF_DOORS);
            }
        }
        for index in agents.between(low_m, high_m) {
            let (part, agent) = (ScenarioPart::Journey(index), &scenario.agents[index]);
            let clear_m = closest_distance_m(&door.polygon_m, agent.position_m);
            let is_inside = contains(&door.polygon_m, agent.position_m);
            if is_closed && (is_inside || f64::from(agent.wall_radius_m) - clear_m > TOUCH_M) {
                let message = format!("agent {index} starts in a door that is closed at 0 s: signal `{signal}` is red");
                return part.fault(message, "move it, or let a green phase of the signal begin at 0 s by `offset_s`");
            }
            if let Some(goal_m) = agent.goals_m.iter().find(|goal_m| contains(&door.polygon_m, **goal_m)) {
                let message = format!("the goal {goal_m} of agent {index} lies in the door of signal `{signal}`");
                return part.fault(message, OUT_OF_DOORS);
            }
        }
    }
    Ok(())
}

fn check_agents_clear_of_obstacles(scenario: &Scenario) -> Result<(), ScenarioFault> {
    let agents = SortedAgents::new(&scenario.agents);
    for (obstacle, polygon_m) in scenario.obstacles_m.iter().enumerate() {
        let low_m = polygon_m.iter().copied().fold(Vec2::INFINITY, Vec2::min) - NEAR_M;
        let high_m = polygon_m.iter().copied().fold(Vec2::NEG_INFINITY, Vec2::max) + NEAR_M;
        let near = |point_m: Vec2| point_m.cmpge(low_m).all() && point_m.cmple(high_m).all();
        for index in agents.between(low_m, high_m) {
            let agent = &scenario.agents[index];
            if near(agent.position_m) {
                check_start(index, agent, obstacle, polygon_m)?;
            }
            if let Some(goal_m) = agent.goals_m.iter().find(|goal_m| near(**goal_m) && contains(polygon_m, **goal_m)) {
                let message = format!("the goal {goal_m} of agent {index} lies inside obstacle {obstacle}");
                return ScenarioPart::Journey(index).fault(message, "move the goal to free ground");
            }
            if let Some(goal_m) = agent.goals_m.last().filter(|goal_m| near(**goal_m)) {
                check_reach(index, agent, obstacle, closest_distance_m(polygon_m, *goal_m))?;
            }
        }
    }
    Ok(())
}

/// Starts and goals of all agents, sorted along the scene's longer side: of a million agents and ten thousand obstacles
/// only those beside each other are compared.
struct SortedAgents {
    axis: usize,
    /// Coordinate along the axis, m, and index of the agent; sorted.
    coordinates: Vec<(f32, usize)>,
}

impl SortedAgents {
    fn new(agents: &[AgentSpec]) -> Self {
        let mut all: Vec<(Vec2, usize)> = Vec::new();
        for (index, agent) in agents.iter().enumerate() {
            all.extend([&agent.position_m].into_iter().chain(&agent.goals_m).map(|&point_m| (point_m, index)));
        }
        let mut order: Vec<usize> = (0..all.len()).collect();
        let along_m = |slot: usize, axis: usize| f64::from(all[slot].0[axis]);
        let axis = sort_along_longer_side(&mut order, all.iter().map(|(point_m, _)| *point_m), along_m);
        Self { axis, coordinates: order.into_iter().map(|slot| (all[slot].0[axis], all[slot].1)).collect() }
    }

    /// Indices, in order, of the agents that start or have a goal beside a box.
    fn between(&self, low_m: Vec2, high_m: Vec2) -> Vec<usize> {
        let from = self.coordinates.partition_point(|(at_m, _)| *at_m < low_m[self.axis]);
        let to = self.coordinates.partition_point(|(at_m, _)| *at_m <= high_m[self.axis]);
        let mut agents: Vec<usize> = self.coordinates[from..to].iter().map(|(_, agent)| *agent).collect();
        agents.sort_unstable();
        agents.dedup();
        agents
    }
}

fn check_start(index: usize, agent: &AgentSpec, obstacle: usize, polygon_m: &[Vec2]) -> Result<(), ScenarioFault> {
    let overlap_m = f64::from(agent.wall_radius_m) - closest_distance_m(polygon_m, agent.position_m);
    let help = "move it until it is at least `wall_radius_m` from every obstacle";
    let part = ScenarioPart::Journey(index);
    if contains(polygon_m, agent.position_m) {
        part.fault(format!("agent {index} starts inside obstacle {obstacle}"), help)
    } else if overlap_m > TOUCH_M {
        part.fault(format!("agent {index} overlaps obstacle {obstacle} by {overlap_m:.2} m"), help)
    } else {
        Ok(())
    }
}

/// Checks that a disc can come near its last goal, which lies `clear_m` from an obstacle.
fn check_reach(index: usize, agent: &AgentSpec, obstacle: usize, clear_m: f64) -> Result<(), ScenarioFault> {
    let radius_m = f64::from(agent.wall_radius_m);
    if radius_m - clear_m < ARRIVAL_M {
        return Ok(());
    }
    let message = format!(
        "agent {index} with a wall radius of {radius_m:.2} m cannot come within {ARRIVAL_M} m of its goal, which lies {clear_m:.2} m from obstacle {obstacle}"
    );
    ScenarioPart::Journey(index)
        .fault(message, "move the goal away from the obstacle, or set a smaller `wall_radius_m`")
}

fn check_agents_apart(agents: &[AgentSpec]) -> Result<(), ScenarioFault> {
    let low_m = |index: usize, axis: usize| agents[index].position_m[axis] - agents[index].radius_m;
    let mut order: Vec<usize> = (0..agents.len()).collect();
    let positions_m = agents.iter().map(|agent| agent.position_m);
    let axis = sort_along_longer_side(&mut order, positions_m, |index, axis| low_m(index, axis).into());
    for (rank, &a) in order.iter().enumerate() {
        let high_m = agents[a].position_m[axis] + agents[a].radius_m;
        for &b in order[rank + 1..].iter().take_while(|&&b| low_m(b, axis) < high_m) {
            let overlap_m = overlap_m(&agents[a], &agents[b]);
            if overlap_m > TOUCH_M {
                let message = format!("agents {} and {} overlap by {overlap_m:.2} m", a.min(b), a.max(b));
                let help = "start them at least the sum of their radii apart";
                return ScenarioPart::Journey(a.max(b)).fault(message, help);
            }
        }
    }
    Ok(())
}

fn overlap_m(a: &AgentSpec, b: &AgentSpec) -> f64 {
    let distance_m = DVec2::from(a.position_m).distance(DVec2::from(b.position_m));
    f64::from(a.radius_m) + f64::from(b.radius_m) - distance_m
}

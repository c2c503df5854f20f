//! The rules of zones that are closed to some agents: these neither start in them nor have goals there. World, metres.

use glam::Vec2;

use crate::maths::polygon::{closest_distance_m, contains};
use crate::scenario::fault::{ScenarioFault, ScenarioPart};
use crate::scenario::resolved::Scenario;

/// Rounding of positions that are meant to touch, m.
const TOUCH_M: f64 = 1e-4;

/// Checks every agent and source against the zones that are closed to it.
pub(crate) fn check_closed_zones(scenario: &Scenario) -> Result<(), ScenarioFault> {
    let help = "move it out of the zone, or remove its profile from `closed_to`";
    for (index, agent) in scenario.agents.iter().enumerate().filter(|(_, agent)| agent.closed_zones != 0) {
        let part = ScenarioPart::Journey(index);
        for (zone, spec) in scenario.closed_zones(agent.closed_zones) {
            let outline_m = spec.area.outline_m();
            let clear_m = closest_distance_m(&outline_m, agent.position_m);
            if contains(&outline_m, agent.position_m) || f64::from(agent.wall_radius_m) - clear_m > TOUCH_M {
                return part.fault(format!("agent {index} starts in zone {zone}, which is closed to it"), help);
            }
            if let Some(goal_m) = goal_in(&outline_m, &agent.goals_m) {
                let message = format!("the goal {goal_m} of agent {index} lies in zone {zone}, which is closed to it");
                return part.fault(message, help);
            }
        }
    }
    for (index, source) in scenario.sources.iter().enumerate() {
        for set in source.closed_zone_sets() {
            for (zone, spec) in scenario.closed_zones(set) {
                if let Some(goal_m) = goal_in(&spec.area.outline_m(), &source.goals_m) {
                    let closed = "which is closed to its agents";
                    let message = format!("the goal {goal_m} of source {index} lies in zone {zone}, {closed}");
                    return ScenarioPart::Source(index).fault(message, help);
                }
            }
        }
    }
    Ok(())
}

fn goal_in(outline_m: &[Vec2], goals_m: &[Vec2]) -> Option<Vec2> {
    goals_m.iter().copied().find(|goal_m| contains(outline_m, *goal_m))
}

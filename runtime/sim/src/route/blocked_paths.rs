//! Agents that cannot arrive because a wall crosses a straight path between two of their waypoints.
//!
//! Agents walk straight from waypoint to waypoint, so such an agent stops at the wall unless it slips around it. World,
//! metres.

use glam::Vec2;

use crate::population::{AgentId, Population};
use crate::route::arrival::ARRIVAL_M;
use crate::scenario::AgentSpec;
use crate::world::obstacles::Obstacles;

/// Agents with blocked paths that are not at their goals.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct BlockedPaths {
    /// The first such agent.
    pub agent: AgentId,
    /// Index of its first waypoint that lies behind a wall.
    pub waypoint: usize,
    /// Number of such agents.
    pub agents: usize,
}

/// The agents with blocked paths, given the position at which every present agent ended; none where no wall can be the
/// reason.
pub fn blocked_paths(
    population: &Population,
    obstacles_m: &[Vec<Vec2>],
    ends_m: impl Iterator<Item = (AgentId, Vec2)>,
) -> Option<BlockedPaths> {
    let obstacles = Obstacles::new(obstacles_m);
    let mut blocked = ends_m
        .filter(|(id, end_m)| !is_at_goal(population.spec(*id), *end_m))
        .filter_map(|(id, _)| Some((id, blocked_waypoint(population.spec(id), &obstacles)?)));
    let (agent, waypoint) = blocked.next()?;
    Some(BlockedPaths { agent, waypoint, agents: 1 + blocked.count() })
}

fn is_at_goal(agent: &AgentSpec, end_m: Vec2) -> bool {
    agent.goals_m.last().is_none_or(|goal_m| f64::from(goal_m.distance(end_m)) < ARRIVAL_M)
}

/// Index of the first waypoint to which the straight path is blocked.
fn blocked_waypoint(agent: &AgentSpec, obstacles: &Obstacles) -> Option<usize> {
    let from_m = [agent.position_m].into_iter().chain(agent.goals_m.iter().copied());
    let mut paths_m = from_m.zip(&agent.goals_m);
    paths_m.position(|(from_m, &to_m)| !obstacles.is_free(from_m, to_m))
}

#[cfg(test)]
mod tests {
    use glam::Vec2;

    use super::*;
    use crate::scenario::Scenario;
    use crate::simulation::tests::antipodal;

    /// The first blocked agent, its waypoint and the number of blocked agents, where only agent 3 ends at its goal.
    fn check(scenario: &Scenario, expected: Option<[usize; 3]>) {
        let ends_m = scenario.agents.iter().enumerate().map(|(index, agent)| match index {
            3 => (index.into(), agent.goals_m[agent.goals_m.len() - 1]),
            _ => (index.into(), agent.position_m),
        });
        let found = blocked_paths(&Population::of(scenario), &scenario.obstacles_m, ends_m);
        assert_eq!(found.map(|BlockedPaths { agent, waypoint, agents }| [agent.index(), waypoint, agents]), expected);
    }

    #[test]
    fn walls_across_straight_paths_are_found() {
        let mut scenario = antipodal(6, 4.0);
        check(&scenario, None);
        // Across the path of every agent.
        scenario.obstacles_m = vec![[(-0.5, -0.5), (0.5, -0.5), (0.5, 0.5), (-0.5, 0.5)].map(Vec2::from).to_vec()];
        check(&scenario, Some([0, 0, 5]));
        scenario.agents[0].goals_m.insert(0, Vec2::new(0.0, 2.0));
        check(&scenario, Some([1, 0, 4]));
        scenario.agents[1].goals_m = vec![Vec2::new(2.0, 0.0), Vec2::new(-2.0, 0.0)];
        check(&scenario, Some([1, 1, 4]));
    }
}

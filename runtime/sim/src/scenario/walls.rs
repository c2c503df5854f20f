//! The walls of a scenario, for discs that they hold and for routes between them. World, metres.

use glam::Vec2;

use crate::behaviour::Area;
use crate::route::mesh::{Ground, walkable_contours_m};
use crate::scenario::resolved::Scenario;
use crate::world::obstacles::Obstacles;

impl Scenario {
    /// The walls that hold discs: obstacles, enclosures, and the edges of the walkable ground.
    pub fn walls(&self) -> Obstacles {
        Obstacles::with_ground(&self.obstacles_m, &self.enclosures_m, &self.ground_lines_m())
    }

    /// Whether there are no walls: the ground is open everywhere.
    pub fn is_open(&self) -> bool {
        self.obstacles_m.is_empty() && self.enclosures_m.is_empty() && self.walkable_m.is_empty()
    }

    /// Starts, goals and corners of areas, which open ground must contain, m.
    pub(crate) fn points_m(&self) -> Vec<Vec2> {
        let agents = self.agents.iter().flat_map(|agent| [agent.position_m].into_iter().chain(agent.goals_m.clone()));
        let sources = self.sources.iter().flat_map(|source| {
            let corners_m = [source.low_m, source.high_m];
            let own_m =
                source.goal_offset_m.into_iter().flat_map(move |offset_m| corners_m.map(|at_m| at_m + offset_m));
            corners_m.into_iter().chain(source.goals_m.clone()).chain(own_m)
        });
        let sets = self.behaviour.goals.iter().flat_map(|set| &set.areas).flat_map(|goal| goal.area.bounds_m());
        let teleports = self.behaviour.states.iter().filter_map(|state| state.settings.teleport.as_ref());
        agents.chain(sources).chain(sets).chain(teleports.flat_map(Area::bounds_m)).collect()
    }

    /// The ground that routes lead over.
    pub(crate) fn ground<'a>(&'a self, points_m: &'a [Vec2]) -> Ground<'a> {
        Ground {
            obstacles_m: &self.obstacles_m,
            enclosures_m: &self.enclosures_m,
            walkable_m: &self.walkable_m,
            points_m,
        }
    }

    /// Corners of all walls of the scene, for pictures, m.
    pub fn corners_m(&self) -> impl Iterator<Item = Vec2> + '_ {
        let walkable = self.walkable_m.iter().flat_map(|polygon| &polygon.outline_m);
        self.obstacles_m.iter().chain(&self.enclosures_m).flatten().chain(walkable).copied()
    }

    /// Closed lines around the walkable ground and its holes, m; none where the ground is open.
    pub fn ground_lines_m(&self) -> Vec<Vec<Vec2>> {
        // Coordinates are in range in every checked scenario.
        walkable_contours_m(&self.walkable_m).unwrap_or_default()
    }

    /// Areas of the sets of goals, for pictures.
    pub fn goal_areas(&self) -> impl Iterator<Item = &Area> {
        self.behaviour.goals.iter().flat_map(|set| &set.areas).map(|goal| &goal.area)
    }
}

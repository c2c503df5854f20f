//! The walls of a scenario, for discs that they hold and for routes between them. World, metres.

use std::borrow::Cow;

use glam::Vec2;

use crate::behaviour::Area;
use crate::route::mesh::{Ground, walkable_contours_m};
use crate::scenario::resolved::Scenario;
use crate::world::obstacles::Obstacles;

impl Scenario {
    /// The walls that hold discs, with all doors open: obstacles, enclosures, and the edges of the walkable ground.
    pub fn walls(&self) -> Obstacles {
        self.walls_with(&[])
    }

    /// As [`walls`](Self::walls), with the doors that are closed, by index.
    pub fn walls_with(&self, closed: &[bool]) -> Obstacles {
        // Coordinates are in range in every checked scenario.
        let contours_m = walkable_contours_m(&self.walkable_m).unwrap_or_default();
        Obstacles::with_ground(&self.solids_m(closed), &self.enclosures_m, &contours_m)
    }

    /// The obstacles, and the doors that are closed, by index, m.
    pub(crate) fn solids_m(&self, closed: &[bool]) -> Cow<'_, [Vec<Vec2>]> {
        if !closed.contains(&true) {
            return Cow::Borrowed(&self.obstacles_m);
        }
        Cow::Owned(self.obstacles_m.iter().cloned().chain(self.doors_m(closed)).collect())
    }

    /// The polygons of the doors that are closed, by index, m.
    pub(crate) fn doors_m<'a>(&'a self, closed: &'a [bool]) -> impl Iterator<Item = Vec<Vec2>> + 'a {
        self.doors.iter().zip(closed).filter(|(_, is_closed)| **is_closed).map(|(door, _)| door.polygon_m.clone())
    }

    /// Whether each door is closed at 0 s.
    pub fn doors_closed_at_start(&self) -> Vec<bool> {
        self.doors.iter().map(|door| !self.behaviour.is_green(door.signal as usize, 0.0)).collect()
    }

    /// Whether there are no walls: the ground is open everywhere and always.
    pub fn is_open(&self) -> bool {
        let has_walls = !self.obstacles_m.is_empty() || !self.enclosures_m.is_empty() || !self.walkable_m.is_empty();
        !has_walls && self.doors.is_empty()
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
        let doors = self.doors.iter().flat_map(|door| door.polygon_m.clone());
        agents.chain(sources).chain(sets).chain(teleports.flat_map(Area::bounds_m)).chain(doors).collect()
    }

    /// The ground that routes lead over, between these obstacles.
    pub(crate) fn ground<'a>(&'a self, obstacles_m: &'a [Vec<Vec2>], points_m: &'a [Vec2]) -> Ground<'a> {
        Ground { obstacles_m, enclosures_m: &self.enclosures_m, walkable_m: &self.walkable_m, points_m }
    }

    /// Corners of all polygons of the scene, for pictures, m.
    pub fn corners_m(&self) -> impl Iterator<Item = Vec2> + '_ {
        let walkable = self.walkable_m.iter().flat_map(|polygon| &polygon.outline_m);
        let doors = self.doors.iter().flat_map(|door| &door.polygon_m);
        self.obstacles_m.iter().chain(&self.enclosures_m).flatten().chain(walkable).chain(doors).copied()
    }

    /// Closed lines of the walls that are no obstacle: enclosures and the edges of the walkable ground, m.
    pub fn wall_lines_m(&self) -> Vec<Vec<Vec2>> {
        [self.enclosures_m.clone(), walkable_contours_m(&self.walkable_m).unwrap_or_default()].concat()
    }
}

//! The walls of a scenario, for discs that they hold and for routes between them. World, metres.

use std::borrow::Cow;

use glam::Vec2;

use crate::behaviour::Area;
use crate::route::mesh::{Ground, walkable_contours_m};
use crate::scenario::places::state_zones::StateZones;
use crate::scenario::places::zone_spec::ZoneSpec;
use crate::scenario::resolved::Scenario;
use crate::scenario::source_spec::SourceSpec;
use crate::world::obstacles::{Obstacles, ZoneWalls};
use crate::world::one_way::OneWayZone;

/// Rows and columns of the positions of an area that are compared with closed zones.
const BARRED_LATTICE: u16 = 16;

impl Scenario {
    /// The walls that hold discs, with all doors open: obstacles, enclosures, and the edges of the walkable ground.
    pub fn walls(&self) -> Obstacles {
        self.walls_with(&[])
    }

    /// As [`walls`](Self::walls), with the doors that are closed, by index.
    pub fn walls_with(&self, closed: &[bool]) -> Obstacles {
        self.walls_of(closed, 0)
    }

    /// As [`walls_with`](Self::walls_with), for agents that do not enter some zones, by bits.
    pub(crate) fn walls_of(&self, closed: &[bool], closed_zones: u32) -> Obstacles {
        // Coordinates are in range in every checked scenario.
        let contours_m = walkable_contours_m(&self.walkable_m).unwrap_or_default();
        Obstacles::with_ground(&self.solids_m(closed, closed_zones), &self.enclosures_m, &contours_m)
    }

    /// The walls of agents that do not enter some zones, with the doors that are closed, by index.
    pub fn zone_walls(&self, closed: &[bool]) -> ZoneWalls {
        let state_zones = StateZones::new(self);
        let mut sets: Vec<u32> = self.own_zone_sets().flat_map(|own| state_zones.wall_sets(own)).collect();
        sets.sort_unstable();
        sets.dedup();
        sets.retain(|set| *set != 0);
        ZoneWalls { sets: sets.into_iter().map(|set| (set, self.walls_of(closed, set))).collect() }
    }

    /// The obstacles, the doors that are closed, by index, and the zones that agents do not enter, by bits, m.
    pub(crate) fn solids_m(&self, closed: &[bool], closed_zones: u32) -> Cow<'_, [Vec<Vec2>]> {
        if !closed.contains(&true) && closed_zones == 0 {
            return Cow::Borrowed(&self.obstacles_m);
        }
        let zones_m = self.closed_zones(closed_zones).map(|(_, zone)| zone.area.outline_m());
        Cow::Owned(self.obstacles_m.iter().cloned().chain(self.doors_m(closed)).chain(zones_m).collect())
    }

    /// The zones that agents do not enter, by bits, with their indices.
    pub(crate) fn closed_zones(&self, closed_zones: u32) -> impl Iterator<Item = (usize, &ZoneSpec)> {
        let closed = self.zones.iter().enumerate().filter(|(_, zone)| zone.is_closed).zip(0..u32::BITS);
        closed.filter(move |(_, bit)| closed_zones >> bit & 1 == 1).map(|(zone, _)| zone)
    }

    /// Whether an area lies wholly in zones that agents do not enter, by bits.
    pub(crate) fn is_barred(&self, area: &Area, closed_zones: u32) -> bool {
        closed_zones != 0
            && area
                .lattice_m(BARRED_LATTICE)
                .all(|at_m| self.closed_zones(closed_zones).any(|(_, zone)| zone.area.holds(at_m)))
    }

    /// The sets of zones that some agents do not enter, by bits, each once, rising.
    pub(crate) fn closed_zone_sets(&self) -> Vec<u32> {
        let state_zones = StateZones::new(self);
        let mut sets: Vec<u32> = self.own_zone_sets().flat_map(|own| state_zones.route_sets(own)).collect();
        sets.sort_unstable();
        sets.dedup();
        sets.retain(|set| *set != 0);
        sets
    }

    /// The zones that each agent and source keeps out of in all states, by bits.
    pub(crate) fn own_zone_sets(&self) -> impl Iterator<Item = u32> + '_ {
        let sources = self.sources.iter().flat_map(SourceSpec::closed_zone_sets);
        let mut sets: Vec<u32> = self.agents.iter().map(|agent| agent.closed_zones).chain(sources).collect();
        sets.sort_unstable();
        sets.dedup();
        sets.into_iter()
    }

    /// The polygons of the doors that are closed, by index, m.
    pub(crate) fn doors_m<'a>(&'a self, closed: &'a [bool]) -> impl Iterator<Item = Vec<Vec2>> + 'a {
        self.doors.iter().zip(closed).filter(|(_, is_closed)| **is_closed).map(|(door, _)| door.polygon_m.clone())
    }

    /// Whether each door is closed at 0 s.
    pub fn doors_closed_at_start(&self) -> Vec<bool> {
        self.doors.iter().map(|door| !self.behaviour.is_green(door.signal as usize, 0.0)).collect()
    }

    /// The zones through which agents move one way.
    pub fn one_way_zones(&self) -> Vec<OneWayZone> {
        self.zones.iter().filter_map(ZoneSpec::one_way).collect()
    }

    /// Whether there are no walls and no one-way zones: the ground is open everywhere and always.
    pub fn is_open(&self) -> bool {
        let has_walls = !self.obstacles_m.is_empty() || !self.enclosures_m.is_empty() || !self.walkable_m.is_empty();
        !has_walls
            && self.doors.is_empty()
            && !self.zones.iter().any(|zone| zone.is_closed || zone.one_way_deg.is_some())
    }

    /// Whether there are neither agents nor sources: a ground alone.
    pub fn is_plan(&self) -> bool {
        self.agents.is_empty() && self.sources.is_empty()
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
        let zones = self.zones.iter().filter(|zone| zone.is_closed).flat_map(|zone| zone.area.bounds_m());
        let doors = doors.chain(zones);
        agents.chain(sources).chain(sets).chain(teleports.flat_map(Area::bounds_m)).chain(doors).collect()
    }

    /// The ground that routes lead over, between these obstacles.
    pub(crate) fn ground<'a>(
        &'a self,
        obstacles_m: &'a [Vec<Vec2>],
        points_m: &'a [Vec2],
        one_way: &'a [OneWayZone],
    ) -> Ground<'a> {
        Ground { obstacles_m, enclosures_m: &self.enclosures_m, walkable_m: &self.walkable_m, points_m, one_way }
    }

    /// Corners of all walls and one-way zones of the scene, for pictures, m.
    pub fn corners_m(&self) -> impl Iterator<Item = Vec2> + '_ {
        let walkable = self.walkable_m.iter().flat_map(|polygon| &polygon.outline_m);
        let doors = self.doors.iter().flat_map(|door| &door.polygon_m);
        let zones = self.one_way_zones().into_iter().flat_map(|zone| zone.corners_m);
        self.obstacles_m.iter().chain(&self.enclosures_m).flatten().chain(walkable).chain(doors).copied().chain(zones)
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

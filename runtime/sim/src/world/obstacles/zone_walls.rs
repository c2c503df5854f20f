//! The walls of agents that do not enter some zones: for each set of such zones the walls of the scene, and the zones.

use crate::world::obstacles::polygons::Obstacles;

/// The walls for each set of zones that some agents do not enter.
#[derive(Clone, Debug, Default)]
pub struct ZoneWalls {
    /// A set of zones, by bits, and its walls.
    pub sets: Vec<(u32, Obstacles)>,
}

impl ZoneWalls {
    /// The walls of an agent that does not enter these zones, by bits; none of one that enters all, and of a set that
    /// there is not.
    pub fn of(&self, closed_zones: u32) -> Option<&Obstacles> {
        self.sets.iter().find(|(set, _)| *set == closed_zones).map(|(_, walls)| walls)
    }
}

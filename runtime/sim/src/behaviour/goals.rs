//! Goals: named sets of areas from which agents choose. World, metres, radians.

use serde::{Deserialize, Serialize};

use crate::behaviour::area::Area;

/// A set of areas from which an agent chooses one.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct GoalSet {
    /// Name of the set.
    pub name: String,
    /// The areas, in the order of the file.
    pub areas: Vec<GoalArea>,
    /// Whether the areas are the places of a queue, its head first.
    pub queue: bool,
}

/// One area of a set.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct GoalArea {
    /// Where it lies.
    pub area: Area,
    /// Facing of agents that stand there, world, rad; none: as they arrive.
    pub facing_rad: Option<f32>,
    /// Greatest number of agents that go or stand there; none: any number.
    pub capacity: Option<u32>,
    /// Weight of the area where an agent draws one by weight.
    pub weight: f32,
}

impl GoalSet {
    /// Greatest number of agents that an area takes; the place of a queue takes one.
    pub fn capacity(&self, area: usize) -> u32 {
        if self.queue { 1 } else { self.areas[area].capacity.unwrap_or(u32::MAX) }
    }
}

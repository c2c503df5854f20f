//! The ground that routes lead over, as a scene gives it: obstacles and walkable polygons. World, metres.

use glam::Vec2;
use serde::{Deserialize, Serialize};

use crate::world::one_way::OneWayZone;

/// The ground of a scene.
#[derive(Clone, Copy, Debug, Default)]
pub struct Ground<'a> {
    /// Obstacles: polygons in either direction, which may overlap, touch, or lie within each other. Repeated corners,
    /// walls without thickness and self-crossing outlines are permitted; such an outline is solid wherever it winds.
    pub obstacles_m: &'a [Vec<Vec2>],
    /// Simple polygons with a wall without thickness around each.
    pub enclosures_m: &'a [Vec<Vec2>],
    /// Polygons on which agents can walk, united. None: the ground is open.
    pub walkable_m: &'a [WalkablePolygon],
    /// Positions that open ground must contain: starts and goals of the agents.
    pub points_m: &'a [Vec2],
    /// One-way zones: routes keep their distance from the sides along the heading as from walls.
    pub one_way: &'a [OneWayZone],
}

/// A polygon on which agents can walk.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct WalkablePolygon {
    /// The outer corners, in either direction, m.
    pub outline_m: Vec<Vec2>,
    /// The corners of each hole, in either direction, m.
    pub holes_m: Vec<Vec<Vec2>>,
}

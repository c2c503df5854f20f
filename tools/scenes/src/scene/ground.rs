//! The ground of a scene: walkable polygons, obstacles and measured areas. World, metres.

use crate::scene::shape::{Point, Shape};

/// A polygon on which agents walk, with holes; all of a scene are united.
#[derive(Clone, Debug, PartialEq)]
pub struct Walkable {
    /// The outline.
    pub polygon_m: Vec<Point>,
    /// Outlines of its holes.
    pub holes_m: Vec<Vec<Point>>,
    /// Position in the source, "file:line" or a name.
    pub origin: String,
}

/// Ground that agents do not enter in some states: a simple polygon.
#[derive(Clone, Debug, PartialEq)]
pub struct ClosedZone {
    /// Its corners in order.
    pub polygon_m: Vec<Point>,
    /// Names of the states.
    pub states: Vec<String>,
    /// Position in the source, "file:line"; empty where it is that of the zone before.
    pub origin: String,
}

/// An area in which the density of agents is measured.
#[derive(Clone, Debug, PartialEq)]
pub struct SceneMeasure {
    /// Its name.
    pub name: String,
    /// Where it lies: not a point.
    pub shape: Shape,
    /// Position in the source, "file:line" or a name.
    pub origin: String,
}

/// An obstacle: a simple polygon.
#[derive(Clone, Debug, PartialEq)]
pub struct SceneObstacle {
    /// Its corners in order.
    pub polygon_m: Vec<Point>,
    /// Whether it is a wall around the agents, and its inside is free.
    pub is_enclosure: bool,
    /// Position in the source, "file:line" or a name; empty where it is that of the obstacle before.
    pub origin: String,
}

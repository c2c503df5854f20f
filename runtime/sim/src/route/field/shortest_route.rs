//! One shortest route between two positions, for goals that few agents share: the search of a field with a target.
//!
//! World, metres.

use glam::{DVec2, Vec2};

use crate::route::field::flood::{Flood, FloodSource};
use crate::route::mesh::RouteMesh;
use crate::route::mesh::triangulation::NONE;

/// A shortest route.
#[derive(Clone, Debug, PartialEq)]
pub struct ShortestRoute {
    /// Its length, m.
    pub length_m: f32,
    /// The corners at which it turns and its end, in order, m.
    pub corners_m: Vec<Vec2>,
}

/// The shortest route between two positions. An end off the mesh counts as its nearest point of the mesh. None where no
/// route leads from one to the other.
pub fn shortest_route(mesh: &RouteMesh, from_m: Vec2, to_m: Vec2) -> Option<ShortestRoute> {
    let [from, to] = [from_m, to_m].map(|point_m| mesh.nearest(DVec2::from(point_m), None, None));
    let (from, to) = (from?, to?);
    if !mesh.leads(from.triangle, to.triangle) {
        return None;
    }
    let sources = [FloodSource { at: to, distance_m: 0.0 }];
    let flood = Flood::run(mesh, &sources, Some(from));
    if flood.target_root == NONE {
        return None;
    }
    let parent = |&root: &u32| Some(flood.labels[root as usize].parent).filter(|&parent| parent != NONE);
    let corners = std::iter::successors(Some(flood.target_root), parent);
    let corners_m = corners.map(|root| flood.point_m(root).as_vec2()).collect();
    Some(ShortestRoute { length_m: flood.target_m as f32, corners_m })
}

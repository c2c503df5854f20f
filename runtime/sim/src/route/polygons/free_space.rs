//! Free space: the ground on which an agent's centre keeps a distance from all walls.
//!
//! The walkable polygons, or the box of open ground, minus the grown obstacles, united on the grid. The edges of
//! walkable polygons are walls too; the edge of open ground is none.
//!
//! **Open ground** ends [`MARGIN_M`] beyond all obstacles and points. A shortest path stays within the convex hull of
//! its ends and of the grown obstacles that it rounds, so no shortest path between points of the box touches its edge.

use glam::{DVec2, Vec2};

use crate::route::polygons::error::RouteError;
use crate::route::polygons::grid::{Contour, GridPoint, LINES_PER_M, grid_point, metres, rounded};
use crate::route::polygons::ground::{Ground, WalkablePolygon};
use crate::route::polygons::growth::{add_bands_and_fans, grow};
use crate::route::polygons::outline::Outline;
use crate::route::polygons::union::{Shape, difference, few, shift_lines, united};
use crate::world::one_way::OneWayZone;

/// Width of open ground beyond all obstacles and points, m: farther than a crowd pushes an agent outside.
pub(crate) const MARGIN_M: f64 = 50.0;
/// Distance that is kept in addition to the wall radius, m: rounding to the grid takes up to 2 mm of it.
pub(crate) const GRID_ALLOWANCE_M: f64 = 3e-3;
/// Half the thickness of walls without one, where gaps beside them are sought, grid lines.
const THIN_WALL_LINES: f64 = 2.0;
/// Distances that routes can keep from walls, m.
const WALL_RADIUS_M: std::ops::RangeInclusive<f32> = 0.0..=10.0;

/// Where the centre of an agent that keeps its distance from walls can be.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct FreeSpace {
    /// Contours on the grid; the space lies to the left of each.
    pub(crate) contours: Vec<Contour>,
}

impl FreeSpace {
    /// The space at a distance from all walls.
    ///
    /// # Errors
    /// If a coordinate or the distance is out of range, or the walls cross too often.
    pub fn new(ground: &Ground, wall_radius_m: f32) -> Result<Self, RouteError> {
        if !WALL_RADIUS_M.contains(&wall_radius_m) {
            return Err(RouteError::WallRadius { wall_radius_m });
        }
        let distance = LINES_PER_M * (f64::from(wall_radius_m) + GRID_ALLOWANCE_M);
        let edges = united_walkable(ground.walkable_m)?;
        let mut walls = grown_walls(ground, &edges, distance)?;
        let shift = shift_lines(&walls);
        if shift > 0.0 {
            walls = grown_walls(ground, &edges, distance + shift)?;
        }
        let walkable = if ground.walkable_m.is_empty() { vec![open_ground(ground, distance)?] } else { edges };
        Ok(Self { contours: difference(vec![walkable], walls)? })
    }

    /// The ground between the walls, without a distance from them. Walls without thickness get one of 4 mm.
    ///
    /// # Errors
    /// If a coordinate is out of range, or the walls cross too often.
    pub(crate) fn between_walls(ground: &Ground) -> Result<Self, RouteError> {
        let solid = |outline: Outline| outline.convex.into_iter().chain(outline.contours).collect();
        let mut walls: Vec<Shape> = outlines(ground)?.into_iter().map(solid).collect();
        thin_walls(ground)?.iter().for_each(|outline| grow(outline, THIN_WALL_LINES, &mut walls));
        let is_open = ground.walkable_m.is_empty();
        let walkable = if is_open { vec![open_ground(ground, 0.0)?] } else { united_walkable(ground.walkable_m)? };
        Ok(Self { contours: difference(vec![walkable], walls)? })
    }

    /// The contours, m.
    pub(crate) fn contours_m(&self) -> Vec<Vec<DVec2>> {
        let in_metres = |contour: &Contour| contour.iter().map(|corner| metres(*corner)).collect();
        self.contours.iter().map(in_metres).collect()
    }
}

/// The contours of the union of walkable polygons, with the ground on the left, m.
///
/// # Errors
/// If a coordinate is out of range.
pub fn walkable_contours_m(polygons: &[WalkablePolygon]) -> Result<Vec<Vec<Vec2>>, RouteError> {
    let contours = united_walkable(polygons)?;
    let in_metres = |contour: &Contour| contour.iter().map(|corner| metres(*corner).as_vec2()).collect();
    Ok(contours.iter().map(in_metres).collect())
}

fn united_walkable(polygons: &[WalkablePolygon]) -> Result<Shape, RouteError> {
    let polygons = polygons.iter().map(without_holes).collect::<Result<Vec<_>, _>>()?;
    Ok(united(few(polygons)?.iter().flatten()))
}

/// The shapes in whose union no agent's centre can be; `edges` are those of the walkable ground.
fn grown_walls(ground: &Ground, edges: &Shape, distance: f64) -> Result<Vec<Shape>, RouteError> {
    let mut walls = Vec::new();
    // Seen from outside, the ground beyond a walkable polygon is an obstacle.
    let reversed = |contour: &Contour| contour.iter().rev().copied().collect();
    edges.iter().for_each(|contour| add_bands_and_fans(&reversed(contour), distance, &mut walls));
    let outlines = outlines(ground)?.into_iter().chain(thin_walls(ground)?);
    outlines.for_each(|outline| grow(&outline, distance, &mut walls));
    Ok(walls)
}

fn outlines(ground: &Ground) -> Result<Vec<Outline>, RouteError> {
    ground.obstacles_m.iter().map(|polygon_m| Outline::new(polygon_m)).collect()
}

/// Walls without thickness: enclosures, and the sides of one-way zones.
fn thin_walls(ground: &Ground) -> Result<Vec<Outline>, RouteError> {
    let enclosures = ground.enclosures_m.iter().map(|polygon_m| Outline::wall_around(polygon_m));
    let sides = ground.one_way.iter().flat_map(OneWayZone::sides_m).map(|side_m| Outline::new(&side_m));
    enclosures.chain(sides).collect()
}

fn without_holes(polygon: &WalkablePolygon) -> Result<Shape, RouteError> {
    let contours = |corners_m| {
        let outline = Outline::new(corners_m)?;
        Ok(outline.convex.into_iter().chain(outline.contours).collect::<Vec<_>>())
    };
    let holes = polygon.holes_m.iter().map(|hole_m| contours(hole_m)).collect::<Result<Vec<_>, _>>()?;
    difference(vec![contours(&polygon.outline_m)?], holes)
}

/// The box of open ground, counter-clockwise.
fn open_ground(ground: &Ground, distance: f64) -> Result<Contour, RouteError> {
    let points = ground
        .obstacles_m
        .iter()
        .chain(ground.enclosures_m)
        .flatten()
        .chain(ground.points_m)
        .chain(ground.one_way.iter().flat_map(|zone| &zone.corners_m))
        .map(|point_m| grid_point(*point_m));
    let points = points.collect::<Result<Vec<_>, _>>()?;
    let bound = |of: fn(&GridPoint) -> i32, better: fn(i32, i32) -> i32| {
        f64::from(points.iter().map(of).reduce(better).unwrap_or_default())
    };
    let margin = MARGIN_M * LINES_PER_M + 2.0 * distance;
    let low = DVec2::new(bound(|point| point.x, i32::min), bound(|point| point.y, i32::min)) - margin;
    let high = DVec2::new(bound(|point| point.x, i32::max), bound(|point| point.y, i32::max)) + margin;
    Ok([low, DVec2::new(high.x, low.y), high, DVec2::new(low.x, high.y)].map(rounded).to_vec())
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::maths::polygon::{closest_distance_m, contains};

    #[test]
    fn walls_of_many_corners_keep_the_distance_and_take_no_more() {
        let star = |x_m: f32| {
            let corner = move |index: u32| {
                let (angle, radius_m) = (index as f32 * std::f32::consts::TAU / 1e3, 1.0 - 0.1 * (index % 2) as f32);
                Vec2::new(x_m, 0.0) + radius_m * Vec2::from(libm::sincosf(angle)).perp()
            };
            (0..1_000).map(corner).collect::<Vec<_>>()
        };
        let obstacles_m = [star(0.0), star(0.3), star(3.0)];
        let ground = Ground { obstacles_m: &obstacles_m, ..Ground::default() };
        let walls = grown_walls(&ground, &Shape::new(), 205.0).expect("small numbers");
        assert!(shift_lines(&walls) > 5.0);
        let free_m = FreeSpace::new(&ground, 0.2).expect("small numbers").contours_m();
        assert!(free_m.len() < 6, "{}", free_m.len());
        for (x, y) in (-40..110).flat_map(|x| (-40..40).map(move |y| (x, y))) {
            let point_m = Vec2::new(x as f32, y as f32) * 0.04 + 0.000_7;
            let distance_m = obstacles_m.iter().map(|corners_m| match contains(corners_m, point_m) {
                true => 0.0,
                false => closest_distance_m(corners_m, point_m),
            });
            let distance_m = distance_m.fold(f64::INFINITY, f64::min);
            let inside = |contour_m: &&Vec<DVec2>| {
                contains(&contour_m.iter().map(|at_m| at_m.as_vec2()).collect::<Vec<_>>(), point_m)
            };
            let is_free = free_m.iter().filter(inside).count() % 2 == 1;
            assert!(!is_free || distance_m > 0.2, "{point_m} {distance_m}");
            // The fans reach 8 % beyond the radius, and the allowances 15 mm.
            assert!(is_free || distance_m < 0.232, "{point_m} {distance_m}");
        }
    }
}

//! Free space: the ground on which an agent's centre keeps a distance from all walls.
//!
//! The walkable polygons, or the box of open ground, minus the grown obstacles, united on the grid. The edges of
//! walkable polygons are walls too; the edge of open ground is none.
//!
//! **Open ground** ends [`MARGIN_M`] beyond all obstacles and points. A shortest path stays within the convex hull of
//! its ends and of the grown obstacles that it rounds, so no shortest path between points of the box touches its edge.

use glam::{DVec2, Vec2};
use i_overlay::core::fill_rule::FillRule;
use i_overlay::core::overlay::{Overlay, ShapeType};
use i_overlay::core::overlay_rule::OverlayRule;

use crate::route::mesh::error::RouteError;
use crate::route::mesh::grid::{GridPoint, LINES_PER_M, grid_point, metres, rounded};
use crate::route::mesh::ground::{Ground, WalkablePolygon};
use crate::route::mesh::growth::{add_bands_and_fans, grow};
use crate::route::mesh::outline::{Contour, Outline, united};
use crate::world::one_way::OneWayZone;

/// Width of open ground beyond all obstacles and points, m: farther than a crowd pushes an agent outside.
pub(crate) const MARGIN_M: f64 = 50.0;
/// Distance that is kept in addition to the wall radius, m: rounding to the grid takes up to 2 mm of it.
pub(crate) const GRID_ALLOWANCE_M: f64 = 3e-3;
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
    /// If a coordinate or the distance is out of range.
    pub fn new(ground: &Ground, wall_radius_m: f32) -> Result<Self, RouteError> {
        if !WALL_RADIUS_M.contains(&wall_radius_m) {
            return Err(RouteError::WallRadius { wall_radius_m });
        }
        let distance = LINES_PER_M * (f64::from(wall_radius_m) + GRID_ALLOWANCE_M);
        let (outlines, walkable) = (outlines(ground)?, walkable(ground, distance)?);
        let mut walls = Vec::new();
        if !ground.walkable_m.is_empty() {
            // Seen from outside, the ground beyond a walkable polygon is an obstacle.
            let reversed = |contour: &Contour| contour.iter().rev().copied().collect();
            walkable.iter().for_each(|contour| add_bands_and_fans(&reversed(contour), distance, &mut walls));
        }
        outlines.iter().for_each(|outline| grow(outline, distance, &mut walls));
        for polygon_m in ground.enclosures_m {
            grow(&Outline::wall_around(polygon_m)?, distance, &mut walls);
        }
        for side_m in ground.one_way.iter().flat_map(OneWayZone::sides_m) {
            grow(&Outline::new(&side_m)?, distance, &mut walls);
        }
        Ok(Self { contours: difference(&walkable, &walls) })
    }

    /// The ground between the walls, without a distance from them.
    ///
    /// # Errors
    /// If a coordinate is out of range.
    pub(crate) fn between_walls(ground: &Ground) -> Result<Self, RouteError> {
        let solids = |outline: Outline| outline.convex.into_iter().chain(outline.contours);
        let solids: Vec<Contour> = outlines(ground)?.into_iter().flat_map(solids).collect();
        Ok(Self { contours: difference(&walkable(ground, 0.0)?, &solids) })
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

fn united_walkable(polygons: &[WalkablePolygon]) -> Result<Vec<Contour>, RouteError> {
    let polygons = polygons.iter().map(without_holes).collect::<Result<Vec<_>, _>>()?;
    Ok(united(&polygons.iter().flatten().collect::<Vec<_>>(), FillRule::NonZero))
}

fn outlines(ground: &Ground) -> Result<Vec<Outline>, RouteError> {
    ground.obstacles_m.iter().map(|polygon_m| Outline::new(polygon_m)).collect()
}

/// The contours of the walkable polygons, or of the box of open ground.
fn walkable(ground: &Ground, distance: f64) -> Result<Vec<Contour>, RouteError> {
    if ground.walkable_m.is_empty() {
        return Ok(vec![open_ground(ground, distance)?]);
    }
    united_walkable(ground.walkable_m)
}

fn without_holes(polygon: &WalkablePolygon) -> Result<Vec<Contour>, RouteError> {
    let contours = |corners_m| {
        let outline = Outline::new(corners_m)?;
        Ok(outline.convex.into_iter().chain(outline.contours).collect::<Vec<_>>())
    };
    let holes = polygon.holes_m.iter().map(|hole_m| contours(hole_m)).collect::<Result<Vec<_>, _>>()?;
    Ok(difference(&contours(&polygon.outline_m)?, &holes.concat()))
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

/// The contours of one union minus another.
fn difference(ground: &[Contour], walls: &[Contour]) -> Vec<Contour> {
    let mut overlay = Overlay::<i32>::new(ground.iter().chain(walls).map(Vec::len).sum());
    for contour in ground {
        overlay.add_contour(contour, ShapeType::Subject);
    }
    for contour in walls {
        overlay.add_contour(contour, ShapeType::Clip);
    }
    overlay.overlay(OverlayRule::Difference, FillRule::NonZero).into_iter().flatten().collect()
}

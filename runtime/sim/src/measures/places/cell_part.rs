//! The part of a Voronoi cell that its agent reaches without crossing a wall, as PedPy cuts cells by the walkable area:
//! the cell less all walls, and of what remains the piece that holds the agent. World, metres.
//!
//! 1. Walls near the cell are cut to a square about the agent; ground that is not walkable is a solid.
//! 2. On a grid about the agent, solids are taken from the cell (`i_overlay`); pillars within the cell become holes.

use glam::{DVec2, Vec2};
use i_overlay::core::fill_rule::FillRule;
use i_overlay::core::overlay::{Overlay, ShapeType};
use i_overlay::core::overlay_rule::OverlayRule;
use i_overlay::i_float::int::point::IntPoint;

use crate::maths::polygon::{contains, signed_area_m2};
use crate::measures::places::voronoi_cell::CELL_RADIUS_M;
use crate::scenario::Scenario;

/// Lines of the grid per metre: a micrometre.
const LINES_PER_M: f64 = 1_048_576.0;
/// Half the side of the square about an agent that holds its cell, m.
const SQUARE_M: f64 = 1.1 * CELL_RADIUS_M as f64;

/// A closed polyline on the grid about an agent.
type CellContour = Vec<IntPoint<i32>>;

/// The walls that cut cells.
#[derive(Clone, Debug, Default)]
pub(crate) struct CellWalls {
    /// Obstacles and closed doors.
    solids: Vec<WallPolygon>,
    /// Walls without thickness around polygons.
    enclosures: Vec<WallPolygon>,
    /// Outlines of the walkable ground, clockwise those of holes; none where the ground is open.
    ground: Vec<WallPolygon>,
}

/// A polygon and its box.
#[derive(Clone, Debug)]
struct WallPolygon {
    corners_m: Vec<Vec2>,
    low_m: Vec2,
    high_m: Vec2,
}

impl WallPolygon {
    fn new(corners_m: Vec<Vec2>) -> Self {
        let low_m = corners_m.iter().copied().fold(Vec2::INFINITY, Vec2::min);
        let high_m = corners_m.iter().copied().fold(Vec2::NEG_INFINITY, Vec2::max);
        Self { corners_m, low_m, high_m }
    }

    /// As [`new`](Self::new), counter-clockwise.
    fn solid(mut corners_m: Vec<Vec2>) -> Self {
        if signed_area_m2(&corners_m) < 0.0 {
            corners_m.reverse();
        }
        Self::new(corners_m)
    }

    fn is_near(&self, position_m: Vec2) -> bool {
        let reach_m = SQUARE_M as f32;
        position_m.cmpge(self.low_m - reach_m).all() && position_m.cmple(self.high_m + reach_m).all()
    }

    /// The part in the square about an agent, on the grid.
    fn contour(&self, position_m: Vec2) -> CellContour {
        let from_agent = |corner_m: &Vec2| DVec2::from(*corner_m) - DVec2::from(position_m);
        let mut corners: Vec<DVec2> = self.corners_m.iter().map(from_agent).collect();
        for outwards in [DVec2::X, DVec2::Y, DVec2::NEG_X, DVec2::NEG_Y] {
            corners = cut(&corners, outwards, SQUARE_M);
        }
        corners.into_iter().map(on_grid).collect()
    }
}

/// The part of a polygon where `normal · x <= offset` (Sutherland and Hodgman 1974).
fn cut(corners: &[DVec2], normal: DVec2, offset: f64) -> Vec<DVec2> {
    let mut kept = Vec::with_capacity(corners.len() + 1);
    for (&from, &to) in corners.iter().zip(corners.iter().cycle().skip(1)) {
        let [before, after] = [from, to].map(|corner| normal.dot(corner) - offset);
        if before <= 0.0 {
            kept.push(from);
        }
        if before * after < 0.0 {
            kept.push(from.lerp(to, before / (before - after)));
        }
    }
    kept
}

fn on_grid(point: DVec2) -> IntPoint<i32> {
    let line = |metres: f64| (metres * LINES_PER_M).round() as i32;
    IntPoint::new(line(point.x), line(point.y))
}

impl CellWalls {
    /// The walls of a scenario, with the doors that are closed, by index.
    pub(crate) fn new(scenario: &Scenario, closed: &[bool]) -> Self {
        let solids = scenario.obstacles_m.iter().cloned().chain(scenario.doors_m(closed));
        Self {
            solids: solids.map(WallPolygon::solid).collect(),
            enclosures: scenario.enclosures_m.iter().cloned().map(WallPolygon::solid).collect(),
            ground: scenario.ground_lines_m().into_iter().map(WallPolygon::new).collect(),
        }
    }

    /// What is left of a cell, given its corners; none where no wall is near, or the agent stands in one.
    pub(crate) fn part_of(&self, position_m: Vec2, cell_m: &[Vec2]) -> Option<CellPart> {
        let walls = self.contours_near(position_m);
        if walls.is_empty() {
            return None;
        }
        let cell: CellContour =
            cell_m.iter().map(|corner_m| on_grid(DVec2::from(*corner_m) - DVec2::from(position_m))).collect();
        let shapes = overlaid(&[cell], &walls, OverlayRule::Difference);
        let contours = shapes.into_iter().find(|contours| {
            let outline_m: Vec<Vec2> = contours[0].iter().map(|at| Vec2::new(at.x as f32, at.y as f32)).collect();
            contains(&outline_m, Vec2::ZERO)
        })?;
        Some(CellPart { position_m, size_m2: area_m2(&contours), contours })
    }

    /// Contours of all walls near an agent, whose insides agents do not walk on.
    fn contours_near(&self, position_m: Vec2) -> Vec<CellContour> {
        let near = |all: &'_ [WallPolygon]| -> Vec<CellContour> {
            let near = all.iter().filter(|wall| wall.is_near(position_m));
            near.map(|wall| wall.contour(position_m)).filter(|contour| contour.len() > 2).collect()
        };
        let square = || -> CellContour {
            let corners = [(-1.0, -1.0), (1.0, -1.0), (1.0, 1.0), (-1.0, 1.0)];
            corners.into_iter().map(|corner| on_grid(SQUARE_M * DVec2::from(corner))).collect()
        };
        let outside_of = |mut insides: Vec<CellContour>| {
            insides.iter_mut().for_each(|contour| contour.reverse());
            insides.push(square());
            insides
        };
        let is_square = |contours: &[CellContour]| {
            let full_m2 = 4.0 * SQUARE_M * SQUARE_M;
            (area_m2(contours) - full_m2).abs() < 1e-6
        };
        let mut walls = near(&self.solids);
        let ground = near(&self.ground);
        if !self.ground.is_empty() && !is_square(&ground) {
            walls.append(&mut outside_of(ground));
        }
        for wall in self.enclosures.iter().filter(|wall| wall.is_near(position_m)) {
            let contour = wall.contour(position_m);
            match contains(&wall.corners_m, position_m) {
                true if is_square(std::slice::from_ref(&contour)) => {}
                true => walls.append(&mut outside_of(vec![contour])),
                false if contour.len() > 2 => walls.push(contour),
                false => {}
            }
        }
        walls
    }
}

/// The part of a cell that its agent reaches.
#[derive(Clone, Debug)]
pub(crate) struct CellPart {
    position_m: Vec2,
    /// Outline and holes, on the grid about the agent.
    contours: Vec<CellContour>,
    /// Size, m².
    pub(crate) size_m2: f64,
}

impl CellPart {
    /// Size of what lies in a simple polygon, m².
    pub(crate) fn size_within_m2(&self, polygon_m: &[Vec2]) -> f64 {
        let polygon = WallPolygon::solid(polygon_m.to_vec()).contour(self.position_m);
        let shapes = overlaid(&self.contours, &[polygon], OverlayRule::Intersect);
        shapes.iter().map(|contours| area_m2(contours)).sum()
    }
}

fn overlaid(subjects: &[CellContour], clips: &[CellContour], rule: OverlayRule) -> Vec<Vec<CellContour>> {
    let mut overlay = Overlay::<i32>::new(subjects.iter().chain(clips).map(Vec::len).sum());
    subjects.iter().for_each(|contour| overlay.add_contour(contour, ShapeType::Subject));
    clips.iter().for_each(|contour| overlay.add_contour(contour, ShapeType::Clip));
    overlay.overlay(rule, FillRule::NonZero)
}

/// Size of contours that run counter-clockwise, less that of clockwise ones, m².
fn area_m2(contours: &[CellContour]) -> f64 {
    let twice = |contour: &CellContour| -> i64 {
        let ends = contour.iter().zip(contour.iter().cycle().skip(1));
        ends.map(|(a, b)| i64::from(a.x) * i64::from(b.y) - i64::from(a.y) * i64::from(b.x)).sum()
    };
    0.5 * contours.iter().map(twice).sum::<i64>() as f64 / (LINES_PER_M * LINES_PER_M)
}

#[cfg(test)]
mod tests {
    use std::collections::BTreeSet;

    use super::*;
    use crate::maths::random::SplitMix64;
    use crate::measures::places::voronoi_cell::VoronoiCell;
    use crate::route::mesh::WalkablePolygon;
    use crate::world::segment::nearest_on_segment;

    fn rect(low: [f32; 2], high: [f32; 2]) -> Vec<Vec2> {
        [[low[0], low[1]], [high[0], low[1]], high, [low[0], high[1]]].map(Vec2::from).to_vec()
    }

    /// Size of the cell, and of its part right of `x`, by flooding a fine grid from the agent.
    fn flooded_m2(scenario: &Scenario, position_m: Vec2, others_m: &[Vec2], x: f32) -> [f64; 2] {
        const STEPS: i32 = 100;
        let at_m = |(i, j): (i32, i32)| position_m + Vec2::new(i as f32, j as f32) / STEPS as f32;
        let is_solid = |at_m: Vec2| {
            let on_ground = scenario.walkable_m.iter().any(|polygon| {
                contains(&polygon.outline_m, at_m) && !polygon.holes_m.iter().any(|hole_m| contains(hole_m, at_m))
            });
            let near_line = scenario.enclosures_m.iter().any(|polygon_m| {
                polygon_m
                    .iter()
                    .zip(polygon_m.iter().cycle().skip(1))
                    .any(|(a, b)| nearest_on_segment(at_m, *a, *b).distance(at_m) < 0.6 / STEPS as f32)
            });
            scenario.obstacles_m.iter().any(|polygon_m| contains(polygon_m, at_m))
                || near_line
                || !(scenario.walkable_m.is_empty() || on_ground)
        };
        let is_own = |cell: (i32, i32)| {
            let own_m = at_m(cell).distance(position_m);
            own_m <= 1.0 && others_m.iter().all(|other_m| other_m.distance(at_m(cell)) >= own_m)
        };
        let (mut seen, mut open) = (BTreeSet::from([(0, 0)]), vec![(0, 0)]);
        while let Some((i, j)) = open.pop() {
            for next in [(i + 1, j), (i - 1, j), (i, j + 1), (i, j - 1)] {
                if is_own(next) && !is_solid(at_m(next)) && seen.insert(next) {
                    open.push(next);
                }
            }
        }
        let cells = |count: usize| count as f64 / f64::from(STEPS * STEPS);
        [cells(seen.len()), cells(seen.iter().filter(|cell| at_m(**cell).x > x).count())]
    }

    fn check(scenario: &Scenario, position_m: Vec2, others_m: &[Vec2]) {
        let walls = CellWalls::new(scenario, &[]);
        let cell = VoronoiCell::new(position_m, &mut others_m.to_vec());
        let part = walls.part_of(position_m, cell.corners_m());
        let x = position_m.x + 0.1;
        let right_m = rect([x, -50.0], [50.0, 50.0]);
        let found_m2 = part.map_or([cell.size_m2, cell.size_within_m2(&right_m)], |part| {
            [part.size_m2, part.size_within_m2(&right_m)]
        });
        for (found_m2, expected_m2) in found_m2.into_iter().zip(flooded_m2(scenario, position_m, others_m, x)) {
            assert!((found_m2 - expected_m2).abs() < 0.04, "{found_m2} m² instead of {expected_m2} at {position_m}");
        }
    }

    #[test]
    fn cells_end_at_walls_as_a_flooded_grid_shows() {
        let room =
            WalkablePolygon { outline_m: rect([-4.0, -4.0], [4.0, 4.0]), holes_m: vec![rect([-1.0, 2.0], [1.0, 3.0])] };
        let scenario = Scenario {
            // A wall of 10 cm, a pillar, two obstacles that overlap.
            obstacles_m: vec![
                rect([-2.05, -4.0], [-1.95, 1.0]),
                rect([0.4, -0.1], [0.6, 0.1]),
                rect([2.0, -2.0], [3.0, -1.0]),
                rect([2.5, -1.5], [3.5, -0.5]),
            ],
            enclosures_m: vec![rect([1.5, 1.0], [3.5, 3.5])],
            walkable_m: vec![room],
            ..Scenario::of(Vec::new())
        };
        let mut random = SplitMix64::new(4, 0);
        let walls = scenario.walls();
        let mut draw = || (8.0 * Vec2::new(random.unit() as f32, random.unit() as f32)) - 4.0;
        let mut checked = 0;
        while checked < 30 {
            let (position_m, others_m) = (draw(), [draw(), draw(), draw(), draw(), draw(), draw()]);
            if walls.depth_m(position_m, 0.1) <= 0.0 {
                check(&scenario, position_m, &others_m);
                checked += 1;
            }
        }
    }

    #[test]
    fn far_walls_leave_cells_as_they_are() {
        let scenario = Scenario { obstacles_m: vec![rect([9.0, 9.0], [10.0, 10.0])], ..Scenario::of(Vec::new()) };
        let cell = VoronoiCell::new(Vec2::ZERO, &mut []);
        assert!(CellWalls::new(&scenario, &[]).part_of(Vec2::ZERO, cell.corners_m()).is_none());
    }
}

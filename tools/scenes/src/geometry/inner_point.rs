//! The point of the ground that is farthest from its edges and obstacles (pole of inaccessibility). World, metres.
//!
//! A square whose middle has the clearance c and whose half diagonal is d holds no point with more than c + d; squares
//! are quartered, the most promising first, until none can be better.

use std::cmp::Ordering;
use std::collections::BinaryHeap;

use crate::geometry::polygon::{bounds_m, contains, edge_distance_m, signed_area_m2};
use crate::scene::{Point, Scene, SceneObstacle, Walkable};

/// Gain in clearance below which a square is not searched, m.
const PRECISION_M: f64 = 0.02;
/// Greatest number of points that are judged.
const POINTS_MAX: usize = 4_000;
/// Greatest number of edges that are compared with points: a second.
const TESTS_MAX: usize = 200_000_000;
/// Squares along the longer side at the start.
const SQUARES: f64 = 8.0;
/// Ground around obstacles in a scene without walkable ground, m.
const MARGIN_M: f64 = 3.0;

/// The ground on which an example of agents has room: the largest walkable polygon, without obstacles.
pub(crate) struct RoomyGround<'a> {
    largest: Option<&'a Walkable>,
    obstacles: &'a [SceneObstacle],
}

impl<'a> RoomyGround<'a> {
    pub(crate) fn new(scene: &'a Scene) -> Self {
        let area_m2 = |walkable: &Walkable| signed_area_m2(&walkable.polygon_m).abs();
        let largest = scene.walkable.iter().max_by(|a, b| area_m2(a).total_cmp(&area_m2(b)));
        Self { largest, obstacles: &scene.obstacles }
    }

    /// Distance to the nearest edge, m; negative off the ground.
    pub(crate) fn clearance_m(&self, at_m: Point) -> f64 {
        // The distance to an edge, positive on the side that is free.
        let to_ring = |ring_m: &[Point], is_free_inside: bool| {
            let distance_m = edge_distance_m(ring_m, at_m);
            if contains(ring_m, at_m) == is_free_inside { distance_m } else { -distance_m }
        };
        let outline = self.largest.map(|walkable| to_ring(&walkable.polygon_m, true));
        let holes =
            self.largest.into_iter().flat_map(|walkable| &walkable.holes_m).map(|hole_m| to_ring(hole_m, false));
        let obstacles = self.obstacles.iter().map(|obstacle| to_ring(&obstacle.polygon_m, obstacle.is_enclosure));
        outline.into_iter().chain(holes).chain(obstacles).fold(f64::INFINITY, f64::min)
    }

    /// The point with the greatest clearance, to 2 cm; none where there is no ground.
    pub(crate) fn innermost_m(&self) -> Option<Point> {
        let [low_m, high_m] = self.bounds_m()?;
        let size_m = [0, 1].map(|axis| high_m[axis] - low_m[axis]);
        let half_m = 0.5 * size_m[0].max(size_m[1]) / SQUARES;
        let mut open = BinaryHeap::new();
        let [columns, rows] = size_m.map(|metres| (0.5 * metres / half_m).ceil().max(1.0) as usize);
        for index in 0..columns * rows {
            let middle = |axis: usize, count: usize| low_m[axis] + half_m * (2 * count + 1) as f64;
            open.push(Square::new(self, [middle(0, index % columns), middle(1, index / columns)], half_m));
        }
        let mut best: Option<(f64, Point)> = None;
        let points_max = POINTS_MAX.min(TESTS_MAX / self.edge_count().max(1));
        let mut points = open.len();
        while let Some(square) = open.pop() {
            let best_m = best.map_or(0.0, |(clearance_m, _)| clearance_m);
            if square.clearance_m > best_m {
                best = Some((square.clearance_m, square.middle_m));
            }
            if square.greatest_m() <= best_m + PRECISION_M || points > points_max {
                break;
            }
            let half_m = 0.5 * square.half_m;
            let [x, y] = square.middle_m;
            for [dx, dy] in [[-1.0, -1.0], [1.0, -1.0], [-1.0, 1.0], [1.0, 1.0]] {
                open.push(Square::new(self, [x + dx * half_m, y + dy * half_m], half_m));
            }
            points += 4;
        }
        best.map(|(_, at_m)| at_m)
    }

    fn bounds_m(&self) -> Option<[Point; 2]> {
        if let Some(walkable) = self.largest {
            return Some(bounds_m(&walkable.polygon_m));
        }
        let corners_m: Vec<Point> = self.obstacles.iter().flat_map(|obstacle| &obstacle.polygon_m).copied().collect();
        let [low_m, high_m] = bounds_m(&corners_m);
        (!corners_m.is_empty()).then(|| [low_m.map(|metres| metres - MARGIN_M), high_m.map(|metres| metres + MARGIN_M)])
    }

    fn edge_count(&self) -> usize {
        let ground = self.largest.into_iter().flat_map(|walkable| walkable.holes_m.iter().chain([&walkable.polygon_m]));
        ground.chain(self.obstacles.iter().map(|obstacle| &obstacle.polygon_m)).map(Vec::len).sum()
    }
}

/// A square, ordered by the greatest clearance that it may hold.
struct Square {
    middle_m: Point,
    half_m: f64,
    clearance_m: f64,
}

impl Square {
    fn new(ground: &RoomyGround<'_>, middle_m: Point, half_m: f64) -> Self {
        Self { middle_m, half_m, clearance_m: ground.clearance_m(middle_m) }
    }

    fn greatest_m(&self) -> f64 {
        self.clearance_m + self.half_m * std::f64::consts::SQRT_2
    }
}

impl Ord for Square {
    fn cmp(&self, other: &Self) -> Ordering {
        let order = self.greatest_m().total_cmp(&other.greatest_m());
        // Of equal ones, that at the lower left.
        order.then_with(|| {
            let [a, b] = [other.middle_m, self.middle_m];
            a[1].total_cmp(&b[1]).then(a[0].total_cmp(&b[0]))
        })
    }
}

impl PartialOrd for Square {
    fn partial_cmp(&self, other: &Self) -> Option<Ordering> {
        Some(self.cmp(other))
    }
}

impl PartialEq for Square {
    fn eq(&self, other: &Self) -> bool {
        self.cmp(other) == Ordering::Equal
    }
}

impl Eq for Square {}

//! Starts and goals on free ground: those inside walls or other agents move to the nearest free point. World, metres.

use std::collections::BTreeMap;

use crate::geometry::polygon::{bounds_m, contains, distance_m, edge_distance_m};
use crate::scene::{Grid, Notes, Point, Scene, SceneAgents, SceneObstacle, Shape, Starts, Walkable, round_to_mm};

/// Radius of the disc that walls hold, m; that of scenario files.
const WALL_RADIUS_M: f64 = 0.2;
/// Rounding of discs that are meant to touch, m.
const TOUCH_M: f64 = 1e-4;
/// Side of a cell, m: no less than the sum of two radii.
const CELL_M: f64 = 2.0;
/// Distance between the rings that are searched, m.
const RING_M: f64 = 0.1;
/// Number of rings that are searched: 10 m.
const RINGS: usize = 100;
/// Points that are searched for one scene at most.
const TRIED_MAX: usize = 2_000_000;
/// Tests of a point against an obstacle or corner for one scene at most; a minute.
const TESTS_MAX: u64 = 5_000_000_000;
/// Positions of a lattice that are tested for one group at most.
const SITES_MAX: usize = 1_000_000;
/// Displacement that changes what happens, m.
const FAR_M: f64 = 0.5;
/// Positions of an area, along each side, that are searched for free ground; as when a scenario is read.
const LATTICE: usize = 8;
/// Displaced agents that a note lists.
const LISTED: usize = 3;

/// Moves starts and goals of a scene to free ground, and notes it.
pub(crate) fn move_to_free_ground(scene: &mut Scene) {
    let Scene { obstacles, walkable, agents, goals, states, notes, .. } = scene;
    let mut ground = FreeGround::new(obstacles, walkable);
    let count: usize = agents.iter().map(|agents| agents.starts.count()).sum();
    if (count as u64).saturating_mul(ground.tests_a_point() as u64) > TESTS_MAX {
        notes.add("", 0, "the scene is too large to compare starts with walls", false);
        return;
    }
    for place in goals.iter_mut().flat_map(|goals| &mut goals.places) {
        let origin = format!("a goal at {}", shown(place.shape.middle_m()));
        ground.free_shape(&mut place.shape, &origin, notes);
    }
    for state in states {
        if let Some(shape) = &mut state.settings.teleport {
            ground.free_shape(shape, &format!("the teleport of state `{}`", state.name), notes);
        }
    }
    agents.iter_mut().for_each(|agents| ground.free_starts(agents, notes));
    agents.retain(|agents| agents.starts.count() > 0);
}

fn shown([x, y]: Point) -> String {
    format!("[{x}, {y}]")
}

/// Walls of a scene, and the discs of the agents so far.
struct FreeGround<'a> {
    solids: Vec<([Point; 2], &'a [Point])>,
    enclosures: Vec<&'a [Point]>,
    walkable: &'a [Walkable],
    discs: BTreeMap<(i64, i64), Vec<(Point, f64)>>,
    tried: usize,
}

impl<'a> FreeGround<'a> {
    fn new(obstacles: &'a [SceneObstacle], walkable: &'a [Walkable]) -> Self {
        let polygons = |is_enclosure: bool| {
            let chosen = obstacles.iter().filter(move |obstacle| obstacle.is_enclosure == is_enclosure);
            chosen.map(|obstacle| obstacle.polygon_m.as_slice())
        };
        Self {
            solids: polygons(false).map(|polygon_m| (bounds_m(polygon_m), polygon_m)).collect(),
            enclosures: polygons(true).collect(),
            walkable,
            discs: BTreeMap::new(),
            tried: 0,
        }
    }

    /// Number of obstacles and corners with which a point is compared.
    fn tests_a_point(&self) -> usize {
        let holes = self.walkable.iter().map(|walkable| walkable.holes_m.iter().map(Vec::len).sum::<usize>());
        let outlines = self.walkable.iter().map(|walkable| walkable.polygon_m.len()).sum::<usize>();
        self.solids.len()
            + self.enclosures.iter().map(|polygon| polygon.len()).sum::<usize>()
            + outlines
            + holes.sum::<usize>()
    }

    /// Whether walls leave room for a disc.
    fn is_off_walls(&self, at_m: Point, radius_m: f64) -> bool {
        let clear_m = radius_m - TOUCH_M;
        let is_near = |[low_m, high_m]: &[Point; 2]| {
            [0, 1].iter().all(|&axis| low_m[axis] - radius_m <= at_m[axis] && at_m[axis] <= high_m[axis] + radius_m)
        };
        let mut near = self.solids.iter().filter(|(bounds_m, _)| is_near(bounds_m));
        near.all(|(_, polygon_m)| !contains(polygon_m, at_m) && edge_distance_m(polygon_m, at_m) >= clear_m)
            && self.enclosures.iter().all(|polygon_m| edge_distance_m(polygon_m, at_m) >= clear_m)
            && self.is_walkable(at_m, clear_m)
    }

    fn is_walkable(&self, at_m: Point, clear_m: f64) -> bool {
        let is_inside = |walkable: &&Walkable| {
            contains(&walkable.polygon_m, at_m) && !walkable.holes_m.iter().any(|hole_m| contains(hole_m, at_m))
        };
        let mut around = self.walkable.iter().filter(is_inside);
        match (around.next(), around.next()) {
            (None, _) => self.walkable.is_empty(),
            // Where two overlap, their edges are no walls.
            (Some(_), Some(_)) => true,
            (Some(one), None) => {
                [&one.polygon_m].into_iter().chain(&one.holes_m).all(|ring_m| edge_distance_m(ring_m, at_m) >= clear_m)
            }
        }
    }

    fn cell(at_m: Point) -> (i64, i64) {
        ((at_m[0] / CELL_M).floor() as i64, (at_m[1] / CELL_M).floor() as i64)
    }

    /// Whether no disc of an agent overlaps another one.
    fn is_off_agents(&self, at_m: Point, radius_m: f64) -> bool {
        let (x, y) = Self::cell(at_m);
        let cells = (-1..=1).flat_map(|dx| (-1..=1).map(move |dy| (x + dx, y + dy)));
        let mut others = cells.filter_map(|cell| self.discs.get(&cell)).flatten();
        others.all(|&(other_m, other_radius_m)| distance_m(at_m, other_m) >= radius_m + other_radius_m - TOUCH_M)
    }

    fn take(&mut self, at_m: Point, radius_m: f64) {
        self.discs.entry(Self::cell(at_m)).or_default().push((at_m, radius_m));
    }

    /// The nearest point with a property on rings about a point.
    fn nearest(&mut self, about_m: Point, is_free: impl Fn(&Self, Point) -> bool) -> Option<Point> {
        for ring in 1..=RINGS {
            let (radius_m, count) = (ring as f64 * RING_M, 8 * ring);
            for index in 0..count {
                self.tried += 1;
                if self.tried > TRIED_MAX {
                    return None;
                }
                let (sin, cos) = libm::sincos(std::f64::consts::TAU * index as f64 / count as f64);
                let at_m = [about_m[0] + radius_m * cos, about_m[1] + radius_m * sin].map(round_to_mm);
                if is_free(self, at_m) {
                    return Some(at_m);
                }
            }
        }
        None
    }

    /// Makes a shape without free ground a point on free ground.
    fn free_shape(&mut self, shape: &mut Shape, what: &str, notes: &mut Notes) {
        if positions_m(shape).iter().any(|&at_m| self.is_off_walls(at_m, WALL_RADIUS_M)) {
            return;
        }
        let middle_m = shape.middle_m();
        match self.nearest(middle_m, |ground, at_m| ground.is_off_walls(at_m, 2.0 * WALL_RADIUS_M)) {
            Some(at_m) => {
                let far = distance_m(middle_m, at_m) > FAR_M;
                notes.add("", 0, format!("{what} has no free ground; it moves to {}", shown(at_m)), far);
                *shape = Shape::Point(at_m);
            }
            None => notes.add("", 0, format!("{what} has no free ground within 10 m; move it"), true),
        }
    }

    /// Moves the agents of a group that have no room.
    fn free_starts(&mut self, agents: &mut SceneAgents, notes: &mut Notes) {
        let radius_m = agents.radius_max_m;
        let wall_radius_m = agents.wall_radius_m.unwrap_or(WALL_RADIUS_M.min(radius_m));
        let mut left_out = 0;
        let starts_m: Vec<Point> = match &agents.starts {
            Starts::Spread { shape, count } => {
                let sites_m = self.sites_m(shape, radius_m, wall_radius_m);
                // A scenario spreads the agents itself where there is room to spare.
                let Some(sites_m) = sites_m.filter(|sites_m| sites_m.len() * 4 < count * 5) else { return };
                left_out = count.saturating_sub(sites_m.len());
                let kept = count - left_out;
                (0..kept).map(|index| sites_m[index * sites_m.len() / kept]).collect()
            }
            Starts::Grid(grid) => {
                if self.has_room_for(grid, radius_m, wall_radius_m) {
                    let inflated_m = radius_m + grid.jitter_m * 2.0_f64.sqrt();
                    grid.positions_m().for_each(|at_m| self.take(at_m, inflated_m));
                    return;
                }
                grid.drawn_m()
            }
            Starts::Points(starts_m) => starts_m.clone(),
        };
        let is_free = |ground: &Self, at_m: Point| {
            ground.is_off_walls(at_m, wall_radius_m) && ground.is_off_agents(at_m, radius_m)
        };
        let (mut kept_m, mut moved, mut far) = (Vec::new(), Vec::new(), false);
        for start_m in starts_m {
            let found_m = if is_free(self, start_m) { Some(start_m) } else { self.nearest(start_m, is_free) };
            let Some(at_m) = found_m else {
                left_out += 1;
                continue;
            };
            if at_m != start_m {
                far |= distance_m(start_m, at_m) > FAR_M;
                moved.push(format!("{} to {}", shown(start_m), shown(at_m)));
            }
            self.take(at_m, radius_m);
            kept_m.push(at_m);
        }
        agents.starts = Starts::Points(kept_m);
        let (file, line) = agents.origin.rsplit_once(':').unwrap_or((&agents.origin, "0"));
        let line = line.parse().unwrap_or(0);
        if !moved.is_empty() {
            let dots = if moved.len() > LISTED { ", …" } else { "" };
            let listed = moved[..moved.len().min(LISTED)].join(", ");
            let counts = format!("{} of {}", moved.len(), agents.starts.count() + left_out);
            let what = format!("{counts} agents start in walls or in each other and move: {listed}{dots}");
            notes.add(file, line, what, far);
        }
        if left_out > 0 {
            notes.add(file, line, format!("{left_out} agents have no room and are left out"), true);
        }
    }

    /// The densest positions of a hexagonal lattice in a shape that are free; none where they are too many to test.
    fn sites_m(&self, shape: &Shape, radius_m: f64, wall_radius_m: f64) -> Option<Vec<Point>> {
        let [low_m, high_m] = shape_bounds_m(shape);
        let (spacing_m, row_m) = (2.0 * radius_m + TOUCH_M, 3.0_f64.sqrt() * radius_m + TOUCH_M);
        let [columns, rows] = [(0, spacing_m), (1, row_m)]
            .map(|(axis, step_m)| ((high_m[axis] - low_m[axis]) / step_m).floor().min(1e6) as usize + 1);
        if columns * rows > SITES_MAX || (columns * rows) as u64 * self.tests_a_point() as u64 > TESTS_MAX / 10 {
            return None;
        }
        let at_m = |index: usize| {
            let (column, row) = (index % columns, index / columns);
            let aside_m = if row % 2 == 1 { radius_m } else { 0.0 };
            [low_m[0] + aside_m + column as f64 * spacing_m, low_m[1] + row as f64 * row_m]
        };
        let is_free = |at_m: &Point| {
            is_inside(shape, *at_m) && self.is_off_walls(*at_m, wall_radius_m) && self.is_off_agents(*at_m, radius_m)
        };
        let rounded = |at_m: Point| at_m.map(|metres| (metres * 1e5).round() / 1e5);
        Some((0..columns * rows).map(at_m).map(rounded).filter(is_free).collect())
    }

    /// Whether all agents of a grid have room wherever they are displaced.
    fn has_room_for(&self, grid: &Grid, radius_m: f64, wall_radius_m: f64) -> bool {
        let displaced_m = grid.jitter_m * 2.0_f64.sqrt();
        let is_apart = grid.columns * grid.rows < 2 || grid.spacing_m >= 2.0 * (radius_m + displaced_m) - TOUCH_M;
        is_apart
            && radius_m + displaced_m <= CELL_M / 2.0
            && grid.positions_m().all(|at_m| {
                self.is_off_walls(at_m, wall_radius_m + displaced_m) && self.is_off_agents(at_m, radius_m + displaced_m)
            })
    }
}

/// Least and greatest corner of a shape.
fn shape_bounds_m(shape: &Shape) -> [Point; 2] {
    match shape {
        Shape::Point(at_m) => [*at_m; 2],
        Shape::Circle([x, y], radius_m) => [[x - radius_m, y - radius_m], [x + radius_m, y + radius_m]],
        Shape::Rect(low_m, high_m) => [*low_m, *high_m],
        Shape::Polygon(corners_m) => bounds_m(corners_m),
    }
}

/// Whether a point lies in a shape.
fn is_inside(shape: &Shape, at_m: Point) -> bool {
    match shape {
        Shape::Point(other_m) => *other_m == at_m,
        Shape::Circle(centre_m, radius_m) => distance_m(at_m, *centre_m) <= *radius_m,
        Shape::Rect(low_m, high_m) => (0..2).all(|axis| (low_m[axis]..=high_m[axis]).contains(&at_m[axis])),
        Shape::Polygon(corners_m) => contains(corners_m, at_m),
    }
}

/// Positions of a shape that are searched for free ground.
fn positions_m(shape: &Shape) -> Vec<Point> {
    if let Shape::Point(at_m) = shape {
        return vec![*at_m];
    }
    let [low_m, high_m] = shape_bounds_m(shape);
    let step =
        |axis: usize, index: usize| low_m[axis] + (high_m[axis] - low_m[axis]) * (index as f64 + 0.5) / LATTICE as f64;
    let all = (0..LATTICE * LATTICE).map(|index| [step(0, index % LATTICE), step(1, index / LATTICE)]);
    all.filter(|&at_m| is_inside(shape, at_m)).chain([shape.middle_m()]).collect()
}

//! Walls: simple polygons whose edges the planner avoids and whose insides no root enters.
//!
//! Each corner knows its neighbours, the unit direction of the edge that leaves it, and whether the polygon is convex
//! there, as van den Berg et al. 2011 need. Corners run counter-clockwise, so the inside is on an edge's left. World,
//! metres.

use glam::Vec2;

use crate::polygon::signed_area_m2;

/// Rounds of pushing a disc out: one for each wall of a niche, and one more.
const CLAMP_ROUNDS: usize = 4;
/// How far outside a wall a point without radius is put, m: more than f32 rounding at 1 km.
const OUTSIDE_M: f32 = 1e-4;

/// A corner of a polygon and the edge that leaves it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Corner {
    /// Where it is.
    pub point_m: Vec2,
    /// Unit direction of the edge to the next corner.
    pub direction: Vec2,
    /// The polygon turns left here, or not at all.
    pub convex: bool,
    /// Index of the next corner.
    pub next: u32,
    /// Index of the previous corner.
    pub previous: u32,
}

/// An edge near an agent, by the index of the corner that it leaves.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct NearEdge {
    /// Index into [`Obstacles::corners`].
    pub edge: u32,
    /// Distance of the edge from the agent's centre.
    pub distance_m: f32,
}

/// All polygons of a scene.
#[derive(Clone, Debug, Default)]
pub struct Obstacles {
    corners: Vec<Corner>,
    polygons: Vec<Polygon>,
}

/// A run of corners and its bounding box.
#[derive(Clone, Copy, Debug)]
struct Polygon {
    first: usize,
    end: usize,
    least_m: Vec2,
    most_m: Vec2,
}

impl Obstacles {
    /// Takes over simple polygons of three corners or more, either way round; repeated corners are dropped.
    pub fn new(polygons_m: &[Vec<Vec2>]) -> Self {
        let mut obstacles = Self::default();
        for points_m in polygons_m {
            obstacles.add(points_m);
        }
        obstacles
    }

    fn add(&mut self, points_m: &[Vec2]) {
        let mut points_m = points_m.to_vec();
        points_m.dedup();
        while points_m.len() > 1 && points_m.first() == points_m.last() {
            points_m.pop();
        }
        if points_m.len() < 3 {
            return;
        }
        if signed_area_m2(&points_m) < 0.0 {
            points_m.reverse();
        }
        let (first, count) = (self.corners.len(), points_m.len());
        self.corners.extend((0..count).map(|index| corner(&points_m, index, first)));
        let least_m = points_m.iter().copied().fold(Vec2::INFINITY, Vec2::min);
        let most_m = points_m.iter().copied().fold(Vec2::NEG_INFINITY, Vec2::max);
        self.polygons.push(Polygon { first, end: first + count, least_m, most_m });
    }

    /// Every corner; an edge is known by the corner that it leaves.
    pub fn corners(&self) -> &[Corner] {
        &self.corners
    }

    /// Both ends of an edge.
    pub fn ends_m(&self, edge: u32) -> [Vec2; 2] {
        let corner = &self.corners[edge as usize];
        [corner.point_m, self.corners[corner.next as usize].point_m]
    }

    /// The edges within `range` that show their outer side to the position, nearest first, ties by index.
    pub fn near(&self, position_m: Vec2, range_m: f32, found: &mut Vec<NearEdge>) {
        found.clear();
        for polygon in self.polygons.iter().filter(|polygon| polygon.reaches(position_m, range_m)) {
            for edge in polygon.first..polygon.end {
                let [from_m, to_m] = self.ends_m(edge as u32);
                let distance_m = position_m.distance(nearest_on_segment(position_m, from_m, to_m));
                let faces = self.corners[edge].direction.perp_dot(position_m - from_m) < 0.0;
                if faces && distance_m <= range_m {
                    found.push(NearEdge { edge: edge as u32, distance_m });
                }
            }
        }
        found.sort_unstable_by(|a, b| a.distance_m.total_cmp(&b.distance_m).then(a.edge.cmp(&b.edge)));
    }

    /// Whether a point lies inside a polygon.
    pub fn contains(&self, point_m: Vec2) -> bool {
        self.polygons.iter().any(|polygon| polygon.reaches(point_m, 0.0) && self.is_inside(polygon, point_m))
    }

    /// The position nearby at which a disc touches no wall. In a gap too narrow for the disc its centre stays outside
    /// all polygons.
    pub fn clamp_outside(&self, position_m: Vec2, radius_m: f32) -> Vec2 {
        let mut clamped_m = position_m;
        for _ in 0..CLAMP_ROUNDS {
            clamped_m = self.pushed_out(clamped_m, radius_m);
        }
        self.pushed_out(clamped_m, OUTSIDE_M)
    }

    /// One round over all polygons.
    fn pushed_out(&self, position_m: Vec2, radius_m: f32) -> Vec2 {
        let mut position_m = position_m;
        for polygon in &self.polygons {
            if polygon.reaches(position_m, radius_m) {
                position_m = self.out_of(polygon, position_m, radius_m);
            }
        }
        position_m
    }

    /// Moves a disc away from a polygon, over the edge nearest to its centre.
    fn out_of(&self, polygon: &Polygon, position_m: Vec2, radius_m: f32) -> Vec2 {
        let (edge, touched_m) = self.nearest_edge(polygon, position_m);
        let away_m = position_m - touched_m;
        let inside = self.is_inside(polygon, position_m);
        if !inside && away_m.length_squared() >= radius_m * radius_m {
            return position_m;
        }
        let outward = -self.corners[edge].direction.perp();
        let away = if inside { -away_m } else { away_m };
        touched_m + radius_m * away.normalize_or(outward)
    }

    /// The polygon's edge nearest to a position, and the point of it that is.
    fn nearest_edge(&self, polygon: &Polygon, position_m: Vec2) -> (usize, Vec2) {
        let mut best = (polygon.first, self.corners[polygon.first].point_m);
        for edge in polygon.first..polygon.end {
            let [from_m, to_m] = self.ends_m(edge as u32);
            let point_m = nearest_on_segment(position_m, from_m, to_m);
            if point_m.distance_squared(position_m) < best.1.distance_squared(position_m) {
                best = (edge, point_m);
            }
        }
        best
    }

    /// Even-odd rule along a ray in +x.
    fn is_inside(&self, polygon: &Polygon, point_m: Vec2) -> bool {
        let crosses = |edge: &usize| {
            let [from_m, to_m] = self.ends_m(*edge as u32);
            let straddles = (from_m.y > point_m.y) != (to_m.y > point_m.y);
            let left_of_edge = (to_m - from_m).perp_dot(point_m - from_m) > 0.0;
            straddles && left_of_edge == (to_m.y > from_m.y)
        };
        (polygon.first..polygon.end).filter(crosses).count() % 2 == 1
    }
}

impl Polygon {
    /// Whether a disc may touch the polygon.
    fn reaches(&self, position_m: Vec2, radius_m: f32) -> bool {
        let nearest_m = position_m.clamp(self.least_m, self.most_m);
        nearest_m.distance_squared(position_m) <= radius_m * radius_m
    }
}

/// Corner `index` of a polygon whose first corner gets the index `first`.
fn corner(points_m: &[Vec2], index: usize, first: usize) -> Corner {
    let count = points_m.len();
    let (next, previous) = ((index + 1) % count, (index + count - 1) % count);
    let point_m = points_m[index];
    Corner {
        point_m,
        direction: (points_m[next] - point_m).normalize(),
        convex: (point_m - points_m[previous]).perp_dot(points_m[next] - point_m) >= 0.0,
        next: (first + next) as u32,
        previous: (first + previous) as u32,
    }
}

/// The point of a segment nearest to a position.
pub(crate) fn nearest_on_segment(position_m: Vec2, from_m: Vec2, to_m: Vec2) -> Vec2 {
    let along = to_m - from_m;
    let share = (position_m - from_m).dot(along) / along.length_squared().max(f32::MIN_POSITIVE);
    from_m + share.clamp(0.0, 1.0) * along
}

#[cfg(test)]
mod tests {
    use proptest::prelude::*;

    use super::*;

    const RADIUS_M: f32 = 0.25;

    /// An L, clockwise on purpose, and a block 0.3 m off it: a niche and a gap too narrow for the disc.
    fn place() -> Obstacles {
        let polygon = |corners: &[[f32; 2]]| corners.iter().copied().map(Vec2::from).collect::<Vec<Vec2>>();
        Obstacles::new(&[
            polygon(&[[0.0, 0.0], [0.0, 3.0], [1.0, 3.0], [1.0, 1.0], [3.0, 1.0], [3.0, 0.0]]),
            polygon(&[[3.3, 0.0], [4.0, 0.0], [4.0, 1.0], [3.3, 1.0]]),
        ])
    }

    fn in_the_shapes(point: Vec2) -> bool {
        let within = |least: [f32; 2], most: [f32; 2]| {
            point.cmpgt(Vec2::from(least)).all() && point.cmplt(Vec2::from(most)).all()
        };
        within([0.0, 0.0], [1.0, 3.0]) || within([0.0, 0.0], [3.0, 1.0]) || within([3.3, 0.0], [4.0, 1.0])
    }

    fn distance_to_edges_m(obstacles: &Obstacles, point_m: Vec2) -> f32 {
        let edges = 0..obstacles.corners().len() as u32;
        let distance_m = |edge| {
            let [from_m, to_m] = obstacles.ends_m(edge);
            point_m.distance(nearest_on_segment(point_m, from_m, to_m))
        };
        edges.map(distance_m).fold(f32::INFINITY, f32::min)
    }

    proptest! {
        #![proptest_config(ProptestConfig::with_cases(2000))]

        #[test]
        fn knows_inside_from_outside(x in -1.0f32..5.0, y in -1.0f32..4.0) {
            prop_assert_eq!(place().contains(Vec2::new(x, y)), in_the_shapes(Vec2::new(x, y)));
        }

        #[test]
        fn clamps_a_disc_out_of_walls_and_leaves_a_free_one(x in -1.0f32..5.0, y in -1.0f32..4.0) {
            let (obstacles, position_m) = (place(), Vec2::new(x, y));
            let free = !obstacles.contains(position_m) && distance_to_edges_m(&obstacles, position_m) >= RADIUS_M;
            let clamped_m = obstacles.clamp_outside(position_m, RADIUS_M);
            prop_assert!(!obstacles.contains(clamped_m), "{clamped_m} is inside");
            prop_assert!(!free || clamped_m == position_m);
            let in_the_gap = (2.9..3.5).contains(&clamped_m.x) && (-0.3..1.3).contains(&clamped_m.y);
            prop_assert!(in_the_gap || distance_to_edges_m(&obstacles, clamped_m) > RADIUS_M - 1e-3, "{clamped_m}");
        }

        #[test]
        fn near_edges_are_those_within_range_that_face_the_point(x in -1.0f32..5.0, y in -1.0f32..4.0) {
            let (obstacles, position_m, mut found) = (place(), Vec2::new(x, y), Vec::new());
            obstacles.near(position_m, 1.0, &mut found);
            prop_assert!(found.windows(2).all(|pair| pair[0].distance_m <= pair[1].distance_m));
            for edge in 0..obstacles.corners().len() as u32 {
                let [from_m, to_m] = obstacles.ends_m(edge);
                let right = (to_m - from_m).perp_dot(position_m - from_m) < 0.0;
                let close = position_m.distance(nearest_on_segment(position_m, from_m, to_m)) <= 1.0;
                prop_assert_eq!(found.iter().any(|near| near.edge == edge), right && close);
            }
        }
    }

    #[test]
    fn corners_run_counter_clockwise_and_know_the_niche() {
        let obstacles = place();
        let hollow: Vec<Vec2> =
            obstacles.corners().iter().filter(|corner| !corner.convex).map(|corner| corner.point_m).collect();
        assert_eq!(hollow, [Vec2::ONE]);
        for (index, corner) in obstacles.corners().iter().enumerate() {
            assert_eq!(obstacles.corners()[corner.next as usize].previous as usize, index);
        }
    }

    #[test]
    fn degenerate_polygons_are_dropped() {
        let flat = vec![Vec2::ZERO, Vec2::X, Vec2::X, Vec2::ZERO];
        assert!(Obstacles::new(&[vec![], vec![Vec2::X], flat]).corners().is_empty());
    }
}

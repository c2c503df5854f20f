//! Walls: simple polygons whose edges the planner avoids and whose insides no root enters.
//!
//! Each corner knows its neighbours, the unit direction of the edge that leaves it, and whether the polygon is convex
//! there, as van den Berg et al. 2011 need. Corners run counter-clockwise, so the inside is on an edge's left. What is
//! near is found through a grid of edges. World, metres.

pub(crate) mod edge_grid;

use glam::{DVec2, Vec2};

use crate::maths::polygon::signed_area_m2;
use crate::world::obstacles::edge_grid::EdgeGrid;

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
    /// Index of each polygon's first corner, and the number of corners.
    polygons: Vec<usize>,
    /// Polygon of each corner.
    polygon_of: Vec<u32>,
    grid: EdgeGrid,
}

impl Obstacles {
    /// Takes over simple polygons of three corners or more, either way round; repeated corners are dropped.
    pub fn new(polygons_m: &[Vec<Vec2>]) -> Self {
        let mut obstacles = Self { polygons: vec![0], ..Self::default() };
        for points_m in polygons_m {
            obstacles.add(points_m);
        }
        let ends_m: Vec<[Vec2; 2]> = (0..obstacles.corners.len()).map(|edge| obstacles.ends_m(edge as u32)).collect();
        obstacles.grid = EdgeGrid::new(&ends_m);
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
        self.polygon_of.resize(self.corners.len(), self.polygons.len() as u32 - 1);
        self.polygons.push(self.corners.len());
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
        for edge in self.grid.within(position_m - range_m, position_m + range_m) {
            let [from_m, to_m] = self.ends_m(edge);
            let distance_m = position_m.distance(nearest_on_segment(position_m, from_m, to_m));
            let faces = self.corners[edge as usize].direction.perp_dot(position_m - from_m) < 0.0;
            if faces && distance_m <= range_m {
                found.push(NearEdge { edge, distance_m });
            }
        }
        found.sort_unstable_by(|a, b| a.distance_m.total_cmp(&b.distance_m).then(a.edge.cmp(&b.edge)));
        found.dedup();
    }

    /// Whether a point lies inside a polygon.
    pub fn contains(&self, point_m: Vec2) -> bool {
        !self.around(point_m).is_empty()
    }

    /// The polygons that a point lies inside of, by the even-odd rule along a ray in +x.
    fn around(&self, point_m: Vec2) -> Vec<u32> {
        if self.corners.is_empty() {
            return Vec::new();
        }
        let crosses = |edge: &u32| {
            let [from_m, to_m] = self.ends_m(*edge);
            let straddles = (from_m.y > point_m.y) != (to_m.y > point_m.y);
            straddles && (side(from_m, to_m, point_m) > 0.0) == (to_m.y > from_m.y)
        };
        let mut crossed: Vec<u32> = self.grid.beyond(point_m).filter(crosses).collect();
        crossed.sort_unstable();
        crossed.dedup();
        let polygon_of = |edge: &u32| self.polygon_of[*edge as usize];
        let polygons = crossed.chunk_by(|a, b| polygon_of(a) == polygon_of(b));
        polygons.filter(|edges| edges.len() % 2 == 1).map(|edges| polygon_of(&edges[0])).collect()
    }

    /// Where a disc ends up that would go from one position to another: outside all walls, as [`Self::clamp_outside`]
    /// puts it, and on the side of them where it was. Whoever is in a wall may leave that one on any side.
    pub fn clamp_way(&self, from_m: Vec2, to_m: Vec2, radius_m: f32) -> Vec2 {
        // Mostly no wall is near.
        let mut near = self.grid.within(from_m.min(to_m) - radius_m, from_m.max(to_m) + radius_m);
        if near.next().is_none() && self.around(to_m).is_empty() {
            return to_m;
        }
        let within = self.around(from_m);
        let free = |to_m: &Vec2| {
            let ends_well = self.around(*to_m).iter().all(|polygon| within.contains(polygon));
            ends_well && self.crossings(from_m, *to_m, &within).next().is_none()
        };
        let direct_m = self.clamp_outside(to_m, radius_m);
        let stopped_m = || {
            let share = self.crossings(from_m, to_m, &within).fold(1.0, f64::min) as f32;
            let before_m = OUTSIDE_M * (to_m - from_m).normalize_or_zero();
            self.clamp_outside(from_m.lerp(to_m, share) - before_m, radius_m)
        };
        Some(direct_m).filter(free).or_else(|| Some(stopped_m()).filter(free)).unwrap_or(from_m)
    }

    /// Whether a straight way leads through no wall.
    pub fn is_free(&self, from_m: Vec2, to_m: Vec2) -> bool {
        self.crossings(from_m, to_m, &[]).next().is_none()
    }

    /// Shares of a straight way at which it leads through the edges of polygons, `within` left out.
    fn crossings(&self, from_m: Vec2, to_m: Vec2, within: &[u32]) -> impl Iterator<Item = f64> {
        let edges = self.grid.within(from_m.min(to_m), from_m.max(to_m));
        let others = edges.filter(|&edge| !within.contains(&self.polygon_of[edge as usize]));
        others.filter_map(move |edge| {
            let [a_m, b_m] = self.ends_m(edge);
            let [before, after] = [from_m, to_m].map(|end_m| side(a_m, b_m, end_m));
            let apart = side(from_m, to_m, a_m) * side(from_m, to_m, b_m);
            // An edge that the way begins on is not led through, but one that it ends on is.
            let passes = (before > 0.0 && after <= 0.0) || (before < 0.0 && after >= 0.0);
            (passes && apart <= 0.0).then(|| before / (before - after))
        })
    }

    /// The position nearby at which a disc touches no wall. In a gap too narrow for the disc its centre stays outside
    /// all polygons.
    pub fn clamp_outside(&self, position_m: Vec2, radius_m: f32) -> Vec2 {
        let mut clamped_m = position_m;
        for _ in 0..CLAMP_ROUNDS {
            let before_m = clamped_m;
            clamped_m = self.pushed_out(clamped_m, radius_m);
            if clamped_m == before_m {
                return clamped_m;
            }
        }
        self.pushed_out(clamped_m, OUTSIDE_M)
    }

    /// One round over all polygons nearby.
    fn pushed_out(&self, position_m: Vec2, radius_m: f32) -> Vec2 {
        let near = self.grid.within(position_m - radius_m, position_m + radius_m);
        let mut polygons: Vec<u32> = near.map(|edge| self.polygon_of[edge as usize]).collect();
        polygons.extend(self.around(position_m));
        polygons.sort_unstable();
        polygons.dedup();
        polygons.into_iter().fold(position_m, |position_m, polygon| self.out_of(polygon, position_m, radius_m))
    }

    /// Moves a disc away from a polygon, over the edge nearest to its centre.
    fn out_of(&self, polygon: u32, position_m: Vec2, radius_m: f32) -> Vec2 {
        let inside = self.around(position_m).contains(&polygon);
        let Some((edge, touched_m)) = self.nearest_edge(polygon, position_m, radius_m, inside) else {
            return position_m;
        };
        let away_m = position_m - touched_m;
        if !inside && away_m.length_squared() >= radius_m * radius_m {
            return position_m;
        }
        let outward = -self.corners[edge as usize].direction.perp();
        let away = if inside { -away_m } else { away_m };
        touched_m + radius_m * away.normalize_or(outward)
    }

    /// A polygon's edge nearest to a position, and the point of it that is: of all edges, or of those near the disc.
    fn nearest_edge(&self, polygon: u32, position_m: Vec2, radius_m: f32, of_all: bool) -> Option<(u32, Vec2)> {
        let [first, end] = [0, 1].map(|next| self.polygons[polygon as usize + next] as u32);
        let touched = |edge: u32| {
            let [from_m, to_m] = self.ends_m(edge);
            (edge, nearest_on_segment(position_m, from_m, to_m))
        };
        let nearer = |a: &(u32, Vec2), b: &(u32, Vec2)| {
            let [a_m2, b_m2] = [a, b].map(|(_, point_m)| point_m.distance_squared(position_m));
            a_m2.total_cmp(&b_m2).then(a.0.cmp(&b.0))
        };
        if of_all {
            return (first..end).map(touched).min_by(nearer);
        }
        let near = self.grid.within(position_m - radius_m, position_m + radius_m);
        near.filter(|edge| (first..end).contains(edge)).map(touched).min_by(nearer)
    }
}

/// Positive where a point lies left of the line from a to b; in f64, where the sign can be trusted.
fn side(from_m: Vec2, to_m: Vec2, point_m: Vec2) -> f64 {
    let [from_m, to_m, point_m] = [from_m, to_m, point_m].map(DVec2::from);
    (to_m - from_m).perp_dot(point_m - from_m)
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

    proptest! {
        #![proptest_config(ProptestConfig::with_cases(4000))]

        #[test]
        fn no_way_leads_through_a_wall_however_far_and_thin(
            x in -1.0f32..5.0, y in -1.0f32..4.0, east in -30.0f32..30.0, north in -30.0f32..30.0, thin in 0.001f32..0.3,
        ) {
            let wall = |x: f32| vec![Vec2::new(x, -9.0), Vec2::new(x + thin, -9.0), Vec2::new(x + thin, 9.0), Vec2::new(x, 9.0)];
            let obstacles = Obstacles::new(&[wall(1.0), wall(2.0), wall(2.2)]);
            let from_m = Vec2::new(x, y);
            prop_assume!(!obstacles.contains(from_m));
            let ended_m = obstacles.clamp_way(from_m, from_m + Vec2::new(east, north), RADIUS_M);
            prop_assert!(!obstacles.contains(ended_m));
            let room = |at_m: Vec2| [1.0, 2.0, 2.2].iter().filter(|&&x| at_m.x > x + 0.5 * thin).count();
            let around = ended_m.y.abs() > 9.0;
            prop_assert!(around || room(from_m) == room(ended_m), "{from_m} {ended_m}");
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

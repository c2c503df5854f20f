//! The polygons of a scene: their corners and edges, what is near, and what a straight path crosses.
//!
//! Corners run counter-clockwise, so the inside is on an edge's left. Each corner knows its neighbours, the unit
//! direction of the edge that leaves it, and whether the polygon is convex there, as the half-planes of van den Berg et
//! al. 2011 need. World, metres.

use glam::Vec2;

use crate::maths::polygon::signed_area_m2;
use crate::world::obstacles::edge_grid::EdgeGrid;
use crate::world::segment::{nearest_on_segment, side_of_line};

/// Number of edges from which those across a ray are looked up in the grid.
const EDGES_MANY: usize = 64;

/// A corner of a polygon and the edge that leaves it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ObstacleCorner {
    /// Position of the corner, m.
    pub point_m: Vec2,
    /// Unit direction of the edge to the next corner.
    pub direction: Vec2,
    /// Whether the polygon turns left here, or runs straight on.
    pub convex: bool,
    /// Index of the next corner.
    pub next: u32,
    /// Index of the previous corner.
    pub previous: u32,
}

/// An edge near an agent.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct NearEdge {
    /// Index of the edge: that of the corner which it leaves, in [`Obstacles::corners`].
    pub edge: u32,
    /// Distance of the edge from the agent's centre, m.
    pub distance_m: f32,
}

/// All polygons of a scene.
#[derive(Clone, Debug, Default)]
pub struct Obstacles {
    pub(super) corners: Vec<ObstacleCorner>,
    /// Index of each polygon's first corner, and the number of corners.
    pub(super) first_corners: Vec<usize>,
    /// Index of each corner's polygon.
    pub(super) polygon_of: Vec<u32>,
    /// Index of the polygon that is solid outside of its contours: the walkable ground's complement.
    pub(super) inside_out: Option<u32>,
    pub(super) grid: EdgeGrid,
}

impl Obstacles {
    /// Takes simple polygons of three corners or more, in either direction; repeated corners are dropped.
    pub fn new(polygons_m: &[Vec<Vec2>]) -> Self {
        Self::with_ground(polygons_m, &[], &[])
    }

    /// As [`new`](Self::new), with a wall without thickness around each enclosure, and with the edges of the walkable
    /// ground, which lies on the left of its contours; none of them: the ground is open.
    pub fn with_ground(polygons_m: &[Vec<Vec2>], enclosures_m: &[Vec<Vec2>], ground_m: &[Vec<Vec2>]) -> Self {
        let mut obstacles = Self { first_corners: vec![0], ..Self::default() };
        let turned = |points_m: &Vec<Vec2>| points_m.iter().rev().copied().collect::<Vec<Vec2>>();
        for points_m in polygons_m {
            let is_clockwise = signed_area_m2(points_m) < 0.0;
            obstacles.add(&[if is_clockwise { turned(points_m) } else { points_m.clone() }]);
        }
        for points_m in enclosures_m {
            obstacles.add(&[points_m.clone(), turned(points_m)]);
        }
        if !ground_m.is_empty() {
            obstacles.inside_out = Some(obstacles.first_corners.len() as u32 - 1);
            obstacles.add(&ground_m.iter().map(turned).collect::<Vec<_>>());
        }
        let ends_m: Vec<[Vec2; 2]> = (0..obstacles.corners.len()).map(|edge| obstacles.ends_m(edge as u32)).collect();
        obstacles.grid = EdgeGrid::new(&ends_m);
        obstacles
    }

    /// Adds a polygon of contours with its inside on their left.
    fn add(&mut self, contours_m: &[Vec<Vec2>]) {
        for points_m in contours_m {
            let mut points_m = points_m.clone();
            points_m.dedup();
            while points_m.len() > 1 && points_m.first() == points_m.last() {
                points_m.pop();
            }
            if points_m.len() >= 3 {
                let (first, count) = (self.corners.len(), points_m.len());
                self.corners.extend((0..count).map(|index| corner(&points_m, index, first)));
            }
        }
        if self.corners.len() > self.polygon_of.len() {
            self.polygon_of.resize(self.corners.len(), self.first_corners.len() as u32 - 1);
            self.first_corners.push(self.corners.len());
        }
    }

    /// Every corner; an edge has the index of the corner that it leaves.
    pub fn corners(&self) -> &[ObstacleCorner] {
        &self.corners
    }

    /// Both ends of an edge, m.
    pub fn ends_m(&self, edge: u32) -> [Vec2; 2] {
        let corner = &self.corners[edge as usize];
        [corner.point_m, self.corners[corner.next as usize].point_m]
    }

    /// Replaces `found` by the edges within range that face the position with their outer side, nearest first, ties by
    /// index.
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

    /// Whether a point lies inside a polygon, by the even-odd rule along a ray in +x.
    pub fn contains(&self, point_m: Vec2) -> bool {
        if self.corners.is_empty() {
            return false;
        }
        let crossed = self.crossed_by_ray(point_m);
        let polygon_of = |edge: &u32| Some(self.polygon_of[*edge as usize]);
        let mut polygons = crossed.chunk_by(|a, b| polygon_of(a) == polygon_of(b));
        let is_off_ground = self
            .inside_out
            .is_some_and(|_| crossed.iter().filter(|edge| polygon_of(edge) == self.inside_out).count() % 2 == 0);
        is_off_ground || polygons.any(|edges| edges.len() % 2 == 1 && polygon_of(&edges[0]) != self.inside_out)
    }

    /// Whether the polygon of an edge holds a point, by the even-odd rule along a ray in +x.
    pub(super) fn surrounds(&self, edge: u32, point_m: Vec2) -> bool {
        let polygon = self.polygon_of[edge as usize];
        let edges = self.first_corners[polygon as usize] as u32..self.first_corners[polygon as usize + 1] as u32;
        let crossed = if edges.len() > EDGES_MANY {
            let crossed = self.crossed_by_ray(point_m);
            crossed.iter().filter(|edge| edges.contains(edge)).count()
        } else {
            edges.filter(|&edge| self.is_right_of(edge, point_m)).count()
        };
        (crossed % 2 == 1) != (self.inside_out == Some(polygon))
    }

    /// The edges that a ray in +x from a point crosses, rising.
    fn crossed_by_ray(&self, point_m: Vec2) -> Vec<u32> {
        let mut crossed: Vec<u32> = self.grid.beyond(point_m).filter(|&edge| self.is_right_of(edge, point_m)).collect();
        crossed.sort_unstable();
        crossed.dedup();
        crossed
    }

    /// Whether a ray in +x from a point crosses an edge.
    fn is_right_of(&self, edge: u32, point_m: Vec2) -> bool {
        let [from_m, to_m] = self.ends_m(edge);
        let straddles = (from_m.y > point_m.y) != (to_m.y > point_m.y);
        straddles && (side_of_line(from_m, to_m, point_m) > 0.0) == (to_m.y > from_m.y)
    }

    /// Whether a straight path crosses no wall.
    pub fn is_free(&self, from_m: Vec2, to_m: Vec2) -> bool {
        self.crossed(from_m, to_m).next().is_none()
    }

    /// Edges that a straight path crosses; an edge may come more than once.
    pub(super) fn crossed(&self, from_m: Vec2, to_m: Vec2) -> impl Iterator<Item = u32> {
        self.grid.within(from_m.min(to_m), from_m.max(to_m)).filter(move |&edge| {
            let [a_m, b_m] = self.ends_m(edge);
            let [before, after] = [from_m, to_m].map(|end_m| side_of_line(a_m, b_m, end_m));
            let apart = side_of_line(from_m, to_m, a_m) * side_of_line(from_m, to_m, b_m);
            // A path that begins on an edge does not cross it; one that ends on it does.
            let passes = (before > 0.0 && after <= 0.0) || (before < 0.0 && after >= 0.0);
            passes && apart <= 0.0
        })
    }
}

/// Corner `index` of a polygon whose first corner gets the index `first`.
fn corner(points_m: &[Vec2], index: usize, first: usize) -> ObstacleCorner {
    let count = points_m.len();
    let (next, previous) = ((index + 1) % count, (index + count - 1) % count);
    let point_m = points_m[index];
    ObstacleCorner {
        point_m,
        direction: (points_m[next] - point_m).normalize(),
        convex: (point_m - points_m[previous]).perp_dot(points_m[next] - point_m) >= 0.0,
        next: (first + next) as u32,
        previous: (first + previous) as u32,
    }
}

#[cfg(test)]
pub(super) mod tests {
    use proptest::prelude::*;

    use super::*;

    /// An L, clockwise on purpose, and a block 0.3 m beside it: a niche and a gap too narrow for a disc.
    pub(in crate::world::obstacles) fn l_and_block() -> Obstacles {
        let polygon = |corners: &[[f32; 2]]| corners.iter().copied().map(Vec2::from).collect::<Vec<Vec2>>();
        Obstacles::new(&[
            polygon(&[[0.0, 0.0], [0.0, 3.0], [1.0, 3.0], [1.0, 1.0], [3.0, 1.0], [3.0, 0.0]]),
            polygon(&[[3.3, 0.0], [4.0, 0.0], [4.0, 1.0], [3.3, 1.0]]),
        ])
    }

    fn is_in_the_shapes(point: Vec2) -> bool {
        let within = |least: [f32; 2], most: [f32; 2]| {
            point.cmpgt(Vec2::from(least)).all() && point.cmplt(Vec2::from(most)).all()
        };
        within([0.0, 0.0], [1.0, 3.0]) || within([0.0, 0.0], [3.0, 1.0]) || within([3.3, 0.0], [4.0, 1.0])
    }

    proptest! {
        #![proptest_config(ProptestConfig::with_cases(2000))]

        #[test]
        fn tells_inside_from_outside(x in -1.0f32..5.0, y in -1.0f32..4.0) {
            prop_assert_eq!(l_and_block().contains(Vec2::new(x, y)), is_in_the_shapes(Vec2::new(x, y)));
        }

        #[test]
        fn near_edges_are_those_within_range_that_face_the_point(x in -1.0f32..5.0, y in -1.0f32..4.0) {
            let (obstacles, position_m, mut found) = (l_and_block(), Vec2::new(x, y), Vec::new());
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
        let obstacles = l_and_block();
        let concave: Vec<Vec2> =
            obstacles.corners().iter().filter(|corner| !corner.convex).map(|corner| corner.point_m).collect();
        assert_eq!(concave, [Vec2::ONE]);
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

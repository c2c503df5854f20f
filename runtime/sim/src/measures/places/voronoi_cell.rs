//! Voronoi cells of agents, cut to a greatest radius: the ground that is nearer to an agent than to any other.
//!
//! Each cell begins as a disc and is cut by the bisector to one neighbour after the other, the nearest first, until no
//! neighbour is near enough to reach it. Walls cut cells afterwards (`cell_part`). World, metres.

use glam::Vec2;

use crate::maths::polygon::signed_area_m2;

/// Greatest radius of a cell, m: the ground beyond it belongs to no agent. PedPy's examples use 1 m.
pub(crate) const CELL_RADIUS_M: f32 = 1.0;
/// Corners of a disc.
const DISC_CORNERS: usize = 32;

/// The cell of one agent.
#[derive(Clone, Debug)]
pub(crate) struct VoronoiCell {
    /// Corners, counter-clockwise, world, m.
    corners_m: Vec<Vec2>,
    /// Size, m²; positive where no two agents stand at the same position.
    pub(crate) size_m2: f64,
}

/// Corners of a regular polygon with the size of a disc, counter-clockwise, m.
pub(crate) fn disc_m(centre_m: Vec2, radius_m: f32, corners: usize) -> Vec<Vec2> {
    let turn_rad = std::f64::consts::TAU / corners as f64;
    let arm_m = f64::from(radius_m) * (turn_rad / libm::sin(turn_rad)).sqrt();
    let corner = |index: usize| {
        let (sin, cos) = libm::sincos(turn_rad * index as f64);
        centre_m + Vec2::new((arm_m * cos) as f32, (arm_m * sin) as f32)
    };
    (0..corners).map(corner).collect()
}

impl VoronoiCell {
    /// The cell of an agent among others within twice [`CELL_RADIUS_M`]; further ones do not matter.
    pub(crate) fn new(position_m: Vec2, others_m: &mut [Vec2]) -> Self {
        others_m.sort_by(|a, b| a.distance_squared(position_m).total_cmp(&b.distance_squared(position_m)));
        let mut corners_m = disc_m(Vec2::ZERO, CELL_RADIUS_M, DISC_CORNERS);
        let mut reach_m2 = farthest_m2(&corners_m);
        for other_m in others_m.iter().map(|other_m| *other_m - position_m) {
            if other_m.length_squared() >= 4.0 * reach_m2 {
                break;
            }
            if other_m != Vec2::ZERO {
                corners_m = cut(&corners_m, other_m, 0.5 * other_m.length_squared());
                reach_m2 = farthest_m2(&corners_m);
            }
        }
        let size_m2 = signed_area_m2(&corners_m);
        corners_m.iter_mut().for_each(|corner_m| *corner_m += position_m);
        Self { corners_m, size_m2 }
    }

    /// Corners, counter-clockwise, world, m.
    pub(crate) fn corners_m(&self) -> &[Vec2] {
        &self.corners_m
    }

    /// Size of the part of the cell that lies in a simple polygon, m².
    pub(crate) fn size_within_m2(&self, polygon_m: &[Vec2]) -> f64 {
        // The cell is convex, so its edges cut the polygon one after the other. Relative to the cell, so that nothing
        // is lost far from the origin.
        let Some(&origin_m) = self.corners_m.first() else { return 0.0 };
        let mut rest_m: Vec<Vec2> = polygon_m.iter().map(|corner_m| *corner_m - origin_m).collect();
        for (index, from_m) in self.corners_m.iter().enumerate() {
            let along_m = self.corners_m[(index + 1) % self.corners_m.len()] - from_m;
            let outwards_m = -along_m.perp();
            rest_m = cut(&rest_m, outwards_m, outwards_m.dot(*from_m - origin_m));
        }
        signed_area_m2(&rest_m).abs()
    }
}

fn farthest_m2(corners_m: &[Vec2]) -> f32 {
    corners_m.iter().map(|corner_m| corner_m.length_squared()).fold(0.0, f32::max)
}

/// The part of a polygon where `normal · x <= offset` (Sutherland and Hodgman 1974).
fn cut(corners_m: &[Vec2], normal: Vec2, offset: f32) -> Vec<Vec2> {
    let mut kept_m = Vec::with_capacity(corners_m.len() + 1);
    for (index, &from_m) in corners_m.iter().enumerate() {
        let to_m = corners_m[(index + 1) % corners_m.len()];
        let [from, to] = [from_m, to_m].map(|corner_m| normal.dot(corner_m) - offset);
        if from <= 0.0 {
            kept_m.push(from_m);
        }
        if (from < 0.0 && to > 0.0) || (from > 0.0 && to < 0.0) {
            kept_m.push(from_m.lerp(to_m, from / (from - to)));
        }
    }
    kept_m
}

#[cfg(test)]
mod tests {
    use std::f64::consts::PI;

    use super::*;

    #[test]
    fn a_lone_agent_has_a_disc() {
        let cell = VoronoiCell::new(Vec2::new(5_000.0, -3.0), &mut []);
        assert!((cell.size_m2 - PI).abs() < 1e-3, "{}", cell.size_m2);
    }

    #[test]
    fn cells_of_a_grid_are_squares() {
        let others = (-3..=3).flat_map(|x| (-3..=3).map(move |y| 0.8 * Vec2::new(x as f32, y as f32)));
        let mut others_m: Vec<Vec2> = others.filter(|other_m| *other_m != Vec2::ZERO).collect();
        let cell = VoronoiCell::new(Vec2::ZERO, &mut others_m);
        assert!((cell.size_m2 - 0.64).abs() < 1e-4, "{}", cell.size_m2);
        let half_m = [(0.0, -9.0), (9.0, -9.0), (9.0, 9.0), (0.0, 9.0)].map(Vec2::from);
        assert!((cell.size_within_m2(&half_m) - 0.32).abs() < 1e-4);
    }

    #[test]
    fn parts_in_an_area_that_is_not_convex_add_up() {
        let l_m = [(-2.0, -2.0), (2.0, -2.0), (2.0, 0.1), (0.2, 0.1), (0.2, 2.0), (-2.0, 2.0)].map(Vec2::from);
        let cell = VoronoiCell::new(Vec2::ZERO, &mut []);
        // Brute force: a fine grid over the disc.
        let grid =
            (-500..500).flat_map(|x| (-500..500).map(move |y| Vec2::new(x as f32 + 0.5, y as f32 + 0.5) / 500.0));
        let inside = grid.filter(|at_m| at_m.length() <= 1.0 && crate::maths::polygon::contains(&l_m, *at_m)).count();
        let expected_m2 = inside as f64 / 250_000.0;
        assert!((cell.size_within_m2(&l_m) - expected_m2).abs() < 0.02, "{expected_m2}");
    }

    #[test]
    fn agents_at_the_same_position_share_a_cell() {
        let cell = VoronoiCell::new(Vec2::ZERO, &mut [Vec2::ZERO, Vec2::new(0.5, 0.0)]);
        assert!(cell.size_m2 > 1.0 && cell.size_m2 < PI);
    }
}

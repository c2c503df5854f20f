//! Discs kept outside walls: the position at which a disc stops, and the one to which it is pushed out.
//!
//! World, metres.

use glam::Vec2;

use crate::world::obstacles::polygons::Obstacles;
use crate::world::segment::nearest_on_segment;

/// Rounds of pushing a disc out of polygons: one for each wall of a niche, and one more.
const CLAMP_ROUNDS: usize = 4;
/// Distance from a wall at which a point without radius is put, m: more than f32 rounding at 1 km.
const OUTSIDE_M: f32 = 1e-4;

impl Obstacles {
    /// End of a disc's straight path: outside all walls, as [`Self::clamp_outside`] puts it, and on the same side of
    /// them as its start. A disc that starts inside a polygon may leave that polygon on any side.
    pub fn clamp_path(&self, from_m: Vec2, to_m: Vec2, radius_m: f32) -> Vec2 {
        // Mostly no wall is near.
        let mut near = self.grid.within(from_m.min(to_m) - radius_m, from_m.max(to_m) + radius_m);
        if near.next().is_none() && self.polygons_around(to_m).is_empty() {
            return to_m;
        }
        let start_polygons = self.polygons_around(from_m);
        let is_allowed = |to_m: &Vec2| {
            let ends_well = self.polygons_around(*to_m).iter().all(|polygon| start_polygons.contains(polygon));
            ends_well && self.crossings(from_m, *to_m, &start_polygons).next().is_none()
        };
        let direct_m = self.clamp_outside(to_m, radius_m);
        let stopped_m = || {
            let share = self.crossings(from_m, to_m, &start_polygons).fold(1.0, f64::min) as f32;
            let before_m = OUTSIDE_M * (to_m - from_m).normalize_or_zero();
            self.clamp_outside(from_m.lerp(to_m, share) - before_m, radius_m)
        };
        Some(direct_m).filter(is_allowed).or_else(|| Some(stopped_m()).filter(is_allowed)).unwrap_or(from_m)
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
        polygons.extend(self.polygons_around(position_m));
        polygons.sort_unstable();
        polygons.dedup();
        polygons.into_iter().fold(position_m, |position_m, polygon| self.pushed_out_of(polygon, position_m, radius_m))
    }

    /// Moves a disc out of one polygon, over the edge nearest to its centre.
    fn pushed_out_of(&self, polygon: u32, position_m: Vec2, radius_m: f32) -> Vec2 {
        let inside = self.polygons_around(position_m).contains(&polygon);
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

    /// The edge of a polygon nearest to a position, and its nearest point: of all edges, or of those near the disc.
    fn nearest_edge(&self, polygon: u32, position_m: Vec2, radius_m: f32, of_all: bool) -> Option<(u32, Vec2)> {
        let [first, end] = [0, 1].map(|next| self.first_corners[polygon as usize + next] as u32);
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

#[cfg(test)]
mod tests {
    use proptest::prelude::*;

    use super::*;
    use crate::world::obstacles::polygons::tests::l_and_block;

    const RADIUS_M: f32 = 0.25;

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
        fn clamps_a_disc_out_of_walls_and_keeps_a_free_one(x in -1.0f32..5.0, y in -1.0f32..4.0) {
            let (obstacles, position_m) = (l_and_block(), Vec2::new(x, y));
            let free = !obstacles.contains(position_m) && distance_to_edges_m(&obstacles, position_m) >= RADIUS_M;
            let clamped_m = obstacles.clamp_outside(position_m, RADIUS_M);
            prop_assert!(!obstacles.contains(clamped_m), "{clamped_m} is inside");
            prop_assert!(!free || clamped_m == position_m);
            let in_the_gap = (2.9..3.5).contains(&clamped_m.x) && (-0.3..1.3).contains(&clamped_m.y);
            prop_assert!(in_the_gap || distance_to_edges_m(&obstacles, clamped_m) > RADIUS_M - 1e-3, "{clamped_m}");
        }
    }

    proptest! {
        #![proptest_config(ProptestConfig::with_cases(4000))]

        #[test]
        fn no_path_crosses_a_wall_however_far_and_thin(
            x in -1.0f32..5.0, y in -1.0f32..4.0, east in -30.0f32..30.0, north in -30.0f32..30.0, thin in 0.001f32..0.3,
        ) {
            let wall = |x: f32| vec![Vec2::new(x, -9.0), Vec2::new(x + thin, -9.0), Vec2::new(x + thin, 9.0), Vec2::new(x, 9.0)];
            let obstacles = Obstacles::new(&[wall(1.0), wall(2.0), wall(2.2)]);
            let from_m = Vec2::new(x, y);
            prop_assume!(!obstacles.contains(from_m));
            let ended_m = obstacles.clamp_path(from_m, from_m + Vec2::new(east, north), RADIUS_M);
            prop_assert!(!obstacles.contains(ended_m));
            let room = |at_m: Vec2| [1.0, 2.0, 2.2].iter().filter(|&&x| at_m.x > x + 0.5 * thin).count();
            let beyond_the_ends = ended_m.y.abs() > 9.0;
            prop_assert!(beyond_the_ends || room(from_m) == room(ended_m), "{from_m} {ended_m}");
        }
    }
}

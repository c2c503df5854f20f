//! An area on the ground: where a goal lies, where agents appear or are counted. World, metres.

use glam::{DVec2, Vec2};
use serde::{Deserialize, Serialize};

use crate::maths::polygon::{contains, signed_area_m2};
use crate::maths::random::SplitMix64;
use crate::world::segment::nearest_on_segment;

/// Positions drawn in the bounding box of a polygon before the nearest position in the polygon is taken.
const DRAWS_MAX: usize = 64;

/// Corners of the polygon around a disc: it reaches 1 % farther.
const DISC_CORNERS: u32 = 24;

/// An area on the ground.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub enum Area {
    /// A disc; a radius of 0 is a point.
    Disc {
        /// Centre, world, m.
        centre_m: Vec2,
        /// Radius, m.
        radius_m: f32,
    },
    /// Corners of a simple polygon, world, m.
    Polygon(Vec<Vec2>),
}

impl Area {
    /// A single point.
    pub fn point(centre_m: Vec2) -> Self {
        Self::Disc { centre_m, radius_m: 0.0 }
    }

    /// A rectangle along the axes, from its lower left to its upper right corner.
    pub fn rectangle(low_m: Vec2, high_m: Vec2) -> Self {
        Self::Polygon(vec![low_m, Vec2::new(high_m.x, low_m.y), high_m, Vec2::new(low_m.x, high_m.y)])
    }

    /// The area at an offset.
    pub(crate) fn moved(&self, by_m: Vec2) -> Self {
        match self {
            Self::Disc { centre_m, radius_m } => Self::Disc { centre_m: *centre_m + by_m, radius_m: *radius_m },
            Self::Polygon(corners_m) => Self::Polygon(corners_m.iter().map(|&corner_m| corner_m + by_m).collect()),
        }
    }

    /// The corners of its outline, counter-clockwise, m; of a disc those of a polygon around it.
    pub fn outline_m(&self) -> Vec<Vec2> {
        match self {
            Self::Disc { centre_m, radius_m } => {
                let angle_rad = |corner: u32| std::f32::consts::TAU * corner as f32 / DISC_CORNERS as f32;
                let reach_m = radius_m / libm::cosf(0.5 * angle_rad(1));
                let corner_m = |corner: u32| {
                    let (sin, cos) = libm::sincosf(angle_rad(corner));
                    *centre_m + reach_m * Vec2::new(cos, sin)
                };
                (0..DISC_CORNERS).map(corner_m).collect()
            }
            Self::Polygon(corners_m) if signed_area_m2(corners_m) < 0.0 => corners_m.iter().rev().copied().collect(),
            Self::Polygon(corners_m) => corners_m.clone(),
        }
    }

    /// Distance from a position to the area, m; 0 inside.
    pub fn distance_m(&self, position_m: Vec2) -> f32 {
        position_m.distance(self.nearest_m(position_m))
    }

    /// The nearest position in the area; a position inside is its own.
    pub fn nearest_m(&self, position_m: Vec2) -> Vec2 {
        match self {
            Self::Disc { centre_m, radius_m } => *centre_m + (position_m - *centre_m).clamp_length_max(*radius_m),
            Self::Polygon(corners_m) if contains(corners_m, position_m) => position_m,
            Self::Polygon(corners_m) => nearest_on_outline(corners_m, position_m),
        }
    }

    /// Whether a position lies in the area; the outline of a disc belongs to it.
    pub fn holds(&self, position_m: Vec2) -> bool {
        match self {
            Self::Disc { centre_m, radius_m } => centre_m.distance_squared(position_m) <= radius_m * radius_m,
            Self::Polygon(corners_m) => contains(corners_m, position_m),
        }
    }

    /// Centre of gravity, m.
    pub fn centre_m(&self) -> Vec2 {
        match self {
            Self::Disc { centre_m, .. } => *centre_m,
            Self::Polygon(corners_m) => centroid_m(corners_m),
        }
    }

    /// Least and greatest corner of its box, m.
    pub fn bounds_m(&self) -> [Vec2; 2] {
        match self {
            Self::Disc { centre_m, radius_m } => [*centre_m - *radius_m, *centre_m + *radius_m],
            Self::Polygon(corners_m) => {
                let low_m = corners_m.iter().copied().fold(Vec2::INFINITY, Vec2::min);
                [low_m, corners_m.iter().copied().fold(Vec2::NEG_INFINITY, Vec2::max)]
            }
        }
    }

    /// The centre, and the positions in the area of a lattice over its box with this number of rows and columns.
    pub(crate) fn lattice_m(&self, count: u16) -> impl Iterator<Item = Vec2> {
        let [low_m, high_m] = self.bounds_m();
        let share = move |index: u16| (f32::from(index) + 0.5) / f32::from(count);
        let cells = (0..count).flat_map(move |row| (0..count).map(move |column| Vec2::new(share(column), share(row))));
        let positions_m = cells.map(move |cell| low_m + cell * (high_m - low_m));
        [self.nearest_m(self.centre_m())].into_iter().chain(positions_m.filter(|&position_m| self.holds(position_m)))
    }

    /// Greatest extent along one of its edges, m: the width of an exit. A disc's is its diameter.
    pub fn width_m(&self) -> f32 {
        match self {
            Self::Disc { radius_m, .. } => 2.0 * radius_m,
            Self::Polygon(corners_m) => {
                let ends_m = corners_m.iter().zip(corners_m.iter().cycle().skip(1));
                ends_m.map(|(from_m, to_m)| from_m.distance(*to_m)).fold(0.0, f32::max)
            }
        }
    }

    /// A position drawn uniformly from the area.
    pub fn draw_m(&self, random: &mut SplitMix64) -> Vec2 {
        match self {
            Self::Disc { centre_m, radius_m } => {
                let (sin, cos) = libm::sincosf((random.unit() * std::f64::consts::TAU) as f32);
                *centre_m + *radius_m * libm::sqrtf(random.unit() as f32) * Vec2::new(cos, sin)
            }
            Self::Polygon(corners_m) => {
                let [low_m, high_m] = self.bounds_m();
                let mut in_box_m = || {
                    let shares = Vec2::new(random.unit() as f32, random.unit() as f32);
                    low_m + shares * (high_m - low_m)
                };
                let mut drawn_m = in_box_m();
                for _ in 1..DRAWS_MAX {
                    if contains(corners_m, drawn_m) {
                        return drawn_m;
                    }
                    drawn_m = in_box_m();
                }
                self.nearest_m(drawn_m)
            }
        }
    }
}

fn nearest_on_outline(corners_m: &[Vec2], position_m: Vec2) -> Vec2 {
    let ends_m = corners_m.iter().zip(corners_m.iter().cycle().skip(1));
    let nearest_m = ends_m.map(|(&from_m, &to_m)| nearest_on_segment(position_m, from_m, to_m));
    let nearer = |a: Vec2, b: Vec2| if b.distance(position_m) < a.distance(position_m) { b } else { a };
    nearest_m.reduce(nearer).unwrap_or(position_m)
}

/// Centre of gravity of a polygon; of its corners where the polygon has no area.
fn centroid_m(corners_m: &[Vec2]) -> Vec2 {
    let first_m = corners_m.first().map_or(DVec2::ZERO, |&corner_m| DVec2::from(corner_m));
    let from_first_m = |corner_m: Vec2| DVec2::from(corner_m) - first_m;
    let twice_area_m2 = 2.0 * signed_area_m2(corners_m);
    if twice_area_m2.abs() < 1e-9 {
        let sum_m: DVec2 = corners_m.iter().map(|&corner_m| from_first_m(corner_m)).sum();
        return (first_m + sum_m / corners_m.len().max(1) as f64).as_vec2();
    }
    let triangles = corners_m.windows(2).map(|ends_m| {
        let [a_m, b_m] = [from_first_m(ends_m[0]), from_first_m(ends_m[1])];
        (a_m + b_m) * a_m.perp_dot(b_m)
    });
    (first_m + triangles.sum::<DVec2>() / (3.0 * twice_area_m2)).as_vec2()
}

#[cfg(test)]
mod tests {
    use super::*;

    fn l_shape() -> Area {
        Area::Polygon([(0.0, 0.0), (4.0, 0.0), (4.0, 1.0), (1.0, 1.0), (1.0, 3.0), (0.0, 3.0)].map(Vec2::from).to_vec())
    }

    #[test]
    fn distances_are_zero_inside_only() {
        let disc = Area::Disc { centre_m: Vec2::new(1.0, 0.0), radius_m: 2.0 };
        assert_eq!([disc.distance_m(Vec2::ZERO), disc.distance_m(Vec2::new(5.0, 0.0))], [0.0, 2.0]);
        assert_eq!(l_shape().distance_m(Vec2::new(3.0, 2.0)), 1.0);
        assert_eq!(l_shape().nearest_m(Vec2::new(2.0, 0.5)), Vec2::new(2.0, 0.5));
        assert_eq!(Area::point(Vec2::X).distance_m(Vec2::ZERO), 1.0);
    }

    #[test]
    fn drawn_positions_fill_the_area_evenly() {
        let mut random = SplitMix64::new(3, 0);
        for area in [l_shape(), Area::Disc { centre_m: Vec2::new(5.0, 2.0), radius_m: 1.5 }] {
            let drawn_m: Vec<Vec2> = (0..20_000).map(|_| area.draw_m(&mut random)).collect();
            assert!(drawn_m.iter().all(|&position_m| area.distance_m(position_m) < 1e-5));
            let mean_m = drawn_m.iter().sum::<Vec2>() / drawn_m.len() as f32;
            assert!(mean_m.distance(area.centre_m()) < 0.03, "{mean_m} instead of {}", area.centre_m());
        }
    }

    #[test]
    fn a_sliver_still_gives_a_position_on_it() {
        let sliver = Area::Polygon([(0.0, 0.0), (100.0, 100.0), (100.0, 100.001)].map(Vec2::from).to_vec());
        assert!(sliver.distance_m(sliver.draw_m(&mut SplitMix64::new(1, 0))) < 1e-3);
    }
}

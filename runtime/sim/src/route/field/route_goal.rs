//! The goal of a field: points, or an area that agents enter at its nearest point.
//!
//! A field is flooded from points. For an area these are its corners and points along its border, [`SPACING_M`] apart,
//! or more where they would be more than [`POINTS_MAX`]; for a disc, 16 points. At a distance d from the border,
//! distances are too long by at most s²/8d with the spacing s: 4 mm at 2 m. A position from which the nearest point of
//! the area is in sight gets the exact point. World, metres.

use glam::{DVec2, Vec2};

use crate::maths::polygon::contains;
use crate::route::mesh::locate::nearest_on_edge;

/// Greatest distance of two points on the border of an area that is not too large for [`POINTS_MAX`], m.
const SPACING_M: f64 = 0.25;
/// Greatest number of points on the border of an area, corners left out: the time of a field grows with it.
const POINTS_MAX: f64 = 32.0;

/// Points of the unit circle at 0°, 22.5°, 45° and 67.5°.
const FIRST_QUARTER: [[f64; 2]; 4] = [
    [1.0, 0.0],
    [0.923_879_532_511_286_7, 0.382_683_432_365_089_8],
    [std::f64::consts::FRAC_1_SQRT_2; 2],
    [0.382_683_432_365_089_8, 0.923_879_532_511_286_7],
];

/// A goal that agents share.
#[derive(Clone, Debug, PartialEq)]
pub enum RouteGoal {
    /// The nearest of some points, m.
    Points(Vec<Vec2>),
    /// A line, such as an exit, between two ends, m.
    Line([Vec2; 2]),
    /// A simple polygon, m.
    Polygon(Vec<Vec2>),
    /// A disc.
    Disc {
        /// Its centre, m.
        centre_m: Vec2,
        /// Its radius, m.
        radius_m: f32,
    },
}

impl RouteGoal {
    /// The points from which a field is flooded.
    pub(crate) fn flooded_points_m(&self) -> Vec<DVec2> {
        match self {
            Self::Points(points_m) => points_m.iter().copied().map(DVec2::from).collect(),
            Self::Line(ends_m) => along(ends_m, false),
            Self::Polygon(corners_m) => along(corners_m, true),
            Self::Disc { centre_m, radius_m } => {
                let quarter = |at: DVec2| [at, at.perp(), -at, -at.perp()];
                let point_m = |at: DVec2| DVec2::from(*centre_m) + f64::from(*radius_m) * at;
                FIRST_QUARTER.map(DVec2::from).into_iter().flat_map(quarter).map(point_m).collect()
            }
        }
    }

    /// The point of an area that is nearest to a position: the position itself within the area. None for points.
    pub(crate) fn nearest_m(&self, point_m: DVec2) -> Option<DVec2> {
        let nearest_of = |corners_m: &[Vec2], closed| {
            let edges_m = edges(corners_m, closed).map(|[from_m, to_m]| nearest_on_edge(point_m, from_m, to_m));
            edges_m.min_by(|a, b| a.distance_squared(point_m).total_cmp(&b.distance_squared(point_m)))
        };
        match self {
            Self::Points(_) => None,
            Self::Line(ends_m) => nearest_of(ends_m, false),
            Self::Polygon(corners_m) if contains(corners_m, point_m.as_vec2()) => Some(point_m),
            Self::Polygon(corners_m) => nearest_of(corners_m, true),
            Self::Disc { centre_m, radius_m } => {
                let centre_m = DVec2::from(*centre_m);
                Some(centre_m + (point_m - centre_m).clamp_length_max(f64::from(*radius_m)))
            }
        }
    }
}

fn edges(corners_m: &[Vec2], closed: bool) -> impl Iterator<Item = [DVec2; 2]> {
    let count = if closed { corners_m.len() } else { corners_m.len().saturating_sub(1) };
    (0..count).map(|corner| [corner, (corner + 1) % corners_m.len()].map(|at| DVec2::from(corners_m[at])))
}

/// The corners of a polyline and points between them.
fn along(corners_m: &[Vec2], closed: bool) -> Vec<DVec2> {
    let length_m: f64 = edges(corners_m, closed).map(|[from_m, to_m]| from_m.distance(to_m)).sum();
    let spacing_m = SPACING_M.max(length_m / POINTS_MAX);
    let mut points_m: Vec<DVec2> = Vec::new();
    for [from_m, to_m] in edges(corners_m, closed) {
        let count = libm::ceil(from_m.distance(to_m) / spacing_m).max(1.0);
        points_m.extend((0..count as u32).map(|index| from_m.lerp(to_m, f64::from(index) / count)));
    }
    if !closed {
        points_m.extend(corners_m.last().copied().map(DVec2::from));
    }
    points_m
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn points_lie_along_the_border() {
        let square = RouteGoal::Polygon([[0.0, 0.0], [1.0, 0.0], [1.0, 1.0], [0.0, 1.0]].map(Vec2::from).to_vec());
        let points_m = square.flooded_points_m();
        assert_eq!((points_m.len(), points_m[1]), (16, DVec2::new(0.25, 0.0)));
        assert_eq!(RouteGoal::Line([Vec2::ZERO, Vec2::new(100.0, 0.0)]).flooded_points_m().len(), 33);
    }

    #[test]
    fn nearest_points_of_areas() {
        let at_m = DVec2::new(3.0, 0.5);
        let square = RouteGoal::Polygon([[0.0, 0.0], [1.0, 0.0], [1.0, 1.0], [0.0, 1.0]].map(Vec2::from).to_vec());
        assert_eq!(square.nearest_m(at_m), Some(DVec2::new(1.0, 0.5)));
        assert_eq!(square.nearest_m(DVec2::splat(0.5)), Some(DVec2::splat(0.5)));
        assert_eq!(RouteGoal::Line([Vec2::ZERO, Vec2::Y]).nearest_m(at_m), Some(DVec2::new(0.0, 0.5)));
        let disc = RouteGoal::Disc { centre_m: Vec2::new(0.0, 0.5), radius_m: 1.0 };
        assert_eq!(disc.nearest_m(at_m), Some(DVec2::new(1.0, 0.5)));
        assert_eq!(RouteGoal::Points(vec![Vec2::ZERO]).nearest_m(at_m), None);
    }
}

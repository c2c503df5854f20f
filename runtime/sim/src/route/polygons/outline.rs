//! The outline of one obstacle on the grid, ready to be grown.
//!
//! Cases:
//!
//! 1. convex, or a wall without thickness between two points: one contour;
//! 2. simple: one contour;
//! 3. anything else (the outline crosses or touches itself, or the grid makes it do so): the contours of all that it
//!    winds around, and its segments, which are walls even where they enclose nothing.

use glam::Vec2;

use crate::route::polygons::error::RouteError;
use crate::route::polygons::grid::{Contour, GridPoint, grid_point, side};
use crate::route::polygons::union::united;

/// The outline of one obstacle.
#[derive(Debug, Default)]
pub(crate) struct Outline {
    /// A convex contour.
    pub(crate) convex: Option<Contour>,
    /// Contours that are not convex; those that run clockwise bound a hole.
    pub(crate) contours: Vec<Contour>,
    /// Closed polylines whose segments are walls without an inside.
    pub(crate) walls: Vec<Contour>,
}

impl Outline {
    /// The outline of a polygon.
    ///
    /// # Errors
    /// If a corner does not fit the grid.
    pub(crate) fn new(polygon_m: &[Vec2]) -> Result<Self, RouteError> {
        let mut corners = polygon_m.iter().map(|corner_m| grid_point(*corner_m)).collect::<Result<Contour, _>>()?;
        corners.dedup();
        while corners.len() > 1 && corners.first() == corners.last() {
            corners.pop();
        }
        match corners[..] {
            [] => return Ok(Self::default()),
            [point] => return Ok(Self::of_convex(vec![point, GridPoint::new(point.x + 1, point.y)])),
            _ if area(&corners) < 0 => corners.reverse(),
            _ => {}
        }
        if is_convex(&corners) {
            return Ok(Self::of_convex(corners));
        }
        let contours = united(std::iter::once(&corners));
        if contours.len() == 1 && contours[0].len() == corners.len() {
            return Ok(Self { contours, ..Self::default() });
        }
        let reversed = corners.iter().rev().copied().collect();
        Ok(Self { convex: None, contours, walls: vec![corners, reversed] })
    }

    /// The outline of a wall without thickness around a polygon.
    ///
    /// # Errors
    /// If a corner does not fit the grid.
    pub(crate) fn wall_around(polygon_m: &[Vec2]) -> Result<Self, RouteError> {
        let Self { convex, contours, .. } = Self::new(polygon_m)?;
        let both = |contour: Contour| [contour.iter().rev().copied().collect(), contour];
        let walls = convex.into_iter().chain(contours).flat_map(both).collect();
        Ok(Self { walls, ..Self::default() })
    }

    fn of_convex(contour: Contour) -> Self {
        Self { convex: Some(contour), ..Self::default() }
    }
}

/// Twice the signed area, in grid cells.
fn area(corners: &[GridPoint]) -> i64 {
    let first = corners[0];
    corners.windows(2).map(|pair| side(first, pair[0], pair[1])).sum()
}

/// Whether a contour turns left only, and once around. A wall between two points does.
fn is_convex(corners: &[GridPoint]) -> bool {
    let count = corners.len();
    let edge = |index: usize| {
        let [a, b] = [corners[index % count], corners[(index + 1) % count]];
        [i64::from(b.x) - i64::from(a.x), i64::from(b.y) - i64::from(a.y)]
    };
    let is_upward = |[x, y]: [i64; 2]| y > 0 || (y == 0 && x > 0);
    let turns_left = |index| {
        let ([x, y], [next_x, next_y]) = (edge(index), edge(index + 1));
        let turn = x * next_y - y * next_x;
        turn > 0 || (turn == 0 && (count == 2 || x * next_x + y * next_y > 0))
    };
    let rounds = (0..count).filter(|&index| !is_upward(edge(index)) && is_upward(edge(index + 1))).count();
    rounds == 1 && (0..count).all(turns_left)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn outline(corners_m: &[[f32; 2]]) -> Outline {
        Outline::new(&corners_m.iter().copied().map(Vec2::from).collect::<Vec<_>>()).expect("near the origin")
    }

    #[test]
    fn outlines_are_sorted_into_their_cases() {
        let square = outline(&[[0.0, 0.0], [0.0, 1.0], [1.0, 1.0], [1.0, 0.0], [0.0, 0.0]]);
        assert_eq!(square.convex.map(|corners| corners.len()), Some(4));
        assert_eq!(outline(&[[0.0, 0.0], [3.0, 1.0]]).convex.map(|corners| corners.len()), Some(2));
        assert_eq!(outline(&[[2.0, 2.0]; 3]).convex.map(|corners| corners.len()), Some(2));
        let corner = outline(&[[0.0, 0.0], [2.0, 0.0], [2.0, 1.0], [1.0, 1.0], [1.0, 2.0], [0.0, 2.0]]);
        assert!(corner.convex.is_none() && corner.contours.len() == 1 && corner.walls.is_empty());
        let bow_tie = outline(&[[0.0, 0.0], [1.0, 1.0], [1.0, 0.0], [0.0, 1.0]]);
        assert_eq!((bow_tie.contours.len(), bow_tie.walls.len()), (2, 2));
        let folded = outline(&[[0.0, 0.0], [2.0, 0.0], [1.0, 0.0]]);
        assert_eq!((folded.contours.len(), folded.walls.len()), (0, 2));
        assert!(outline(&[]).contours.is_empty());
    }

    #[test]
    fn a_pentagram_is_not_convex() {
        let star = outline(&[[0.0, 3.0], [-2.0, -3.0], [3.0, 1.0], [-3.0, 1.0], [2.0, -3.0]]);
        assert!(star.convex.is_none() && star.contours.len() == 1 && star.contours[0].len() == 10);
    }

    #[test]
    fn coordinates_beyond_the_grid_are_refused() {
        for far in [f32::NAN, f32::INFINITY, 16_001.0] {
            assert!(Outline::new(&[Vec2::ZERO, Vec2::new(1.0, far), Vec2::X]).is_err());
        }
    }
}

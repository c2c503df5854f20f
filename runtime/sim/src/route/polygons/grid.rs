//! The grid on which the polygons of a ground are united: 1/1024 m, whole numbers.
//!
//! Every corner of a mesh lies on the grid. f64 holds such coordinates exactly in metres too, and so does f32 within 16
//! km. World axes.

use glam::{DVec2, Vec2};
use i_overlay::i_float::int::point::IntPoint;

use crate::route::polygons::error::RouteError;

/// Grid lines per metre.
pub(crate) const LINES_PER_M: f64 = 1024.0;
/// Greatest coordinate of an input, m: with growth and margin, f32 still resolves the grid.
const COORDINATE_MAX_M: f32 = 16_000.0;

/// A point of the grid, in grid lines.
pub(crate) type GridPoint = IntPoint<i32>;
/// A closed polyline of grid points with the solid on its left.
pub(crate) type Contour = Vec<GridPoint>;

/// The grid point nearest to a point.
///
/// # Errors
/// If the point is not finite, or is too far from the origin.
pub(crate) fn grid_point(point_m: Vec2) -> Result<GridPoint, RouteError> {
    // Written so that NaN fails.
    if point_m.abs().max_element() <= COORDINATE_MAX_M && point_m.is_finite() {
        return Ok(rounded(DVec2::from(point_m) * LINES_PER_M));
    }
    Err(RouteError::Coordinate { x_m: point_m.x, y_m: point_m.y })
}

/// The grid point nearest to a position in grid lines.
pub(crate) fn rounded(lines: DVec2) -> GridPoint {
    GridPoint::new(libm::round(lines.x) as i32, libm::round(lines.y) as i32)
}

/// A grid point in metres, exactly.
pub(crate) fn metres(point: GridPoint) -> DVec2 {
    lines(point) / LINES_PER_M
}

/// A grid point as a vector, in grid lines.
pub(crate) fn lines(point: GridPoint) -> DVec2 {
    DVec2::new(f64::from(point.x), f64::from(point.y))
}

/// Twice the area of the triangle a, b, c in grid cells: positive where c lies left of the line from a to b. Exact.
pub(crate) fn side(a: GridPoint, b: GridPoint, c: GridPoint) -> i64 {
    let [ab, ac] = [b, c].map(|end| [i64::from(end.x) - i64::from(a.x), i64::from(end.y) - i64::from(a.y)]);
    ab[0] * ac[1] - ab[1] * ac[0]
}

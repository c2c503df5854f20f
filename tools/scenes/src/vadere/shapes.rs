//! Shapes of a Vadere scenario, checked: corners, boxes, range. World, metres.

use crate::geometry::polygon::{is_simple, without_repeats};
use crate::json_place::JsonStep;
use crate::scene::{Point, Shape};

/// Greatest coordinate, m; that of scenario files.
const COORDINATE_MAX_M: f64 = 10_000.0;
/// Corners of the polygon that stands for a circle.
const CIRCLE_CORNERS: usize = 16;
/// Name of the profile of all agents.
pub(crate) const PROFILE: &str = "pedestrian";

/// A mistake in an item of the file, and how to mend it.
pub(crate) type VadereFault = (String, &'static str);

/// A mistake, and the steps from the topography to its item.
pub(crate) type PlacedFault = (Vec<JsonStep>, VadereFault);

/// The mistake of an item of a list of the topography.
pub(crate) fn at_item(list: &'static str, index: usize) -> impl Fn(VadereFault) -> PlacedFault {
    move |fault| (vec![JsonStep::Key(list), JsonStep::Item(index)], fault)
}

/// The corners of a shape, those of a circle on a polygon about it.
pub(crate) fn corners_m(shape: &Shape) -> Vec<Point> {
    match shape {
        Shape::Point(at_m) => vec![*at_m],
        Shape::Rect([left, low], [right, high]) => vec![[*left, *low], [*right, *low], [*right, *high], [*left, *high]],
        Shape::Polygon(corners_m) => corners_m.clone(),
        Shape::Circle([x, y], radius_m) => {
            let corner = |index: usize| {
                let (sin, cos) = libm::sincos(std::f64::consts::TAU * index as f64 / CIRCLE_CORNERS as f64);
                [x + radius_m * cos, y + radius_m * sin].map(|metres| (metres * 1e3).round() / 1e3)
            };
            (0..CIRCLE_CORNERS).map(corner).collect()
        }
    }
}

/// Checks that all points of a shape are near the origin.
pub(crate) fn check_shape(shape: &Shape) -> Result<(), VadereFault> {
    check_points(&corners_m(shape))?;
    match shape {
        Shape::Polygon(corners_m) if !is_simple(&without_repeats(corners_m)) => {
            Err(("the polygon of a target or source crosses itself".into(), "list its corners in order"))
        }
        _ => Ok(()),
    }
}

/// Checks that all points are near the origin.
pub(crate) fn check_points(points_m: &[Point]) -> Result<(), VadereFault> {
    match points_m.iter().flatten().find(|metres| metres.is_nan() || metres.abs() > COORDINATE_MAX_M) {
        None => Ok(()),
        Some(metres) => Err((format!("{metres} m is not within 10 km of the origin"), "move the scene to the origin")),
    }
}

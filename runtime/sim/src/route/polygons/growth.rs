//! Obstacles grown by the distance that routes keep from walls.
//!
//! Each edge gets a band of that width on its right. Each convex corner gets a fan **circumscribed** about the arc: one
//! segment per 45° of turn or less, so its corners lie at most 1.083 times the distance from the obstacle's. No point
//! outside the grown contours is therefore nearer to the obstacle than the distance. Bisectors give the fans' normals;
//! no function of an angle is needed. A convex contour and its bands and fans make one convex contour.
//!
//! Grid lines.

use glam::DVec2;

use crate::route::polygons::grid::{Contour, GridPoint, lines, rounded, side};
use crate::route::polygons::outline::Outline;
use crate::route::polygons::union::Shape;

/// Cosine of the greatest turn of one segment of a fan, 45°, less rounding.
const SEGMENT_COS: f64 = std::f64::consts::FRAC_1_SQRT_2 - 1e-9;

/// Appends the shapes whose union is an obstacle grown by a distance.
pub(crate) fn grow(outline: &Outline, distance: f64, grown: &mut Vec<Shape>) {
    if let Some(contour) = &outline.convex {
        grown.push(vec![grown_convex(contour, distance)]);
    }
    for contour in &outline.contours {
        add_bands_and_fans(contour, distance, grown);
    }
    grown.push(outline.contours.clone());
    for wall in &outline.walls {
        add_bands_and_fans(wall, distance, grown);
    }
}

/// The outer contour of a convex one and its bands and fans.
fn grown_convex(contour: &Contour, distance: f64) -> Contour {
    let mut grown = Contour::new();
    for [before, at, after] in corners(contour) {
        let normals = [normal(before, at), normal(at, after)];
        fan(lines(at), normals, distance, &mut grown);
    }
    grown
}

/// Appends the bands on the right of a contour's edges and the fans at its convex corners.
pub(crate) fn add_bands_and_fans(contour: &Contour, distance: f64, grown: &mut Vec<Shape>) {
    for [before, at, after] in corners(contour) {
        let normals = [normal(before, at), normal(at, after)];
        let outer = |point| rounded(lines(point) + distance * normals[1]);
        grown.push(vec![vec![outer(at), outer(after), after, at]]);
        let turn = side(before, at, after);
        let folds_back = turn == 0 && normals[0].dot(normals[1]) < 0.0;
        if turn > 0 || folds_back {
            let mut corner = vec![at];
            fan(lines(at), normals, distance, &mut corner);
            grown.push(vec![corner]);
        }
    }
}

/// Each corner with the ones before and after it.
fn corners(contour: &Contour) -> impl Iterator<Item = [GridPoint; 3]> {
    let count = contour.len();
    (0..count).map(move |index| [contour[(index + count - 1) % count], contour[index], contour[(index + 1) % count]])
}

/// Unit normal to the right of an edge.
fn normal(from: GridPoint, to: GridPoint) -> DVec2 {
    let along = lines(to) - lines(from);
    -along.perp() / along.length()
}

/// Appends the outer corners of a fan, from one normal counter-clockwise to the other, both ends included.
fn fan(centre: DVec2, normals: [DVec2; 2], distance: f64, corners: &mut Contour) {
    corners.push(rounded(centre + distance * normals[0]));
    add_tangents(centre, normals, distance, corners);
    corners.push(rounded(centre + distance * normals[1]));
}

/// Appends the points at which the tangents of neighbouring normals meet; wide turns are bisected.
fn add_tangents(centre: DVec2, [from, to]: [DVec2; 2], distance: f64, corners: &mut Contour) {
    let cos = from.dot(to);
    if cos >= SEGMENT_COS {
        corners.push(rounded(centre + distance * (from + to) / (1.0 + cos)));
        return;
    }
    let sum = from + to;
    // The bisector of a fold is the direction of the edge before it.
    let bisector = if sum.length_squared() > 1e-12 { sum / sum.length() } else { from.perp() };
    add_tangents(centre, [from, bisector], distance, corners);
    add_tangents(centre, [bisector, to], distance, corners);
}

#[cfg(test)]
mod tests {
    use glam::Vec2;

    use super::*;
    use crate::maths::polygon::{closest_distance_m, contains};
    use crate::route::polygons::grid::metres;

    #[test]
    fn grown_corners_keep_the_distance() {
        let corners_m = [[0.0, 0.0], [3.0, 0.0], [3.0, 0.3], [0.1, 0.2], [2.0, 4.0]].map(Vec2::from).to_vec();
        let mut grown = Vec::new();
        grow(&Outline::new(&corners_m).expect("near the origin"), 256.0, &mut grown);
        let grown_m: Vec<Vec<Vec2>> = grown
            .iter()
            .flatten()
            .map(|contour| contour.iter().map(|corner| metres(*corner).as_vec2()).collect())
            .collect();
        for (x, y) in (-50..200).flat_map(|x| (-50..250).map(move |y| (x, y))) {
            let point_m = Vec2::new(x as f32, y as f32) * 0.02 + 0.000_7;
            let distance_m = if contains(&corners_m, point_m) { 0.0 } else { closest_distance_m(&corners_m, point_m) };
            let inside = grown_m.iter().any(|contour_m| contains(contour_m, point_m));
            assert!(inside || distance_m > 0.248, "{point_m} {distance_m}");
            assert!(!inside || distance_m < 0.25 * 1.083 + 0.002, "{point_m} {distance_m}");
        }
    }
}

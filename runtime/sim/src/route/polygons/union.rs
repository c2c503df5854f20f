//! Unions of many polygons, two neighbours at a time.
//!
//! A union of polygons costs as much as their edges cross. A wall of a thousand short edges has a thousand bands, of
//! which hundreds lie one over the other; so have polygons in a heap. Where there are many, neighbours are therefore
//! united first, then the neighbours among these unions, and so on: what lies inside is gone before the rest comes.
//! Eight stars of 2,000 corners in a heap take 2.8 s at once, and 0.2 s by twos.
//!
//! Each round rounds crossings to the grid, by up to half a line along either axis ([`shift_lines`]).

use i_overlay::core::fill_rule::FillRule;
use i_overlay::core::overlay::{IntOverlayOptions, Overlay, ShapeType};
use i_overlay::core::overlay_rule::OverlayRule;
use i_overlay::core::solver::Solver;
use rayon::prelude::*;

use crate::maths::morton::morton_code;
use crate::route::polygons::error::RouteError;
use crate::route::polygons::grid::Contour;

/// Contours that belong together: outlines counter-clockwise, their holes clockwise.
pub(crate) type Shape = Vec<Contour>;

/// Corners up to which all shapes are united at once.
const TOGETHER_MAX: usize = 8_192;
/// Greatest number of corners of a ground: a mesh of as many takes about a second and 300 MB.
const CORNERS_MAX: usize = 1_000_000;

/// The contours of the union of some shapes.
pub(crate) fn united<'a>(contours: impl Iterator<Item = &'a Contour> + Clone) -> Shape {
    united_by(Solver::AUTO, contours)
}

fn united_by<'a>(solver: Solver, contours: impl Iterator<Item = &'a Contour> + Clone) -> Shape {
    let corners = contours.clone().map(Vec::len).sum();
    let mut overlay = Overlay::<i32>::new_custom(corners, IntOverlayOptions::default(), solver);
    for contour in contours {
        overlay.add_contour(contour, ShapeType::Subject);
    }
    overlay.overlay(OverlayRule::Subject, FillRule::NonZero).into_iter().flatten().collect()
}

/// The contours of one union minus another.
///
/// # Errors
/// If the contours cross too often.
pub(crate) fn difference(ground: Vec<Shape>, walls: Vec<Shape>) -> Result<Shape, RouteError> {
    let (ground, walls) = (few(ground)?, few(walls)?);
    let mut overlay = Overlay::<i32>::new(corners(&ground) + corners(&walls));
    for contour in ground.iter().flatten() {
        overlay.add_contour(contour, ShapeType::Subject);
    }
    for contour in walls.iter().flatten() {
        overlay.add_contour(contour, ShapeType::Clip);
    }
    let shape: Shape = overlay.overlay(OverlayRule::Difference, FillRule::NonZero).into_iter().flatten().collect();
    check(std::slice::from_ref(&shape), CORNERS_MAX)?;
    Ok(shape)
}

/// Distance by which the union of some shapes may lie beside their edges, grid lines, beyond that of one union.
pub(crate) fn shift_lines(shapes: &[Shape]) -> f64 {
    f64::from(rounds(shapes)) * std::f64::consts::FRAC_1_SQRT_2
}

/// Number of rounds in which shapes are united two by two.
fn rounds(shapes: &[Shape]) -> u32 {
    if corners(shapes) > TOGETHER_MAX { shapes.len().next_power_of_two().ilog2() } else { 0 }
}

/// Few shapes with the same union.
///
/// # Errors
/// If they have too many corners.
pub(crate) fn few(mut shapes: Vec<Shape>) -> Result<Vec<Shape>, RouteError> {
    let rounds = rounds(&shapes);
    if rounds > 0 {
        shapes.sort_by_cached_key(place);
    }
    let most = corners(&shapes).max(CORNERS_MAX);
    for _ in 0..rounds {
        let neighbours = shapes.par_chunks(2);
        // The solver that is quicker where edges cross often.
        shapes = neighbours.map(|shapes| united_by(Solver::FRAG, shapes.iter().flatten())).collect();
        check(&shapes, most)?;
    }
    Ok(shapes)
}

fn check(shapes: &[Shape], most: usize) -> Result<(), RouteError> {
    let corners = corners(shapes);
    if corners > most { Err(RouteError::Corners { corners, most }) } else { Ok(()) }
}

fn corners(shapes: &[Shape]) -> usize {
    shapes.iter().flatten().map(Vec::len).sum()
}

/// Place of a shape's first corner along a Morton curve.
fn place(shape: &Shape) -> u64 {
    let unsigned = |coordinate: i32| coordinate.cast_unsigned() ^ (1 << 31);
    let first = shape.iter().flatten().next();
    first.map_or(0, |corner| morton_code(unsigned(corner.x), unsigned(corner.y)))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::maths::random::SplitMix64;
    use crate::route::polygons::grid::{GridPoint, side};

    /// Triangles in a heap.
    fn heap(count: usize) -> Vec<Shape> {
        let mut random = SplitMix64::new(7, 0);
        let mut at = |within: f64| (random.unit() * within) as i32;
        let mut triangle = || {
            let [x, y] = [at(40_000.0), at(40_000.0)];
            let corners = [at(900.0), at(900.0), at(900.0), at(900.0)];
            let [a, b, c] = [[0, 0], [300 + corners[0], corners[1]], [corners[2], 300 + corners[3]]];
            let contour: Contour = [a, b, c].map(|[dx, dy]| GridPoint::new(x + dx, y + dy)).to_vec();
            if side(contour[0], contour[1], contour[2]) < 0 { contour.into_iter().rev().collect() } else { contour }
        };
        (0..count).map(|_| vec![triangle()]).collect()
    }

    /// Area in cells of the grid.
    fn area(shape: &Shape) -> f64 {
        let twice = |contour: &Contour| contour.windows(2).map(|pair| side(contour[0], pair[0], pair[1])).sum::<i64>();
        shape.iter().map(|contour| 0.5 * twice(contour) as f64).sum()
    }

    #[test]
    fn unions_by_twos_are_those_at_once() {
        let shapes = heap(4_000);
        let at_once = united(shapes.iter().flatten());
        let by_twos = few(shapes.clone()).expect("few corners");
        assert!(rounds(&shapes) == 12 && by_twos.len() == 1);
        let [at_once, by_twos] = [&at_once, &by_twos[0]].map(area);
        let apart = (at_once - by_twos).abs() / at_once;
        assert!(at_once > 1e8 && apart < 1e-4, "{at_once} {by_twos}");
    }

    #[test]
    fn few_shapes_stay_as_they_are() {
        let shapes = heap(1_000);
        assert_eq!((shift_lines(&shapes), few(shapes.clone())), (0.0, Ok(shapes)));
    }
}

//! Measured points against a curve that others published: the fundamental diagram and its like.

use glam::Vec2;
use tiny_skia::Pixmap;

use crate::plots::chart::axis::Axis;
use crate::plots::chart::mark::Mark;
use crate::plots::chart::plot::{Figure, line};
use crate::raster::palette::{INK, line_colour};

/// Sheet, pixels.
const SIZE_PX: [u32; 2] = [1600, 1000];
/// Left, top, width, height of the axes, pixels.
const PANEL_PX: [f32; 4] = [130.0, 210.0, 1410.0, 660.0];
const POINT_PX: f32 = 10.0;
const CURVE_PX: f32 = 3.0;

/// What is drawn; both axes start at 0 or below.
#[derive(Clone, Debug)]
pub struct Diagram<'a> {
    /// Heading.
    pub title: &'a str,
    /// Quantity and unit across.
    pub across: &'a str,
    /// Quantity and unit upwards.
    pub up: &'a str,
    /// Name of the curve, and points along it.
    pub curve: (&'a str, Vec<Vec2>),
    /// Name of what was measured, and the points.
    pub points: (&'a str, Vec<Vec2>),
}

/// The sheet.
pub fn diagram(diagram: &Diagram) -> Pixmap {
    let mut figure = Figure::new(SIZE_PX[0], SIZE_PX[1]);
    let ((curve_name, curve), (points_name, points)) = (&diagram.curve, &diagram.points);
    figure.title(diagram.title, Vec2::new(PANEL_PX[0], 70.0));
    let legend = [(Mark::Bar, INK, *curve_name), (Mark::Disc, line_colour(0), *points_name)];
    figure.legend(Vec2::new(PANEL_PX[0] + 10.0, 124.0), &legend);
    let from_zero = |label: &str, value: fn(&Vec2) -> f32| Axis {
        low: 0.0,
        ..Axis::around(label, curve.iter().chain(points).map(value).chain([0.0]))
    };
    let axes = [from_zero(diagram.across, |point| point.x), from_zero(diagram.up, |point| point.y)];
    let panel = figure.panel(PANEL_PX, axes);
    figure.polyline(&panel, curve.iter().copied(), line(INK, CURVE_PX));
    for point in points {
        figure.mark(&panel, *point, Mark::Disc, POINT_PX, line_colour(0));
    }
    figure.pixmap
}

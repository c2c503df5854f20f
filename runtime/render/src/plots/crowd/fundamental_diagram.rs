//! Measured points against a published curve: the fundamental diagram.

use glam::Vec2;
use tiny_skia::Pixmap;

use crate::plots::chart::axis::PlotAxis;
use crate::plots::chart::figure::{LineStyle, PlotFigure};
use crate::plots::chart::mark::PlotMark;
use crate::raster::palette::{INK, line_colour};

/// Size of the figure, pixels.
const SIZE_PX: [u32; 2] = [1600, 1000];
/// Left, top, width, height of the axes, pixels.
const PANEL_PX: [f32; 4] = [130.0, 210.0, 1410.0, 660.0];
/// Left end of the title's baseline, pixels.
const TITLE_PX: Vec2 = Vec2::new(130.0, 70.0);
/// Left end of the legend's baseline, pixels.
const LEGEND_PX: Vec2 = Vec2::new(140.0, 124.0);
/// Radius of a point, pixels.
const POINT_PX: f32 = 10.0;
/// Width of the curve, pixels.
const CURVE_PX: f32 = 3.0;

/// Content of a fundamental diagram. Both axes start at 0.
///
/// ```
/// use fbcrowd_render::plots::crowd::{FundamentalDiagram, fundamental_diagram};
/// use glam::Vec2;
///
/// let picture = fundamental_diagram(&FundamentalDiagram {
///     title: "Fundamental diagram",
///     across: "density, 1/m²",
///     up: "speed, m/s",
///     curve: ("published", vec![Vec2::new(0.5, 1.2), Vec2::new(4.0, 0.2)]),
///     points: ("measured", vec![Vec2::new(1.0, 1.05), Vec2::new(2.0, 0.6)]),
/// });
/// assert!(picture.width() > picture.height());
/// ```
#[derive(Clone, Debug)]
pub struct FundamentalDiagram<'a> {
    /// Title of the figure.
    pub title: &'a str,
    /// Quantity and unit of the horizontal axis.
    pub across: &'a str,
    /// Quantity and unit of the vertical axis.
    pub up: &'a str,
    /// Name of the curve, and points along it.
    pub curve: (&'a str, Vec<Vec2>),
    /// Name of the measured points, and the points.
    pub points: (&'a str, Vec<Vec2>),
}

/// The figure of a fundamental diagram.
pub fn fundamental_diagram(diagram: &FundamentalDiagram<'_>) -> Pixmap {
    let mut figure = PlotFigure::new(SIZE_PX);
    let ((curve_name, curve), (points_name, points)) = (&diagram.curve, &diagram.points);
    figure.title(diagram.title, TITLE_PX);
    let legend = [(PlotMark::Bar, INK, *curve_name), (PlotMark::Disc, line_colour(0), *points_name)];
    figure.legend(LEGEND_PX, &legend);
    let from_zero = |label: &str, value: fn(&Vec2) -> f32| PlotAxis {
        low: 0.0,
        ..PlotAxis::around(label, curve.iter().chain(points).map(value).chain([0.0]))
    };
    let axes = [from_zero(diagram.across, |point| point.x), from_zero(diagram.up, |point| point.y)];
    let panel = figure.panel(PANEL_PX, axes);
    figure.polyline(&panel, curve.iter().copied(), LineStyle::solid(INK, CURVE_PX));
    for point in points {
        figure.mark(&panel, *point, PlotMark::Disc, POINT_PX, line_colour(0));
    }
    figure.pixmap
}

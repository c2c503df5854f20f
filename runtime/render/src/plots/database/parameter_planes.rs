//! Figures with three panels side by side, one per pair of parameters: v_f and ω_t, v_f and ω_s, ω_t and ω_s.
//!
//! Units of plots: v_f and ω_s in m/s, ω_t in °/s.

use glam::{Vec2, Vec3};
use motiondb::motion::MotionDb;

use crate::plots::chart::axis::PlotAxis;
use crate::plots::chart::figure::{PlotFigure, PlotPanel};

/// Width of the figure, pixels.
pub(crate) const WIDTH_PX: u32 = 2900;
/// Left edge of the first panel, pixels.
pub(crate) const LEFT_PX: f32 = 120.0;
/// Width of a panel, pixels.
pub(crate) const PANEL_WIDTH_PX: f32 = 820.0;
/// Distance from the left edge of a panel to that of the next, pixels.
const PANEL_STEP_PX: f32 = 930.0;
/// Left end of the title's baseline, pixels.
pub(crate) const TITLE_PX: Vec2 = Vec2::new(LEFT_PX, 80.0);
/// Left end of the legend's baseline, pixels.
pub(crate) const LEGEND_PX: Vec2 = Vec2::new(LEFT_PX + 10.0, 134.0);
/// Horizontal and vertical parameter of each panel, as indices of (v_f, ω_t, ω_s).
pub(crate) const PLANES: [[usize; 2]; 3] = [[0, 1], [0, 2], [1, 2]];
/// Labels of the parameters.
const LABELS: [&str; 3] = ["forward speed v_f, m/s", "turn rate ω_t, °/s", "side speed ω_s, m/s"];

/// Parameters of all examples, in units of plots.
pub(crate) fn example_points(db: &MotionDb) -> Vec<Vec3> {
    db.parameters().map(|parameters| in_plot_units(parameters.to_vec3())).collect()
}

/// (v_f, ω_t, ω_s) in units of plots.
fn in_plot_units(parameters: Vec3) -> Vec3 {
    Vec3::new(parameters.x, parameters.y.to_degrees(), parameters.z)
}

/// A point's parameters of one panel.
pub(crate) fn in_plane(point: Vec3, plane: [usize; 2]) -> Vec2 {
    Vec2::new(point[plane[0]], point[plane[1]])
}

/// Draws the empty panel of a plane, given by index, with axes over all points.
pub(crate) fn plane_panel(
    figure: &mut PlotFigure,
    points: &[Vec3],
    plane: usize,
    [top_px, height_px]: [f32; 2],
) -> PlotPanel {
    let axes = PLANES[plane].map(|axis| PlotAxis::around(LABELS[axis], points.iter().map(|point| point[axis])));
    let left_px = LEFT_PX + PANEL_STEP_PX * plane as f32;
    figure.panel([left_px, top_px, PANEL_WIDTH_PX, height_px], axes)
}

//! Figures of several contestants in several scenes: a panel a measure, a group a scene, a column a contestant; every
//! run a dot, with a line over their mean ± standard deviation. Scales start at 0, since all measures do.

use glam::Vec2;
use tiny_skia::Pixmap;

use crate::plots::chart::axis::Axis;
use crate::plots::chart::mark::Mark;
use crate::plots::chart::plot::{Figure, Panel, line};
use crate::raster::palette::{INK, Rgb, line_colour};

/// Panels side by side.
const COLUMNS: usize = 2;
/// Width and height of a panel with its surroundings, pixels.
const CELL_PX: Vec2 = Vec2::new(1000.0, 560.0);
/// Left, top, width, height of the axes within it, pixels.
const PANEL_PX: [f32; 4] = [120.0, 70.0, 840.0, 420.0];
/// Height of the sheet's head, pixels.
const HEAD_PX: f32 = 160.0;
/// What the columns of a group take of its width.
const GROUP_SHARE: f32 = 0.7;
/// Dots of one column spread over this share of it, so that equal ones show.
const SPREAD_SHARE: f32 = 0.4;
/// Radius of a dot, and half the length of the line of a mean, pixels and share of a column.
const DOT_PX: f32 = 5.0;
const MEAN_SHARE: f32 = 0.4;
/// Room above the highest value, as a share of it.
const HEADROOM: f32 = 0.08;

/// What is compared.
#[derive(Clone, Debug, Default)]
pub struct Comparison {
    /// Heading of the sheet.
    pub title: String,
    /// Scenes.
    pub groups: Vec<String>,
    /// Contestants.
    pub contestants: Vec<String>,
    /// In reading order.
    pub measures: Vec<Measure>,
}

/// One panel.
#[derive(Clone, Debug, Default)]
pub struct Measure {
    /// Quantity and unit.
    pub label: String,
    /// By group, then by contestant, then by run.
    pub values: Vec<Vec<Vec<f32>>>,
}

/// The sheet.
pub fn comparison(comparison: &Comparison) -> Pixmap {
    let rows = comparison.measures.len().div_ceil(COLUMNS);
    let size = Vec2::new(COLUMNS as f32 * CELL_PX.x, HEAD_PX + rows as f32 * CELL_PX.y);
    let mut figure = Figure::new(size.x as u32, size.y as u32);
    figure.title(&comparison.title, Vec2::new(PANEL_PX[0], 70.0));
    let names = comparison.contestants.iter().enumerate();
    let legend: Vec<(Mark, Rgb, &str)> =
        names.map(|(index, name)| (Mark::Disc, line_colour(index), name.as_str())).collect();
    figure.legend(Vec2::new(PANEL_PX[0] + 10.0, 130.0), &legend);
    for (cell, measure) in comparison.measures.iter().enumerate() {
        let corner = Vec2::new((cell % COLUMNS) as f32 * CELL_PX.x, HEAD_PX + (cell / COLUMNS) as f32 * CELL_PX.y);
        draw_measure(&mut figure, corner, &comparison.groups, measure);
    }
    figure.pixmap
}

fn draw_measure(figure: &mut Figure, corner: Vec2, groups: &[String], measure: &Measure) {
    let [left, top, width, height] = PANEL_PX;
    let highest = measure.values.iter().flatten().flatten().copied().fold(f32::MIN_POSITIVE, f32::max);
    let axis = Axis { label: measure.label.clone(), low: 0.0, high: highest * (1.0 + HEADROOM) };
    let names: Vec<&str> = groups.iter().map(String::as_str).collect();
    let panel = figure.panel_of_groups([corner.x + left, corner.y + top, width, height], &names, axis);
    for (group, contestants) in measure.values.iter().enumerate() {
        let column = GROUP_SHARE / contestants.len().max(1) as f32;
        for (index, runs) in contestants.iter().enumerate() {
            let centre = group as f32 + column * (index as f32 + 0.5) - 0.5 * GROUP_SHARE;
            draw_runs(figure, &panel, [centre, column], runs, line_colour(index));
        }
    }
}

/// One contestant in one scene: `[centre, width]` of its column, in groups.
fn draw_runs(figure: &mut Figure, panel: &Panel, [centre, width]: [f32; 2], runs: &[f32], colour: Rgb) {
    if runs.is_empty() {
        return;
    }
    let count = runs.len() as f32;
    for (index, value) in runs.iter().enumerate() {
        let aside = SPREAD_SHARE * width * ((index as f32 + 0.5) / count - 0.5);
        figure.mark(panel, Vec2::new(centre + aside, *value), Mark::Disc, DOT_PX, colour);
    }
    let mean = runs.iter().sum::<f32>() / count;
    let squares = runs.iter().map(|value| (value - mean) * (value - mean)).sum::<f32>();
    let deviation = libm::sqrtf(squares / (count - 1.0).max(1.0));
    let half = MEAN_SHARE * width;
    figure.polyline(panel, [centre - half, centre + half].map(|x| Vec2::new(x, mean)), line(INK, 2.5));
    let ends = [(mean - deviation).max(0.0), mean + deviation];
    figure.polyline(panel, ends.map(|value| Vec2::new(centre, value)), line(INK, 1.2));
}

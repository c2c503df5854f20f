//! A comparison of several series (planners, say) in several scenes: a panel per measure, a group per scene, a column
//! per series. Every run is a dot; a line shows the mean, another the standard deviation. Scales start at 0, since no
//! measure is negative.

use glam::Vec2;
use motiondb::statistics::{mean, standard_deviation};
use tiny_skia::Pixmap;

use crate::plots::chart::axis::PlotAxis;
use crate::plots::chart::cell_grid::CellGrid;
use crate::plots::chart::figure::{LegendEntry, LineStyle, PlotFigure, PlotPanel};
use crate::plots::chart::mark::PlotMark;
use crate::raster::palette::{INK, Rgb, line_colour};

/// Grid of the panels, with their surroundings.
const GRID: CellGrid = CellGrid { columns: 2, cell_px: Vec2::new(1000.0, 560.0), head_px: 160.0 };
/// Left, top, width, height of the axes in a cell, pixels.
const PANEL_PX: [f32; 4] = [120.0, 70.0, 840.0, 420.0];
/// Left end of the title's baseline, pixels.
const TITLE_PX: Vec2 = Vec2::new(120.0, 70.0);
/// Left end of the legend's baseline, pixels.
const LEGEND_PX: Vec2 = Vec2::new(130.0, 130.0);
/// Width of all columns of a group, share of the group's width.
const GROUP_SHARE: f32 = 0.7;
/// Width over which the dots of one column are spread, share of the column: so equal values are visible.
const SPREAD_SHARE: f32 = 0.4;
/// Radius of a dot, pixels.
const DOT_PX: f32 = 5.0;
/// Half the length of the line of a mean, share of a column.
const MEAN_SHARE: f32 = 0.4;
/// Margin above the highest value, share of the value.
const HEADROOM: f32 = 0.08;

/// Content of a comparison.
///
/// ```
/// use fbcrowd_render::plots::crowd::{ComparedMeasure, Comparison, comparison};
///
/// // One scene, two planners, two runs each.
/// let values = vec![vec![vec![0.02, 0.03], vec![0.11, 0.09]]];
/// let picture = comparison(&Comparison {
///     title: "Collisions".to_owned(),
///     groups: vec!["crossing".to_owned()],
///     series: vec!["MCN".to_owned(), "social forces".to_owned()],
///     measures: vec![ComparedMeasure { label: "collisions C".to_owned(), values }],
/// });
/// assert_eq!(picture.width(), 2000);
/// ```
#[derive(Clone, Debug, Default)]
pub struct Comparison {
    /// Title of the figure.
    pub title: String,
    /// Names of the scenes.
    pub groups: Vec<String>,
    /// Names of the series.
    pub series: Vec<String>,
    /// Measures, in reading order of the panels.
    pub measures: Vec<ComparedMeasure>,
}

/// Content of one panel of a comparison.
#[derive(Clone, Debug, Default)]
pub struct ComparedMeasure {
    /// Quantity and unit.
    pub label: String,
    /// Values by group, then by series, then by run.
    pub values: Vec<Vec<Vec<f32>>>,
}

/// The figure of a comparison.
pub fn comparison(comparison: &Comparison) -> Pixmap {
    let mut figure = PlotFigure::new(GRID.size_px(comparison.measures.len()));
    figure.title(&comparison.title, TITLE_PX);
    let names = comparison.series.iter().enumerate();
    let legend: Vec<LegendEntry<'_>> =
        names.map(|(index, name)| (PlotMark::Disc, line_colour(index), name.as_str())).collect();
    figure.legend(LEGEND_PX, &legend);
    for (cell, measure) in comparison.measures.iter().enumerate() {
        draw_measure(&mut figure, GRID.rect_px(cell, PANEL_PX), &comparison.groups, measure);
    }
    figure.pixmap
}

fn draw_measure(figure: &mut PlotFigure, rect_px: [f32; 4], groups: &[String], measure: &ComparedMeasure) {
    let highest = measure.values.iter().flatten().flatten().copied().fold(f32::MIN_POSITIVE, f32::max);
    let axis = PlotAxis::new(&measure.label, [0.0, highest * (1.0 + HEADROOM)]);
    let names: Vec<&str> = groups.iter().map(String::as_str).collect();
    let panel = figure.panel_of_groups(rect_px, &names, axis);
    for (group, series) in measure.values.iter().enumerate() {
        let column = GROUP_SHARE / series.len().max(1) as f32;
        for (index, runs) in series.iter().enumerate() {
            let centre = group as f32 + column * (index as f32 + 0.5) - 0.5 * GROUP_SHARE;
            draw_runs(figure, &panel, [centre, column], runs, line_colour(index));
        }
    }
}

/// Draws one series in one scene; `[centre, width]` are those of its column, in groups.
fn draw_runs(figure: &mut PlotFigure, panel: &PlotPanel, [centre, width]: [f32; 2], runs: &[f32], colour: Rgb) {
    for (index, value) in runs.iter().enumerate() {
        let aside = SPREAD_SHARE * width * ((index as f32 + 0.5) / runs.len() as f32 - 0.5);
        figure.mark(panel, Vec2::new(centre + aside, *value), PlotMark::Disc, DOT_PX, colour);
    }
    let values = || runs.iter().copied().map(f64::from);
    let (Some(mean), Some(deviation)) = (mean(values()), standard_deviation(values())) else { return };
    let (mean, deviation) = (mean as f32, deviation as f32);
    let half = MEAN_SHARE * width;
    let mean_ends = [centre - half, centre + half].map(|x| Vec2::new(x, mean));
    figure.polyline(panel, mean_ends, LineStyle::solid(INK, 2.5));
    let deviation_ends = [(mean - deviation).max(0.0), mean + deviation].map(|value| Vec2::new(centre, value));
    figure.polyline(panel, deviation_ends, LineStyle::solid(INK, 1.2));
}

//! Plots of a scenario's `[[measure]]` tables: passages over a line and removals against time (N–t), density in an area
//! against time.

use std::fs;
use std::path::{Path, PathBuf};

use fbcrowd_sim::measures::{AreaMeasures, EgressMeasures, LineMeasures, PlaceMeasures};
use glam::Vec2;
use tiny_skia::Pixmap;

use crate::error::RenderError;
use crate::plots::chart::axis::PlotAxis;
use crate::plots::chart::figure::{LineStyle, PlotFigure};
use crate::plots::chart::mark::PlotMark;
use crate::raster::palette::line_colour;
use crate::raster::png_frame;

/// Size of the figure, pixels.
const SIZE_PX: [u32; 2] = [1600, 1000];
/// Left, top, width, height of the axes, pixels.
const PANEL_PX: [f32; 4] = [130.0, 210.0, 1410.0, 660.0];
/// Left end of the title's baseline, pixels.
const TITLE_PX: Vec2 = Vec2::new(130.0, 70.0);
/// Left end of the legend's baseline, pixels.
const LEGEND_PX: Vec2 = Vec2::new(140.0, 124.0);
/// Width of a curve, pixels.
const CURVE_PX: f32 = 3.0;

/// Names and points of the curves of a plot.
type Curves = Vec<(&'static str, Vec<Vec2>)>;

/// Writes a plot of each measure into a folder, which is made if missing; returns the paths of the files.
///
/// # Errors
/// If the folder cannot be made or a file cannot be written.
pub fn write_place_plots(places: &[PlaceMeasures], folder: &Path) -> Result<Vec<PathBuf>, RenderError> {
    fs::create_dir_all(folder).map_err(|source| RenderError::Folder { folder: folder.to_owned(), source })?;
    let write = |place: &PlaceMeasures| {
        let path = place_plot_path(&place.name, folder);
        png_frame::write(&path, &place_plot(place)).map(|()| path)
    };
    places.iter().map(write).collect()
}

/// Path of the plot of the measure with a name.
pub fn place_plot_path(name: &str, folder: &Path) -> PathBuf {
    folder.join(format!("{name}.png"))
}

/// The plot of one measure.
pub fn place_plot(place: &PlaceMeasures) -> Pixmap {
    let (up, curves) = match (&place.line, &place.area, &place.egress) {
        (Some(line), _, _) => ("passages N", passages(line)),
        (None, Some(area), _) => ("density, 1/m²", densities(area)),
        (None, None, Some(egress)) => ("agents that left", removals(egress)),
        (None, None, None) => ("", Vec::new()),
    };
    let mut figure = PlotFigure::new(SIZE_PX);
    let title = figure.fitted(&place.name, PANEL_PX[2]);
    figure.title(&title, TITLE_PX);
    let legend: Vec<_> =
        curves.iter().enumerate().map(|(index, (name, _))| (PlotMark::Bar, line_colour(index), *name)).collect();
    figure.legend(LEGEND_PX, &legend);
    let from_zero = |label: &str, value: fn(&Vec2) -> f32| PlotAxis {
        low: 0.0,
        ..PlotAxis::around(label, curves.iter().flat_map(|(_, points)| points).map(value).chain([0.0, 1.0]))
    };
    let axes = [from_zero("time, s", |point| point.x), from_zero(up, |point| point.y)];
    let panel = figure.panel(PANEL_PX, axes);
    for (index, (_, points)) in curves.iter().enumerate() {
        figure.polyline(&panel, points.iter().copied(), LineStyle::solid(line_colour(index), CURVE_PX));
    }
    figure.pixmap
}

fn passages(line: &LineMeasures) -> Curves {
    vec![("forward", steps(&line.forward.times_s)), ("backward", steps(&line.backward.times_s))]
}

fn removals(egress: &EgressMeasures) -> Curves {
    vec![("removals", steps(&egress.times_s))]
}

/// A count that rises by one at each time.
fn steps(times_s: &[f64]) -> Vec<Vec2> {
    let rise = |(index, time_s): (usize, &f64)| [index, index + 1].map(|count| Vec2::new(*time_s as f32, count as f32));
    [Vec2::ZERO].into_iter().chain(times_s.iter().enumerate().flat_map(rise)).collect()
}

fn densities(area: &AreaMeasures) -> Curves {
    let classical = area.moments.iter().map(|moment| [moment.time_s, moment.density_per_m2]);
    let voronoi = area.moments.iter().map(|moment| [moment.time_s, moment.voronoi_density_per_m2]);
    let point = |[time_s, density]: [f64; 2]| Vec2::new(time_s as f32, density as f32);
    vec![("agents inside per m²", classical.map(point).collect()), ("Voronoi", voronoi.map(point).collect())]
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn counts_rise_by_one_at_each_time() {
        let expected = [(0.0, 0.0), (2.0, 0.0), (2.0, 1.0), (5.0, 1.0), (5.0, 2.0)].map(Vec2::from);
        assert_eq!(steps(&[2.0, 5.0]), expected);
    }

    #[test]
    fn a_measure_without_agents_is_drawn() {
        let place = PlaceMeasures { name: "empty".into(), line: None, area: None, egress: None };
        assert_eq!(place_plot(&place).width(), SIZE_PX[0]);
    }
}

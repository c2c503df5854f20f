//! Plots of a scenario's `[[measure]]` tables: passages over a line and removals against time (N–t), density and level of
//! service in an area against time.

use std::fs;
use std::path::{Path, PathBuf};

use fbcrowd_sim::measures::{AreaMeasures, EgressMeasures, LEVELS_OF_SERVICE, LineMeasures, PlaceMeasures};
use glam::Vec2;
use tiny_skia::Pixmap;

use crate::error::RenderError;
use crate::plots::chart::axis::PlotAxis;
use crate::plots::chart::figure::{LineStyle, PlotFigure, PlotPanel};
use crate::plots::chart::mark::PlotMark;
use crate::raster::paint::fill_rect;
use crate::raster::palette::{self, line_colour};
use crate::raster::png_frame;
use crate::raster::text::TextAnchor;

/// Size of the figure, pixels.
const SIZE_PX: [u32; 2] = [1600, 1000];
/// Left, top, width, height of the axes, pixels.
const PANEL_PX: [f32; 4] = [130.0, 200.0, 1410.0, 650.0];
/// Left end of the title's baseline, pixels.
const TITLE_PX: Vec2 = Vec2::new(130.0, 70.0);
/// Left end of the legend's baseline, pixels.
const LEGEND_PX: Vec2 = Vec2::new(140.0, 124.0);
/// Width of a curve, pixels.
const CURVE_PX: f32 = 3.0;

/// Height of the strip of levels of service below the axes, pixels, and its distance from them.
const STRIP_PX: [f32; 2] = [22.0, 80.0];
/// Opacity of the bands of levels of service behind the curves.
const BAND_OPACITY: f32 = 0.22;
/// Least height of a band with a letter, pixels.
const LETTER_PX: f32 = 16.0;

/// Names and points of the curves of a plot.
type Curves = Vec<(&'static str, Vec<Vec2>)>;

/// Writes a plot of each measure until a time, s, into a folder, which is made if missing; returns the paths of the
/// files.
///
/// # Errors
/// If the folder cannot be made or a file cannot be written.
pub fn write_place_plots(places: &[PlaceMeasures], until_s: f32, folder: &Path) -> Result<Vec<PathBuf>, RenderError> {
    fs::create_dir_all(folder).map_err(|source| RenderError::Folder { folder: folder.to_owned(), source })?;
    let write = |place: &PlaceMeasures| {
        let path = place_plot_path(&place.name, folder);
        png_frame::write(&path, &place_plot(place, until_s)).map(|()| path)
    };
    places.iter().map(write).collect()
}

/// Path of the plot of the measure with a name.
pub fn place_plot_path(name: &str, folder: &Path) -> PathBuf {
    folder.join(format!("{name}.png"))
}

/// The plot of one measure until a time, s.
pub fn place_plot(place: &PlaceMeasures, until_s: f32) -> Pixmap {
    let (up, curves) = match (&place.line, &place.area, &place.egress) {
        (Some(line), _, _) => ("passages N", passages(line, until_s)),
        (None, Some(area), _) => ("density, 1/m²", densities(area)),
        (None, None, Some(egress)) => ("agents that left", removals(egress, until_s)),
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
    if let Some(area) = &place.area {
        draw_levels(&mut figure, &panel, area);
    }
    for (index, (_, points)) in curves.iter().enumerate() {
        figure.polyline(&panel, points.iter().copied(), LineStyle::solid(line_colour(index), CURVE_PX));
    }
    figure.pixmap
}

/// Draws the bands of Fruin's levels of service behind the curves, and the level of each moment in a strip below.
fn draw_levels(figure: &mut PlotFigure, panel: &PlotPanel, area: &AreaMeasures) {
    let [left, top, width, height] = panel.rect_px;
    let y_px = |density: f64| panel.to_px(Vec2::new(0.0, density as f32)).y.clamp(top, top + height);
    let mut from = 0.0;
    for ((name, most), colour) in LEVELS_OF_SERVICE.iter().zip(palette::LEVELS_OF_SERVICE) {
        let [low_px, high_px] = [from, *most].map(y_px);
        fill_rect(&mut figure.pixmap, [left, high_px, width, low_px - high_px], colour, BAND_OPACITY);
        if low_px - high_px >= LETTER_PX {
            let beside_px = Vec2::new(left + width - 8.0, 0.5 * (low_px + high_px) + 0.5 * LETTER_PX - 1.0);
            figure.note(name, beside_px, TextAnchor::Right, palette::INK);
        }
        from = *most;
    }
    let strip_px = top + height + STRIP_PX[1];
    for (index, moment) in area.moments.iter().enumerate() {
        let ends_s = [moment.time_s, area.moments.get(index + 1).map_or(moment.time_s, |next| next.time_s)];
        let [from_px, to_px] = ends_s.map(|time_s| panel.to_px(Vec2::new(time_s as f32, 0.0)).x.round());
        let colour = palette::LEVELS_OF_SERVICE[moment.level_of_service()];
        fill_rect(&mut figure.pixmap, [from_px, strip_px, to_px - from_px, STRIP_PX[0]], colour, 1.0);
    }
    let below_px = Vec2::new(left, strip_px + STRIP_PX[0] + 22.0);
    let text = "Level of service A to F by agents inside per m²: Fruin (1971), walkways.";
    figure.note(text, below_px, TextAnchor::Left, palette::INK);
}

fn passages(line: &LineMeasures, until_s: f32) -> Curves {
    let curve = |times_s| steps(times_s, until_s);
    vec![("forward", curve(&line.forward.times_s)), ("backward", curve(&line.backward.times_s))]
}

fn removals(egress: &EgressMeasures, until_s: f32) -> Curves {
    vec![("removals", steps(&egress.times_s, until_s))]
}

/// A count that rises by one at each time, until the end.
fn steps(times_s: &[f64], until_s: f32) -> Vec<Vec2> {
    let rise = |(index, time_s): (usize, &f64)| [index, index + 1].map(|count| Vec2::new(*time_s as f32, count as f32));
    let end = Vec2::new(until_s, times_s.len() as f32);
    [Vec2::ZERO].into_iter().chain(times_s.iter().enumerate().flat_map(rise)).chain([end]).collect()
}

fn densities(area: &AreaMeasures) -> Curves {
    let classical = area.moments.iter().map(|moment| [moment.time_s, moment.density_per_m2]);
    let voronoi = area.moments.iter().map(|moment| [moment.time_s, moment.voronoi_density_per_m2]);
    let point = |[time_s, density]: [f64; 2]| Vec2::new(time_s as f32, density as f32);
    vec![("agents inside per m²", classical.map(point).collect()), ("Voronoi", voronoi.map(point).collect())]
}

#[cfg(test)]
mod tests {
    use fbcrowd_sim::measures::AreaMoment;

    use super::*;

    #[test]
    fn counts_rise_by_one_at_each_time() {
        let expected = [(0.0, 0.0), (2.0, 0.0), (2.0, 1.0), (5.0, 1.0), (5.0, 2.0), (9.0, 2.0)].map(Vec2::from);
        assert_eq!(steps(&[2.0, 5.0], 9.0), expected);
    }

    #[test]
    fn an_area_shows_its_level_of_service_at_each_time() {
        let moment = |(index, density_per_m2): (usize, &f64)| AreaMoment {
            time_s: 0.5 * index as f64,
            number: 1,
            density_per_m2: *density_per_m2,
            voronoi_density_per_m2: *density_per_m2,
            mean_speed_mps: None,
        };
        let densities = [0.1, 0.4, 0.6, 1.0, 2.0, 4.0, 0.0];
        let area = AreaMeasures {
            size_m2: 1.0,
            mean_number: 1.0,
            mean_density_per_m2: 1.0,
            greatest_density_per_m2: 4.0,
            mean_voronoi_density_per_m2: 1.0,
            greatest_voronoi_density_per_m2: 4.0,
            mean_speed_mps: None,
            level_of_service_shares: [0.0; 6],
            moments: densities.iter().enumerate().map(moment).collect(),
        };
        let place = PlaceMeasures { name: "hall".into(), line: None, area: Some(area), egress: None };
        let picture = place_plot(&place, 4.0);
        let strip_px = (PANEL_PX[1] + PANEL_PX[3] + STRIP_PX[1] + 0.5 * STRIP_PX[0]) as u32;
        let mut colours: Vec<_> = (0..SIZE_PX[0]).map(|x| picture.pixel(x, strip_px).unwrap()).collect();
        colours.dedup();
        // Paper, six levels, paper.
        assert_eq!(colours.len(), 8, "{colours:?}");
    }

    #[test]
    fn a_measure_without_agents_is_drawn() {
        let place = PlaceMeasures { name: "empty".into(), line: None, area: None, egress: None };
        assert_eq!(place_plot(&place, 4.0).width(), SIZE_PX[0]);
    }
}

//! Pose distances of two examples, for every phase of one and every phase of the other, with their correspondence times
//! T (`FbCrowd` §5, Eq. 10).
//!
//! Distances are those of [`motiondb::motion::distances_m`], in cm.

use glam::Vec2;
use motiondb::motion::{MotionDb, PHASE_COUNT, distances_m, pose_pairs};
use tiny_skia::Pixmap;

use crate::plots::chart::axis::{PlotAxis, number};
use crate::plots::chart::figure::{PlotFigure, PlotPanel};
use crate::plots::chart::mark::PlotMark;
use crate::raster::paint::fill_rect;
use crate::raster::palette::{INK, heat};

/// Width and height of the figure, pixels.
const SIZE_PX: [u32; 2] = [1400, 1440];
/// Left, top, width, height of the axes, pixels.
const PANEL_PX: [f32; 4] = [130.0, 210.0, 1120.0, 1120.0];
/// Left end of the title's baseline, pixels.
const TITLE_PX: Vec2 = Vec2::new(130.0, 80.0);
/// Left end of the legend's baseline, pixels.
const LEGEND_PX: Vec2 = Vec2::new(140.0, 134.0);

/// The figure of m_sp and m_mb with the stored pairs; `None` for a database without correspondence.
pub fn pose_distances(db: &MotionDb) -> Option<Pixmap> {
    let found = db.correspondence.as_ref()?;
    let examples = [found.semi_procedural as usize, found.blending as usize];
    let title = "Distance of the poses of m_sp and m_mb, and correspondence times";
    Some(draw(db, title, examples, ["m_sp ", "m_mb "], &found.pairs_s))
}

/// The figure of any two examples, given by index, with the pairs that are found for them.
pub fn pose_distances_between(db: &MotionDb, examples: [usize; 2]) -> Pixmap {
    let pairs_s: Vec<[f32; 2]> = pose_pairs(db, examples[0], examples[1]).iter().map(|pair| pair.times_s).collect();
    let [from, to] = examples.map(|index| db.examples[index].name.as_str());
    draw(db, &format!("Distance of the poses of {from} and {to}"), examples, ["", ""], &pairs_s)
}

/// `roles` precede the examples' names on the axes.
fn draw(db: &MotionDb, title: &str, examples: [usize; 2], roles: [&str; 2], pairs_s: &[[f32; 2]]) -> Pixmap {
    let distances_m = distances_m(db, examples[0], examples[1]);
    let greatest_m = distances_m.iter().flatten().copied().fold(f32::MIN_POSITIVE, f32::max);
    let least_m = distances_m.iter().flatten().copied().fold(greatest_m, f32::min);
    let mut figure = PlotFigure::new(SIZE_PX);
    figure.title(title, TITLE_PX);
    let [least, middle, greatest] =
        [least_m, 0.5 * (least_m + greatest_m), greatest_m].map(|metres| format!("{} cm", number(100.0 * metres, 1)));
    figure.heat_legend(LEGEND_PX, [&least, &middle, &greatest], &[(PlotMark::Disc, INK, "chosen pairs")]);
    let axis = |side: usize| {
        PlotAxis::new(&format!("phase of {}{}", roles[side], db.examples[examples[side]].name), [0.0, 1.0])
    };
    let panel = figure.panel(PANEL_PX, [axis(0), axis(1)]);
    let share = |metres: f32| (metres - least_m) / (greatest_m - least_m).max(f32::MIN_POSITIVE);
    draw_cells(&mut figure, &panel, |row, other_row| share(distances_m[row][other_row]));
    let phase = |side: usize, time_s: f32| db.examples[examples[side]].phase_map.phase(time_s);
    for [from_s, to_s] in pairs_s {
        figure.mark(&panel, Vec2::new(phase(0, *from_s), phase(1, *to_s)), PlotMark::Disc, 8.0, INK);
    }
    figure.pixmap
}

/// Draws a square around each pair of stored phases, in the colour of its share of the heat scale. The squares of the
/// first phase are also drawn at the end of the cycle.
fn draw_cells(figure: &mut PlotFigure, panel: &PlotPanel, share: impl Fn(usize, usize) -> f32) {
    let edge = |row: usize, offset: f32| ((row as f32 + offset) / PHASE_COUNT as f32).clamp(0.0, 1.0);
    for (row, other_row) in (0..=PHASE_COUNT).flat_map(|row| (0..=PHASE_COUNT).map(move |other_row| (row, other_row))) {
        let low = panel.to_px(Vec2::new(edge(row, -0.5), edge(other_row, 0.5))).round();
        let high = panel.to_px(Vec2::new(edge(row, 0.5), edge(other_row, -0.5))).round();
        let colour = heat(share(row % PHASE_COUNT, other_row % PHASE_COUNT));
        fill_rect(&mut figure.pixmap, [low.x, low.y, high.x - low.x, high.y - low.y], colour, 1.0);
    }
}

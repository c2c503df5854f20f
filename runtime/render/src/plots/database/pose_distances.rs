//! How alike the poses of two examples are, at every phase of one against every phase of the other, and the
//! correspondence times T chosen there (`FbCrowd` §5, Eq. 10): of m_sp and m_mb, or of any two.
//!
//! Distances are [`motiondb::motion::distances_m`]'s, cm.

use glam::Vec2;
use motiondb::motion::{MotionDb, PHASE_COUNT, distances_m, pose_pairs};
use tiny_skia::Pixmap;

use crate::plots::chart::axis::{PlotAxis, number};
use crate::plots::chart::figure::{PlotFigure, PlotPanel};
use crate::plots::chart::mark::PlotMark;
use crate::raster::paint::fill_rect;
use crate::raster::palette::{INK, heat};

/// Sides of the sheet, pixels.
const SHEET_PX: [u32; 2] = [1400, 1440];
/// Left, top, width, height of the axes on it, pixels.
const PANEL_PX: [f32; 4] = [130.0, 210.0, 1120.0, 1120.0];
/// Left baseline of the legend, pixels.
const LEGEND_PX: Vec2 = Vec2::new(140.0, 134.0);

/// The plot of m_sp and m_mb with the stored pairs; none of a database without correspondences.
pub fn pose_distances(db: &MotionDb) -> Option<Pixmap> {
    let found = db.correspondence.as_ref()?;
    let examples = [found.semi_procedural as usize, found.blending as usize];
    let title = "Where m_sp and m_mb are alike: distance of poses, and correspondences";
    Some(draw(db, title, examples, ["m_sp ", "m_mb "], &found.pairs_s))
}

/// The plot of any two examples with the pairs that are found for them.
pub fn pose_distances_between(db: &MotionDb, examples: [usize; 2]) -> Pixmap {
    let pairs_s: Vec<[f32; 2]> = pose_pairs(db, examples[0], examples[1]).iter().map(|pair| pair.times_s).collect();
    let [from, to] = examples.map(|index| db.examples[index].name.as_str());
    draw(db, &format!("Where {from} and {to} are alike"), examples, ["", ""], &pairs_s)
}

/// `roles` are said before the examples' names.
fn draw(db: &MotionDb, title: &str, examples: [usize; 2], roles: [&str; 2], pairs_s: &[[f32; 2]]) -> Pixmap {
    let distances_m = distances_m(db, examples[0], examples[1]);
    let greatest_m = distances_m.iter().flatten().copied().fold(f32::MIN_POSITIVE, f32::max);
    let least_m = distances_m.iter().flatten().copied().fold(greatest_m, f32::min);
    let mut figure = PlotFigure::new(SHEET_PX);
    figure.title(title, Vec2::new(PANEL_PX[0], 80.0));
    let [least, middle, greatest] =
        [least_m, 0.5 * (least_m + greatest_m), greatest_m].map(|metres| format!("{} cm", number(100.0 * metres, 1)));
    figure.heat_legend(LEGEND_PX, [&least, &middle, &greatest], &[(PlotMark::Disc, INK, "chosen pairs")]);
    let axis = |side: usize| {
        let label = format!("phase of {}{}", roles[side], db.examples[examples[side]].name);
        PlotAxis { label, low: 0.0, high: 1.0 }
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

/// A square about each pair of stored phases; those of the first phase are drawn again where the cycle closes.
fn draw_cells(figure: &mut PlotFigure, panel: &PlotPanel, share: impl Fn(usize, usize) -> f32) {
    let edge = |row: usize, off: f32| ((row as f32 + off) / PHASE_COUNT as f32).clamp(0.0, 1.0);
    for (row, other_row) in (0..=PHASE_COUNT).flat_map(|row| (0..=PHASE_COUNT).map(move |other_row| (row, other_row))) {
        let low = panel.to_px(Vec2::new(edge(row, -0.5), edge(other_row, 0.5))).round();
        let high = panel.to_px(Vec2::new(edge(row, 0.5), edge(other_row, -0.5))).round();
        let colour = heat(share(row % PHASE_COUNT, other_row % PHASE_COUNT));
        fill_rect(&mut figure.pixmap, [low.x, low.y, high.x - low.x, high.y - low.y], colour, 1.0);
    }
}

//! The same crowd walked several ways, beside each other: the paper's Fig. 7. One colour an agent, the same in every
//! panel; a dot where it starts, a cross on its goal; what was measured stands beneath.

use fbcrowd_sim::scenario::AgentSpec;
use glam::Vec2;
use tiny_skia::Pixmap;

use crate::plots::chart::axis::{Axis, equal_units};
use crate::plots::chart::mark::Mark;
use crate::plots::chart::plot::Figure;
use crate::plots::crowd::trajectories::{draw_obstacles, draw_paths, shown_m};
use crate::raster::palette::INK;
use crate::raster::text::Anchor;
use crate::top_view::trails::Tracks;

/// Width of one panel's axes and the room left of them, pixels.
const PANEL_PX: f32 = 760.0;
const LEFT_PX: f32 = 100.0;
/// Least and greatest height of the axes, which follows the scene's, pixels.
const PANEL_HEIGHTS_PX: [f32; 2] = [320.0, 1100.0];
/// Room above the axes, and below them without the notes, pixels.
const ABOVE_PX: f32 = 220.0;
const BELOW_PX: f32 = 130.0;
/// Height of a line of notes, pixels.
const LINE_PX: f32 = 36.0;

/// One way.
#[derive(Clone, Debug)]
pub struct Way<'a> {
    /// Who leads.
    pub heading: String,
    /// What was measured, a line each.
    pub notes: Vec<String>,
    /// Everybody's path.
    pub tracks: &'a Tracks,
}

/// The sheet; every panel shows the same part of the world.
pub fn side_by_side(title: &str, agents: &[AgentSpec], obstacles_m: &[Vec<Vec2>], ways: &[Way]) -> Pixmap {
    let walked_m = ways.iter().flat_map(|way| way.tracks.positions_m.iter().copied());
    let [low, high] = shown_m(agents, walked_m.chain(obstacles_m.iter().flatten().copied()));
    let [least, greatest] = PANEL_HEIGHTS_PX;
    let height = (PANEL_PX * (high.y - low.y) / (high.x - low.x)).round().clamp(least, greatest);
    let lines = ways.iter().map(|way| way.notes.len()).max().unwrap_or(0) as f32;
    let width = LEFT_PX + ways.len() as f32 * (LEFT_PX + PANEL_PX);
    let mut figure = Figure::new(width as u32, (ABOVE_PX + height + BELOW_PX + lines * LINE_PX) as u32);
    figure.title(title, Vec2::new(LEFT_PX, 70.0));
    figure.legend(Vec2::new(LEFT_PX + 10.0, 118.0), &[(Mark::Disc, INK, "start"), (Mark::Cross, INK, "goal")]);
    for (index, way) in ways.iter().enumerate() {
        let left = LEFT_PX + index as f32 * (LEFT_PX + PANEL_PX);
        let rect_px = [left, ABOVE_PX, PANEL_PX, height];
        let axis = |label: &str, low: f32, high: f32| Axis { label: label.to_owned(), low, high };
        let axes = equal_units(rect_px, [axis("x, m", low.x, high.x), axis("y, m", low.y, high.y)]);
        let panel = figure.panel(rect_px, axes);
        draw_obstacles(&mut figure, &panel, obstacles_m);
        draw_paths(&mut figure, &panel, agents, way.tracks);
        let centre = left + 0.5 * PANEL_PX;
        figure.text(&way.heading, Vec2::new(centre, ABOVE_PX - 14.0), Anchor::Centre);
        for (line, note) in way.notes.iter().enumerate() {
            let baseline = ABOVE_PX + height + BELOW_PX + (line as f32 - 0.4) * LINE_PX;
            figure.text(note, Vec2::new(centre, baseline), Anchor::Centre);
        }
    }
    figure.pixmap
}

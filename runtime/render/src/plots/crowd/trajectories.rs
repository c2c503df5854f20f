//! Everybody's path on one sheet, as in the paper's Fig. 7: one colour an agent, a dot where it starts, a cross on its
//! goal.

use fbcrowd_sim::recording::Header;
use fbcrowd_sim::scenario::AgentSpec;
use glam::Vec2;
use tiny_skia::Pixmap;

use crate::plots::chart::axis::{Axis, equal_units};
use crate::plots::chart::mark::Mark;
use crate::plots::chart::plot::{Figure, Line, Panel, line};
use crate::raster::palette::{GRID_COARSE, INK, OBSTACLE_RIM, line_colour};
use crate::top_view::framing::bounds_m;
use crate::top_view::trails::Tracks;

/// Width of the sheet, pixels.
const WIDTH_PX: u32 = 1600;
/// Left, top and width of the axes on it, and the room below them, pixels.
const PANEL_LEFT_TOP_WIDTH_PX: [f32; 3] = [130.0, 190.0, 1410.0];
const BELOW_PX: f32 = 120.0;
/// Least and greatest height of the axes, which follows the scene's, pixels.
const PANEL_HEIGHTS_PX: [f32; 2] = [480.0, 1600.0];
/// Room around the paths, m.
const MARGIN_M: f32 = 0.6;
/// Width of a path, and of one among more than [`FEW_AGENTS`], pixels.
const PATH_PX: [f32; 2] = [4.0, 1.6];
/// Radius of the marks, likewise.
const MARK_PX: [f32; 2] = [11.0, 4.5];
/// Up to so many agents, paths are drawn broad.
const FEW_AGENTS: usize = 60;

/// The plot of a whole recording.
pub fn trajectories(header: &Header, tracks: &Tracks) -> Pixmap {
    let corners_m = header.scenario.obstacles_m.iter().flatten().copied();
    let [low, high] = shown_m(&header.scenario.agents, tracks.positions_m.iter().copied().chain(corners_m));
    let [left, top, width] = PANEL_LEFT_TOP_WIDTH_PX;
    let [least, greatest] = PANEL_HEIGHTS_PX;
    let height = (width * (high.y - low.y) / (high.x - low.x)).round().clamp(least, greatest);
    let mut figure = Figure::new(WIDTH_PX, (top + height + BELOW_PX) as u32);
    figure.title(&title(header, tracks), Vec2::new(left, 70.0));
    figure.legend(Vec2::new(left + 10.0, 122.0), &[(Mark::Disc, INK, "start"), (Mark::Cross, INK, "goal")]);
    let axis = |label: &str, low: f32, high: f32| Axis { label: label.to_owned(), low, high };
    let rect_px = [left, top, width, height];
    let axes = equal_units(rect_px, [axis("x, m", low.x, high.x), axis("y, m", low.y, high.y)]);
    let panel = figure.panel(rect_px, axes);
    draw_obstacles(&mut figure, &panel, &header.scenario.obstacles_m);
    draw_paths(&mut figure, &panel, &header.scenario.agents, tracks);
    figure.pixmap
}

fn title(header: &Header, tracks: &Tracks) -> String {
    let duration_s = tracks.frame_count().saturating_sub(1) as f32 * tracks.dt_s;
    let paths = match tracks.agent_count {
        1 => "path of 1 agent".to_owned(),
        count => format!("paths of {count} agents"),
    };
    format!("{}: {paths} in {duration_s:.1} s", header.scenario.name)
}

/// All goals and whatever else is drawn, with room around.
pub(crate) fn shown_m(agents: &[AgentSpec], drawn_m: impl Iterator<Item = Vec2>) -> [Vec2; 2] {
    let goals_m = agents.iter().flat_map(|agent| agent.goals_m.iter().copied());
    let [low, high] = bounds_m(drawn_m.chain(goals_m));
    [low - MARGIN_M, high + MARGIN_M]
}

pub(crate) fn draw_obstacles(figure: &mut Figure, panel: &Panel, obstacles_m: &[Vec<Vec2>]) {
    for corners in obstacles_m {
        figure.polygon(panel, corners.iter().copied(), 1.0, line(GRID_COARSE, 1.0));
        let closed = corners.iter().chain(corners.first()).copied();
        figure.polyline(panel, closed, line(OBSTACLE_RIM, 3.0));
    }
}

/// Paths below, then all marks, so that no path crosses a mark.
pub(crate) fn draw_paths(figure: &mut Figure, panel: &Panel, agents: &[AgentSpec], tracks: &Tracks) {
    let many = usize::from(tracks.agent_count > FEW_AGENTS);
    for agent in 0..tracks.agent_count {
        let style = Line { opacity: 0.85, ..line(line_colour(agent), PATH_PX[many]) };
        figure.polyline(panel, tracks.agent_m(agent), style);
    }
    for (agent, spec) in agents.iter().enumerate() {
        let colour = line_colour(agent);
        if let Some(goal_m) = spec.goals_m.last() {
            figure.mark(panel, *goal_m, Mark::Cross, MARK_PX[many], colour);
        }
        let start_m = tracks.agent_m(agent).next().unwrap_or(spec.position_m);
        figure.mark(panel, start_m, Mark::Disc, 0.8 * MARK_PX[many], colour);
    }
}

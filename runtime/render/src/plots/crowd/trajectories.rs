//! The paths of all agents of a recording, as in the paper's Fig. 7. One colour per agent, a dot at its start, a cross
//! at its goal. World axes, metres.

use fbcrowd_sim::recording::Header;
use fbcrowd_sim::scenario::{Marking, MarkingColour, MarkingShape, PlaceLabel, Scenario};
use glam::Vec2;
use tiny_skia::Pixmap;

use crate::plots::chart::axis::{PlotAxis, equal_units};
use crate::plots::chart::figure::{LegendEntry, LineStyle, PlotFigure, PlotPanel};
use crate::plots::chart::mark::PlotMark;
use crate::raster::palette::{GRID_COARSE, INK, OBSTACLE_RIM, OUTSIDE, SIGNAL, from_bytes, line_colour};
use crate::raster::text::TextAnchor;
use crate::top_view::framing::bounds_m;
use crate::top_view::trails::Tracks;

/// Width of the figure, pixels.
const WIDTH_PX: u32 = 1600;
/// Left, top and width of the axes, pixels.
const PANEL_LEFT_TOP_WIDTH_PX: [f32; 3] = [130.0, 190.0, 1410.0];
/// Margin below the axes, pixels.
const BELOW_PX: f32 = 120.0;
/// Left end of the title's baseline, pixels.
const TITLE_PX: Vec2 = Vec2::new(130.0, 70.0);
/// Left end of the legend's baseline, pixels.
const LEGEND_PX: Vec2 = Vec2::new(140.0, 122.0);
/// Least and greatest height of the axes, which follows the scene's, pixels.
const PANEL_HEIGHTS_PX: [f32; 2] = [480.0, 1600.0];
/// Margin around the paths, m.
const MARGIN_M: f32 = 0.6;
/// Width of a path among few and among many agents, pixels.
const PATH_PX: [f32; 2] = [4.0, 1.6];
/// Radius of the marks among few and among many agents, pixels.
const MARK_PX: [f32; 2] = [11.0, 4.5];
/// Greatest number of agents that are few.
const FEW_AGENTS: usize = 60;

/// Opacity of ground that is not walkable: lighter than on pictures, so that thin lines show.
const OUTSIDE_OPACITY: f32 = 0.5;

/// Legend of figures with paths.
pub(crate) const PATH_LEGEND: [LegendEntry<'static>; 2] =
    [(PlotMark::Disc, INK, "start"), (PlotMark::Cross, INK, "goal")];

/// The figure of a whole recording.
///
/// ```no_run
/// use std::path::Path;
///
/// use fbcrowd_render::plots::crowd::trajectories;
/// use fbcrowd_render::top_view::read_tracks;
/// use fbcrowd_render::{RenderError, png_frame};
/// use fbcrowd_sim::Recording;
///
/// let recording = Recording::open(Path::new("crossing.fbrec"))?;
/// let tracks = read_tracks(&recording)?;
/// png_frame::write(Path::new("paths.png"), &trajectories(recording.header(), &tracks))?;
/// # Ok::<(), RenderError>(())
/// ```
pub fn trajectories(header: &Header, tracks: &Tracks) -> Pixmap {
    let scene = PathScene::new(&header.scenario, &[tracks]);
    let [left, top, width] = PANEL_LEFT_TOP_WIDTH_PX;
    let height = scene.height_px(width, PANEL_HEIGHTS_PX);
    let mut figure = PlotFigure::new([WIDTH_PX, (top + height + BELOW_PX) as u32]);
    figure.title(&title(header, tracks), TITLE_PX);
    figure.legend(LEGEND_PX, &PATH_LEGEND);
    scene.draw(&mut figure, [left, top, width, height], tracks);
    figure.pixmap
}

fn title(header: &Header, tracks: &Tracks) -> String {
    let duration_s = tracks.frame_count.saturating_sub(1) as f32 * tracks.dt_s;
    let paths = match tracks.agents.len() {
        1 => "path of 1 agent".to_owned(),
        count => format!("paths of {count} agents"),
    };
    format!("{}: {paths} in {duration_s:.1} s", header.scenario.name)
}

/// Agents, obstacles, and the box of the world that panels with their paths show.
pub(crate) struct PathScene<'a> {
    scenario: &'a Scenario,
    /// Least and greatest corner, world, m.
    bounds_m: [Vec2; 2],
}

impl<'a> PathScene<'a> {
    /// A scene whose box holds all tracks, obstacles and goals, with a margin.
    pub(crate) fn new(scenario: &'a Scenario, tracks: &[&Tracks]) -> Self {
        let Scenario { agents, sources, .. } = scenario;
        let paths_m = tracks.iter().flat_map(|tracks| tracks.positions_m());
        let goals_m = agents.iter().flat_map(|agent| agent.goals_m.iter());
        let starts_m = agents.iter().map(|agent| agent.position_m);
        let areas_m = sources.iter().flat_map(|source| [source.low_m, source.high_m]);
        let goals_m = goals_m.chain(sources.iter().flat_map(|source| source.goals_m.iter()));
        let goal_areas_m = scenario.goal_areas().flat_map(|area| area.bounds_m());
        let [low_m, high_m] = bounds_m(
            paths_m
                .chain(goals_m.copied())
                .chain(scenario.corners_m())
                .chain(starts_m)
                .chain(areas_m)
                .chain(goal_areas_m),
        );
        Self { scenario, bounds_m: [low_m - MARGIN_M, high_m + MARGIN_M] }
    }

    /// Height of the axes for a width, within limits, pixels.
    pub(crate) fn height_px(&self, width_px: f32, [least_px, greatest_px]: [f32; 2]) -> f32 {
        let [low, high] = self.bounds_m;
        (width_px * (high.y - low.y) / (high.x - low.x)).round().clamp(least_px, greatest_px)
    }

    /// Draws a panel with walls and paths at left, top, width, height.
    pub(crate) fn draw(&self, figure: &mut PlotFigure, rect_px: [f32; 4], tracks: &Tracks) {
        let panel = self.draw_place(figure, rect_px);
        self.draw_paths(figure, &panel, tracks);
        self.draw_labels(figure, &panel);
    }

    /// Draws a panel with walls at left, top, width, height.
    pub(crate) fn draw_place(&self, figure: &mut PlotFigure, rect_px: [f32; 4]) -> PlotPanel {
        let [low, high] = self.bounds_m;
        let axes = [PlotAxis::new("x, m", [low.x, high.x]), PlotAxis::new("y, m", [low.y, high.y])];
        let panel = figure.panel(rect_px, equal_units(rect_px, axes));
        self.draw_markings(figure, &panel);
        for corners in &self.scenario.obstacles_m {
            figure.polygon(&panel, corners.iter().copied(), 1.0, LineStyle::solid(GRID_COARSE, 1.0));
            let closed = corners.iter().chain(corners.first()).copied();
            figure.polyline(&panel, closed, LineStyle::solid(OBSTACLE_RIM, 3.0));
        }
        for door in &self.scenario.doors {
            let closed = door.polygon_m.iter().chain(door.polygon_m.first()).copied();
            let line = LineStyle { is_dashed: true, ..LineStyle::solid(OBSTACLE_RIM, 2.0) };
            figure.polyline(&panel, closed, line);
        }
        for line_m in self.scenario.ground_lines_m().iter().chain(&self.scenario.enclosures_m) {
            let closed = line_m.iter().chain(line_m.first()).copied();
            figure.polyline(&panel, closed, LineStyle::solid(OBSTACLE_RIM, 3.0));
        }
        panel
    }

    /// Draws the ground that is not walkable, markings and goal areas; signals as they are at the start.
    fn draw_markings(&self, figure: &mut PlotFigure, panel: &PlotPanel) {
        figure.outside(panel, &self.scenario.ground_lines_m(), OUTSIDE, OUTSIDE_OPACITY);
        for Marking { shape, colour } in &self.scenario.markings {
            let colour = match *colour {
                MarkingColour::Fixed(rgb) => from_bytes(rgb),
                MarkingColour::Signal(signal) => {
                    let signal = self.scenario.behaviour.signals.get(signal as usize);
                    SIGNAL[usize::from(signal.is_some_and(|signal| signal.is_green(0.0)))]
                }
            };
            for corners_m in shape.polygons_m() {
                figure.polygon(panel, corners_m, 1.0, LineStyle::solid(colour, 1.0));
            }
        }
        let style = LineStyle { opacity: 0.5, is_dashed: true, ..LineStyle::solid(INK, 1.2) };
        for corners_m in self.scenario.goal_areas().flat_map(|area| MarkingShape::Area(area.clone()).polygons_m()) {
            let closed = corners_m.iter().chain(corners_m.first()).copied();
            figure.polyline(panel, closed, style);
        }
    }

    /// Writes the labels of places.
    pub(crate) fn draw_labels(&self, figure: &mut PlotFigure, panel: &PlotPanel) {
        for PlaceLabel { text, at_m } in &self.scenario.labels {
            figure.note(text, panel.to_px(*at_m), TextAnchor::Centre, INK);
        }
    }

    /// Draws paths, then marks, so that no path crosses a mark.
    fn draw_paths(&self, figure: &mut PlotFigure, panel: &PlotPanel, tracks: &Tracks) {
        let many = usize::from(tracks.agents.len() > FEW_AGENTS);
        for (agent, track) in tracks.agents.iter().enumerate() {
            let style = LineStyle { opacity: 0.85, ..LineStyle::solid(line_colour(agent), PATH_PX[many]) };
            figure.polyline(panel, track.positions_m.iter().copied(), style);
        }
        for goal_m in self.scenario.sources.iter().filter_map(|source| source.goals_m.last()) {
            figure.mark(panel, *goal_m, PlotMark::Cross, MARK_PX[many], INK);
        }
        let agents = &self.scenario.agents;
        for agent in 0..agents.len().max(tracks.agents.len()) {
            let (colour, spec) = (line_colour(agent), agents.get(agent));
            if let Some(goal_m) = spec.and_then(|spec| spec.goals_m.last()) {
                figure.mark(panel, *goal_m, PlotMark::Cross, MARK_PX[many], colour);
            }
            let start_m = tracks.agents.get(agent).and_then(|track| track.positions_m.first().copied());
            if let Some(start_m) = start_m.or(spec.map(|spec| spec.position_m)) {
                figure.mark(panel, start_m, PlotMark::Disc, 0.8 * MARK_PX[many], colour);
            }
        }
    }
}

//! Paths of the same agents in several simulations, side by side, as in the paper's Fig. 7. One colour per agent, the
//! same in every panel; measures below each panel. World axes, metres.

use fbcrowd_sim::scenario::Scenario;
use glam::Vec2;
use tiny_skia::Pixmap;

use crate::plots::chart::figure::PlotFigure;
use crate::plots::crowd::trajectories::{PATH_LEGEND, PathScene};
use crate::raster::text::TextAnchor;
use crate::top_view::trails::Tracks;

/// Width of the axes of a panel, pixels.
const PANEL_PX: f32 = 760.0;
/// Margin to the left of each panel's axes, pixels.
const LEFT_PX: f32 = 100.0;
/// Least and greatest height of the axes, which follows the scene's, pixels.
const PANEL_HEIGHTS_PX: [f32; 2] = [320.0, 1100.0];
/// Margin above the axes, pixels.
const ABOVE_PX: f32 = 220.0;
/// Margin below the axes, without the notes, pixels.
const BELOW_PX: f32 = 130.0;
/// Height of a line of notes, pixels.
const LINE_PX: f32 = 36.0;
/// Left end of the title's baseline, pixels.
const TITLE_PX: Vec2 = Vec2::new(LEFT_PX, 70.0);
/// Left end of the legend's baseline, pixels.
const LEGEND_PX: Vec2 = Vec2::new(LEFT_PX + 10.0, 118.0);

/// Content of one panel: the paths of one simulation.
///
/// ```
/// use fbcrowd_render::Tracks;
/// use fbcrowd_render::plots::crowd::{PathPanel, side_by_side};
/// use fbcrowd_sim::{AgentId, AgentSpec, Scenario};
/// use glam::Vec2;
///
/// let scenario = Scenario::of(vec![AgentSpec { goals_m: vec![Vec2::new(4.0, 0.0)], ..AgentSpec::default() }]);
/// let mut tracks = Tracks::new(1.0);
/// tracks.push([(AgentId(0), Vec2::ZERO)]);
/// tracks.push([(AgentId(0), Vec2::new(4.0, 0.0))]);
/// let panel = |heading: &str| PathPanel { heading: heading.to_owned(), notes: Vec::new(), tracks: &tracks };
/// let picture = side_by_side("One agent, two planners", &scenario, &[panel("MCN"), panel("ORCA")]);
/// assert!(picture.width() > picture.height());
/// ```
#[derive(Clone, Debug)]
pub struct PathPanel<'a> {
    /// Heading of the panel.
    pub heading: String,
    /// Measures, one per line.
    pub notes: Vec<String>,
    /// Paths of all agents.
    pub tracks: &'a Tracks,
}

/// The figure of several panels; all show the same part of the world.
pub fn side_by_side(title: &str, scenario: &Scenario, panels: &[PathPanel<'_>]) -> Pixmap {
    let tracks: Vec<&Tracks> = panels.iter().map(|panel| panel.tracks).collect();
    let scene = PathScene::new(scenario, &tracks);
    let height = scene.height_px(PANEL_PX, PANEL_HEIGHTS_PX);
    let lines = panels.iter().map(|panel| panel.notes.len()).max().unwrap_or(0) as f32;
    let width = LEFT_PX + panels.len() as f32 * (LEFT_PX + PANEL_PX);
    let mut figure = PlotFigure::new([width as u32, (ABOVE_PX + height + BELOW_PX + lines * LINE_PX) as u32]);
    figure.title(title, TITLE_PX);
    figure.legend(LEGEND_PX, &PATH_LEGEND);
    for (index, panel) in panels.iter().enumerate() {
        let left = LEFT_PX + index as f32 * (LEFT_PX + PANEL_PX);
        scene.draw(&mut figure, [left, ABOVE_PX, PANEL_PX, height], panel.tracks);
        let centre = left + 0.5 * PANEL_PX;
        figure.text(&panel.heading, Vec2::new(centre, ABOVE_PX - 14.0), TextAnchor::Centre);
        for (line, note) in panel.notes.iter().enumerate() {
            let baseline = ABOVE_PX + height + BELOW_PX + (line as f32 - 0.4) * LINE_PX;
            figure.text(note, Vec2::new(centre, baseline), TextAnchor::Centre);
        }
    }
    figure.pixmap
}

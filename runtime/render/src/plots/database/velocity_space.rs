//! The velocities that a database allows, in the agent's frame, as the paper's Fig. 3: turning and holding set, and the
//! edges that forbid sharp turns. By the paper's own construction there is one set, and only the motions that span it
//! are shown.

use glam::Vec2;
use motiondb::motion::{MotionDb, MotionExample};
use motiondb::velocity_sets::velocity_hull::{Construction, is_holding, is_turning, turning_point_mps};
use tiny_skia::Pixmap;

use crate::plots::chart::axis::{PlotAxis, equal_units};
use crate::plots::chart::figure::{LineStyle, PlotFigure, PlotPanel};
use crate::plots::chart::mark::PlotMark;
use crate::raster::palette::{INK, Rgb};

/// Sides of the sheet, pixels.
const SHEET_PX: [u32; 2] = [1600, 1400];
/// Left, top, width, height of the axes on it, pixels.
const PANEL_PX: [f32; 4] = [130.0, 190.0, 1410.0, 1080.0];
/// Turning set: a blue; holding set: an ochre; sharp-turn edges: a red, as in the paper.
pub(crate) const TURNING_SET: Rgb = Rgb::new(0.16, 0.40, 0.72);
pub(crate) const HOLDING_SET: Rgb = Rgb::new(0.78, 0.52, 0.10);
pub(crate) const SHARP_TURN_EDGES: Rgb = Rgb::new(0.80, 0.16, 0.16);

/// The plot of a database's velocity sets.
pub fn velocity_space(db: &MotionDb) -> Pixmap {
    let mut figure = PlotFigure::new(SHEET_PX);
    figure.title(title(db), Vec2::new(PANEL_PX[0], 70.0));
    let panel = figure.panel(PANEL_PX, equal_units(PANEL_PX, axes(db)));
    draw_sets(&mut figure, &panel, db);
    draw_axes(&mut figure, &panel);
    draw_examples(&mut figure, &panel, db);
    figure.legend(Vec2::new(PANEL_PX[0] + 10.0, 122.0), &legend(db));
    figure.pixmap
}

fn is_papers(db: &MotionDb) -> bool {
    db.velocity_hull.construction == Construction::Paper
}

fn title(db: &MotionDb) -> &'static str {
    if is_papers(db) {
        "Velocities that the motions allow, by the paper's construction, in the agent's frame"
    } else {
        "Velocities that the motions allow, in the agent's frame"
    }
}

fn legend(db: &MotionDb) -> Vec<(PlotMark, Rgb, &'static str)> {
    let sharp_turns = (PlotMark::Dashes, SHARP_TURN_EDGES, "sharp-turn edges");
    let mirrors = (PlotMark::Ring, INK, "mirrored twins, unnamed");
    if is_papers(db) {
        return vec![(PlotMark::Disc, TURNING_SET, "the only set"), sharp_turns, mirrors];
    }
    vec![
        (PlotMark::Disc, TURNING_SET, "turning set"),
        (PlotMark::Diamond, HOLDING_SET, "holding set"),
        sharp_turns,
        mirrors,
    ]
}

/// Forward to the right and left up: the agent's frame, not mirrored.
fn axes(db: &MotionDb) -> [PlotAxis; 2] {
    let points: Vec<Vec2> = shown(db).map(|(_, (_, _, point))| point).collect();
    let with_origin = |values: Vec<f32>| values.into_iter().chain([0.0]);
    [
        PlotAxis::around("forward velocity, m/s", with_origin(points.iter().map(|point| point.x).collect())),
        PlotAxis::around("velocity to the left, m/s", with_origin(points.iter().map(|point| point.y).collect())),
    ]
}

/// Every example, with its mark in each set that it spans.
fn shown(db: &MotionDb) -> impl Iterator<Item = (&MotionExample, (PlotMark, Rgb, Vec2))> {
    let marks = |example| {
        let [turning, holding] = points_mps(example);
        let holding = holding.filter(|_| !is_papers(db));
        turning.into_iter().chain(holding).map(move |mark| (example, mark))
    };
    db.examples.iter().flat_map(marks)
}

/// Where an example stands in the turning and, unless it is shown there, the holding set; the marks of mirrored twins
/// are open.
fn points_mps(example: &MotionExample) -> [Option<(PlotMark, Rgb, Vec2)>; 2] {
    let parameters = &example.parameters;
    let [turning_mark, holding_mark] =
        if example.mirrored { [PlotMark::Ring, PlotMark::OpenDiamond] } else { [PlotMark::Disc, PlotMark::Diamond] };
    let turning = is_turning(parameters).then(|| (turning_mark, TURNING_SET, turning_point_mps(parameters)));
    let held = Vec2::new(parameters.speed_mps, parameters.strafe_mps);
    let holding = (is_holding(parameters) && !is_turning(parameters)).then_some((holding_mark, HOLDING_SET, held));
    [turning, holding]
}

fn draw_sets(figure: &mut PlotFigure, panel: &PlotPanel, db: &MotionDb) {
    let sets = &db.velocity_hull;
    if !is_papers(db) {
        figure.polygon(panel, sets.holding_mps.iter().copied(), 0.13, LineStyle::solid(HOLDING_SET, 3.0));
    }
    figure.polygon(panel, sets.turning_mps.iter().copied(), 0.13, LineStyle::solid(TURNING_SET, 3.0));
    for edge in &sets.sharp_turn_edges_mps {
        figure.polyline(panel, *edge, LineStyle { is_dashed: true, ..LineStyle::solid(SHARP_TURN_EDGES, 4.5) });
    }
}

/// The agent's own axes, through the origin.
fn draw_axes(figure: &mut PlotFigure, panel: &PlotPanel) {
    let [x, y] = &panel.axes;
    let axis = LineStyle { opacity: 0.5, ..LineStyle::solid(INK, 1.5) };
    figure.polyline(panel, [Vec2::new(x.low, 0.0), Vec2::new(x.high, 0.0)], axis);
    figure.polyline(panel, [Vec2::new(0.0, y.low), Vec2::new(0.0, y.high)], axis);
}

fn draw_examples(figure: &mut PlotFigure, panel: &PlotPanel, db: &MotionDb) {
    let mut names = Vec::new();
    for (example, (mark, colour, point)) in shown(db) {
        figure.mark(panel, point, mark, 8.0, colour);
        names.push((point, if example.mirrored { "" } else { example.name.as_str() }));
    }
    figure.names(panel, &names);
}

//! The velocity sets of a database (`FbCrowd` Fig. 3): turning set, holding set, and sharp-turn edges, with the
//! examples that span them. By the paper's own construction there is a single set. Agent's frame, m/s.

use glam::Vec2;
use motiondb::motion::{MotionDb, MotionExample};
use motiondb::velocity_sets::velocity_hull::{Construction, is_holding, is_turning, turning_point_mps};
use tiny_skia::Pixmap;

use crate::plots::chart::axis::{PlotAxis, equal_units};
use crate::plots::chart::figure::{LineStyle, PlotFigure, PlotPanel};
use crate::plots::chart::mark::PlotMark;
use crate::raster::palette::{HOLDING_SET, INK, Rgb, SHARP_TURN_EDGES, TURNING_SET};

/// Width and height of the figure, pixels.
const SIZE_PX: [u32; 2] = [1600, 1400];
/// Left end of the title's baseline, pixels.
const TITLE_PX: Vec2 = Vec2::new(130.0, 70.0);
/// Left end of the legend's baseline, pixels.
const LEGEND_PX: Vec2 = Vec2::new(140.0, 122.0);
/// Opacity of a filled set.
const SET_OPACITY: f32 = 0.13;
/// Left, top, width, height of the axes, pixels.
const PANEL_PX: [f32; 4] = [130.0, 190.0, 1410.0, 1080.0];

/// The figure of a database's velocity sets.
pub fn velocity_space(db: &MotionDb) -> Pixmap {
    let mut figure = PlotFigure::new(SIZE_PX);
    figure.title(title(db), TITLE_PX);
    let panel = figure.panel(PANEL_PX, equal_units(PANEL_PX, axes(db)));
    draw_sets(&mut figure, &panel, db);
    draw_axes(&mut figure, &panel);
    draw_examples(&mut figure, &panel, db);
    figure.legend(LEGEND_PX, &legend(db));
    figure.pixmap
}

/// Whether the sets are built as in the paper.
fn is_by_paper(db: &MotionDb) -> bool {
    db.velocity_hull.construction == Construction::Paper
}

fn title(db: &MotionDb) -> &'static str {
    if is_by_paper(db) {
        "Velocities that the motions allow, by the paper's construction, in the agent's frame"
    } else {
        "Velocities that the motions allow, in the agent's frame"
    }
}

fn legend(db: &MotionDb) -> Vec<(PlotMark, Rgb, &'static str)> {
    let sharp_turns = (PlotMark::Dashes, SHARP_TURN_EDGES, "sharp-turn edges");
    let mirrors = (PlotMark::Ring, INK, "mirrored examples, unnamed");
    if is_by_paper(db) {
        return vec![(PlotMark::Disc, TURNING_SET, "the only set"), sharp_turns, mirrors];
    }
    vec![
        (PlotMark::Disc, TURNING_SET, "turning set"),
        (PlotMark::Diamond, HOLDING_SET, "holding set"),
        sharp_turns,
        mirrors,
    ]
}

/// Axes over all shown points and the origin: forward is to the right, left is up.
fn axes(db: &MotionDb) -> [PlotAxis; 2] {
    let points: Vec<Vec2> = shown(db).map(|(_, (_, _, point))| point).collect();
    let with_origin = |values: Vec<f32>| values.into_iter().chain([0.0]);
    [
        PlotAxis::around("forward velocity, m/s", with_origin(points.iter().map(|point| point.x).collect())),
        PlotAxis::around("velocity to the left, m/s", with_origin(points.iter().map(|point| point.y).collect())),
    ]
}

/// Examples with mark, colour and position of each point that is shown of them.
fn shown(db: &MotionDb) -> impl Iterator<Item = (&MotionExample, (PlotMark, Rgb, Vec2))> {
    let marks = |example| {
        let [turning, holding] = points_mps(example);
        let holding = holding.filter(|_| !is_by_paper(db));
        turning.into_iter().chain(holding).map(move |mark| (example, mark))
    };
    db.examples.iter().flat_map(marks)
}

/// Point of an example in the turning set or else in the holding set. Marks of mirrored examples are open.
fn points_mps(example: &MotionExample) -> [Option<(PlotMark, Rgb, Vec2)>; 2] {
    let parameters = &example.parameters;
    let [turning_mark, holding_mark] =
        if example.mirrored { [PlotMark::Ring, PlotMark::OpenDiamond] } else { [PlotMark::Disc, PlotMark::Diamond] };
    let turning = is_turning(parameters).then(|| (turning_mark, TURNING_SET, turning_point_mps(parameters)));
    let held = parameters.velocity_mps();
    let holding = (is_holding(parameters) && !is_turning(parameters)).then_some((holding_mark, HOLDING_SET, held));
    [turning, holding]
}

fn draw_sets(figure: &mut PlotFigure, panel: &PlotPanel, db: &MotionDb) {
    let sets = &db.velocity_hull;
    if !is_by_paper(db) {
        figure.polygon(panel, sets.holding_mps.iter().copied(), SET_OPACITY, LineStyle::solid(HOLDING_SET, 3.0));
    }
    figure.polygon(panel, sets.turning_mps.iter().copied(), SET_OPACITY, LineStyle::solid(TURNING_SET, 3.0));
    for edge in &sets.sharp_turn_edges_mps {
        figure.polyline(panel, *edge, LineStyle { is_dashed: true, ..LineStyle::solid(SHARP_TURN_EDGES, 4.5) });
    }
}

/// Draws the agent's axes through the origin.
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

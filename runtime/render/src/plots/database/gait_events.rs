//! Gait events: for each example, height and speed of both soles over the cycle, the contacts, and the four key times.
//!
//! The curves are those of a sole's lowest point. Its speed is relative to the ground: with root velocity v and turn
//! rate ω, a point p of the root frame has the velocity v + ω·perp(p) + dp/dt. A sheet has up to 36 examples. Metres,
//! seconds.

use std::ops::Range;

use glam::{Vec2, Vec3};
use motiondb::body::{Pose, Side};
use motiondb::motion::{MotionDb, MotionExample, PHASE_COUNT};
use motiondb::quality::planted_feet::PLANTED_CONTACT;
use tiny_skia::Pixmap;

use crate::plots::chart::axis::PlotAxis;
use crate::plots::chart::cell_grid::CellGrid;
use crate::plots::chart::figure::{LineStyle, PlotFigure, PlotPanel};
use crate::plots::chart::mark::PlotMark;
use crate::raster::palette::{INK, SIDES};
use crate::raster::text::TextAnchor;

/// Greatest number of examples on a sheet.
pub(crate) const SHEET_EXAMPLES: usize = 36;
/// Grid of the examples on a sheet.
const GRID: CellGrid = CellGrid { columns: 3, cell_px: Vec2::new(800.0, 720.0), head_px: 180.0 };
/// Left, top, width, height of the axes of the heights, in an example's cell, pixels.
const HEIGHT_PANEL_PX: [f32; 4] = [120.0, 90.0, 650.0, 270.0];
/// Left, top, width, height of the axes of the speeds, in an example's cell, pixels.
const SPEED_PANEL_PX: [f32; 4] = [120.0, 470.0, 650.0, 160.0];
/// Left end of the title's baseline, pixels.
const TITLE_PX: Vec2 = Vec2::new(120.0, 70.0);
/// Left end of the legend's baseline, pixels.
const LEGEND_PX: Vec2 = Vec2::new(130.0, 130.0);
/// Least gap between an axis's label and the example's name, pixels.
const NAME_GAP_PX: f32 = 40.0;
/// Height of the left and the right foot's contact bars above the axis's lower end, share of the axis.
const BAR_SHARES: [f32; 2] = [0.10, 0.04];
/// Margin below the heights (for the bars) and above them (for the names of key times), share of their range.
const MARGIN_SHARES: [f32; 2] = [0.24, 0.25];
/// Least range of the heights, m: curves of standing feet are level lines, not noise.
const MIN_RANGE_M: f32 = 0.05;
/// Least range of the speeds, m/s.
const MIN_RANGE_MPS: f32 = 0.5;
/// Names of the key times, in their order.
const KEY_NAMES: [&str; 4] = ["R off", "R strike", "L off", "L strike"];
/// Foot of each key time, as an index of a `[left, right]` pair.
const KEY_SIDES: [usize; 4] = [1, 1, 0, 0];

/// The sheet of gait events of some examples of a database, given by index.
pub fn gait_events(db: &MotionDb, examples: Range<usize>) -> Pixmap {
    let mut figure = PlotFigure::new(GRID.size_px(examples.len()));
    figure.title("Lowest point of each sole, its speed over the ground, contacts and key times", TITLE_PX);
    let legend = [
        (PlotMark::Disc, SIDES[0], "left foot"),
        (PlotMark::Disc, SIDES[1], "right foot"),
        (PlotMark::Bar, INK, "planted"),
        (PlotMark::Dashes, INK, "key times: toe-offs and heel strikes"),
    ];
    figure.legend(LEGEND_PX, &legend);
    for (cell, example) in examples.enumerate() {
        draw_example(&mut figure, db, example, cell);
    }
    figure.pixmap
}

fn draw_example(figure: &mut PlotFigure, db: &MotionDb, index: usize, cell: usize) {
    let example = &db.examples[index];
    let soles = Side::BOTH.map(|side| sole_curves(db, index, side));
    let [heights_m, speeds_mps] = [0, 1].map(|curve| soles.each_ref().map(|sole| sole[curve].as_slice()));
    let mut panel = |rect_px: [f32; 4], value: PlotAxis| {
        let time = PlotAxis::new("time, s", [0.0, example.phase_map.period_s]);
        figure.panel(GRID.rect_px(cell, rect_px), [time, value])
    };
    let height_panel = panel(HEIGHT_PANEL_PX, height_axis(heights_m));
    let speed_panel = panel(SPEED_PANEL_PX, speed_axis(speeds_mps));
    let [left, top, width, _] = HEIGHT_PANEL_PX;
    let name = figure.fitted(&example.name, width - figure.width_px(&height_panel.axes[1].label) - NAME_GAP_PX);
    figure.text(&name, GRID.corner_px(cell) + Vec2::new(left + width, top - 16.0), TextAnchor::Right);
    draw_key_times(figure, &height_panel, example, &KEY_NAMES);
    draw_key_times(figure, &speed_panel, example, &[""; 4]);
    for side in Side::BOTH {
        for (panel, curves) in [(&height_panel, heights_m), (&speed_panel, speeds_mps)] {
            let points = curves[side.index()].iter().enumerate();
            let points = points.map(|(row, value)| Vec2::new(time_s(example, row), *value));
            figure.polyline(panel, points, LineStyle::solid(SIDES[side.index()], 2.4));
        }
        draw_contacts(figure, &height_panel, db, index, side);
    }
}

fn height_axis(heights_m: [&[f32]; 2]) -> PlotAxis {
    let all = heights_m.into_iter().flatten();
    let [low, high] = all.fold([0.0_f32; 2], |[low, high], height| [low.min(*height), high.max(*height)]);
    let range = (high - low).max(MIN_RANGE_M);
    let [below, above] = MARGIN_SHARES.map(|share| share * range);
    PlotAxis::new("height, m", [low - below, low + range + above])
}

fn speed_axis(speeds_mps: [&[f32]; 2]) -> PlotAxis {
    let highest = speeds_mps.into_iter().flatten().copied().fold(MIN_RANGE_MPS, f32::max);
    PlotAxis::new("speed, m/s", [0.0, 1.08 * highest])
}

/// Height (m) and horizontal speed over the ground (m/s) of the lowest sole point, at each stored phase and at the
/// first one again, which closes the cycle.
fn sole_curves(db: &MotionDb, example: usize, side: Side) -> [Vec<f32>; 2] {
    let soles: Vec<[Vec3; 3]> = (0..PHASE_COUNT).map(|phase| sole_points_m(db, example, phase, side)).collect();
    let lowest = |row: usize| {
        let points_m = soles[row % PHASE_COUNT];
        (0..3).min_by(|a, b| points_m[*a].z.total_cmp(&points_m[*b].z)).unwrap_or(0)
    };
    let height_m = |row: usize| soles[row % PHASE_COUNT][lowest(row)].z;
    let speed_mps = |row: usize| {
        let (point, found) = (lowest(row), &db.examples[example]);
        let at_m = |row: usize| soles[row % PHASE_COUNT][point].truncate();
        let steps_s = [row + PHASE_COUNT - 1, row + PHASE_COUNT + 1].map(|row| time_s(found, row));
        let in_root_mps = (at_m(row + 1) - at_m(row + PHASE_COUNT - 1)) / (steps_s[1] - steps_s[0]);
        let root_mps = found.parameters.velocity_mps();
        (root_mps + found.parameters.turn_rate_rad_s * at_m(row).perp() + in_root_mps).length()
    };
    [(0..=PHASE_COUNT).map(height_m).collect(), (0..=PHASE_COUNT).map(speed_mps).collect()]
}

fn sole_points_m(db: &MotionDb, example: usize, phase: usize, side: Side) -> [Vec3; 3] {
    let pelvis_m = db.rows.pelvis_m[example * PHASE_COUNT + phase];
    let joints = Pose { pelvis_m, rotations: *db.rows.rotations(example, phase) }.forward_kinematics(&db.skeleton);
    joints.sole_points_m(&db.skeleton, side.index())
}

fn time_s(example: &MotionExample, row: usize) -> f32 {
    example.phase_map.time_s(row as f32 / PHASE_COUNT as f32)
}

/// Draws a bar below the curves for each time in which the foot is planted.
fn draw_contacts(figure: &mut PlotFigure, panel: &PlotPanel, db: &MotionDb, example: usize, side: Side) {
    let [_, height] = &panel.axes;
    let height_m = height.low + BAR_SHARES[side.index()] * (height.high - height.low);
    let planted = |row: usize| {
        f64::from(db.rows.contacts[example * PHASE_COUNT + row % PHASE_COUNT][side.index()]) >= PLANTED_CONTACT
    };
    for row in (0..PHASE_COUNT).filter(|row| planted(*row) && planted(row + 1)) {
        let ends = [row, row + 1].map(|row| Vec2::new(time_s(&db.examples[example], row), height_m));
        figure.polyline(panel, ends, LineStyle::solid(SIDES[side.index()], 6.0));
    }
}

/// Draws a vertical line with a name at each key time.
fn draw_key_times(figure: &mut PlotFigure, panel: &PlotPanel, example: &MotionExample, names: &[&str; 4]) {
    let Some(key_times_s) = example.key_times_s else { return };
    let [_, value] = &panel.axes;
    for (key, time_s) in key_times_s.into_iter().enumerate() {
        let ends = [Vec2::new(time_s, value.low), Vec2::new(time_s, value.high)];
        let colour = SIDES[KEY_SIDES[key]];
        figure.polyline(panel, ends, LineStyle { is_dashed: true, opacity: 0.8, ..LineStyle::solid(colour, 1.3) });
        // Key times may be close together: their names alternate between two heights.
        let at = panel.to_px(ends[1]) + Vec2::new(4.0, 18.0 + 20.0 * (key % 2) as f32);
        figure.note(names[key], at, TextAnchor::Left, INK);
    }
}

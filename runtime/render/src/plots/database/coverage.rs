//! Coverage of (v_f, ω_t, ω_s) by the examples: three slices through the space of parameters, and the sentences of
//! [`motiondb::quality::coverage`].
//!
//! The colour of a point p shows how much the examples differ that are blended there: their mean distance Σ u_i·|p_i − p|,
//! each axis divided by its range over the examples. Points outside the hull stay white: bodies do not move with such
//! parameters.

use glam::{Vec2, Vec3};
use motiondb::blend_space::Locator;
use motiondb::motion::{MotionDb, Parameters};
use motiondb::quality::coverage::coverage;
use tiny_skia::Pixmap;

use crate::plots::chart::axis::{PlotAxis, number};
use crate::plots::chart::figure::{PlotFigure, PlotPanel};
use crate::plots::chart::mark::PlotMark;
use crate::plots::database::parameter_planes::{
    LEFT_PX, LEGEND_PX, PANEL_WIDTH_PX, PLANES, TITLE_PX, WIDTH_PX, example_points, in_plane, plane_panel,
};
use crate::raster::paint::fill_rect;
use crate::raster::palette::{INK, heat};
use crate::raster::text::TextAnchor;

/// Top and height of every panel, pixels.
const PANEL_TOP_AND_HEIGHT_PX: [f32; 2] = [260.0, 720.0];
/// Distance of a panel's heading above it, pixels.
const HEADING_PX: f32 = 14.0;
/// Side of the squares of one colour, pixels.
const CELL_PX: f32 = 10.0;
/// Baseline of the first sentence, pixels.
const SENTENCE_TOP_PX: f32 = 1120.0;
/// Distance of the sentences' baselines, pixels.
const SENTENCE_STEP_PX: f32 = 40.0;
/// Margin below the last sentence, pixels.
const BELOW_PX: f32 = 20.0;
/// Greatest distance of an example from a slice in which it is shown, share of the third parameter's range.
const IN_SLICE_SHARE: f32 = 0.05;
/// Mean distance of the hottest colour, ranges: almost half across the examples.
const HOTTEST_DISTANCE: f32 = 0.4;

/// The figure of a database's coverage.
pub fn coverage_slices(db: &MotionDb) -> Pixmap {
    let mut sentences: Vec<String> = coverage(db).into_iter().map(|gap| gap.sentence).collect();
    if sentences.is_empty() {
        sentences.push("The database has no coverage gap.".to_owned());
    }
    let height = SENTENCE_TOP_PX + sentences.len() as f32 * SENTENCE_STEP_PX + BELOW_PX;
    let mut figure = PlotFigure::new([WIDTH_PX, height as u32]);
    figure.title("Coverage: mean distance of the examples that are blended, shares of the axes' ranges", TITLE_PX);
    draw_legend(&mut figure);
    let (locator, points) = (db.locator(), example_points(db));
    for plane in 0..PLANES.len() {
        draw_slice(&mut figure, db, &locator, &points, plane);
    }
    for (line, sentence) in sentences.iter().enumerate() {
        let baseline = SENTENCE_TOP_PX + line as f32 * SENTENCE_STEP_PX;
        figure.text(sentence, Vec2::new(LEFT_PX, baseline), TextAnchor::Left);
    }
    figure.pixmap
}

fn draw_legend(figure: &mut PlotFigure) {
    let [low, middle, high] = [0.0, 0.5, 1.0].map(|share| number(share * HOTTEST_DISTANCE, 1));
    let high = format!("{high} and more; white: outside the hull");
    let examples = [(PlotMark::Disc, INK, "examples in the slice"), (PlotMark::Ring, INK, "mirrored examples")];
    figure.heat_legend(LEGEND_PX, [&low, &middle, &high], &examples);
}

fn draw_slice(figure: &mut PlotFigure, db: &MotionDb, locator: &Locator, points: &[Vec3], plane: usize) {
    let panel = plane_panel(figure, points, plane, PANEL_TOP_AND_HEIGHT_PX);
    let (third, value) = third_parameter(db, PLANES[plane]);
    let heading = match third {
        0 => format!("at {} m/s forward", number(value, 2)),
        1 => "without turning".to_owned(),
        _ => "without side speed".to_owned(),
    };
    let corner = Vec2::new(panel.rect_px[0] + PANEL_WIDTH_PX, PANEL_TOP_AND_HEIGHT_PX[0] - HEADING_PX);
    figure.text(&heading, corner, TextAnchor::Right);
    draw_cells(figure, &panel, db, locator, PLANES[plane]);
    for (example, point) in db.examples.iter().zip(points) {
        let distance = (example.parameters.to_vec3()[third] - value).abs();
        if distance <= IN_SLICE_SHARE * db.blend_space.axis_ranges[third] {
            let mark = if example.mirrored { PlotMark::Ring } else { PlotMark::Disc };
            figure.mark(&panel, in_plane(*point, PLANES[plane]), mark, 6.5, INK);
        }
    }
}

/// Index and value of the parameter that is constant in a slice. ω_t and ω_s are 0. v_f is that of m_sp: at v_f = 0, a
/// database without backward clips has nothing to show.
fn third_parameter(db: &MotionDb, plane: [usize; 2]) -> (usize, f32) {
    let third = 3 - plane[0] - plane[1];
    let walk = db.correspondence.as_ref().map(|found| db.examples[found.semi_procedural as usize].parameters);
    (third, if third == 0 { walk.unwrap_or_default().speed_mps } else { 0.0 })
}

/// Colours every square of the panel with its middle inside the hull.
fn draw_cells(figure: &mut PlotFigure, panel: &PlotPanel, db: &MotionDb, locator: &Locator, plane: [usize; 2]) {
    let [left, top, width, height] = panel.rect_px;
    let [columns, rows] = [width, height].map(|side_px| (side_px / CELL_PX) as usize);
    let (third, value) = third_parameter(db, plane);
    for (column, row) in (0..columns).flat_map(|column| (0..rows).map(move |row| (column, row))) {
        let share = |index: usize, count: usize| (index as f32 + 0.5) / count as f32;
        let at = |axis: &PlotAxis, share: f32| axis.low + share * (axis.high - axis.low);
        let mut query = Vec3::ZERO;
        query[plane[0]] = at(&panel.axes[0], share(column, columns));
        query[plane[1]] = at(&panel.axes[1], 1.0 - share(row, rows));
        query.y = query.y.to_radians();
        query[third] = value;
        if let Some(distance) = mean_distance(db, locator, Parameters::from_vec3(query)) {
            let corner = Vec2::new(left + column as f32 * CELL_PX, top + row as f32 * CELL_PX);
            let colour = heat(distance / HOTTEST_DISTANCE);
            fill_rect(&mut figure.pixmap, [corner.x, corner.y, CELL_PX, CELL_PX], colour, 1.0);
        }
    }
}

/// Σ u_i·|p_i − p|, ranges; `None` outside the hull.
fn mean_distance(db: &MotionDb, locator: &Locator, query: Parameters) -> Option<f32> {
    let shares = locator.locate_inside(query)?;
    let point = db.blend_space.scaled(query);
    let distance = |example: u32| db.blend_space.scaled(db.examples[example as usize].parameters).distance(point);
    Some(shares.examples.into_iter().zip(shares.shares).map(|(example, share)| share * distance(example)).sum())
}

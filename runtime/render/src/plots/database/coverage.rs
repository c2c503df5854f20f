//! Where in (v_f, ω_t, ω_s) a set of clips is thin: three slices through the space of parameters and the sentences of
//! [`motiondb::quality::coverage`].
//!
//! Colour says how unlike the motions are that meet there: the mean distance of the mixed examples from the asked
//! parameters, Σ u_i·|p_i − p|, each axis divided by its range over the examples. White paper lies outside the hull:
//! bodies do not move like that.

use glam::{Vec2, Vec3};
use motiondb::blend_space::Locator;
use motiondb::motion::{MotionDb, Parameters};
use motiondb::quality::coverage::coverage;
use tiny_skia::Pixmap;

use crate::plots::chart::axis::{PlotAxis, number};
use crate::plots::chart::figure::{PlotFigure, PlotPanel};
use crate::plots::chart::mark::PlotMark;
use crate::raster::paint::fill_rect;
use crate::raster::palette::{INK, heat};
use crate::raster::text::TextAnchor;

/// Width of the sheet, pixels.
const WIDTH_PX: u32 = 2900;
/// Top and height of every panel, pixels.
const PANEL_TOP_AND_HEIGHT_PX: [f32; 2] = [260.0, 720.0];
/// Left edge of the first panel, width of each, and distance from one to the next, pixels.
const PANEL_LEFT_WIDTH_STEP_PX: [f32; 3] = [120.0, 820.0, 930.0];
/// Side of the squares that are coloured alike, pixels.
const CELL_PX: f32 = 10.0;
/// First sentence, and distance of sentences, pixels.
const SENTENCE_TOP_PX: f32 = 1120.0;
const SENTENCE_STEP_PX: f32 = 40.0;
/// The two axes of each slice: v_f and ω_t, v_f and ω_s, ω_t and ω_s. The third parameter is 0, but v_f that of m_sp:
/// at v_f = 0 a set without backward clips has nothing to show.
const SLICES: [[usize; 2]; 3] = [[0, 1], [0, 2], [1, 2]];
const AXIS_NAMES: [&str; 3] = ["forward speed v_f, m/s", "turn rate ω_t, °/s", "side speed ω_s, m/s"];
/// An example is shown in a slice that it lies this near to, share of the third parameter's range.
const IN_SLICE_SHARE: f32 = 0.05;
/// The mean distance that is coloured as thin as can be, ranges: as far as half across the set.
const THINNEST: f32 = 0.4;
/// The plot of a database's thin places.
pub fn coverage_slices(db: &MotionDb) -> Pixmap {
    let sentences: Vec<String> = match coverage(db) {
        found if found.is_empty() => vec!["The set is thin nowhere.".to_owned()],
        found => found.into_iter().map(|thin| thin.sentence).collect(),
    };
    let height = SENTENCE_TOP_PX + sentences.len() as f32 * SENTENCE_STEP_PX + 20.0;
    let mut figure = PlotFigure::new([WIDTH_PX, height as u32]);
    let left = PANEL_LEFT_WIDTH_STEP_PX[0];
    figure.title(
        "Where the set is thin: mean distance of the examples that are mixed, shares of the axes' ranges",
        Vec2::new(left, 80.0),
    );
    draw_legend(&mut figure, Vec2::new(left + 10.0, 134.0));
    let locator = db.locator();
    for slice in 0..SLICES.len() {
        draw_slice(&mut figure, db, &locator, slice);
    }
    for (line, sentence) in sentences.iter().enumerate() {
        figure.text(sentence, Vec2::new(left, SENTENCE_TOP_PX + line as f32 * SENTENCE_STEP_PX), TextAnchor::Left);
    }
    figure.pixmap
}

fn draw_legend(figure: &mut PlotFigure, at_px: Vec2) {
    let [dense, middle, thin] = [0.0, 0.5, 1.0].map(|share| number(share * THINNEST, 1));
    let thin = format!("{thin} and more; white: outside the hull");
    let examples = [(PlotMark::Disc, INK, "examples in the slice"), (PlotMark::Ring, INK, "their mirrored twins")];
    figure.heat_legend(at_px, [&dense, &middle, &thin], &examples);
}

fn draw_slice(figure: &mut PlotFigure, db: &MotionDb, locator: &Locator, slice: usize) {
    let view = SLICES[slice];
    let points: Vec<Vec3> = db.examples.iter().map(|example| in_plot_units(example.parameters.to_vec3())).collect();
    let [left, width, step] = PANEL_LEFT_WIDTH_STEP_PX;
    let [top, height] = PANEL_TOP_AND_HEIGHT_PX;
    let axes = view.map(|axis| PlotAxis::around(AXIS_NAMES[axis], points.iter().map(|point| point[axis])));
    let panel = figure.panel([left + step * slice as f32, top, width, height], axes);
    let (third, value) = held(db, view);
    let name =
        [format!("at {} m/s forward", number(value, 2)), "without turning".to_owned(), "without side speed".to_owned()];
    figure.text(&name[third], Vec2::new(panel.rect_px[0] + width, top - 14.0), TextAnchor::Right);
    draw_cells(figure, &panel, db, locator, view);
    for (example, point) in db.examples.iter().zip(&points) {
        let off = (example.parameters.to_vec3()[third] - value).abs();
        if off <= IN_SLICE_SHARE * db.blend_space.axis_ranges[third] {
            let mark = if example.mirrored { PlotMark::Ring } else { PlotMark::Disc };
            figure.mark(&panel, Vec2::new(point[view[0]], point[view[1]]), mark, 6.5, INK);
        }
    }
}

/// The third parameter of a slice and what it is held at.
fn held(db: &MotionDb, view: [usize; 2]) -> (usize, f32) {
    let third = 3 - view[0] - view[1];
    let walk = db.correspondence.as_ref().map(|found| db.examples[found.semi_procedural as usize].parameters);
    (third, if third == 0 { walk.unwrap_or_default().speed_mps } else { 0.0 })
}

/// Turn rates read better in degrees.
fn in_plot_units(parameters: Vec3) -> Vec3 {
    Vec3::new(parameters.x, parameters.y.to_degrees(), parameters.z)
}

/// Every square of the panel whose middle lies inside the hull.
fn draw_cells(figure: &mut PlotFigure, panel: &PlotPanel, db: &MotionDb, locator: &Locator, view: [usize; 2]) {
    let [left, top, width, height] = panel.rect_px;
    let [columns, rows] = [width, height].map(|side_px| (side_px / CELL_PX) as usize);
    for (column, row) in (0..columns).flat_map(|column| (0..rows).map(move |row| (column, row))) {
        let share = |index: usize, count: usize| (index as f32 + 0.5) / count as f32;
        let at = |axis: &PlotAxis, share: f32| axis.low + share * (axis.high - axis.low);
        let mut query = Vec3::ZERO;
        query[view[0]] = at(&panel.axes[0], share(column, columns));
        query[view[1]] = at(&panel.axes[1], 1.0 - share(row, rows));
        query.y = query.y.to_radians();
        let (third, value) = held(db, view);
        query[third] = value;
        if let Some(thin) = thinness(db, locator, Parameters::from_vec3(query)) {
            let corner = Vec2::new(left + column as f32 * CELL_PX, top + row as f32 * CELL_PX);
            fill_rect(&mut figure.pixmap, [corner.x, corner.y, CELL_PX, CELL_PX], heat(thin / THINNEST), 1.0);
        }
    }
}

/// Σ u_i·|p_i − p| in ranges; none outside the hull.
fn thinness(db: &MotionDb, locator: &Locator, query: Parameters) -> Option<f32> {
    let shares = locator.locate_inside(query)?;
    let asked = db.blend_space.scaled(query);
    let distance = |example: u32| db.blend_space.scaled(db.examples[example as usize].parameters).distance(asked);
    Some(shares.examples.into_iter().zip(shares.shares).map(|(example, share)| share * distance(example)).sum())
}

//! The contact sheet: each example as a row of bodies and, below it, a row of stick figures, at eight phases of its
//! cycle, from the side, from the front and from above.
//!
//! The bodies are those of the top view, rotated. A line shows the ground. A sheet has up to 24 examples. Poses in the
//! root frame, metres; positions on the sheet in pixels, y down.

use std::ops::Range;

use fbcrowd_sim::recording::AgentFrame;
use glam::Vec2;
use motiondb::body::Pose;
use motiondb::motion::{MotionDb, MotionExample, PHASE_COUNT};
use tiny_skia::Pixmap;

use crate::plots::chart::axis::number;
use crate::plots::chart::figure::PlotFigure;
use crate::plots::database::body_views::{CELL_PX, VIEWS, draw_body, draw_sticks, scale_px_m};
use crate::raster::drawn_body::{self, Detail, DrawnPart};
use crate::raster::paint::fill_rect;
use crate::raster::palette::{GRID_COARSE, INK, look};
use crate::raster::tapered_capsule::Canvas;
use crate::raster::text::TextAnchor;

/// Number of phases drawn of each cycle.
const PHASES: usize = 8;
/// Height of the ground line above a cell's lower edge, pixels.
const GROUND_PX: f32 = 18.0;
/// Width of the column of names, pixels.
const NAMES_PX: f32 = 540.0;
/// Height of the sheet's head, pixels.
const HEAD_PX: f32 = 150.0;
/// Margins, and gaps between views, pixels.
const GAP_PX: f32 = 40.0;
/// Width of one view of one example, pixels.
const STRIP_PX: f32 = PHASES as f32 * CELL_PX.x + GAP_PX;
/// Width of the name and all views of one example, pixels.
const BLOCK_PX: f32 = NAMES_PX + VIEWS.len() as f32 * STRIP_PX;
/// Height of one example (bodies and stick figures), pixels.
const ROW_PX: f32 = 2.0 * CELL_PX.y;
/// Greatest number of examples on a sheet.
pub(crate) const SHEET_EXAMPLES: usize = 24;
/// Greatest number of columns of examples.
const COLUMNS: usize = 2;
/// Left end of the title's baseline, pixels.
const TITLE_PX: Vec2 = Vec2::new(GAP_PX, 66.0);
/// Baseline of the views' names, pixels.
const VIEW_NAMES_PX: f32 = 120.0;

/// The contact sheet of some examples of a database, given by index.
pub fn contact_sheet(db: &MotionDb, examples: Range<usize>) -> Pixmap {
    let columns = examples.len().min(COLUMNS);
    let rows = examples.len().div_ceil(columns.max(1));
    let size = Vec2::new(columns as f32 * BLOCK_PX, HEAD_PX + rows as f32 * ROW_PX + GAP_PX);
    let mut figure = PlotFigure::new([size.x as u32, size.y as u32]);
    figure.title("Examples, one stride each, from right mid-stance on", TITLE_PX);
    for column in 0..columns {
        draw_head(&mut figure, column as f32 * BLOCK_PX);
    }
    let corners: Vec<(usize, Vec2)> = examples.enumerate().map(|(n, example)| (example, corner_px(n, rows))).collect();
    for &(example, corner) in &corners {
        draw_caption(&mut figure, db, example, corner);
        draw_example_sticks(&mut figure.pixmap, db, example, corner + Vec2::new(0.0, CELL_PX.y));
    }
    figure.pixmap = draw_bodies(figure.pixmap, db, &corners);
    figure.pixmap
}

/// Left end of the ground line of the bodies of a sheet's n-th example.
fn corner_px(n: usize, rows: usize) -> Vec2 {
    let [column, row] = [n / rows, n % rows].map(|index| index as f32);
    Vec2::new(column * BLOCK_PX, HEAD_PX + row * ROW_PX + CELL_PX.y - GROUND_PX)
}

/// Position of a body's root relative to the left end of its ground line.
fn cell_px(view: usize, cell: usize) -> Vec2 {
    Vec2::new(NAMES_PX + view as f32 * STRIP_PX + (cell as f32 + 0.5) * CELL_PX.x, -VIEWS[view].lift_px)
}

fn draw_head(figure: &mut PlotFigure, left: f32) {
    for (index, view) in VIEWS.iter().enumerate() {
        figure.text(view.name, Vec2::new(left + NAMES_PX + index as f32 * STRIP_PX, VIEW_NAMES_PX), TextAnchor::Left);
    }
}

/// Draws name, numbers and ground lines of one example.
fn draw_caption(figure: &mut PlotFigure, db: &MotionDb, example: usize, corner: Vec2) {
    let name = figure.fitted(&db.examples[example].name, NAMES_PX - 2.0 * GAP_PX);
    figure.text(&name, corner + Vec2::new(GAP_PX, -70.0), TextAnchor::Left);
    draw_numbers(figure, &db.examples[example], corner + Vec2::new(GAP_PX, -40.0));
    for view in 0..VIEWS.len() {
        let left = corner.x + NAMES_PX + view as f32 * STRIP_PX;
        for ground in [corner.y, corner.y + CELL_PX.y] {
            fill_rect(&mut figure.pixmap, [left, ground.round(), STRIP_PX - GAP_PX, 1.0], GRID_COARSE, 1.0);
        }
    }
}

fn draw_numbers(figure: &mut PlotFigure, example: &MotionExample, at_px: Vec2) {
    let parameters = &example.parameters;
    let (speed, strafe) = (number(parameters.speed_mps, 2), number(parameters.strafe_mps, 2));
    let turn = number(parameters.turn_rate_rad_s.to_degrees(), 0);
    let lines = [
        format!("{speed} m/s forward, {strafe} m/s to the left"),
        format!("{turn} °/s, stride {} s", number(example.phase_map.period_s, 2)),
    ];
    for (index, line) in lines.iter().enumerate() {
        figure.note(line, at_px + Vec2::new(0.0, 26.0 * index as f32), TextAnchor::Left, INK);
    }
}

fn draw_bodies(paper: Pixmap, db: &MotionDb, corners: &[(usize, Vec2)]) -> Pixmap {
    let (mut canvas, scale_px_m) = (Canvas::new(paper), scale_px_m(&db.skeleton));
    for &(example, corner) in corners {
        for cell in 0..PHASES {
            let parts = parts(db, example, cell);
            for (index, view) in VIEWS.iter().enumerate() {
                draw_body(&mut canvas, &parts, view, scale_px_m, corner + cell_px(index, cell));
            }
        }
    }
    canvas.pixmap
}

fn draw_example_sticks(pixmap: &mut Pixmap, db: &MotionDb, example: usize, corner: Vec2) {
    for cell in 0..PHASES {
        let pose = pose(db, example, cell);
        for (index, view) in VIEWS.iter().enumerate() {
            draw_sticks(pixmap, &db.skeleton, &pose, view, corner + cell_px(index, cell));
        }
    }
}

/// Pose of an example in one of its cells, in the root frame.
fn pose(db: &MotionDb, example: usize, cell: usize) -> Pose {
    let phase = cell * PHASE_COUNT / PHASES;
    let rotations = *db.rows.rotations(example, phase);
    Pose { pelvis_m: db.rows.pelvis_m[example * PHASE_COUNT + phase], rotations }
}

/// Parts of the drawn body of an example in one of its cells.
fn parts(db: &MotionDb, example: usize, cell: usize) -> Vec<DrawnPart> {
    let frame = AgentFrame { pose: pose(db, example, cell), ..AgentFrame::default() };
    let mut parts = Vec::new();
    drawn_body::append_parts(&mut parts, &db.skeleton, &frame, 1.0, look(example), Detail::Full);
    parts
}

//! Every example of a database as strips of bodies and, under them, of stick figures: from the side, from the front and
//! from above, at eight phases of its cycle.
//!
//! The bodies are those of the top view, turned; the feet that carry weight stand on an underlined ground. A sheet
//! holds two dozen examples; more go on further sheets.

use std::ops::Range;

use fbcrowd_sim::recording::AgentFrame;
use glam::{Mat3, Quat, Vec2, Vec3};
use motiondb::body::{JOINT_COUNT, Joint, Pose, Skeleton};
use motiondb::motion::{MotionDb, MotionExample, PHASE_COUNT};
use tiny_skia::Pixmap;

use crate::plots::chart::axis::number;
use crate::plots::chart::figure::PlotFigure;
use crate::plots::database::stick_figure;
use crate::raster::drawn_body::{self, Detail, DrawnPart};
use crate::raster::paint::fill_rect;
use crate::raster::palette::{GRID_COARSE, INK, look};
use crate::raster::tapered_capsule::{Canvas, TaperedCapsule};
use crate::raster::text::TextAnchor;

/// Phases drawn of each cycle.
const PHASES: usize = 8;
/// Width and height of one body's cell, pixels.
const CELL_PX: Vec2 = Vec2::new(94.0, 150.0);
/// Pixels a metre, of bodies no taller than this, m; of giants so much fewer that they fit.
const SCALE_PX_M: f32 = 66.0;
const HEIGHT_MAX_M: f32 = 1.95;
/// Height of the ground line over a cell's lower edge, pixels.
const GROUND_PX: f32 = 18.0;
/// Width of the column of names, height of the head row, gap between views, pixels.
const NAMES_PX: f32 = 540.0;
const HEAD_PX: f32 = 150.0;
const GAP_PX: f32 = 40.0;
/// Width of one view of one example, and of all that is drawn of it, pixels.
const STRIP_PX: f32 = PHASES as f32 * CELL_PX.x + GAP_PX;
const BLOCK_PX: f32 = NAMES_PX + VIEWS.len() as f32 * STRIP_PX;
/// Height of one example: bodies over sticks, pixels.
const ROW_PX: f32 = 2.0 * CELL_PX.y;
/// Examples on a sheet, one below the other in two columns.
pub(crate) const SHEET_EXAMPLES: usize = 24;
const COLUMNS: usize = 2;
/// Width of the dark rim under a limb, pixels.
const RIM_PX: f32 = 1.5;
/// Bodies are seen from this far beyond their own depth, so that no part counts as below the paper, m.
const DEPTH_OFFSET_M: f32 = 2.0;

/// One way of looking at a body: its name, and the root frame's axes as right, up and towards the eye.
struct View {
    name: &'static str,
    axes: [Vec3; 3],
    /// Height of the body's root over the ground line: bodies seen from above are centred in their cell, pixels.
    lift_px: f32,
}

const VIEWS: [View; 3] = [
    View { name: "from its right side", axes: [Vec3::X, Vec3::Z, Vec3::NEG_Y], lift_px: 0.0 },
    View { name: "from the front", axes: [Vec3::Y, Vec3::Z, Vec3::X], lift_px: 0.0 },
    View { name: "from above", axes: [Vec3::X, Vec3::Y, Vec3::Z], lift_px: 56.0 },
];

/// The contact sheet of some examples of a database.
pub fn contact_sheet(db: &MotionDb, examples: Range<usize>) -> Pixmap {
    let columns = examples.len().min(COLUMNS);
    let rows = examples.len().div_ceil(columns.max(1));
    let size = Vec2::new(columns as f32 * BLOCK_PX, HEAD_PX + rows as f32 * ROW_PX + GAP_PX);
    let mut figure = PlotFigure::new([size.x as u32, size.y as u32]);
    figure.title("Examples, one stride each, from right mid-stance on", Vec2::new(GAP_PX, 66.0));
    for column in 0..columns {
        draw_head(&mut figure, column as f32 * BLOCK_PX);
    }
    let corners: Vec<(usize, Vec2)> = examples.enumerate().map(|(n, example)| (example, corner_px(n, rows))).collect();
    for &(example, corner) in &corners {
        draw_words(&mut figure, db, example, corner);
        draw_sticks(&mut figure.pixmap, db, example, corner + Vec2::new(0.0, CELL_PX.y));
    }
    figure.pixmap = draw_bodies(figure.pixmap, db, &corners);
    figure.pixmap
}

/// Where the ground line of the bodies of a sheet's n-th example begins.
fn corner_px(n: usize, rows: usize) -> Vec2 {
    let [column, row] = [n / rows, n % rows].map(|index| index as f32);
    Vec2::new(column * BLOCK_PX, HEAD_PX + row * ROW_PX + CELL_PX.y - GROUND_PX)
}

/// Where the root of a body stands on the sheet, from the beginning of its ground line.
fn cell_px(view: usize, cell: usize) -> Vec2 {
    Vec2::new(NAMES_PX + view as f32 * STRIP_PX + (cell as f32 + 0.5) * CELL_PX.x, -VIEWS[view].lift_px)
}

fn draw_head(figure: &mut PlotFigure, left: f32) {
    for (index, view) in VIEWS.iter().enumerate() {
        figure.text(view.name, Vec2::new(left + NAMES_PX + index as f32 * STRIP_PX, 120.0), TextAnchor::Left);
    }
}

/// Name, numbers and ground of one example.
fn draw_words(figure: &mut PlotFigure, db: &MotionDb, example: usize, corner: Vec2) {
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

fn draw_sticks(pixmap: &mut Pixmap, db: &MotionDb, example: usize, corner: Vec2) {
    let scale_px_m = scale_px_m(&db.skeleton);
    for cell in 0..PHASES {
        let sticks = stick_figure::sticks(&db.skeleton, &pose(db, example, cell));
        for (index, view) in VIEWS.iter().enumerate() {
            let at_px = corner + cell_px(index, cell);
            let to_px = |point_m: Vec3| {
                let seen_m = Vec2::new(view.axes[0].dot(point_m), -view.axes[1].dot(point_m));
                at_px + scale_px_m * seen_m
            };
            sticks.iter().for_each(|stick| stick_figure::draw(pixmap, stick, to_px));
        }
    }
}

fn scale_px_m(skeleton: &Skeleton) -> f32 {
    let rest = Pose { pelvis_m: skeleton.offsets_m[Joint::Pelvis.index()], rotations: [Quat::IDENTITY; JOINT_COUNT] };
    let crown_m = skeleton.segment_ends_m[Joint::Head.index()];
    let height_m = rest.forward_kinematics(skeleton).point_m(Joint::Head, crown_m).z;
    SCALE_PX_M * (HEIGHT_MAX_M / height_m).min(1.0)
}

/// The pose of an example in one cell of its strips, in the root frame.
fn pose(db: &MotionDb, example: usize, cell: usize) -> Pose {
    let phase = cell * PHASE_COUNT / PHASES;
    let rotations = *db.rows.rotations(example, phase);
    Pose { pelvis_m: db.rows.pelvis_m[example * PHASE_COUNT + phase], rotations }
}

/// The limbs of an example in one cell.
fn parts(db: &MotionDb, example: usize, cell: usize) -> Vec<DrawnPart> {
    let frame = AgentFrame { pose: pose(db, example, cell), ..AgentFrame::default() };
    let mut parts = Vec::new();
    drawn_body::append_parts(&mut parts, &db.skeleton, &frame, look(example), Detail::Full);
    parts
}

/// Far parts first, as the top view paints low ones first.
fn draw_body(canvas: &mut Canvas, parts: &[DrawnPart], view: &View, scale_px_m: f32, at_px: Vec2) {
    let to_view = Mat3::from_cols(view.axes[0], view.axes[1], view.axes[2]).transpose();
    let to_px = |point: Vec3| {
        let seen = (to_view * point + Vec3::Z * DEPTH_OFFSET_M) * scale_px_m;
        Vec3::new(at_px.x + seen.x, at_px.y - seen.y, seen.z)
    };
    let mut cones: Vec<(TaperedCapsule, Vec3)> = parts
        .iter()
        .map(|part| {
            (
                TaperedCapsule { ends_px: part.ends_m.map(to_px), radii_px: part.radii_m.map(|r| r * scale_px_m) },
                part.colour,
            )
        })
        .collect();
    let depth = |cone: &TaperedCapsule| cone.ends_px[0].z + cone.ends_px[1].z;
    cones.sort_by(|one, other| depth(&one.0).total_cmp(&depth(&other.0)));
    for (cone, colour) in &cones {
        canvas.paint(cone, *colour, RIM_PX);
    }
}

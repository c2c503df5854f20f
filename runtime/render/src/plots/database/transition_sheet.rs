//! The sheet of transitions: each as a strip of bodies from the right side and one from the front, at ten times from its
//! first frame to its last, and a plan of the feet.
//!
//! Both views and the plan are those of the first root frame: a body that turns is seen to turn. The plan shows the sole
//! of each contact at its middle, the path of the root, and its facing at both ends. Metres; positions on the sheet in
//! pixels, y down.

use std::ops::Range;

use fbcrowd_sim::recording::AgentFrame;
use glam::{Quat, Vec2, Vec3};
use motiondb::body::{Pose, Root, Side};
use motiondb::motion::{Action, ActionFrame, ActionKind, MotionDb};
use motiondb::quality::planted_feet::PLANTED_CONTACT;
use tiny_skia::Pixmap;

use crate::plots::chart::axis::number;
use crate::plots::chart::figure::PlotFigure;
use crate::plots::chart::mark::PlotMark;
use crate::plots::database::body_views::{CELL_PX, VIEWS, draw_body, draw_sticks, scale_px_m};
use crate::raster::drawn_body::{self, Detail, DrawnPart};
use crate::raster::paint::{fill_rect, paint, path_through, round_stroke, stroke};
use crate::raster::palette::{GRID_COARSE, INK, SIDES, look};
use crate::raster::tapered_capsule::Canvas;
use crate::raster::text::TextAnchor;

/// Number of times drawn of each transition.
const TIMES: usize = 10;
/// Greatest number of transitions on a sheet.
pub(crate) const SHEET_TRANSITIONS: usize = 12;
/// Width of the column of names, pixels.
const NAMES_PX: f32 = 620.0;
/// Width of a strip, pixels.
const STRIP_PX: f32 = TIMES as f32 * CELL_PX.x;
/// Margins, and gaps between the parts of a row, pixels.
const GAP_PX: f32 = 40.0;
/// Height of a row: bodies from the side and from the front, stick figures from the side, pixels.
const ROW_PX: f32 = 3.0 * CELL_PX.y;
/// Side of the square of a plan, pixels.
const PLAN_PX: f32 = ROW_PX - GAP_PX;
/// Height of the head, pixels.
const HEAD_PX: f32 = 150.0;
/// Left end of the title's baseline, pixels.
const TITLE_PX: Vec2 = Vec2::new(GAP_PX, 66.0);
/// Height of the ground line above a cell's lower edge, pixels.
const GROUND_PX: f32 = 18.0;
/// Greatest scale of a plan, pixels per metre.
const PLAN_PX_M: f32 = 260.0;
/// Margin of a plan about feet and root, m.
const PLAN_MARGIN_M: f32 = 0.1;
/// Width of a drawn sole, m.
const SOLE_M: f32 = 0.07;
/// Length of the mark of the facing, m.
const FACING_M: f32 = 0.15;

/// The transitions of a database that are not mirrored, by index into its actions.
pub(crate) fn recorded_transitions(db: &MotionDb) -> Vec<usize> {
    let is_recorded = |action: &Action| action.kind != ActionKind::Idle && !action.mirrored;
    (0..db.actions.len()).filter(|&index| is_recorded(&db.actions[index])).collect()
}

/// The sheet of some transitions, given by index into the actions of the database.
pub fn transition_sheet(db: &MotionDb, transitions: &[usize]) -> Pixmap {
    let width_px = NAMES_PX + STRIP_PX + PLAN_PX + 3.0 * GAP_PX;
    let height_px = HEAD_PX + transitions.len() as f32 * ROW_PX + GAP_PX;
    let mut figure = PlotFigure::new([width_px as u32, height_px as u32]);
    figure.title("Transitions, from the first frame to the last", TITLE_PX);
    let strips = "from the right side, from the front, as stick figures; green is left, violet is right";
    figure.text(strips, Vec2::new(NAMES_PX, 120.0), TextAnchor::Left);
    let rows: Vec<(&Action, f32)> = transitions
        .iter()
        .enumerate()
        .map(|(row, &index)| (&db.actions[index], HEAD_PX + row as f32 * ROW_PX))
        .collect();
    for &(action, top_px) in &rows {
        draw_caption(&mut figure, db, action, top_px);
        draw_stick_strip(&mut figure.pixmap, db, action, top_px);
        draw_plan(&mut figure, db, action, top_px);
    }
    draw_bodies(figure.pixmap, db, &rows)
}

/// Name, figures and ground lines of a transition.
fn draw_caption(figure: &mut PlotFigure, db: &MotionDb, action: &Action, top_px: f32) {
    let name = figure.fitted(&action.name, NAMES_PX - 2.0 * GAP_PX);
    figure.text(&name, Vec2::new(GAP_PX, top_px + 60.0), TextAnchor::Left);
    let moved_m = action.displacement_m();
    let example = |index: u32| &db.examples[index as usize].name;
    let lines = [
        format!("{}, {} s", action.kind.name(), number(action.duration_s(), 2)),
        format!("{} m ahead, {} m to the left", number(moved_m.x, 2), number(moved_m.y, 2)),
        format!("turn {}°", number(action.turn_rad().to_degrees(), 0)),
        format!("from {} at {}", example(action.entry.example), number(action.entry.phase, 2)),
        format!("to {} at {}", example(action.exit.example), number(action.exit.phase, 2)),
    ];
    for (index, line) in lines.iter().enumerate() {
        figure.note(line, Vec2::new(GAP_PX, top_px + 90.0 + 26.0 * index as f32), TextAnchor::Left, INK);
    }
    for strip in 0..3 {
        let ground_px = ground_px(top_px, strip).round();
        fill_rect(&mut figure.pixmap, [NAMES_PX, ground_px, STRIP_PX, 1.0], GRID_COARSE, 1.0);
    }
}

/// Height of the ground line of a row's strip.
fn ground_px(top_px: f32, strip: usize) -> f32 {
    top_px + (strip + 1) as f32 * CELL_PX.y - GROUND_PX
}

/// Position of a body's root in a cell of a strip.
fn cell_px(top_px: f32, strip: usize, cell: usize) -> Vec2 {
    Vec2::new(NAMES_PX + (cell as f32 + 0.5) * CELL_PX.x, ground_px(top_px, strip))
}

/// The frame of a transition that a cell shows.
fn frame_in(action: &Action, cell: usize) -> ActionFrame {
    action.at(action.duration_s() * cell as f32 / (TIMES - 1) as f32)
}

/// The pose of a frame about its root, turned as in the first root frame.
fn turned_pose(frame: &ActionFrame) -> Pose {
    let turn = Quat::from_rotation_z(frame.root.facing_rad);
    let mut pose = frame.pose;
    pose.pelvis_m = turn * pose.pelvis_m;
    pose.rotations[0] = turn * pose.rotations[0];
    pose
}

fn draw_stick_strip(pixmap: &mut Pixmap, db: &MotionDb, action: &Action, top_px: f32) {
    for cell in 0..TIMES {
        let pose = turned_pose(&frame_in(action, cell));
        draw_sticks(pixmap, &db.skeleton, &pose, &VIEWS[0], cell_px(top_px, 2, cell));
    }
}

fn draw_bodies(paper: Pixmap, db: &MotionDb, rows: &[(&Action, f32)]) -> Pixmap {
    let (mut canvas, scale_px_m) = (Canvas::new(paper), scale_px_m(&db.skeleton));
    for (index, &(action, top_px)) in rows.iter().enumerate() {
        for cell in 0..TIMES {
            let parts = parts(db, &frame_in(action, cell), index);
            for (strip, view) in VIEWS[..2].iter().enumerate() {
                draw_body(&mut canvas, &parts, view, scale_px_m, cell_px(top_px, strip, cell));
            }
        }
    }
    canvas.pixmap
}

fn parts(db: &MotionDb, frame: &ActionFrame, colours: usize) -> Vec<DrawnPart> {
    let frame = AgentFrame { pose: turned_pose(frame), ..AgentFrame::default() };
    let mut parts = Vec::new();
    drawn_body::append_parts(&mut parts, &db.skeleton, &frame, 1.0, look(colours), Detail::Full);
    parts
}

/// The plan of a transition: forward to the right, left up.
fn draw_plan(figure: &mut PlotFigure, db: &MotionDb, action: &Action, top_px: f32) {
    let roots_m: Vec<Vec2> = action.frames.iter().map(|frame| frame.root.position_m).collect();
    let soles_m: Vec<(usize, [Vec2; 3])> = Side::BOTH
        .map(Side::index)
        .into_iter()
        .flat_map(|side| contacts(action, side).into_iter().map(move |contact| (side, contact)))
        .map(|(side, contact)| (side, sole_m(db, &action.frames[(contact.start + contact.end) / 2], side)))
        .collect();
    let shown_m = || roots_m.iter().chain(soles_m.iter().flat_map(|(_, sole_m)| sole_m)).copied();
    let [least_m, most_m] =
        [Vec2::min as fn(Vec2, Vec2) -> Vec2, Vec2::max].map(|side| shown_m().fold(Vec2::ZERO, side));
    let size_m = (most_m - least_m).max_element() + 2.0 * PLAN_MARGIN_M;
    let scale_px_m = PLAN_PX_M.min(PLAN_PX / size_m);
    let middle_px = Vec2::new(NAMES_PX + STRIP_PX + GAP_PX + 0.5 * PLAN_PX, top_px + 0.5 * ROW_PX);
    let middle_m = 0.5 * (least_m + most_m);
    let to_px = |point_m: Vec2| middle_px + scale_px_m * (point_m - middle_m) * Vec2::new(1.0, -1.0);
    let mut draw_line = |points_m: &[Vec2], colour, width_px, opacity| {
        if let Some(path) = path_through(points_m.iter().map(|&point_m| to_px(point_m)), false) {
            stroke(&mut figure.pixmap, &path, &paint(colour, opacity), &round_stroke(width_px), None);
        }
    };
    for (side, sole_m) in &soles_m {
        draw_line(sole_m, SIDES[*side], SOLE_M * scale_px_m, 0.45);
    }
    draw_line(&roots_m, INK, 2.0, 1.0);
    for Root { position_m, facing_rad } in [action.frames[0].root, action.frames[action.frames.len() - 1].root] {
        draw_line(&[position_m, position_m + FACING_M * Vec2::from_angle(facing_rad)], INK, 3.0, 1.0);
    }
    PlotMark::Disc.draw(&mut figure.pixmap, to_px(roots_m[0]), 5.0, INK);
    PlotMark::Diamond.draw(&mut figure.pixmap, to_px(roots_m[roots_m.len() - 1]), 7.0, INK);
}

/// The contacts of a foot, as frames of the action.
fn contacts(action: &Action, side: usize) -> Vec<Range<usize>> {
    let mut contacts: Vec<Range<usize>> = Vec::new();
    for (index, frame) in action.frames.iter().enumerate() {
        if f64::from(frame.contacts[side]) < PLANTED_CONTACT {
            continue;
        }
        match contacts.last_mut() {
            Some(last) if last.end == index => last.end += 1,
            _ => contacts.push(index..index + 1),
        }
    }
    contacts
}

/// Heel, ball and toe tip on the ground, in the first root frame, m.
fn sole_m(db: &MotionDb, frame: &ActionFrame, side: usize) -> [Vec2; 3] {
    let points_m = frame.pose.forward_kinematics(&db.skeleton).sole_points_m(&db.skeleton, side);
    points_m.map(|point_m: Vec3| frame.root.to_world(point_m).truncate())
}

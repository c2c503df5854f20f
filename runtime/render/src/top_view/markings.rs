//! What belongs to a scene besides walls and agents: ground that is not walkable, markings, goal areas, labels.
//!
//! All of it is part of the background; [`signals`](crate::top_view::signals) draws what changes with time. Positions in
//! the world, metres; pictures in pixels.

use fbcrowd_sim::scenario::{Marking, MarkingColour, MarkingShape, Scenario};
use glam::Vec2;
use tiny_skia::{FillRule, Path, PathBuilder, Pixmap, Rect, Stroke, StrokeDash, Transform};

use crate::raster::paint::{circle, fill, paint, path_through, stroke};
use crate::raster::palette;
use crate::raster::text::{TextAnchor, Typeface};
use crate::top_view::framing::Framing;

/// Height of the letters of labels, m, and its limits in pixels.
const LABEL_M: f32 = 0.55;
/// Least and greatest height of the letters of labels, pixels.
const LABEL_PX: [f32; 2] = [9.0, 16.0];
/// Width of the outline of a goal area, and length of its dashes, m.
const GOAL_OUTLINE_M: [f32; 2] = [0.03, 0.16];
/// Opacity of the outline of a goal area.
const GOAL_OPACITY: f32 = 0.4;
/// Radius of a goal that is a point, m.
const GOAL_POINT_M: f32 = 0.08;

/// Width of the sides of a one-way zone, m.
const ONE_WAY_SIDE_M: f32 = 0.04;
/// Opacity of the marks of one-way zones.
const ONE_WAY_OPACITY: f32 = 0.35;

/// Fills the ground outside the walkable polygons.
pub(crate) fn draw_outside(pixmap: &mut Pixmap, scenario: &Scenario, framing: &Framing) {
    let lines_m = scenario.ground_lines_m();
    if lines_m.is_empty() {
        return;
    }
    let mut path = PathBuilder::new();
    if let Some(picture) = Rect::from_xywh(0.0, 0.0, framing.width_px as f32, framing.height_px as f32) {
        path.push_rect(picture);
    }
    for line in lines_m.iter().filter_map(|line_m| outline(framing, line_m)) {
        path.push_path(&line);
    }
    if let Some(path) = path.finish() {
        let colour = paint(palette::OUTSIDE, 1.0);
        pixmap.fill_path(&path, &colour, FillRule::EvenOdd, Transform::identity(), None);
    }
}

/// Draws the markings that do not change.
pub(crate) fn draw_markings(pixmap: &mut Pixmap, scenario: &Scenario, framing: &Framing) {
    for Marking { shape, colour } in &scenario.markings {
        let MarkingColour::Fixed(rgb) = *colour else { continue };
        for path in shape.polygons_m().iter().filter_map(|corners_m| outline(framing, corners_m)) {
            fill(pixmap, &path, &paint(palette::from_bytes(rgb), 1.0), None);
        }
    }
}

/// Draws the directions of one-way zones, and their sides.
pub(crate) fn draw_one_way_zones(pixmap: &mut Pixmap, scenario: &Scenario, framing: &Framing) {
    let pen = Stroke { width: (ONE_WAY_SIDE_M * framing.scale_px_m).clamp(0.8, 3.0), ..Stroke::default() };
    for zone in scenario.one_way_zones() {
        for path in zone.chevrons_m().iter().filter_map(|corners_m| outline(framing, corners_m)) {
            fill(pixmap, &path, &paint(palette::OBSTACLE_RIM, ONE_WAY_OPACITY), None);
        }
        for side_m in zone.sides_m() {
            if let Some(line) = path_through(side_m.map(|end_m| framing.to_px(end_m)), false) {
                stroke(pixmap, &line, &paint(palette::OBSTACLE_RIM, ONE_WAY_OPACITY), &pen, None);
            }
        }
    }
}

/// Draws the outlines of goal areas.
pub(crate) fn draw_goal_areas(pixmap: &mut Pixmap, scenario: &Scenario, framing: &Framing) {
    let [width, dash] = GOAL_OUTLINE_M.map(|length_m| length_m * framing.scale_px_m);
    let dash = StrokeDash::new(vec![dash.max(2.0); 2], 0.0);
    let pen = Stroke { width: width.clamp(0.8, 3.0), dash, ..Stroke::default() };
    for area in scenario.goal_areas() {
        if area.width_m() < 2.0 * GOAL_POINT_M {
            let radius_px = (GOAL_POINT_M * framing.scale_px_m).max(1.0);
            if let Some(dot) = circle(framing.to_px(area.centre_m()), radius_px) {
                fill(pixmap, &dot, &paint(palette::INK, GOAL_OPACITY), None);
            }
            continue;
        }
        for corners_m in MarkingShape::Area(area.clone()).polygons_m() {
            if let Some(line) = outline(framing, &corners_m) {
                stroke(pixmap, &line, &paint(palette::INK, GOAL_OPACITY), &pen, None);
            }
        }
    }
}

/// Writes the labels of places.
pub(crate) fn draw_labels(pixmap: &mut Pixmap, scenario: &Scenario, framing: &Framing) {
    if scenario.labels.is_empty() {
        return;
    }
    let face = Typeface::new((LABEL_M * framing.scale_px_m).clamp(LABEL_PX[0], LABEL_PX[1]));
    for label in &scenario.labels {
        let base_px = framing.to_px(label.at_m) + Vec2::new(0.0, 0.35 * face.size_px);
        face.draw(pixmap, &label.text, base_px, TextAnchor::Centre, palette::INK);
    }
}

fn outline(framing: &Framing, corners_m: &[Vec2]) -> Option<Path> {
    path_through(corners_m.iter().map(|corner_m| framing.to_px(*corner_m)), true)
}

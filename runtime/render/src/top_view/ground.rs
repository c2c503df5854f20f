//! All that stands still in a top view, drawn once for a whole sequence: ground, metric grid, goals, obstacles with
//! their shade.

use fbcrowd_sim::recording::Header;
use glam::Vec2;
use tiny_skia::{Color, FillRule, LineJoin, Paint, Path, PathBuilder, Pixmap, Rect, Stroke, Transform};

use crate::raster::palette::{self, Rgb};
use crate::top_view::framing::Framing;
use crate::top_view::shade::ShadeMask;

/// Grid steps to choose from: fine lines, and coarse ones over them, m.
const GRID_STEPS_M: [[f32; 2]; 4] = [[1.0, 5.0], [5.0, 25.0], [10.0, 50.0], [100.0, 500.0]];
/// Fine lines stand no closer than this, pixels.
const MIN_GRID_PX: f32 = 11.0;
/// Height of the sides that obstacles show by their shade: a counter, low enough not to hide who walks behind, m.
const OBSTACLE_HEIGHT_M: f32 = 1.0;
/// Softness of obstacles' shade, m.
const OBSTACLE_BLUR_M: f32 = 0.05;
/// Width of an obstacle's rim, m.
const RIM_M: f32 = 0.035;
/// Radius of the ring on a last goal, and of the dot on a waypoint before it, m.
const GOAL_RADIUS_M: [f32; 2] = [0.17, 0.05];
/// Width of a goal's ring, m.
const GOAL_RING_M: f32 = 0.045;
/// Opacity of goals: they lie on the ground, under everyone. In small pictures of crowds they fade, down to the second
/// number.
const GOAL_OPACITY: [f32; 2] = [0.55, 0.22];
/// From this scale on goals have their full opacity, pixels a metre.
const GOAL_SCALE_PX_M: f32 = 40.0;

/// The still part of every frame.
pub(crate) fn background(header: &Header, framing: &Framing) -> Pixmap {
    let mut pixmap = Pixmap::new(framing.width_px, framing.height_px).expect("the framing's sides are checked");
    pixmap.fill(to_color(palette::GROUND, 1.0));
    draw_grid(&mut pixmap, framing);
    draw_goals(&mut pixmap, header, framing);
    draw_obstacles(&mut pixmap, header, framing);
    pixmap
}

/// Fine lines first, coarse ones over them, each on whole pixels so that all look alike.
fn draw_grid(pixmap: &mut Pixmap, framing: &Framing) {
    let Some(steps_m) = GRID_STEPS_M.into_iter().find(|steps| steps[0] * framing.scale_px_m >= MIN_GRID_PX) else {
        return;
    };
    let line_px = (framing.height_px as f32 / 1080.0).round().max(1.0);
    for (step_m, colour) in steps_m.into_iter().zip([palette::GRID_FINE, palette::GRID_COARSE]) {
        let [low, high] = [framing.to_world(Vec2::ZERO) / step_m, framing.to_world(framing.size_px()) / step_m];
        for line in low.x.ceil() as i64..=high.x.floor() as i64 {
            let x = framing.to_px(Vec2::new(line as f32 * step_m, 0.0)).x.floor();
            fill_rect(pixmap, [x, 0.0, line_px, framing.height_px as f32], colour, 1.0);
        }
        for line in high.y.ceil() as i64..=low.y.floor() as i64 {
            let y = framing.to_px(Vec2::new(0.0, line as f32 * step_m)).y.floor();
            fill_rect(pixmap, [0.0, y, framing.width_px as f32, line_px], colour, 1.0);
        }
    }
}

fn draw_goals(pixmap: &mut Pixmap, header: &Header, framing: &Framing) {
    let opacity = (GOAL_OPACITY[0] * framing.scale_px_m / GOAL_SCALE_PX_M).clamp(GOAL_OPACITY[1], GOAL_OPACITY[0]);
    for (index, agent) in header.scenario.agents.iter().enumerate() {
        let Some((last, waypoints)) = agent.goals_m.split_last() else { continue };
        let paint = paint(palette::look(index).shirt, opacity);
        for waypoint in waypoints {
            if let Some(dot) = circle(framing, *waypoint, GOAL_RADIUS_M[1]) {
                pixmap.fill_path(&dot, &paint, FillRule::Winding, Transform::identity(), None);
            }
        }
        if let Some(ring) = circle(framing, *last, GOAL_RADIUS_M[0]) {
            let width = (GOAL_RING_M * framing.scale_px_m).max(1.0);
            pixmap.stroke_path(&ring, &paint, &Stroke { width, ..Stroke::default() }, Transform::identity(), None);
        }
    }
}

fn draw_obstacles(pixmap: &mut Pixmap, header: &Header, framing: &Framing) {
    let outlines: Vec<Path> =
        header.scenario.obstacles_m.iter().filter_map(|corners| polygon(framing, corners)).collect();
    if outlines.is_empty() {
        return;
    }
    let mut shade = ShadeMask::new(framing);
    for outline in &outlines {
        shade.add_block(framing, outline, OBSTACLE_HEIGHT_M);
    }
    shade.blur(OBSTACLE_BLUR_M * framing.scale_px_m);
    shade.apply(pixmap);
    let width = (RIM_M * framing.scale_px_m).clamp(1.0, 4.0);
    let rim = Stroke { width, line_join: LineJoin::Round, ..Stroke::default() };
    for outline in &outlines {
        let [top, edge] = [palette::OBSTACLE, palette::OBSTACLE_RIM].map(|colour| paint(colour, 1.0));
        pixmap.fill_path(outline, &top, FillRule::Winding, Transform::identity(), None);
        pixmap.stroke_path(outline, &edge, &rim, Transform::identity(), None);
    }
}

/// A flat colour for tiny-skia.
pub(crate) fn paint(colour: Rgb, opacity: f32) -> Paint<'static> {
    let mut paint = Paint { anti_alias: true, ..Paint::default() };
    paint.set_color(to_color(colour, opacity));
    paint
}

/// A colour for tiny-skia.
pub(crate) fn to_color(colour: Rgb, opacity: f32) -> Color {
    let [red, green, blue] = palette::to_bytes(colour);
    let mut color = Color::from_rgba8(red, green, blue, u8::MAX);
    color.apply_opacity(opacity);
    color
}

/// Fills left, top, width, height, pixels; nothing where the rectangle is empty.
pub(crate) fn fill_rect(pixmap: &mut Pixmap, [left, top, width, height]: [f32; 4], colour: Rgb, opacity: f32) {
    if let Some(rect) = Rect::from_xywh(left, top, width, height) {
        pixmap.fill_rect(rect, &paint(colour, opacity), Transform::identity(), None);
    }
}

fn circle(framing: &Framing, centre_m: Vec2, radius_m: f32) -> Option<Path> {
    let centre = framing.to_px(centre_m);
    PathBuilder::from_circle(centre.x, centre.y, (radius_m * framing.scale_px_m).max(1.5))
}

fn polygon(framing: &Framing, corners_m: &[Vec2]) -> Option<Path> {
    let mut path = PathBuilder::new();
    for (index, corner) in corners_m.iter().map(|corner| framing.to_px(*corner)).enumerate() {
        if index == 0 { path.move_to(corner.x, corner.y) } else { path.line_to(corner.x, corner.y) }
    }
    path.close();
    path.finish()
}

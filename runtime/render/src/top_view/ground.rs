//! The static layer of a top view, drawn once for a whole sequence: ground, metric grid, markings, goals, and obstacles
//! with their shade; areas and goals of sources; labels. Enters: the recording's scenario, world metres.

use fbcrowd_sim::recording::Header;
use fbcrowd_sim::scenario::SourceSpec;
use glam::Vec2;
use tiny_skia::{LineJoin, Paint, Path, Pixmap, Stroke, StrokeDash};

use crate::raster::paint::{circle, fill, fill_rect, paint, path_through, stroke, to_color};
use crate::raster::palette;
use crate::raster::pixels::Strip;
use crate::top_view::framing::Framing;
use crate::top_view::markings;
use crate::top_view::shade::ShadeMask;

/// Steps of fine and coarse grid lines to choose from, m.
const GRID_STEPS_M: [[f32; 2]; 4] = [[1.0, 5.0], [5.0, 25.0], [10.0, 50.0], [100.0, 500.0]];
/// Least distance of fine lines, pixels.
const MIN_GRID_PX: f32 = 11.0;
/// Height of obstacles, as their shade shows it, m: low enough not to darken agents behind.
const OBSTACLE_HEIGHT_M: f32 = 1.0;
/// Softness of obstacles' shade, m.
const OBSTACLE_BLUR_M: f32 = 0.05;
/// Width of an obstacle's rim, m.
const RIM_M: f32 = 0.035;
/// Radius of the ring on a last goal, and of the dot on a waypoint before it, m.
const GOAL_RADIUS_M: [f32; 2] = [0.17, 0.05];
/// Least radius of rings and dots, pixels.
const MIN_GOAL_RADIUS_PX: f32 = 1.5;
/// Width of a goal's ring, m.
const GOAL_RING_M: f32 = 0.045;
/// Length of a dash of a source's outline, m.
const DASH_M: f32 = 0.12;
/// Opacity of goals at full scale, and in small pictures of crowds.
const GOAL_OPACITY: [f32; 2] = [0.55, 0.22];
/// Scale from which goals have their full opacity, pixels per metre.
const GOAL_SCALE_PX_M: f32 = 40.0;

/// The static layer of every frame.
pub(crate) fn background(header: &Header, framing: &Framing) -> Pixmap {
    let mut pixmap = Pixmap::new(framing.width_px, framing.height_px).expect("the framing's sides are checked");
    pixmap.fill(to_color(palette::GROUND, 1.0));
    draw_grid(&mut pixmap, framing);
    markings::draw_outside(&mut pixmap, &header.scenario, framing);
    markings::draw_markings(&mut pixmap, &header.scenario, framing);
    markings::draw_one_way_zones(&mut pixmap, &header.scenario, framing);
    markings::draw_goal_areas(&mut pixmap, &header.scenario, framing);
    draw_goals(&mut pixmap, header, framing);
    draw_obstacles(&mut pixmap, header, framing);
    markings::draw_labels(&mut pixmap, &header.scenario, framing);
    pixmap
}

/// Fine lines, then coarse ones over them, each on whole pixels, so that all look the same.
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
        draw_goals_of(pixmap, framing, &agent.goals_m, &paint(palette::look(index).shirt, opacity));
    }
    for source in &header.scenario.sources {
        let paint = paint(palette::INK, opacity);
        draw_area(pixmap, framing, source, &paint);
        draw_goals_of(pixmap, framing, &source.goals_m, &paint);
    }
}

/// Draws a dot on each waypoint and a ring on the last goal.
fn draw_goals_of(pixmap: &mut Pixmap, framing: &Framing, goals_m: &[Vec2], paint: &Paint<'_>) {
    let Some((last, waypoints)) = goals_m.split_last() else { return };
    for waypoint in waypoints {
        if let Some(dot) = goal_circle(framing, *waypoint, GOAL_RADIUS_M[1]) {
            fill(pixmap, &dot, paint, None);
        }
    }
    if let Some(ring) = goal_circle(framing, *last, GOAL_RADIUS_M[0]) {
        stroke(pixmap, &ring, paint, &goal_line(framing), None);
    }
}

/// Draws the outline of the area in which a source places agents.
fn draw_area(pixmap: &mut Pixmap, framing: &Framing, source: &SourceSpec, paint: &Paint<'_>) {
    if let Some(outline) = path_through(source.outline_m().iter().map(|corner_m| framing.to_px(*corner_m)), true) {
        let dash = (DASH_M * framing.scale_px_m).max(2.0);
        stroke(
            pixmap,
            &outline,
            paint,
            &Stroke { dash: StrokeDash::new(vec![dash; 2], 0.0), ..goal_line(framing) },
            None,
        );
    }
}

fn goal_line(framing: &Framing) -> Stroke {
    Stroke { width: (GOAL_RING_M * framing.scale_px_m).max(1.0), ..Stroke::default() }
}

fn goal_circle(framing: &Framing, centre_m: Vec2, radius_m: f32) -> Option<Path> {
    circle(framing.to_px(centre_m), (radius_m * framing.scale_px_m).max(MIN_GOAL_RADIUS_PX))
}

fn draw_obstacles(pixmap: &mut Pixmap, header: &Header, framing: &Framing) {
    let outline = |corners: &Vec<Vec2>| path_through(corners.iter().map(|corner| framing.to_px(*corner)), true);
    let width = (RIM_M * framing.scale_px_m).clamp(1.0, 4.0);
    let rim = Stroke { width, line_join: LineJoin::Round, ..Stroke::default() };
    let scenario = &header.scenario;
    for (lines_m, width) in [(scenario.ground_lines_m(), width), (scenario.enclosures_m.clone(), 2.0 * width)] {
        for line in lines_m.iter().filter_map(outline) {
            stroke(pixmap, &line, &paint(palette::OBSTACLE_RIM, 1.0), &Stroke { width, ..rim.clone() }, None);
        }
    }
    let outlines: Vec<Path> = header.scenario.obstacles_m.iter().filter_map(outline).collect();
    if outlines.is_empty() {
        return;
    }
    let mut shade = ShadeMask::new(Strip::whole(framing.width_px, framing.height_px));
    for outline in &outlines {
        shade.add_block(framing, outline, OBSTACLE_HEIGHT_M);
    }
    shade.blur(OBSTACLE_BLUR_M * framing.scale_px_m);
    shade.apply(pixmap);
    for outline in &outlines {
        let [top, edge] = [palette::OBSTACLE, palette::OBSTACLE_RIM].map(|colour| paint(colour, 1.0));
        fill(pixmap, outline, &top, None);
        stroke(pixmap, outline, &edge, &rim, None);
    }
}

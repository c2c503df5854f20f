//! The space in which motions are blended: every example at its (v_f, ω_t, ω_s) and the simplices between them, seen
//! along each axis.
//!
//! Many examples share a parameter and fall together in two of the three views: points carry numbers, names stand in a
//! key.

use glam::{Vec2, Vec3};
use motiondb::motion_db::MotionDb;
use tiny_skia::Pixmap;

use crate::axis::Axis;
use crate::palette::line_colour;
use crate::plot::{Figure, Line, Mark, Panel, line};
use crate::text::Anchor;

/// Width of the sheet, pixels.
const WIDTH_PX: u32 = 2900;
/// Least height, pixels; a long key takes more.
const MIN_HEIGHT_PX: u32 = 1020;
/// Top and height of every panel, pixels.
const PANEL_TOP_AND_HEIGHT_PX: [f32; 2] = [200.0, 680.0];
/// Left edge of the first panel, width of each, and distance from one to the next, pixels.
const PANEL_LEFT_WIDTH_STEP_PX: [f32; 3] = [120.0, 640.0, 780.0];
/// Left edge and first line of the key, and distance of its lines, pixels.
const KEY_LEFT_TOP_STEP_PX: [f32; 3] = [2440.0, 200.0, 30.0];
/// The two axes of each panel: v_f and ω_t, v_f and ω_s, ω_t and ω_s.
const VIEWS: [[usize; 2]; 3] = [[0, 1], [0, 2], [1, 2]];
const AXIS_NAMES: [&str; 3] = ["forward speed v_f, m/s", "turn rate ω_t, °/s", "side speed ω_s, m/s"];

/// The plot of a database's blend space.
pub fn parameter_space(db: &MotionDb) -> Pixmap {
    let [key_left, key_top, key_step] = KEY_LEFT_TOP_STEP_PX;
    let key_bottom_px = key_top + key_step * (db.examples.len() + 1) as f32;
    let mut figure = Figure::new(WIDTH_PX, MIN_HEIGHT_PX.max(key_bottom_px as u32));
    let space = &db.blend_space;
    let simplices = space.simplices.len() / (space.dimension as usize + 1);
    let title = format!(
        "Blend space: {} examples, {simplices} simplices of dimension {}, {:.1} % of the hull covered",
        db.examples.len(),
        space.dimension,
        100.0 * space.covered_share
    );
    figure.title(&title, Vec2::new(PANEL_LEFT_WIDTH_STEP_PX[0], 80.0));
    for (index, view) in VIEWS.into_iter().enumerate() {
        draw_view(&mut figure, db, index, view);
    }
    for (index, example) in db.examples.iter().enumerate() {
        let at = Vec2::new(key_left, key_top + key_step * index as f32);
        figure.note(&format!("{index}  {}", example.name), at, Anchor::Left, line_colour(index));
    }
    figure.pixmap
}

fn draw_view(figure: &mut Figure, db: &MotionDb, index: usize, view: [usize; 2]) {
    let points: Vec<Vec3> = db.examples.iter().map(|example| in_plot_units(example.parameters.to_vec3())).collect();
    let [left, width, step] = PANEL_LEFT_WIDTH_STEP_PX;
    let [top, height] = PANEL_TOP_AND_HEIGHT_PX;
    let axes = view.map(|axis| Axis::around(AXIS_NAMES[axis], points.iter().map(|point| point[axis])));
    let panel = figure.panel([left + step * index as f32, top, width, height], axes);
    let flat: Vec<Vec2> = points.iter().map(|point| Vec2::new(point[view[0]], point[view[1]])).collect();
    draw_simplices(figure, &panel, db, &flat);
    for (example, point) in flat.iter().enumerate() {
        figure.mark(&panel, *point, Mark::Disc, 6.5, line_colour(example));
    }
    let numbers: Vec<String> = (0..flat.len()).map(|example| example.to_string()).collect();
    let names: Vec<(Vec2, &str)> = flat.iter().copied().zip(numbers.iter().map(String::as_str)).collect();
    figure.names(&panel, &names);
}

/// Turn rates read better in degrees.
fn in_plot_units(parameters: Vec3) -> Vec3 {
    Vec3::new(parameters.x, parameters.y.to_degrees(), parameters.z)
}

/// Every edge of every simplex once.
fn draw_simplices(figure: &mut Figure, panel: &Panel, db: &MotionDb, points: &[Vec2]) {
    let corners = db.blend_space.dimension as usize + 1;
    let mut edges: Vec<[u32; 2]> = db.blend_space.simplices.chunks_exact(corners).flat_map(edges_of).collect();
    edges.sort_unstable();
    edges.dedup();
    for [from, to] in edges {
        let ends = [points.get(from as usize), points.get(to as usize)].into_iter().flatten().copied();
        figure.polyline(panel, ends, Line { opacity: 0.4, ..line(line_colour(0), 1.3) });
    }
}

fn edges_of(simplex: &[u32]) -> Vec<[u32; 2]> {
    let pairs =
        simplex.iter().enumerate().flat_map(|(index, from)| simplex[..index].iter().map(move |to| (*from, *to)));
    pairs.map(|(from, to)| [from.min(to), from.max(to)]).collect()
}

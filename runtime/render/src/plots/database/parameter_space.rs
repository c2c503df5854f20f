//! The space in which motions are blended: every example at its (v_f, ω_t, ω_s) and the simplices between them, seen
//! along each axis.
//!
//! Many examples share a parameter and fall together in two of the three views: points carry numbers, names stand in a
//! key. Mirrored twins are open marks without a number.

use glam::{Vec2, Vec3};
use motiondb::motion::{MotionDb, MotionExample};
use tiny_skia::Pixmap;

use crate::plots::chart::axis::PlotAxis;
use crate::plots::chart::figure::{LineStyle, PlotFigure, PlotPanel};
use crate::plots::chart::mark::PlotMark;
use crate::raster::palette::{INK, Rgb, line_colour};

/// Width of the sheet, pixels.
const WIDTH_PX: u32 = 2900;
/// Top and height of every panel, pixels.
const PANEL_TOP_AND_HEIGHT_PX: [f32; 2] = [220.0, 760.0];
/// Left edge of the first panel, width of each, and distance from one to the next, pixels.
const PANEL_LEFT_WIDTH_STEP_PX: [f32; 3] = [120.0, 820.0, 930.0];
/// First line of the key under the panels, and distance of its lines, pixels.
const KEY_TOP_PX: f32 = 1130.0;
const KEY_LINE_PX: f32 = 42.0;
/// Least width of its columns, and what a mark and the gap to the next column take of it, pixels.
const KEY_COLUMN_PX: f32 = 550.0;
const KEY_MARK_PX: f32 = 70.0;
/// The two axes of each panel: v_f and ω_t, v_f and ω_s, ω_t and ω_s.
const VIEWS: [[usize; 2]; 3] = [[0, 1], [0, 2], [1, 2]];
const AXIS_NAMES: [&str; 3] = ["forward speed v_f, m/s", "turn rate ω_t, °/s", "side speed ω_s, m/s"];

/// The plot of a database's blend space.
pub fn parameter_space(db: &MotionDb) -> Pixmap {
    let key = Key::new(db);
    let mut figure = PlotFigure::new([WIDTH_PX, (KEY_TOP_PX + key.lines as f32 * KEY_LINE_PX) as u32]);
    figure.title(&title(db), Vec2::new(PANEL_LEFT_WIDTH_STEP_PX[0], 80.0));
    let legend =
        [(PlotMark::Disc, INK, "recorded, numbers in the key below"), (PlotMark::Ring, INK, "its mirrored twin")];
    figure.legend(Vec2::new(PANEL_LEFT_WIDTH_STEP_PX[0] + 10.0, 134.0), &legend);
    for (index, view) in VIEWS.into_iter().enumerate() {
        draw_view(&mut figure, db, index, view);
    }
    key.draw(&mut figure, db);
    figure.pixmap
}

/// Numbers and names of the recorded examples, column by column; as many columns as the longest name leaves.
struct Key {
    /// Index of the example, and what is said of it.
    entries: Vec<(usize, String)>,
    lines: usize,
    column_px: f32,
}

impl Key {
    fn new(db: &MotionDb) -> Self {
        let face = PlotFigure::new([1, 1]);
        let room_px = WIDTH_PX as f32 - PANEL_LEFT_WIDTH_STEP_PX[0];
        let entry = |(index, example): (usize, &MotionExample)| {
            (index, face.fitted(&format!("{index}  {}", example.name), room_px - KEY_MARK_PX))
        };
        let entries: Vec<(usize, String)> = recorded(db).map(entry).collect();
        let widest_px = entries.iter().map(|(_, text)| face.width_px(text)).fold(0.0, f32::max);
        let column_px = (widest_px + KEY_MARK_PX).max(KEY_COLUMN_PX).min(room_px);
        let columns = (room_px / column_px) as usize;
        Self { lines: entries.len().div_ceil(columns.max(1)), entries, column_px }
    }

    fn draw(&self, figure: &mut PlotFigure, db: &MotionDb) {
        for (place, (index, text)) in self.entries.iter().enumerate() {
            let [column, line] = [place / self.lines, place % self.lines].map(|step| step as f32);
            let at = Vec2::new(PANEL_LEFT_WIDTH_STEP_PX[0] + column * self.column_px, KEY_TOP_PX + line * KEY_LINE_PX);
            figure.legend(at, &[(PlotMark::Disc, example_colour(db, &db.examples[*index]), text)]);
        }
    }
}

fn title(db: &MotionDb) -> String {
    if db.examples.len() == 1 {
        return "Blend space: a single example, nothing to blend".to_owned();
    }
    let space = &db.blend_space;
    let (dimension, covered) = (space.dimension, 100.0 * space.covered_share);
    // A single point is a simplex to the runtime, to people it is none.
    let simplices = space.simplices().filter(|corners| corners.len() > 1).count();
    let counts = format!("{} examples, {simplices} simplices of dimension {dimension}", db.examples.len());
    format!("Blend space: {counts}, {covered:.1} % of the hull covered")
}

/// The examples that are no mirrored twins, with their indices.
fn recorded(db: &MotionDb) -> impl Iterator<Item = (usize, &MotionExample)> {
    db.examples.iter().enumerate().filter(|(_, example)| !example.mirrored)
}

/// The colour of an example, which its mirrored twin shares.
fn example_colour(db: &MotionDb, example: &MotionExample) -> Rgb {
    let first = db.examples.iter().position(|other| other.source == example.source);
    line_colour(first.unwrap_or_default())
}

fn draw_view(figure: &mut PlotFigure, db: &MotionDb, index: usize, view: [usize; 2]) {
    let points: Vec<Vec3> = db.examples.iter().map(|example| in_plot_units(example.parameters.to_vec3())).collect();
    let [left, width, step] = PANEL_LEFT_WIDTH_STEP_PX;
    let [top, height] = PANEL_TOP_AND_HEIGHT_PX;
    let axes = view.map(|axis| PlotAxis::around(AXIS_NAMES[axis], points.iter().map(|point| point[axis])));
    let panel = figure.panel([left + step * index as f32, top, width, height], axes);
    let flat: Vec<Vec2> = points.iter().map(|point| Vec2::new(point[view[0]], point[view[1]])).collect();
    draw_simplices(figure, &panel, db, &flat);
    for (example, point) in db.examples.iter().zip(&flat) {
        let mark = if example.mirrored { PlotMark::Ring } else { PlotMark::Disc };
        figure.mark(&panel, *point, mark, 6.5, example_colour(db, example));
    }
    let number = |(index, example): (usize, &MotionExample)| {
        if example.mirrored { String::new() } else { index.to_string() }
    };
    let numbers: Vec<String> = db.examples.iter().enumerate().map(number).collect();
    let names: Vec<(Vec2, &str)> = flat.iter().copied().zip(numbers.iter().map(String::as_str)).collect();
    figure.names(&panel, &names);
}

/// Turn rates read better in degrees.
fn in_plot_units(parameters: Vec3) -> Vec3 {
    Vec3::new(parameters.x, parameters.y.to_degrees(), parameters.z)
}

/// Every edge of every simplex once.
fn draw_simplices(figure: &mut PlotFigure, panel: &PlotPanel, db: &MotionDb, points: &[Vec2]) {
    let corners = db.blend_space.dimension as usize + 1;
    let mut edges: Vec<[u32; 2]> = db.blend_space.simplices.chunks_exact(corners).flat_map(edges_of).collect();
    edges.sort_unstable();
    edges.dedup();
    for [from, to] in edges {
        let ends = [points.get(from as usize), points.get(to as usize)].into_iter().flatten().copied();
        figure.polyline(panel, ends, LineStyle { opacity: 0.22, ..LineStyle::solid(INK, 1.3) });
    }
}

fn edges_of(simplex: &[u32]) -> Vec<[u32; 2]> {
    let pairs =
        simplex.iter().enumerate().flat_map(|(index, from)| simplex[..index].iter().map(move |to| (*from, *to)));
    pairs.map(|(from, to)| [from.min(to), from.max(to)]).collect()
}

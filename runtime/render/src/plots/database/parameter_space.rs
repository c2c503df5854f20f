//! The blend space: every example at its (v_f, ω_t, ω_s), and the simplices between them, seen along each axis.
//!
//! Many examples have a parameter in common and coincide in two of the three panels. So points have numbers, and a list
//! below gives their names. Mirrored examples are open marks without a number.

use glam::Vec2;
use motiondb::motion::{MotionDb, MotionExample};
use tiny_skia::Pixmap;

use crate::plots::chart::figure::{LineStyle, PlotFigure, PlotPanel};
use crate::plots::chart::mark::PlotMark;
use crate::plots::database::parameter_planes::{
    LEFT_PX, LEGEND_PX, PLANES, TITLE_PX, WIDTH_PX, example_points, in_plane, plane_panel,
};
use crate::raster::palette::{INK, Rgb, line_colour};

/// Top and height of every panel, pixels.
const PANEL_TOP_AND_HEIGHT_PX: [f32; 2] = [220.0, 760.0];
/// Baseline of the first line of the list of names, pixels.
const LIST_TOP_PX: f32 = 1130.0;
/// Distance of the list's lines, pixels.
const LIST_LINE_PX: f32 = 42.0;
/// Least width of the list's columns, pixels.
const LIST_COLUMN_PX: f32 = 550.0;
/// Width of a mark in the list and of the gap to the next column, pixels.
const LIST_MARK_PX: f32 = 70.0;
/// Radius of a point, pixels.
const POINT_PX: f32 = 6.5;

/// The figure of a database's blend space.
pub fn parameter_space(db: &MotionDb) -> Pixmap {
    let list = NameList::new(db);
    let mut figure = PlotFigure::new([WIDTH_PX, (LIST_TOP_PX + list.lines as f32 * LIST_LINE_PX) as u32]);
    figure.title(&title(db), TITLE_PX);
    let legend = [(PlotMark::Disc, INK, "recorded, names below"), (PlotMark::Ring, INK, "mirrored")];
    figure.legend(LEGEND_PX, &legend);
    for plane in 0..PLANES.len() {
        draw_plane(&mut figure, db, plane);
    }
    list.draw(&mut figure, db);
    figure.pixmap
}

/// Numbers and names of the recorded examples, column by column; as many columns as the longest name allows.
struct NameList {
    /// Index of each example, and its text.
    entries: Vec<(usize, String)>,
    /// Number of lines.
    lines: usize,
    /// Width of a column, pixels.
    column_px: f32,
}

impl NameList {
    fn new(db: &MotionDb) -> Self {
        let face = PlotFigure::new([1, 1]);
        let room_px = WIDTH_PX as f32 - LEFT_PX;
        let entry = |(index, example): (usize, &MotionExample)| {
            (index, face.fitted(&format!("{index}  {}", example.name), room_px - LIST_MARK_PX))
        };
        let recorded = db.examples.iter().enumerate().filter(|(_, example)| !example.mirrored);
        let entries: Vec<(usize, String)> = recorded.map(entry).collect();
        let widest_px = entries.iter().map(|(_, text)| face.width_px(text)).fold(0.0, f32::max);
        let column_px = (widest_px + LIST_MARK_PX).max(LIST_COLUMN_PX).min(room_px);
        let columns = (room_px / column_px) as usize;
        Self { lines: entries.len().div_ceil(columns.max(1)), entries, column_px }
    }

    fn draw(&self, figure: &mut PlotFigure, db: &MotionDb) {
        for (slot, (index, text)) in self.entries.iter().enumerate() {
            let [column, line] = [slot / self.lines, slot % self.lines].map(|step| step as f32);
            let at_px = Vec2::new(LEFT_PX + column * self.column_px, LIST_TOP_PX + line * LIST_LINE_PX);
            figure.legend(at_px, &[(PlotMark::Disc, example_colour(db, &db.examples[*index]), text)]);
        }
    }
}

fn title(db: &MotionDb) -> String {
    if db.examples.len() == 1 {
        return "Blend space: a single example, nothing to blend".to_owned();
    }
    let space = &db.blend_space;
    let (dimension, covered) = (space.dimension, 100.0 * space.covered_share);
    // The runtime uses simplices of one point; the title does not count them.
    let simplices = space.simplices().filter(|corners| corners.len() > 1).count();
    let counts = format!("{} examples, {simplices} simplices of dimension {dimension}", db.examples.len());
    format!("Blend space: {counts}, {covered:.1} % of the hull covered")
}

/// Colour of an example; the same for all examples of one source.
fn example_colour(db: &MotionDb, example: &MotionExample) -> Rgb {
    let first = db.examples.iter().position(|other| other.source == example.source);
    line_colour(first.unwrap_or_default())
}

fn draw_plane(figure: &mut PlotFigure, db: &MotionDb, plane: usize) {
    let points = example_points(db);
    let panel = plane_panel(figure, &points, plane, PANEL_TOP_AND_HEIGHT_PX);
    let points: Vec<Vec2> = points.iter().map(|point| in_plane(*point, PLANES[plane])).collect();
    draw_simplices(figure, &panel, db, &points);
    for (example, point) in db.examples.iter().zip(&points) {
        let mark = if example.mirrored { PlotMark::Ring } else { PlotMark::Disc };
        figure.mark(&panel, *point, mark, POINT_PX, example_colour(db, example));
    }
    let number = |(index, example): (usize, &MotionExample)| {
        if example.mirrored { String::new() } else { index.to_string() }
    };
    let numbers: Vec<String> = db.examples.iter().enumerate().map(number).collect();
    let names: Vec<(Vec2, &str)> = points.iter().copied().zip(numbers.iter().map(String::as_str)).collect();
    figure.names(&panel, &names);
}

/// Draws every edge of every simplex once.
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

/// Edges of a simplex, each with the lower index first.
fn edges_of(simplex: &[u32]) -> Vec<[u32; 2]> {
    let pairs =
        simplex.iter().enumerate().flat_map(|(index, from)| simplex[..index].iter().map(move |to| (*from, *to)));
    pairs.map(|(from, to)| [from.min(to), from.max(to)]).collect()
}

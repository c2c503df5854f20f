//! A small plotting kit: a figure on paper, panels with metric axes, and lines, polygons, marks and words in them.
//!
//! A [`Figure`] is the sheet, a [`Panel`] a window of it with its own axes; what is drawn in a panel is cut at its
//! frame. Sheets are large (1600 pixels across and more), letters and lines on all of them the same.

use glam::Vec2;
use tiny_skia::{FillRule, LineCap, LineJoin, Mask, Path, PathBuilder, Pixmap, Rect, Stroke, StrokeDash, Transform};

use crate::plots::chart::axis::{Axis, tick_text};
use crate::plots::chart::label_positions::{NamePlace, place_names};
use crate::plots::chart::mark::Mark;
use crate::raster::palette::{GRID_FINE, INK, PAPER, Rgb};
use crate::raster::text::{Anchor, Typeface};
use crate::top_view::ground::{fill_rect, paint, to_color};

/// Letters of titles, of axes and legends, and of notes beside points, pixels.
const LETTERS_PX: [f32; 3] = [36.0, 25.0, 19.0];
/// Width of axes and grid lines, and length of ticks, pixels.
const HAIRLINE_PX: f32 = 1.0;
const TICK_PX: f32 = 8.0;
/// Radius of the marks of a legend, share of its letters' height.
const LEGEND_MARK: f32 = 0.36;
/// Points nearer to each other than this share one note, pixels.
const SAME_POINT_PX: f32 = 5.0;
/// Widest note, share of its panel: of dozens of points that fall together not all are named.
const NOTE_MAX_SHARE: f32 = 0.4;
/// Opacity of the paper under a name: lines behind it stay faintly visible.
const NAME_BACKING: f32 = 0.75;

/// A sheet of paper.
#[derive(Clone, Debug)]
pub struct Figure {
    /// The picture, opaque.
    pub pixmap: Pixmap,
    title_face: Typeface,
    face: Typeface,
    note_face: Typeface,
}

/// A framed window of a figure.
#[derive(Clone, Debug)]
pub struct Panel {
    /// Left, top, width, height on the sheet, pixels.
    pub rect_px: [f32; 4],
    /// Across, then up.
    pub axes: [Axis; 2],
    cut: Option<Mask>,
}

/// How a line is drawn.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Line {
    /// Colour.
    pub colour: Rgb,
    /// Pixels.
    pub width_px: f32,
    /// 0 to 1.
    pub opacity: f32,
    /// Dashes instead of a full line.
    pub dashed: bool,
}

impl Panel {
    /// A place on the sheet, pixels.
    pub fn to_px(&self, point: Vec2) -> Vec2 {
        let [left, top, width, height] = self.rect_px;
        let share = |value: f32, axis: &Axis| (value - axis.low) / (axis.high - axis.low);
        let [x, y] = &self.axes;
        Vec2::new(left + width * share(point.x, x), top + height * (1.0 - share(point.y, y)))
    }
}

impl Figure {
    /// An empty sheet; sides are 1 to 16384 pixels.
    pub fn new(width_px: u32, height_px: u32) -> Self {
        Self::with_letters(width_px, height_px, 1.0)
    }

    /// As [`Self::new`], with letters of another size, as a multiple of the usual one.
    pub fn with_letters(width_px: u32, height_px: u32, size: f32) -> Self {
        let side = |side_px: u32| side_px.clamp(1, crate::top_view::framing::MAX_SIDE_PX);
        let mut pixmap = Pixmap::new(side(width_px), side(height_px)).expect("the sides are clamped to what it takes");
        pixmap.fill(to_color(PAPER, 1.0));
        let [title_face, face, note_face] = LETTERS_PX.map(|letters_px| Typeface::new(size * letters_px));
        Self { pixmap, title_face, face, note_face }
    }

    /// Writes a heading, its baseline's left end at a place on the sheet; it ends before the sheet does.
    pub fn title(&mut self, text: &str, at_px: Vec2) {
        let text = self.title_face.fitted(text, self.pixmap.width() as f32 - at_px.x - self.title_face.size_px);
        self.title_face.draw(&mut self.pixmap, &text, at_px, Anchor::Left, INK);
    }

    /// As much of a line of text as so many pixels hold.
    pub fn fitted(&self, text: &str, width_px: f32) -> String {
        self.face.fitted(text, width_px)
    }

    /// Width of a line of text, pixels.
    pub fn width_px(&self, text: &str) -> f32 {
        self.face.width_px(text)
    }

    /// Writes a line of text at a place on the sheet.
    pub fn text(&mut self, text: &str, at_px: Vec2, anchor: Anchor) {
        self.face.draw(&mut self.pixmap, text, at_px, anchor, INK);
    }

    /// Writes a small note at a place on the sheet.
    pub fn note(&mut self, text: &str, at_px: Vec2, anchor: Anchor, colour: Rgb) {
        self.note_face.draw_with_halo(&mut self.pixmap, text, at_px, anchor, [colour, PAPER]);
    }

    /// Writes the names of points beside them, those of points that fall together in one line; points with an empty
    /// name are only kept free. Names that stand far off are tied to their points by a line.
    pub fn names(&mut self, panel: &Panel, names: &[(Vec2, &str)]) {
        let points: Vec<Vec2> = names.iter().map(|(point, _)| panel.to_px(*point)).collect();
        let mut notes = joined_names(names.iter().map(|(_, name)| *name).zip(&points));
        for (_, text) in &mut notes {
            *text = self.note_face.fitted(text, NOTE_MAX_SHARE * panel.rect_px[2]);
        }
        let size = |text: &str| Vec2::new(self.note_face.width_px(text), self.note_face.size_px);
        let sizes: Vec<(Vec2, Vec2)> = notes.iter().map(|(point, text)| (*point, size(text))).collect();
        let places = place_names(&sizes, &points, &NamePlace::within(panel.rect_px));
        for ((point, _), place) in notes.iter().zip(&places).filter(|(_, place)| place.is_far) {
            self.leader([*point, place.nearest_px(*point)]);
        }
        for ((_, text), place) in notes.iter().zip(&places) {
            let (low, size) = (place.low_px, place.high_px - place.low_px);
            fill_rect(&mut self.pixmap, [low.x, low.y, size.x, size.y], PAPER, NAME_BACKING);
            self.note(text, Vec2::new(low.x, place.high_px.y - 0.2 * size.y), Anchor::Left, INK);
        }
    }

    /// The fine line from a point to its name.
    fn leader(&mut self, [from, to]: [Vec2; 2]) {
        let mut path = PathBuilder::new();
        path.move_to(from.x, from.y);
        path.line_to(to.x, to.y);
        if let Some(path) = path.finish() {
            let stroke = Stroke { width: HAIRLINE_PX, ..Stroke::default() };
            self.pixmap.stroke_path(&path, &paint(INK, 0.6), &stroke, Transform::identity(), None);
        }
    }

    /// Draws the grid, the frame, ticks and labels of a panel.
    pub fn panel(&mut self, rect_px: [f32; 4], axes: [Axis; 2]) -> Panel {
        let cut = self.cut(rect_px);
        let panel = Panel { rect_px: rect_px.map(f32::round), axes, cut };
        self.draw_ticks_across(&panel);
        self.draw_ticks_up(&panel);
        self.draw_frame(&panel);
        panel
    }

    /// As [`Self::panel`], with names across instead of numbers: name i is centred on i.
    pub fn panel_of_groups(&mut self, rect_px: [f32; 4], names: &[&str], value: Axis) -> Panel {
        let across = Axis { label: String::new(), low: -0.5, high: names.len() as f32 - 0.5 };
        let panel = Panel { rect_px: rect_px.map(f32::round), axes: [across, value], cut: self.cut(rect_px) };
        self.draw_ticks_up(&panel);
        self.draw_frame(&panel);
        let base = rect_px[1] + rect_px[3] + 1.35 * self.face.size_px;
        for (index, name) in names.iter().enumerate() {
            let x = panel.to_px(Vec2::new(index as f32, 0.0)).x;
            self.text(name, Vec2::new(x, base), Anchor::Centre);
        }
        panel
    }

    fn cut(&self, [left, top, width, height]: [f32; 4]) -> Option<Mask> {
        let mut mask = Mask::new(self.pixmap.width(), self.pixmap.height())?;
        let frame = PathBuilder::from_rect(Rect::from_xywh(left, top, width, height)?);
        mask.fill_path(&frame, FillRule::Winding, false, Transform::identity());
        Some(mask)
    }

    fn draw_ticks_across(&mut self, panel: &Panel) {
        let [left, top, width, height] = panel.rect_px;
        let step = panel.axes[0].tick_step(width);
        let base = top + height + 1.35 * self.face.size_px;
        for value in panel.axes[0].ticks(step) {
            let x = panel.to_px(Vec2::new(value, 0.0)).x.round();
            fill_rect(&mut self.pixmap, [x, top, HAIRLINE_PX, height], GRID_FINE, 1.0);
            fill_rect(&mut self.pixmap, [x, top + height, HAIRLINE_PX, TICK_PX], INK, 1.0);
            self.text(&tick_text(value, step), Vec2::new(x, base), Anchor::Centre);
        }
        let below = Vec2::new(left + 0.5 * width, base + 1.3 * self.face.size_px);
        self.text(&panel.axes[0].label, below, Anchor::Centre);
    }

    fn draw_ticks_up(&mut self, panel: &Panel) {
        let [left, top, width, height] = panel.rect_px;
        let step = panel.axes[1].tick_step(height);
        for value in panel.axes[1].ticks(step) {
            let y = panel.to_px(Vec2::new(0.0, value)).y.round();
            fill_rect(&mut self.pixmap, [left, y, width, HAIRLINE_PX], GRID_FINE, 1.0);
            fill_rect(&mut self.pixmap, [left - TICK_PX, y, TICK_PX, HAIRLINE_PX], INK, 1.0);
            let beside = Vec2::new(left - 1.75 * TICK_PX, y + 0.35 * self.face.size_px);
            self.text(&tick_text(value, step), beside, Anchor::Right);
        }
        // Written level above the axis: no reader has to tilt the head.
        let above = Vec2::new(left, top - 0.55 * self.face.size_px);
        self.text(&panel.axes[1].label, above, Anchor::Left);
    }

    fn draw_frame(&mut self, panel: &Panel) {
        let [left, top, width, height] = panel.rect_px;
        for edge in [[left, top + height, width + HAIRLINE_PX, HAIRLINE_PX], [left, top, HAIRLINE_PX, height]] {
            fill_rect(&mut self.pixmap, edge, INK, 1.0);
        }
    }

    /// A line through points.
    pub fn polyline(&mut self, panel: &Panel, points: impl IntoIterator<Item = Vec2>, line: Line) {
        if let Some(path) = path(panel, points, false) {
            self.stroke(panel, &path, line);
        }
    }

    /// Many lines of two ends each, as one.
    pub fn hatching(&mut self, panel: &Panel, strokes: impl IntoIterator<Item = [Vec2; 2]>, line: Line) {
        let mut path = PathBuilder::new();
        for [from, to] in strokes.into_iter().map(|ends| ends.map(|end| panel.to_px(end))) {
            path.move_to(from.x, from.y);
            path.line_to(to.x, to.y);
        }
        if let Some(path) = path.finish() {
            self.stroke(panel, &path, line);
        }
    }

    /// A filled polygon with an outline in the same colour.
    pub fn polygon(&mut self, panel: &Panel, corners: impl IntoIterator<Item = Vec2>, fill_opacity: f32, line: Line) {
        if let Some(path) = path(panel, corners, true) {
            let fill = paint(line.colour, fill_opacity);
            self.pixmap.fill_path(&path, &fill, FillRule::Winding, Transform::identity(), panel.cut.as_ref());
            self.stroke(panel, &path, line);
        }
    }

    /// A mark of a radius in pixels.
    pub fn mark(&mut self, panel: &Panel, at: Vec2, mark: Mark, radius_px: f32, colour: Rgb) {
        let centre = panel.to_px(at);
        if centre.is_finite() {
            mark.draw(&mut self.pixmap, centre, radius_px, colour);
        }
    }

    /// A legend: a mark and a word each, from a place on the sheet to the right.
    pub fn legend(&mut self, at_px: Vec2, entries: &[(Mark, Rgb, &str)]) {
        let mut pen_px = at_px;
        for (mark, colour, text) in entries {
            let size = self.face.size_px;
            mark.draw(&mut self.pixmap, pen_px - Vec2::new(0.0, 0.32 * size), LEGEND_MARK * size, *colour);
            pen_px.x += 0.8 * size;
            self.text(text, pen_px, Anchor::Left);
            pen_px.x += self.face.width_px(text) + 1.6 * size;
        }
    }

    fn stroke(&mut self, panel: &Panel, path: &Path, line: Line) {
        let width = line.width_px.max(1.0);
        let dash = line.dashed.then(|| StrokeDash::new(vec![4.0 * width, 3.0 * width], 0.0)).flatten();
        let stroke = Stroke { width, dash, line_cap: LineCap::Round, line_join: LineJoin::Round, ..Stroke::default() };
        let paint = paint(line.colour, line.opacity);
        self.pixmap.stroke_path(path, &paint, &stroke, Transform::identity(), panel.cut.as_ref());
    }
}

/// A full line.
pub(crate) fn line(colour: Rgb, width_px: f32) -> Line {
    Line { colour, width_px, opacity: 1.0, dashed: false }
}

/// Names with their points; names of points that fall together joined by commas at the first of them.
fn joined_names<'a>(names: impl Iterator<Item = (&'a str, &'a Vec2)>) -> Vec<(Vec2, String)> {
    let mut joined: Vec<(Vec2, String)> = Vec::new();
    for (name, point) in names.filter(|(name, point)| !name.is_empty() && point.is_finite()) {
        match joined.iter_mut().find(|(other, _)| other.distance(*point) < SAME_POINT_PX) {
            Some((_, text)) => *text = format!("{text}, {name}"),
            None => joined.push((*point, name.to_owned())),
        }
    }
    joined
}

/// Points that are not finite are left out.
fn path(panel: &Panel, points: impl IntoIterator<Item = Vec2>, closed: bool) -> Option<Path> {
    let mut path = PathBuilder::new();
    for point in points.into_iter().map(|point| panel.to_px(point)).filter(|point| point.is_finite()) {
        if path.is_empty() { path.move_to(point.x, point.y) } else { path.line_to(point.x, point.y) }
    }
    if closed {
        path.close();
    }
    path.finish()
}

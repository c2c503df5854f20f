//! A small plotting kit: a figure on paper, panels with axes, and lines, polygons, marks and texts in them.
//!
//! A [`PlotFigure`] is the whole picture, a [`PlotPanel`] a rectangle of it with its own axes. Shapes in a panel are
//! clipped at its frame. Positions on the figure are in pixels, y down; in a panel they are in the units of its axes.
//! Letters and lines have the same size on all figures.

use glam::Vec2;
use tiny_skia::{FillRule, Mask, Path, PathBuilder, Pixmap, Rect, Stroke, Transform};

use crate::plots::chart::axis::{PlotAxis, tick_text};
use crate::plots::chart::label_positions::{LabelBox, label_boxes};
use crate::plots::chart::mark::PlotMark;
use crate::raster::paint::{
    dashes, fill, fill_rect, paint, path_of_lines, path_through, round_stroke, stroke, to_color,
};
use crate::raster::palette::{GRID_FINE, INK, PAPER, Rgb, heat};
use crate::raster::pixels::MAX_SIDE_PX;
use crate::raster::text::{TextAnchor, Typeface};

/// Height of letters: titles, axes and legends, notes beside points, pixels.
const LETTERS_PX: [f32; 3] = [36.0, 25.0, 19.0];
/// Width of axes and grid lines, pixels.
const HAIRLINE_PX: f32 = 1.0;
/// Length of ticks, pixels.
const TICK_PX: f32 = 8.0;
/// Radius of the marks of a legend, share of the height of its letters.
const LEGEND_MARK: f32 = 0.36;
/// Distance up to which points share one note, pixels.
const SAME_POINT_PX: f32 = 5.0;
/// Greatest width of a note, share of its panel: of dozens of points at one position, not all are named.
const NOTE_MAX_SHARE: f32 = 0.4;
/// Opacity of the paper under a name: lines behind it are faintly visible.
const NAME_BACKING: f32 = 0.75;

/// An entry of a legend: mark, colour and text.
pub(crate) type LegendEntry<'a> = (PlotMark, Rgb, &'a str);

/// A figure on paper.
#[derive(Clone, Debug)]
pub(crate) struct PlotFigure {
    /// The picture, opaque.
    pub(crate) pixmap: Pixmap,
    title_face: Typeface,
    face: Typeface,
    note_face: Typeface,
}

/// A framed rectangle of a figure, with its axes.
#[derive(Clone, Debug)]
pub(crate) struct PlotPanel {
    /// Left, top, width, height on the figure, pixels.
    pub(crate) rect_px: [f32; 4],
    /// Horizontal and vertical axis.
    pub(crate) axes: [PlotAxis; 2],
    /// Mask of the rectangle.
    clip: Option<Mask>,
}

/// Style of a line.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct LineStyle {
    /// Colour of the line.
    pub(crate) colour: Rgb,
    /// Width of the line, pixels.
    pub(crate) width_px: f32,
    /// Opacity of the line, 0 to 1.
    pub(crate) opacity: f32,
    /// Whether the line is dashed.
    pub(crate) is_dashed: bool,
}

impl LineStyle {
    /// A solid, opaque line.
    pub(crate) fn solid(colour: Rgb, width_px: f32) -> Self {
        Self { colour, width_px, opacity: 1.0, is_dashed: false }
    }
}

impl PlotPanel {
    /// Position of a point on the figure, pixels.
    pub(crate) fn to_px(&self, point: Vec2) -> Vec2 {
        let [left, top, width, height] = self.rect_px;
        let share = |value: f32, axis: &PlotAxis| (value - axis.low) / (axis.high - axis.low);
        let [x, y] = &self.axes;
        Vec2::new(left + width * share(point.x, x), top + height * (1.0 - share(point.y, y)))
    }

    /// Path through points, in pixels.
    fn path(&self, points: impl IntoIterator<Item = Vec2>, is_closed: bool) -> Option<Path> {
        path_through(points.into_iter().map(|point| self.to_px(point)), is_closed)
    }
}

impl PlotFigure {
    /// An empty figure of a width and height, each clamped to 1 to 16384 pixels.
    pub(crate) fn new(size_px: [u32; 2]) -> Self {
        Self::with_letters(size_px, 1.0)
    }

    /// As [`Self::new`], with letters of another size, as a multiple of the usual one.
    pub(crate) fn with_letters(size_px: [u32; 2], letters: f32) -> Self {
        let [width_px, height_px] = size_px.map(|side_px| side_px.clamp(1, MAX_SIDE_PX));
        let mut pixmap = Pixmap::new(width_px, height_px).expect("the sides are clamped to valid ones");
        pixmap.fill(to_color(PAPER, 1.0));
        let [title_face, face, note_face] = LETTERS_PX.map(|letters_px| Typeface::new(letters * letters_px));
        Self { pixmap, title_face, face, note_face }
    }

    /// Writes the title, with its baseline's left end at a position; it is fitted into the figure.
    pub(crate) fn title(&mut self, text: &str, at_px: Vec2) {
        let text = self.title_face.fitted(text, self.pixmap.width() as f32 - at_px.x - self.title_face.size_px);
        self.title_face.draw(&mut self.pixmap, &text, at_px, TextAnchor::Left, INK);
    }

    /// The text, fitted into a width in pixels.
    pub(crate) fn fitted(&self, text: &str, width_px: f32) -> String {
        self.face.fitted(text, width_px)
    }

    /// Width of a line of text, pixels.
    pub(crate) fn width_px(&self, text: &str) -> f32 {
        self.face.width_px(text)
    }

    /// Writes a line of text.
    pub(crate) fn text(&mut self, text: &str, at_px: Vec2, anchor: TextAnchor) {
        self.face.draw(&mut self.pixmap, text, at_px, anchor, INK);
    }

    /// Writes a small note.
    pub(crate) fn note(&mut self, text: &str, at_px: Vec2, anchor: TextAnchor, colour: Rgb) {
        self.note_face.draw_with_halo(&mut self.pixmap, 0, text, at_px, anchor, [colour, PAPER]);
    }

    /// Writes the names of points beside them; names of points at one position share a line. Points with an empty name
    /// are only kept free. A line connects a far name with its point.
    pub(crate) fn names(&mut self, panel: &PlotPanel, names: &[(Vec2, &str)]) {
        let points: Vec<Vec2> = names.iter().map(|(point, _)| panel.to_px(*point)).collect();
        let mut notes = joined_names(names.iter().map(|(_, name)| *name).zip(&points));
        for (_, text) in &mut notes {
            *text = self.note_face.fitted(text, NOTE_MAX_SHARE * panel.rect_px[2]);
        }
        let size = |text: &str| Vec2::new(self.note_face.width_px(text), self.note_face.size_px);
        let sizes: Vec<(Vec2, Vec2)> = notes.iter().map(|(point, text)| (*point, size(text))).collect();
        let boxes = label_boxes(&sizes, &points, &LabelBox::within(panel.rect_px));
        for ((point, _), label) in notes.iter().zip(&boxes).filter(|(_, label)| label.is_far) {
            self.draw_leader([*point, label.nearest_px(*point)]);
        }
        for ((_, text), label) in notes.iter().zip(&boxes) {
            let (low, size) = (label.low_px, label.high_px - label.low_px);
            fill_rect(&mut self.pixmap, [low.x, low.y, size.x, size.y], PAPER, NAME_BACKING);
            self.note(text, Vec2::new(low.x, label.high_px.y - 0.2 * size.y), TextAnchor::Left, INK);
        }
    }

    /// Draws the fine line from a point to its name.
    fn draw_leader(&mut self, ends: [Vec2; 2]) {
        if let Some(path) = path_of_lines([ends]) {
            let pen = Stroke { width: HAIRLINE_PX, ..Stroke::default() };
            stroke(&mut self.pixmap, &path, &paint(INK, 0.6), &pen, None);
        }
    }

    /// Draws grid, frame, ticks and labels of a panel.
    pub(crate) fn panel(&mut self, rect_px: [f32; 4], axes: [PlotAxis; 2]) -> PlotPanel {
        let panel = PlotPanel { rect_px: rect_px.map(f32::round), axes, clip: self.clip(rect_px) };
        self.draw_ticks_across(&panel);
        self.draw_ticks_up(&panel);
        self.draw_frame(&panel);
        panel
    }

    /// As [`Self::panel`], with names instead of numbers on the horizontal axis: name i is centred at i.
    pub(crate) fn panel_of_groups(&mut self, rect_px: [f32; 4], names: &[&str], value: PlotAxis) -> PlotPanel {
        let across = PlotAxis::new("", [-0.5, names.len() as f32 - 0.5]);
        let panel = PlotPanel { rect_px: rect_px.map(f32::round), axes: [across, value], clip: self.clip(rect_px) };
        self.draw_ticks_up(&panel);
        self.draw_frame(&panel);
        let base = rect_px[1] + rect_px[3] + 1.35 * self.face.size_px;
        for (index, name) in names.iter().enumerate() {
            let x = panel.to_px(Vec2::new(index as f32, 0.0)).x;
            self.text(name, Vec2::new(x, base), TextAnchor::Centre);
        }
        panel
    }

    /// Mask of a rectangle of left, top, width, height.
    fn clip(&self, [left, top, width, height]: [f32; 4]) -> Option<Mask> {
        let mut mask = Mask::new(self.pixmap.width(), self.pixmap.height())?;
        let frame = PathBuilder::from_rect(Rect::from_xywh(left, top, width, height)?);
        mask.fill_path(&frame, FillRule::Winding, false, Transform::identity());
        Some(mask)
    }

    fn draw_ticks_across(&mut self, panel: &PlotPanel) {
        let [left, top, width, height] = panel.rect_px;
        let step = panel.axes[0].tick_step(width);
        let base = top + height + 1.35 * self.face.size_px;
        for value in panel.axes[0].ticks(step) {
            let x = panel.to_px(Vec2::new(value, 0.0)).x.round();
            fill_rect(&mut self.pixmap, [x, top, HAIRLINE_PX, height], GRID_FINE, 1.0);
            fill_rect(&mut self.pixmap, [x, top + height, HAIRLINE_PX, TICK_PX], INK, 1.0);
            self.text(&tick_text(value, step), Vec2::new(x, base), TextAnchor::Centre);
        }
        let below = Vec2::new(left + 0.5 * width, base + 1.3 * self.face.size_px);
        self.text(&panel.axes[0].label, below, TextAnchor::Centre);
    }

    fn draw_ticks_up(&mut self, panel: &PlotPanel) {
        let [left, top, width, height] = panel.rect_px;
        let step = panel.axes[1].tick_step(height);
        for value in panel.axes[1].ticks(step) {
            let y = panel.to_px(Vec2::new(0.0, value)).y.round();
            fill_rect(&mut self.pixmap, [left, y, width, HAIRLINE_PX], GRID_FINE, 1.0);
            fill_rect(&mut self.pixmap, [left - TICK_PX, y, TICK_PX, HAIRLINE_PX], INK, 1.0);
            let beside = Vec2::new(left - 1.75 * TICK_PX, y + 0.35 * self.face.size_px);
            self.text(&tick_text(value, step), beside, TextAnchor::Right);
        }
        // The label is horizontal, above the axis.
        let above = Vec2::new(left, top - 0.55 * self.face.size_px);
        self.text(&panel.axes[1].label, above, TextAnchor::Left);
    }

    fn draw_frame(&mut self, panel: &PlotPanel) {
        let [left, top, width, height] = panel.rect_px;
        for edge in [[left, top + height, width + HAIRLINE_PX, HAIRLINE_PX], [left, top, HAIRLINE_PX, height]] {
            fill_rect(&mut self.pixmap, edge, INK, 1.0);
        }
    }

    /// Draws a line through points.
    pub(crate) fn polyline(&mut self, panel: &PlotPanel, points: impl IntoIterator<Item = Vec2>, style: LineStyle) {
        if let Some(path) = panel.path(points, false) {
            self.stroke(panel, &path, style);
        }
    }

    /// Draws many separate lines.
    pub(crate) fn hatching(&mut self, panel: &PlotPanel, lines: impl IntoIterator<Item = [Vec2; 2]>, style: LineStyle) {
        if let Some(path) = path_of_lines(lines.into_iter().map(|ends| ends.map(|end| panel.to_px(end)))) {
            self.stroke(panel, &path, style);
        }
    }

    /// Draws a filled polygon with an outline in the same colour.
    pub(crate) fn polygon(
        &mut self,
        panel: &PlotPanel,
        corners: impl IntoIterator<Item = Vec2>,
        fill_opacity: f32,
        style: LineStyle,
    ) {
        if let Some(path) = panel.path(corners, true) {
            fill(&mut self.pixmap, &path, &paint(style.colour, fill_opacity), panel.clip.as_ref());
            self.stroke(panel, &path, style);
        }
    }

    /// Fills a panel outside closed lines, of which inner ones bound holes; nothing without lines.
    pub(crate) fn outside(&mut self, panel: &PlotPanel, lines: &[Vec<Vec2>], colour: Rgb, opacity: f32) {
        let [left, top, width, height] = panel.rect_px;
        let Some(frame) = Rect::from_xywh(left, top, width, height).filter(|_| !lines.is_empty()) else { return };
        let mut path = PathBuilder::new();
        path.push_rect(frame);
        for line in lines.iter().filter_map(|line| panel.path(line.iter().copied(), true)) {
            path.push_path(&line);
        }
        let (Some(path), clip) = (path.finish(), panel.clip.as_ref()) else { return };
        self.pixmap.fill_path(&path, &paint(colour, opacity), FillRule::EvenOdd, Transform::identity(), clip);
    }

    /// Draws a mark; `radius_px` is in pixels.
    pub(crate) fn mark(&mut self, panel: &PlotPanel, at: Vec2, mark: PlotMark, radius_px: f32, colour: Rgb) {
        let centre = panel.to_px(at);
        if centre.is_finite() {
            mark.draw(&mut self.pixmap, centre, radius_px, colour);
        }
    }

    /// Draws a legend: the entries side by side, from a position on.
    pub(crate) fn legend(&mut self, at_px: Vec2, entries: &[LegendEntry<'_>]) {
        let mut pen_px = at_px;
        for (mark, colour, text) in entries {
            let size = self.face.size_px;
            mark.draw(&mut self.pixmap, pen_px - Vec2::new(0.0, 0.32 * size), LEGEND_MARK * size, *colour);
            pen_px.x += 0.8 * size;
            self.text(text, pen_px, TextAnchor::Left);
            pen_px.x += self.face.width_px(text) + 1.6 * size;
        }
    }

    /// Draws a legend of the heat scale, with the texts of its low, middle and high values, before further entries.
    pub(crate) fn heat_legend(&mut self, at_px: Vec2, texts: [&str; 3], entries: &[LegendEntry<'_>]) {
        let scale = [0.0, 0.5, 1.0].into_iter().zip(texts);
        let mut legend: Vec<_> = scale.map(|(share, text)| (PlotMark::Diamond, heat(share), text)).collect();
        legend.extend_from_slice(entries);
        self.legend(at_px, &legend);
    }

    fn stroke(&mut self, panel: &PlotPanel, path: &Path, style: LineStyle) {
        let width = style.width_px.max(1.0);
        let pen = Stroke { dash: style.is_dashed.then(|| dashes(width)).flatten(), ..round_stroke(width) };
        stroke(&mut self.pixmap, path, &paint(style.colour, style.opacity), &pen, panel.clip.as_ref());
    }
}

/// Names with their points; names of points at one position are joined by commas, at the first of these points.
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

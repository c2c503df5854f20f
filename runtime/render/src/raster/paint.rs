//! Fills, strokes and paths for tiny-skia. Positions in pixels, x right, y down.

use glam::Vec2;
use tiny_skia::{
    Color, FillRule, LineCap, LineJoin, Mask, Paint, Path, PathBuilder, Pixmap, Rect, Stroke, StrokeDash, Transform,
};

use crate::raster::palette::{self, Rgb};

/// A flat paint.
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

/// Fills a rectangle of left, top, width, height; nothing if it is empty.
pub(crate) fn fill_rect(pixmap: &mut Pixmap, [left, top, width, height]: [f32; 4], colour: Rgb, opacity: f32) {
    if let Some(rect) = Rect::from_xywh(left, top, width, height) {
        pixmap.fill_rect(rect, &paint(colour, opacity), Transform::identity(), None);
    }
}

/// Fills a path, within a mask if there is one.
pub(crate) fn fill(pixmap: &mut Pixmap, path: &Path, paint: &Paint<'_>, mask: Option<&Mask>) {
    pixmap.fill_path(path, paint, FillRule::Winding, Transform::identity(), mask);
}

/// Strokes a path, within a mask if there is one.
pub(crate) fn stroke(pixmap: &mut Pixmap, path: &Path, paint: &Paint<'_>, stroke: &Stroke, mask: Option<&Mask>) {
    pixmap.stroke_path(path, paint, stroke, Transform::identity(), mask);
}

/// A stroke with round caps and joins.
pub(crate) fn round_stroke(width: f32) -> Stroke {
    Stroke { width, line_cap: LineCap::Round, line_join: LineJoin::Round, ..Stroke::default() }
}

/// Dashes for a stroke of this width.
pub(crate) fn dashes(width: f32) -> Option<StrokeDash> {
    StrokeDash::new(vec![4.0 * width, 3.0 * width], 0.0)
}

/// Path through points, closed if `is_closed`; `None` without a line. Points that are not finite are left out.
pub(crate) fn path_through(points: impl IntoIterator<Item = Vec2>, is_closed: bool) -> Option<Path> {
    let mut path = PathBuilder::new();
    for point in points.into_iter().filter(|point| point.is_finite()) {
        if path.is_empty() { path.move_to(point.x, point.y) } else { path.line_to(point.x, point.y) }
    }
    if is_closed {
        path.close();
    }
    path.finish()
}

/// Path of separate lines.
pub(crate) fn path_of_lines(lines: impl IntoIterator<Item = [Vec2; 2]>) -> Option<Path> {
    let mut path = PathBuilder::new();
    for [from, to] in lines {
        path.move_to(from.x, from.y);
        path.line_to(to.x, to.y);
    }
    path.finish()
}

/// Path of a circle.
pub(crate) fn circle(centre: Vec2, radius: f32) -> Option<Path> {
    PathBuilder::from_circle(centre.x, centre.y, radius)
}

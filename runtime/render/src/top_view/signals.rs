//! Markings in the colours of signals, which change with time: lamps, lanes, doors.
//!
//! Each pixel's coverage is computed by itself, from its distance to the outline, so that all strips of a picture agree.
//! Pixels, x right, y down.

use fbcrowd_sim::scenario::{Marking, MarkingColour, Scenario};
use glam::Vec2;
use tiny_skia::Pixmap;

use crate::raster::palette::{INK, SIGNAL};
use crate::raster::pixels::{PixelWindow, Strip, blend, pixels_mut};
use crate::top_view::framing::Framing;

/// Width of the rim, m, and its limits in pixels.
const RIM_M: f32 = 0.06;
/// Least and greatest width of the rim, pixels.
const RIM_PX: [f32; 2] = [1.0, 4.0];

/// Draws the markings in the colours of their signals, by index, on a strip of a picture.
pub(crate) fn draw_signals(
    pixmap: &mut Pixmap,
    strip: &Strip,
    scenario: &Scenario,
    framing: &Framing,
    is_green: impl Fn(usize) -> bool,
) {
    let half_rim_px = 0.5 * (RIM_M * framing.scale_px_m).clamp(RIM_PX[0], RIM_PX[1]);
    for Marking { shape, colour } in &scenario.markings {
        let MarkingColour::Signal(signal) = *colour else { continue };
        if signal as usize >= scenario.behaviour.signals.len() {
            continue;
        }
        let colour = SIGNAL[usize::from(is_green(signal as usize))];
        for corners_m in shape.polygons_m() {
            let corners_px: Vec<Vec2> = corners_m.iter().map(|corner_m| framing.to_px(*corner_m)).collect();
            let reach = Vec2::splat(half_rim_px + 1.0);
            let low = corners_px.iter().copied().fold(Vec2::INFINITY, Vec2::min) - reach;
            let high = corners_px.iter().copied().fold(Vec2::NEG_INFINITY, Vec2::max) + reach;
            let window = PixelWindow::between(low, high, strip);
            let pixels = pixels_mut(pixmap);
            for y in window.rows() {
                let row = strip.row_start(y);
                for x in window.columns() {
                    let inside_px = inside_px(&corners_px, Vec2::new(x as f32 + 0.5, y as f32 + 0.5));
                    blend(&mut pixels[row + x], colour, (inside_px + 0.5).clamp(0.0, 1.0));
                    blend(&mut pixels[row + x], INK, (half_rim_px + 0.5 - inside_px.abs()).clamp(0.0, 1.0));
                }
            }
        }
    }
}

/// Distance of a point to the outline of a simple polygon, pixels; negative outside.
fn inside_px(corners_px: &[Vec2], point: Vec2) -> f32 {
    let (mut distance_px, mut is_inside) = (f32::INFINITY, false);
    for (&from, &to) in corners_px.iter().zip(corners_px.iter().cycle().skip(1)) {
        let (edge, offset) = (to - from, point - from);
        let along = (offset.dot(edge) / edge.length_squared().max(f32::MIN_POSITIVE)).clamp(0.0, 1.0);
        distance_px = distance_px.min(offset.distance(along * edge));
        let is_left = from.x + (point.y - from.y) / (to.y - from.y) * edge.x > point.x;
        is_inside ^= (from.y > point.y) != (to.y > point.y) && is_left;
    }
    if is_inside { distance_px } else { -distance_px }
}

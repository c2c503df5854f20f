//! What is written over the picture: scale bar, time stamp, agents' numbers.

use fbcrowd_sim::recording::AgentFrame;
use glam::Vec2;
use tiny_skia::Pixmap;

use crate::raster::palette::{GROUND, INK};
use crate::raster::text::{Anchor, Typeface};
use crate::top_view::framing::Framing;
use crate::top_view::ground::fill_rect;

/// Height of letters in a picture whose shorter side is [`REFERENCE_SIDE_PX`], pixels; other pictures in proportion.
const LETTERS_PX: f32 = 15.0;
/// Height of an agent's number, likewise.
const LABEL_PX: f32 = 12.5;
/// Least height of letters that can be read, pixels.
const MIN_LETTERS_PX: f32 = 9.0;
const REFERENCE_SIDE_PX: f32 = 720.0;
/// The scale bar takes at most this share of the picture's width.
const BAR_SHARE: f32 = 0.14;
/// Lengths that a scale bar may have, times a power of ten.
const BAR_STEPS: [f64; 3] = [5.0, 2.0, 1.0];
/// Distance of a label from its body's root, to the right and up, m.
const LABEL_OFFSET_M: Vec2 = Vec2::new(0.26, 0.26);

/// The faces and places of writing in one sequence.
#[derive(Clone, Debug)]
pub struct Overlay {
    framing: Framing,
    face: Typeface,
    label_face: Typeface,
}

impl Overlay {
    /// Letters sized for the picture.
    pub fn new(framing: &Framing) -> Self {
        let share = framing.size_px().min_element() / REFERENCE_SIDE_PX;
        let face = |size_px: f32| Typeface::new((size_px * share).max(MIN_LETTERS_PX));
        Self { framing: *framing, face: face(LETTERS_PX), label_face: face(LABEL_PX) }
    }

    /// The scale bar at the lower left: two ticks, a line, its length.
    pub fn draw_scale_bar(&self, pixmap: &mut Pixmap) {
        let size = self.face.size_px;
        let length_m = bar_length_m(BAR_SHARE * self.framing.width_px as f32 / self.framing.scale_px_m);
        let (length, line) = ((length_m as f32 * self.framing.scale_px_m).round(), (size / 10.0).round().max(1.0));
        let [left, base] = [size, self.framing.height_px as f32 - size].map(f32::round);
        let tick = (0.4 * size).round();
        fill_rect(pixmap, [left, base - line, length, line], INK, 1.0);
        for x in [left, left + length - line] {
            fill_rect(pixmap, [x, base - tick, line, tick], INK, 1.0);
        }
        let middle = Vec2::new(left + 0.5 * length, base - 0.55 * size);
        self.face.draw_with_halo(pixmap, &format!("{length_m} m"), middle, Anchor::Centre, [INK, GROUND]);
    }

    /// The simulated time at the lower right.
    pub fn draw_time(&self, pixmap: &mut Pixmap, time_s: f32) {
        let size = self.face.size_px;
        let corner = self.framing.size_px() - Vec2::splat(size);
        self.face.draw_with_halo(pixmap, &format!("{time_s:.2} s"), corner, Anchor::Right, [INK, GROUND]);
    }

    /// Each agent's index beside it.
    pub fn draw_labels(&self, pixmap: &mut Pixmap, agents: &[AgentFrame]) {
        for (index, agent) in agents.iter().enumerate() {
            self.draw_label(pixmap, index, agent.root.position_m);
        }
    }

    /// One agent's index beside it.
    pub fn draw_label(&self, pixmap: &mut Pixmap, index: usize, position_m: Vec2) {
        let beside = self.framing.to_px(position_m + LABEL_OFFSET_M);
        self.label_face.draw_with_halo(pixmap, &index.to_string(), beside, Anchor::Left, [INK, GROUND]);
    }
}

/// The greatest of 1, 2, 5, 10, … times any power of ten that is at most a length; f64, so that it is written shortly.
fn bar_length_m(longest_m: f32) -> f64 {
    let longest_m = f64::from(longest_m);
    let power = libm::pow(10.0, libm::floor(libm::log10(longest_m.max(1e-3))));
    BAR_STEPS.into_iter().map(|step| step * power).find(|length| *length <= longest_m).unwrap_or(power)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn letters_follow_the_shorter_side() {
        let letters_px = |[width_px, height_px]: [u32; 2]| {
            Overlay::new(&Framing { width_px, height_px, centre_m: Vec2::ZERO, scale_px_m: 40.0 }).face.size_px
        };
        assert_eq!([[1280, 720], [720, 1280], [200, 2000]].map(letters_px), [LETTERS_PX, LETTERS_PX, MIN_LETTERS_PX]);
    }

    #[test]
    fn scale_bars_have_round_lengths() {
        for (longest_m, written) in
            [(0.003, "0.002"), (0.07, "0.05"), (0.9, "0.5"), (1.0, "1"), (4.9, "2"), (73.0, "50"), (2500.0, "2000")]
        {
            assert_eq!(bar_length_m(longest_m).to_string(), written);
        }
    }
}

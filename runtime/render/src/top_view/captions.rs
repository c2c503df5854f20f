//! Captions over a picture: scale bar, time, and agents' numbers. They are drawn on the rows of a picture that begin at
//! `top_px`.

use fbcrowd_sim::AgentId;
use fbcrowd_sim::recording::AgentFrame;
use glam::Vec2;
use tiny_skia::Pixmap;

use crate::raster::paint::fill_rect;
use crate::raster::palette::{GROUND, INK};
use crate::raster::text::{TextAnchor, Typeface};
use crate::top_view::framing::Framing;

/// Shorter side of the reference picture, pixels; letters of other pictures are in proportion.
const REFERENCE_SIDE_PX: f32 = 720.0;
/// Height of letters in the reference picture, pixels.
const LETTERS_PX: f32 = 15.0;
/// Height of an agent's number in the reference picture, pixels.
const LABEL_PX: f32 = 12.5;
/// Least height of readable letters, pixels.
const MIN_LETTERS_PX: f32 = 9.0;
/// Greatest width of the scale bar, share of the picture's width.
const BAR_SHARE: f32 = 0.14;
/// Lengths of scale bars, times a power of ten.
const BAR_STEPS: [f64; 3] = [5.0, 2.0, 1.0];
/// Distance of a label from its body's root, to the right and up, m.
const LABEL_OFFSET_M: Vec2 = Vec2::new(0.26, 0.26);

/// Typefaces and framing of the captions of one sequence.
#[derive(Clone, Debug)]
pub(crate) struct Captions {
    framing: Framing,
    face: Typeface,
    label_face: Typeface,
}

impl Captions {
    /// Captions with letters in proportion to the picture.
    pub(crate) fn new(framing: &Framing) -> Self {
        let share = framing.size_px().min_element() / REFERENCE_SIDE_PX;
        let face = |size_px: f32| Typeface::new((size_px * share).max(MIN_LETTERS_PX));
        Self { framing: *framing, face: face(LETTERS_PX), label_face: face(LABEL_PX) }
    }

    /// Draws the scale bar at the lower left: a line with two ticks, and its length.
    pub(crate) fn draw_scale_bar(&self, pixmap: &mut Pixmap, top_px: u32) {
        let size = self.face.size_px;
        let length_m = bar_length_m(BAR_SHARE * self.framing.width_px as f32 / self.framing.scale_px_m);
        let (length, line) = ((length_m as f32 * self.framing.scale_px_m).round(), (size / 10.0).round().max(1.0));
        let [left, base] = [size, self.framing.height_px as f32 - size].map(f32::round);
        let tick = (0.4 * size).round();
        let top = top_px as f32;
        fill_rect(pixmap, [left, base - line - top, length, line], INK, 1.0);
        for x in [left, left + length - line] {
            fill_rect(pixmap, [x, base - tick - top, line, tick], INK, 1.0);
        }
        let middle = Vec2::new(left + 0.5 * length, base - 0.55 * size);
        self.face.draw_with_halo(pixmap, top_px, &format!("{length_m} m"), middle, TextAnchor::Centre, [INK, GROUND]);
    }

    /// Draws the simulated time at the lower right.
    pub(crate) fn draw_time(&self, pixmap: &mut Pixmap, top_px: u32, time_s: f32) {
        let size = self.face.size_px;
        let corner = self.framing.size_px() - Vec2::splat(size);
        self.face.draw_with_halo(pixmap, top_px, &format!("{time_s:.2} s"), corner, TextAnchor::Right, [INK, GROUND]);
    }

    /// Draws each agent's id beside it.
    pub(crate) fn draw_labels(&self, pixmap: &mut Pixmap, top_px: u32, agents: &[AgentFrame]) {
        for agent in agents {
            self.draw_label(pixmap, top_px, agent.id, agent.root.position_m);
        }
    }

    /// Draws one agent's id beside it.
    pub(crate) fn draw_label(&self, pixmap: &mut Pixmap, top_px: u32, id: AgentId, position_m: Vec2) {
        let beside = self.framing.to_px(position_m + LABEL_OFFSET_M);
        self.label_face.draw_with_halo(pixmap, top_px, &id.0.to_string(), beside, TextAnchor::Left, [INK, GROUND]);
    }
}

/// Greatest of 1, 2, 5, 10, … times any power of ten that is at most `longest_m`; f64, so that its text is short.
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
            Captions::new(&Framing { width_px, height_px, centre_m: Vec2::ZERO, scale_px_m: 40.0 }).face.size_px
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

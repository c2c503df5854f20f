//! Captions of a camera frame: agents' ids over their heads, and a strip with frame, time and camera.

use fbcrowd_sim::recording::AgentFrame;
use glam::Vec2;
use tiny_skia::Pixmap;

use crate::raster::paint::fill_rect;
use crate::raster::palette::{INK, PAPER};
use crate::raster::text::{TextAnchor, Typeface};
use crate::visibility::Lens;

/// Shorter side of the reference picture, pixels.
const REFERENCE_SIDE_PX: f32 = 720.0;
/// Height of letters of the strip and of labels in the reference picture, pixels.
const LETTERS_PX: [f32; 2] = [17.0, 13.0];
/// Least height of readable letters, pixels.
const MIN_LETTERS_PX: f32 = 9.0;
/// Height of a label above the ground, m: over the head.
const LABEL_M: f32 = 1.92;
/// Distance beyond which agents have no label, m: they would cover each other.
const LABELLED_M: f32 = 40.0;
/// Opacity of the strip.
const STRIP_OPACITY: f32 = 0.62;

/// Typefaces of one sequence.
#[derive(Clone, Debug)]
pub(crate) struct CameraCaptions {
    strip: Typeface,
    label: Typeface,
}

impl CameraCaptions {
    /// Captions with letters in proportion to the picture.
    pub(crate) fn new(size_px: [u32; 2]) -> Self {
        let share = size_px[0].min(size_px[1]) as f32 / REFERENCE_SIDE_PX;
        let [strip, label] = LETTERS_PX.map(|size_px| Typeface::new((size_px * share).max(MIN_LETTERS_PX)));
        Self { strip, label }
    }

    /// Writes each agent's id over its head, far ones first.
    pub(crate) fn draw_labels(&self, pixmap: &mut Pixmap, lens: &Lens, agents: &[AgentFrame]) {
        let labelled = agents.iter().filter_map(|agent| {
            let over_m = agent.root.position_m.extend(LABEL_M);
            let depth_m = lens.to_camera(over_m).z;
            let px = lens.to_px(over_m).filter(|_| depth_m > 0.0 && depth_m < LABELLED_M)?;
            let is_inside = px.cmpge(Vec2::ZERO).all() && px.cmplt(lens.size()).all();
            is_inside.then_some((depth_m, px, agent.id.0))
        });
        let mut labelled: Vec<(f32, Vec2, u32)> = labelled.collect();
        labelled.sort_by(|one, other| other.0.total_cmp(&one.0));
        for (_, px, id) in labelled {
            self.label.draw_with_halo(pixmap, 0, &id.to_string(), px, TextAnchor::Centre, [PAPER, INK]);
        }
    }

    /// Draws the strip along the lower edge: left, middle and right text.
    pub(crate) fn draw_strip(&self, pixmap: &mut Pixmap, texts: [&str; 3]) {
        let [width, height] = [pixmap.width() as f32, pixmap.height() as f32];
        let strip_px = (1.7 * self.strip.size_px).round();
        fill_rect(pixmap, [0.0, height - strip_px, width, strip_px], INK, STRIP_OPACITY);
        let base = height - 0.56 * self.strip.size_px;
        let margin = 0.7 * self.strip.size_px;
        let anchors = [TextAnchor::Left, TextAnchor::Centre, TextAnchor::Right];
        for ((text, anchor), x) in texts.into_iter().zip(anchors).zip([margin, 0.5 * width, width - margin]) {
            let fitted = self.strip.fitted(text, 0.4 * width);
            self.strip.draw(pixmap, &fitted, Vec2::new(x, base), anchor, PAPER);
        }
    }
}

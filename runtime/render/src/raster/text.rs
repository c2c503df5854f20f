//! Text on pictures: glyphs of a bundled font, rasterised once per size by fontdue. Positions in pixels, y down.

use std::collections::BTreeMap;

use epaint_default_fonts::UBUNTU_LIGHT;
use fontdue::{Font, FontSettings};
use glam::Vec2;
use tiny_skia::Pixmap;

use crate::raster::palette::Rgb;
use crate::raster::pixels::{blend, pixels_mut};

/// Characters beyond ASCII that pictures contain.
const SYMBOLS: &str = "°·–²−ωφ×…±µ";
/// Factor on the coverage of glyphs: thickens the thin strokes of the light font.
const STROKE_GAIN: f32 = 1.35;

/// Horizontal anchor of a text: the point that is at the given position.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum TextAnchor {
    /// The left end.
    Left,
    /// The middle.
    Centre,
    /// The right end.
    Right,
}

/// The font at one size.
#[derive(Clone, Debug)]
pub(crate) struct Typeface {
    /// Height of a line's letters from descender to ascender, pixels.
    pub(crate) size_px: f32,
    glyphs: BTreeMap<char, Glyph>,
}

/// A rasterised character.
#[derive(Clone, Debug)]
struct Glyph {
    /// Movement of the pen to the next character, pixels.
    advance_px: f32,
    /// Left and top edge of the coverage relative to the pen on the baseline, pixels.
    corner_px: [i32; 2],
    /// Width of the coverage, pixels.
    width: usize,
    /// Coverage of each pixel, row by row, 0 to 255.
    coverage: Vec<u8>,
}

impl Typeface {
    /// The font at a size; rasterises every character.
    pub(crate) fn new(size_px: f32) -> Self {
        let font = Font::from_bytes(UBUNTU_LIGHT, FontSettings { scale: size_px, ..FontSettings::default() })
            .expect("the font is compiled in and known to parse");
        let characters = (' '..='~').chain(SYMBOLS.chars());
        let glyphs = characters.map(|character| (character, Glyph::new(&font, character, size_px))).collect();
        Self { size_px, glyphs }
    }

    /// Width of a text, pixels.
    pub(crate) fn width_px(&self, text: &str) -> f32 {
        self.glyphs_of(text).map(|glyph| glyph.advance_px).sum()
    }

    /// The text, at most `width_px` wide. The middle of a longer text becomes `…`, since names with the same beginning
    /// often differ at their ends.
    pub(crate) fn fitted(&self, text: &str, width_px: f32) -> String {
        let letters: Vec<char> = text.chars().collect();
        let shortened = |kept: usize| {
            let (head, tail) = (kept.div_ceil(2), kept / 2);
            letters[..head].iter().chain(['…'].iter()).chain(&letters[letters.len() - tail..]).collect::<String>()
        };
        if self.width_px(text) <= width_px {
            return text.to_owned();
        }
        let fitting = (0..letters.len()).rev().map(shortened).find(|text| self.width_px(text) <= width_px);
        fitting.unwrap_or_default()
    }

    /// Draws a text with its baseline at `at_px`.
    pub(crate) fn draw(&self, pixmap: &mut Pixmap, text: &str, at_px: Vec2, anchor: TextAnchor, colour: Rgb) {
        self.draw_below(pixmap, 0, text, at_px, anchor, colour);
    }

    /// As [`Self::draw`], on the rows of a picture that begin at `top_px`.
    fn draw_below(&self, pixmap: &mut Pixmap, top_px: u32, text: &str, at_px: Vec2, anchor: TextAnchor, colour: Rgb) {
        let share = match anchor {
            TextAnchor::Left => 0.0,
            TextAnchor::Centre => 0.5,
            TextAnchor::Right => 1.0,
        };
        let mut pen_px = at_px.x - share * self.width_px(text);
        for glyph in self.glyphs_of(text) {
            // Rounded in the picture, so that all strips agree.
            let base_px = (at_px.y.round() as i32).saturating_sub_unsigned(top_px);
            glyph.draw(pixmap, [pen_px.round() as i32, base_px], colour);
            pen_px += glyph.advance_px;
        }
    }

    /// Draws a text with a halo of one pixel, so that it is readable over bodies and lines, on the rows of a picture
    /// that begin at `top_px`.
    pub(crate) fn draw_with_halo(
        &self,
        pixmap: &mut Pixmap,
        top_px: u32,
        text: &str,
        at_px: Vec2,
        anchor: TextAnchor,
        [ink, halo]: [Rgb; 2],
    ) {
        for shift in [Vec2::X, Vec2::NEG_X, Vec2::Y, Vec2::NEG_Y, Vec2::ONE, Vec2::NEG_ONE] {
            self.draw_below(pixmap, top_px, text, at_px + shift, anchor, halo);
        }
        self.draw_below(pixmap, top_px, text, at_px, anchor, ink);
    }

    fn glyphs_of<'a>(&'a self, text: &'a str) -> impl Iterator<Item = &'a Glyph> {
        // A character without a glyph is drawn as a question mark.
        text.chars().filter_map(|character| self.glyphs.get(&character).or_else(|| self.glyphs.get(&'?')))
    }
}

impl Glyph {
    fn new(font: &Font, character: char, size_px: f32) -> Self {
        let (metrics, mut coverage) = font.rasterize(character, size_px);
        for value in &mut coverage {
            *value = (f32::from(*value) * STROKE_GAIN).min(255.0) as u8;
        }
        let corner_px = [metrics.xmin, -(metrics.ymin + metrics.height as i32)];
        Self { advance_px: metrics.advance_width, corner_px, width: metrics.width, coverage }
    }

    fn draw(&self, pixmap: &mut Pixmap, pen_px: [i32; 2], colour: Rgb) {
        let (width, height) = (pixmap.width() as usize, pixmap.height() as usize);
        let index = |pen: i32, corner: i32, step: usize, side: usize| {
            usize::try_from(pen.saturating_add(corner).saturating_add(step as i32)).ok().filter(|at| *at < side)
        };
        let pixels = pixels_mut(pixmap);
        for (row, line) in self.coverage.chunks(self.width.max(1)).enumerate() {
            let Some(y) = index(pen_px[1], self.corner_px[1], row, height) else { continue };
            for (column, covered) in line.iter().enumerate().filter(|(_, covered)| **covered > 0) {
                let Some(x) = index(pen_px[0], self.corner_px[0], column, width) else { continue };
                blend(&mut pixels[y * width + x], colour, f32::from(*covered) / 255.0);
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_text_too_wide_loses_its_middle() {
        let face = Typeface::new(20.0);
        let long = "dataset-1_walk_normal_001_mirrored";
        let fitted = face.fitted(long, 0.5 * face.width_px(long));
        assert!(face.width_px(&fitted) <= 0.5 * face.width_px(long), "{fitted}");
        assert!(fitted.starts_with("dataset") && fitted.contains('…') && fitted.ends_with("rored"), "{fitted}");
        assert_eq!((face.fitted("walk", 500.0), face.fitted("walk", 1.0)), ("walk".to_owned(), String::new()));
    }
}

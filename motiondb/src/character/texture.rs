//! The textures of a character: pixels as the file states them, sRGB, and where their alpha hides a surface.

use serde::{Deserialize, Serialize};

/// Greatest number of pixels of all textures of a character; larger ones are halved when they are compiled.
pub const TEXTURE_PIXELS_MAX: usize = 16 << 20;
/// Greatest width and height of a texture, pixels.
pub const TEXTURE_SIDE_MAX: usize = 4096;

/// A texture. The first row is that of v = 0.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub struct CharacterTexture {
    /// Width and height, pixels.
    pub size_px: [u32; 2],
    /// How coordinates beyond 0 to 1 are read, along u and v.
    pub wraps: [Wrap; 2],
    /// Red, green and blue (sRGB), and alpha of each pixel, row by row.
    pub pixels: Vec<u8>,
}

/// How a texture continues beyond its edge.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
pub enum Wrap {
    /// It repeats.
    #[default]
    Repeat,
    /// Every second copy is mirrored.
    Mirror,
    /// Its edge continues.
    Clamp,
}

/// What the alpha of a texture hides.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
pub enum CutOut {
    /// Nothing.
    #[default]
    Opaque,
    /// All of a lower alpha.
    Below(f32),
    /// A share of the samples of a pixel: as much as alpha is less than 1.
    Blended,
}

impl CharacterTexture {
    /// The texture at half its width and height: means of four pixels in linear light, by their alpha.
    #[must_use]
    pub fn halved(&self, linear: &[f32; 256]) -> Self {
        let [width, height] = self.size_px.map(|side| (side / 2).max(1));
        let mut pixels = Vec::with_capacity(4 * width as usize * height as usize);
        for y in 0..height {
            for x in 0..width {
                let corner = |index: u32| self.pixel((2 * x + index % 2) as usize, (2 * y + index / 2) as usize);
                pixels.extend(mean([0, 1, 2, 3].map(corner), linear));
            }
        }
        Self { size_px: [width, height], wraps: self.wraps, pixels }
    }

    /// Number of pixels.
    pub fn pixel_count(&self) -> usize {
        self.pixels.len() / 4
    }

    /// A pixel; beyond the last row and column, theirs.
    pub fn pixel(&self, x: usize, y: usize) -> [u8; 4] {
        let [width, height] = self.size_px.map(|side| side as usize);
        let start = 4 * (y.min(height - 1) * width + x.min(width - 1));
        [0, 1, 2, 3].map(|part| self.pixels[start + part])
    }
}

/// The mean of pixels by their alpha; of transparent ones, the plain mean.
fn mean(pixels: [[u8; 4]; 4], linear: &[f32; 256]) -> [u8; 4] {
    let alpha_sum: u32 = pixels.iter().map(|pixel| u32::from(pixel[3])).sum();
    let weight = |pixel: &[u8; 4]| if alpha_sum > 0 { f32::from(pixel[3]) } else { 1.0 };
    let weights: f32 = pixels.iter().map(weight).sum();
    let part = |part: usize| {
        let sum: f32 = pixels.iter().map(|pixel| weight(pixel) * linear[usize::from(pixel[part])]).sum();
        nearest(sum / weights, linear)
    };
    [part(0), part(1), part(2), ((alpha_sum + 2) / 4) as u8]
}

/// The sRGB value whose linear value is nearest.
fn nearest(value: f32, linear: &[f32; 256]) -> u8 {
    let above = linear.partition_point(|known| *known < value).min(255);
    let below = above.saturating_sub(1);
    if value - linear[below] < linear[above] - value { below as u8 } else { above as u8 }
}

/// Linear value of each sRGB value (IEC 61966-2-1).
pub fn linear_values() -> [f32; 256] {
    std::array::from_fn(|value| {
        let value = value as f64 / 255.0;
        let linear = if value <= 0.04045 { value / 12.92 } else { libm::pow((value + 0.055) / 1.055, 2.4) };
        linear as f32
    })
}

impl Wrap {
    /// The index of a pixel along a side of `count` pixels.
    pub fn index(self, index: i64, count: i64) -> usize {
        let index = match self {
            Self::Repeat => index.rem_euclid(count),
            Self::Clamp => index.clamp(0, count - 1),
            Self::Mirror => {
                let turn = index.rem_euclid(2 * count);
                if turn < count { turn } else { 2 * count - 1 - turn }
            }
        };
        index as usize
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn halves_are_means_of_linear_light_without_what_is_transparent() {
        let linear = linear_values();
        let pixels = [[255, 0, 0, 255], [0, 0, 0, 255], [0, 255, 0, 0], [255, 0, 0, 255]];
        let texture = CharacterTexture { size_px: [2, 2], wraps: [Wrap::Repeat; 2], pixels: pixels.concat() };
        // Two of three parts of the light; a plain mean of codes would be 170.
        assert_eq!(texture.halved(&linear).pixels, [213, 0, 0, 191]);
        let row = CharacterTexture { size_px: [3, 1], wraps: [Wrap::Repeat; 2], pixels: [[9, 9, 9, 255]; 3].concat() };
        assert_eq!(row.halved(&linear), CharacterTexture { size_px: [1, 1], pixels: vec![9, 9, 9, 255], ..row });
    }

    #[test]
    fn wraps_continue_a_side() {
        let along = |wrap: Wrap| (-3..6).map(|index| wrap.index(index, 3)).collect::<Vec<usize>>();
        assert_eq!(along(Wrap::Repeat), [0, 1, 2, 0, 1, 2, 0, 1, 2]);
        assert_eq!(along(Wrap::Mirror), [2, 1, 0, 0, 1, 2, 2, 1, 0]);
        assert_eq!(along(Wrap::Clamp), [0, 0, 0, 0, 1, 2, 2, 2, 2]);
    }
}

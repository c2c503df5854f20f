//! A picture in scene-linear light: half floats, Rec. 709, premultiplied; and its display by the tone curve.

use exr::prelude::f16;
use glam::Vec3;
use tiny_skia::{Pixmap, PremultipliedColorU8};

use crate::shading::tone::ToneTable;
use crate::visibility::TILE_PX;

/// A picture in scene-linear light.
#[derive(Clone, Debug, PartialEq)]
pub struct LinearPicture {
    /// Width and height, pixels.
    pub size_px: [u32; 2],
    /// Red, green, blue and alpha of each pixel, row by row.
    pub pixels: Vec<[f16; 4]>,
}

/// The sum of pictures of the same size.
#[derive(Clone, Debug, Default)]
pub(crate) struct LinearSum {
    size_px: [u32; 2],
    light: Vec<Vec3>,
    count: u32,
}

impl LinearSum {
    /// Adds a picture.
    pub(crate) fn add(&mut self, picture: &LinearPicture) {
        self.size_px = picture.size_px;
        self.light.resize(picture.pixels.len(), Vec3::ZERO);
        for (sum, [red, green, blue, _]) in self.light.iter_mut().zip(&picture.pixels) {
            *sum += Vec3::from([red, green, blue].map(|light| light.to_f32()));
        }
        self.count += 1;
    }

    /// The mean of all pictures.
    pub(crate) fn mean(&self) -> LinearPicture {
        let pixels = self.light.iter().map(|light| opaque(*light / self.count.max(1) as f32)).collect();
        LinearPicture { size_px: self.size_px, pixels }
    }
}

/// An opaque pixel.
pub(crate) fn opaque(colour: Vec3) -> [f16; 4] {
    let [red, green, blue] = colour.to_array().map(f16::from_f32);
    [red, green, blue, f16::ONE]
}

impl LinearPicture {
    /// A picture from its tiles, row by row.
    pub(crate) fn from_tiles(size_px: [u32; 2], tiles: &[Vec<[f16; 4]>]) -> Self {
        let [width, height] = size_px.map(|side| side as usize);
        let (side, columns) = (TILE_PX as usize, width.div_ceil(TILE_PX as usize));
        let mut pixels = Vec::with_capacity(width * height);
        for y in 0..height {
            for (column, tile) in tiles[y / side * columns..][..columns].iter().enumerate() {
                let tile_width = side.min(width - column * side);
                pixels.extend_from_slice(&tile[y % side * tile_width..][..tile_width]);
            }
        }
        Self { size_px, pixels }
    }

    /// Pixels of a tile, by its column and row among tiles.
    pub(crate) fn tile(&self, column: usize, row: usize) -> Vec<[f16; 4]> {
        let ([width, height], side) = (self.size_px.map(|side| side as usize), TILE_PX as usize);
        let columns = column * side..((column + 1) * side).min(width);
        let lines = (row * side..((row + 1) * side).min(height)).map(|y| &self.pixels[y * width..][..width]);
        lines.flat_map(|line| &line[columns.clone()]).copied().collect()
    }

    /// The picture for display, opaque.
    ///
    /// # Panics
    /// If a side is 0 or beyond what a picture can have; that of a checked view is not.
    pub fn to_display(&self) -> Pixmap {
        let table = ToneTable::shared();
        let mut pixmap = Pixmap::new(self.size_px[0], self.size_px[1]).expect("the view's sides are checked");
        for (pixel, [red, green, blue, _]) in pixmap.pixels_mut().iter_mut().zip(&self.pixels) {
            let [red, green, blue] = [red, green, blue].map(|light| table.code(*light));
            *pixel = PremultipliedColorU8::from_rgba(red, green, blue, u8::MAX).unwrap_or(*pixel);
        }
        pixmap
    }
}

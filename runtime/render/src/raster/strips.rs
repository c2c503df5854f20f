//! A picture that is drawn strip by strip, so that a large one takes little memory.

use tiny_skia::{Pixmap, PremultipliedColorU8};

/// A picture whose rows are drawn on demand.
pub(crate) trait PictureStrips {
    /// Width and height of the picture, pixels.
    fn size_px(&self) -> [u32; 2];

    /// Number of rows of each strip; the last one may show fewer.
    fn strip_rows(&self) -> u32;

    /// Draws the strip that begins at a row.
    fn draw(&mut self, top_px: u32);

    /// Pixels of the strip that was drawn last, row by row.
    fn pixels(&self) -> &[PremultipliedColorU8];
}

/// A picture that is drawn already: one strip.
impl PictureStrips for &Pixmap {
    fn size_px(&self) -> [u32; 2] {
        [self.width(), self.height()]
    }

    fn strip_rows(&self) -> u32 {
        self.height()
    }

    fn draw(&mut self, _top_px: u32) {}

    fn pixels(&self) -> &[PremultipliedColorU8] {
        Pixmap::pixels(self)
    }
}

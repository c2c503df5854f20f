//! Textures of meshes: each at its own size and at halves of it, sampled by the size of a pixel. Linear Rec. 709.

use glam::{Vec2, Vec3, Vec4};
use motiondb::character::{CharacterTexture, linear_values};

/// A texture and its halves, down to one pixel.
#[derive(Clone, Debug, PartialEq)]
pub struct Texture {
    levels: Vec<CharacterTexture>,
    linear: [f32; 256],
}

impl Texture {
    /// A texture; `skipped` of its finest levels are left out to save memory.
    pub fn new(texture: &CharacterTexture, skipped: u32) -> Self {
        let linear = linear_values();
        let skips = skipped.min(texture.size_px[0].max(texture.size_px[1]).ilog2());
        let finest = (0..skips).fold(texture.clone(), |texture, _| texture.halved(&linear));
        let mut levels = vec![finest];
        while levels[levels.len() - 1].size_px != [1, 1] {
            levels.push(levels[levels.len() - 1].halved(&linear));
        }
        Self { levels, linear }
    }

    /// Width and height of the finest level, pixels.
    pub fn size_px(&self) -> Vec2 {
        let [width, height] = self.levels[0].size_px;
        Vec2::new(width as f32, height as f32)
    }

    /// Colour and alpha at coordinates, where a pixel of the picture is as wide as `footprint_px` of the texture.
    pub(crate) fn sample(&self, uv: Vec2, footprint_px: f32) -> Vec4 {
        let last = self.levels.len() - 1;
        let level = if footprint_px > 1.0 { libm::log2f(footprint_px).min(last as f32) } else { 0.0 };
        let finer = level as usize;
        let share = level - finer as f32;
        let sampled = self.bilinear(finer, uv);
        if share > 0.0 { sampled.lerp(self.bilinear((finer + 1).min(last), uv), share) } else { sampled }
    }

    /// Colour and alpha at coordinates on one level, between the four nearest pixels.
    fn bilinear(&self, level: usize, uv: Vec2) -> Vec4 {
        let texture = &self.levels[level];
        let size = texture.size_px.map(|side| side as f32);
        let at = Vec2::new(uv.x * size[0] - 0.5, uv.y * size[1] - 0.5);
        let (corner, share) = (at.floor(), at - at.floor());
        let index = |axis: usize, step: f32| {
            texture.wraps[axis].index((corner[axis] + step) as i64, i64::from(texture.size_px[axis]))
        };
        let texel = |x: f32, y: f32| self.linear_texel(texture.pixel(index(0, x), index(1, y)));
        let upper = texel(0.0, 0.0).lerp(texel(1.0, 0.0), share.x);
        upper.lerp(texel(0.0, 1.0).lerp(texel(1.0, 1.0), share.x), share.y)
    }

    fn linear_texel(&self, [red, green, blue, alpha]: [u8; 4]) -> Vec4 {
        let [red, green, blue] = [red, green, blue].map(|part| self.linear[usize::from(part)]);
        Vec3::new(red, green, blue).extend(f32::from(alpha) / 255.0)
    }
}

#[cfg(test)]
mod tests {
    use motiondb::character::Wrap;

    use super::*;

    /// Black and white columns.
    fn stripes(width: u32) -> Texture {
        let pixels = (0..width * 4).flat_map(|index| if index % 2 == 0 { [0, 0, 0, 255] } else { [255; 4] }).collect();
        Texture::new(&CharacterTexture { size_px: [width, 4], wraps: [Wrap::Repeat; 2], pixels }, 0)
    }

    #[test]
    fn near_pixels_show_texels_and_far_ones_their_mean() {
        let texture = stripes(64);
        let [dark, light] = [0.5 / 64.0, 1.5 / 64.0].map(|u| texture.sample(Vec2::new(u, 0.3), 0.2).x);
        assert!(dark < 1e-3 && light > 0.999, "{dark} {light}");
        let between = texture.sample(Vec2::new(1.0 / 64.0, 0.3), 1.0).x;
        assert!((between - 0.5).abs() < 1e-3, "{between}");
        for u in [0.0, 0.13, 0.5, 0.99, 7.77, -3.2] {
            let far = texture.sample(Vec2::new(u, 0.3), 9.0).x;
            assert!((far - 0.5).abs() < 0.02, "{u}: {far}");
        }
    }

    #[test]
    fn skipped_levels_leave_half_the_size() {
        let texture = CharacterTexture { size_px: [8, 2], wraps: [Wrap::Clamp; 2], pixels: vec![99; 64] };
        assert_eq!(Texture::new(&texture, 1).size_px(), Vec2::new(4.0, 1.0));
        assert_eq!(Texture::new(&texture, 9).size_px(), Vec2::new(1.0, 1.0));
    }
}

//! The tone curve: scene-linear light to sRGB code values. Linear up to a knee, then a shoulder that reaches white late,
//! so that bright ground keeps its lines.

use std::sync::OnceLock;

use exr::prelude::f16;

use crate::raster::palette::encode_srgb;

/// Light up to which the curve is a straight line.
const KNEE: f32 = 0.55;

/// Code value of each half float, by its bits.
pub(crate) struct ToneTable {
    codes: Vec<u8>,
}

impl ToneTable {
    /// The table, made once.
    pub(crate) fn shared() -> &'static Self {
        static TABLE: OnceLock<ToneTable> = OnceLock::new();
        TABLE.get_or_init(Self::new)
    }

    fn new() -> Self {
        let code = |bits: u16| {
            let light = f16::from_bits(bits).to_f32();
            // NaN becomes black.
            (255.0 * encode_srgb(curve(light.max(0.0))) + 0.5) as u8
        };
        Self { codes: (0..=u16::MAX).map(code).collect() }
    }

    /// The code value of a channel.
    pub(crate) fn code(&self, light: f16) -> u8 {
        self.codes[usize::from(light.to_bits())]
    }
}

/// Display light of scene light, 0 to 1.
fn curve(light: f32) -> f32 {
    if light <= KNEE {
        return light;
    }
    if light == f32::INFINITY {
        return 1.0;
    }
    let above = (light - KNEE) / (1.0 - KNEE);
    KNEE + (1.0 - KNEE) * above / (1.0 + above)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn brighter_light_is_never_darker() {
        let table = ToneTable::new();
        let codes: Vec<u8> = (0..2000).map(|step| table.code(f16::from_f32(step as f32 * 0.005))).collect();
        assert!(codes.is_sorted() && codes[0] == 0 && codes[1999] > 245, "{}", codes[1999]);
        assert_eq!([f32::NAN, -1.0, f32::INFINITY].map(|light| table.code(f16::from_f32(light))), [0, 0, 255]);
    }
}

//! The colour space of a scene-linear picture.

use exr::meta::attribute::Chromaticities;
use exr::prelude::{Vec2, f16};
use glam::{Mat3, Vec3};

/// A colour space of scene-linear light.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum ColourSpace {
    /// Primaries and white point of Rec. 709, the same as sRGB's.
    #[default]
    Rec709,
    /// ACEScg: primaries AP1, white point of ACES (S-2014-004).
    AcesCg,
}

/// Rec. 709 to ACEScg, by columns: Bradford adaptation from D65 to the white point of ACES, computed from both sets of
/// chromaticities; a test computes it again.
const REC_709_TO_ACES_CG: Mat3 = Mat3::from_cols(
    Vec3::new(0.613_097, 0.070_194, 0.020_616),
    Vec3::new(0.339_523, 0.916_354, 0.109_570),
    Vec3::new(0.047_380, 0.013_452, 0.869_815),
);

impl ColourSpace {
    /// Primaries and white point.
    pub(crate) fn chromaticities(self) -> Chromaticities {
        let [red, green, blue, white] = self.xy().map(|[x, y]| Vec2(x, y));
        Chromaticities { red, green, blue, white }
    }

    /// Chromaticities of red, green, blue and white.
    fn xy(self) -> [[f32; 2]; 4] {
        match self {
            Self::Rec709 => [[0.64, 0.33], [0.30, 0.60], [0.15, 0.06], [0.3127, 0.3290]],
            Self::AcesCg => [[0.713, 0.293], [0.165, 0.830], [0.128, 0.044], [0.32168, 0.33767]],
        }
    }

    /// A pixel of Rec. 709 in this space.
    pub(crate) fn of_rec_709(self, pixel: [f16; 4]) -> [f16; 4] {
        if self == Self::Rec709 {
            return pixel;
        }
        let [red, green, blue, alpha] = pixel;
        let light = REC_709_TO_ACES_CG * Vec3::from([red, green, blue].map(f16::to_f32));
        let [red, green, blue] = light.to_array().map(f16::from_f32);
        [red, green, blue, alpha]
    }
}

#[cfg(test)]
mod tests {
    use glam::{DMat3, DVec3};

    use super::*;

    /// XYZ of the primaries, scaled so that they add up to the white point (SMPTE RP 177).
    fn to_xyz(space: ColourSpace) -> DMat3 {
        let xyz = space.xy().map(|[x, y]| {
            let [x, y] = [f64::from(x), f64::from(y)];
            DVec3::new(x / y, 1.0, (1.0 - x - y) / y)
        });
        let primaries = DMat3::from_cols(xyz[0], xyz[1], xyz[2]);
        primaries * DMat3::from_diagonal(primaries.inverse() * xyz[3])
    }

    #[test]
    fn the_matrix_is_that_of_the_chromaticities() {
        let bradford = DMat3::from_cols(
            DVec3::new(0.8951, -0.7502, 0.0389),
            DVec3::new(0.2664, 1.7135, -0.0685),
            DVec3::new(-0.1614, 0.0367, 1.0296),
        );
        let [from, to] = [ColourSpace::Rec709, ColourSpace::AcesCg].map(to_xyz);
        let [from_white, to_white] = [from, to].map(|space| bradford * (space * DVec3::ONE));
        let adapted = bradford.inverse() * DMat3::from_diagonal(to_white / from_white) * bradford;
        let matrix = (to.inverse() * adapted * from).as_mat3();
        assert!(matrix.abs_diff_eq(REC_709_TO_ACES_CG, 1e-5), "{matrix}");
    }

    #[test]
    fn white_stays_white() {
        let white = ColourSpace::AcesCg.of_rec_709([f16::ONE; 4]).map(f16::to_f32);
        assert!(white.iter().all(|light| (light - 1.0).abs() < 1e-3), "{white:?}");
    }
}

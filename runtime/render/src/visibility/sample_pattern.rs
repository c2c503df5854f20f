//! Where the samples of a pixel lie. Units of 1/256 pixel, so that positions are exact in integers and floats.

/// Number of units in a pixel.
pub(crate) const UNITS: i32 = 256;

/// The samples of every pixel.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum SamplePattern {
    /// One sample in the middle.
    One,
    /// Four samples on a rotated grid: for previews.
    #[default]
    Four,
    /// Sixteen samples, each alone in its row and column: for finals.
    Sixteen,
}

impl SamplePattern {
    /// The pattern of a number of samples; none for other numbers.
    ///
    /// ```
    /// use fbcrowd_render::visibility::SamplePattern;
    ///
    /// assert_eq!(SamplePattern::of(16), Some(SamplePattern::Sixteen));
    /// assert_eq!(SamplePattern::of(5), None);
    /// ```
    pub const fn of(count: usize) -> Option<Self> {
        match count {
            1 => Some(Self::One),
            4 => Some(Self::Four),
            16 => Some(Self::Sixteen),
            _ => None,
        }
    }

    /// Number of samples of a pixel.
    pub const fn count(self) -> usize {
        self.offsets().len()
    }

    /// Positions from the pixel's upper left corner, units.
    pub(crate) const fn offsets(self) -> &'static [[i32; 2]] {
        match self {
            Self::One => &[[128, 128]],
            Self::Four => &[[96, 32], [224, 96], [32, 160], [160, 224]],
            Self::Sixteen => &SIXTEEN,
        }
    }
}

/// Positions of the samples of the pattern with `N` of them, known when the program is compiled.
pub(crate) struct SampleOffsets<const N: usize>;

impl<const N: usize> SampleOffsets<N> {
    /// As [`SamplePattern::offsets`].
    pub(crate) const UNITS: [[i32; 2]; N] = match SamplePattern::of(N) {
        Some(pattern) => *pattern.offsets().first_chunk().expect("a pattern of N samples has N offsets"),
        None => panic!("there is no such pattern"),
    };
}

/// A (0, 2)-sequence: column `i`, row the bits of `i` reversed.
const SIXTEEN: [[i32; 2]; 16] = {
    let mut offsets = [[0; 2]; 16];
    let mut index = 0;
    while index < 16 {
        let reversed = ((index & 1) << 3) | ((index & 2) << 1) | ((index & 4) >> 1) | ((index & 8) >> 3);
        offsets[index] = [index as i32 * 16 + 8, reversed as i32 * 16 + 8];
        index += 1;
    }
    offsets
};

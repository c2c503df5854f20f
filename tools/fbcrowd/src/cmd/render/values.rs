//! Values of the options of `fbcrowd render`.

use std::ops::RangeInclusive;

use clap::ValueEnum;
use fbcrowd_render::camera::ColourBy;
use fbcrowd_render::passes::{ColourSpace, ExrCompression};
use fbcrowd_render::shading::Occlusion;
use fbcrowd_render::top_view::PictureFormat;
use fbcrowd_render::visibility::SamplePattern;

/// Sides of a picture, pixels, as in `[view]`.
const SIDE_PX: RangeInclusive<u32> = 16..=8_192;

#[derive(Clone, Copy, ValueEnum)]
pub(super) enum CompressionArg {
    /// Deflate, sixteen lines at once: the default.
    Zip16,
    /// Deflate, line by line.
    Zip1,
    /// Runs of equal bytes: fast, about twice as large.
    Rle,
    /// Wavelets.
    Piz,
    None,
}

#[derive(Clone, Copy, ValueEnum)]
pub(super) enum ColourSpaceArg {
    /// Primaries of Rec. 709 and sRGB: the default.
    Rec709,
    /// ACEScg, primaries AP1.
    #[value(name = "acescg")]
    AcesCg,
}

#[derive(Clone, Copy, PartialEq, Eq, ValueEnum)]
pub(super) enum ViewArg {
    /// From straight above.
    Top,
    /// From a camera in the scene.
    Camera,
    /// The body of each --agent alone at the frames, side by side, from its right side and from its front.
    Strip,
}

#[derive(Clone, Copy, ValueEnum)]
pub(super) enum FormatArg {
    Png,
    Exr,
}

#[derive(Clone, Copy, ValueEnum)]
pub(super) enum OverlayArg {
    /// Velocity space: every half-plane that limits the plan, and the preferred, planned and actual velocities.
    Constraints,
}

#[derive(Clone, Copy, PartialEq, Eq, ValueEnum)]
pub(super) enum OcclusionArg {
    None,
    /// The ground at the feet.
    Ground,
    /// The ground and the bodies.
    Full,
}

#[derive(Clone, Copy, PartialEq, Eq, ValueEnum)]
pub(super) enum ColourByArg {
    /// Each agent has its own hue.
    Agent,
    /// Each group has its own hue.
    Group,
    /// Planned speed: red stands, green walks briskly.
    Speed,
    /// Blue blends examples, ochre deforms the base walk.
    Synthesis,
    /// Agents around: green is free, red is crowded.
    Density,
}

impl From<CompressionArg> for ExrCompression {
    fn from(arg: CompressionArg) -> Self {
        match arg {
            CompressionArg::Zip16 => Self::Zip16,
            CompressionArg::Zip1 => Self::Zip1,
            CompressionArg::Rle => Self::Rle,
            CompressionArg::Piz => Self::Piz,
            CompressionArg::None => Self::Uncompressed,
        }
    }
}

impl From<ColourSpaceArg> for ColourSpace {
    fn from(arg: ColourSpaceArg) -> Self {
        match arg {
            ColourSpaceArg::Rec709 => Self::Rec709,
            ColourSpaceArg::AcesCg => Self::AcesCg,
        }
    }
}

/// Reads a picture's size, such as `1920x1080`.
pub(super) fn size_px(text: &str) -> Result<[u32; 2], String> {
    let side = |text: &str| text.parse().ok().filter(|side| SIDE_PX.contains(side));
    let sides = text.split_once('x').and_then(|(width, height)| Some([side(width)?, side(height)?]));
    sides.ok_or_else(|| "give a size such as 1920x1080, of 16 to 8192 pixels a side".to_owned())
}

pub(super) fn sample_pattern(text: &str) -> Result<SamplePattern, String> {
    let count = text.parse().ok();
    count.and_then(SamplePattern::of).ok_or_else(|| "give 1, 4 or 16".to_owned())
}

impl From<FormatArg> for PictureFormat {
    fn from(format: FormatArg) -> Self {
        match format {
            FormatArg::Png => Self::Png,
            FormatArg::Exr => Self::Exr,
        }
    }
}

impl From<OcclusionArg> for Occlusion {
    fn from(occlusion: OcclusionArg) -> Self {
        match occlusion {
            OcclusionArg::None => Self::None,
            OcclusionArg::Ground => Self::Ground,
            OcclusionArg::Full => Self::Full,
        }
    }
}

impl From<ColourByArg> for ColourBy {
    fn from(colour_by: ColourByArg) -> Self {
        match colour_by {
            ColourByArg::Agent => Self::Agent,
            ColourByArg::Group => Self::Group,
            ColourByArg::Speed => Self::Speed,
            ColourByArg::Synthesis => Self::Synthesis,
            ColourByArg::Density => Self::Density,
        }
    }
}

//! Options of a camera sequence.

use std::path::PathBuf;

use fbcrowd_sim::scenario::{CameraSpec, ShotSpec};
use motiondb::character::Character;

use crate::camera::colour_by::ColourBy;
use crate::passes::{ColourSpace, ExrCompression, PassSet};
use crate::shading::Occlusion;
use crate::top_view::{FrameRange, PictureFormat};
use crate::visibility::SamplePattern;

/// How well frames are drawn.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Quality {
    /// Samples of a pixel: four for previews, sixteen for finals.
    pub samples: SamplePattern,
    /// Whether the sun casts shadows.
    pub shadow: bool,
    /// What is darkened where little sky is seen.
    pub occlusion: Occlusion,
}

impl Default for Quality {
    fn default() -> Self {
        Self { samples: SamplePattern::Four, shadow: true, occlusion: Occlusion::Full }
    }
}

/// Options of a camera sequence.
#[derive(Clone, Debug, Default)]
pub struct CameraOptions {
    /// Output folder; made if missing.
    pub folder: PathBuf,
    /// Name of the sequence: files are called `name.####.png`.
    pub name: String,
    /// File format of the pictures.
    pub format: PictureFormat,
    /// Frames to be drawn; `None` for all.
    pub frames: Option<FrameRange>,
    /// Times and numbers of the frames, instead of the recorded scenario's.
    pub shot: Option<ShotSpec>,
    /// Cameras to choose from, instead of the recorded scenario's.
    pub cameras: Option<Vec<CameraSpec>>,
    /// Width and height of the pictures, pixels, instead of the view's.
    pub size_px: Option<[u32; 2]>,
    /// Name of a camera; by default the scenario's first, or one that frames the crowd.
    pub camera: Option<String>,
    /// The recording's characters, in its order; plain bodies where there are none.
    pub characters: Vec<Character>,
    /// How well frames are drawn.
    pub quality: Quality,
    /// What the colours of clothes show.
    pub colour_by: ColourBy,
    /// Passes beside the picture; EXR only.
    pub passes: PassSet,
    /// Compression of EXR files.
    pub compression: ExrCompression,
    /// Colour space of EXR files.
    pub colour_space: ColourSpace,
    /// Whether a strip with frame, time and camera is drawn below; PNG only.
    pub burn_in: bool,
    /// Whether each agent's id is written over it; PNG only. The view's `labels` turn it on, too.
    pub labels: bool,
}

//! A recording as a sequence of numbered pictures, drawn in parallel.
//!
//! Each picture depends only on the recording and its number. So any part of a sequence, on any number of threads,
//! gives the same files. Each file appears under its name complete or not at all.

use std::fs;
use std::path::{Path, PathBuf};
use std::sync::atomic::{AtomicUsize, Ordering};

use fbcrowd_sim::recording::Recording;
use rayon::prelude::*;

use crate::constraints::constraint_overlay::ConstraintOverlay;
use crate::error::RenderError;
use crate::raster::{exr_frame, png_frame};
use crate::top_view::frame::{FrameBuffers, TopView};
use crate::top_view::frame_range::{FIRST_FRAME, FrameRange};
use crate::top_view::playback::{picture_count, picture_time_s, read_tracks, sample};
use crate::top_view::trails::Tracks;

/// File format of pictures.
///
/// ```
/// assert_eq!(fbcrowd_render::PictureFormat::Exr.extension(), "exr");
/// ```
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum PictureFormat {
    /// PNG: eight bits, sRGB.
    #[default]
    Png,
    /// EXR: half floats, scene-linear.
    Exr,
}

impl PictureFormat {
    /// Extension of file names.
    pub const fn extension(self) -> &'static str {
        match self {
            Self::Png => "png",
            Self::Exr => "exr",
        }
    }
}

/// Options of a sequence.
#[derive(Clone, Debug)]
pub struct SequenceOptions {
    /// Output folder; made if missing.
    pub folder: PathBuf,
    /// Name of the sequence: files are called `name.####.png`.
    pub name: String,
    /// File format of the pictures.
    pub format: PictureFormat,
    /// Frames to be drawn; `None` for all.
    pub frames: Option<FrameRange>,
    /// Indices of agents whose constraints are drawn beside the scene.
    pub constraints_of: Vec<usize>,
}

/// Views that all pictures of a sequence share.
struct SequenceViews<'a> {
    top: TopView<'a>,
    overlay: Option<ConstraintOverlay<'a>>,
}

/// Paths of the pictures that [`render_sequence`] writes with the same options, in order.
///
/// # Errors
/// If no frame is in the range.
pub fn picture_paths(recording: &Recording, options: &SequenceOptions) -> Result<Vec<PathBuf>, RenderError> {
    let numbers = frame_numbers(recording, options.frames.as_ref())?;
    Ok(numbers.into_iter().map(|number| picture_path(options, number)).collect())
}

fn picture_path(options: &SequenceOptions, number: u32) -> PathBuf {
    options.folder.join(format!("{}.{number:04}.{}", options.name, options.format.extension()))
}

/// Renders a recording from above, and returns the files in order. `observer` receives the number of finished frames
/// and of all frames, from any thread.
///
/// # Errors
/// If the view is out of range, no frame is in the range, the recording is damaged, or a file cannot be written.
pub fn render_sequence(
    recording: &Recording,
    options: &SequenceOptions,
    observer: &(dyn Fn(usize, usize) + Sync),
) -> Result<Vec<PathBuf>, RenderError> {
    let numbers = frame_numbers(recording, options.frames.as_ref())?;
    let tracks = read_tracks(recording)?;
    let views = SequenceViews::new(recording, &tracks, &options.constraints_of)?;
    make_folder(&options.folder)?;
    let done = AtomicUsize::new(0);
    numbers
        .par_iter()
        .map_init(
            || views.top.buffers(),
            |buffers, number| {
                let path = render_frame(recording, &views, buffers, options, *number)?;
                observer(done.fetch_add(1, Ordering::Relaxed) + 1, numbers.len());
                Ok(path)
            },
        )
        .collect()
}

impl<'a> SequenceViews<'a> {
    fn new(recording: &'a Recording, tracks: &'a Tracks, constraints_of: &[usize]) -> Result<Self, RenderError> {
        let top = TopView::new(recording.header(), tracks)?;
        let overlay = match constraints_of {
            [] => None,
            agents => Some(ConstraintOverlay::new(recording, top.framing(), agents)?),
        };
        Ok(Self { top, overlay })
    }
}

fn frame_numbers(recording: &Recording, frames: Option<&FrameRange>) -> Result<Vec<u32>, RenderError> {
    if recording.frame_count() == 0 {
        return Err(RenderError::EmptyRecording);
    }
    let count = picture_count(recording);
    frames.map_or_else(|| Ok((FIRST_FRAME..FIRST_FRAME + count).collect()), |frames| frames.clip(count))
}

fn make_folder(folder: &Path) -> Result<(), RenderError> {
    fs::create_dir_all(folder).map_err(|source| RenderError::Folder { folder: folder.to_owned(), source })
}

fn render_frame(
    recording: &Recording,
    views: &SequenceViews<'_>,
    buffers: &mut FrameBuffers,
    options: &SequenceOptions,
    number: u32,
) -> Result<PathBuf, RenderError> {
    let time_s = picture_time_s(recording, number - FIRST_FRAME);
    let agents = sample(recording, time_s)?;
    let scene = views.top.draw(buffers, time_s as f32, &agents);
    let overlaid = views.overlay.as_ref().map(|overlay| overlay.draw(scene, time_s)).transpose()?;
    let pixmap = overlaid.as_ref().unwrap_or(scene);
    let path = picture_path(options, number);
    match options.format {
        PictureFormat::Png => png_frame::write(&path, pixmap)?,
        PictureFormat::Exr => exr_frame::write(&path, pixmap, recording.header().scenario.view.frame_rate_hz)?,
    }
    Ok(path)
}

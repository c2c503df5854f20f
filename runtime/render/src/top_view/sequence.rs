//! A recording as numbered pictures, drawn in parallel.
//!
//! Each picture is a function of the recording and its number alone, so that any share of a sequence, on any number of
//! threads, gives the same files; each appears under its name whole or not at all.

use std::fs;
use std::path::{Path, PathBuf};
use std::sync::atomic::{AtomicUsize, Ordering};

use fbcrowd_sim::recording::Recording;
use rayon::prelude::*;

use crate::constraints::overlay_constraints::ConstraintOverlay;
use crate::error::RenderError;
use crate::raster::{exr_frame, png_frame};
use crate::top_view::frame::{FrameBuffers, TopView};
use crate::top_view::frame_range::{FIRST_FRAME, FrameRange};
use crate::top_view::playback::{picture_count, picture_time_s, read_tracks, sample};
use crate::top_view::trails::Tracks;

/// File format of a sequence.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Format {
    /// Eight bits, sRGB.
    #[default]
    Png,
    /// Half floats, scene-linear.
    Exr,
}

impl Format {
    /// The file name's extension.
    pub const fn extension(self) -> &'static str {
        match self {
            Self::Png => "png",
            Self::Exr => "exr",
        }
    }
}

/// Where a sequence goes and what of it is drawn.
#[derive(Clone, Debug)]
pub struct SequenceOptions {
    /// Made if missing.
    pub folder: PathBuf,
    /// Of the files `name.####.png`.
    pub name: String,
    /// Of the files.
    pub format: Format,
    /// All frames where absent.
    pub frames: Option<FrameRange>,
    /// Agents whose constraints are drawn beside the scene.
    pub constraints_of: Vec<usize>,
}

/// What all pictures of a sequence are drawn with.
struct Views<'a> {
    top: TopView<'a>,
    overlay: Option<ConstraintOverlay<'a>>,
}

/// Renders a recording from above; `progress` hears, from any thread, how many of how many frames are done. Returns the
/// files in order.
///
/// # Errors
/// Where the view or the range is impossible, the recording damaged, or a file cannot be written.
pub fn render_sequence(
    recording: &Recording,
    options: &SequenceOptions,
    progress: &(dyn Fn(usize, usize) + Sync),
) -> Result<Vec<PathBuf>, RenderError> {
    let numbers = numbers(recording, options.frames.as_ref())?;
    let tracks = read_tracks(recording)?;
    let views = Views::new(recording, &tracks, &options.constraints_of)?;
    make_folder(&options.folder)?;
    let done = AtomicUsize::new(0);
    numbers
        .par_iter()
        .map_init(
            || views.top.buffers(),
            |buffers, number| {
                let path = render_frame(recording, &views, buffers, options, *number)?;
                progress(done.fetch_add(1, Ordering::Relaxed) + 1, numbers.len());
                Ok(path)
            },
        )
        .collect()
}

impl<'a> Views<'a> {
    fn new(recording: &'a Recording, tracks: &'a Tracks, constraints_of: &[usize]) -> Result<Self, RenderError> {
        let top = TopView::new(recording.header(), tracks)?;
        let overlay = match constraints_of {
            [] => None,
            agents => Some(ConstraintOverlay::new(recording, top.framing(), agents)?),
        };
        Ok(Self { top, overlay })
    }
}

fn numbers(recording: &Recording, frames: Option<&FrameRange>) -> Result<Vec<u32>, RenderError> {
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
    views: &Views<'_>,
    buffers: &mut FrameBuffers,
    options: &SequenceOptions,
    number: u32,
) -> Result<PathBuf, RenderError> {
    let time_s = picture_time_s(recording, number - FIRST_FRAME);
    let agents = sample(recording, time_s)?;
    let scene = views.top.draw(buffers, time_s as f32, &agents);
    let overlaid = views.overlay.as_ref().map(|overlay| overlay.draw(scene, time_s)).transpose()?;
    let pixmap = overlaid.as_ref().unwrap_or(scene);
    let path = options.folder.join(format!("{}.{number:04}.{}", options.name, options.format.extension()));
    match options.format {
        Format::Png => png_frame::write(&path, pixmap)?,
        Format::Exr => exr_frame::write(&path, pixmap, recording.header().scenario.view.frame_rate_hz)?,
    }
    Ok(path)
}

//! A recording as numbered pictures, drawn in parallel.
//!
//! Each picture is a function of the recording and its number alone, so that any share of a sequence, on any number of
//! threads, gives the same files; each appears under its name whole or not at all.

use std::fs;
use std::path::{Path, PathBuf};
use std::sync::atomic::{AtomicUsize, Ordering};

use fbcrowd_sim::recording::Recording;
use rayon::prelude::*;

use crate::error::RenderError;
use crate::frame_range::{FIRST_FRAME, FrameRange};
use crate::playback::{picture_count, picture_time_s, read_tracks, sample};
use crate::top_view::{FrameBuffers, TopView};
use crate::{exr_frame, png_frame};

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
    let view = TopView::new(recording.header(), &tracks)?;
    make_folder(&options.folder)?;
    let done = AtomicUsize::new(0);
    numbers
        .par_iter()
        .map_init(
            || view.buffers(),
            |buffers, number| {
                let path = render_frame(recording, &view, buffers, options, *number)?;
                progress(done.fetch_add(1, Ordering::Relaxed) + 1, numbers.len());
                Ok(path)
            },
        )
        .collect()
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
    view: &TopView<'_>,
    buffers: &mut FrameBuffers,
    options: &SequenceOptions,
    number: u32,
) -> Result<PathBuf, RenderError> {
    let time_s = picture_time_s(recording, number - FIRST_FRAME);
    let agents = sample(recording, time_s)?;
    let pixmap = view.draw(buffers, time_s as f32, &agents);
    let path = options.folder.join(format!("{}.{number:04}.{}", options.name, options.format.extension()));
    match options.format {
        Format::Png => png_frame::write(&path, pixmap)?,
        Format::Exr => exr_frame::write(&path, pixmap, recording.header().scenario.view.frame_rate_hz)?,
    }
    Ok(path)
}

//! A recording to files of pictures, with progress: what `render` and `run` share.

use std::path::Path;
use std::sync::OnceLock;
use std::time::Instant;

use fbcrowd_render::error::RenderError;
use fbcrowd_render::plots::crowd::trajectories;
use fbcrowd_render::raster::png_frame;
use fbcrowd_render::top_view::{SequenceOptions, read_tracks, render_sequence};
use fbcrowd_sim::recording::Recording;

use crate::failure::Failure;
use crate::progress::Progress;

impl From<RenderError> for Failure {
    fn from(error: RenderError) -> Self {
        Self::bad(error.to_string())
    }
}

/// A finished sequence.
pub(crate) struct Rendered {
    /// Frames written.
    pub(crate) frames: usize,
    /// Milliseconds of the clock a frame, over all threads.
    pub(crate) ms_per_frame: f64,
}

/// Opens a recording.
pub(crate) fn open(path: &Path) -> Result<Recording, Failure> {
    Recording::open(path).map_err(|error| Failure::bad(error.to_string()))
}

/// Renders a sequence.
pub(crate) fn render(recording: &Recording, options: &SequenceOptions) -> Result<Rendered, Failure> {
    let progress = OnceLock::new();
    let start = Instant::now();
    let files = render_sequence(recording, options, &|_, total| {
        progress.get_or_init(|| Progress::new("frames", total)).advance();
    })?;
    let elapsed_ms = start.elapsed().as_secs_f64() * 1000.0;
    if let Some(progress) = progress.into_inner() {
        progress.finish();
    }
    Ok(Rendered { frames: files.len(), ms_per_frame: elapsed_ms / files.len().max(1) as f64 })
}

/// Draws everybody's path on one sheet (the paper's Fig. 7).
pub(crate) fn plot_trajectories(recording: &Recording, path: &Path) -> Result<(), Failure> {
    let tracks = read_tracks(recording)?;
    Ok(png_frame::write(path, &trajectories(recording.header(), &tracks))?)
}

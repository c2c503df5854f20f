//! A recording → files of pictures, or a [`video`], with progress.

pub mod video;

use std::path::{Path, PathBuf};
use std::sync::OnceLock;
use std::time::Instant;
use std::{fs, io};

use fbcrowd_render::camera::{CameraOptions, camera_picture_paths, draw_camera_sequence, render_camera_sequence};
use fbcrowd_render::error::RenderError;
use fbcrowd_render::plots::crowd::{StripOptions, strip_paths, trajectories, write_agent_strips};
use fbcrowd_render::raster::{RgbPicture, png_frame};
use fbcrowd_render::top_view::{
    SequenceOptions, draw_sequence, frame_times, picture_paths, read_tracks, render_sequence,
};
use fbcrowd_sim::recording::Recording;
use fbcrowd_sim::scenario::FrameRate;

use crate::error::JobError;
use crate::observer::{Observer, Work};
use crate::output_path::{LockedFolder, check_files};
use crate::rendering::video::{Video, VideoOptions};

/// A sequence that has been rendered.
pub struct RenderedSequence {
    /// Number of frames that were written.
    pub frames: usize,
    /// Duration per frame, all threads together, ms.
    pub ms_per_frame: f64,
}

impl RenderedSequence {
    /// Both sequences together.
    pub fn and(&self, other: Self) -> Self {
        let frames = self.frames + other.frames;
        let ms = self.ms_per_frame * self.frames as f64 + other.ms_per_frame * other.frames as f64;
        Self { frames, ms_per_frame: ms / frames.max(1) as f64 }
    }
}

/// Opens a recording.
///
/// # Errors
/// If the file cannot be read or is not a valid recording.
pub fn open(path: &Path) -> Result<Recording, JobError> {
    Ok(Recording::open(path)?)
}

/// Checks that a sequence can be written, and that no frame replaces an input. Leaves nothing.
///
/// # Errors
/// Where the options do not fit the recording, a frame would replace an input, or the system does not allow writing.
pub fn check_frames(recording: &Recording, options: &SequenceOptions, inputs: &[PathBuf]) -> Result<(), JobError> {
    check_files(&options.folder, &picture_paths(recording, options)?, inputs)
}

/// As [`check_frames`], for a recording that does not exist yet: checks the frames of earlier runs, which
/// [`remove_frames`] would remove.
///
/// # Errors
/// As [`check_frames`].
pub fn check_old_frames(folder: &Path, name: &str, inputs: &[PathBuf]) -> Result<(), JobError> {
    check_files(folder, &numbered_frames(folder, name)?, inputs)
}

/// Renders a sequence of frames.
///
/// # Errors
/// If the options do not fit the recording, or a frame cannot be read or written.
pub fn render(
    recording: &Recording,
    options: &SequenceOptions,
    observer: &Observer,
) -> Result<RenderedSequence, JobError> {
    watched(observer, |progress| Ok::<_, RenderError>(render_sequence(recording, options, progress)?.len()))
}

/// As [`check_frames`], for frames of a camera.
///
/// # Errors
/// As [`check_frames`]; and where the camera does not exist.
pub fn check_camera_frames(recording: &Recording, options: &CameraOptions, inputs: &[PathBuf]) -> Result<(), JobError> {
    check_files(&options.folder, &camera_picture_paths(recording, options)?, inputs)
}

/// Renders a sequence of frames from a camera.
///
/// # Errors
/// As [`render`]; and where the camera is inside a body, or its agent is not present.
pub fn render_camera(
    recording: &Recording,
    options: &CameraOptions,
    observer: &Observer,
) -> Result<RenderedSequence, JobError> {
    watched(observer, |progress| Ok::<_, RenderError>(render_camera_sequence(recording, options, progress)?.len()))
}

/// Draws strips of single agents, and returns the files; none of them replaces an input.
///
/// # Errors
/// As [`check_frames`] and [`render`]; and where an agent does not exist or is not present.
pub fn render_strips(
    recording: &Recording,
    options: &StripOptions,
    inputs: &[PathBuf],
) -> Result<Vec<PathBuf>, JobError> {
    check_files(&options.folder, &strip_paths(recording, options), inputs)?;
    let _lock = LockedFolder::shared(&options.folder)?;
    Ok(write_agent_strips(recording, options)?)
}

/// Renders a recording from above into a video.
///
/// # Errors
/// As [`render`]; or where ffmpeg is not installed, or fails.
pub fn render_video(
    recording: &Recording,
    options: &SequenceOptions,
    video: &VideoOptions,
    observer: &Observer,
) -> Result<RenderedSequence, JobError> {
    let rate = frame_times(recording, options.shot.as_ref()).rate;
    watched(observer, |progress| into_video(video, rate, |show| draw_sequence(recording, options, progress, show)))
}

/// Renders a recording from a camera into a video.
///
/// # Errors
/// As [`render_camera`]; or where ffmpeg is not installed, or fails.
pub fn render_camera_video(
    recording: &Recording,
    options: &CameraOptions,
    video: &VideoOptions,
    observer: &Observer,
) -> Result<RenderedSequence, JobError> {
    let rate = frame_times(recording, options.shot.as_ref()).rate;
    watched(observer, |progress| {
        into_video(video, rate, |show| draw_camera_sequence(recording, options, progress, show))
    })
}

/// Passes all pictures that are drawn to a video, and returns their number.
fn into_video(
    options: &VideoOptions,
    rate: FrameRate,
    draw: impl FnOnce(&mut dyn FnMut(RgbPicture) -> Result<(), JobError>) -> Result<usize, JobError>,
) -> Result<usize, JobError> {
    let mut video: Option<Video> = None;
    let mut show = |picture: RgbPicture| {
        let begun = match video.take() {
            Some(begun) => begun,
            None => Video::begin(options, picture.size_px, rate)?,
        };
        video.insert(begun).push(&picture)
    };
    let frames = draw(&mut show)?;
    video.map_or(Ok(()), Video::finish)?;
    Ok(frames)
}

/// Renders a sequence and returns its number of frames, with its progress and duration.
fn watched<E: Into<JobError>>(
    observer: &Observer,
    render: impl FnOnce(&(dyn Fn(usize, usize) + Sync)) -> Result<usize, E>,
) -> Result<RenderedSequence, JobError> {
    // The number of frames is known with the first one.
    let work = OnceLock::new();
    let start = Instant::now();
    let frames = render(&|_, total| {
        work.get_or_init(|| Work::begin(observer, "frames", total)).advance();
    })
    .map_err(Into::into)?;
    let elapsed_ms = start.elapsed().as_secs_f64() * 1000.0;
    if let Some(work) = work.into_inner() {
        work.end();
    }
    Ok(RenderedSequence { frames, ms_per_frame: elapsed_ms / frames.max(1) as f64 })
}

/// Removes the PNG frames that an earlier run left under a sequence's name: they would follow the last new frame.
///
/// # Errors
/// If the system does not allow it.
pub fn remove_frames(folder: &Path, name: &str) -> Result<(), JobError> {
    let remove = |path: &PathBuf| fs::remove_file(path).map_err(|error| JobError::unwritable(path, error));
    numbered_frames(folder, name)?.iter().try_for_each(remove)
}

/// Every `NAME.####.png` of a folder; none where the folder does not exist.
fn numbered_frames(folder: &Path, name: &str) -> Result<Vec<PathBuf>, JobError> {
    let is_frame = |file: &str| {
        let number = file.strip_prefix(&format!("{name}.")).and_then(|rest| rest.strip_suffix(".png"));
        number.is_some_and(|number| number.len() >= 4 && number.bytes().all(|byte| byte.is_ascii_digit()))
    };
    let Ok(entries) = fs::read_dir(folder) else { return Ok(Vec::new()) };
    let entries = entries.collect::<io::Result<Vec<_>>>();
    let entries = entries.map_err(|error| JobError::unwritable(folder, error))?;
    let frames = entries.into_iter().filter(|entry| entry.file_name().to_str().is_some_and(is_frame));
    Ok(frames.map(|entry| entry.path()).collect())
}

/// Draws the paths of all agents on one sheet (Fig. 7).
///
/// # Errors
/// If a frame cannot be read, or the picture cannot be written.
pub fn plot_trajectories(recording: &Recording, path: &Path) -> Result<(), JobError> {
    let tracks = read_tracks(recording)?;
    Ok(png_frame::write(path, &trajectories(recording.header(), &tracks))?)
}

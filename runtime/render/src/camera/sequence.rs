//! A recording as numbered frames of a camera. Only the requested frames are read, and a few for framing and smoothing.
//!
//! Each frame depends only on the recording and its number, so that any part of a sequence, on any number of threads, gives
//! the same files.

use std::path::PathBuf;
use std::sync::atomic::{AtomicUsize, Ordering};

use fbcrowd_sim::recording::Recording;
use motiondb::memory;
use rayon::prelude::*;

use crate::camera::exr_passes;
use crate::camera::memory_need::frame_bytes;
use crate::camera::options::CameraOptions;
use crate::camera::take::{Take, find_camera};
use crate::error::RenderError;
use crate::raster::png_frame::{self, RgbPicture, rgb_picture};
use crate::top_view::sequence::{PictureFormat, frame_numbers, frame_times, make_folder};

/// Greatest number of bytes of all frames that are drawn at once.
const AT_ONCE_BYTES: usize = 1 << 30;

/// Paths of the pictures that [`render_camera_sequence`] writes with the same options, in order.
///
/// # Errors
/// If no frame is in the range, or the camera does not exist.
pub fn camera_picture_paths(recording: &Recording, options: &CameraOptions) -> Result<Vec<PathBuf>, RenderError> {
    let numbers = numbers(recording, options)?;
    Ok(numbers.into_iter().map(|number| picture_path(options, number)).collect())
}

/// Numbers of the requested frames.
fn numbers(recording: &Recording, options: &CameraOptions) -> Result<Vec<u32>, RenderError> {
    find_camera(recording, options)?;
    let times = frame_times(recording, options.shot.as_ref());
    frame_numbers(recording, &times, options.frames.as_ref())
}

fn picture_path(options: &CameraOptions, number: u32) -> PathBuf {
    options.folder.join(format!("{}.{number:04}.{}", options.name, options.format.extension()))
}

/// Renders frames of a recording from a camera, and returns the files in order. `observer` receives the number of
/// finished frames and of all frames, from any thread.
///
/// # Errors
/// If the camera does not exist or is inside a body, no frame is in the range, the recording is damaged, or a file cannot
/// be written.
pub fn render_camera_sequence(
    recording: &Recording,
    options: &CameraOptions,
    observer: &(dyn Fn(usize, usize) + Sync),
) -> Result<Vec<PathBuf>, RenderError> {
    let numbers = numbers(recording, options)?;
    let take = Take::new(recording, options)?;
    let at_once = at_once(&take, &numbers)?;
    make_folder(&options.folder)?;
    let done = AtomicUsize::new(0);
    let render = |number: &u32| {
        let path = picture_path(options, *number);
        match options.format {
            PictureFormat::Exr => exr_passes::write(&take, &path, *number)?,
            PictureFormat::Png => png_frame::write(&path, &take.picture(*number)?)?,
        }
        observer(done.fetch_add(1, Ordering::Relaxed) + 1, numbers.len());
        Ok(path)
    };
    let mut paths = Vec::with_capacity(numbers.len());
    for numbers in numbers.chunks(at_once) {
        // In order: the error is that of the first frame that fails, whichever thread is faster.
        let rendered: Vec<Result<PathBuf, RenderError>> = numbers.par_iter().map(render).collect();
        for path in rendered {
            paths.push(path?);
        }
    }
    Ok(paths)
}

/// Draws frames of a recording from a camera, and passes them to a function in order. Returns their number.
///
/// # Errors
/// As [`render_camera_sequence`]; or where the function fails.
pub fn draw_camera_sequence<E: From<RenderError>>(
    recording: &Recording,
    options: &CameraOptions,
    observer: &(dyn Fn(usize, usize) + Sync),
    mut show: impl FnMut(RgbPicture) -> Result<(), E>,
) -> Result<usize, E> {
    let numbers = numbers(recording, options)?;
    let take = Take::new(recording, options)?;
    let at_once = at_once(&take, &numbers)?;
    let mut done = 0;
    for chunk in numbers.chunks(at_once) {
        let draw = |number: &u32| -> Result<RgbPicture, RenderError> { rgb_picture(&mut &take.picture(*number)?) };
        let pictures: Vec<Result<RgbPicture, RenderError>> = chunk.par_iter().map(draw).collect();
        for picture in pictures {
            show(picture?)?;
            done += 1;
            observer(done, numbers.len());
        }
    }
    Ok(done)
}

/// Number of frames that are drawn at once.
///
/// # Errors
/// If the system does not give the memory that they need.
fn at_once(take: &Take<'_>, numbers: &[u32]) -> Result<usize, RenderError> {
    let frame_bytes = frame_bytes(take, numbers);
    let at_once = (AT_ONCE_BYTES / frame_bytes).clamp(1, rayon::current_num_threads()).min(numbers.len());
    if !memory::has_room(at_once * frame_bytes) {
        return Err(RenderError::OutOfMemory { mib: (at_once * frame_bytes) >> 20 });
    }
    Ok(at_once)
}

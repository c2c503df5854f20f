//! A recording as a sequence of numbered pictures, drawn in parallel.
//!
//! Each picture depends only on the recording and its number. So any part of a sequence, on any number of threads,
//! gives the same files. Each file appears under its name complete or not at all.

use std::fs;
use std::path::{Path, PathBuf};
use std::sync::atomic::{AtomicUsize, Ordering};

use fbcrowd_sim::recording::{FrameTimes, Recording, duration_s, sample};
use fbcrowd_sim::scenario::ShotSpec;
use motiondb::memory;
use rayon::prelude::*;
use tiny_skia::Pixmap;

use crate::constraints::constraint_overlay::ConstraintOverlay;
use crate::error::RenderError;
use crate::raster::exr_frame;
use crate::raster::exr_frame::FrameLabel;
use crate::raster::png_frame::{self, RgbPicture, rgb_picture};
use crate::raster::strips::PictureStrips;
use crate::top_view::frame::{FrameBuffers, STRIP_PIXELS, TopView};
use crate::top_view::frame_range::FrameRange;
use crate::top_view::playback::read_tracks_between;
use crate::top_view::trails::Tracks;

/// Bytes of the background for each pixel, while the shade of obstacles is drawn on it.
const BACKGROUND_BYTES: usize = 6;
/// Bytes of a frame for each pixel as it is encoded: its colours.
const COLOUR_BYTES: usize = 3;
/// Bytes of a strip for each pixel: colours, height and shade.
const STRIP_PIXEL_BYTES: usize = 9;
/// Greatest number of bytes of a strip.
const STRIP_BYTES: usize = STRIP_PIXEL_BYTES * STRIP_PIXELS as usize;
/// Bytes that a whole frame takes for each of its pixels: the scene, the scene with marks, the picture, its colours.
const WHOLE_FRAME_BYTES: usize = 16;
/// Greatest number of bytes of all whole frames that are drawn at once.
const WHOLE_FRAMES_BYTES: usize = 1 << 30;

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
    /// Times and numbers of the frames, instead of the recorded scenario's.
    pub shot: Option<ShotSpec>,
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
    let times = frame_times(recording, options.shot.as_ref());
    let numbers = frame_numbers(recording, &times, options.frames.as_ref())?;
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
    let times = frame_times(recording, options.shot.as_ref());
    let numbers = frame_numbers(recording, &times, options.frames.as_ref())?;
    check_memory(recording, &numbers, !options.constraints_of.is_empty())?;
    let tracks = tracks_of(recording, &times, &numbers)?;
    let views = SequenceViews::new(recording, &tracks, &options.constraints_of)?;
    make_folder(&options.folder)?;
    let done = AtomicUsize::new(0);
    let render = |buffers: &mut FrameBuffers, number: &u32| {
        let path = render_frame(recording, &views, buffers, options, (*number, &times))?;
        observer(done.fetch_add(1, Ordering::Relaxed) + 1, numbers.len());
        Ok(path)
    };
    let mut paths = Vec::new();
    for numbers in numbers.chunks(views.most_at_once().unwrap_or(numbers.len())) {
        let rendered = numbers.par_iter().map_init(|| views.top.strip_buffers(), render);
        paths.extend(rendered.collect::<Result<Vec<PathBuf>, RenderError>>()?);
    }
    Ok(paths)
}

/// Draws frames of a recording from above, and passes them to a function in order. Returns their number.
///
/// # Errors
/// As [`render_sequence`]; or where the function fails.
pub fn draw_sequence<E: From<RenderError>>(
    recording: &Recording,
    options: &SequenceOptions,
    observer: &(dyn Fn(usize, usize) + Sync),
    mut show: impl FnMut(RgbPicture) -> Result<(), E>,
) -> Result<usize, E> {
    let times = frame_times(recording, options.shot.as_ref());
    let numbers = frame_numbers(recording, &times, options.frames.as_ref())?;
    check_memory(recording, &numbers, true)?;
    let tracks = tracks_of(recording, &times, &numbers)?;
    let views = SequenceViews::new(recording, &tracks, &options.constraints_of)?;
    let at_once = views.most_at_once().unwrap_or(numbers.len()).min(rayon::current_num_threads());
    let draw = |buffers: &mut FrameBuffers, number: &u32| -> Result<RgbPicture, RenderError> {
        let time_s = times.time_s(*number);
        let agents = sample(recording, time_s)?;
        let mut strips = views.top.strips(buffers, time_s as f32, &agents);
        match &views.overlay {
            None => rgb_picture(&mut strips),
            Some(overlay) => rgb_picture(&mut &overlay.draw(&whole(&mut strips), time_s)?),
        }
    };
    let mut done = 0;
    for chunk in numbers.chunks(at_once.max(1)) {
        let pictures = chunk.par_iter().map_init(|| views.top.strip_buffers(), draw).collect::<Result<Vec<_>, _>>()?;
        for picture in pictures {
            show(picture)?;
            done += 1;
            observer(done, numbers.len());
        }
    }
    Ok(done)
}

/// The tracks that frames show, ascending.
fn tracks_of(recording: &Recording, times: &FrameTimes, numbers: &[u32]) -> Result<Tracks, RenderError> {
    let [first, last] = [numbers.first(), numbers.last()].map(|number| number.map_or(0.0, |at| times.time_s(*at)));
    let trail_s = f64::from(recording.header().scenario.view.trail_s);
    read_tracks_between(recording, [first - trail_s, last])
}

/// Checks that the system gives the memory that the frames need: the background and the shade of obstacles once; for
/// each thread a strip and the colours of a frame, or whole frames.
fn check_memory(recording: &Recording, numbers: &[u32], has_overlay: bool) -> Result<(), RenderError> {
    let view = &recording.header().scenario.view;
    let pixels = view.width as usize * view.height as usize;
    let threads = rayon::current_num_threads().min(numbers.len());
    let at_once = if has_overlay {
        WHOLE_FRAMES_BYTES.min(threads * WHOLE_FRAME_BYTES * pixels).max(WHOLE_FRAME_BYTES * pixels)
    } else {
        threads * (COLOUR_BYTES * pixels + STRIP_BYTES.min(STRIP_PIXEL_BYTES * pixels))
    };
    let bytes = BACKGROUND_BYTES * pixels + at_once;
    if memory::has_room(bytes) { Ok(()) } else { Err(RenderError::OutOfMemory { mib: bytes >> 20 }) }
}

impl<'a> SequenceViews<'a> {
    fn new(recording: &'a Recording, tracks: &'a Tracks, constraints_of: &[usize]) -> Result<Self, RenderError> {
        let top = TopView::new(recording.header(), tracks)?.with_doors(recording.population());
        let overlay = match constraints_of {
            [] => None,
            agents => Some(ConstraintOverlay::new(recording, top.framing(), agents)?),
        };
        Ok(Self { top, overlay })
    }

    /// Greatest number of frames that are drawn at once; none where any number may be. A frame with an overlay is drawn
    /// as a whole.
    fn most_at_once(&self) -> Option<usize> {
        let frame_bytes = WHOLE_FRAME_BYTES * self.overlay.as_ref()?.pixel_count();
        let at_once = (WHOLE_FRAMES_BYTES / frame_bytes.max(1)).max(1);
        (at_once < rayon::current_num_threads()).then_some(at_once)
    }
}

/// The shot that options state, else that of the recorded scenario, else one from its start at its view's frame rate.
pub(crate) fn shot_of(recording: &Recording, stated: Option<&ShotSpec>) -> ShotSpec {
    stated.or(recording.header().scenario.shot.as_ref()).cloned().unwrap_or_default()
}

/// Whether options or the recorded scenario state a shot.
pub(crate) fn is_shot_stated(recording: &Recording, stated: Option<&ShotSpec>) -> bool {
    stated.is_some() || recording.header().scenario.shot.is_some()
}

/// Times and numbers of all frames of a recording.
pub fn frame_times(recording: &Recording, stated: Option<&ShotSpec>) -> FrameTimes {
    FrameTimes::of(&shot_of(recording, stated), &recording.header().scenario)
}

pub(crate) fn frame_numbers(
    recording: &Recording,
    times: &FrameTimes,
    frames: Option<&FrameRange>,
) -> Result<Vec<u32>, RenderError> {
    if recording.frame_count() == 0 {
        return Err(RenderError::EmptyRecording);
    }
    let duration_s = duration_s(recording);
    let (first, count) = (times.first_frame, times.count(duration_s));
    if count == 0 {
        return Err(RenderError::NothingAfterPreroll { preroll_s: times.start_s, duration_s });
    }
    frames.map_or_else(|| Ok((first..first + count).collect()), |frames| frames.clip(first, count))
}

pub(crate) fn make_folder(folder: &Path) -> Result<(), RenderError> {
    fs::create_dir_all(folder).map_err(|source| RenderError::Folder { folder: folder.to_owned(), source })
}

fn render_frame(
    recording: &Recording,
    views: &SequenceViews<'_>,
    buffers: &mut FrameBuffers,
    options: &SequenceOptions,
    (number, times): (u32, &FrameTimes),
) -> Result<PathBuf, RenderError> {
    let time_s = times.time_s(number);
    let agents = sample(recording, time_s)?;
    let path = picture_path(options, number);
    let is_stated = is_shot_stated(recording, options.shot.as_ref());
    let label = FrameLabel { rate: times.rate, moment: is_stated.then_some((number, time_s)) };
    let mut strips = views.top.strips(buffers, time_s as f32, &agents);
    match &views.overlay {
        None => write(&path, &mut strips, options.format, &label)?,
        Some(overlay) => {
            let picture = overlay.draw(&whole(&mut strips), time_s)?;
            write(&path, &mut &picture, options.format, &label)?;
        }
    }
    Ok(path)
}

fn write(
    path: &Path,
    picture: &mut impl PictureStrips,
    format: PictureFormat,
    label: &FrameLabel,
) -> Result<(), RenderError> {
    match format {
        PictureFormat::Png => png_frame::write_strips(path, picture),
        PictureFormat::Exr => exr_frame::write(path, picture, label),
    }
}

/// All strips as one picture.
fn whole(strips: &mut impl PictureStrips) -> Pixmap {
    let [width, height] = strips.size_px();
    let mut picture = Pixmap::new(width, height).expect("the framing's sides are checked");
    for top_px in (0..height).step_by(strips.strip_rows() as usize) {
        strips.draw(top_px);
        let left = &mut picture.pixels_mut()[(top_px * width) as usize..];
        let shown = left.len().min(strips.pixels().len());
        left[..shown].copy_from_slice(&strips.pixels()[..shown]);
    }
    picture
}

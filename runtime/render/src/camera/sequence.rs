//! A recording as numbered frames of a camera. Only the requested frames are read, and a few for framing and smoothing.
//!
//! Each frame depends only on the recording and its number, so that any part of a sequence, on any number of threads, gives
//! the same files.

use std::path::PathBuf;
use std::sync::atomic::{AtomicUsize, Ordering};

use fbcrowd_sim::recording::{AgentFrame, Recording};
use fbcrowd_sim::scenario::CameraSpec;
use glam::Vec3;
use motiondb::memory;
use rayon::prelude::*;

use crate::camera::captions::CameraCaptions;
use crate::camera::default_camera::{DEFAULT_NAME, default_camera};
use crate::camera::exr_passes;
use crate::camera::options::CameraOptions;
use crate::camera::placement::lens_at;
use crate::camera::view::{CameraView, Shot};
use crate::error::RenderError;
use crate::passes::tile_passes::channels;
use crate::raster::png_frame;
use crate::shading::LinearPicture;
use crate::top_view::frame_range::FIRST_FRAME;
use crate::top_view::playback::{picture_time_s, sample};
use crate::top_view::sequence::{PictureFormat, frame_numbers, make_folder};

/// Bytes of a frame for each pixel while it is drawn and encoded.
const PIXEL_BYTES: usize = 24;
/// Bytes of each channel of a pass, for each pixel: values of tiles, of the frame, and in the file.
const PASS_BYTES: usize = 12;
/// Bytes of a frame for its parts and its shadow map.
const FRAME_BYTES: usize = 160 << 20;
/// Greatest number of bytes of all frames that are drawn at once.
const AT_ONCE_BYTES: usize = 1 << 30;
/// Distance from the middle of a body, on the ground and in height, within which an eye is inside it, m.
const INSIDE_M: [f32; 2] = [0.22, 1.8];

/// Paths of the pictures that [`render_camera_sequence`] writes with the same options, in order.
///
/// # Errors
/// If no frame is in the range, or the camera does not exist.
pub fn camera_picture_paths(recording: &Recording, options: &CameraOptions) -> Result<Vec<PathBuf>, RenderError> {
    find_camera(recording, options)?;
    let numbers = frame_numbers(recording, options.frames.as_ref())?;
    Ok(numbers.into_iter().map(|number| picture_path(options, number)).collect())
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
    let numbers = frame_numbers(recording, options.frames.as_ref())?;
    let camera = match find_camera(recording, options)? {
        Some(camera) => camera.clone(),
        None => default_camera(recording)?,
    };
    let view = &recording.header().scenario.view;
    let size_px = options.size_px.unwrap_or([view.width, view.height]);
    let passes = channels(&options.passes, options.quality.samples.count()).len();
    let pixel_bytes = PIXEL_BYTES + PASS_BYTES * passes;
    let frame_bytes = FRAME_BYTES + pixel_bytes * size_px[0] as usize * size_px[1] as usize;
    let at_once = (AT_ONCE_BYTES / frame_bytes).clamp(1, rayon::current_num_threads()).min(numbers.len());
    if !memory::has_room(at_once * frame_bytes) {
        return Err(RenderError::OutOfMemory { mib: (at_once * frame_bytes) >> 20 });
    }
    let sequence = CameraSequence {
        recording,
        options,
        view: CameraView::new(recording.header(), recording.population(), options.quality, options.colour_by)
            .with_characters(&options.characters),
        captions: CameraCaptions::new(size_px),
        camera,
        size_px,
    };
    make_folder(&options.folder)?;
    let done = AtomicUsize::new(0);
    let render = |number: &u32| {
        let path = sequence.render(*number)?;
        observer(done.fetch_add(1, Ordering::Relaxed) + 1, numbers.len());
        Ok(path)
    };
    let mut paths = Vec::with_capacity(numbers.len());
    for numbers in numbers.chunks(at_once) {
        paths.extend(numbers.par_iter().map(render).collect::<Result<Vec<PathBuf>, RenderError>>()?);
    }
    Ok(paths)
}

/// The camera of a name; without a name, the scenario's first; none where it is to be made.
fn find_camera<'a>(
    recording: &'a Recording,
    options: &'a CameraOptions,
) -> Result<Option<&'a CameraSpec>, RenderError> {
    let cameras = options.cameras.as_ref().unwrap_or(&recording.header().scenario.cameras);
    let Some(name) = options.camera.as_deref() else { return Ok(cameras.first()) };
    match cameras.iter().find(|camera| camera.name == name) {
        Some(camera) => Ok(Some(camera)),
        None if name == DEFAULT_NAME => Ok(None),
        None => {
            let names = cameras.iter().map(|camera| camera.name.as_str()).chain([DEFAULT_NAME]);
            let cameras = names.collect::<Vec<_>>().join(", ");
            Err(RenderError::NoSuchCamera { name: name.to_owned(), cameras })
        }
    }
}

/// What all frames of a sequence share.
struct CameraSequence<'a> {
    recording: &'a Recording,
    options: &'a CameraOptions,
    view: CameraView<'a>,
    captions: CameraCaptions,
    camera: CameraSpec,
    size_px: [u32; 2],
}

impl CameraSequence<'_> {
    fn render(&self, number: u32) -> Result<PathBuf, RenderError> {
        let time_s = picture_time_s(self.recording, number - FIRST_FRAME);
        let agents = sample(self.recording, time_s)?;
        let lens = lens_at(self.recording, &self.camera, self.size_px, time_s)?;
        let shot = Shot { lens, time_s, eyes_of: self.camera.eyes_of, fog_m: self.camera.fog_m };
        let agents = self.outside_eye(agents, lens.eye_m, number)?;
        let path = picture_path(self.options, number);
        match self.options.format {
            PictureFormat::Exr => {
                let lens_at = |time_s| lens_at(self.recording, &self.camera, self.size_px, time_s);
                exr_passes::write(&path, self.recording, &self.view, self.options, (&shot, &agents, number), lens_at)?;
            }
            PictureFormat::Png => self.write_png(&path, &self.view.draw(&shot, &agents), &shot, &agents, number)?,
        }
        Ok(path)
    }

    /// The agents that do not hold the eye. The default camera looks through those that walk into it.
    fn outside_eye(&self, agents: Vec<AgentFrame>, eye_m: Vec3, frame: u32) -> Result<Vec<AgentFrame>, RenderError> {
        let holds_eye = |agent: &AgentFrame| {
            let is_own = Some(agent.id.0) == self.camera.eyes_of;
            let on_ground_m = agent.root.position_m.distance(eye_m.truncate());
            !is_own && on_ground_m < INSIDE_M[0] && (0.0..INSIDE_M[1]).contains(&eye_m.z)
        };
        if self.camera.name == DEFAULT_NAME || self.camera.eyes_of.is_some() {
            return Ok(agents.into_iter().filter(|agent| !holds_eye(agent)).collect());
        }
        match agents.iter().find(|agent| holds_eye(agent)) {
            Some(agent) => Err(RenderError::EyeInside { camera: self.camera.name.clone(), agent: agent.id.0, frame }),
            None => Ok(agents),
        }
    }

    fn write_png(
        &self,
        path: &std::path::Path,
        picture: &LinearPicture,
        shot: &Shot,
        agents: &[AgentFrame],
        number: u32,
    ) -> Result<(), RenderError> {
        let scenario = &self.recording.header().scenario;
        let mut pixmap = picture.to_display();
        if self.options.labels || scenario.view.labels {
            self.captions.draw_labels(&mut pixmap, &shot.lens, agents);
        }
        if self.options.burn_in {
            let [frame, time] = [format!("{} {number}", scenario.name), format!("{:.2} s", shot.time_s)];
            let lens = self.camera.focal_mm.map_or(String::new(), |focal_mm| format!(" · {focal_mm} mm"));
            self.captions.draw_strip(&mut pixmap, [&frame, &time, &format!("{}{lens}", self.camera.name)]);
        }
        png_frame::write(path, &pixmap)
    }
}

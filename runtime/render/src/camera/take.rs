//! A recording as a camera films it: lens and agents at any time. World, metres, seconds.

use fbcrowd_sim::recording::{
    AgentFrame, ExtraFrame, FrameTimes, Recording, RecordingError, duration_s, sample, sample_extra,
};
use fbcrowd_sim::scenario::{CameraSpec, ShotSpec};
use glam::Vec3;
use tiny_skia::Pixmap;

use crate::camera::blocks::solid_at;
use crate::camera::captions::CameraCaptions;
use crate::camera::default_camera::{DEFAULT_NAME, default_camera};
use crate::camera::options::CameraOptions;
use crate::camera::placement::lens_at;
use crate::camera::view::{CameraView, Shot};
use crate::error::RenderError;
use crate::shading::LinearPicture;
use crate::shading::linear_picture::LinearSum;
use crate::top_view::sequence::{frame_times, is_shot_stated, shot_of};
use crate::visibility::Lens;

/// Distance from the middle of a body, on the ground and in height, within which an eye is inside it, m.
const INSIDE_M: [f32; 2] = [0.22, 1.8];

/// What all frames of a sequence share.
pub(crate) struct Take<'a> {
    pub(crate) recording: &'a Recording,
    pub(crate) options: &'a CameraOptions,
    pub(crate) view: CameraView<'a>,
    pub(crate) times: FrameTimes,
    /// Whether options or scenario state a shot.
    pub(crate) is_shot_stated: bool,
    shot: ShotSpec,
    captions: CameraCaptions,
    camera: CameraSpec,
    pub(crate) size_px: [u32; 2],
}

/// One moment of a take.
pub(crate) struct Moment {
    pub(crate) shot: Shot,
    /// The agents that do not hold the eye.
    pub(crate) agents: Vec<AgentFrame>,
    /// The extra joints of all agents.
    pub(crate) extra: ExtraFrame,
}

impl<'a> Take<'a> {
    /// The take of the camera that the options name.
    ///
    /// # Errors
    /// If the camera does not exist, or a frame cannot be read.
    pub(crate) fn new(recording: &'a Recording, options: &'a CameraOptions) -> Result<Self, RenderError> {
        let times = frame_times(recording, options.shot.as_ref());
        let size_px = size_px(recording, options);
        let camera = match find_camera(recording, options)? {
            Some(camera) if camera.gltf.is_some() => {
                return Err(RenderError::UnreadCamera { camera: camera.name.clone() });
            }
            Some(camera) => camera.clone(),
            None => default_camera(recording, times.start_s, size_px)?,
        };
        let view = CameraView::new(recording.header(), recording.population(), options.quality, options.colour_by);
        Ok(Self {
            recording,
            options,
            view: view.with_characters(&options.characters),
            times,
            is_shot_stated: is_shot_stated(recording, options.shot.as_ref()),
            shot: shot_of(recording, options.shot.as_ref()),
            captions: CameraCaptions::new(size_px),
            camera,
            size_px,
        })
    }

    /// Whether frames blend several moments.
    pub(crate) fn is_blurred(&self) -> bool {
        self.shot.samples_per_frame > 1
    }

    /// Times that a frame blends, s.
    pub(crate) fn moments_s(&self, number: u32) -> Vec<f64> {
        self.times.moments_s(number, &self.shot, duration_s(self.recording))
    }

    /// Lens and agents at a time; `number` is the frame that errors name.
    pub(crate) fn moment(&self, time_s: f64, number: u32) -> Result<Moment, RenderError> {
        let agents = self.agents_at(time_s)?;
        let lens = self.lens_at(time_s)?;
        let shot = Shot { lens, time_s, eyes_of: self.camera.eyes_of, fog_m: self.camera.fog_m };
        Ok(Moment { agents: self.outside_eye(agents, lens.eye_m, number)?, extra: self.extra_at(time_s)?, shot })
    }

    /// All agents at a time.
    pub(crate) fn agents_at(&self, time_s: f64) -> Result<Vec<AgentFrame>, RecordingError> {
        sample(self.recording, time_s)
    }

    /// The extra joints of all agents at a time; none where no characters show them.
    pub(crate) fn extra_at(&self, time_s: f64) -> Result<ExtraFrame, RecordingError> {
        if self.options.characters.is_empty() {
            return Ok(ExtraFrame::default());
        }
        sample_extra(self.recording, time_s)
    }

    /// The lens at a time.
    pub(crate) fn lens_at(&self, time_s: f64) -> Result<Lens, RenderError> {
        lens_at(self.recording, &self.camera, self.size_px, time_s)
    }

    /// A frame for display, with its captions, which show its own time.
    pub(crate) fn picture(&self, number: u32) -> Result<Pixmap, RenderError> {
        let Moment { shot, agents, extra } = self.moment(self.times.time_s(number), number)?;
        let picture = match self.moments_s(number)[..] {
            [_] => self.view.draw(&shot, &agents, &extra),
            ref moments_s => self.mean_picture(moments_s, number)?,
        };
        let mut pixmap = picture.to_display();
        self.draw_captions(&mut pixmap, &shot, &agents, number);
        Ok(pixmap)
    }

    /// The mean light of all moments.
    fn mean_picture(&self, moments_s: &[f64], number: u32) -> Result<LinearPicture, RenderError> {
        let mut sum = LinearSum::default();
        for time_s in moments_s {
            let Moment { shot, agents, extra } = self.moment(*time_s, number)?;
            sum.add(&self.view.draw(&shot, &agents, &extra));
        }
        Ok(sum.mean())
    }

    /// The agents that do not hold the eye. The default camera looks through those that walk into it; the eye of another
    /// one must be in the open.
    fn outside_eye(&self, agents: Vec<AgentFrame>, eye_m: Vec3, frame: u32) -> Result<Vec<AgentFrame>, RenderError> {
        let holds_eye = |agent: &AgentFrame| {
            let is_own = Some(agent.id.0) == self.camera.eyes_of;
            let on_ground_m = agent.root.position_m.distance(eye_m.truncate());
            !is_own && on_ground_m < INSIDE_M[0] && (0.0..INSIDE_M[1]).contains(&eye_m.z)
        };
        if self.camera.name == DEFAULT_NAME || self.camera.eyes_of.is_some() {
            return Ok(agents.into_iter().filter(|agent| !holds_eye(agent)).collect());
        }
        let in_agent = agents.iter().find(|agent| holds_eye(agent)).map(|agent| format!("inside agent {}", agent.id.0));
        match in_agent.or_else(|| solid_at(&self.recording.header().scenario, eye_m).map(str::to_owned)) {
            Some(place) => Err(RenderError::EyeInside { camera: self.camera.name.clone(), eye_m, place, frame }),
            None => Ok(agents),
        }
    }

    fn draw_captions(&self, pixmap: &mut Pixmap, shot: &Shot, agents: &[AgentFrame], number: u32) {
        let scenario = &self.recording.header().scenario;
        if self.options.labels || scenario.view.labels {
            self.captions.draw_labels(pixmap, &shot.lens, agents);
        }
        if self.options.burn_in {
            let [frame, time] = [format!("{} {number}", scenario.name), format!("{:.2} s", shot.time_s)];
            let lens = self.camera.focal_mm.map_or(String::new(), |focal_mm| format!(" · {focal_mm} mm"));
            self.captions.draw_strip(pixmap, [&frame, &time, &format!("{}{lens}", self.camera.name)]);
        }
    }
}

/// Width and height of the pictures, pixels.
fn size_px(recording: &Recording, options: &CameraOptions) -> [u32; 2] {
    let view = &recording.header().scenario.view;
    options.size_px.unwrap_or([view.width, view.height])
}

/// The camera of a name; without a name, the scenario's first; none where it is to be made.
pub(crate) fn find_camera<'a>(
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

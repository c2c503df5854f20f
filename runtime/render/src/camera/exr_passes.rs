//! One frame of a camera as EXR: the picture and its passes. World, metres, seconds.

use std::path::Path;

use fbcrowd_sim::recording::{AgentFrame, Recording};

use crate::camera::options::CameraOptions;
use crate::camera::view::{CameraView, Shot};
use crate::error::RenderError;
use crate::passes::motion::OtherFrame;
use crate::passes::multi_channel_exr::{self, PassFrame};
use crate::passes::pass::Pass;
use crate::passes::pass_picture::{gathered, matte_metadata};
use crate::passes::tile_passes::{FramePasses, channels};
use crate::top_view::playback::{duration_s, sample};
use crate::visibility::Lens;

/// Draws a frame with its passes, and writes it. `lens_at` gives the lens at a time, s.
///
/// # Errors
/// If the recording is damaged, or the file cannot be written.
pub(crate) fn write(
    path: &Path,
    recording: &Recording,
    view: &CameraView<'_>,
    options: &CameraOptions,
    (shot, agents, number): (&Shot, &[AgentFrame], u32),
    lens_at: impl Fn(f64) -> Result<Lens, RenderError>,
) -> Result<(), RenderError> {
    let frame_rate_hz = recording.header().scenario.view.frame_rate_hz;
    let scene = view.scene(shot, agents);
    let other = |frames: f64| -> Result<OtherFrame, RenderError> {
        let time_s = (shot.time_s + frames / f64::from(frame_rate_hz)).clamp(0.0, duration_s(recording));
        let posed = posed_then(agents, &sample(recording, time_s)?);
        // A camera at an agent that is not present then stays.
        let lens = lens_at(time_s).unwrap_or(shot.lens);
        Ok(OtherFrame { scene: view.posed_scene(shot, agents, &posed), lens })
    };
    let others: Option<[OtherFrame; 2]> = match options.passes.holds(Pass::Motion) {
        true => Some([other(1.0)?, other(-1.0)?]),
        false => None,
    };
    let passes = FramePasses {
        passes: &options.passes,
        scene: &scene,
        lens: &shot.lens,
        population: view.population(),
        others: others.as_ref(),
    };
    let (picture, tiles) = view.draw_with(shot, &scene, |tile| passes.tile(tile));
    let channels = gathered(picture.size_px, &channels(&options.passes, view.samples()), &tiles);
    let frame = PassFrame {
        picture: &picture,
        channels,
        metadata: matte_metadata(&options.passes, &scene, view.population()),
        lens: &shot.lens,
        number,
        frame_rate_hz,
        colour_space: options.colour_space,
        compression: options.compression,
    };
    multi_channel_exr::write(path, frame)
}

/// The agents of a frame as they are at another time; as they are now where they are not present then.
fn posed_then(agents: &[AgentFrame], then: &[AgentFrame]) -> Vec<AgentFrame> {
    let posed = |agent: &AgentFrame| {
        let found = then.binary_search_by_key(&agent.id, |other| other.id);
        found.map_or(*agent, |index| then[index])
    };
    agents.iter().map(posed).collect()
}

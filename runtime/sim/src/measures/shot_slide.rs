//! Slide of planted feet in the frames of a shot, which lie between recorded frames, beside that of the recording.
//!
//! As [`planted_slide`](crate::measures::planted_slide) measures, over all agents and the same time. cm/s.

use serde::Serialize;

use crate::measures::planted_slide::PlantedSlide;
use crate::recording::{AgentFrame, FrameTimes, Recording, RecordingError, duration_s, sample};

/// Slide of planted feet in the frames of a shot, and in the recording.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct ShotSlide {
    /// Number of frames.
    pub frames: u32,
    /// Frame rate, Hz.
    pub fps: f64,
    /// Slide in the frames of the shot, cm/s; null where no foot is planted.
    pub planted_slide_cm_s: Option<f64>,
    /// Slide in the recorded frames of the same time, cm/s; null where no foot is planted.
    pub recorded_slide_cm_s: Option<f64>,
}

/// Measures the frames of a shot. A frame rate of a multiple of the step's leaves the recorded frames as they are.
///
/// # Errors
/// If a frame cannot be read.
pub fn shot_slide(recording: &Recording, times: &FrameTimes) -> Result<ShotSlide, RecordingError> {
    let (dt_s, end_s) = (f64::from(recording.header().scenario.dt_s), duration_s(recording));
    let frames = times.count(end_s);
    let times_s = (0..frames).map(|frame| times.time_s(times.first_frame + frame));
    let first = (times.start_s / dt_s).ceil() as usize;
    let recorded_s = (first..recording.frame_count()).map(|frame| frame as f64 * dt_s);
    Ok(ShotSlide {
        frames,
        fps: times.rate.hz(),
        planted_slide_cm_s: slide_cm_s(recording, times_s, 1.0 / times.rate.hz())?,
        recorded_slide_cm_s: slide_cm_s(recording, recorded_s, dt_s)?,
    })
}

fn slide_cm_s(
    recording: &Recording,
    times_s: impl Iterator<Item = f64>,
    spacing_s: f64,
) -> Result<Option<f64>, RecordingError> {
    let (skeleton, population) = (recording.header().skeleton(), recording.population());
    let dt_s = f64::from(recording.header().scenario.dt_s);
    let mut slide = PlantedSlide::new(population.agents.len(), spacing_s as f32);
    let mut before_s = f64::NEG_INFINITY;
    for time_s in times_s {
        for agent in &sample(recording, time_s)? {
            if jumped(recording, agent, [before_s / dt_s, time_s / dt_s]) {
                slide.lift(agent.id.index());
            }
            let stature = population.agents[agent.id.index()].stature;
            let joints = agent.pose.forward_kinematics(skeleton).sized(stature);
            slide.push_one(agent.id.index(), agent, &skeleton.sized(stature), &joints);
        }
        before_s = time_s;
    }
    Ok(slide.finish().slide_cm_s)
}

/// Whether an agent is teleported between two times, in steps.
fn jumped(recording: &Recording, agent: &AgentFrame, [before, now]: [f64; 2]) -> bool {
    let life = recording.population().agents.get(agent.id.index());
    let within = |frame: &u32| f64::from(*frame) > before && f64::from(*frame) <= now + 1e-3;
    life.is_some_and(|life| life.teleports.iter().any(within))
}

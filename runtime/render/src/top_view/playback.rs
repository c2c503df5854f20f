//! Playback: a recording at any time. Pictures have the view's frame rate, recorded frames the simulation's step.
//!
//! Roots are in the world, poses in their root frames.

use std::f32::consts::{PI, TAU};

use fbcrowd_sim::recording::{AgentFrame, Recording, RecordingError};
use motiondb::body::{Pose, Root};
use rayon::prelude::*;

use crate::error::RenderError;
use crate::top_view::trails::Tracks;

/// Distance of a picture's time from a recorded frame up to which it shows that frame unchanged, steps.
const SAME_FRAME_STEPS: f64 = 1e-3;

/// Greatest number of positions in tracks: 256 MiB, a thousand agents for 18 minutes at every step.
const MAX_TRACK_POINTS: usize = 1 << 25;

/// Number of pictures of a recording at its view's frame rate; the first is at time 0.
pub(crate) fn picture_count(recording: &Recording) -> u32 {
    let frame_rate_hz = recording.header().scenario.view.frame_rate_hz;
    (duration_s(recording) * f64::from(frame_rate_hz) + SAME_FRAME_STEPS) as u32 + 1
}

/// Time of a recording's last frame, s.
pub(crate) fn duration_s(recording: &Recording) -> f64 {
    recording.frame_count().saturating_sub(1) as f64 * f64::from(recording.header().scenario.dt_s)
}

/// Time of a picture, given by its index from 0, s.
pub(crate) fn picture_time_s(recording: &Recording, picture: u32) -> f64 {
    f64::from(picture) / f64::from(recording.header().scenario.view.frame_rate_hz)
}

/// Number of frames that are read at once.
const FRAMES_AT_ONCE: usize = 256;

/// Root positions of all agents over the whole recording, while they are present. A long recording of many agents is
/// thinned to every n-th frame, so that the tracks take at most 256 MiB.
///
/// # Errors
/// If the recording has no frame, or one cannot be read.
pub fn read_tracks(recording: &Recording) -> Result<Tracks, RenderError> {
    if recording.frame_count() == 0 {
        return Err(RenderError::EmptyRecording);
    }
    let agent_frames = (0..recording.frame_count()).map(|frame| recording.agent_count(frame)).sum();
    let stride = track_stride(agent_frames);
    let mut tracks = Tracks::new(recording.header().scenario.dt_s * stride as f32);
    let kept: Vec<usize> = (0..recording.frame_count()).step_by(stride).collect();
    for frames in kept.chunks(FRAMES_AT_ONCE) {
        let roots_m = |agents: &mut Vec<AgentFrame>, frame: &usize| {
            recording.read_frame(*frame, agents)?;
            Ok(agents.iter().map(|agent| (agent.id, agent.root.position_m)).collect())
        };
        let read: Result<Vec<Vec<_>>, RecordingError> = frames.par_iter().map_init(Vec::new, roots_m).collect();
        read?.into_iter().for_each(|roots_m| tracks.push(roots_m));
    }
    Ok(tracks)
}

/// Number n such that every n-th frame is kept.
fn track_stride(agent_frames: usize) -> usize {
    agent_frames.div_ceil(MAX_TRACK_POINTS).max(1)
}

/// All present agents at a time, s; between two recorded frames, a blend of both. An agent is shown from its frame of
/// birth up to its removal; one that the later frame lacks is shown as in the earlier one.
///
/// # Errors
/// If a frame cannot be read.
pub fn sample(recording: &Recording, time_s: f64) -> Result<Vec<AgentFrame>, RecordingError> {
    let step = time_s / f64::from(recording.header().scenario.dt_s);
    let nearest = step.round();
    let last = recording.frame_count().saturating_sub(1);
    let mut agents = Vec::new();
    if (step - nearest).abs() < SAME_FRAME_STEPS || step >= last as f64 {
        recording.read_frame((nearest as usize).min(last), &mut agents)?;
        return Ok(agents);
    }
    let mut later = Vec::new();
    recording.read_frame(step as usize, &mut agents)?;
    recording.read_frame(step as usize + 1, &mut later)?;
    let share = step.fract() as f32;
    let next = |agent: &AgentFrame| later.binary_search_by_key(&agent.id, |next| next.id).ok();
    let blended = |agent: &AgentFrame| next(agent).map_or(*agent, |next| blend(agent, &later[next], share));
    Ok(agents.iter().map(blended).collect())
}

/// A body between two frames. All fields but root and pose are those of the earlier frame.
fn blend(agent: &AgentFrame, next: &AgentFrame, share: f32) -> AgentFrame {
    let (from, to) = (agent.root.facing_rad, next.root.facing_rad);
    let turn_rad = (to - from + PI).rem_euclid(TAU) - PI;
    let rotation = |joint: usize| agent.pose.rotations[joint].lerp(next.pose.rotations[joint], share);
    AgentFrame {
        root: Root {
            position_m: agent.root.position_m.lerp(next.root.position_m, share),
            facing_rad: from + share * turn_rad,
        },
        pose: Pose {
            pelvis_m: agent.pose.pelvis_m.lerp(next.pose.pelvis_m, share),
            rotations: std::array::from_fn(rotation),
        },
        ..*agent
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn tracks_are_thinned_only_beyond_the_limit() {
        for (frames, agents, stride) in [(1, 0, 1), (540, 17, 1), (18_000, 1_000, 1), (18_000, 10_000, 6)] {
            assert_eq!(track_stride(frames * agents), stride, "{frames} {agents}");
        }
    }

    #[test]
    fn a_blended_facing_turns_the_shorter_side() {
        let at = |facing_rad: f32| AgentFrame { root: Root { facing_rad, ..Root::default() }, ..AgentFrame::default() };
        for (from, to, middle) in [(3.0, -3.0, PI), (0.2, -0.2, 0.0), (7.0, 7.2, 7.1)] {
            let found = blend(&at(from), &at(to), 0.5).root.facing_rad;
            assert!((found - middle).abs() < 1e-4, "{from} {to} {found}");
        }
    }
}

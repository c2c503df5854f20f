//! Tracks of all agents over a whole recording, for framing and trails. Roots are in the world, metres.

use fbcrowd_sim::AgentId;
use fbcrowd_sim::recording::{Recording, RecordingError};
use glam::Vec2;
use rayon::prelude::*;

use crate::error::RenderError;
use crate::top_view::trails::Tracks;

/// Greatest number of positions in tracks: 256 MiB, a thousand agents for 18 minutes at every step.
const MAX_TRACK_POINTS: usize = 1 << 25;

/// Number of frames that are read at once.
const FRAMES_AT_ONCE: usize = 256;

/// Greatest number of frames that are read for the framing: all of a minute at 30 steps a second. Of a longer recording
/// every n-th one is read, so that a part of its pictures does not cost all of its frames.
const MAX_FRAMED: usize = 2_048;

/// Root positions of all agents over the whole recording, while they are present. A long recording of many agents is
/// thinned to every n-th frame, so that the tracks take at most 256 MiB.
///
/// # Errors
/// If the recording has no frame, or one cannot be read.
pub fn read_tracks(recording: &Recording) -> Result<Tracks, RenderError> {
    read_tracks_between(recording, [0.0, f64::INFINITY])
}

/// As [`read_tracks`], between two times, s; and the box of the whole recording's positions, unless its view needs none.
///
/// # Errors
/// As [`read_tracks`].
pub(crate) fn read_tracks_between(recording: &Recording, [from_s, to_s]: [f64; 2]) -> Result<Tracks, RenderError> {
    let count = recording.frame_count();
    if count == 0 {
        return Err(RenderError::EmptyRecording);
    }
    let agent_frames = (0..count).map(|frame| recording.agent_count(frame)).sum();
    let stride = track_stride(agent_frames);
    let dt_s = recording.header().scenario.dt_s * stride as f32;
    let frame_at = |time_s: f64| ((time_s / f64::from(dt_s)).max(0.0) as usize).min((count - 1) / stride);
    let (first, last) = (frame_at(from_s - f64::from(dt_s)), frame_at(to_s + f64::from(dt_s)));
    let mut tracks = Tracks::starting_at(dt_s, first);
    let kept: Vec<usize> = (first..=last).map(|frame| frame * stride).collect();
    for frames in kept.chunks(FRAMES_AT_ONCE) {
        read_roots(recording, frames)?.into_iter().for_each(|roots_m| tracks.push(roots_m));
    }
    let (view, stride) = (&recording.header().scenario.view, count.div_ceil(MAX_FRAMED));
    let is_framed = view.centre_m.is_some() && view.width_m.is_some();
    // The framing must not depend on the times. Where all frames are read anyway, it is that of the tracks.
    if !is_framed && (kept.len() < count || stride > 1) {
        tracks.bounds_m = read_bounds_m(recording, stride)?;
    }
    Ok(tracks)
}

/// Positions of the agents of some frames.
fn read_roots(recording: &Recording, frames: &[usize]) -> Result<Vec<Vec<(AgentId, Vec2)>>, RecordingError> {
    frames.par_iter().map(|frame| recording.read_positions(*frame)).collect()
}

/// The box of all positions of every n-th frame of a recording, the last one among them; none without agents.
fn read_bounds_m(recording: &Recording, stride: usize) -> Result<Option<[Vec2; 2]>, RenderError> {
    let mut bounds_m = None;
    let frames: Vec<usize> = (0..recording.frame_count()).rev().step_by(stride).collect();
    for frames in frames.chunks(FRAMES_AT_ONCE) {
        for (_, at_m) in read_roots(recording, frames)?.into_iter().flatten() {
            let [low_m, high_m] = bounds_m.unwrap_or([at_m; 2]);
            bounds_m = Some([low_m.min(at_m), high_m.max(at_m)]);
        }
    }
    Ok(bounds_m)
}

/// Number n such that every n-th frame is kept.
fn track_stride(agent_frames: usize) -> usize {
    agent_frames.div_ceil(MAX_TRACK_POINTS).max(1)
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
}

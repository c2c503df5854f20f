//! Tracks of all agents over a whole recording, for framing and trails. Roots are in the world, metres.

use fbcrowd_sim::recording::{AgentFrame, Recording, RecordingError};
use rayon::prelude::*;

use crate::error::RenderError;
use crate::top_view::trails::Tracks;

/// Greatest number of positions in tracks: 256 MiB, a thousand agents for 18 minutes at every step.
const MAX_TRACK_POINTS: usize = 1 << 25;

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

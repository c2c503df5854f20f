//! Playback of extra joints: their rotations at any time, as [`sample`](crate::recording::sample) gives the bodies.

use glam::Quat;

use crate::population::AgentId;
use crate::recording::error::RecordingError;
use crate::recording::playback::times::{Between, between};
use crate::recording::reader::Recording;

/// Rotations of the extra joints of all present agents at a time; empty where a recording has no extra joints.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct ExtraFrame {
    /// The agents, rising.
    ids: Vec<AgentId>,
    /// Rotations relative to the parents, agent by agent, each with the joints that the recording's header lists.
    rotations: Vec<Quat>,
}

impl ExtraFrame {
    /// Rotations of an agent's extra joints, in the order of the recording's header; empty where the agent has none.
    pub fn of(&self, agent: AgentId) -> &[Quat] {
        let Ok(index) = self.ids.binary_search(&agent) else { return &[] };
        let count = self.rotations.len() / self.ids.len();
        &self.rotations[index * count..][..count]
    }

    /// The same with the agents that it lacks as in another frame of the recording.
    #[must_use]
    pub fn completed(self, other: &Self) -> Self {
        let mut ids = [&self.ids[..], &other.ids[..]].concat();
        ids.sort_unstable();
        ids.dedup();
        if ids.len() == self.ids.len() {
            return self;
        }
        let own_first = |id: &AgentId| if self.ids.binary_search(id).is_ok() { self.of(*id) } else { other.of(*id) };
        Self { rotations: ids.iter().flat_map(own_first).copied().collect(), ids }
    }
}

/// Rotations of the extra joints at a time, s; between two recorded frames, those of both blended. Agents are present and
/// blended as in [`sample`](crate::recording::sample).
///
/// # Errors
/// If a frame cannot be read.
///
/// ```no_run
/// use std::path::Path;
///
/// use fbcrowd_sim::recording::{Recording, sample, sample_extra};
///
/// # fn main() -> Result<(), Box<dyn std::error::Error>> {
/// let recording = Recording::open(Path::new("scene.fbrec"))?;
/// let (agents, extra) = (sample(&recording, 1.5)?, sample_extra(&recording, 1.5)?);
/// for (joint, rotation) in recording.header().extra_joints.iter().zip(extra.of(agents[0].id)) {
///     println!("{}: {rotation}", joint.name);
/// }
/// # Ok(())
/// # }
/// ```
pub fn sample_extra(recording: &Recording, time_s: f64) -> Result<ExtraFrame, RecordingError> {
    if recording.header().extra_joints.is_empty() {
        return Ok(ExtraFrame::default());
    }
    let Between { frame, later } = between(recording, time_s);
    let mut sampled = extra_of_frame(recording, frame)?;
    let Some((after, share)) = later else { return Ok(sampled) };
    let next = extra_of_frame(recording, after)?;
    let (lives, count) = (&recording.population().agents, recording.header().extra_joints.len());
    for (id, rotations) in sampled.ids.iter().zip(sampled.rotations.chunks_exact_mut(count)) {
        if !lives[id.index()].is_teleported(after as u32) {
            rotations.iter_mut().zip(next.of(*id)).for_each(|(from, to)| *from = from.lerp(*to, share));
        }
    }
    Ok(sampled)
}

/// The extra joints of a recorded frame.
fn extra_of_frame(recording: &Recording, frame: usize) -> Result<ExtraFrame, RecordingError> {
    let mut rotations = Vec::new();
    recording.read_extra(frame, &mut rotations)?;
    let lives = recording.population().agents.iter().enumerate();
    let present = lives.filter(|(_, life)| life.is_present(frame as u32));
    Ok(ExtraFrame { ids: present.map(|(index, _)| index.into()).collect(), rotations })
}

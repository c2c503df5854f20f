//! Frames → tracks → measures of people: of a crowd while it runs, or of a recording.
//!
//! A track keeps every frame of a body, so a long recording of a great crowd is read several times, each time for as
//! many agents as fit into a budget of memory.

use std::ops::Range;

use motiondb::body::Skeleton;

use crate::measures::frame_pairs::FramePairs;
use crate::measures::people::body_track::{BodySample, BodyTrack};
use crate::measures::people::people_measures::{PeopleMeasures, PeopleTally};
use crate::measures::people::sole_slide::SoleSlideTally;
use crate::measures::root_measures::RootMeasures;
use crate::population::Population;
use crate::recording::error::RecordingError;
use crate::recording::frame::AgentFrame;
use crate::recording::reader::Recording;
use crate::scenario::Scenario;

/// Memory for tracks, bytes.
const TRACKS_MAX_BYTES: usize = 512 << 20;
/// Interval at which standing bodies are compared, s.
const COMPARED_EACH_S: f64 = 0.5;
/// Greatest speed of a root that stands, m/s.
const STILL_MPS: f32 = 0.03;

/// Measures people frame by frame; keeps all frames of the agents that it follows.
#[derive(Debug)]
pub struct PeopleMeasuring {
    skeleton: Skeleton,
    dt_s: f32,
    /// Ids of the agents that are followed.
    ids: Range<usize>,
    steps: u32,
    before: Vec<AgentFrame>,
    roots: RootMeasures,
    slide: SoleSlideTally,
    /// The tracks of the followed agents, by id; a new one where a state moves the agent at once.
    tracks: Vec<Vec<BodyTrack>>,
    tally: PeopleTally,
}

impl PeopleMeasuring {
    /// Begins with the start of a scenario and follows all agents. The population must list every agent of the frame.
    pub fn new(skeleton: &Skeleton, scenario: &Scenario, population: &Population, start: &[AgentFrame]) -> Self {
        let mut measuring = Self {
            skeleton: skeleton.clone(),
            dt_s: scenario.dt_s,
            ids: 0..usize::MAX,
            steps: 0,
            before: start.to_vec(),
            roots: RootMeasures::new(scenario, population, start),
            slide: SoleSlideTally::new(scenario.dt_s),
            tracks: Vec::new(),
            tally: PeopleTally::default(),
        };
        start.iter().for_each(|agent| measuring.follow(agent, population, false));
        measuring
    }

    /// Begins again with the start, to follow the agents with ids in a range; what was measured of others stays.
    fn follow_others(&mut self, ids: Range<usize>, scenario: &Scenario, population: &Population, start: &[AgentFrame]) {
        (self.ids, self.steps) = (ids, 0);
        self.before = start.to_vec();
        self.roots = RootMeasures::new(scenario, population, start);
        self.tracks.clear();
        start.iter().for_each(|agent| self.follow(agent, population, false));
    }

    /// Adds up the measures of the agents that are followed.
    fn add_up(&mut self) {
        self.tracks.iter().flatten().for_each(|track| self.tally.add(track));
    }

    /// Adds one step, given every present agent after it, in the order of ids, and a population that lists them.
    pub fn push(&mut self, population: &Population, after: &[AgentFrame]) {
        self.steps += 1;
        let is_teleported = |agent: &AgentFrame| population.agents[agent.id.index()].is_teleported(self.steps);
        let teleported: Vec<bool> = after.iter().map(is_teleported).collect();
        after.iter().zip(teleported).for_each(|(agent, teleported)| self.follow(agent, population, teleported));
        let mut pairs = FramePairs::new(&self.before, after);
        pairs.common.retain(|(_, after)| !is_teleported_in(population, after, self.steps));
        let each = ((COMPARED_EACH_S / f64::from(self.dt_s)).round() as u32).max(1);
        if self.steps.is_multiple_of(each) {
            let still = |(before, after): &&(&AgentFrame, &AgentFrame)| {
                let moved_m = after.root.position_m.distance(before.root.position_m);
                moved_m < STILL_MPS * self.dt_s && after.contacts == [1.0; 2] && self.ids.contains(&after.id.index())
            };
            let standing: Vec<&AgentFrame> = pairs.common.iter().filter(still).map(|pair| pair.1).collect();
            self.tally.standing.compare(&standing);
        }
        self.roots.push(population, &pairs);
        self.before.clear();
        self.before.extend_from_slice(after);
    }

    /// Adds a frame of an agent to its track.
    fn follow(&mut self, agent: &AgentFrame, population: &Population, is_moved: bool) {
        let index = agent.id.index();
        if !self.ids.contains(&index) {
            return;
        }
        let stature = population.agents[index].stature;
        let (skeleton, joints) =
            (self.skeleton.sized(stature), agent.pose.forward_kinematics(&self.skeleton).sized(stature));
        let has_arrived = self.roots.has_arrived(agent.id);
        if is_moved {
            self.slide.lift(index);
        }
        if !has_arrived {
            self.slide.push(agent, &skeleton, &joints);
        }
        let slot = index - self.ids.start;
        if slot >= self.tracks.len() {
            self.tracks.resize(slot + 1, Vec::new());
        }
        let tracks = &mut self.tracks[slot];
        if is_moved || tracks.is_empty() {
            let (dt_s, start_s) = (f64::from(self.dt_s), f64::from(self.steps) * f64::from(self.dt_s));
            tracks.push(BodyTrack { agent: index, ..BodyTrack::new(dt_s, start_s) });
        }
        if let Some(track) = tracks.last_mut() {
            track.samples.push(BodySample::new(&skeleton, agent, &joints, has_arrived));
        }
    }

    /// The tracks so far, by id.
    pub fn tracks(&self) -> impl Iterator<Item = &BodyTrack> {
        self.tracks.iter().flatten()
    }

    /// The measures after the last frame.
    pub fn finish(mut self) -> PeopleMeasures {
        self.add_up();
        self.tally.finish(self.slide.finish())
    }
}

fn is_teleported_in(population: &Population, agent: &AgentFrame, frame: u32) -> bool {
    population.agents[agent.id.index()].is_teleported(frame)
}

/// Measures the people of a recording.
///
/// # Errors
/// If a frame cannot be read.
pub fn measure_people(recording: &Recording) -> Result<PeopleMeasures, RecordingError> {
    let of_one = recording.frame_count() * size_of::<BodySample>();
    measure_at_once(recording, (TRACKS_MAX_BYTES / of_one).max(1))
}

/// As [`measure_people`], for so many agents at once.
fn measure_at_once(recording: &Recording, at_once: usize) -> Result<PeopleMeasures, RecordingError> {
    let (header, population) = (recording.header(), recording.population());
    let mut agents = Vec::new();
    let mut measuring = PeopleMeasuring::new(header.skeleton(), &header.scenario, population, &[]);
    for first in (0..population.agents.len()).step_by(at_once) {
        recording.read_frame(0, &mut agents)?;
        measuring.follow_others(first..first + at_once, &header.scenario, population, &agents);
        for frame in 1..recording.frame_count() {
            recording.read_frame(frame, &mut agents)?;
            measuring.push(population, &agents);
        }
        measuring.add_up();
    }
    Ok(measuring.tally.finish(measuring.slide.finish()))
}

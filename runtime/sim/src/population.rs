//! All agents that ever were in a simulation or recording, by id.
//!
//! Ids count births: the agents of the scenario have the first ids, in index order; each later agent has the next one.
//! No id is used twice, so an id is an index into [`Population::agents`]. Frame k is the state after k steps. An agent is
//! present from its frame of birth, in which it stands at its start, up to the frame before its removal.

use serde::{Deserialize, Serialize};

use crate::behaviour::SignalOrder;
use crate::scenario::agent_spec::is_of_skeleton;
use crate::scenario::{AgentSpec, Coupling, Scenario};

/// The id of an agent: the number of agents that were born before it.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, PartialOrd, Ord, Serialize, Deserialize)]
#[serde(transparent)]
pub struct AgentId(pub u32);

impl AgentId {
    /// Index of the agent in [`Population::agents`].
    pub fn index(self) -> usize {
        self.0 as usize
    }
}

impl From<usize> for AgentId {
    /// The id at an index; scenarios have at most a million agents.
    fn from(index: usize) -> Self {
        Self(index as u32)
    }
}

/// One agent from its birth to its removal.
#[derive(Clone, Debug, PartialEq)]
pub struct AgentLife {
    /// The agent at its start.
    pub spec: AgentSpec,
    /// Index of the source that the agent came from; none of an agent of the scenario's start, or added by a program.
    pub source: Option<u32>,
    /// Time for which the agent goes on standing after its `pre_movement_s`, s: its reaction to a common start.
    pub reaction_s: f32,
    /// The first frame with the agent.
    pub born: u32,
    /// The first frame without it; none of an agent that is present to the end.
    pub removed: Option<u32>,
    /// Index of the database by which the body moves.
    pub database: u32,
    /// Index of the character that the body is drawn as; none of the plain body.
    pub character: Option<u32>,
    /// Size of the body, relative to the database's skeleton.
    pub stature: f32,
    /// The group that the agent belongs to: id of its first member.
    pub group: Option<u32>,
    /// Changes of the radius of the disc that other agents see, in the order of frames.
    pub radii_m: Vec<RadiusChange>,
    /// Frames in which the agent appears where its state has moved it at once, rising.
    pub teleports: Vec<u32>,
}

/// A change of an agent's radius.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct RadiusChange {
    /// The first frame with the radius.
    pub frame: u32,
    /// Radius of the disc that other agents see, m.
    pub radius_m: f32,
}

impl AgentLife {
    /// A life that begins in a frame, with the database of its style and the plain body, of the stated size.
    pub fn new(spec: AgentSpec, source: Option<u32>, born: u32) -> Self {
        Self {
            group: spec.group.map(|group| group.first),
            database: spec.style,
            stature: spec.stature,
            spec,
            source,
            reaction_s: 0.0,
            born,
            removed: None,
            character: None,
            radii_m: Vec::new(),
            teleports: Vec::new(),
        }
    }

    /// The first frame after which the agent does not stand but begins, where steps last `dt_s`.
    pub fn begins_at(&self, dt_s: f32) -> u32 {
        self.born + ((self.spec.pre_movement_s + self.reaction_s) / dt_s).ceil() as u32
    }

    /// Radius of the disc that other agents see in a frame, m.
    pub fn radius_m(&self, frame: u32) -> f32 {
        let later = self.radii_m.partition_point(|change| change.frame <= frame);
        later.checked_sub(1).map_or(self.spec.radius_m, |last| self.radii_m[last].radius_m)
    }

    /// Radius of the disc that walls hold in a frame, m: at most that of the other disc.
    pub fn wall_radius_m(&self, frame: u32) -> f32 {
        self.spec.wall_radius_m.min(self.radius_m(frame))
    }

    /// Whether a state has moved the agent at once between a frame and the one before.
    pub fn is_teleported(&self, frame: u32) -> bool {
        self.teleports.binary_search(&frame).is_ok()
    }

    /// Whether the agent is present in a frame.
    pub fn is_present(&self, frame: u32) -> bool {
        self.born <= frame && self.removed.is_none_or(|removed| frame < removed)
    }
}

/// Reaction time of an agent, by id, s: none of an agent that comes after the start. The members of a group react as
/// its first one, so they begin to walk together.
pub(crate) fn reaction_s(scenario: &Scenario, index: usize) -> f32 {
    let (Some(spec), Some(variation)) = (scenario.agents.get(index), scenario.variation) else { return 0.0 };
    let first = spec.group.map_or(index as u32, |group| group.first);
    variation.drawn_reaction_s(scenario.seed, first)
}

/// Size of an agent's body, relative to the database's skeleton: what the scenario states, otherwise drawn by the agent's
/// id.
pub(crate) fn drawn_stature(scenario: &Scenario, id: AgentId, spec: &AgentSpec) -> f32 {
    // Without two-way coupling bodies move and look as in the clips.
    let variation =
        scenario.variation.filter(|_| scenario.coupling == Coupling::TwoWay && is_of_skeleton(&spec.stature));
    variation.map_or(spec.stature, |variation| variation.drawn_stature(scenario.seed, id.0))
}

/// What a source did.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
#[serde(default)]
pub struct SourceCount {
    /// Agents that came from the source.
    pub born: u32,
    /// Agents that are due and wait until there is room.
    pub waiting: u32,
    /// Frames in which an agent was due and had no room.
    pub blocked_frames: u32,
}

/// What became of the agents that wanted one of a set of goals and found none with room.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
#[serde(default)]
pub struct GoalCount {
    /// Agents that wait until there is room.
    pub waiting: u32,
    /// Greatest number of agents that waited at once.
    pub waiting_max: u32,
    /// Steps in which an agent waited.
    pub waiting_steps: u32,
}

impl GoalCount {
    /// Adds a step.
    pub(crate) fn add(&mut self, waiting: u32) {
        self.waiting = waiting;
        self.waiting_max = self.waiting_max.max(waiting);
        self.waiting_steps += u32::from(waiting > 0);
    }
}

/// When a door was open and closed.
#[derive(Clone, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
#[serde(default)]
pub struct DoorPhases {
    /// Whether the door is closed in the first frame.
    pub is_closed_at_start: bool,
    /// Frames from which on the door is closed where it was open, or open where it was closed, rising.
    pub changes: Vec<u32>,
}

impl DoorPhases {
    /// Whether the door is closed in a frame, and in the step that leads to it.
    pub fn is_closed(&self, frame: u32) -> bool {
        let changes = self.changes.partition_point(|change| *change <= frame);
        self.is_closed_at_start != (changes % 2 == 1)
    }
}

/// What an event has made of a signal.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub struct SignalChange {
    /// The first frame in which the signal shows it.
    pub frame: u32,
    /// Index of the signal.
    pub signal: u32,
    /// What it shows.
    pub order: SignalOrder,
}

/// All agents, past and present, the counts of sources and goals, and the phases of doors.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Population {
    /// Every agent, by id.
    pub agents: Vec<AgentLife>,
    /// The counts of every source, by index.
    pub sources: Vec<SourceCount>,
    /// The counts of every set of goals, by index.
    pub goals: Vec<GoalCount>,
    /// The phases of every door, by index.
    pub doors: Vec<DoorPhases>,
    /// What events have made of signals, in the order of frames.
    pub signals: Vec<SignalChange>,
}

impl Population {
    /// The population of a scenario at its start.
    pub fn of(scenario: &Scenario) -> Self {
        let life = |(index, spec): (usize, &AgentSpec)| {
            let character = scenario.character_of(index as u32, spec);
            let stature = drawn_stature(scenario, index.into(), spec);
            let reaction_s = reaction_s(scenario, index);
            AgentLife { character, reaction_s, stature, ..AgentLife::new(spec.clone(), None, 0) }
        };
        let door = |is_closed_at_start| DoorPhases { is_closed_at_start, changes: Vec::new() };
        Self {
            doors: scenario.doors_closed_at_start().into_iter().map(door).collect(),
            agents: scenario.agents.iter().enumerate().map(life).collect(),
            sources: vec![SourceCount::default(); scenario.sources.len()],
            goals: vec![GoalCount::default(); scenario.behaviour.goals.len()],
            signals: Vec::new(),
        }
    }

    /// Whether a signal of a scenario, by index, is green at a time: as events have ordered, else by its phases.
    pub fn is_green(&self, scenario: &Scenario, signal: usize, time_s: f64) -> bool {
        // A frame that is shown unchanged has its signals.
        let frame = (time_s / f64::from(scenario.dt_s) + 1e-3) as u32;
        let changes = self.signals.iter().rev().filter(|change| change.signal as usize == signal);
        match changes.into_iter().find(|change| change.frame <= frame).map(|change| change.order) {
            Some(SignalOrder::Green) => true,
            Some(SignalOrder::Red) => false,
            Some(SignalOrder::Phases) | None => scenario.behaviour.is_green(signal, time_s),
        }
    }

    /// Whether each door, by index, is closed in a frame, and in the step that leads to it.
    pub fn closed_doors(&self, frame: u32) -> Vec<bool> {
        self.doors.iter().map(|door| door.is_closed(frame)).collect()
    }

    /// The agent with an id at its start.
    pub fn spec(&self, id: AgentId) -> &AgentSpec {
        &self.agents[id.index()].spec
    }

    /// Whether agents are born or removed after the start.
    pub fn changes(&self) -> bool {
        self.agents.iter().any(|life| life.born > 0 || life.removed.is_some())
    }
}

//! The `AGNT` chunk: all agents that ever were in a recording, by id, and what the sources did; zipped JSON.
//!
//! It is written last, since only then the frames of removal are known. The agents of the scenario's start are in the
//! header; here they have no `spec`. Keys with their default are left out: an agent that is present in all frames is `{}`.

use std::borrow::Cow;
use std::fmt;

use serde::de::{Error, SeqAccess, Visitor};
use serde::{Deserialize, Deserializer, Serialize};

use crate::population::{
    AgentLife, DoorPhases, GoalCount, Population, RadiusChange, SignalChange, SourceCount, reaction_s,
};
use crate::recording::header::Header;
use crate::scenario::AgentSpec;
use crate::scenario::ranges::{AGENTS_MAX, RADIUS_M, check_agent};

/// Statures, relative to the database's skeleton: from an infant to a giant.
const STATURE: std::ops::RangeInclusive<f32> = 0.1..=10.0;

#[derive(Serialize, Deserialize)]
struct StoredPopulation<'a> {
    #[serde(deserialize_with = "limited")]
    agents: Vec<StoredLife<'a>>,
    #[serde(default)]
    sources: Cow<'a, [SourceCount]>,
    #[serde(default, skip_serializing_if = "<[GoalCount]>::is_empty")]
    goals: Cow<'a, [GoalCount]>,
    #[serde(default, skip_serializing_if = "<[DoorPhases]>::is_empty")]
    doors: Cow<'a, [DoorPhases]>,
    #[serde(default, skip_serializing_if = "<[SignalChange]>::is_empty")]
    signals: Cow<'a, [SignalChange]>,
}

#[derive(Serialize, Deserialize)]
#[serde(default)]
struct StoredLife<'a> {
    #[serde(skip_serializing_if = "Option::is_none")]
    spec: Option<Cow<'a, AgentSpec>>,
    #[serde(skip_serializing_if = "Option::is_none")]
    source: Option<u32>,
    #[serde(skip_serializing_if = "is_0")]
    born: u32,
    #[serde(skip_serializing_if = "Option::is_none")]
    removed: Option<u32>,
    #[serde(skip_serializing_if = "is_0")]
    database: u32,
    #[serde(skip_serializing_if = "Option::is_none")]
    character: Option<u32>,
    #[serde(skip_serializing_if = "is_1")]
    stature: f32,
    #[serde(skip_serializing_if = "Option::is_none")]
    group: Option<u32>,
    #[serde(skip_serializing_if = "<[RadiusChange]>::is_empty")]
    radii_m: Cow<'a, [RadiusChange]>,
    #[serde(skip_serializing_if = "<[u32]>::is_empty")]
    teleports: Cow<'a, [u32]>,
}

impl Default for StoredLife<'_> {
    /// An agent of the scenario's start that is present in all frames.
    fn default() -> Self {
        Self {
            spec: None,
            source: None,
            born: 0,
            removed: None,
            database: 0,
            character: None,
            stature: 1.0,
            group: None,
            radii_m: Cow::Borrowed(&[]),
            teleports: Cow::Borrowed(&[]),
        }
    }
}

#[expect(clippy::trivially_copy_pass_by_ref, reason = "serde's signature")]
fn is_0(value: &u32) -> bool {
    *value == 0
}

#[expect(clippy::trivially_copy_pass_by_ref, reason = "serde's signature")]
fn is_1(value: &f32) -> bool {
    *value == 1.0
}

/// What is stored of a population, to be written.
pub(crate) fn stored<'a>(population: &'a Population, header: &Header) -> impl Serialize + 'a {
    let listed = header.scenario.agents.len();
    let life = |(index, life): (usize, &'a AgentLife)| StoredLife {
        spec: (index >= listed).then_some(Cow::Borrowed(&life.spec)),
        source: life.source,
        born: life.born,
        removed: life.removed,
        database: life.database,
        character: life.character,
        stature: life.stature,
        group: life.group,
        radii_m: Cow::Borrowed(&life.radii_m),
        teleports: Cow::Borrowed(&life.teleports),
    };
    let agents = population.agents.iter().enumerate().map(life).collect();
    let Population { sources, goals, doors, signals, .. } = population;
    StoredPopulation {
        agents,
        sources: Cow::Borrowed(sources),
        goals: Cow::Borrowed(goals),
        doors: Cow::Borrowed(doors),
        signals: Cow::Borrowed(signals),
    }
}

/// The population of a recording with this header and number of frames.
///
/// # Errors
/// What is wrong with it.
pub(crate) fn read(payload: &[u8], header: &Header, frame_count: usize) -> Result<Population, String> {
    let stored: StoredPopulation = crate::recording::zipped_json::decode(payload)?;
    let population = population(stored, header)?;
    check(&population, header, frame_count)?;
    Ok(population)
}

fn population(stored: StoredPopulation<'_>, header: &Header) -> Result<Population, String> {
    let listed = &header.scenario.agents;
    if stored.agents.len() < listed.len() {
        return Err(format!("it lists {} agents, but the scenario has {}", stored.agents.len(), listed.len()));
    }
    let life = |(id, stored): (usize, StoredLife<'_>)| {
        let spec = match (listed.get(id), stored.spec) {
            (Some(spec), None) => spec.clone(),
            (None, Some(spec)) => spec.into_owned(),
            _ => return Err(format!("agent {id} has no start, or two")),
        };
        let StoredLife { source, born, removed, database, character, stature, group, radii_m, teleports, .. } = stored;
        let (radii_m, teleports) = (radii_m.into_owned(), teleports.into_owned());
        let reaction_s = reaction_s(&header.scenario, id);
        Ok(AgentLife {
            spec,
            source,
            reaction_s,
            born,
            removed,
            database,
            character,
            stature,
            group,
            radii_m,
            teleports,
        })
    };
    let agents = stored.agents.into_iter().enumerate().map(life).collect::<Result<_, String>>()?;
    let mut goals = stored.goals.into_owned();
    if goals.is_empty() {
        goals = vec![GoalCount::default(); header.scenario.behaviour.goals.len()];
    }
    let StoredPopulation { sources, doors, signals, .. } = stored;
    let (sources, doors, signals) = (sources.into_owned(), doors.into_owned(), signals.into_owned());
    Ok(Population { agents, sources, goals, doors, signals })
}

fn check(population: &Population, header: &Header, frame_count: usize) -> Result<(), String> {
    let Population { agents, sources, goals, doors, signals } = population;
    if sources.len() != header.scenario.sources.len() {
        return Err(format!("it counts {} sources, but the scenario has another number", sources.len()));
    }
    if goals.len() != header.scenario.behaviour.goals.len() {
        return Err(format!("it counts {} sets of goals, but the scenario has another number", goals.len()));
    }
    if doors.len() != header.scenario.doors.len() {
        return Err(format!("it lists {} doors, but the scenario has another number", doors.len()));
    }
    for (index, door) in doors.iter().enumerate() {
        let is_frame = |frame: &u32| *frame > 0 && (*frame as usize) < frame_count;
        if !door.changes.iter().all(is_frame) || !door.changes.is_sorted_by(|a, b| a < b) {
            return Err(format!("door {index}: a frame is out of range"));
        }
    }
    let known = header.scenario.behaviour.signals.len();
    let is_change = |change: &SignalChange| (change.frame as usize) < frame_count && (change.signal as usize) < known;
    if !signals.iter().all(is_change) || !signals.is_sorted_by_key(|change| change.frame) {
        return Err("a change of a signal is out of range".into());
    }
    if !agents.is_sorted_by_key(|life| life.born) {
        return Err("ids do not count births".into());
    }
    for (id, life) in agents.iter().enumerate() {
        check_agent(id, &life.spec).map_err(|fault| format!("agent {id}: {}", fault.message))?;
        let is_born = (life.born as usize) < frame_count && (id >= header.scenario.agents.len() || life.born == 0);
        let is_gone = life.removed.is_none_or(|frame| frame > life.born && (frame as usize) < frame_count);
        let is_in = |index: Option<u32>, count: usize| index.is_none_or(|index| (index as usize) < count);
        let is_known = is_in(life.source, sources.len())
            && is_in(Some(life.database), header.databases.len())
            && is_in(life.character, header.characters.len());
        let is_frame = |frame: u32| frame > life.born && (frame as usize) < frame_count;
        let changes = life.radii_m.iter();
        let is_traced = changes.clone().all(|change| is_frame(change.frame) && RADIUS_M.contains(&change.radius_m))
            && changes.is_sorted_by(|a, b| a.frame < b.frame)
            && life.teleports.iter().all(|&frame| is_frame(frame))
            && life.teleports.is_sorted_by(|a, b| a < b);
        if !(is_born && is_gone && is_known && is_traced && STATURE.contains(&life.stature)) {
            return Err(format!("agent {id}: a frame, an index or the stature is out of range"));
        }
    }
    Ok(())
}

/// Reads a list of at most [`AGENTS_MAX`] agents: three bytes of text become a hundred in memory.
fn limited<'de, 'a, D: Deserializer<'de>>(deserializer: D) -> Result<Vec<StoredLife<'a>>, D::Error> {
    deserializer.deserialize_seq(AtMost)
}

struct AtMost;

impl<'de> Visitor<'de> for AtMost {
    type Value = Vec<StoredLife<'static>>;

    fn expecting(&self, formatter: &mut fmt::Formatter) -> fmt::Result {
        formatter.write_str("a list of at most a million agents")
    }

    fn visit_seq<A: SeqAccess<'de>>(self, mut list: A) -> Result<Self::Value, A::Error> {
        let mut agents = Vec::new();
        while let Some(agent) = list.next_element()? {
            if agents.len() == AGENTS_MAX {
                return Err(A::Error::invalid_length(AGENTS_MAX + 1, &self));
            }
            agents.push(agent);
        }
        Ok(agents)
    }
}

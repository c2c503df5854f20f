//! A scenario and a database → a recording, with progress, notes for the user, and the durations of the stages.

use std::path::Path;
use std::sync::Arc;

use fbcrowd_sim::behaviour::EndlessTransitions;
use fbcrowd_sim::planning::Planner;
use fbcrowd_sim::population::{GoalCount, Population, SourceCount};
use fbcrowd_sim::recording::{Header, Recorder};
use fbcrowd_sim::route::mesh::ClosedPassage;
use fbcrowd_sim::route::{ClosedToAgents, closed_to_agents};
use fbcrowd_sim::scenario::Scenario;
use fbcrowd_sim::simulation::Simulation;
use fbcrowd_sim::synthesis::library::{self, HybridData};
use motiondb::memory;
use motiondb::motion::MotionDb;
use motiondb::quality::coverage;

use crate::error::JobError;
use crate::observer::{JobEvent, Observer, Work};
use crate::timings::{StepStopwatch, Timings};

/// Memory of each agent in a simulation, bytes; measured: 2,700.
pub(crate) const AGENT_BYTES: usize = 3_000;

/// Greatest number of closed passages that are noted one by one.
const PASSAGES_NOTED: usize = 5;

/// What is simulated.
pub struct SimulationInput {
    /// The database that the bodies move by.
    pub db: MotionDb,
    /// Checksum of the database's file; the recording keeps it.
    pub database_checksum: u32,
    /// The scenario.
    pub scenario: Scenario,
    /// Checksums of the files of the scenario's characters, in their order; the recording keeps them.
    pub character_checksums: Vec<u32>,
}

/// Simulates a scenario into a recording.
///
/// # Errors
/// If the planner's time horizon is shorter than a switch of synthesis, or the recording cannot be written.
pub fn simulate(input: SimulationInput, recording: &Path, observer: &Observer) -> Result<Timings, JobError> {
    let mut prepared = prepare(Arc::new(input.db), input.scenario, observer)?;
    prepared.character_checksums = input.character_checksums;
    prepared.record(input.database_checksum, recording, observer)
}

/// A simulation at its start: nothing can fail any more but the writing of its recording.
pub struct PreparedSimulation {
    scenario: Scenario,
    simulation: Simulation,
    /// Checksums of the files of the scenario's characters, in their order.
    pub character_checksums: Vec<u32>,
}

/// Prepares a simulation; writes nothing.
///
/// # Errors
/// Where the planner looks less far ahead than a change of synthesis takes, or the system has too little memory.
pub fn prepare(db: Arc<MotionDb>, scenario: Scenario, observer: &Observer) -> Result<PreparedSimulation, JobError> {
    check_memory(scenario.agents.len())?;
    if let Some(style) = scenario.styles.iter().find(|style| db.of_style(style).is_none()) {
        let existing = db.style_names().into_iter().filter(|style| !style.is_empty()).collect();
        return Err(JobError::NoStyle { style: style.clone(), existing });
    }
    let simulation = Simulation::new(Arc::clone(&db), &scenario);
    if let Some(error) = simulation.route_error() {
        return Err(error.clone().into());
    }
    note_missing_motions(&db, simulation.database(), "", observer);
    for (style, complete) in scenario.styles.iter().zip(simulation.style_databases()) {
        note_missing_motions(db.of_style(style).unwrap_or(&db), complete, &format!("style `{style}`: "), observer);
    }
    note_closed_passages(&scenario, observer);
    check_horizon(simulation.database(), &scenario)?;
    simulation.style_databases().try_for_each(|db| check_horizon(db, &scenario))?;
    Ok(PreparedSimulation { scenario, simulation, character_checksums: Vec::new() })
}

/// Checks that the system gives the memory that a crowd needs.
fn check_memory(agents: usize) -> Result<(), JobError> {
    let bytes = agents * AGENT_BYTES;
    if memory::has_room(bytes) { Ok(()) } else { Err(JobError::OutOfMemory { agents, mib: bytes >> 20 }) }
}

impl PreparedSimulation {
    /// Simulates into a recording, which keeps the checksum of the database's file.
    ///
    /// # Errors
    /// Where the recording cannot be written.
    pub fn record(self, database_checksum: u32, recording: &Path, observer: &Observer) -> Result<Timings, JobError> {
        let Self { scenario, mut simulation, character_checksums } = self;
        let steps = scenario.steps();
        let db = simulation.database();
        let mut header = Header::new(db, database_checksum, scenario).with_extra_joints(db);
        for (character, checksum) in header.characters.iter_mut().zip(character_checksums) {
            character.checksum = checksum;
        }
        let mut recorder = Recorder::create(recording, &header)?;
        recorder.push_with_extra(simulation.frames(), simulation.extra_rotations())?;
        let (mut stopwatch, mut agent_steps) = (StepStopwatch::default(), 0);
        let work = Work::begin(observer, "steps", steps);
        for _ in 0..steps {
            stopwatch.start();
            simulation.step(&mut |stage| stopwatch.lap(stage));
            check_transitions(&simulation, &header)?;
            recorder.push_with_extra(simulation.frames(), simulation.extra_rotations())?;
            agent_steps += simulation.frames().len();
            work.advance();
        }
        work.end();
        if let Some(error) = simulation.route_error() {
            return Err(error.clone().into());
        }
        recorder.finish(simulation.population())?;
        note_waiting(simulation.population(), observer);
        note_full_goals(simulation.population(), &header.scenario, observer);
        header.scenario.barred_goals().iter().for_each(|barred| observer(JobEvent::Note(&barred.to_string())));
        header.scenario.notes().iter().for_each(|note| observer(JobEvent::Note(note)));
        Ok(stopwatch.timings(agent_steps, steps, header.scenario.dt_s))
    }
}

/// Notes where bodies move by more than the clips of their database, or can reach no goal with them; `of` names a
/// style.
fn note_missing_motions(db: &MotionDb, complete: &MotionDb, of: &str, observer: &Observer) {
    if !coverage::walks_ahead(db) {
        let note = "none of these clips walks ahead, so no agent reaches a goal; add a walk, and compile again";
        observer(JobEvent::Note(&format!("{of}{note}")));
    }
    if let Some((walk, count)) = library::deformed_walk(db, complete) {
        let missing = "these clips lack motions that a crowd needs (fbcrowd inspect names them)";
        observer(JobEvent::Note(&format!("{of}{missing}; {walk} is deformed to {count} of them")));
    }
}

/// Notes the passages that are too narrow for agents: those that separate parts of the ground, and how many there are.
fn note_closed_passages(scenario: &Scenario, observer: &Observer) {
    for ClosedToAgents { wall_radius_m, passages } in closed_to_agents(scenario) {
        let count = passages.len();
        for ClosedPassage { at_m, width_m, separates } in passages.into_iter().take(PASSAGES_NOTED) {
            let detour = if separates { "" } else { ", with a detour around it" };
            let (at, closed) = (format!("[{:.2}, {:.2}]", at_m.x, at_m.y), "is closed to agents with a wall radius of");
            observer(JobEvent::Note(&format!(
                "the passage at {at}, {width_m:.2} m wide, {closed} {wall_radius_m:.2} m{detour}"
            )));
        }
        if count > PASSAGES_NOTED {
            observer(JobEvent::Note(&format!("{} more passages are closed", count - PASSAGES_NOTED)));
        }
    }
}

/// Notes sources whose agents had no room.
fn note_waiting(population: &Population, observer: &Observer) {
    for (index, SourceCount { born, waiting, blocked_frames }) in population.sources.iter().enumerate() {
        if *waiting > 0 {
            let counts = format!("{born} agents came, {waiting} still wait, no room in {blocked_frames} frames");
            observer(JobEvent::Note(&format!("source {index} is blocked: {counts}; widen its area or lower its rate")));
        }
    }
}

/// Notes goals that had no room for all agents.
fn note_full_goals(population: &Population, scenario: &Scenario, observer: &Observer) {
    for (count, set) in population.goals.iter().zip(&scenario.behaviour.goals) {
        let &GoalCount { waiting, waiting_max, waiting_steps } = count;
        if waiting_steps > 0 {
            let time_s = waiting_steps as f32 * scenario.dt_s;
            let name = &set.name;
            let counts = format!("up to {waiting_max} agents waited during {time_s:.1} s, {waiting} still wait");
            let remedy = "add areas or capacity, or a transition with `after_s`";
            observer(JobEvent::Note(&format!("goals `{name}` were full: {counts}; {remedy}")));
        }
    }
}

/// Checks that the transitions of the last step ended.
fn check_transitions(simulation: &Simulation, header: &Header) -> Result<(), JobError> {
    let Some(EndlessTransitions { agent, time_s, states }) = simulation.endless_transitions() else { return Ok(()) };
    let states: Vec<&str> = states.iter().map(|state| header.states[*state as usize].as_str()).collect();
    Err(JobError::EndlessTransitions { agent: agent.0, time_s: *time_s, states: states.join("`, `") })
}

/// The planner must look further ahead than a change of synthesis takes (§3.4.1).
fn check_horizon(db: &MotionDb, scenario: &Scenario) -> Result<(), JobError> {
    let horizon_s = scenario.params.planner.time_horizon_s;
    match HybridData::new(db, scenario.modes()) {
        Some(HybridData { transition_s, .. }) if scenario.planner == Planner::Mcn && horizon_s <= transition_s => {
            Err(JobError::ShortHorizon { horizon_s, transition_s })
        }
        _ => Ok(()),
    }
}

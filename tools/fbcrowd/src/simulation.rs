//! Runs a simulation into a recording and measures the time that its stages take: what `simulate` and `run` share.

use std::path::Path;
use std::sync::Arc;
use std::time::{Duration, Instant};

use fbcrowd_sim::planning::Planner;
use fbcrowd_sim::recording::{AgentFrame, Header, Recorder};
use fbcrowd_sim::route::{BlockedPaths, blocked_paths};
use fbcrowd_sim::scenario::{Scenario, ScenarioError};
use fbcrowd_sim::simulation::{Simulation, Stage};
use fbcrowd_sim::synthesis::library;
use fbcrowd_sim::synthesis::library::HybridData;
use motiondb::motion::MotionDb;
use motiondb::quality::coverage;
use serde::Serialize;

use crate::failure::Failure;
use crate::output;
use crate::progress::Progress;

/// Where the time of a simulation went. Never part of a recording.
#[derive(Clone, Debug, Serialize)]
pub(crate) struct Timings {
    agents: usize,
    steps: usize,
    threads: usize,
    plan_microseconds_per_agent_step: f64,
    synthesis_microseconds_per_agent_step: f64,
    coupling_microseconds_per_agent_step: f64,
    /// Simulated time over the time that all stages took, recording left out.
    times_real_time: f64,
    /// Agents that one core carries in real time at this dt, counting every thread as busy throughout.
    agents_per_core_in_real_time: f64,
}

impl Timings {
    /// One line each.
    pub(crate) fn text(&self) -> String {
        format!(
            "time per agent and step  planning {:.2} µs, synthesis {:.2} µs, coupling {:.2} µs\n\
             speed                    {:.1} × real time with {} thread{}; one core carries {:.0} agents in real time\n",
            self.plan_microseconds_per_agent_step,
            self.synthesis_microseconds_per_agent_step,
            self.coupling_microseconds_per_agent_step,
            self.times_real_time,
            self.threads,
            if self.threads == 1 { "" } else { "s" },
            self.agents_per_core_in_real_time,
        )
    }
}

/// A mistake in a scenario is shown where it stands.
impl From<ScenarioError> for Failure {
    fn from(error: ScenarioError) -> Self {
        match error {
            ScenarioError::Unreadable { .. } => Self::bad(error.to_string()),
            ScenarioError::Invalid(invalid) => Self::mistake(*invalid),
        }
    }
}

/// Simulates a scenario on a database into a recording.
pub(crate) fn simulate(
    db: MotionDb,
    database_checksum: u32,
    scenario: Scenario,
    recording: &Path,
) -> Result<Timings, Failure> {
    let db = Arc::new(db);
    let mut simulation = Simulation::new(Arc::clone(&db), &scenario);
    tell_of_deformed(&db, simulation.database());
    check_horizon(simulation.database(), &scenario)?;
    let steps = (scenario.duration_s / scenario.dt_s).round() as usize;
    let header = Header::new(simulation.database(), database_checksum, scenario);
    let bad = |error: fbcrowd_sim::recording::RecordingError| Failure::bad(error.to_string());
    let mut recorder = Recorder::create(recording, &header).map_err(bad)?;
    recorder.push(simulation.frames()).map_err(bad)?;
    let mut stopwatch = Stopwatch::default();
    let progress = Progress::new("steps", steps);
    for _ in 0..steps {
        stopwatch.start();
        simulation.step(&mut |stage| stopwatch.lap(stage));
        recorder.push(simulation.frames()).map_err(bad)?;
        progress.advance();
    }
    progress.finish();
    recorder.finish().map_err(bad)?;
    tell_of_walls(&header.scenario, simulation.frames());
    Ok(stopwatch.timings(header.scenario.agents.len(), steps, header.scenario.dt_s))
}

/// Says where bodies move by more than the clips of their database, or can reach no goal with them.
fn tell_of_deformed(db: &MotionDb, complete: &MotionDb) {
    if !coverage::walks_ahead(db) {
        output::say("note: none of these clips walks ahead, so nobody will reach a goal; add a walk, and compile anew");
    }
    if let Some((walk, count)) = library::deformed_walk(db, complete) {
        let lacking = "these clips lack ways of walking that a crowd needs (fbcrowd inspect names them)";
        output::say(&format!("note: {lacking}; {walk} is deformed to {count} of them"));
    }
}

/// Says who has not arrived because of a wall.
fn tell_of_walls(scenario: &Scenario, frames: &[AgentFrame]) {
    let ends_m = frames.iter().map(|frame| frame.root.position_m);
    let Some(BlockedPaths { agent, waypoint, agents }) = blocked_paths(scenario, ends_m) else { return };
    let [x, y] = scenario.agents[agent].goals_m[waypoint].to_array();
    let others = if agents == 1 { String::new() } else { format!(" ({agents} agents have)") };
    let remedy = "agents walk straight: who is to go round needs a waypoint beside it";
    output::say(&format!("note: agent {agent} has a wall across its way to [{x}, {y}]{others}; {remedy}"));
}

/// §3.4.1: the planner must look further ahead than a change of synthesis takes.
fn check_horizon(db: &MotionDb, scenario: &Scenario) -> Result<(), Failure> {
    let horizon_s = scenario.params.planner.time_horizon_s;
    match HybridData::new(db, scenario.modes()) {
        Some(HybridData { transition_s, .. }) if scenario.planner == Planner::Mcn && horizon_s <= transition_s => {
            Err(Failure::bad(format!(
                "the planner looks {horizon_s} s ahead, but with this database a change of synthesis takes up to \
                 {transition_s:.2} s; give `time_horizon_s` more than that under [params.planner], or \
                 `modes = \"blending\"` under [params.synthesis]"
            )))
        }
        _ => Ok(()),
    }
}

/// Time per stage; path and neighbours count as planning.
#[derive(Debug, Default)]
struct Stopwatch {
    last: Option<Instant>,
    planning: Duration,
    synthesis: Duration,
    coupling: Duration,
}

impl Stopwatch {
    fn start(&mut self) {
        self.last = Some(Instant::now());
    }

    fn lap(&mut self, stage: Stage) {
        let now = Instant::now();
        let spent = self.last.replace(now).map_or(Duration::ZERO, |last| now - last);
        match stage {
            Stage::Path | Stage::Neighbours | Stage::Planning => self.planning += spent,
            Stage::Synthesis => self.synthesis += spent,
            Stage::Coupling => self.coupling += spent,
        }
    }

    fn timings(&self, agents: usize, steps: usize, dt_s: f32) -> Timings {
        let agent_steps = (agents * steps).max(1) as f64;
        let microseconds = |spent: Duration| spent.as_secs_f64() * 1e6 / agent_steps;
        let total = self.planning + self.synthesis + self.coupling;
        let threads = rayon::current_num_threads();
        let times_real_time = steps as f64 * f64::from(dt_s) / total.as_secs_f64().max(1e-9);
        Timings {
            agents,
            steps,
            threads,
            plan_microseconds_per_agent_step: microseconds(self.planning),
            synthesis_microseconds_per_agent_step: microseconds(self.synthesis),
            coupling_microseconds_per_agent_step: microseconds(self.coupling),
            times_real_time,
            agents_per_core_in_real_time: times_real_time * agents as f64 / threads as f64,
        }
    }
}

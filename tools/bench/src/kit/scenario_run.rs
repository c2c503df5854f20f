//! Scenario files that are simulated with all positions kept, so that any measure of the crowd can be computed later.
//!
//! The files are compiled in (`assets/scenarios`), so that no bench depends on its working folder.

use std::fs;
use std::path::{Path, PathBuf};
use std::sync::Arc;

use fbcrowd_jobs::{JobError, Observer};
use fbcrowd_render::plots::crowd::trajectories;
use fbcrowd_render::raster::png_frame;
use fbcrowd_render::top_view::Tracks;
use fbcrowd_sim::measures::{Measures, Measuring};
use fbcrowd_sim::recording::Header;
use fbcrowd_sim::scenario::{self, Scenario};
use fbcrowd_sim::simulation::Simulation;
use glam::Vec2;
use motiondb::files::SourceText;
use motiondb::motion::MotionDb;

use crate::error::BenchError;
use crate::kit::threads::run_each_on_one_thread;

/// A scenario file of `assets/scenarios`: its path in that folder, and its text.
pub(crate) type ScenarioFile = (&'static str, &'static str);

/// A [`ScenarioFile`] by its path.
macro_rules! scenario_file {
    ($path:literal) => {
        ($path, include_str!(concat!("../../../../assets/scenarios/", $path)))
    };
}
pub(crate) use scenario_file;

/// A scenario that has been simulated.
#[derive(Clone, Debug)]
pub(crate) struct ScenarioRun {
    /// The scenario.
    pub(crate) scenario: Scenario,
    /// Its measures.
    pub(crate) measures: Measures,
    /// Positions of the synthesised roots.
    pub(crate) tracks: Tracks,
}

/// The roots of all agents before and after one step, by id; NaN where an agent is not present.
#[derive(Clone, Debug)]
pub(crate) struct StepRoots {
    /// Positions before the step, m.
    pub(crate) before_m: Vec<Vec2>,
    /// Positions after the step, m.
    pub(crate) after_m: Vec<Vec2>,
    /// Time at the end of the step, s.
    pub(crate) end_s: f64,
}

impl ScenarioRun {
    /// All steps in order.
    pub(crate) fn steps(&self) -> impl Iterator<Item = StepRoots> {
        (1..self.tracks.frame_count).map(|frame| StepRoots {
            before_m: self.roots_m(frame - 1),
            after_m: self.roots_m(frame),
            end_s: frame as f64 * self.dt_s(),
        })
    }

    /// The roots of all agents in a frame, by id, m; NaN where an agent is not present.
    pub(crate) fn roots_m(&self, frame: usize) -> Vec<Vec2> {
        let agents = 0..self.agent_count();
        agents.map(|agent| self.tracks.position_m(agent, frame).unwrap_or(Vec2::NAN)).collect()
    }

    /// Number of agents that were present at any time.
    pub(crate) fn agent_count(&self) -> usize {
        self.tracks.agents.len()
    }

    /// Time step, s.
    pub(crate) fn dt_s(&self) -> f64 {
        f64::from(self.scenario.dt_s)
    }
}

/// The scenario of a file. The motion that the file names is ignored: a bench has its own database.
pub(crate) fn scenario((path, text): ScenarioFile) -> Result<Scenario, BenchError> {
    scenario_of_text(path, text.to_owned())
}

/// The scenario of a file that states no seed, with a seed.
pub(crate) fn seeded((path, text): ScenarioFile, seed: u64) -> Result<Scenario, BenchError> {
    scenario_of_text(path, format!("seed = {seed}\n{text}"))
}

/// The scenario of a text; `path` is for messages.
fn scenario_of_text(path: &str, text: String) -> Result<Scenario, BenchError> {
    let (scenario, _) = scenario::parse(&SourceText { path: PathBuf::from(path), text })?;
    Ok(scenario)
}

/// A scenario with everything in it turned about the origin.
pub(crate) fn turned(scenario: &Scenario, turn_rad: f32) -> Scenario {
    let turn = Vec2::from_angle(turn_rad);
    let mut scenario = scenario.clone();
    for agent in &mut scenario.agents {
        agent.position_m = turn.rotate(agent.position_m);
        agent.facing_rad += turn_rad;
        agent.goals_m.iter_mut().for_each(|goal_m| *goal_m = turn.rotate(*goal_m));
    }
    scenario.obstacles_m.iter_mut().flatten().for_each(|corner_m| *corner_m = turn.rotate(*corner_m));
    scenario
}

/// Number of time steps of a scenario.
pub(crate) fn step_count(scenario: &Scenario) -> usize {
    (scenario.duration_s / scenario.dt_s).round() as usize
}

/// Simulates all scenarios, each on one thread.
pub(crate) fn run_scenarios(
    db: &Arc<MotionDb>,
    scenarios: Vec<Scenario>,
    observer: &Observer,
) -> Result<Vec<ScenarioRun>, BenchError> {
    let results = run_each_on_one_thread(scenarios.len(), observer, |index| simulate(db, &scenarios[index]))?;
    let runs = scenarios.into_iter().zip(results);
    Ok(runs.map(|(scenario, (measures, tracks))| ScenarioRun { scenario, measures, tracks }).collect())
}

fn simulate(db: &Arc<MotionDb>, scenario: &Scenario) -> (Measures, Tracks) {
    let mut simulation = Simulation::new(Arc::clone(db), scenario);
    let mut measuring = Measuring::new(&db.skeleton, scenario, simulation.population(), simulation.frames());
    let mut tracks = Tracks::new(scenario.dt_s);
    tracks.push_frame(simulation.frames());
    for _ in 0..step_count(scenario) {
        simulation.step(&mut |_| {});
        measuring.push(simulation.population(), simulation.frames());
        tracks.push_frame(simulation.frames());
    }
    (measuring.finish(simulation.population()), tracks)
}

/// Draws the paths of all agents.
pub(crate) fn draw_paths(path: &Path, db: &MotionDb, run: &ScenarioRun) -> Result<(), BenchError> {
    create_parent(path)?;
    let header = Header::new(db, 0, run.scenario.clone());
    Ok(png_frame::write(path, &trajectories(&header, &run.tracks))?)
}

/// Creates the folder of a file.
pub(crate) fn create_parent(path: &Path) -> Result<(), BenchError> {
    match path.parent() {
        Some(folder) => Ok(fs::create_dir_all(folder).map_err(|error| JobError::unwritable(folder, error))?),
        None => Ok(()),
    }
}

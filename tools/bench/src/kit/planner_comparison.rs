//! Planners side by side: the same scenes and the same bodies, one run for each planner, scene and seed.

use std::fs;
use std::path::{Path, PathBuf};
use std::sync::Arc;
use std::time::{Duration, Instant};

use fbcrowd_jobs::{JobError, Observer};
use fbcrowd_render::top_view::Tracks;
use fbcrowd_sim::measures::{Measures, Measuring, write_roots};
use fbcrowd_sim::params::Params;
use fbcrowd_sim::planning::Planner;
use fbcrowd_sim::recording::AgentFrame;
use fbcrowd_sim::scenario::{Coupling, Scenario};
use fbcrowd_sim::simulation::{Simulation, Stage};
use fbcrowd_sim::synthesis::Modes;
use motiondb::files::atomic_file::AtomicFile;
use motiondb::motion::MotionDb;

use crate::error::BenchError;
use crate::kit::scenario_run::step_count;
use crate::kit::scenes::{self, Scene};
use crate::kit::threads::run_each_on_one_thread;

/// A planner of the comparison.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct ComparedPlanner {
    /// Name in tables, JSON and file names.
    pub(crate) name: &'static str,
    /// The planner.
    pub(crate) planner: Planner,
    /// Sub-steps per time step; of social forces only.
    substeps: u32,
}

/// The paper's planner.
pub(crate) const MCN: ComparedPlanner = ComparedPlanner { name: "mcn", planner: Planner::Mcn, substeps: 1 };
/// Baseline: optimal reciprocal collision avoidance.
pub(crate) const ORCA: ComparedPlanner = ComparedPlanner { name: "orca", planner: Planner::Orca, substeps: 1 };
/// Baseline: social forces by the power law of the time to collision.
pub(crate) const SOCIAL_FORCE: ComparedPlanner =
    ComparedPlanner { name: "social_force", planner: Planner::SocialForce, substeps: 1 };
/// The same forces in sub-steps of 5 ms, as their authors integrate them (Karamouzas, Skinner, Guy 2014).
pub(crate) const SOCIAL_FORCE_20: ComparedPlanner =
    ComparedPlanner { name: "social_force_20_substeps", planner: Planner::SocialForce, substeps: 20 };

/// How every run of a comparison is made.
#[derive(Clone, Debug)]
pub(crate) struct Protocol {
    /// Time step, s.
    pub(crate) dt_s: f32,
    /// Coupling of discs and bodies.
    pub(crate) coupling: Coupling,
    /// Kinds of synthesis.
    pub(crate) modes: Modes,
    /// Whether a run ends as soon as all agents are at their goals, instead of after 60 s.
    pub(crate) until_all_are_at_goals: bool,
    /// Whether the positions are kept, for pictures.
    pub(crate) keeps_tracks: bool,
    /// Folder for files of positions; none is written without.
    pub(crate) trajectories: Option<PathBuf>,
}

impl Default for Protocol {
    /// The protocol of Table 1, with our bodies.
    fn default() -> Self {
        Self {
            dt_s: scenes::STEP_S,
            coupling: Coupling::default(),
            modes: Modes::default(),
            until_all_are_at_goals: false,
            keeps_tracks: false,
            trajectories: None,
        }
    }
}

/// One run of a comparison.
#[derive(Clone, Debug)]
pub(crate) struct ComparisonRun {
    /// Seed of the scene.
    pub(crate) seed: u64,
    /// Measures of the recording.
    pub(crate) measures: Measures,
    /// Route, neighbour search and planning, µs per agent and step.
    pub(crate) plan_microseconds_per_agent_step: f64,
    /// Positions of the synthesised roots; empty unless kept.
    pub(crate) tracks: Tracks,
}

/// Runs every planner on every scene; the runs come by scene, then by planner.
pub(crate) fn compare(
    db: &Arc<MotionDb>,
    scenes: &[Scene],
    planners: &[ComparedPlanner],
    protocol: &Protocol,
    observer: &Observer,
) -> Result<Vec<ComparisonRun>, BenchError> {
    if let Some(folder) = &protocol.trajectories {
        fs::create_dir_all(folder).map_err(|error| JobError::unwritable(folder, error))?;
    }
    let runs = run_each_on_one_thread(scenes.len() * planners.len(), observer, |index| {
        run(db, &scenes[index / planners.len()], &planners[index % planners.len()], protocol)
    });
    runs?.into_iter().collect()
}

fn run(
    db: &Arc<MotionDb>,
    scene: &Scene,
    planner: &ComparedPlanner,
    protocol: &Protocol,
) -> Result<ComparisonRun, BenchError> {
    let mut params = Params::default();
    params.social_force.substeps = planner.substeps;
    params.synthesis.modes = protocol.modes;
    let scenario = Scenario { dt_s: protocol.dt_s, ..scene.scenario(planner.planner, protocol.coupling, params) };
    let mut simulation = Simulation::new(Arc::clone(db), &scenario);
    let mut positions = Positions::create(scene, planner, protocol)?;
    positions.push(simulation.frames())?;
    let mut measuring = Measuring::new(&db.skeleton, &scenario, simulation.population(), simulation.frames());
    let (mut planning, mut steps) = (Duration::ZERO, 0);
    while steps < step_count(&scenario) && !(protocol.until_all_are_at_goals && measuring.all_are_at_goals()) {
        planning += timed_step(&mut simulation);
        steps += 1;
        measuring.push(simulation.population(), simulation.frames());
        positions.push(simulation.frames())?;
    }
    let agent_steps = (steps * scene.agents.len()).max(1) as f64;
    Ok(ComparisonRun {
        seed: scene.seed,
        measures: measuring.finish(simulation.population()),
        plan_microseconds_per_agent_step: planning.as_secs_f64() * 1e6 / agent_steps,
        tracks: positions.finish()?,
    })
}

/// Makes one step; returns the duration of path, neighbour search and planning.
fn timed_step(simulation: &mut Simulation) -> Duration {
    let (start, mut planning) = (Instant::now(), Duration::ZERO);
    simulation.step(&mut |stage| {
        if stage == Stage::Planning {
            planning = start.elapsed();
        }
    });
    planning
}

/// Root positions of a run, kept or written as the protocol demands.
struct Positions {
    tracks: Option<Tracks>,
    file: Option<(PathBuf, AtomicFile)>,
}

impl Positions {
    fn create(scene: &Scene, planner: &ComparedPlanner, protocol: &Protocol) -> Result<Self, BenchError> {
        let name = format!("{}_s{}_{}.txt", scene.name, scene.seed, planner.name);
        let create_in = |folder: &PathBuf| {
            let path = folder.join(name);
            let file = AtomicFile::create(&path).map_err(|error| unwritable(&path, error))?;
            Ok::<_, BenchError>((path, file))
        };
        Ok(Self {
            tracks: protocol.keeps_tracks.then(|| Tracks::new(protocol.dt_s)),
            file: protocol.trajectories.as_ref().map(create_in).transpose()?,
        })
    }

    fn push(&mut self, agents: &[AgentFrame]) -> Result<(), BenchError> {
        if let Some(tracks) = &mut self.tracks {
            tracks.push_frame(agents);
        }
        match &mut self.file {
            Some((path, file)) => write_roots(agents, file.writer()).map_err(|error| unwritable(path, error)),
            None => Ok(()),
        }
    }

    fn finish(self) -> Result<Tracks, BenchError> {
        if let Some((path, file)) = self.file {
            file.commit().map_err(|error| unwritable(&path, error))?;
        }
        Ok(self.tracks.unwrap_or_default())
    }
}

fn unwritable(path: &Path, error: std::io::Error) -> BenchError {
    JobError::unwritable(path, error).into()
}

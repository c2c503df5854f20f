//! Planners run against each other: the same scenes, the same bodies, one run a planner, scene and seed.
//!
//! Runs are shared out among threads, each of which works alone: its own pool of one thread keeps a run from being
//! interrupted by another, so that planning times are those of one thread. Figures do not depend on it.

use std::fs;
use std::path::PathBuf;
use std::sync::Arc;
use std::sync::atomic::{AtomicUsize, Ordering};
use std::thread;
use std::time::{Duration, Instant};

use fbcrowd_render::top_view::Tracks;
use fbcrowd_sim::measures::{Measures, Measuring, write_roots};
use fbcrowd_sim::params::Params;
use fbcrowd_sim::planning::Planner;
use fbcrowd_sim::recording::AgentFrame;
use fbcrowd_sim::scenario::{Coupling, Scenario};
use fbcrowd_sim::simulation::{Simulation, Stage};
use fbcrowd_sim::synthesis::Modes;
use glam::Vec2;
use motiondb::files::atomic_file::AtomicFile;
use motiondb::motion::MotionDb;

use crate::cmd::bench::scenes::{self, Scene};
use crate::failure::Failure;
use crate::progress::Progress;

/// A planner as it takes part.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Contestant {
    /// In tables, JSON and names of files.
    pub(super) name: &'static str,
    pub(super) planner: Planner,
    /// Of social forces.
    substeps: u32,
}

pub(super) const MCN: Contestant = Contestant { name: "mcn", planner: Planner::Mcn, substeps: 1 };
pub(super) const ORCA: Contestant = Contestant { name: "orca", planner: Planner::Orca, substeps: 1 };
pub(super) const SOCIAL_FORCE: Contestant =
    Contestant { name: "social_force", planner: Planner::SocialForce, substeps: 1 };
/// The same forces, integrated as finely as their authors do: in steps of 5 ms (Karamouzas, Skinner, Guy 2014).
pub(super) const SOCIAL_FORCE_20: Contestant =
    Contestant { name: "social_force_20_substeps", planner: Planner::SocialForce, substeps: 20 };

/// How all of them run.
#[derive(Clone, Debug)]
pub(super) struct Protocol {
    pub(super) dt_s: f32,
    pub(super) coupling: Coupling,
    pub(super) modes: Modes,
    /// Ends a run as soon as all are at their goals at once, instead of after 60 s.
    pub(super) until_all_are_at_goals: bool,
    /// Keeps the paths, to draw them.
    pub(super) keeps_tracks: bool,
    /// Where to write the paths.
    pub(super) trajectories: Option<PathBuf>,
}

impl Default for Protocol {
    /// That of Table 1, with our bodies.
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

/// What one run gave.
#[derive(Clone, Debug)]
pub(super) struct Run {
    pub(super) seed: u64,
    pub(super) measures: Measures,
    pub(super) plan_microseconds_per_agent_step: f64,
    /// Empty unless kept.
    pub(super) tracks: Tracks,
}

/// Runs every contestant on every scene; by scene, then by contestant.
pub(super) fn run_all(
    db: &Arc<MotionDb>,
    scenes: &[Scene],
    contestants: &[Contestant],
    protocol: &Protocol,
) -> Result<Vec<Run>, Failure> {
    if let Some(folder) = &protocol.trajectories {
        fs::create_dir_all(folder).map_err(|error| Failure::unwritable(folder, &error))?;
    }
    let runs = each_alone(scenes.len() * contestants.len(), |index| {
        run(db, &scenes[index / contestants.len()], &contestants[index % contestants.len()], protocol)
    });
    runs?.into_iter().collect()
}

/// So many runs shared out among threads; what they gave by index.
pub(super) fn each_alone<T: Send>(count: usize, run: impl Fn(usize) -> T + Sync) -> Result<Vec<T>, Failure> {
    let (next, progress) = (AtomicUsize::new(0), Progress::new("runs", count));
    let work = || {
        let mut done = Vec::new();
        loop {
            let index = next.fetch_add(1, Ordering::Relaxed);
            if index >= count {
                return done;
            }
            done.push((index, run(index)));
            progress.advance();
        }
    };
    let mut runs = in_threads(work)?;
    progress.finish();
    runs.sort_by_key(|(index, _)| *index);
    Ok(runs.into_iter().map(|(_, run)| run).collect())
}

/// Does the same work in as many threads as may be used, each with a pool of its own that has no other.
fn in_threads<T: Send>(work: impl Fn() -> Vec<T> + Sync) -> Result<Vec<T>, Failure> {
    let alone = || rayon::ThreadPoolBuilder::new().num_threads(1).build();
    let pools = (0..rayon::current_num_threads()).map(|_| alone()).collect::<Result<Vec<_>, _>>();
    let pools = pools.map_err(|error| Failure::bad(format!("cannot start threads: {error}; ask for fewer")))?;
    Ok(thread::scope(|scope| {
        let threads: Vec<_> = pools.iter().map(|pool| scope.spawn(|| pool.install(&work))).collect();
        threads.into_iter().flat_map(|thread| thread.join().expect("no simulation panics")).collect()
    }))
}

fn run(db: &Arc<MotionDb>, scene: &Scene, contestant: &Contestant, protocol: &Protocol) -> Result<Run, Failure> {
    let mut params = Params::default();
    params.social_force.substeps = contestant.substeps;
    params.synthesis.modes = protocol.modes;
    let scenario = Scenario { dt_s: protocol.dt_s, ..scene.scenario(contestant.planner, protocol.coupling, params) };
    let mut simulation = Simulation::new(Arc::clone(db), &scenario);
    let mut paths = Paths::begin(scene, contestant, protocol)?;
    paths.push(simulation.frames())?;
    let mut measuring = Measuring::new(&db.skeleton, &scenario, simulation.frames());
    let (mut planning, mut steps) = (Duration::ZERO, 0);
    while steps < step_count(&scenario) && !(protocol.until_all_are_at_goals && measuring.all_are_at_goals()) {
        planning += advance(&mut simulation);
        steps += 1;
        measuring.push(simulation.frames());
        paths.push(simulation.frames())?;
    }
    let agent_steps = (steps * scene.agents.len()).max(1) as f64;
    Ok(Run {
        seed: scene.seed,
        measures: measuring.finish(),
        plan_microseconds_per_agent_step: planning.as_secs_f64() * 1e6 / agent_steps,
        tracks: paths.finish(scenario.dt_s)?,
    })
}

pub(super) fn step_count(scenario: &Scenario) -> usize {
    (scenario.duration_s / scenario.dt_s).round() as usize
}

/// One step; returns the time of path, neighbours and planning.
fn advance(simulation: &mut Simulation) -> Duration {
    let (start, mut planning) = (Instant::now(), Duration::ZERO);
    simulation.step(&mut |stage| {
        if stage == Stage::Planning {
            planning = start.elapsed();
        }
    });
    planning
}

/// The paths of a run, kept or written as far as they are wanted.
struct Paths {
    agent_count: usize,
    positions_m: Option<Vec<Vec2>>,
    file: Option<(PathBuf, AtomicFile)>,
}

impl Paths {
    fn begin(scene: &Scene, contestant: &Contestant, protocol: &Protocol) -> Result<Self, Failure> {
        let name = format!("{}_s{}_{}.txt", scene.name, scene.seed, contestant.name);
        let create = |folder: &PathBuf| {
            let path = folder.join(name);
            AtomicFile::create(&path)
                .map(|file| (path.clone(), file))
                .map_err(|error| Failure::unwritable(&path, &error))
        };
        Ok(Self {
            agent_count: scene.agents.len(),
            positions_m: protocol.keeps_tracks.then(Vec::new),
            file: protocol.trajectories.as_ref().map(create).transpose()?,
        })
    }

    fn push(&mut self, agents: &[AgentFrame]) -> Result<(), Failure> {
        if let Some(positions_m) = &mut self.positions_m {
            positions_m.extend(agents.iter().map(|agent| agent.root.position_m));
        }
        match &mut self.file {
            Some((path, file)) => write_roots(agents, file.writer()).map_err(|error| Failure::unwritable(path, &error)),
            None => Ok(()),
        }
    }

    fn finish(self, dt_s: f32) -> Result<Tracks, Failure> {
        if let Some((path, file)) = self.file {
            file.commit().map_err(|error| Failure::unwritable(&path, &error))?;
        }
        Ok(Tracks { agent_count: self.agent_count, dt_s, positions_m: self.positions_m.unwrap_or_default() })
    }
}

//! Scenario files run and watched: everybody's path is kept, so that whatever is asked of a crowd is read off it later.
//!
//! The files are compiled in (`assets/scenarios`), so that no bench depends on the folder it is run in.

use std::fs;
use std::path::{Path, PathBuf};
use std::sync::Arc;

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

use crate::cmd::bench::contest::{each_alone, step_count};
use crate::failure::Failure;

/// A scenario file of `assets/scenarios`: its path there and its text.
macro_rules! scenario_text {
    ($path:literal) => {
        ($path, include_str!(concat!("../../../../../assets/scenarios/", $path)))
    };
}
pub(super) use scenario_text;

/// A scenario that has been played.
#[derive(Clone, Debug)]
pub(super) struct Watched {
    pub(super) scenario: Scenario,
    pub(super) measures: Measures,
    /// The synthesised roots.
    pub(super) tracks: Tracks,
}

/// One step as it was seen: the roots before and after it.
#[derive(Clone, Copy, Debug)]
pub(super) struct Seen<'a> {
    pub(super) before_m: &'a [Vec2],
    pub(super) after_m: &'a [Vec2],
    pub(super) end_s: f64,
}

impl Watched {
    pub(super) fn steps(&self) -> impl Iterator<Item = Seen<'_>> {
        (1..self.tracks.frame_count()).map(|frame| Seen {
            before_m: self.tracks.frame_m(frame - 1),
            after_m: self.tracks.frame_m(frame),
            end_s: frame as f64 * self.dt_s(),
        })
    }

    pub(super) fn dt_s(&self) -> f64 {
        f64::from(self.scenario.dt_s)
    }
}

/// The scenario that a text tells.
pub(super) fn scenario((path, text): (&str, &str)) -> Result<Scenario, Failure> {
    let text = SourceText { path: PathBuf::from(path), text: text.to_owned() };
    // The bench brings its own database, whatever the file names.
    let (scenario, _) = scenario::parse(&text)?;
    Ok(scenario)
}

/// A scenario turned about the origin, everything in it.
pub(super) fn turned(scenario: &Scenario, turn_rad: f32) -> Scenario {
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

/// Plays all scenarios, each on one thread.
pub(super) fn watch_all(db: &Arc<MotionDb>, scenarios: Vec<Scenario>) -> Result<Vec<Watched>, Failure> {
    let played = each_alone(scenarios.len(), |index| watch(db, &scenarios[index]))?;
    Ok(scenarios
        .into_iter()
        .zip(played)
        .map(|(scenario, (measures, tracks))| Watched { scenario, measures, tracks })
        .collect())
}

fn watch(db: &Arc<MotionDb>, scenario: &Scenario) -> (Measures, Tracks) {
    let mut simulation = Simulation::new(Arc::clone(db), scenario);
    let mut measuring = Measuring::new(&db.skeleton, scenario, simulation.frames());
    let roots_m = |simulation: &Simulation| simulation.frames().iter().map(|agent| agent.root.position_m).collect();
    let mut positions_m: Vec<Vec2> = roots_m(&simulation);
    for _ in 0..step_count(scenario) {
        simulation.step(&mut |_| {});
        measuring.push(simulation.frames());
        positions_m.extend::<Vec<Vec2>>(roots_m(&simulation));
    }
    let tracks = Tracks { agent_count: scenario.agents.len(), dt_s: scenario.dt_s, positions_m };
    (measuring.finish(), tracks)
}

/// Draws everybody's path.
pub(super) fn write_paths(path: &Path, db: &MotionDb, watched: &Watched) -> Result<(), Failure> {
    if let Some(folder) = path.parent() {
        fs::create_dir_all(folder).map_err(|error| Failure::unwritable(folder, &error))?;
    }
    let header = Header::new(db, 0, watched.scenario.clone());
    png_frame::write(path, &trajectories(&header, &watched.tracks)).map_err(|error| Failure::bad(error.to_string()))
}

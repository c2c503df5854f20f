//! The comparison as pictures: the table, and everybody's paths in each scene's first seed.

use std::fs;
use std::path::Path;

use fbcrowd_render::error::RenderError;
use fbcrowd_render::plots::crowd::{ComparedMeasure, Comparison, PathPanel, comparison, side_by_side};
use fbcrowd_render::raster::png_frame;
use fbcrowd_sim::measures::Measures;

use crate::cmd::bench::contest::{Contestant, Run};
use crate::cmd::bench::scenes::Scene;
use crate::cmd::bench::table1::{CONTESTANTS, Details, RunFigures};
use crate::failure::Failure;

/// Writes both kinds into a folder: `table1.png` and `SCENE_s<seed>.png`.
pub(super) fn write(folder: &Path, details: &Details, scenes: &[Scene], runs: &[Run]) -> Result<(), Failure> {
    fs::create_dir_all(folder).map_err(|error| Failure::unwritable(folder, &error))?;
    png_frame::write(&folder.join("table1.png"), &comparison(&table(details))).map_err(bad)?;
    let mut drawn: Vec<&str> = Vec::new();
    for (scene, runs) in scenes.iter().zip(runs.chunks(CONTESTANTS.len())) {
        if !drawn.contains(&scene.name.as_str()) {
            drawn.push(&scene.name);
            write_paths(&folder.join(format!("{}_s{}.png", scene.name, scene.seed)), scene, &CONTESTANTS, runs)?;
        }
    }
    Ok(())
}

/// Writes one scene as every contestant leads it.
pub(super) fn write_paths(path: &Path, scene: &Scene, contestants: &[Contestant], runs: &[Run]) -> Result<(), Failure> {
    let panels: Vec<PathPanel> =
        contestants.iter().zip(runs).map(|(contestant, run)| path_panel(contestant, run)).collect();
    let seconds = runs.first().map_or(0.0, |run| run.measures.steps as f32 * run.measures.dt_s);
    let Scene { name, seed, agents } = scene;
    let title = format!("{name}, seed {seed}: paths of {} agents in {seconds:.0} s", agents.len());
    png_frame::write(path, &side_by_side(&title, agents, &[], &panels)).map_err(bad)
}

fn path_panel<'a>(contestant: &Contestant, run: &'a Run) -> PathPanel<'a> {
    PathPanel { heading: contestant.name.replace('_', " "), notes: notes(&run.measures), tracks: &run.tracks }
}

fn bad(error: RenderError) -> Failure {
    Failure::bad(error.to_string())
}

fn notes(measures: &Measures) -> Vec<String> {
    let time = measures.mean_time_to_goal_s.map_or_else(String::new, |time_s| format!(" after {time_s:.1} s"));
    vec![
        format!("C {:.5}, bodies {:.4} mm", measures.collision_rate, measures.body_penetration_mm),
        format!(
            "A {:.3} m/s², before arrival {:.3}",
            measures.mean_acceleration_mps2, measures.mean_acceleration_before_arrival_mps2
        ),
        format!("{} of {} arrive{time}, {} stall", measures.arrived, measures.agents, measures.stalled),
    ]
}

fn table(details: &Details) -> Comparison {
    let measure = |label: &str, value: fn(&RunFigures) -> Option<f64>| {
        let runs = |runs: &[RunFigures]| runs.iter().filter_map(value).map(|value| value as f32).collect();
        let planners = details.scenes.iter().map(|scene| scene.planners.iter().map(|planner| runs(&planner.runs)));
        ComparedMeasure { label: label.to_owned(), values: planners.map(Iterator::collect).collect() }
    };
    Comparison {
        title: "Planners through the same bodies: every run, mean ± deviation".to_owned(),
        groups: details.scenes.iter().map(|scene| scene.scene.clone()).collect(),
        series: CONTESTANTS.iter().map(|contestant| contestant.name.replace('_', " ")).collect(),
        measures: vec![
            measure("collisions C (Eq. 17)", |run| Some(run.measures.collision_rate)),
            measure("bodies in each other, mm", |run| Some(run.measures.body_penetration_mm)),
            measure("acceleration A (Eq. 18), m/s²", |run| Some(run.measures.mean_acceleration_mps2)),
            measure("acceleration before arrival, m/s²", |run| {
                Some(run.measures.mean_acceleration_before_arrival_mps2)
            }),
            measure("mean time to goal, s", |run| run.measures.mean_time_to_goal_s),
            measure("planning, µs an agent and step", |run| Some(run.plan_microseconds_per_agent_step)),
        ],
    }
}

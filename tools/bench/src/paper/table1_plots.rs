//! The pictures of `fbcrowd bench table1`: the table, and all paths in each scene's first seed.

use std::fs;
use std::path::Path;

use fbcrowd_jobs::JobError;
use fbcrowd_render::plots::crowd::{ComparedMeasure, Comparison, PathPanel, comparison, side_by_side};
use fbcrowd_render::raster::png_frame;
use fbcrowd_sim::measures::Measures;

use fbcrowd_sim::scenario::Scenario;

use crate::error::BenchError;
use crate::kit::planner_comparison::{ComparedPlanner, ComparisonRun};
use crate::kit::scenes::Scene;
use crate::paper::table1_figures::{RunFigures, SceneFigures};

/// Draws `table1.png` and `SCENE_s<seed>.png` into a folder.
pub(crate) fn draw(
    folder: &Path,
    figures: &[SceneFigures],
    planners: &[ComparedPlanner],
    scenes: &[Scene],
    runs: &[ComparisonRun],
) -> Result<(), BenchError> {
    fs::create_dir_all(folder).map_err(|error| JobError::unwritable(folder, error))?;
    png_frame::write(&folder.join("table1.png"), &comparison(&table(figures, planners)))?;
    let mut drawn: Vec<&str> = Vec::new();
    for (scene, runs) in scenes.iter().zip(runs.chunks(planners.len())) {
        if !drawn.contains(&scene.name.as_str()) {
            drawn.push(&scene.name);
            draw_paths(&folder.join(format!("{}_s{}.png", scene.name, scene.seed)), scene, planners, runs)?;
        }
    }
    Ok(())
}

/// Draws the paths of one scene with every planner.
pub(crate) fn draw_paths(
    path: &Path,
    scene: &Scene,
    planners: &[ComparedPlanner],
    runs: &[ComparisonRun],
) -> Result<(), BenchError> {
    let ways: Vec<PathPanel> = planners.iter().zip(runs).map(|(planner, run)| drawn_paths(planner, run)).collect();
    let seconds = runs.first().map_or(0.0, |run| run.measures.steps as f32 * run.measures.dt_s);
    let Scene { name, seed, agents } = scene;
    let title = format!("{name}, seed {seed}: paths of {} agents in {seconds:.0} s", agents.len());
    Ok(png_frame::write(path, &side_by_side(&title, &Scenario::of(agents.clone()), &ways))?)
}

fn drawn_paths<'a>(planner: &ComparedPlanner, run: &'a ComparisonRun) -> PathPanel<'a> {
    PathPanel { heading: planner.name.replace('_', " "), notes: notes(&run.measures), tracks: &run.tracks }
}

/// Measures beneath the paths.
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

/// Every run of every planner and scene.
fn table(figures: &[SceneFigures], compared: &[ComparedPlanner]) -> Comparison {
    let measure = |label: &str, value: fn(&RunFigures) -> Option<f64>| {
        let runs = |runs: &[RunFigures]| runs.iter().filter_map(value).map(|value| value as f32).collect();
        let planners = figures.iter().map(|scene| scene.planners.iter().map(|planner| runs(&planner.runs)));
        ComparedMeasure { label: label.to_owned(), values: planners.map(Iterator::collect).collect() }
    };
    Comparison {
        title: "Planners through the same bodies: every run, mean ± deviation".to_owned(),
        groups: figures.iter().map(|scene| scene.scene.clone()).collect(),
        series: compared.iter().map(|planner| planner.name.replace('_', " ")).collect(),
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

//! Measures of a comparison of planners: every run, and means over the seeds of each scene.

use fbcrowd_jobs::json_schema::measures::MeasuresMirror;
use fbcrowd_sim::measures::Measures;
use schemars::JsonSchema;
use serde::Serialize;

use crate::kit::planner_comparison::{ComparedPlanner, ComparisonRun};
use crate::kit::scenes::Scene;
use crate::kit::statistics::{Spread, spread};

/// What `fbcrowd bench table1` measures.
#[derive(JsonSchema, Serialize)]
pub struct Details {
    /// The scenes.
    pub scenes: Vec<SceneFigures>,
}

/// One scene with every planner.
#[derive(JsonSchema, Serialize)]
pub struct SceneFigures {
    /// Name of the scene.
    pub scene: String,
    /// Number of agents.
    pub agents: usize,
    /// The planners.
    pub planners: Vec<PlannerFigures>,
}

/// One planner in one scene: means and standard deviations (`…_sd`) over the seeds.
#[derive(JsonSchema, Serialize)]
pub struct PlannerFigures {
    /// Name of the planner.
    pub planner: &'static str,
    /// C (Eq. 17): overlap of discs as a share of both radii, summed over pairs, per agent and step; mean.
    pub collision_rate: f64,
    /// Standard deviation of `collision_rate`.
    pub collision_rate_sd: f64,
    /// A (Eq. 18): mean acceleration of the roots over all steps, m/s²; mean.
    pub mean_acceleration_mps2: f64,
    /// Standard deviation of `mean_acceleration_mps2`, m/s².
    pub mean_acceleration_mps2_sd: f64,
    /// Mean acceleration of the roots before each agent's arrival, m/s²; mean.
    pub mean_acceleration_before_arrival_mps2: f64,
    /// Standard deviation of `mean_acceleration_before_arrival_mps2`, m/s².
    pub mean_acceleration_before_arrival_mps2_sd: f64,
    /// Share of the agents that arrive, 0 to 1; mean.
    pub arrived_share: f64,
    /// Number of runs in which an agent stalls.
    pub stalled: usize,
    /// Mean time until arrival, s; mean; null where no agent arrives in any run.
    pub mean_time_to_goal_s: Option<f64>,
    /// Standard deviation of `mean_time_to_goal_s`, s; null where no agent arrives in any run.
    pub mean_time_to_goal_s_sd: Option<f64>,
    /// Deepest overlap of two bodies, summed over pairs, per agent and step, mm; mean.
    pub body_penetration_mm: f64,
    /// Standard deviation of `body_penetration_mm`, mm.
    pub body_penetration_mm_sd: f64,
    /// Route, neighbour search and planning, µs per agent and step; mean.
    pub plan_microseconds_per_agent_step: f64,
    /// The runs, one for each seed.
    pub runs: Vec<RunFigures>,
}

/// One run: its seed, the measures of `fbcrowd measure --json`, and the duration of planning.
#[derive(JsonSchema, Serialize)]
pub struct RunFigures {
    /// Seed of the scene.
    pub seed: u64,
    /// Measures of the run.
    #[serde(flatten)]
    #[schemars(with = "MeasuresMirror")]
    pub measures: Measures,
    /// Route, neighbour search and planning, µs per agent and step.
    pub plan_microseconds_per_agent_step: f64,
}

/// Means over the runs of each scene's name, in order of first appearance. Runs come by scene, then by planner.
pub(crate) fn figures(scenes: &[Scene], planners: &[ComparedPlanner], runs: &[ComparisonRun]) -> Vec<SceneFigures> {
    let mut names: Vec<&str> = Vec::new();
    for scene in scenes {
        if !names.contains(&scene.name.as_str()) {
            names.push(&scene.name);
        }
    }
    let by_scene: Vec<(&Scene, &[ComparisonRun])> = scenes.iter().zip(runs.chunks(planners.len())).collect();
    let of_name = |name: &str| {
        let of_scene: Vec<&(&Scene, &[ComparisonRun])> =
            by_scene.iter().filter(|(scene, _)| scene.name == name).collect();
        let of_planner = |(index, planner): (usize, &ComparedPlanner)| {
            planner_figures(planner.name, of_scene.iter().map(|(_, runs)| &runs[index]).collect())
        };
        SceneFigures {
            scene: name.to_owned(),
            agents: of_scene.first().map_or(0, |(scene, _)| scene.agents.len()),
            planners: planners.iter().enumerate().map(of_planner).collect(),
        }
    };
    names.into_iter().map(of_name).collect()
}

fn planner_figures(planner: &'static str, runs: Vec<&ComparisonRun>) -> PlannerFigures {
    let of = |value: fn(&ComparisonRun) -> f64| {
        spread(runs.iter().map(|run| value(run))).unwrap_or(Spread { mean: 0.0, deviation: 0.0 })
    };
    let collisions = of(|run| run.measures.collision_rate);
    let acceleration = of(|run| run.measures.mean_acceleration_mps2);
    let before_arrival = of(|run| run.measures.mean_acceleration_before_arrival_mps2);
    let bodies = of(|run| run.measures.body_penetration_mm);
    let time_to_goal = spread(runs.iter().filter_map(|run| run.measures.mean_time_to_goal_s));
    PlannerFigures {
        planner,
        collision_rate: collisions.mean,
        collision_rate_sd: collisions.deviation,
        mean_acceleration_mps2: acceleration.mean,
        mean_acceleration_mps2_sd: acceleration.deviation,
        mean_acceleration_before_arrival_mps2: before_arrival.mean,
        mean_acceleration_before_arrival_mps2_sd: before_arrival.deviation,
        arrived_share: of(|run| run.measures.arrived as f64 / run.measures.agents as f64).mean,
        stalled: runs.iter().filter(|run| run.measures.stalled > 0).count(),
        mean_time_to_goal_s: time_to_goal.map(|time| time.mean),
        mean_time_to_goal_s_sd: time_to_goal.map(|time| time.deviation),
        body_penetration_mm: bodies.mean,
        body_penetration_mm_sd: bodies.deviation,
        plan_microseconds_per_agent_step: of(|run| run.plan_microseconds_per_agent_step).mean,
        runs: runs.into_iter().map(RunFigures::new).collect(),
    }
}

impl RunFigures {
    fn new(run: &ComparisonRun) -> Self {
        Self {
            seed: run.seed,
            measures: run.measures.clone(),
            plan_microseconds_per_agent_step: run.plan_microseconds_per_agent_step,
        }
    }
}

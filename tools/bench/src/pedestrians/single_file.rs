//! RiMEA test 16: agents walk in single file in a ring, at three densities, against people in single file. World,
//! metres, seconds.

use std::f32::consts::TAU;

use fbcrowd_sim::scenario::{AgentSpec, Scenario};
use glam::Vec2;

use crate::error::BenchError;
use crate::kit::report::Criterion;
use crate::kit::scenario_run::ScenarioRun;
use crate::kit::statistics::mean;
use crate::pedestrians::case::{CaseOutcome, figure};

/// Length of the ring's middle line, m.
const RING_M: f32 = 24.0;
/// Width of the corridor, m; no disc passes another.
const WIDTH_M: f32 = 0.8;
/// Corners of each wall.
const CORNERS: usize = 48;
/// Waypoints of one round.
const WAYPOINTS: usize = 12;
/// Rounds that no agent completes.
const ROUNDS: usize = 6;
/// Preferred speed, m/s (Weidmann 1993).
const SPEED_MPS: f32 = 1.34;
/// Simulated time, s.
const DURATION_S: f32 = 60.0;
/// Time from which speeds are measured, s.
const STEADY_S: f64 = 20.0;
/// Number of agents of each ring, and the speeds below which 10 and 90 % of people walk at its density, m/s: individual
/// speeds by individual density (two over the distance between both neighbours) of 34 and 56 people in an oval of 26 m
/// (Forschungszentrum Jülich, single file; cameras with 34 and 56 people), 222, 210 and 458 values.
const RINGS: [(usize, [f64; 2]); 3] = [(30, [0.398, 0.588]), (36, [0.166, 0.468]), (42, [0.102, 0.281])];

/// The rings.
pub(crate) fn scenes() -> Result<Vec<Scenario>, BenchError> {
    Ok(RINGS.iter().map(|(count, _)| ring(*count)).collect())
}

fn ring(count: usize) -> Scenario {
    let radius_m = RING_M / TAU;
    let at_m = |radius_m: f32, turn: f32| {
        let (sin, cos) = libm::sincosf(TAU * turn);
        radius_m * Vec2::new(cos, sin)
    };
    let circle_m = |radius_m: f32| {
        (0..CORNERS).map(|corner| at_m(radius_m, corner as f32 / CORNERS as f32)).collect::<Vec<Vec2>>()
    };
    let agent = |index: usize| {
        let turn = index as f32 / count as f32;
        let first = (turn * WAYPOINTS as f32) as usize + 1;
        let waypoint_m = |index: usize| at_m(radius_m, (index % WAYPOINTS) as f32 / WAYPOINTS as f32);
        AgentSpec {
            position_m: at_m(radius_m, turn),
            facing_rad: TAU * (turn + 0.25),
            goals_m: (first..first + ROUNDS * WAYPOINTS).map(waypoint_m).collect(),
            preferred_speed_mps: SPEED_MPS,
            ..AgentSpec::default()
        }
    };
    Scenario {
        name: format!("16_single_file_{count}"),
        duration_s: DURATION_S,
        obstacles_m: vec![circle_m(radius_m - 0.5 * WIDTH_M)],
        enclosures_m: vec![circle_m(radius_m + 0.5 * WIDTH_M)],
        ..Scenario::of((0..count).map(agent).collect())
    }
}

/// Judges the runs of the rings.
pub(crate) fn judge(runs: &[ScenarioRun]) -> CaseOutcome {
    let mut outcome = CaseOutcome { figures: Vec::new(), criteria: Vec::new() };
    for (run, (count, [least_mps, greatest_mps])) in runs.iter().zip(RINGS) {
        let (per_m, speed_mps) = (count as f64 / f64::from(RING_M), speed_mps(run));
        outcome.figures.push(figure(format!("speed at {per_m:.2}/m, m/s"), speed_mps));
        let name = || format!("RiMEA 16: speed at {per_m:.2}/m, m/s");
        outcome.criteria.push(Criterion::at_least(name(), least_mps, speed_mps));
        outcome.criteria.push(Criterion::at_most(name(), greatest_mps, speed_mps));
    }
    outcome
}

/// Mean speed of all agents about the ring, along its middle line, m/s.
fn speed_mps(run: &ScenarioRun) -> Option<f64> {
    let radius_m = f64::from(RING_M / TAU);
    let steps = run.steps().filter(|step| step.end_s > STEADY_S);
    let speeds = steps.flat_map(|step| {
        let turns_rad = step.before_m.iter().zip(&step.after_m).map(|(from_m, to_m)| from_m.angle_to(*to_m));
        turns_rad.map(|turn_rad| f64::from(turn_rad) * radius_m / run.dt_s()).collect::<Vec<f64>>()
    });
    mean(speeds.collect::<Vec<f64>>().into_iter())
}

//! Tests of the guideline about walking: a set speed (1), pre-movement times (5), a corner (6), speeds by age (7).
//! World, metres, seconds.

use fbcrowd_sim::measures::Gate;
use glam::Vec2;

use crate::kit::report::Criterion;
use crate::kit::scenario_run::ScenarioRun;
use crate::kit::statistics::mean;
use crate::pedestrians::case::{CaseOutcome, TOUCH_M, figure, gate, speed_mps};

/// Test 1: length of the corridor, m.
const CORRIDOR_M: f64 = 40.0;
/// Test 1: least and greatest duration by the guideline, s.
const CORRIDOR_TIME_S: [f64; 2] = [26.0, 34.0];
/// Tests 1 and 7: greatest difference from a set speed, as a share of it.
const SPEED_TOLERANCE: f64 = 0.05;
/// Test 5: share of its preferred speed beyond which an agent has begun. One that waits steps aside for others, slower.
const BEGUN_SPEED: f64 = 0.5;
/// Test 5: greatest time from an agent's own time to its beginning, s: a turn on the spot and a step.
const BEGUN_AFTER_S: f64 = 2.0;
/// Test 7: positions between which no agent starts or stops, m.
const LANE_GATES_M: [f32; 2] = [5.0, 25.0];
/// Test 7: number of agents of each age in the file's order, least and greatest speed (RiMEA, table 1), m/s.
const AGES: [(&str, usize, [f64; 2]); 3] =
    [("under 30", 20, [0.58, 1.61]), ("30 to 50", 15, [1.41, 1.54]), ("over 50", 15, [0.68, 1.41])];
/// Test 7: farthest outside a range, m/s: rounding of times.
const RANGE_TOLERANCE_MPS: f64 = 0.005;

/// RiMEA 1.
pub(crate) fn corridor(runs: &[ScenarioRun]) -> CaseOutcome {
    let gates = [0.0, CORRIDOR_M as f32].map(|x_m| gate(&runs[0], x_m, [-1.0, 1.0]));
    let speed = speed_mps(0, &gates, CORRIDOR_M);
    let time_s = speed.map(|speed_mps| CORRIDOR_M / speed_mps);
    let set_mps = f64::from(runs[0].scenario.agents[0].preferred_speed_mps);
    CaseOutcome {
        figures: vec![figure("time for 40 m, s", time_s), figure("speed, m/s", speed)],
        criteria: vec![
            Criterion::at_least("RiMEA 1: time for 40 m, s", CORRIDOR_TIME_S[0], time_s),
            Criterion::at_most("RiMEA 1: time for 40 m, s", CORRIDOR_TIME_S[1], time_s),
            Criterion::at_most(
                "RiMEA 1: speed off the set one, share",
                SPEED_TOLERANCE,
                speed.map(|speed_mps| (speed_mps / set_mps - 1.0).abs()),
            ),
        ],
    }
}

/// RiMEA 5.
pub(crate) fn pre_movement(runs: &[ScenarioRun]) -> CaseOutcome {
    let run = &runs[0];
    let begun_s = |agent: usize| {
        let least_m = BEGUN_SPEED * f64::from(run.scenario.agents[agent].preferred_speed_mps) * run.dt_s();
        let mut steps_m =
            run.tracks.agents[agent].positions_m.windows(2).map(|pair| f64::from(pair[0].distance(pair[1])));
        Some(steps_m.position(|step_m| step_m > least_m)? as f64 * run.dt_s())
    };
    let own_s = |agent: usize| f64::from(run.scenario.agents[agent].pre_movement_s);
    let agents = || 0..run.agent_count();
    let delays_s: Vec<f64> = agents().filter_map(|agent| Some(begun_s(agent)? - own_s(agent))).collect();
    let [first_s, last_s] = [f64::min, f64::max].map(|choose| agents().map(own_s).reduce(choose));
    let [least_s, greatest_s] = [f64::min, f64::max].map(|choose| delays_s.iter().copied().reduce(choose));
    CaseOutcome {
        figures: vec![
            figure("first of the agents' own times, s", first_s),
            figure("last of them, s", last_s),
            figure("least time from an agent's own time to its beginning, s", least_s),
            figure("greatest time from an agent's own time to its beginning, s", greatest_s),
        ],
        criteria: vec![
            Criterion::at_least("RiMEA 5: agents that begin", 10.0, delays_s.len() as f64),
            Criterion::at_least("RiMEA 5: time from an agent's own time to its beginning, s", 0.0, least_s),
            Criterion::at_most("RiMEA 5: time from an agent's own time to its beginning, s", BEGUN_AFTER_S, greatest_s),
            Criterion::at_least("RiMEA 5: agents that leave", 10.0, run.measures.removed as f64),
        ],
    }
}

/// RiMEA 6.
pub(crate) fn corner(runs: &[ScenarioRun]) -> CaseOutcome {
    let run = &runs[0];
    let obstacles = run.scenario.walls();
    let mut gate = Gate::new([Vec2::new(10.0, 12.0), Vec2::new(12.0, 12.0)], run.agent_count());
    let (mut crossed, mut nearest_m, mut near) = (0, f32::INFINITY, Vec::new());
    for step in run.steps() {
        gate.push(&step.before_m, &step.after_m, step.end_s, run.dt_s());
        let is_present = |(from_m, to_m): &(&Vec2, &Vec2)| from_m.is_finite() && to_m.is_finite();
        for (&from_m, &root_m) in step.before_m.iter().zip(&step.after_m).filter(is_present) {
            crossed += usize::from(obstacles.contains(root_m) || !obstacles.is_free(from_m, root_m));
            obstacles.near(root_m, 1.0, &mut near);
            nearest_m = near.first().map_or(nearest_m, |edge| nearest_m.min(edge.distance_m));
        }
    }
    let wall_radius_m = run.scenario.agents[0].wall_radius_m;
    let passages_s = gate.passages_s();
    CaseOutcome {
        figures: vec![
            figure("agents round the corner", passages_s.len() as f64),
            figure("time at which the last of them is round, s", passages_s.last().copied()),
            figure("nearest that a disc comes to a wall, m", f64::from(nearest_m - wall_radius_m)),
        ],
        criteria: vec![
            Criterion::at_least("RiMEA 6: agents round the corner", 20.0, passages_s.len() as f64),
            Criterion::at_most("RiMEA 6: agents and steps through a wall", 0.0, crossed as f64),
            Criterion::at_most("RiMEA 6: disc in a wall, m", TOUCH_M, f64::from(wall_radius_m - nearest_m).max(0.0)),
        ],
    }
}

/// RiMEA 7.
pub(crate) fn speeds_by_age(runs: &[ScenarioRun]) -> CaseOutcome {
    let run = &runs[0];
    let gates = LANE_GATES_M.map(|x_m| gate(run, x_m, [-1.0, 1000.0]));
    let apart_m = f64::from(LANE_GATES_M[1] - LANE_GATES_M[0]);
    let (mut figures, mut first, mut walked) = (Vec::new(), 0, 0);
    let (mut outside_mps, mut off) = (0.0_f64, 0.0_f64);
    for (age, count, [least_mps, greatest_mps]) in AGES {
        let agents = first..first + count;
        let speeds = agents.filter_map(|agent| {
            Some((speed_mps(agent, &gates, apart_m)?, f64::from(run.scenario.agents[agent].preferred_speed_mps)))
        });
        let speeds: Vec<(f64, f64)> = speeds.collect();
        for (walked_mps, set_mps) in &speeds {
            outside_mps = outside_mps.max(least_mps - walked_mps).max(walked_mps - greatest_mps);
            off = off.max((walked_mps / set_mps - 1.0).abs());
        }
        let walked_mps = || speeds.iter().map(|(walked_mps, _)| *walked_mps);
        figures.push(figure(format!("least speed {age}, m/s"), walked_mps().reduce(f64::min)));
        figures.push(figure(format!("mean speed {age}, m/s"), mean(walked_mps())));
        figures.push(figure(format!("greatest speed {age}, m/s"), walked_mps().reduce(f64::max)));
        (first, walked) = (first + count, walked + speeds.len());
    }
    let all = |value: f64| (walked == first).then_some(value);
    CaseOutcome {
        figures,
        criteria: vec![
            Criterion::at_most("RiMEA 7: outside the range of an age, m/s", RANGE_TOLERANCE_MPS, all(outside_mps)),
            Criterion::at_most("RiMEA 7: an agent off its own speed, share", SPEED_TOLERANCE, all(off)),
        ],
    }
}

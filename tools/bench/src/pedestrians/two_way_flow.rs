//! Lanes in two-way flow: the order parameter of Nowak and Schadschneider 2012. World, metres, seconds.

use fbcrowd_sim::measures::{LaneOrder, LaneWalker, lane_order};
use glam::Vec2;
use schemars::JsonSchema;
use serde::Serialize;

use crate::kit::scenario_run::{ScenarioFile, ScenarioRun, scenario_file};
use crate::kit::statistics::{Spread, mean, spread_of};

/// The scenario.
pub(crate) const TWO_WAY_FLOW: ScenarioFile = scenario_file!("counterflow.toml");
/// Half the length of the corridor's middle, which holds agents of both directions throughout, m.
const LANES_WITHIN_M: f32 = 6.0;
/// Start and end of the time with steady lanes, s: the crowds have walked through each other for 10 m, and the first
/// agents leave the middle at 14 s.
const LANES_STEADY_S: [f64; 2] = [8.0, 13.0];

/// Measures of the two-way flow, each as mean and standard deviation over the seeds.
#[derive(JsonSchema, Serialize)]
pub struct LaneFigures {
    /// Order parameter φ at the start, 0 to 1; null where nothing could be measured.
    pub order_at_start: Option<Spread>,
    /// Order parameter φ with steady lanes, 0 to 1; null where nothing could be measured.
    pub order: Option<Spread>,
    /// Reduced order (φ − φ_0)/(1 − φ_0) at the start, 0 by chance; null where nothing could be measured.
    pub reduced_at_start: Option<Spread>,
    /// Reduced order (φ − φ_0)/(1 − φ_0) with steady lanes, 0 by chance; null where nothing could be measured.
    pub reduced: Option<Spread>,
    /// Speed in each agent's own direction with steady lanes, m/s; null where nothing could be measured.
    pub speed_mps: Option<Spread>,
}

/// Measures of one seed.
struct FlowOfSeed {
    start: LaneOrder,
    /// Mean φ over the steady time.
    order: f64,
    /// Mean reduced order over the steady time.
    reduced: f64,
    speed_mps: f64,
}

impl LaneFigures {
    /// Measures of the runs, one for each seed.
    pub(crate) fn of(runs: &[ScenarioRun]) -> Self {
        let flows: Vec<FlowOfSeed> = runs.iter().filter_map(flow_of_seed).collect();
        Self {
            order_at_start: spread_of(&flows, |flow| Some(flow.start.order)),
            order: spread_of(&flows, |flow| Some(flow.order)),
            reduced_at_start: spread_of(&flows, |flow| flow.start.reduced()),
            reduced: spread_of(&flows, |flow| Some(flow.reduced)),
            speed_mps: spread_of(&flows, |flow| Some(flow.speed_mps)),
        }
    }
}

/// None where nothing could be measured.
fn flow_of_seed(run: &ScenarioRun) -> Option<FlowOfSeed> {
    let goes_forward = |agent: usize| run.scenario.agents[agent].goals_m[0].x > 0.0;
    let order = |roots_m: &[Vec2]| {
        let within = roots_m.iter().enumerate().filter(|(_, root_m)| root_m.x.abs() <= LANES_WITHIN_M);
        let walker =
            |(agent, root_m): (usize, &Vec2)| LaneWalker { across_m: root_m.y, goes_forward: goes_forward(agent) };
        lane_order(&within.map(walker).collect::<Vec<LaneWalker>>())
    };
    let (mut orders, mut speeds_mps) = (Vec::new(), Vec::new());
    let [from_s, to_s] = LANES_STEADY_S;
    for step in run.steps().filter(|step| (from_s..=to_s).contains(&step.end_s)) {
        orders.extend(order(&step.after_m));
        for (agent, (before_m, after_m)) in step.before_m.iter().zip(step.after_m).enumerate() {
            if after_m.x.abs() <= LANES_WITHIN_M {
                let speed_mps = f64::from(after_m.x - before_m.x) / run.dt_s();
                speeds_mps.push(if goes_forward(agent) { speed_mps } else { -speed_mps });
            }
        }
    }
    Some(FlowOfSeed {
        start: order(&run.roots_m(0))?,
        order: mean(orders.iter().map(|order| order.order))?,
        reduced: mean(orders.iter().filter_map(|order| order.reduced()))?,
        speed_mps: mean(speeds_mps.into_iter())?,
    })
}

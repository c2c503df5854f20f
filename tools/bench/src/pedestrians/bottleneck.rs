//! The crowd that leaves a room by a door: its flow, and the half-circle in which it waits. World, metres, seconds.

use fbcrowd_sim::measures::{Gate, SECTORS, WaitingCrowd, WaitingShape};
use glam::Vec2;
use schemars::JsonSchema;
use serde::Serialize;

use crate::kit::scenario_run::{ScenarioFile, ScenarioRun, scenario_file};
use crate::kit::statistics::{Spread, spread_of};

/// The scenario.
pub(crate) const BOTTLENECK: ScenarioFile = scenario_file!("bottleneck.toml");
/// Half the width of the door, m.
const DOOR_HALF_M: f32 = 0.6;
/// Position of the wall's near face, where the room ends, m.
const ROOM_END_M: Vec2 = Vec2::new(-0.2, 0.0);
/// Time at which the crowd has come up to the door, s.
const ARCH_FROM_S: f64 = 8.0;
/// Share of the agents that have left when the measurement of the half-circle ends.
const ARCH_UNTIL_SHARE: f64 = 0.5;

/// Measures of the crowd at the door, each as mean and standard deviation over the seeds.
#[derive(JsonSchema, Serialize)]
pub struct DoorFigures {
    /// Number of agents that pass the door; null where nothing could be measured.
    pub through: Option<Spread>,
    /// Agents per second and metre of door; null where nothing could be measured.
    pub flow_per_m_s: Option<Spread>,
    /// Longest time in which no agent passes the door, s; null where nothing could be measured.
    pub longest_gap_s: Option<Spread>,
    /// Mean number of agents that wait; null where nothing could be measured.
    pub waiting: Option<Spread>,
    /// Radius of the half-circle in which they wait, m; null where nothing could be measured.
    pub radius_m: Option<Spread>,
    /// Unevenness of that half-circle, 0 for an even one; null where nothing could be measured.
    pub unevenness: Option<Spread>,
    /// Agents per square metre within 1 m of the door; null where nothing could be measured.
    pub at_the_door_per_m2: Option<Spread>,
    /// Agents per square metre from 1 to 2 m before the door; null where nothing could be measured.
    pub before_it_per_m2: Option<Spread>,
    /// Extent of the crowd in each sector from left to right, m; mean over the seeds.
    pub reach_m: [f64; SECTORS],
    /// C (Eq. 17), per agent and step; null where nothing could be measured.
    pub collision_rate: Option<Spread>,
    /// Length of the paths, divided by the straight lines along the waypoints; null where no agent arrives.
    pub path_over_straight_line: Option<Spread>,
}

/// Measures of one seed.
struct DoorOfSeed {
    gate: Gate,
    shape: WaitingShape,
    collision_rate: f64,
    path_over_straight_line: Option<f64>,
}

impl DoorFigures {
    /// Measures of the runs, one for each seed.
    pub(crate) fn of(runs: &[ScenarioRun]) -> Self {
        let doors: Vec<DoorOfSeed> = runs.iter().map(door_of_seed).collect();
        let width_m = f64::from(2.0 * DOOR_HALF_M);
        let reach_m =
            |sector: usize| doors.iter().map(|door| door.shape.reach_m[sector]).sum::<f64>() / doors.len() as f64;
        Self {
            through: spread_of(&doors, |door| Some(door.gate.passages_s().len() as f64)),
            flow_per_m_s: spread_of(&doors, |door| Some(door.gate.flow_per_s()? / width_m)),
            longest_gap_s: spread_of(&doors, |door| door.gate.longest_gap_s()),
            waiting: spread_of(&doors, |door| Some(door.shape.waiting)),
            radius_m: spread_of(&doors, |door| Some(door.shape.radius_m())),
            unevenness: spread_of(&doors, |door| door.shape.unevenness()),
            at_the_door_per_m2: spread_of(&doors, |door| Some(door.shape.rings_per_m2[0])),
            before_it_per_m2: spread_of(&doors, |door| Some(door.shape.rings_per_m2[1])),
            reach_m: std::array::from_fn(reach_m),
            collision_rate: spread_of(&doors, |door| Some(door.collision_rate)),
            path_over_straight_line: spread_of(&doors, |door| door.path_over_straight_line),
        }
    }
}

fn door_of_seed(run: &ScenarioRun) -> DoorOfSeed {
    let mut gate = Gate::new([Vec2::new(0.0, DOOR_HALF_M), Vec2::new(0.0, -DOOR_HALF_M)], run.agent_count());
    let mut crowd = WaitingCrowd::new(ROOM_END_M, Vec2::NEG_X);
    let until = (ARCH_UNTIL_SHARE * run.agent_count() as f64) as usize;
    for step in run.steps() {
        gate.push(&step.before_m, &step.after_m, step.end_s, run.dt_s());
        if step.end_s >= ARCH_FROM_S && gate.passages_s().len() < until {
            crowd.push(&step.before_m, &step.after_m, run.scenario.dt_s);
        }
    }
    let measures = &run.measures;
    DoorOfSeed {
        gate,
        shape: crowd.shape(),
        collision_rate: measures.collision_rate,
        path_over_straight_line: measures.path_over_straight_line,
    }
}

//! `fbcrowd bench emergence`: what nobody plans and a crowd does all the same (the paper's §7): lanes in two-way flow,
//! and an arch of people before a door, through full bodies and under each planner.
//!
//! Both scenes are played for several seeds, because who meets whom is chaotic. World, metres, seconds.

use std::fmt::Write;
use std::path::{Path, PathBuf};
use std::sync::Arc;

use fbcrowd_sim::measures::{Gate, LaneOrder, LaneWalker, SECTORS, WaitingCrowd, WaitingShape, lane_order};
use fbcrowd_sim::scenario::Scenario;
use glam::Vec2;
use motiondb::motion::MotionDb;
use serde::Serialize;

use crate::cmd::bench::bar::{Bar, Found, conclude};
use crate::cmd::bench::bundled::database;
use crate::cmd::bench::contest::{Contestant, MCN, ORCA, SOCIAL_FORCE};
use crate::cmd::bench::watch::{self, Watched, scenario_text};
use crate::failure::{Answer, Failure};
use crate::statistics::{Spread, spread};

const PLANNERS: [Contestant; 3] = [MCN, ORCA, SOCIAL_FORCE];
/// From three seeds to another three every figure of the door changes by a tenth.
const SEEDS: [u64; 10] = [1, 2, 3, 4, 5, 6, 7, 8, 9, 10];
const COUNTERFLOW: (&str, &str) = scenario_text!("counterflow.toml");
const BOTTLENECK: (&str, &str) = scenario_text!("bottleneck.toml");
/// Lanes are read in the middle of the corridor, where both crowds are all the while …
const LANES_WITHIN_M: f32 = 6.0;
/// … and are steady from here on: the crowds have walked through each other for 10 m; the first of them run out at 14
/// s.
const LANES_STEADY_S: [f64; 2] = [8.0, 13.0];
/// A crowd that starts as a chequerboard is nearer to perfect lanes than to chance.
const LANES_ORDER: f64 = 0.5;
/// The door: half its width, m.
const DOOR_HALF_M: f32 = 0.6;
/// People a metre of door lets through in a second in laboratories: 1.0 to 2.0 (Seyfried et al. 2009, Transportation
/// Science 43, and those that it compares).
const FLOW_PER_M_S: [f64; 2] = [1.0, 2.0];
/// The arch is looked at from the time at which the crowd has come up until half have left, s and share.
const ARCH_FROM_S: f64 = 8.0;
const ARCH_UNTIL_SHARE: f64 = 0.5;
/// A sector reaches as far as the half-circle but for a third: people stand in grains of half a metre, and none stands
/// within the walls' first half metre; a queue has 2.2, a crowd on one side 1.
const UNEVENNESS: f64 = 1.0 / 3.0;
/// Nobody passes for so long while people wait: clogged, s. Thrice the time between two people at the least flow
/// published, and one's reaction.
const CLOG_S: f64 = 5.0;

/// Look for what emerges: lanes in two-way flow, an arch before a door, no clogging.
///
/// In JSON `planners[] {planner, lanes {…}, door {…}}`, each figure as `{mean, deviation}` over seeds: `order` φ and
/// `reduced` (φ − φ_0)/(1 − φ_0) of Nowak and Schadschneider 2012, at the start and when steady; people a second and
/// metre of door, the longest time in which nobody passes it, and the shape of the crowd before it.
#[derive(clap::Args)]
#[command(after_help = "Example:\n  fbcrowd bench emergence --plots out/plots")]
pub(super) struct Args {
    /// The database that the bodies come from; the bundled clips by default.
    #[arg(long = "db", value_name = "FILE.fbdb")]
    database: Option<PathBuf>,
    /// Draw everybody's paths in the first seed.
    #[arg(long, value_name = "DIR")]
    plots: Option<PathBuf>,
    /// Print JSON.
    #[arg(long)]
    json: bool,
}

#[derive(Serialize)]
struct Details {
    planners: Vec<PlannerFigures>,
}

#[derive(Serialize)]
struct PlannerFigures {
    planner: &'static str,
    lanes: Lanes,
    door: Door,
}

/// Figures are null where nothing could be measured in any seed.
#[derive(Serialize)]
struct Lanes {
    order_at_start: Option<Spread>,
    order: Option<Spread>,
    reduced_at_start: Option<Spread>,
    reduced: Option<Spread>,
    /// In everybody's own direction, when steady.
    speed_mps: Option<Spread>,
}

#[derive(Serialize)]
struct Door {
    through: Option<Spread>,
    flow_per_m_s: Option<Spread>,
    longest_gap_s: Option<Spread>,
    waiting: Option<Spread>,
    radius_m: Option<Spread>,
    unevenness: Option<Spread>,
    /// People on a square metre within 1 m of the door, and from 1 to 2 m.
    at_the_door_per_m2: Option<Spread>,
    before_it_per_m2: Option<Spread>,
    /// How far the crowd reaches in each sector, from left to right, m; mean over seeds.
    reach_m: [f64; SECTORS],
    collision_rate: Option<Spread>,
    path_over_straight_line: Option<Spread>,
}

pub(super) fn run(args: &Args) -> Result<Answer, Failure> {
    let db = Arc::new(database(args.database.as_deref())?);
    let mut scenarios = Vec::new();
    for contestant in &PLANNERS {
        for file in [COUNTERFLOW, BOTTLENECK] {
            for seed in SEEDS {
                scenarios.push(seeded(file, contestant, seed)?);
            }
        }
    }
    let watched = watch::watch_all(&db, scenarios)?;
    let of_planners = || PLANNERS.iter().zip(watched.chunks(2 * SEEDS.len()));
    if let Some(folder) = &args.plots {
        for (contestant, played) in of_planners() {
            write_first(folder, contestant, &db, played)?;
        }
    }
    let planners = of_planners().map(|(contestant, played)| planner_figures(contestant, played)).collect();
    let details = Details { planners };
    let bars = details.planners.first().map(bars).unwrap_or_default();
    let text = text(&details);
    conclude(&Found { details, goals: Vec::new(), bars }, &text, args.json)
}

/// A file under another planner and seed.
fn seeded((path, text): (&str, &str), contestant: &Contestant, seed: u64) -> Result<Scenario, Failure> {
    let scenario = watch::scenario((path, &format!("seed = {seed}\n{text}")))?;
    Ok(Scenario { planner: contestant.planner, ..scenario })
}

fn write_first(folder: &Path, contestant: &Contestant, db: &MotionDb, played: &[Watched]) -> Result<(), Failure> {
    for first in played.iter().step_by(SEEDS.len()) {
        let name = format!("{}_{}.png", first.scenario.name, contestant.name);
        watch::write_paths(&folder.join(name), db, first)?;
    }
    Ok(())
}

fn planner_figures(contestant: &Contestant, played: &[Watched]) -> PlannerFigures {
    let (flows, doors) = played.split_at(SEEDS.len());
    PlannerFigures { planner: contestant.name, lanes: lanes(flows), door: door(doors) }
}

/// The mean and spread of what could be measured.
fn over_seeds<T>(seeds: &[T], value: impl Fn(&T) -> Option<f64>) -> Option<Spread> {
    let values: Vec<f64> = seeds.iter().filter_map(value).collect();
    spread(values.into_iter())
}

/// One seed of the two-way flow.
struct Flow {
    start: LaneOrder,
    /// φ and the reduced parameter, means over the steady time.
    order: f64,
    reduced: f64,
    speed_mps: f64,
}

fn lanes(played: &[Watched]) -> Lanes {
    let flows: Vec<Flow> = played.iter().filter_map(flow).collect();
    Lanes {
        order_at_start: over_seeds(&flows, |flow| Some(flow.start.order)),
        order: over_seeds(&flows, |flow| Some(flow.order)),
        reduced_at_start: over_seeds(&flows, |flow| flow.start.reduced()),
        reduced: over_seeds(&flows, |flow| Some(flow.reduced)),
        speed_mps: over_seeds(&flows, |flow| Some(flow.speed_mps)),
    }
}

fn flow(played: &Watched) -> Option<Flow> {
    let goes_forward = |agent: usize| played.scenario.agents[agent].goals_m[0].x > 0.0;
    let order = |roots_m: &[Vec2]| {
        let within = roots_m.iter().enumerate().filter(|(_, root_m)| root_m.x.abs() <= LANES_WITHIN_M);
        let walker =
            |(agent, root_m): (usize, &Vec2)| LaneWalker { across_m: root_m.y, goes_forward: goes_forward(agent) };
        lane_order(&within.map(walker).collect::<Vec<LaneWalker>>())
    };
    let (mut orders, mut speeds_mps) = (Vec::new(), Vec::new());
    let [from_s, to_s] = LANES_STEADY_S;
    for seen in played.steps().filter(|seen| (from_s..=to_s).contains(&seen.end_s)) {
        orders.extend(order(seen.after_m));
        for (agent, (before_m, after_m)) in seen.before_m.iter().zip(seen.after_m).enumerate() {
            if after_m.x.abs() <= LANES_WITHIN_M {
                let speed_mps = f64::from(after_m.x - before_m.x) / played.dt_s();
                speeds_mps.push(if goes_forward(agent) { speed_mps } else { -speed_mps });
            }
        }
    }
    Some(Flow {
        start: order(played.tracks.frame_m(0))?,
        order: mean(orders.iter().map(|order| order.order))?,
        reduced: mean(orders.iter().filter_map(|order| order.reduced()))?,
        speed_mps: mean(speeds_mps.into_iter())?,
    })
}

/// None of none.
fn mean(values: impl Iterator<Item = f64> + Clone) -> Option<f64> {
    spread(values).map(|spread| spread.mean)
}

/// One seed of the room.
struct Leaving {
    gate: Gate,
    shape: WaitingShape,
    collision_rate: f64,
    path_over_straight_line: Option<f64>,
}

fn door(played: &[Watched]) -> Door {
    let left: Vec<Leaving> = played.iter().map(leaving).collect();
    let width_m = f64::from(2.0 * DOOR_HALF_M);
    let reach_m = |sector: usize| left.iter().map(|seed| seed.shape.reach_m[sector]).sum::<f64>() / left.len() as f64;
    Door {
        through: over_seeds(&left, |seed| Some(seed.gate.passages_s().len() as f64)),
        flow_per_m_s: over_seeds(&left, |seed| Some(seed.gate.flow_per_s()? / width_m)),
        longest_gap_s: over_seeds(&left, |seed| seed.gate.longest_gap_s()),
        waiting: over_seeds(&left, |seed| Some(seed.shape.waiting)),
        radius_m: over_seeds(&left, |seed| Some(seed.shape.radius_m())),
        unevenness: over_seeds(&left, |seed| seed.shape.unevenness()),
        at_the_door_per_m2: over_seeds(&left, |seed| Some(seed.shape.rings_per_m2[0])),
        before_it_per_m2: over_seeds(&left, |seed| Some(seed.shape.rings_per_m2[1])),
        reach_m: std::array::from_fn(reach_m),
        collision_rate: over_seeds(&left, |seed| Some(seed.collision_rate)),
        path_over_straight_line: over_seeds(&left, |seed| seed.path_over_straight_line),
    }
}

fn leaving(played: &Watched) -> Leaving {
    let mut gate = Gate::new([Vec2::new(0.0, DOOR_HALF_M), Vec2::new(0.0, -DOOR_HALF_M)], played.tracks.agent_count);
    // At the wall's near face, where the room ends.
    let mut crowd = WaitingCrowd::new(Vec2::new(-0.2, 0.0), Vec2::NEG_X);
    let until = (ARCH_UNTIL_SHARE * played.tracks.agent_count as f64) as usize;
    for seen in played.steps() {
        gate.push(seen.before_m, seen.after_m, seen.end_s, played.dt_s());
        if seen.end_s >= ARCH_FROM_S && gate.passages_s().len() < until {
            crowd.push(seen.before_m, seen.after_m, played.scenario.dt_s);
        }
    }
    let measures = &played.measures;
    Leaving {
        gate,
        shape: crowd.shape(),
        collision_rate: measures.collision_rate,
        path_over_straight_line: measures.path_over_straight_line,
    }
}

/// What MCN must show.
fn bars(mcn: &PlannerFigures) -> Vec<Bar> {
    let mean = |figure: &Option<Spread>| figure.map(|spread| spread.mean);
    let PlannerFigures { lanes, door, .. } = mcn;
    vec![
        Bar::at_most("lanes: reduced order at the start", 0.0, mean(&lanes.reduced_at_start)),
        Bar::at_least("lanes: reduced order when steady", LANES_ORDER, mean(&lanes.reduced)),
        Bar::at_least("door: people through it, of 72", 72.0, mean(&door.through)),
        Bar::at_least("door: people a second and metre", FLOW_PER_M_S[0], mean(&door.flow_per_m_s)),
        Bar::at_most("door: people a second and metre", FLOW_PER_M_S[1], mean(&door.flow_per_m_s)),
        Bar::at_most("door: unevenness of the half-circle", UNEVENNESS, mean(&door.unevenness)),
        Bar::at_most("door: longest time in which nobody passes, s", CLOG_S, mean(&door.longest_gap_s)),
    ]
}

fn text(details: &Details) -> String {
    let mut text = format!("{:<58}", format!("mean ± deviation over {} seeds", SEEDS.len()));
    let (flow, door) = ("two-way flow: ", "door: ");
    details.planners.iter().for_each(|planner| text += &format!("{:>18}", planner.planner));
    text.push('\n');
    let mut row = |of: &str, name: &str, value: &dyn Fn(&PlannerFigures) -> Option<Spread>| {
        let cell = |spread: Spread| format!("{:.3} ± {:.3}", spread.mean, spread.deviation);
        let cells = details.planners.iter().map(|planner| value(planner).map_or_else(|| "–".to_owned(), cell));
        // Writing to a string cannot fail.
        let _ = writeln!(
            text,
            "{:<58}{}",
            format!("{of}{name}"),
            cells.map(|cell| format!("{cell:>18}")).collect::<String>()
        );
    };
    row(flow, "order φ at the start", &|planner| planner.lanes.order_at_start);
    row(flow, "order φ when steady", &|planner| planner.lanes.order);
    row(flow, "reduced order at the start", &|planner| planner.lanes.reduced_at_start);
    row(flow, "reduced order when steady", &|planner| planner.lanes.reduced);
    row(flow, "speed when steady, m/s", &|planner| planner.lanes.speed_mps);
    row(door, "people through it", &|planner| planner.door.through);
    row(door, "people a second and metre", &|planner| planner.door.flow_per_m_s);
    row(door, "longest time in which nobody passes, s", &|planner| planner.door.longest_gap_s);
    row(door, "people who wait", &|planner| planner.door.waiting);
    row(door, "radius of their half-circle, m", &|planner| planner.door.radius_m);
    row(door, "its unevenness", &|planner| planner.door.unevenness);
    row(door, "people/m² within 1 m", &|planner| planner.door.at_the_door_per_m2);
    row(door, "people/m² from 1 to 2 m", &|planner| planner.door.before_it_per_m2);
    row(door, "C", &|planner| planner.door.collision_rate);
    row(door, "path over the straight way", &|planner| planner.door.path_over_straight_line);
    text + "\n"
}

//! `fbcrowd bench emergence`: patterns that no agent plans and a crowd shows (the paper's §7): lanes in two-way flow,
//! and an arch before a door, through full bodies and with each planner.
//!
//! Both scenes are simulated with several seeds: small differences change which agents meet.

use std::fmt::Write;
use std::path::Path;
use std::sync::Arc;

use fbcrowd_jobs::Observer;
use fbcrowd_jobs::wording::counted;
use fbcrowd_sim::scenario::Scenario;
use motiondb::motion::MotionDb;
use schemars::JsonSchema;
use serde::Serialize;

use crate::error::BenchError;
use crate::kit::args::{DatabaseArg, PlotsArg, SeedsArg};
use crate::kit::database::database;
use crate::kit::planner_comparison::{ComparedPlanner, MCN, ORCA, SOCIAL_FORCE};
use crate::kit::report::{BenchReport, Criterion};
use crate::kit::scenario_run::{ScenarioRun, draw_paths, run_scenarios, seeded};
use crate::kit::statistics::Spread;
use crate::pedestrians::bottleneck::{BOTTLENECK, DoorFigures};
use crate::pedestrians::two_way_flow::{LaneFigures, TWO_WAY_FLOW};

/// Planners, MCN first.
const PLANNERS: [ComparedPlanner; 3] = [MCN, ORCA, SOCIAL_FORCE];
/// Seeds; from three seeds to another three every measure of the door changes by a tenth.
const SEEDS: [u64; 10] = [1, 2, 3, 4, 5, 6, 7, 8, 9, 10];
/// Least reduced order of steady lanes: nearer to perfect lanes than to chance, from a chequerboard at the start.
const LANES_ORDER: f64 = 0.5;
/// Agents of the room.
const DOOR_AGENTS: f64 = 72.0;
/// Least and greatest flow of pedestrians per second and metre of door in laboratories (Seyfried et al. 2009,
/// Transportation Science 43, and those that it compares).
const FLOW_PER_M_S: [f64; 2] = [1.0, 2.0];
/// Greatest unevenness of the half-circle: agents stand half a metre apart, and none stands within the first half metre
/// along the walls. A queue has 2.2, a crowd on one side 1.
const UNEVENNESS: f64 = 1.0 / 3.0;
/// Greatest time in which no agent passes while others wait, s: thrice the time between two pedestrians at the least
/// published flow, and one reaction time.
const CLOG_S: f64 = 5.0;

/// Look for patterns that emerge: lanes in two-way flow, an arch before a door, no clogging.
#[derive(clap::Args)]
#[command(after_help = "Example:\n  fbcrowd bench emergence --plots out/plots")]
pub struct Args {
    #[command(flatten)]
    database: DatabaseArg,
    #[command(flatten)]
    seeds: SeedsArg,
    #[command(flatten)]
    plots: PlotsArg,
}

/// What was measured.
#[derive(JsonSchema, Serialize)]
pub struct Details {
    /// The planners.
    pub planners: Vec<PlannerPatterns>,
}

/// Patterns with one planner.
#[derive(JsonSchema, Serialize)]
pub struct PlannerPatterns {
    /// Name of the planner.
    pub planner: &'static str,
    /// Lanes in two-way flow.
    pub lanes: LaneFigures,
    /// The crowd before a door.
    pub door: DoorFigures,
}

/// Runs the bench.
///
/// # Errors
/// If the database cannot be read, or a picture cannot be written.
pub fn run(args: &Args, observer: &Observer) -> Result<BenchReport<Details>, BenchError> {
    args.database.check_folder(args.plots.plots.as_ref())?;
    let db = Arc::new(database(&args.database)?);
    let seeds = if args.seeds.seeds.is_empty() { &SEEDS } else { args.seeds.seeds.as_slice() };
    let mut scenarios = Vec::new();
    for planner in &PLANNERS {
        for file in [TWO_WAY_FLOW, BOTTLENECK] {
            for &seed in seeds {
                scenarios.push(Scenario { planner: planner.planner, ..seeded(file, seed)? });
            }
        }
    }
    let runs = run_scenarios(&db, scenarios, observer)?;
    let by_planner = || PLANNERS.iter().zip(runs.chunks(2 * seeds.len()));
    if let Some(folder) = &args.plots.plots {
        for (planner, runs) in by_planner() {
            draw_first_seeds(folder, planner, &db, runs)?;
        }
    }
    let planners: Vec<PlannerPatterns> = by_planner().map(|(planner, runs)| patterns(planner, runs)).collect();
    let criteria = planners.first().map(criteria).unwrap_or_default();
    let details = Details { planners };
    Ok(BenchReport { text: text(&details, seeds.len()), details, goals: Vec::new(), criteria })
}

/// Draws the paths of the first seed in both scenes.
fn draw_first_seeds(
    folder: &Path,
    planner: &ComparedPlanner,
    db: &MotionDb,
    runs: &[ScenarioRun],
) -> Result<(), BenchError> {
    for first in runs.iter().step_by(runs.len() / 2) {
        draw_paths(&folder.join(format!("{}_{}.png", first.scenario.name, planner.name)), db, first)?;
    }
    Ok(())
}

/// Runs come by scene, then by seed.
fn patterns(planner: &ComparedPlanner, runs: &[ScenarioRun]) -> PlannerPatterns {
    let (flows, doors) = runs.split_at(runs.len() / 2);
    PlannerPatterns { planner: planner.name, lanes: LaneFigures::of(flows), door: DoorFigures::of(doors) }
}

/// Criteria of MCN.
fn criteria(mcn: &PlannerPatterns) -> Vec<Criterion> {
    let mean = |figure: &Option<Spread>| figure.map(|spread| spread.mean);
    let PlannerPatterns { lanes, door, .. } = mcn;
    vec![
        Criterion::at_most("lanes: reduced order at the start", 0.0, mean(&lanes.reduced_at_start)),
        Criterion::at_least("lanes: reduced order when steady", LANES_ORDER, mean(&lanes.reduced)),
        Criterion::at_least("door: agents through it, of 72", DOOR_AGENTS, mean(&door.through)),
        Criterion::at_least("door: agents per second and metre", FLOW_PER_M_S[0], mean(&door.flow_per_m_s)),
        Criterion::at_most("door: agents per second and metre", FLOW_PER_M_S[1], mean(&door.flow_per_m_s)),
        Criterion::at_most("door: unevenness of the half-circle", UNEVENNESS, mean(&door.unevenness)),
        Criterion::at_most("door: longest time in which none passes, s", CLOG_S, mean(&door.longest_gap_s)),
    ]
}

fn text(details: &Details, seeds: usize) -> String {
    let mut text = format!("{:<58}", format!("mean ± deviation over {}", counted(seeds, "seed", "seeds")));
    let (flow, door) = ("two-way flow: ", "door: ");
    details.planners.iter().for_each(|planner| text += &format!("{:>18}", planner.planner));
    text.push('\n');
    let mut row = |of: &str, name: &str, value: &dyn Fn(&PlannerPatterns) -> Option<Spread>| {
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
    row(door, "agents through it", &|planner| planner.door.through);
    row(door, "agents per second and metre", &|planner| planner.door.flow_per_m_s);
    row(door, "longest time in which none passes, s", &|planner| planner.door.longest_gap_s);
    row(door, "agents that wait", &|planner| planner.door.waiting);
    row(door, "radius of their half-circle, m", &|planner| planner.door.radius_m);
    row(door, "its unevenness", &|planner| planner.door.unevenness);
    row(door, "agents/m² within 1 m", &|planner| planner.door.at_the_door_per_m2);
    row(door, "agents/m² from 1 to 2 m", &|planner| planner.door.before_it_per_m2);
    row(door, "C", &|planner| planner.door.collision_rate);
    row(door, "path over the straight line", &|planner| planner.door.path_over_straight_line);
    text + "\n"
}

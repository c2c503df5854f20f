//! `fbcrowd bench plan`: the duration of planning, and whether it is the same in crowds of every size.
//!
//! Discs of 0.3 agents/m², each with the opposite point as its goal, walk with their bodies until they are well mixed.
//! Then the simulation halts every second. MCN with all its constraints, our own ORCA, and ORCA's neighbour query alone
//! are timed in turns on the same frozen world, each with the sorting of the agents into cells. Ratios are formed
//! within a turn, so that other work of the machine affects both alike; medians count.

use std::hint::black_box;
use std::sync::Arc;
use std::time::Instant;

use fbcrowd_jobs::Observer;
use fbcrowd_jobs::observer::Work;
use fbcrowd_sim::params::Params;
use fbcrowd_sim::planning::{CrowdPlanningMemory, Plan, Planner, WorldView, plan_all, ranking_horizon_s};
use fbcrowd_sim::simulation::Simulation;
use fbcrowd_sim::world::neighbours::{NearestNeighbours, NeighbourQuery, NeighbourSearch};
use rayon::ThreadPool;
use schemars::JsonSchema;
use serde::Serialize;

use crate::error::BenchError;
use crate::kit::crowd::disc;
use crate::kit::database::bundled;
use crate::kit::report::{BenchReport, Criterion, Goal};
use crate::kit::statistics::median;
use crate::kit::threads::pool;

/// Sizes of the crowds, agents. The criterion on growth is from the second to the last.
const CROWDS: [usize; 4] = [100, 1_000, 10_000, 100_000];
/// Steps before the first halt, until all agents walk and meet.
const WARM_UP: usize = 30;
/// Steps from halt to halt.
const BETWEEN: usize = 10;
/// Number of halts.
const HALTS: usize = 3;
/// Turns at each halt.
const TURNS: usize = 5;
/// Least number of plans in a turn: small crowds are planned several times.
const PLANS: usize = 20_000;
/// Greatest ratio of MCN to ORCA.
const MCN_OVER_ORCA: f64 = 1.5;
/// Greatest ratio of ORCA to its neighbour query.
const ORCA_OVER_QUERY: f64 = 2.0;
/// Greatest ratio of the durations per agent in the largest crowd and in the one of 1,000.
const GROWTH: f64 = 1.3;
/// Least ratio of the speeds of two threads and of one.
const TWO_THREADS: f64 = 1.6;
/// Goal for planning one agent, µs: about what RVO2 takes, neighbour query included.
const GOAL_US: f64 = 1.5;

/// Time the planning of ever larger crowds.
#[derive(clap::Args)]
#[command(after_help = "Example:\n  fbcrowd bench plan --json")]
pub struct Args {
    /// Leave out larger crowds than this.
    #[arg(long, value_name = "N", default_value_t = CROWDS[3])]
    largest: usize,
}

/// What was measured.
#[derive(JsonSchema, Serialize)]
pub struct Details {
    /// Crowds, the smallest first.
    pub crowds: Vec<CrowdTimes>,
}

/// Median durations and ratios of one crowd. Every duration includes the sorting of the agents into cells.
#[derive(JsonSchema, Serialize)]
pub struct CrowdTimes {
    /// Number of agents.
    pub agents: usize,
    /// ORCA's neighbour query alone, µs per agent and step.
    pub query_microseconds_per_agent_step: f32,
    /// Planning by ORCA, µs per agent and step.
    pub orca_microseconds_per_agent_step: f32,
    /// Planning by MCN, µs per agent and step.
    pub mcn_microseconds_per_agent_step: f32,
    /// Planning by MCN on two threads, µs per agent and step.
    pub mcn_two_threads_microseconds_per_agent_step: f32,
    /// Ratio of MCN to ORCA.
    pub mcn_over_orca: f32,
    /// Ratio of ORCA to its neighbour query.
    pub orca_over_query: f32,
    /// Ratio of the speeds of two threads and of one.
    pub two_threads: f32,
}

/// Durations of one turn, µs per agent and step.
struct Turn {
    query_us: f32,
    orca_us: f32,
    mcn_us: f32,
    mcn_two_threads_us: f32,
}

/// Pools of one thread and of two.
struct Pools {
    one: ThreadPool,
    two: ThreadPool,
}

/// Runs the bench.
///
/// # Errors
/// If the bundled clips give no database, or the system starts no threads.
pub fn run(args: &Args, observer: &Observer) -> Result<BenchReport<Details>, BenchError> {
    let db = Arc::new(bundled()?);
    let pools = Pools { one: pool(1)?, two: pool(2)? };
    let sizes: Vec<usize> = CROWDS.into_iter().filter(|&agents| agents <= args.largest).collect();
    let mut simulations: Vec<Simulation> =
        sizes.iter().map(|&agents| Simulation::new(Arc::clone(&db), &disc(agents))).collect();
    let turns = timed(&mut simulations, &pools, observer);
    let crowds: Vec<CrowdTimes> =
        sizes.iter().zip(&turns).filter_map(|(&agents, turns)| crowd_times(agents, turns)).collect();
    let goals = crowds.iter().find(|crowd| crowd.agents == CROWDS[1]).map(|crowd| Goal {
        name: "planning 1,000 agents, µs per agent-step",
        measured: Some(f64::from(crowd.mcn_microseconds_per_agent_step)),
        goal: GOAL_US,
    });
    let (criteria, details) = (criteria(&crowds), Details { crowds });
    Ok(BenchReport { text: text(&details), details, goals: goals.into_iter().collect(), criteria })
}

/// The turns of each simulation. All crowds are timed at every halt, so that their ratios are of the same minute.
fn timed(simulations: &mut [Simulation], pools: &Pools, observer: &Observer) -> Vec<Vec<Turn>> {
    let mut turns: Vec<Vec<Turn>> = simulations.iter().map(|_| Vec::new()).collect();
    let work = Work::begin(observer, "halts", HALTS);
    for halt in 0..HALTS {
        for simulation in simulations.iter_mut() {
            let steps = if halt == 0 { WARM_UP } else { BETWEEN };
            (0..steps).for_each(|_| simulation.step(&mut |_| ()));
        }
        for _ in 0..TURNS {
            for (simulation, turns) in simulations.iter().zip(&mut turns) {
                turns.push(turn(&simulation.world(), pools));
            }
        }
        work.advance();
    }
    work.end();
    turns
}

fn turn(world: &WorldView, pools: &Pools) -> Turn {
    let plan = |planner, pool| {
        let mut memory = CrowdPlanningMemory::default();
        microseconds(world, pool, planner, |world| plan_once(planner, world, &mut memory))
    };
    Turn {
        query_us: microseconds(world, &pools.one, Planner::Orca, query_once),
        orca_us: plan(Planner::Orca, &pools.one),
        mcn_us: plan(Planner::Mcn, &pools.one),
        mcn_two_threads_us: plan(Planner::Mcn, &pools.two),
    }
}

/// Duration of sorting the agents into cells for a planner and of some work after it, µs per agent. The first time does
/// not count: it wakes the threads and fills the working memory.
fn microseconds(
    world: &WorldView,
    pool: &ThreadPool,
    planner: Planner,
    mut work: impl FnMut(&WorldView) + Send,
) -> f32 {
    let ahead_s = ranking_horizon_s(planner, &Params::default());
    let agents = world.positions_m.len();
    let repeats = PLANS.div_ceil(agents);
    let mut neighbours = NeighbourSearch::default();
    let mut once = || {
        neighbours.rebuild(world.positions_m, world.velocities_mps, world.radii_m, ahead_s);
        work(&WorldView { neighbours: &neighbours, ..*world });
    };
    pool.install(|| {
        once();
        let start = Instant::now();
        (0..repeats).for_each(|_| once());
        start.elapsed().as_secs_f32() * 1e6 / (repeats * agents) as f32
    })
}

fn plan_once(planner: Planner, world: &WorldView, memory: &mut CrowdPlanningMemory) {
    let mut plans = vec![Plan::default(); world.positions_m.len()];
    plan_all(planner, world, &Params::default(), memory, &mut plans);
    black_box(plans);
}

/// The neighbour queries of ORCA.
fn query_once(world: &WorldView) {
    let mut nearest = NearestNeighbours::default();
    for &agent in world.neighbours.in_cell_order() {
        let disc = world.disc(agent as usize);
        let query = NeighbourQuery {
            agent: agent as usize,
            position_m: disc.position_m,
            velocity_mps: disc.velocity_mps,
            radius_m: disc.radius_m,
            range_m: Params::default().orca.neighbour_range_m,
        };
        world.neighbours.nearest(&query, &mut nearest);
        black_box(&nearest);
    }
}

/// Medians over the turns; none without turns.
fn crowd_times(agents: usize, turns: &[Turn]) -> Option<CrowdTimes> {
    let of = |figure: fn(&Turn) -> f32| median(turns.iter().map(figure));
    Some(CrowdTimes {
        agents,
        query_microseconds_per_agent_step: of(|turn| turn.query_us)?,
        orca_microseconds_per_agent_step: of(|turn| turn.orca_us)?,
        mcn_microseconds_per_agent_step: of(|turn| turn.mcn_us)?,
        mcn_two_threads_microseconds_per_agent_step: of(|turn| turn.mcn_two_threads_us)?,
        mcn_over_orca: of(|turn| turn.mcn_us / turn.orca_us)?,
        orca_over_query: of(|turn| turn.orca_us / turn.query_us)?,
        two_threads: of(|turn| turn.mcn_us / turn.mcn_two_threads_us)?,
    })
}

fn criteria(crowds: &[CrowdTimes]) -> Vec<Criterion> {
    // 100 agents meet in the middle within the time, so they are not a steady crowd.
    let steady: Vec<&CrowdTimes> = crowds.iter().filter(|crowd| crowd.agents >= CROWDS[1]).collect();
    let worst = |figure: fn(&CrowdTimes) -> f32, worse: fn(f64, f64) -> f64| {
        steady.iter().map(|crowd| f64::from(figure(crowd))).reduce(worse)
    };
    let growth = steady
        .first()
        .zip(steady.last())
        .map(|(first, last)| f64::from(last.mcn_microseconds_per_agent_step / first.mcn_microseconds_per_agent_step));
    vec![
        Criterion::at_most("MCN over ORCA", MCN_OVER_ORCA, worst(|crowd| crowd.mcn_over_orca, f64::max)),
        Criterion::at_most(
            "ORCA over its neighbour query",
            ORCA_OVER_QUERY,
            worst(|crowd| crowd.orca_over_query, f64::max),
        ),
        Criterion::at_most("growth per agent from 1,000 to the largest crowd", GROWTH, growth),
        Criterion::at_least("speed of two threads over one", TWO_THREADS, worst(|crowd| crowd.two_threads, f64::min)),
    ]
}

fn text(details: &Details) -> String {
    let head = "         agents  query µs  ORCA µs  MCN µs  on two threads  MCN/ORCA  ORCA/query  two threads\n";
    let line = |crowd: &CrowdTimes| {
        format!(
            "{:15}{:10.2}{:9.2}{:8.2}{:16.2}{:10.2}{:12.2}{:13.2}\n",
            crowd.agents,
            crowd.query_microseconds_per_agent_step,
            crowd.orca_microseconds_per_agent_step,
            crowd.mcn_microseconds_per_agent_step,
            crowd.mcn_two_threads_microseconds_per_agent_step,
            crowd.mcn_over_orca,
            crowd.orca_over_query,
            crowd.two_threads,
        )
    };
    head.to_owned() + &details.crowds.iter().map(line).collect::<String>()
}

//! `fbcrowd bench plan`: what planning costs, and whether it costs the same in every crowd.
//!
//! Discs of 0.3 agents/m², each bound for the point opposite, walk with their bodies until they are well mixed. Then
//! the simulation is halted every second, and from the same frozen world MCN, with all its constraints, our own ORCA
//! and ORCA's neighbour query alone are timed in turns, each with the sorting of the agents into cells. Ratios are
//! formed within a turn, so that whatever else the machine does weighs on both alike; medians count.

use std::hint::black_box;
use std::sync::Arc;
use std::time::Instant;

use fbcrowd_sim::maths::SplitMix64;
use fbcrowd_sim::params::Params;
use fbcrowd_sim::planning::{CrowdPlanningMemory, Plan, Planner, WorldView, plan_all, ranking_horizon_s};
use fbcrowd_sim::scenario::{AgentSpec, Scenario};
use fbcrowd_sim::simulation::Simulation;
use fbcrowd_sim::world::neighbours::{NearestNeighbours, NeighbourQuery, NeighbourSearch};
use glam::Vec2;
use rayon::ThreadPool;
use serde::Serialize;

use crate::cmd::bench::bar::{Bar, Found, Goal, conclude};
use crate::cmd::bench::bundled::bundled;
use crate::failure::{Answer, Failure};
use crate::progress::Progress;
use crate::statistics::median;

/// Crowds that are timed; the bar on growth is from the second to the last.
const CROWDS: [usize; 4] = [100, 1_000, 10_000, 100_000];
/// Agents of a square metre, and how far each is off its place of the lattice, as a share of the spacing.
const DENSITY_PER_M2: f32 = 0.3;
const JITTER: f64 = 0.2;
const RADIUS_M: f32 = 0.25;
const SPEED_MPS: f32 = 1.33;
/// The step of Table 1 (§7).
const DT_S: f32 = 0.1;
/// Steps until all walk and meet, and from halt to halt.
const WARM_UP: usize = 30;
const BETWEEN: usize = 10;
const HALTS: usize = 3;
/// Turns at each halt.
const TURNS: usize = 5;
/// A small crowd is planned so often that a turn has this many plans.
const PLANS: usize = 20_000;
/// Limits of the bars, and the goal in µs: about what RVO2 takes, neighbour query included.
const MCN_OVER_ORCA: f64 = 1.5;
const ORCA_OVER_QUERY: f64 = 2.0;
const GROWTH: f64 = 1.3;
const TWO_THREADS: f64 = 1.6;
const GOAL_US: f64 = 1.5;

/// Time the planning of ever larger crowds.
///
/// In JSON `crowds[] {agents, query_microseconds_per_agent_step, orca_…, mcn_…, mcn_two_threads_…, mcn_over_orca,
/// orca_over_query, two_threads}`: times, sorting into cells included, and the medians of the ratios.
#[derive(clap::Args)]
#[command(after_help = "Example:\n  fbcrowd bench plan --json")]
pub(super) struct Args {
    /// Leave crowds larger than this out.
    #[arg(long, value_name = "N", default_value_t = CROWDS[3])]
    largest: usize,
    /// Print JSON.
    #[arg(long)]
    json: bool,
}

#[derive(Serialize)]
struct Details {
    crowds: Vec<Crowd>,
}

#[derive(Serialize)]
struct Crowd {
    agents: usize,
    query_microseconds_per_agent_step: f32,
    orca_microseconds_per_agent_step: f32,
    mcn_microseconds_per_agent_step: f32,
    mcn_two_threads_microseconds_per_agent_step: f32,
    mcn_over_orca: f32,
    orca_over_query: f32,
    two_threads: f32,
}

/// Times of one turn, µs per agent and step.
struct Turn {
    query_us: f32,
    orca_us: f32,
    mcn_us: f32,
    mcn_two_threads_us: f32,
}

/// Threads that plan.
struct Pools {
    one: ThreadPool,
    two: ThreadPool,
}

pub(super) fn run(args: &Args) -> Result<Answer, Failure> {
    let db = Arc::new(bundled()?);
    let pools = Pools { one: pool(1)?, two: pool(2)? };
    let sizes: Vec<usize> = CROWDS.into_iter().filter(|&agents| agents <= args.largest).collect();
    let mut simulations: Vec<Simulation> =
        sizes.iter().map(|&agents| Simulation::new(Arc::clone(&db), &disc(agents))).collect();
    let turns = timed(&mut simulations, &pools);
    let crowds: Vec<Crowd> = sizes.iter().zip(&turns).filter_map(|(&agents, turns)| crowd(agents, turns)).collect();
    let bars = bars(&crowds);
    let goals = crowds.iter().find(|crowd| crowd.agents == CROWDS[1]);
    let goals = goals.map(|crowd| Goal {
        name: "planning 1,000 agents, µs per agent-step",
        measured: Some(f64::from(crowd.mcn_microseconds_per_agent_step)),
        goal: GOAL_US,
    });
    let found = Found { details: Details { crowds }, goals: goals.into_iter().collect(), bars };
    conclude(&found, &text(&found.details), args.json)
}

/// The turns of each simulation. All crowds take turns at every halt, so that growth is measured in the same minute.
fn timed(simulations: &mut [Simulation], pools: &Pools) -> Vec<Vec<Turn>> {
    let mut turns: Vec<Vec<Turn>> = simulations.iter().map(|_| Vec::new()).collect();
    let progress = Progress::new("halts", HALTS);
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
        progress.advance();
    }
    progress.finish();
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

/// Of the sorting into cells for a planner and some work upon it, per agent. The first time, which wakes the threads,
/// and fills the working memory, does not count.
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

/// The searches of ORCA.
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

fn crowd(agents: usize, turns: &[Turn]) -> Option<Crowd> {
    let of = |figure: fn(&Turn) -> f32| median(turns.iter().map(figure));
    Some(Crowd {
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

fn bars(crowds: &[Crowd]) -> Vec<Bar> {
    // 100 agents meet in the middle within the time, and are no steady crowd.
    let steady: Vec<&Crowd> = crowds.iter().filter(|crowd| crowd.agents >= CROWDS[1]).collect();
    let worst = |figure: fn(&Crowd) -> f32, worse: fn(f64, f64) -> f64| {
        steady.iter().map(|crowd| f64::from(figure(crowd))).reduce(worse)
    };
    let growth = steady
        .first()
        .zip(steady.last())
        .map(|(first, last)| f64::from(last.mcn_microseconds_per_agent_step / first.mcn_microseconds_per_agent_step));
    vec![
        Bar::at_most("MCN over ORCA", MCN_OVER_ORCA, worst(|crowd| crowd.mcn_over_orca, f64::max)),
        Bar::at_most("ORCA over its neighbour query", ORCA_OVER_QUERY, worst(|crowd| crowd.orca_over_query, f64::max)),
        Bar::at_most("growth per agent from 1,000 to the largest crowd", GROWTH, growth),
        Bar::at_least("speed of two threads over one", TWO_THREADS, worst(|crowd| crowd.two_threads, f64::min)),
    ]
}

/// A jittered lattice in a disc; each is bound for the point opposite.
pub(super) fn disc(agents: usize) -> Scenario {
    let spacing_m = DENSITY_PER_M2.sqrt().recip();
    let half = ((agents as f32).sqrt() * 0.6) as i32 + 3;
    let place = |index: i32| spacing_m * (index as f32 + 0.5);
    let mut places_m: Vec<Vec2> =
        (-half..half).flat_map(|x| (-half..half).map(move |y| Vec2::new(place(x), place(y)))).collect();
    places_m.sort_by(|a, b| a.length_squared().total_cmp(&b.length_squared()));
    let mut random = SplitMix64::new(1, agents as u64);
    let mut jitter_m = || spacing_m * random.within(JITTER) as f32;
    let agents = places_m.into_iter().take(agents).map(|place_m| agent(place_m + Vec2::new(jitter_m(), jitter_m())));
    Scenario { dt_s: DT_S, ..Scenario::of(agents.collect()) }
}

/// Bound for the point opposite.
pub(super) fn agent(position_m: Vec2) -> AgentSpec {
    AgentSpec {
        position_m,
        facing_rad: (-position_m).to_angle(),
        goals_m: vec![-position_m],
        radius_m: RADIUS_M,
        preferred_speed_mps: SPEED_MPS,
    }
}

pub(super) fn pool(threads: usize) -> Result<ThreadPool, Failure> {
    let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build();
    pool.map_err(|error| Failure::bad(format!("cannot start {threads} threads: {error}")))
}

fn text(details: &Details) -> String {
    let head = "         agents  query µs  ORCA µs  MCN µs  on two threads  MCN/ORCA  ORCA/query  two threads\n";
    let line = |crowd: &Crowd| {
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

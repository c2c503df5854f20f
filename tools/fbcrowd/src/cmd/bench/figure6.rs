//! `fbcrowd bench figure6`: what a frame costs in planning (MCN), synthesis (HMS) and coupling (CNS), for 10 to 10,000
//! people on an antipodal circle: the paper's Fig. 6.
//!
//! All circles take turns, a frame of one thread and a frame of two after each other, so that ratios are of the same
//! moments whatever else the machine does; medians of the turns count. Each follows a frame that does not count: a
//! simulation does not wake its threads anew for every frame as these turns do, and after 26 ms of rest the second
//! thread came too late for half of a frame. A small circle is stepped so often that a turn has [`AGENT_STEPS`]
//! agent-steps. Coupling holds the making of the frame that a recording would keep, not its packing.

use std::f32::consts::TAU;
use std::fs;
use std::path::{Path, PathBuf};
use std::sync::Arc;
use std::time::{Duration, Instant};

use fbcrowd_render::comparison_plot::{Comparison, Measure, comparison};
use fbcrowd_render::png_frame;
use fbcrowd_sim::scenario::Scenario;
use fbcrowd_sim::split_mix::SplitMix64;
use fbcrowd_sim::step::{Simulation, Stage};
use glam::Vec2;
use motiondb::motion_db::MotionDb;
use rayon::ThreadPool;
use serde::Serialize;

use super::bar::{Bar, Found, Goal, conclude};
use super::bundled::database;
use super::plan::{agent, pool};
use crate::failure::{Answer, Failure};
use crate::progress::Progress;
use crate::statistics::median;

/// Circles that are timed. The bars are on those from 1,000 on.
const CIRCLES: [usize; 7] = [10, 17, 50, 100, 500, 1_000, 10_000];
const LARGE: usize = 1_000;
/// Those of `assets/scenarios/table1`: places along the circle, their jitter, the least radius.
const SPACING_M: f32 = 1.5;
const JITTER: f64 = 0.1;
const RADIUS_MIN_M: f32 = 4.0;
/// A film's step.
const DT_S: f32 = 1.0 / 30.0;
/// Until all walk.
const WARM_UP: usize = 30;
const TURNS: usize = 25;
/// Agent-steps of a turn, at least.
const AGENT_STEPS: usize = 200;
/// Limits of the bars …
const TWO_THREADS: f64 = 1.6;
const GROWTH: f64 = 1.3;
const BYTES: f64 = 4096.0;
/// … and goals on a quiet core, µs and frames a second.
const SYNTHESIS_US: f64 = 1.2;
const STEP_US: f64 = 4.0;
const FRAMES_HZ: f64 = 30.0;

/// Time the stages of a frame on ever larger circles.
///
/// In JSON `circles[] {agents, mcn_ms, hms_ms, cns_ms, frame_ms, frame_two_threads_ms, two_threads}`: medians per
/// frame, the stages on one thread; `bytes_per_agent`; `picture`, where one is asked for.
#[derive(clap::Args)]
#[command(after_help = "Examples:\n  fbcrowd bench figure6 -o figure6.png\n  fbcrowd bench figure6 --json")]
pub(super) struct Args {
    /// Draw the times.
    #[arg(short, long, value_name = "FILE.png")]
    output: Option<PathBuf>,
    /// The database that the bodies come from; the bundled clips by default.
    #[arg(long = "db", value_name = "FILE.fbdb")]
    database: Option<PathBuf>,
    /// Leave circles larger than this out.
    #[arg(long, value_name = "N", default_value_t = CIRCLES[6])]
    largest: usize,
    /// Print JSON.
    #[arg(long)]
    json: bool,
}

#[derive(Serialize)]
struct Details {
    circles: Vec<Circle>,
    /// Of the largest circle.
    bytes_per_agent: usize,
    /// Null unless asked for.
    picture: Option<PathBuf>,
}

#[derive(Serialize)]
struct Circle {
    agents: usize,
    mcn_ms: f32,
    hms_ms: f32,
    cns_ms: f32,
    frame_ms: f32,
    frame_two_threads_ms: f32,
    two_threads: f32,
    #[serde(skip)]
    turns: Vec<Turn>,
}

/// Times of one turn, ms a frame.
struct Turn {
    one: Frame,
    two: Frame,
}

/// By stage.
#[derive(Clone, Copy, Default)]
struct Frame {
    mcn_ms: f32,
    hms_ms: f32,
    cns_ms: f32,
}

impl Frame {
    fn total_ms(&self) -> f32 {
        self.mcn_ms + self.hms_ms + self.cns_ms
    }
}

pub(super) fn run(args: &Args) -> Result<Answer, Failure> {
    let db = Arc::new(database(args.database.as_deref())?);
    let pools = [pool(1)?, pool(2)?];
    let sizes: Vec<usize> = CIRCLES.into_iter().filter(|&agents| agents <= args.largest).collect();
    let mut simulations: Vec<Simulation> = sizes.iter().map(|&agents| simulation(&db, agents)).collect();
    let turns = timed(&mut simulations, &pools);
    let circles = sizes.into_iter().zip(turns).filter_map(|(agents, turns)| circle(agents, turns)).collect();
    let bytes_per_agent = simulations.last().map_or(0, Simulation::bytes_per_agent);
    let details = Details { circles, bytes_per_agent, picture: args.output.clone() };
    if let Some(path) = &args.output {
        draw(path, &details.circles)?;
    }
    let (goals, bars, text) = (goals(&details), bars(&details), text(&details));
    conclude(&Found { details, goals, bars }, &text, args.json)
}

/// An antipodal circle.
fn simulation(db: &Arc<MotionDb>, agents: usize) -> Simulation {
    let radius_m = (agents as f32 * SPACING_M / TAU).max(RADIUS_MIN_M);
    let mut random = SplitMix64::new(1, agents as u64);
    let mut place = |index: usize| {
        let angle_rad = TAU * index as f32 / agents as f32 + random.within(JITTER) as f32 * SPACING_M / radius_m;
        agent(radius_m * Vec2::from_angle(angle_rad))
    };
    let scenario = Scenario { dt_s: DT_S, ..Scenario::of((0..agents).map(&mut place).collect()) };
    let mut simulation = Simulation::new(Arc::clone(db), &scenario);
    (0..WARM_UP).for_each(|_| simulation.step(&mut |_| ()));
    simulation
}

/// The turns of each simulation.
fn timed(simulations: &mut [Simulation], pools: &[ThreadPool; 2]) -> Vec<Vec<Turn>> {
    let mut turns: Vec<Vec<Turn>> = simulations.iter().map(|_| Vec::new()).collect();
    let progress = Progress::new("turns", TURNS);
    for _ in 0..TURNS {
        for (simulation, turns) in simulations.iter_mut().zip(&mut turns) {
            turns.push(turn(simulation, pools));
        }
        progress.advance();
    }
    progress.finish();
    turns
}

/// Frames of one thread and of two in turns.
fn turn(simulation: &mut Simulation, pools: &[ThreadPool; 2]) -> Turn {
    let repeats = AGENT_STEPS.div_ceil(simulation.frames().len());
    let mut spent = [[Duration::ZERO; 3]; 2];
    for _ in 0..repeats {
        for (pool, spent) in pools.iter().zip(&mut spent) {
            pool.install(|| {
                simulation.step(&mut |_| ());
                frame(simulation, spent);
            });
        }
    }
    let [one, two] = spent.map(|stages| {
        let [mcn_ms, hms_ms, cns_ms] = stages.map(|spent| spent.as_secs_f32() * 1e3 / repeats as f32);
        Frame { mcn_ms, hms_ms, cns_ms }
    });
    Turn { one, two }
}

/// One step; adds the time of planning, synthesis and coupling.
fn frame(simulation: &mut Simulation, spent: &mut [Duration; 3]) {
    let mut last = Instant::now();
    simulation.step(&mut |stage| {
        let now = Instant::now();
        let index = match stage {
            Stage::Path | Stage::Neighbours | Stage::Planning => 0,
            Stage::Synthesis => 1,
            Stage::Coupling => 2,
        };
        spent[index] += now - last;
        last = now;
    });
}

fn circle(agents: usize, turns: Vec<Turn>) -> Option<Circle> {
    let of = |figure: fn(&Turn) -> f32| median(turns.iter().map(figure));
    Some(Circle {
        agents,
        mcn_ms: of(|turn| turn.one.mcn_ms)?,
        hms_ms: of(|turn| turn.one.hms_ms)?,
        cns_ms: of(|turn| turn.one.cns_ms)?,
        frame_ms: of(|turn| turn.one.total_ms())?,
        frame_two_threads_ms: of(|turn| turn.two.total_ms())?,
        two_threads: of(|turn| turn.one.total_ms() / turn.two.total_ms())?,
        turns,
    })
}

impl Circle {
    /// A time per frame as one per agent, µs.
    fn per_agent_us(&self, frame_ms: f32) -> f64 {
        f64::from(frame_ms) * 1e3 / self.agents as f64
    }
}

fn bars(details: &Details) -> Vec<Bar> {
    let large = || details.circles.iter().filter(|circle| circle.agents >= LARGE);
    let synthesis_us = |circle: &Circle| circle.per_agent_us(circle.hms_ms);
    let growth = large().next().zip(large().next_back()).map(|(first, last)| synthesis_us(last) / synthesis_us(first));
    let two_threads = large().map(|circle| f64::from(circle.two_threads)).reduce(f64::min);
    vec![
        Bar::at_least("speed of two threads over one, from 1,000 on", TWO_THREADS, two_threads),
        Bar::at_most("growth of the synthesis per body from 1,000 to the largest", GROWTH, growth),
        Bar::at_most("memory per agent, bytes", BYTES, details.bytes_per_agent as f64),
    ]
}

fn goals(details: &Details) -> Vec<Goal> {
    let of = |agents: usize| details.circles.iter().find(|circle| circle.agents == agents);
    let (thousand, most) = (of(LARGE), of(CIRCLES[6]));
    vec![
        Goal {
            name: "synthesis of 1,000, µs a body",
            measured: thousand.map(|circle| circle.per_agent_us(circle.hms_ms)),
            goal: SYNTHESIS_US,
        },
        Goal {
            name: "whole step of 1,000, µs an agent",
            measured: thousand.map(|circle| circle.per_agent_us(circle.frame_ms)),
            goal: STEP_US,
        },
        Goal {
            name: "10,000 on two threads, frames a second",
            measured: most.map(|circle| 1e3 / f64::from(circle.frame_two_threads_ms)),
            goal: FRAMES_HZ,
        },
    ]
}

/// Every turn a dot, by circle and stage.
fn draw(path: &Path, circles: &[Circle]) -> Result<(), Failure> {
    if let Some(folder) = path.parent() {
        fs::create_dir_all(folder).map_err(|error| Failure::unwritable(folder, &error))?;
    }
    let stages: [fn(&Frame) -> f32; 3] = [|frame| frame.mcn_ms, |frame| frame.hms_ms, |frame| frame.cns_ms];
    let measure = |label: &str, scale: fn(&Circle) -> f32| {
        let of_circle = |circle: &Circle| -> Vec<Vec<f32>> {
            let of_stage =
                |stage: fn(&Frame) -> f32| circle.turns.iter().map(|turn| stage(&turn.one) * scale(circle)).collect();
            stages.map(of_stage).into()
        };
        Measure { label: label.to_owned(), values: circles.iter().map(of_circle).collect() }
    };
    let sheet = comparison(&Comparison {
        title: "A frame of the antipodal circle on one thread: every turn, mean ± deviation".to_owned(),
        groups: circles.iter().map(|circle| circle.agents.to_string()).collect(),
        contestants: ["planning (MCN)", "synthesis (HMS)", "coupling (CNS)"].map(str::to_owned).into(),
        measures: vec![
            measure("ms a frame, by agents", |_| 1.0),
            measure("µs a frame and agent, by agents", |circle| 1e3 / circle.agents as f32),
        ],
    });
    png_frame::write(path, &sheet).map_err(|error| Failure::bad(error.to_string()))
}

fn text(details: &Details) -> String {
    let head = "  agents  MCN, ms  HMS, ms  CNS, ms  frame, ms  two threads, ms  two threads  µs an agent\n";
    let line = |circle: &Circle| {
        format!(
            "{:8}{:9.3}{:9.3}{:9.3}{:11.3}{:17.3}{:13.2}{:13.2}\n",
            circle.agents,
            circle.mcn_ms,
            circle.hms_ms,
            circle.cns_ms,
            circle.frame_ms,
            circle.frame_two_threads_ms,
            circle.two_threads,
            circle.per_agent_us(circle.frame_ms),
        )
    };
    head.to_owned() + &details.circles.iter().map(line).collect::<String>()
}

//! `fbcrowd bench figure6`: what a frame costs in planning (MCN), synthesis (HMS) and coupling (CNS), for 10 to 10,000
//! people on an antipodal circle: the paper's Fig. 6; and for crowds.
//!
//! On a large circle people walk for minutes before they meet. So mixed crowds are timed beside the circles: discs of
//! 0.3 people/m², who go every way and have to give way to each other, many of them with their bodies deformed.
//!
//! All scenes take turns, a frame of one thread and a frame of two after each other, so that ratios are of the same
//! moments whatever else the machine does; medians of the turns count. Each follows a frame that does not count: a
//! simulation does not wake its threads anew for every frame as these turns do, and after 26 ms of rest the second
//! thread came too late for half of a frame. A small circle is stepped so often that a turn has [`AGENT_STEPS`]
//! agent-steps, its turns are spread over the crossing, and it begins anew once all are across. Coupling holds the
//! making of the frame that a recording would keep, not its packing.

use std::fs;
use std::path::{Path, PathBuf};
use std::sync::Arc;
use std::time::Duration;

use fbcrowd_render::plots::crowd::{ComparedMeasure, Comparison, comparison};
use fbcrowd_render::raster::png_frame;
use rayon::ThreadPool;
use serde::Serialize;

use crate::cmd::bench::bar::{Bar, Found, Goal, conclude};
use crate::cmd::bench::bundled::database;
use crate::cmd::bench::figure6_scene::Scene;
use crate::cmd::bench::plan::pool;
use crate::failure::{Answer, Failure};
use crate::progress::Progress;
use crate::statistics::median;

/// Circles and crowds that are timed. The bars are on those from [`LARGE`] on, to [`LARGEST`].
const CIRCLES: [usize; 7] = [10, 17, 50, 100, 500, LARGE, LARGEST];
const CROWDS: [usize; 2] = [LARGE, LARGEST];
const LARGE: usize = 1_000;
const LARGEST: usize = 10_000;
pub(super) const TURNS: usize = 25;
/// Agent-steps of a turn, at least.
const AGENT_STEPS: usize = 200;
/// Steps that a simulation makes for a frame of one thread and one of two.
const STEPS: usize = 4;
/// Limits of the bars …
const TWO_THREADS: f64 = 1.6;
const GROWTH: f64 = 1.3;
const BYTES: f64 = 4096.0;
/// … and goals on a quiet core, µs and frames a second.
const SYNTHESIS_US: f64 = 1.2;
const STEP_US: f64 = 4.0;
const FRAMES_HZ: f64 = 30.0;

/// Time the stages of a frame on ever larger circles, and in crowds.
///
/// In JSON `circles[]` and `crowds[] {agents, mcn_ms, hms_ms, cns_ms, frame_ms, frame_two_threads_ms, two_threads,
/// deformed_share}`: medians per frame, the stages on one thread, and how many bodies semi-procedural locomotion moves;
/// `bytes_per_agent`; `picture`, where one is asked for.
#[derive(clap::Args)]
#[command(after_help = "Examples:\n  fbcrowd bench figure6 -o figure6.png\n  fbcrowd bench figure6 --json")]
pub(super) struct Args {
    /// Draw the times on the circles.
    #[arg(short, long, value_name = "FILE.png")]
    output: Option<PathBuf>,
    /// The database that the bodies come from; the bundled clips by default.
    #[arg(long = "db", value_name = "FILE.fbdb")]
    database: Option<PathBuf>,
    /// Leave larger circles and crowds out; the bars on growth are missed then.
    #[arg(long, value_name = "N", default_value_t = LARGEST)]
    largest: usize,
    /// Print JSON.
    #[arg(long)]
    json: bool,
}

#[derive(Serialize)]
struct Details {
    circles: Vec<Times>,
    crowds: Vec<Times>,
    /// Of the largest circle.
    bytes_per_agent: usize,
    /// Null unless asked for.
    picture: Option<PathBuf>,
}

/// Of one scene.
#[derive(Serialize)]
struct Times {
    agents: usize,
    mcn_ms: f32,
    hms_ms: f32,
    cns_ms: f32,
    frame_ms: f32,
    frame_two_threads_ms: f32,
    two_threads: f32,
    deformed_share: f32,
    #[serde(skip)]
    turns: Vec<Turn>,
}

/// Times of one turn, ms a frame, and the share of bodies that were deformed at its end.
struct Turn {
    one: Frame,
    two: Frame,
    deformed_share: f32,
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
    let asked = |sizes: &[usize]| sizes.iter().copied().filter(|&agents| agents <= args.largest).collect::<Vec<_>>();
    let mut circles: Vec<Scene> = asked(&CIRCLES).into_iter().map(|agents| Scene::circle(&db, agents)).collect();
    let mut crowds: Vec<Scene> = asked(&CROWDS).into_iter().map(|agents| Scene::crowd(&db, agents)).collect();
    let mut turns = timed(circles.iter_mut().chain(&mut crowds).collect(), &pools);
    let of_crowds = turns.split_off(circles.len());
    let times = |scenes: &[Scene], turns: Vec<Vec<Turn>>| scenes.iter().zip(turns).filter_map(times).collect();
    let details = Details {
        circles: times(&circles, turns),
        crowds: times(&crowds, of_crowds),
        bytes_per_agent: circles.last().map_or(0, |circle| circle.simulation.bytes_per_agent()),
        picture: args.output.clone(),
    };
    if let Some(path) = &args.output {
        draw(path, &details.circles)?;
    }
    let (goals, bars, text) = (goals(&details), bars(&details), text(&details));
    conclude(&Found { details, goals, bars }, &text, args.json)
}

/// The turns of each scene.
fn timed(mut scenes: Vec<&mut Scene>, pools: &[ThreadPool; 2]) -> Vec<Vec<Turn>> {
    let mut turns: Vec<Vec<Turn>> = scenes.iter().map(|_| Vec::new()).collect();
    let progress = Progress::new("turns", TURNS);
    for _ in 0..TURNS {
        for (scene, turns) in scenes.iter_mut().zip(&mut turns) {
            turns.push(turn(scene, pools));
            scene.skip(scene.between);
        }
        progress.advance();
    }
    progress.finish();
    turns
}

/// Frames of one thread and of two in turns.
fn turn(scene: &mut Scene, pools: &[ThreadPool; 2]) -> Turn {
    let repeats = AGENT_STEPS.div_ceil(scene.scenario.agents.len());
    let mut spent = [[Duration::ZERO; 3]; 2];
    for _ in 0..repeats {
        if scene.left < STEPS {
            scene.begin();
        }
        for (pool, spent) in pools.iter().zip(&mut spent) {
            pool.install(|| {
                scene.skip(1);
                scene.frame(spent);
            });
        }
    }
    let [one, two] = spent.map(|stages| {
        let [mcn_ms, hms_ms, cns_ms] = stages.map(|spent| spent.as_secs_f32() * 1e3 / repeats as f32);
        Frame { mcn_ms, hms_ms, cns_ms }
    });
    Turn { one, two, deformed_share: scene.deformed_share() }
}

fn times((scene, turns): (&Scene, Vec<Turn>)) -> Option<Times> {
    let of = |figure: fn(&Turn) -> f32| median(turns.iter().map(figure));
    Some(Times {
        agents: scene.scenario.agents.len(),
        mcn_ms: of(|turn| turn.one.mcn_ms)?,
        hms_ms: of(|turn| turn.one.hms_ms)?,
        cns_ms: of(|turn| turn.one.cns_ms)?,
        frame_ms: of(|turn| turn.one.total_ms())?,
        frame_two_threads_ms: of(|turn| turn.two.total_ms())?,
        two_threads: of(|turn| turn.one.total_ms() / turn.two.total_ms())?,
        deformed_share: turns.iter().map(|turn| turn.deformed_share).sum::<f32>() / turns.len() as f32,
        turns,
    })
}

impl Times {
    /// A time per frame as one per agent, µs.
    fn per_agent_us(&self, frame_ms: f32) -> f64 {
        f64::from(frame_ms) * 1e3 / self.agents as f64
    }

    fn synthesis_us(&self) -> f64 {
        self.per_agent_us(self.hms_ms)
    }

    fn step_us(&self) -> f64 {
        self.per_agent_us(self.frame_ms)
    }

    /// On two threads.
    fn frames_hz(&self) -> f64 {
        1e3 / f64::from(self.frame_two_threads_ms)
    }
}

fn of_size(times: &[Times], agents: usize) -> Option<&Times> {
    times.iter().find(|times| times.agents == agents)
}

fn bars(details: &Details) -> Vec<Bar> {
    let of_scenes = |times: &[Times], word: &str| {
        let large = times.iter().filter(|times| times.agents >= LARGE);
        let two_threads = large.map(|times| f64::from(times.two_threads)).reduce(f64::min);
        let both = of_size(times, LARGE).zip(of_size(times, LARGEST));
        let growth = |of: fn(&Times) -> f64| both.map(|(first, last)| of(last) / of(first));
        [
            Bar::at_least(format!("{word} from 1,000 on, speed of two threads over one"), TWO_THREADS, two_threads),
            Bar::at_most(
                format!("{word} of 10,000 over 1,000, synthesis of a body"),
                GROWTH,
                growth(Times::synthesis_us),
            ),
            Bar::at_most(
                format!("{word} of 10,000 over 1,000, whole step of an agent"),
                GROWTH,
                growth(Times::step_us),
            ),
        ]
    };
    let memory = Bar::at_most("memory per agent, bytes", BYTES, details.bytes_per_agent as f64);
    let bars = of_scenes(&details.circles, "circle").into_iter().chain(of_scenes(&details.crowds, "crowd"));
    bars.chain([memory]).collect()
}

fn goals(details: &Details) -> Vec<Goal> {
    let goal = |name, times: Option<&Times>, of: fn(&Times) -> f64, goal| Goal { name, measured: times.map(of), goal };
    let (circle, crowd) = (of_size(&details.circles, LARGE), of_size(&details.crowds, LARGE));
    let (circle_most, crowd_most) = (of_size(&details.circles, LARGEST), of_size(&details.crowds, LARGEST));
    vec![
        goal("circle of 1,000, synthesis, µs a body", circle, Times::synthesis_us, SYNTHESIS_US),
        goal("circle of 1,000, whole step, µs an agent", circle, Times::step_us, STEP_US),
        goal("circle of 10,000 on two threads, frames a second", circle_most, Times::frames_hz, FRAMES_HZ),
        goal("crowd of 1,000, synthesis, µs a body", crowd, Times::synthesis_us, SYNTHESIS_US),
        goal("crowd of 1,000, whole step, µs an agent", crowd, Times::step_us, STEP_US),
        goal("crowd of 10,000, whole step, µs an agent", crowd_most, Times::step_us, STEP_US),
        goal("crowd of 10,000 on two threads, frames a second", crowd_most, Times::frames_hz, FRAMES_HZ),
    ]
}

/// Every turn a dot, by circle and stage.
fn draw(path: &Path, circles: &[Times]) -> Result<(), Failure> {
    if let Some(folder) = path.parent() {
        fs::create_dir_all(folder).map_err(|error| Failure::unwritable(folder, &error))?;
    }
    let stages: [fn(&Frame) -> f32; 3] = [|frame| frame.mcn_ms, |frame| frame.hms_ms, |frame| frame.cns_ms];
    let measure = |label: &str, scale: fn(&Times) -> f32| {
        let of_circle = |circle: &Times| -> Vec<Vec<f32>> {
            let of_stage =
                |stage: fn(&Frame) -> f32| circle.turns.iter().map(|turn| stage(&turn.one) * scale(circle)).collect();
            stages.map(of_stage).into()
        };
        ComparedMeasure { label: label.to_owned(), values: circles.iter().map(of_circle).collect() }
    };
    let sheet = comparison(&Comparison {
        title: "A frame of the antipodal circle on one thread: every turn, mean ± deviation".to_owned(),
        groups: circles.iter().map(|circle| circle.agents.to_string()).collect(),
        series: ["planning (MCN)", "synthesis (HMS)", "coupling (CNS)"].map(str::to_owned).into(),
        measures: vec![
            measure("ms a frame, by agents", |_| 1.0),
            measure("µs a frame and agent, by agents", |circle| 1e3 / circle.agents as f32),
        ],
    });
    png_frame::write(path, &sheet).map_err(|error| Failure::bad(error.to_string()))
}

fn text(details: &Details) -> String {
    let head = |word: &str| {
        format!(
            "{word:>8}  MCN, ms  HMS, ms  CNS, ms  frame, ms  two threads, ms  two threads  µs an agent  frames/s  deformed\n"
        )
    };
    let line = |times: &Times| {
        format!(
            "{:8}{:9.3}{:9.3}{:9.3}{:11.3}{:17.3}{:13.2}{:13.2}{:10.0}{:8.0} %\n",
            times.agents,
            times.mcn_ms,
            times.hms_ms,
            times.cns_ms,
            times.frame_ms,
            times.frame_two_threads_ms,
            times.two_threads,
            times.step_us(),
            times.frames_hz(),
            100.0 * times.deformed_share,
        )
    };
    let table = |word, times: &[Times]| head(word) + &times.iter().map(line).collect::<String>();
    table("circle", &details.circles) + &table("crowd", &details.crowds)
}

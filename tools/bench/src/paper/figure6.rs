//! `fbcrowd bench figure6`: the duration of a frame's planning (MCN), synthesis (HMS) and coupling (CNS), for 10 to
//! 10,000 agents on an antipodal circle (the paper's Fig. 6), and in crowds.
//!
//! On a large circle agents walk for minutes before they meet. So mixed crowds are timed beside the circles: discs of
//! 0.3 agents/m² that go in all directions and give way to each other, many of them with deformed bodies.
//!
//! All scenes are timed in turns, a frame of one thread and a frame of two one after the other, so that ratios are of
//! the same moments and other work of the machine affects both; medians of the turns count. Each follows a frame that
//! does not count: a simulation does not wake its threads for every frame as these turns do, and after 26 ms of rest
//! the second thread came too late for half of a frame. A small circle is stepped so often that a turn has at least 200
//! agent-steps; its turns are spread over the crossing, and it begins again once all are across. Coupling includes
//! making the frame that a recording would keep, but not packing it.

use std::path::{Path, PathBuf};
use std::sync::Arc;

use fbcrowd_jobs::Observer;
use fbcrowd_render::plots::crowd::{ComparedMeasure, Comparison, comparison};
use fbcrowd_render::raster::png_frame;
use schemars::JsonSchema;
use serde::Serialize;

use crate::error::BenchError;
use crate::kit::args::DatabaseArg;
use crate::kit::database::database;
use crate::kit::report::{BenchReport, Criterion, Goal};
use crate::kit::scenario_run::create_parent;
use crate::kit::threads::pool;
use crate::paper::figure6_scene::Scene;
use crate::paper::figure6_times::{FrameTimes, StageTimes, Turn, timed};

/// Numbers of agents on circles.
const CIRCLES: [usize; 7] = [10, 17, 50, 100, 500, LARGE, LARGEST];
/// Numbers of agents in crowds.
const CROWDS: [usize; 2] = [LARGE, LARGEST];
/// Least number of agents in a criterion.
const LARGE: usize = 1_000;
/// Greatest number of agents.
const LARGEST: usize = 10_000;
/// Least ratio of the speeds of two threads and of one.
const TWO_THREADS: f64 = 1.6;
/// Greatest ratio of the durations per agent in the largest scenes and in those of 1,000.
const GROWTH: f64 = 1.3;
/// Greatest memory per agent, bytes.
const BYTES: f64 = 4096.0;
/// Goal for the synthesis of a body on a quiet core, µs.
const SYNTHESIS_US: f64 = 1.2;
/// Goal for the whole step of an agent on a quiet core, µs.
const STEP_US: f64 = 4.0;
/// Goal for frames per second.
const FRAMES_HZ: f64 = 30.0;

/// Time the stages of a frame on ever larger circles, and in crowds.
#[derive(clap::Args)]
#[command(after_help = "Examples:\n  fbcrowd bench figure6 -o figure6.png\n  fbcrowd bench figure6 --json")]
pub struct Args {
    /// Draw the times on the circles.
    #[arg(short, long, value_name = "FILE.png")]
    output: Option<PathBuf>,
    #[command(flatten)]
    database: DatabaseArg,
    /// Leave out larger circles and crowds; the criteria on growth are missed then.
    #[arg(long, value_name = "N", default_value_t = LARGEST)]
    largest: usize,
}

/// What was measured.
#[derive(JsonSchema, Serialize)]
pub struct Details {
    /// Antipodal circles, the smallest first.
    pub circles: Vec<FrameTimes>,
    /// Mixed crowds, the smallest first.
    pub crowds: Vec<FrameTimes>,
    /// Memory per agent of the largest circle, bytes.
    pub bytes_per_agent: usize,
    /// Path of the picture; null where none is drawn.
    pub picture: Option<PathBuf>,
}

/// Runs the bench.
///
/// # Errors
/// If the database cannot be read, the system starts no threads, or the picture cannot be written.
pub fn run(args: &Args, observer: &Observer) -> Result<BenchReport<Details>, BenchError> {
    args.output.as_ref().map_or(Ok(()), |output| args.database.check_file(output))?;
    let db = Arc::new(database(&args.database)?);
    let pools = [pool(1)?, pool(2)?];
    let timed_sizes = |sizes: &[usize]| sizes.iter().copied().filter(|&size| size <= args.largest).collect::<Vec<_>>();
    let mut circles: Vec<Scene> = timed_sizes(&CIRCLES).into_iter().map(|agents| Scene::circle(&db, agents)).collect();
    let mut crowds: Vec<Scene> = timed_sizes(&CROWDS).into_iter().map(|agents| Scene::crowd(&db, agents)).collect();
    let mut of_circles = timed(circles.iter_mut().chain(&mut crowds).collect(), &pools, observer);
    let of_crowds = of_circles.split_off(circles.len());
    let times = |scenes: &[Scene], turns: Vec<Vec<Turn>>| {
        scenes.iter().zip(turns).filter_map(|(scene, turns)| FrameTimes::new(scene, turns)).collect()
    };
    let details = Details {
        circles: times(&circles, of_circles),
        crowds: times(&crowds, of_crowds),
        bytes_per_agent: circles.last().map_or(0, |circle| circle.simulation.bytes_per_agent()),
        picture: args.output.clone(),
    };
    if let Some(path) = &args.output {
        draw(path, &details.circles)?;
    }
    let (goals, criteria) = (goals(&details), criteria(&details));
    Ok(BenchReport { text: text(&details), details, goals, criteria })
}

/// The times of the scene with this number of agents; none where it was left out.
fn of_size(times: &[FrameTimes], agents: usize) -> Option<&FrameTimes> {
    times.iter().find(|times| times.agents == agents)
}

fn criteria(details: &Details) -> Vec<Criterion> {
    let of_scenes = |times: &[FrameTimes], word: &str| {
        let large = times.iter().filter(|times| times.agents >= LARGE);
        let two_threads = large.map(|times| f64::from(times.two_threads)).reduce(f64::min);
        let both = of_size(times, LARGE).zip(of_size(times, LARGEST));
        let growth = |of: fn(&FrameTimes) -> f64| both.map(|(first, last)| of(last) / of(first));
        [
            Criterion::at_least(
                format!("{word} from 1,000 on, speed of two threads over one"),
                TWO_THREADS,
                two_threads,
            ),
            Criterion::at_most(
                format!("{word} of 10,000 over 1,000, synthesis of a body"),
                GROWTH,
                growth(FrameTimes::synthesis_us),
            ),
            Criterion::at_most(
                format!("{word} of 10,000 over 1,000, whole step of an agent"),
                GROWTH,
                growth(FrameTimes::step_us),
            ),
        ]
    };
    let memory = Criterion::at_most("memory per agent, bytes", BYTES, details.bytes_per_agent as f64);
    let criteria = of_scenes(&details.circles, "circle").into_iter().chain(of_scenes(&details.crowds, "crowd"));
    criteria.chain([memory]).collect()
}

fn goals(details: &Details) -> Vec<Goal> {
    let goal = |name, times: Option<&FrameTimes>, of: fn(&FrameTimes) -> f64, goal| Goal {
        name,
        measured: times.map(of),
        goal,
    };
    let (circle, crowd) = (of_size(&details.circles, LARGE), of_size(&details.crowds, LARGE));
    let (circle_most, crowd_most) = (of_size(&details.circles, LARGEST), of_size(&details.crowds, LARGEST));
    vec![
        goal("circle of 1,000, synthesis, µs a body", circle, FrameTimes::synthesis_us, SYNTHESIS_US),
        goal("circle of 1,000, whole step, µs an agent", circle, FrameTimes::step_us, STEP_US),
        goal("circle of 10,000 on two threads, frames a second", circle_most, FrameTimes::frames_hz, FRAMES_HZ),
        goal("crowd of 1,000, synthesis, µs a body", crowd, FrameTimes::synthesis_us, SYNTHESIS_US),
        goal("crowd of 1,000, whole step, µs an agent", crowd, FrameTimes::step_us, STEP_US),
        goal("crowd of 10,000, whole step, µs an agent", crowd_most, FrameTimes::step_us, STEP_US),
        goal("crowd of 10,000 on two threads, frames a second", crowd_most, FrameTimes::frames_hz, FRAMES_HZ),
    ]
}

/// Draws every turn as a dot, by circle and stage.
fn draw(path: &Path, circles: &[FrameTimes]) -> Result<(), BenchError> {
    create_parent(path)?;
    let stages: [fn(&StageTimes) -> f32; 3] = [|times| times.mcn_ms, |times| times.hms_ms, |times| times.cns_ms];
    let measure = |label: &str, scale: fn(&FrameTimes) -> f32| {
        let of_circle = |circle: &FrameTimes| -> Vec<Vec<f32>> {
            let of_stage = |stage: fn(&StageTimes) -> f32| {
                circle.turns.iter().map(|turn| stage(&turn.one_thread) * scale(circle)).collect()
            };
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
    Ok(png_frame::write(path, &sheet)?)
}

fn text(details: &Details) -> String {
    let head = |word: &str| {
        format!(
            "{word:>8}  MCN, ms  HMS, ms  CNS, ms  frame, ms  two threads, ms  two threads  µs an agent  frames/s  deformed\n"
        )
    };
    let line = |times: &FrameTimes| {
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
    let table = |word, times: &[FrameTimes]| head(word) + &times.iter().map(line).collect::<String>();
    table("circle", &details.circles) + &table("crowd", &details.crowds)
}

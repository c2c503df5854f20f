//! `fbcrowd bench render`: the duration of a frame of the camera view.
//!
//! A crowd walks across a disc; a camera above it sees all bodies. Frames of 1920 × 1080 pixels with four samples are drawn
//! on one thread, with more and more light: shadow of the sun, occlusion of the ground, occlusion of bodies. The larger
//! crowd is ten copies of the smaller one; in another case all wear skinned characters: one of tubes, or the characters of
//! files, with their textures. The least duration counts: other work of the machine only lengthens it. An EXR file with
//! depth, normals, motion and a Cryptomatte is drawn and encoded on two threads. Where a Python has Blender as a package,
//! Cycles draws the triangles of the skinned characters, too.

use std::fs;
use std::hint::black_box;
use std::path::{Path, PathBuf};
use std::sync::Arc;
use std::time::Instant;

use fbcrowd_jobs::character::load;
use fbcrowd_jobs::observer::Work;
use fbcrowd_jobs::{JobError, Observer};
use fbcrowd_render::camera::{CameraOptions, CameraView, ColourBy, Quality, Shot, render_camera_sequence};
use fbcrowd_render::shading::Occlusion;
use fbcrowd_render::top_view::PictureFormat;
use fbcrowd_render::visibility::{Lens, SamplePattern};
use fbcrowd_sim::AgentId;
use fbcrowd_sim::recording::{AgentFrame, ExtraFrame, Header, Recorder, Recording};
use fbcrowd_sim::scenario::{CameraSpec, Scenario};
use fbcrowd_sim::simulation::Simulation;
use glam::{Vec2, Vec3};
use motiondb::body::Skeleton;
use motiondb::character::Character;
use motiondb::motion::MotionDb;
use motiondb_compiler::Outside;
use schemars::JsonSchema;
use serde::Serialize;

use crate::error::BenchError;
use crate::kit::crowd::disc;
use crate::kit::database::bundled;
use crate::kit::report::{BenchReport, Goal};
use crate::kit::threads::pool;
use crate::speed::cycles::CyclesCase;
use crate::speed::tube_character::tube_character;

/// Agents of the smaller crowd.
const AGENTS: usize = 1_000;
/// Steps of the simulation, until all agents walk.
const STEPS: usize = 30;
/// Copies along and across of the larger crowd.
const COPIES: [usize; 2] = [5, 2];
/// Distance of copies, m.
const COPY_M: f32 = 68.0;
/// Size of the picture, pixels.
const SIZE_PX: [u32; 2] = [1920, 1080];
/// Height of a body, m.
const BODY_M: f32 = 1.75;

/// Time a frame of the camera view.
#[derive(clap::Args)]
#[command(
    after_help = "Examples:\n  fbcrowd bench render --json\n  fbcrowd bench render --character my/woman.glb --character my/man.vrm"
)]
pub struct Args {
    /// Number of frames of which the quickest counts.
    #[arg(long, value_name = "N", default_value_t = 5, value_parser = clap::value_parser!(u32).range(1..=1000))]
    pub turns: u32,
    /// A GLB, glTF, VRM or .fbchar file of a character; several are worn in turn. The default is a figure of tubes.
    #[arg(long = "character", value_name = "FILE")]
    pub characters: Vec<PathBuf>,
    /// A Python with Blender's package `bpy`, in which Cycles draws the same characters; by default that of
    /// `FBCROWD_BLENDER_PYTHON`, else python3.11 or python3, where they have it.
    #[arg(long, value_name = "PYTHON")]
    pub blender_python: Option<PathBuf>,
}

/// What was measured.
#[derive(JsonSchema, Serialize)]
pub struct Details {
    /// Durations, in the order in which they were measured.
    pub cases: Vec<Case>,
    /// An EXR file with passes.
    pub exr: ExrCase,
    /// The skinned characters, drawn by Cycles.
    pub cycles: CyclesCase,
}

/// An EXR file of a frame with depth, normals, motion and a Cryptomatte by agent, drawn and written on two threads.
#[derive(JsonSchema, Serialize)]
pub struct ExrCase {
    /// Duration of drawing and encoding, compressed by blocks of sixteen lines, s.
    pub frame_s: f64,
    /// Size of the file, bytes.
    pub bytes: u64,
}

/// One kind of frame.
#[derive(JsonSchema, Serialize)]
pub struct Case {
    /// Number of agents in view.
    pub agents: usize,
    /// Height of the nearest body in the picture, pixels.
    pub tallest_px: f32,
    /// Light that is computed.
    pub light: &'static str,
    /// Duration of making the parts of all bodies on one thread, s.
    pub parts_s: f64,
    /// Duration of the whole frame on one thread, s.
    pub frame_s: f64,
}

/// Name of a light, its quality, and its goal for a thousand agents, s.
const LIGHTS: [(&str, bool, Occlusion, f64); 4] = [
    ("no shadow", false, Occlusion::None, 0.5),
    ("shadow", true, Occlusion::None, 0.6),
    ("shadow and ground occlusion", true, Occlusion::Ground, 0.8),
    ("shadow and full occlusion", true, Occlusion::Full, 1.2),
];
/// Goal for a thousand skinned characters with shadow, s.
const CHARACTER_GOAL_S: f64 = 1.3;
/// Goal for drawing and encoding an EXR file on two threads, s.
const EXR_GOAL_S: f64 = 0.7;
/// Goal for ten thousand agents with shadow, s.
const LARGE_GOAL_S: f64 = 0.8;

/// Runs the bench.
///
/// # Errors
/// If the bundled clips give no database, a file gives no character, or the system gives no thread.
pub fn run(args: &Args, observer: &Observer) -> Result<BenchReport<Details>, BenchError> {
    let db = Arc::new(bundled()?);
    let mut simulation = Simulation::new(Arc::clone(&db), &disc(AGENTS));
    (0..STEPS).for_each(|_| simulation.step(&mut |_| {}));
    let header = Header::new(&db, 0, disc(AGENTS));
    let small = simulation.frames().to_vec();
    let large = copies(&small);
    let characters = characters(&args.characters, &db.skeleton)?;
    let mut dressed = simulation.population().clone();
    for (index, life) in dressed.agents.iter_mut().enumerate() {
        life.character = Some((index % characters.len()) as u32);
    }
    let work = Work::begin(observer, "frames", (LIGHTS.len() + 3) * args.turns as usize + 1);
    let one_thread = pool(1)?;
    let time = |agents: &[AgentFrame], lens: Lens, light: usize, worn: &[Character]| {
        let (name, shadow, occlusion, _) = LIGHTS[light];
        let quality = Quality { samples: SamplePattern::Four, shadow, occlusion };
        let view = CameraView::new(&header, &dressed, quality, ColourBy::Agent).with_characters(worn);
        let name = if worn.is_empty() { name } else { "shadow, skinned characters" };
        let shot = Shot { lens, time_s: 0.0, eyes_of: None, fog_m: None };
        let (mut parts_s, mut frame_s) = (f64::INFINITY, f64::INFINITY);
        for _ in 0..args.turns {
            one_thread.install(|| {
                let stopwatch = Stopwatch::start();
                let scene = view.scene(&shot, agents, &ExtraFrame::default());
                parts_s = parts_s.min(stopwatch.elapsed_s());
                black_box(view.draw_scene(&shot, &scene));
                frame_s = frame_s.min(stopwatch.elapsed_s());
            });
            work.advance();
        }
        Case { agents: agents.len(), tallest_px: tallest_px(&lens, agents), light: name, parts_s, frame_s }
    };
    let mut cases: Vec<Case> = (0..LIGHTS.len()).map(|light| time(&small, wide_lens(34.0), light, &[])).collect();
    cases.push(time(&large, wide_lens(150.0), 1, &[]));
    cases.push(time(&small, wide_lens(34.0), 1, &characters));
    let exr = exr_case(&db, &simulation, args.turns, &work)?;
    let view = CameraView::new(&header, &dressed, Quality::default(), ColourBy::Agent).with_characters(&characters);
    let shot = Shot { lens: wide_lens(34.0), time_s: 0.0, eyes_of: None, fog_m: None };
    let drawn = view.scene(&shot, &small, &ExtraFrame::default());
    let cycles = CyclesCase::measure(args.blender_python.as_deref(), &drawn.meshes, &shot.lens);
    work.advance();
    work.end();
    let mut goals: Vec<Goal> = cases
        .iter()
        .zip(LIGHTS)
        .map(|(case, (name, .., goal))| Goal { name: goal_name(name), measured: Some(case.frame_s), goal })
        .collect();
    goals.push(Goal {
        name: "10,000 agents, shadow, CPU-s a frame",
        measured: cases.get(LIGHTS.len()).map(|case| case.frame_s),
        goal: LARGE_GOAL_S,
    });
    goals.push(Goal {
        name: "1,000 skinned characters, shadow, CPU-s a frame",
        measured: cases.last().map(|case| case.frame_s),
        goal: CHARACTER_GOAL_S,
    });
    let name = "EXR with a Cryptomatte, s to draw and encode on two threads";
    goals.push(Goal { name, measured: Some(exr.frame_s), goal: EXR_GOAL_S });
    let details = Details { cases, exr, cycles };
    Ok(BenchReport { text: text(&details), details, goals, criteria: Vec::new() })
}

/// The characters of files; a figure of tubes where there are none.
fn characters(files: &[PathBuf], skeleton: &Skeleton) -> Result<Vec<Character>, JobError> {
    if files.is_empty() {
        return Ok(vec![tube_character(skeleton)]);
    }
    files.iter().map(|file| Ok(load(file, Outside::Refused, &[])?.character)).collect()
}

/// Draws and writes an EXR file of the crowd.
fn exr_case(db: &MotionDb, simulation: &Simulation, turns: u32, work: &Work<'_>) -> Result<ExrCase, BenchError> {
    let folder = std::env::temp_dir().join(format!("fbcrowd_bench_render_{}", std::process::id()));
    fs::create_dir_all(&folder).map_err(|error| JobError::unwritable(&folder, error))?;
    let measured = timed_exr(db, simulation, turns, work, &folder);
    // A folder that stays does no harm.
    let _ = fs::remove_dir_all(&folder);
    measured
}

fn timed_exr(
    db: &MotionDb,
    simulation: &Simulation,
    turns: u32,
    work: &Work<'_>,
    folder: &Path,
) -> Result<ExrCase, BenchError> {
    let path = folder.join("crowd.fbrec");
    let scenario = Scenario { name: "crowd".to_owned(), ..disc(AGENTS) };
    let mut recorder = Recorder::create(&path, &Header::new(db, 0, scenario)).map_err(JobError::from)?;
    recorder.push(simulation.frames()).map_err(JobError::from)?;
    recorder.finish(simulation.population()).map_err(JobError::from)?;
    let recording = Recording::open(&path).map_err(JobError::from)?;
    let lens = wide_lens(34.0);
    let camera = CameraSpec {
        eye_m: Some(lens.eye_m),
        look_at_m: Some(lens.eye_m + lens.forward),
        fov_deg: Some(87.0),
        ..CameraSpec::default()
    };
    let two_threads = pool(2)?;
    let options = CameraOptions {
        folder: folder.to_owned(),
        name: "crowd".to_owned(),
        format: PictureFormat::Exr,
        cameras: Some(vec![camera]),
        size_px: Some(SIZE_PX),
        passes: "z,n,motion,agent".parse().unwrap_or_default(),
        ..CameraOptions::default()
    };
    let mut frame_s = f64::INFINITY;
    for _ in 0..turns {
        let start = Instant::now();
        two_threads.install(|| render_camera_sequence(&recording, &options, &|_, _| ())).map_err(JobError::from)?;
        frame_s = frame_s.min(start.elapsed().as_secs_f64());
        work.advance();
    }
    let bytes = fs::metadata(folder.join("crowd.1001.exr")).map_or(0, |data| data.len());
    Ok(ExrCase { frame_s, bytes })
}

fn goal_name(light: &str) -> &'static str {
    match light {
        "shadow" => "1,000 agents, shadow, CPU-s a frame",
        "shadow and ground occlusion" => "1,000 agents, shadow and ground occlusion, CPU-s a frame",
        "shadow and full occlusion" => "1,000 agents, shadow and full occlusion, CPU-s a frame",
        _ => "1,000 agents, no shadow, CPU-s a frame",
    }
}

/// The crowd several times, side by side.
fn copies(agents: &[AgentFrame]) -> Vec<AgentFrame> {
    let mut all = Vec::with_capacity(agents.len() * COPIES[0] * COPIES[1]);
    for copy in 0..COPIES[0] * COPIES[1] {
        let [column, row] = [copy % COPIES[0], copy / COPIES[0]];
        let middle = Vec2::new(0.5 * (COPIES[0] - 1) as f32, 0.5 * (COPIES[1] - 1) as f32);
        let shift_m = COPY_M * (Vec2::new(column as f32, row as f32) - middle);
        all.extend(agents.iter().map(|agent| {
            let mut moved = *agent;
            moved.id = AgentId((copy * agents.len()) as u32 + agent.id.0);
            moved.root.position_m += shift_m;
            moved
        }));
    }
    all
}

/// A lens that sees a crowd with this half width from the south, above its heads.
fn wide_lens(half_width_m: f32) -> Lens {
    let eye_m = Vec3::new(0.0, -1.55 * half_width_m, 0.55 * half_width_m);
    Lens::perspective(SIZE_PX, eye_m, Vec3::new(0.0, -0.25 * half_width_m, 0.0), 1.9)
}

fn tallest_px(lens: &Lens, agents: &[AgentFrame]) -> f32 {
    let depth_m = |agent: &AgentFrame| lens.to_camera(agent.root.position_m.extend(0.9)).z;
    let nearest_m = agents.iter().map(depth_m).filter(|depth_m| *depth_m > 1.0).fold(f32::INFINITY, f32::min);
    BODY_M / lens.pixel_m(nearest_m)
}

/// Measures the processor time of its thread; where the system does not report it, the time of day.
struct Stopwatch {
    start: Instant,
    cpu_s: Option<f64>,
}

impl Stopwatch {
    fn start() -> Self {
        Self { start: Instant::now(), cpu_s: thread_cpu_s() }
    }

    fn elapsed_s(&self) -> f64 {
        match (self.cpu_s, thread_cpu_s()) {
            (Some(before_s), Some(after_s)) => after_s - before_s,
            _ => self.start.elapsed().as_secs_f64(),
        }
    }
}

/// Processor time of this thread so far, s; none where the system does not report it.
fn thread_cpu_s() -> Option<f64> {
    let text = fs::read_to_string("/proc/thread-self/schedstat").ok()?;
    Some(1e-9 * text.split_whitespace().next()?.parse::<f64>().ok()?)
}

fn text(details: &Details) -> String {
    let line = |case: &Case| {
        let Case { agents, tallest_px, light, parts_s, frame_s } = case;
        format!(
            "{agents:>7} agents up to {tallest_px:>3.0} px  {light:<28} {frame_s:.3} s a frame, parts {parts_s:.3} s\n"
        )
    };
    let ExrCase { frame_s, bytes } = details.exr;
    let exr = format!("EXR with passes, {:.1} MB: {frame_s:.3} s on two threads\n", bytes as f64 / 1e6);
    let ours_s = details.cases.last().map_or(f64::NAN, |case| case.frame_s);
    details.cases.iter().map(line).collect::<String>() + &exr + &details.cycles.line(ours_s)
}

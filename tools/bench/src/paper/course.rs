//! `fbcrowd bench course`: the paper's obstacle course (§7.1), narrow passages with sharp turns, by motion blending
//! alone, by semi-procedural locomotion alone and by both. The agent finds its way by routes, without waypoints.
//!
//! The paper's claim: blending collides in tight corners, semi-procedural locomotion looks mechanical, and hybrid
//! synthesis does neither. Each walks the course at several speeds, because each meets a corner in another phase of the
//! stride. Measured until the agent is at its goal: how often its disc is held at a wall and its body reaches into one,
//! and the distance of its poses from the database: the RMS angle of bones to the nearest pose of any example
//! ([`PoseSequence`]).

use std::path::{Path, PathBuf};
use std::sync::Arc;

use fbcrowd_jobs::Observer;
use fbcrowd_render::plots::crowd::{PathPanel, side_by_side};
use fbcrowd_render::raster::png_frame;
use fbcrowd_render::top_view::Tracks;
use fbcrowd_sim::measures::{Measures, Measuring};
use fbcrowd_sim::recording::AgentFrame;
use fbcrowd_sim::scenario::Scenario;
use fbcrowd_sim::simulation::Simulation;
use fbcrowd_sim::synthesis::{Mode, Modes, Transition};
use motiondb::body::Skeleton;
use motiondb::motion::MotionDb;
use schemars::JsonSchema;
use serde::Serialize;

use crate::error::BenchError;
use crate::kit::args::{DatabaseArg, PictureArg};
use crate::kit::database::database;
use crate::kit::pose_sequence::PoseSequence;
use crate::kit::report::{BenchReport, Criterion};
use crate::kit::scenario_run::{ScenarioFile, create_parent, scenario, scenario_file, step_count};
use crate::kit::threads::run_each_on_one_thread;

const COURSE: ScenarioFile = scenario_file!("obstacle_course.toml");

/// A synthesis by name: its kinds of locomotion, and the transition between them.
type CourseSynthesis = (&'static str, Modes, Transition);

/// The last is the paper's transition from one kind to the other.
const SYNTHESES: [CourseSynthesis; 4] = [
    ("blending", Modes::Blending, Transition::Direct),
    ("semi_procedural", Modes::SemiProcedural, Transition::Direct),
    ("hybrid", Modes::Hybrid, Transition::Direct),
    ("hybrid_through_m_mb", Modes::Hybrid, Transition::ThroughMMb),
];
/// Preferred speeds, m/s: a stroll, a walk, and a hurry.
const SPEEDS_MPS: [f32; 3] = [0.9, WALK_MPS, 1.9];
/// The speed of the picture and of Table 1's scenes, m/s.
const WALK_MPS: f32 = 1.33;

/// Walk the obstacle course by blending alone, by semi-procedural locomotion alone and by both.
#[derive(clap::Args)]
#[command(
    after_help = "Examples:\n  fbcrowd bench course -o course.png\n  fbcrowd bench course --db motion.fbdb --json"
)]
pub struct Args {
    #[command(flatten)]
    picture: PictureArg,
    #[command(flatten)]
    database: DatabaseArg,
}

/// What was measured.
#[derive(JsonSchema, Serialize)]
pub struct Details {
    /// Path of the picture.
    pub picture: PathBuf,
    /// Walks: every synthesis at every preferred speed.
    #[serde(rename = "ways")]
    pub walks: Vec<CourseWalk>,
}

/// The course by one synthesis at one preferred speed.
#[derive(JsonSchema, Serialize)]
pub struct CourseWalk {
    /// Name of the synthesis.
    pub synthesis: &'static str,
    /// Preferred speed, m/s.
    pub preferred_mps: f32,
    /// Whether the agent arrives at its goal.
    pub arrived: bool,
    /// Time until the agent is at its goal, or until the end, s.
    pub time_s: f64,
    /// Share of the time in which a wall holds the disc, 0 to 1.
    pub wall_disc_share: f64,
    /// Share of the time in which the body reaches into a wall, 0 to 1.
    pub wall_body_share: f64,
    /// Greatest depth of the body in a wall, mm.
    pub wall_body_max_mm: f64,
    /// Root mean square over time of the angle of the bones to the nearest pose of any example, degrees.
    pub pose_distance_deg: f64,
    /// Share of the time in semi-procedural locomotion, 0 to 1.
    pub semi_procedural_share: f64,
    /// Mean acceleration of the root before arrival, m/s².
    pub acceleration_mps2: f64,
    /// Mean speed of planted feet before arrival, cm/s; null where no foot is planted.
    pub planted_slide_cm_s: Option<f64>,
    #[serde(skip)]
    tracks: Tracks,
}

/// Runs the bench.
///
/// # Errors
/// If the database cannot be read, or the picture cannot be written.
pub fn run(args: &Args, observer: &Observer) -> Result<BenchReport<Details>, BenchError> {
    let picture = args.picture.path("course");
    args.database.check_file(&picture)?;
    let db = Arc::new(database(&args.database)?);
    let scenario = scenario(COURSE)?;
    let speeds = SPEEDS_MPS.len();
    let walks = run_each_on_one_thread(SYNTHESES.len() * speeds, observer, |index| {
        walk(&db, &scenario, SYNTHESES[index / speeds], SPEEDS_MPS[index % speeds])
    })?;
    draw(&picture, &scenario, &walks)?;
    let details = Details { picture, walks };
    Ok(BenchReport { text: text(&details), goals: Vec::new(), criteria: criteria(&details.walks), details })
}

/// One agent walks the course until it is at its goal.
fn walk(
    db: &Arc<MotionDb>,
    scenario: &Scenario,
    (synthesis, modes, transition): CourseSynthesis,
    preferred_mps: f32,
) -> CourseWalk {
    let mut scenario = scenario.clone();
    scenario.agents[0].preferred_speed_mps = preferred_mps;
    (scenario.params.synthesis.modes, scenario.params.synthesis.transition) = (modes, transition);
    let mut simulation = Simulation::new(Arc::clone(db), &scenario);
    let mut measuring = Measuring::new(&db.skeleton, &scenario, simulation.population(), simulation.frames());
    let mut tracks = Tracks::new(scenario.dt_s);
    tracks.push_frame(simulation.frames());
    let mut poses = PoseDistances::to_examples_of(db);
    while tracks.frame_count <= step_count(&scenario) && !measuring.all_are_at_goals() {
        simulation.step(&mut |_| {});
        measuring.push(simulation.population(), simulation.frames());
        tracks.push_frame(simulation.frames());
        poses.push(&simulation.frames()[0], &db.skeleton);
    }
    let measures: Measures = measuring.finish(simulation.population());
    let steps = measures.steps.max(1) as f64;
    CourseWalk {
        synthesis,
        preferred_mps,
        arrived: measures.arrived == 1,
        time_s: steps * f64::from(scenario.dt_s),
        wall_disc_share: measures.wall_disc_share,
        wall_body_share: measures.wall_body_share,
        wall_body_max_mm: measures.wall_body_max_mm,
        pose_distance_deg: (poses.squared_deg2 / steps).sqrt(),
        semi_procedural_share: poses.semi_procedural as f64 / steps,
        acceleration_mps2: measures.mean_acceleration_before_arrival_mps2,
        planted_slide_cm_s: measures.planted_slide_cm_s,
        tracks,
    }
}

/// Distances of a body's poses to the examples.
struct PoseDistances {
    examples: Vec<PoseSequence>,
    /// Sum of the squared distances to the nearest example, degrees².
    squared_deg2: f64,
    /// Number of poses of semi-procedural locomotion.
    semi_procedural: usize,
}

impl PoseDistances {
    fn to_examples_of(db: &MotionDb) -> Self {
        let examples = (0..db.examples.len()).map(|example| PoseSequence::of(db, example)).collect();
        Self { examples, squared_deg2: 0.0, semi_procedural: 0 }
    }

    fn push(&mut self, frame: &AgentFrame, skeleton: &Skeleton) {
        let joints = frame.pose.forward_kinematics(skeleton);
        let to_example_deg = self.examples.iter().map(|example| example.distance_to_pose_deg(&joints));
        let nearest_deg = f64::from(to_example_deg.fold(f32::INFINITY, f32::min));
        self.squared_deg2 += nearest_deg * nearest_deg;
        self.semi_procedural += usize::from(frame.mode == Mode::SemiProcedural);
    }
}

/// Draws the paths from above, side by side.
fn draw(path: &Path, scenario: &Scenario, walks: &[CourseWalk]) -> Result<(), BenchError> {
    create_parent(path)?;
    let ways: Vec<PathPanel> = walks.iter().filter(|walk| walk.preferred_mps == WALK_MPS).map(drawn_path).collect();
    let sheet = side_by_side("The obstacle course by each synthesis", scenario, &ways);
    Ok(png_frame::write(path, &sheet)?)
}

fn drawn_path(walk: &CourseWalk) -> PathPanel<'_> {
    PathPanel {
        heading: walk.synthesis.replace('_', " "),
        notes: vec![
            format!("{} in {:.1} s", if walk.arrived { "arrives" } else { "does not arrive" }, walk.time_s),
            format!("at a wall {:.1} % of the time", 100.0 * walk.wall_disc_share),
            format!("poses {:.1}° from the examples", walk.pose_distance_deg),
        ],
        tracks: &walk.tracks,
    }
}

fn criteria(walks: &[CourseWalk]) -> Vec<Criterion> {
    let by = |synthesis: &'static str| walks.iter().filter(move |walk| walk.synthesis == synthesis);
    let mean = |synthesis, of: fn(&CourseWalk) -> f64| by(synthesis).map(of).sum::<f64>() / SPEEDS_MPS.len() as f64;
    let disc = |synthesis| mean(synthesis, |walk| walk.wall_disc_share);
    let body = |synthesis| mean(synthesis, |walk| walk.wall_body_share);
    let poses_deg = |synthesis| mean(synthesis, |walk| walk.pose_distance_deg * walk.pose_distance_deg).sqrt();
    let (hybrid, semi_procedural) = ("hybrid", "semi_procedural");
    vec![
        Criterion::at_least("hybrid arrives, share", 1.0, mean(hybrid, |walk| f64::from(u8::from(walk.arrived)))),
        Criterion::at_most("semi-procedural disc held at a wall, share of time", 0.0, disc(semi_procedural)),
        Criterion::at_most("hybrid disc held at a wall, share of time", 0.0, disc(hybrid)),
        Criterion::at_most("semi-procedural body in a wall, share of time", 0.0, body(semi_procedural)),
        Criterion::at_most("hybrid body in a wall, share of time", body(semi_procedural), body(hybrid)),
        Criterion::below(
            "hybrid poses from the examples, below semi-procedural, °",
            poses_deg(semi_procedural),
            poses_deg(hybrid),
        ),
    ]
}

fn text(details: &Details) -> String {
    let head = format!(
        "{:<21}{:>12}{:>9}{:>9}{:>12}{:>12}{:>12}{:>12}{:>14}{:>10}{:>14}\n",
        "synthesis",
        "wants, m/s",
        "arrives",
        "time, s",
        "disc, %",
        "body, %",
        "body, mm",
        "poses, °",
        "deformed, %",
        "A, m/s²",
        "slide, cm/s"
    );
    let line = |walk: &CourseWalk| {
        format!(
            "{:<21}{:>12.2}{:>9}{:>9.1}{:>12.1}{:>12.1}{:>12.0}{:>12.2}{:>14.0}{:>10.3}{:>14}\n",
            walk.synthesis,
            walk.preferred_mps,
            if walk.arrived { "yes" } else { "no" },
            walk.time_s,
            100.0 * walk.wall_disc_share,
            100.0 * walk.wall_body_share,
            walk.wall_body_max_mm,
            walk.pose_distance_deg,
            100.0 * walk.semi_procedural_share,
            walk.acceleration_mps2,
            walk.planted_slide_cm_s.map_or_else(|| "–".to_owned(), |slide| format!("{slide:.2}")),
        )
    };
    head + &details.walks.iter().map(line).collect::<String>() + &format!("written: {}\n", details.picture.display())
}

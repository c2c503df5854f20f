//! `fbcrowd bench course`: narrow, sharply turning passages by motion blending alone, by semi-procedural locomotion
//! alone and by both, the paper's obstacle course (§7.1).
//!
//! The paper's claim: blending collides in tight corners, semi-procedural locomotion looks mechanical, hybrid synthesis
//! does neither. Each walks the course at several speeds, because a corner is met in another phase of the stride at
//! each. Measured until the agent is at its goal: how often its disc is held at a wall and its body reaches into one,
//! and how far its poses lie from the database: the RMS angle of bones to the nearest pose of any example
//! ([`PoseSequence`]).

use std::fs;
use std::path::{Path, PathBuf};
use std::sync::Arc;

use fbcrowd_render::plots::crowd::{PathPanel, side_by_side};
use fbcrowd_render::raster::png_frame;
use fbcrowd_render::top_view::Tracks;
use fbcrowd_sim::measures::{Measures, Measuring};
use fbcrowd_sim::recording::AgentFrame;
use fbcrowd_sim::scenario::Scenario;
use fbcrowd_sim::simulation::Simulation;
use fbcrowd_sim::synthesis::{Mode, Modes, Transition};
use glam::Vec2;
use motiondb::body::Skeleton;
use motiondb::motion::MotionDb;
use serde::Serialize;

use crate::cmd::bench::bar::{Bar, Found, conclude};
use crate::cmd::bench::bundled::database;
use crate::cmd::bench::contest::{each_alone, step_count};
use crate::cmd::bench::watch::{scenario, scenario_text};
use crate::failure::{Answer, Failure};
use crate::pose_sequence::PoseSequence;

const COURSE: (&str, &str) = scenario_text!("course.toml");
/// The last is the paper's way from one synthesis to the other, beside ours.
const WAYS: [(&str, Modes, Transition); 4] = [
    ("blending", Modes::Blending, Transition::Direct),
    ("semi_procedural", Modes::SemiProcedural, Transition::Direct),
    ("hybrid", Modes::Hybrid, Transition::Direct),
    ("hybrid_through_m_mb", Modes::Hybrid, Transition::ThroughMMb),
];

/// Preferred speeds: a stroll, the walk of everybody else, and a hurry, m/s.
const SPEEDS_MPS: [f32; 3] = [0.9, WALK_MPS, 1.9];
/// The speed of the picture, m/s: that of Table 1's scenes.
const WALK_MPS: f32 = 1.33;

/// Walk the obstacle course by blending alone, by semi-procedural locomotion alone and by both.
///
/// In JSON `picture`, its file, and `ways[] {synthesis, preferred_mps, arrived, time_s, wall_disc_share,
/// wall_body_share, wall_body_max_mm, pose_distance_deg, semi_procedural_share, acceleration_mps2,
/// planted_slide_cm_s}`.
#[derive(clap::Args)]
#[command(
    after_help = "Examples:\n  fbcrowd bench course -o course.png\n  fbcrowd bench course --db motion.fbdb --json"
)]
pub(super) struct Args {
    /// The picture of the paths.
    #[arg(short, long, value_name = "FILE.png", default_value = "out/course.png")]
    output: PathBuf,
    /// The database that the bodies come from; the bundled clips by default.
    #[arg(long = "db", value_name = "FILE.fbdb")]
    database: Option<PathBuf>,
    /// Print JSON.
    #[arg(long)]
    json: bool,
}

#[derive(Serialize)]
struct Details {
    picture: PathBuf,
    ways: Vec<Walked>,
}

/// The course by one synthesis at one speed.
#[derive(Serialize)]
struct Walked {
    synthesis: &'static str,
    preferred_mps: f32,
    arrived: bool,
    /// Until at the goal, or the end.
    time_s: f64,
    /// Share of the time in which the disc is held at a wall.
    wall_disc_share: f64,
    /// Share of the time in which the body reaches into a wall.
    wall_body_share: f64,
    wall_body_max_mm: f64,
    /// RMS over time.
    pose_distance_deg: f64,
    /// Share of the time in semi-procedural locomotion.
    semi_procedural_share: f64,
    acceleration_mps2: f64,
    planted_slide_cm_s: Option<f64>,
    #[serde(skip)]
    tracks: Tracks,
}

pub(super) fn run(args: &Args) -> Result<Answer, Failure> {
    let db = Arc::new(database(args.database.as_deref())?);
    let scenario = scenario(COURSE)?;
    let speeds = SPEEDS_MPS.len();
    let ways = each_alone(WAYS.len() * speeds, |index| {
        walk(&db, &scenario, WAYS[index / speeds], SPEEDS_MPS[index % speeds])
    })?;
    draw(&args.output, &scenario, &ways)?;
    let details = Details { picture: args.output.clone(), ways };
    let (bars, text) = (bars(&details.ways), text(&details));
    conclude(&Found { details, goals: Vec::new(), bars }, &text, args.json)
}

fn walk(
    db: &Arc<MotionDb>,
    scenario: &Scenario,
    (synthesis, modes, transition): (&'static str, Modes, Transition),
    preferred_mps: f32,
) -> Walked {
    let mut scenario = scenario.clone();
    scenario.agents[0].preferred_speed_mps = preferred_mps;
    (scenario.params.synthesis.modes, scenario.params.synthesis.transition) = (modes, transition);
    let mut simulation = Simulation::new(Arc::clone(db), &scenario);
    let mut measuring = Measuring::new(&db.skeleton, &scenario, simulation.frames());
    let root_m = |simulation: &Simulation| simulation.frames()[0].root.position_m;
    let mut positions_m: Vec<Vec2> = vec![root_m(&simulation)];
    let mut poses = Poses::beside(db);
    while positions_m.len() <= step_count(&scenario) && !measuring.all_are_at_goals() {
        simulation.step(&mut |_| {});
        measuring.push(simulation.frames());
        positions_m.push(root_m(&simulation));
        poses.push(&simulation.frames()[0], &db.skeleton);
    }
    let measures: Measures = measuring.finish();
    let steps = measures.steps.max(1) as f64;
    Walked {
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
        tracks: Tracks { agent_count: 1, dt_s: scenario.dt_s, positions_m },
    }
}

/// A body's poses beside the examples: squared distances from the nearest, summed, and how many m_sp made.
struct Poses {
    examples: Vec<PoseSequence>,
    squared_deg2: f64,
    semi_procedural: usize,
}

impl Poses {
    fn beside(db: &MotionDb) -> Self {
        let examples = (0..db.examples.len()).map(|example| PoseSequence::of(db, example)).collect();
        Self { examples, squared_deg2: 0.0, semi_procedural: 0 }
    }

    fn push(&mut self, frame: &AgentFrame, skeleton: &Skeleton) {
        let joints = frame.pose.forward_kinematics(skeleton);
        let to_example_deg = self.examples.iter().map(|example| example.to_pose_deg(&joints));
        self.squared_deg2 += f64::from(to_example_deg.fold(f32::INFINITY, f32::min)).powi(2);
        self.semi_procedural += usize::from(frame.mode == Mode::SemiProcedural);
    }
}

/// The paths from above, side by side.
fn draw(path: &Path, scenario: &Scenario, ways: &[Walked]) -> Result<(), Failure> {
    if let Some(folder) = path.parent() {
        fs::create_dir_all(folder).map_err(|error| Failure::unwritable(folder, &error))?;
    }
    let panels: Vec<PathPanel> =
        ways.iter().filter(|walked| walked.preferred_mps == WALK_MPS).map(path_panel).collect();
    let sheet = side_by_side("The obstacle course by each synthesis", &scenario.agents, &scenario.obstacles_m, &panels);
    png_frame::write(path, &sheet).map_err(|error| Failure::bad(error.to_string()))
}

fn path_panel(walked: &Walked) -> PathPanel<'_> {
    PathPanel {
        heading: walked.synthesis.replace('_', " "),
        notes: vec![
            format!("{} in {:.1} s", if walked.arrived { "arrives" } else { "does not arrive" }, walked.time_s),
            format!("at a wall {:.1} % of the time", 100.0 * walked.wall_disc_share),
            format!("poses {:.1}° from the examples", walked.pose_distance_deg),
        ],
        tracks: &walked.tracks,
    }
}

fn bars(ways: &[Walked]) -> Vec<Bar> {
    let by = |synthesis: &'static str| ways.iter().filter(move |walked| walked.synthesis == synthesis);
    let mean = |synthesis, of: fn(&Walked) -> f64| by(synthesis).map(of).sum::<f64>() / SPEEDS_MPS.len() as f64;
    let disc = |synthesis| mean(synthesis, |walked| walked.wall_disc_share);
    let body = |synthesis| mean(synthesis, |walked| walked.wall_body_share);
    let poses_deg = |synthesis| mean(synthesis, |walked| walked.pose_distance_deg.powi(2)).sqrt();
    let (hybrid, semi_procedural) = ("hybrid", "semi_procedural");
    vec![
        Bar::at_least("hybrid arrives, share", 1.0, mean(hybrid, |walked| f64::from(u8::from(walked.arrived)))),
        Bar::at_most("semi-procedural disc held at a wall, share of time", 0.0, disc(semi_procedural)),
        Bar::at_most("hybrid disc held at a wall, share of time", 0.0, disc(hybrid)),
        Bar::at_most("semi-procedural body in a wall, share of time", 0.0, body(semi_procedural)),
        Bar::at_most("hybrid body in a wall, share of time", body(semi_procedural), body(hybrid)),
        Bar::below(
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
    let line = |walked: &Walked| {
        format!(
            "{:<21}{:>12.2}{:>9}{:>9.1}{:>12.1}{:>12.1}{:>12.0}{:>12.2}{:>14.0}{:>10.3}{:>14}\n",
            walked.synthesis,
            walked.preferred_mps,
            if walked.arrived { "yes" } else { "no" },
            walked.time_s,
            100.0 * walked.wall_disc_share,
            100.0 * walked.wall_body_share,
            walked.wall_body_max_mm,
            walked.pose_distance_deg,
            100.0 * walked.semi_procedural_share,
            walked.acceleration_mps2,
            walked.planted_slide_cm_s.map_or_else(|| "–".to_owned(), |slide| format!("{slide:.2}")),
        )
    };
    head + &details.ways.iter().map(line).collect::<String>() + &format!("written: {}\n", details.picture.display())
}

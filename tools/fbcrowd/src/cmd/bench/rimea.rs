//! `fbcrowd bench rimea`: the tests of the RiMEA guideline for evacuation analyses that concern walking on the level,
//! and three of the kind, each a scenario file of `assets/scenarios`, through full bodies.
//!
//! What each of them measures and demands stands in [`rimea_cases`](crate::cmd::bench::rimea_cases).

use std::fmt::Write;
use std::path::{Path, PathBuf};
use std::sync::Arc;

use fbcrowd_render::plots::crowd::{FundamentalDiagram, fundamental_diagram};
use fbcrowd_render::raster::png_frame;
use fbcrowd_sim::measures::weidmann_mps;
use glam::Vec2;
use serde::Serialize;

use crate::cmd::bench::bar::{Found, conclude};
use crate::cmd::bench::bundled::database;
use crate::cmd::bench::rimea_cases::{CASES, Case, DIAGRAM_SCENARIO, DiagramPoint, Figure, diagram_points};
use crate::cmd::bench::watch::{self, Watched};
use crate::failure::{Answer, Failure};

/// Weidmann's curve is drawn from and to here, 1/m².
const DRAWN_PER_M2: [f64; 2] = [0.2, 3.4];
/// In so many pieces.
const DRAWN_PIECES: usize = 64;

/// Play the RiMEA guideline's tests of walking: speed, density, corners, bottlenecks, and three of the kind.
///
/// In JSON `tests[] {test, scenario, criterion, figures[] {name, value}}` and `fundamental_diagram[] {per_m2,
/// speed_mps, weidmann_mps}`, the points of test 4.
#[derive(clap::Args)]
#[command(after_help = "Example:\n  fbcrowd bench rimea --plots out/plots")]
pub(super) struct Args {
    /// The database that the bodies come from; the bundled clips by default.
    #[arg(long = "db", value_name = "FILE.fbdb")]
    database: Option<PathBuf>,
    /// Draw everybody's paths, a picture a scenario, and the fundamental diagram.
    #[arg(long, value_name = "DIR")]
    plots: Option<PathBuf>,
    /// Print JSON.
    #[arg(long)]
    json: bool,
}

#[derive(Serialize)]
struct Details {
    tests: Vec<Test>,
    fundamental_diagram: Vec<DiagramPoint>,
}

#[derive(Serialize)]
struct Test {
    test: &'static str,
    scenario: &'static str,
    criterion: &'static str,
    figures: Vec<Figure>,
}

pub(super) fn run(args: &Args) -> Result<Answer, Failure> {
    let db = Arc::new(database(args.database.as_deref())?);
    let mut scenarios = Vec::new();
    for case in &CASES {
        let scenario = watch::scenario(case.file)?;
        scenarios.extend(case.turned_deg.iter().map(|turn_deg| watch::turned(&scenario, turn_deg.to_radians())));
    }
    let watched = watch::watch_all(&db, scenarios)?;
    if let Some(folder) = &args.plots {
        write_paths(folder, &db, &watched)?;
    }
    let diagram_run = watched.iter().find(|played| played.scenario.name == DIAGRAM_SCENARIO);
    let fundamental_diagram = diagram_run.map(diagram_points).unwrap_or_default();
    if let Some(folder) = &args.plots {
        write_diagram(&folder.join("fundamental_diagram.png"), &fundamental_diagram)?;
    }
    let (mut tests, mut bars, mut rest) = (Vec::new(), Vec::new(), &watched[..]);
    for case in &CASES {
        let (played, others) = rest.split_at(case.turned_deg.len());
        rest = others;
        let judged = (case.judge)(played);
        tests.push(case.told(judged.figures));
        bars.extend(judged.bars);
    }
    let details = Details { tests, fundamental_diagram };
    let text: String = details.tests.iter().map(Test::text).collect();
    conclude(&Found { details, goals: Vec::new(), bars }, &text, args.json)
}

impl Case {
    fn told(&self, figures: Vec<Figure>) -> Test {
        Test { test: self.test, scenario: self.file.0, criterion: self.criterion, figures }
    }
}

impl Test {
    fn text(&self) -> String {
        let mut text = format!("{} ({})\n  {}\n", self.test, self.scenario, self.criterion);
        for Figure { name, value } in &self.figures {
            // Writing to a string cannot fail.
            let _ = writeln!(text, "  {value:>10.3}  {name}");
        }
        text + "\n"
    }
}

fn write_paths(folder: &Path, db: &motiondb::motion::MotionDb, watched: &[Watched]) -> Result<(), Failure> {
    for (index, played) in watched.iter().enumerate() {
        let again = index > 0 && watched[index - 1].scenario.name == played.scenario.name;
        if !again {
            watch::write_paths(&folder.join(format!("{}.png", played.scenario.name)), db, played)?;
        }
    }
    Ok(())
}

fn write_diagram(path: &Path, points: &[DiagramPoint]) -> Result<(), Failure> {
    let [low, high] = DRAWN_PER_M2;
    let at = |piece: usize| low + (high - low) * piece as f64 / DRAWN_PIECES as f64;
    let place = |per_m2: f64, speed_mps: f64| Vec2::new(per_m2 as f32, speed_mps as f32);
    let picture = fundamental_diagram(&FundamentalDiagram {
        title: "Fundamental diagram: people who all go one way",
        across: "density, people/m²",
        up: "speed, m/s",
        curve: ("Weidmann 1993", (0..=DRAWN_PIECES).map(|piece| place(at(piece), weidmann_mps(at(piece)))).collect()),
        points: ("simulated", points.iter().map(|point| place(point.per_m2, point.speed_mps)).collect()),
    });
    png_frame::write(path, &picture).map_err(|error| Failure::bad(error.to_string()))
}

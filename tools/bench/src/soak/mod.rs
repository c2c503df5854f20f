//! `fbcrowd bench soak`: whether any damaged, forged or mutated input file, or any generated world, ends the program,
//! takes too long or does harm.
//!
//! In: a sound database, the bundled clips, and a seed. Out: counts of the copies that are rejected and used, and every
//! copy with a fault. Each copy draws its random numbers from a seed of its own, the seed of the bench plus its number,
//! so that a single copy can be made again.
//!
//! Read in this order: [`tally`] tries copies; [`draw`], [`mutation`] and [`scratch`] serve all kinds of files; one
//! file for each kind: [`databases`], [`clips`], [`text_files`], [`recordings`]; [`generated`] makes worlds.

pub(crate) mod clips;
pub(crate) mod databases;
pub(crate) mod draw;
pub mod generated;
pub mod mutation;
pub(crate) mod recordings;
pub(crate) mod scratch;
pub mod tally;
pub(crate) mod text_files;

use std::fs;
use std::path::PathBuf;
use std::sync::Arc;

use fbcrowd_jobs::{JobError, Observer};
use fbcrowd_sim::params::Params;
use motiondb::files::database_file;
use motiondb::motion::MotionDb;
use motiondb::velocity_sets::velocity_hull::VelocityHull;
use schemars::JsonSchema;
use serde::Serialize;

use crate::error::BenchError;
use crate::kit::args::DatabaseArg;
use crate::kit::database::database;
use crate::kit::report::{BenchReport, Criterion};
use crate::soak::draw::Draw;
use crate::soak::generated::world::GeneratedWorld;
use crate::soak::generated::{linear_program, scenario, turned_scene};
use crate::soak::scratch::Scratch;
use crate::soak::tally::{CopyOutcome, FaultyCopy, InputKind, InputTally, try_all};

/// Name of the kind of which every copy must be rejected.
const DAMAGED: &str = "damaged databases";

/// Damage, forge and mutate thousands of copies of every kind of input; each must be rejected or do no harm.
///
/// Damaged databases: one byte altered, or cut anywhere; the checksum must reject every one. Forged ones: altered and
/// sealed with a right checksum; what is used must move bodies. BVH and GLB files, manifests, scenarios and recordings:
/// bytes altered, dropped, repeated or inserted, numbers replaced, lengths and checksums set right or not; what is used
/// must give valid databases and finite bodies. All begin with the bundled clips. Generated worlds: agents and
/// obstacles piled, far off, fast, tiny, huge, on edges and in walls; each planner must plan numbers, keep its greatest
/// speed and lead no agent through a wall. Generated scenarios: obstacles, enclosures, ground with holes, sources,
/// queues, states, signals and zones; what is accepted is simulated: finite numbers, no agent through a wall or
/// from the exit of a one-way zone to its entry, none lost or doubled. Turned scenes: everyday ones, turned and moved; the velocity that MCN or
/// ORCA plans must turn with them within 1e-4 m/s. Linear programs: feasible or not, opposite, parallel except for
/// rounding; no velocity of a grid may be better than the solution.
#[derive(clap::Args)]
#[command(after_help = "\
Examples:
  fbcrowd bench soak
  fbcrowd bench soak --db motion.fbdb --count 100000 --forged 10000 --mutated 0 --worlds 0 --scenarios 0 --turned 0 --programs 0
  fbcrowd bench soak --seed 4711 --count 1 --forged 1 --mutated 1 --worlds 1 --scenarios 1 --turned 1 --programs 1    # one copy again")]
pub struct Args {
    #[command(flatten)]
    database: DatabaseArg,
    /// Number of damaged databases.
    #[arg(long, value_name = "N", default_value_t = 10_000)]
    count: usize,
    /// Number of forged databases, which take longer.
    #[arg(long, value_name = "N", default_value_t = 1_000)]
    forged: usize,
    /// Number of mutated files of each other kind.
    #[arg(long, value_name = "N", default_value_t = 1_000)]
    mutated: usize,
    /// Number of generated worlds.
    #[arg(long, value_name = "N", default_value_t = 1_000_000)]
    worlds: usize,
    /// Number of generated scenarios, which are simulated.
    #[arg(long, value_name = "N", default_value_t = 2_000)]
    scenarios: usize,
    /// Write each generated scenario with a fault to this folder.
    #[arg(long, value_name = "DIR")]
    faulty: Option<PathBuf>,
    /// Number of turned scenes.
    #[arg(long, value_name = "N", default_value_t = 10_000)]
    turned: usize,
    /// Number of linear programs.
    #[arg(long, value_name = "N", default_value_t = 100_000)]
    programs: usize,
    /// Seed of all random numbers; a copy's own seed is this plus its number from 0.
    #[arg(long, value_name = "N", default_value_t = 1)]
    seed: u64,
}

/// What was measured.
#[derive(JsonSchema, Serialize)]
pub struct Details {
    /// Seed of the first copy.
    pub seed: u64,
    /// Counts by kind of input.
    pub kinds: Vec<InputTally>,
    /// Copies with a fault.
    #[serde(rename = "finds")]
    pub faulty: Vec<FaultyCopy>,
}

/// Runs the bench.
///
/// # Errors
/// If the database cannot be read, or the temporary folder cannot be written.
pub fn run(args: &Args, observer: &Observer) -> Result<BenchReport<Details>, BenchError> {
    let db = database(&args.database)?;
    let scratch = Scratch::new()?;
    if let Some(folder) = &args.faulty {
        fs::create_dir_all(folder).map_err(|error| JobError::unwritable(folder, error))?;
    }
    let (kinds, faulty) = try_all(&input_kinds(args, &Arc::new(db), &scratch)?, args.seed, observer);
    let total = |count: fn(&InputTally) -> usize| kinds.iter().map(count).sum::<usize>() as f64;
    let refused = kinds.iter().find(|kind| kind.name == DAMAGED).map(|kind| kind.refused as f64);
    let criteria = vec![
        Criterion::at_least("damaged databases refused", args.count as f64, refused),
        Criterion::at_most("copies that end the program", 0.0, total(|kind| kind.panics)),
        Criterion::at_most("copies that take longer than 10 s", 0.0, total(|kind| kind.slow)),
        Criterion::at_most(
            "copies that are used and do harm; worlds, scenes, scenarios and programs with a fault",
            0.0,
            total(|kind| kind.harmful),
        ),
    ];
    let details = Details { seed: args.seed, kinds, faulty };
    Ok(BenchReport { text: text(&details), details, goals: Vec::new(), criteria })
}

/// Every kind of input, with the number of its copies.
fn input_kinds<'a>(args: &Args, db: &Arc<MotionDb>, scratch: &'a Scratch) -> Result<Vec<InputKind<'a>>, BenchError> {
    let bytes = Arc::new(database_file::to_bytes(db));
    let forged = Arc::clone(&bytes);
    let (bvh, glb) = (clips::bundled(".bvh"), clips::bundled(".glb"));
    let recording = recordings::bytes(db, scratch)?;
    text_files::write_clips(scratch)?;
    let (crowd, hull, turned_hull) = (Arc::clone(db), db.velocity_hull.clone(), db.velocity_hull.clone());
    let (walkers, faulty) = (Arc::clone(db), args.faulty.clone());
    let generated_scenario = move |draw: &mut Draw| scenario::simulated(&walkers, draw.seed(), faulty.as_deref());
    let turned = move |draw: &mut Draw| outcome(turned_scene::fault(&turned_hull, draw.seed(), 0));
    let program = |draw: &mut Draw| outcome(linear_program::fault(draw.seed(), 0));
    let kind = |name, copies, attempt| InputKind { name, copies, attempt };
    Ok(vec![
        kind(DAMAGED, args.count, Box::new(move |draw: &mut Draw| databases::damage(&bytes, draw))),
        kind("forged databases", args.forged, Box::new(move |draw: &mut Draw| databases::forge(&forged, draw))),
        kind("BVH", args.mutated, Box::new(move |draw: &mut Draw| clips::bvh(&bvh, draw))),
        kind("GLB", args.mutated, Box::new(move |draw: &mut Draw| clips::glb(&glb, draw))),
        kind("manifests", args.mutated, Box::new(|draw: &mut Draw| text_files::manifest(scratch, draw))),
        kind("scenarios", args.mutated, Box::new(move |draw: &mut Draw| text_files::scenario(&crowd, scratch, draw))),
        kind("recordings", args.mutated, Box::new(move |draw: &mut Draw| recordings::read(&recording, scratch, draw))),
        kind("generated worlds", args.worlds, Box::new(move |draw: &mut Draw| generated_world(&hull, draw))),
        kind("turned scenes", args.turned, Box::new(turned)),
        kind("linear programs", args.programs, Box::new(program)),
        kind("generated scenarios", args.scenarios, Box::new(generated_scenario)),
    ])
}

/// Generates a world and plans in it.
fn generated_world(hull: &VelocityHull, draw: &mut Draw) -> CopyOutcome {
    let world = GeneratedWorld::new(draw.seed(), 0);
    outcome(world.fault(hull, &Params::default()).map(|(_, fault)| fault))
}

fn outcome(fault: Option<&'static str>) -> CopyOutcome {
    fault.map_or(CopyOutcome::Used, CopyOutcome::Harmful)
}

fn text(details: &Details) -> String {
    let mut text = "                      copies  refused    used  harmful  panics  slowest s\n".to_owned();
    for kind in &details.kinds {
        let InputTally { name, copies, refused, used, harmful, panics, slowest_s, .. } = kind;
        text += &format!("{name:<20}{copies:8}{refused:9}{used:8}{harmful:9}{panics:8}{slowest_s:11.2}\n");
    }
    for FaultyCopy { kind, seed, fault } in &details.faulty {
        text += &format!(
            "{kind}: {fault}; again with --seed {seed} --count 1 --forged 1 --mutated 1 --worlds 1 --scenarios 1 --turned 1 --programs 1\n"
        );
    }
    text
}

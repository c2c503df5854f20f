//! `fbcrowd bench soak`: does anything that FbCrowd reads, damaged, forged or mutated, or any world that it is put in,
//! ever end the program, take for ever or do harm?
//!
//! One file a kind of input; worlds, turned scenes and linear programs are drawn and judged by
//! [`fbcrowd_sim::wild::world`], [`fbcrowd_sim::wild::turned_world`] and [`fbcrowd_sim::wild::program`]. Each copy
//! draws its own random numbers from a seed of its own, the run's seed plus its number, so that one copy can be made
//! again alone.

mod clip;
mod database;
mod draw;
mod recording;
mod scratch;
mod text_file;

use std::panic::{AssertUnwindSafe, catch_unwind};
use std::path::PathBuf;
use std::sync::Arc;
use std::time::Instant;

use fbcrowd_sim::params::Params;
use fbcrowd_sim::wild::world::WildWorld;
use fbcrowd_sim::wild::{self, turned_world};
use motiondb::files::database_file;
use motiondb::motion::MotionDb;
use motiondb::validate;
use motiondb::velocity_sets::velocity_hull::VelocityHull;
use rayon::prelude::*;
use serde::Serialize;

use crate::cmd::bench::bar::{Bar, Found, conclude};
use crate::cmd::bench::bundled::bundled;
use crate::cmd::bench::soak::draw::Draw;
use crate::cmd::bench::soak::scratch::Scratch;
use crate::failure::{Answer, Failure};
use crate::output;
use crate::progress::Progress;

/// No copy may take longer, as no input of a fuzz target may.
const LONGEST_S: f64 = 10.0;
const DAMAGED: &str = "damaged databases";

/// Damage, forge and mutate thousands of copies of whatever is read; each must be refused or do no harm.
///
/// Damaged databases: one byte altered, or cut anywhere; the checksum must refuse every one. Forged ones: altered and
/// sealed with a right checksum; what is used must move bodies. BVH and GLB files, manifests, scenarios and recordings:
/// bytes altered, dropped, repeated or inserted, numbers replaced, lengths and checksums set right or not; what is used
/// must give sound databases and finite bodies. All begin with the bundled clips. Wild worlds: agents and obstacles
/// piled, far off, fast, tiny, huge, on edges and in walls; each planner must plan numbers, keep its greatest speed and
/// lead nobody through a wall. Turned scenes: everyday ones, turned and moved; the velocity that MCN or ORCA plans must
/// turn with them within 1e-4 m/s. Linear programs: feasible or not, opposite, parallel but for rounding; no velocity
/// that is tried may be better than the one found.
///
/// In JSON `seed, kinds[] {name, copies, refused, used, harmful, panics, slow, slowest_s}, finds[] {kind, seed, what}`.
#[derive(clap::Args)]
#[command(after_help = "\
Examples:
  fbcrowd bench soak
  fbcrowd bench soak --db motion.fbdb --count 100000 --forged 10000 --mutated 0 --worlds 0 --turned 0 --programs 0
  fbcrowd bench soak --seed 4711 --count 1 --forged 1 --mutated 1 --worlds 1 --turned 1 --programs 1    # a find, again")]
pub(super) struct Args {
    /// A sound database; that of the bundled clips by default.
    #[arg(long = "db", value_name = "FILE.fbdb")]
    database: Option<PathBuf>,
    /// Damaged databases.
    #[arg(long, value_name = "N", default_value_t = 10_000)]
    count: usize,
    /// Forged databases, which take longer.
    #[arg(long, value_name = "N", default_value_t = 1_000)]
    forged: usize,
    /// Mutated files of each other kind.
    #[arg(long, value_name = "N", default_value_t = 1_000)]
    mutated: usize,
    /// Wild worlds.
    #[arg(long, value_name = "N", default_value_t = 1_000_000)]
    worlds: usize,
    /// Turned scenes.
    #[arg(long, value_name = "N", default_value_t = 10_000)]
    turned: usize,
    /// Linear programs.
    #[arg(long, value_name = "N", default_value_t = 100_000)]
    programs: usize,
    /// Which bytes are altered, and how, and what is drawn: of a copy the seed plus its number from 0.
    #[arg(long, value_name = "N", default_value_t = 1)]
    seed: u64,
    /// Print JSON.
    #[arg(long)]
    json: bool,
}

/// What became of one copy.
enum Fate {
    Refused,
    Used,
    /// Used though it is not sound.
    Harmful(&'static str),
}

/// One kind of input: a copy is made from its draws, and read.
struct Kind<'a> {
    name: &'static str,
    copies: usize,
    attempt: Box<dyn Fn(&mut Draw) -> Fate + Sync + 'a>,
}

#[derive(Serialize)]
struct Details {
    seed: u64,
    kinds: Vec<Tally>,
    finds: Vec<Find>,
}

#[derive(Serialize)]
struct Tally {
    name: &'static str,
    copies: usize,
    refused: usize,
    used: usize,
    harmful: usize,
    panics: usize,
    /// Copies over [`LONGEST_S`].
    slow: usize,
    slowest_s: f64,
}

/// A copy that is not as it should be.
#[derive(Serialize)]
struct Find {
    kind: &'static str,
    seed: u64,
    what: &'static str,
}

pub(super) fn run(args: &Args) -> Result<Answer, Failure> {
    let db = match &args.database {
        Some(path) => database_file::load(path)?.0,
        None => bundled()?,
    };
    let scratch = Scratch::new()?;
    let found = soak(&kinds(args, &Arc::new(db), &scratch)?, args.seed);
    let total = |count: fn(&Tally) -> usize| found.kinds.iter().map(count).sum::<usize>() as f64;
    let refused = found.kinds.iter().find(|kind| kind.name == DAMAGED).map(|kind| kind.refused as f64);
    let bars = vec![
        Bar::at_least("damaged databases refused", args.count as f64, refused),
        Bar::at_most("copies that end the program", 0.0, total(|kind| kind.panics)),
        Bar::at_most("copies that take longer than 10 s", 0.0, total(|kind| kind.slow)),
        Bar::at_most(
            "copies that are used and do harm; worlds, scenes and programs with a fault",
            0.0,
            total(|kind| kind.harmful),
        ),
    ];
    let text = text(&found);
    conclude(&Found { details: found, goals: Vec::new(), bars }, &text, args.json)
}

fn kinds<'a>(args: &Args, db: &Arc<MotionDb>, scratch: &'a Scratch) -> Result<Vec<Kind<'a>>, Failure> {
    let bytes = Arc::new(database_file::to_bytes(db));
    let forged = Arc::clone(&bytes);
    let (bvh, glb) = (clip::bundled(".bvh"), clip::bundled(".glb"));
    let recording = recording::bytes(db, scratch)?;
    text_file::write_clips(scratch)?;
    let (crowd, hull, turned_hull) = (Arc::clone(db), db.velocity_hull.clone(), db.velocity_hull.clone());
    let turned = move |draw: &mut Draw| fate(turned_world::fault(&turned_hull, draw.seed(), 0));
    let kind = |name, copies, attempt| Kind { name, copies, attempt };
    Ok(vec![
        kind(DAMAGED, args.count, Box::new(move |draw: &mut Draw| database::damage(&bytes, draw))),
        kind("forged databases", args.forged, Box::new(move |draw: &mut Draw| database::forge(&forged, draw))),
        kind("BVH", args.mutated, Box::new(move |draw: &mut Draw| clip::bvh(&bvh, draw))),
        kind("GLB", args.mutated, Box::new(move |draw: &mut Draw| clip::glb(&glb, draw))),
        kind("manifests", args.mutated, Box::new(|draw: &mut Draw| text_file::manifest(scratch, draw))),
        kind("scenarios", args.mutated, Box::new(move |draw: &mut Draw| text_file::scenario(&crowd, scratch, draw))),
        kind("recordings", args.mutated, Box::new(move |draw: &mut Draw| recording::read(&recording, scratch, draw))),
        kind("wild worlds", args.worlds, Box::new(move |draw: &mut Draw| wild_world(&hull, draw))),
        kind("turned scenes", args.turned, Box::new(turned)),
        kind("linear programs", args.programs, Box::new(|draw: &mut Draw| fate(wild::program::fault(draw.seed(), 0)))),
    ])
}

/// Draws a world and plans in it.
fn wild_world(hull: &VelocityHull, draw: &mut Draw) -> Fate {
    let world = WildWorld::drawn(draw.seed(), 0);
    fate(world.fault(hull, &Params::default()).map(|(_, what)| what))
}

fn fate(fault: Option<&'static str>) -> Fate {
    fault.map_or(Fate::Used, Fate::Harmful)
}

fn soak(kinds: &[Kind], seed: u64) -> Details {
    let progress = Progress::new("copies", kinds.iter().map(|kind| kind.copies).sum());
    let mut found = Details { seed, kinds: Vec::new(), finds: Vec::new() };
    for (stream, kind) in kinds.iter().enumerate() {
        let copy = |index: usize| {
            let seed = seed.wrapping_add(index as u64);
            let outcome = tried(kind, &mut Draw::new(seed, stream as u64));
            progress.advance();
            (seed, outcome)
        };
        let outcomes: Vec<(u64, Outcome)> = (0..kind.copies).into_par_iter().map(copy).collect();
        found.add(kind, &outcomes);
    }
    progress.finish();
    found
}

/// A copy's fate, none where it panicked, and its time.
struct Outcome {
    fate: Option<Fate>,
    seconds: f64,
}

/// The panic's own message, on standard error, names its place.
fn tried(kind: &Kind, draw: &mut Draw) -> Outcome {
    let start = Instant::now();
    let fate = catch_unwind(AssertUnwindSafe(|| (kind.attempt)(draw))).ok();
    Outcome { fate, seconds: start.elapsed().as_secs_f64() }
}

impl Outcome {
    fn fault(&self) -> Option<&'static str> {
        match &self.fate {
            None => Some("ends the program"),
            Some(Fate::Harmful(what)) => Some(what),
            Some(_) => (self.seconds > LONGEST_S).then_some("takes longer than 10 s"),
        }
    }
}

impl Details {
    fn add(&mut self, kind: &Kind, outcomes: &[(u64, Outcome)]) {
        for (seed, what) in outcomes.iter().filter_map(|(seed, outcome)| Some((*seed, outcome.fault()?))) {
            output::say(&format!("{}, seed {seed}: {what}", kind.name));
            self.finds.push(Find { kind: kind.name, seed, what });
        }
        let count = |is: fn(&Outcome) -> bool| outcomes.iter().filter(|(_, outcome)| is(outcome)).count();
        self.kinds.push(Tally {
            name: kind.name,
            copies: kind.copies,
            refused: count(|outcome| matches!(outcome.fate, Some(Fate::Refused))),
            used: count(|outcome| matches!(outcome.fate, Some(Fate::Used))),
            harmful: count(|outcome| matches!(outcome.fate, Some(Fate::Harmful(_)))),
            panics: count(|outcome| outcome.fate.is_none()),
            slow: count(|outcome| outcome.seconds > LONGEST_S),
            slowest_s: outcomes.iter().map(|(_, outcome)| outcome.seconds).fold(0.0, f64::max),
        });
    }
}

/// What is used must be sound: none of the invariants of `fbcrowd validate` broken.
fn judged(db: &MotionDb) -> Fate {
    match validate::validate(db).iter().any(|check| check.broken.is_some()) {
        true => Fate::Harmful("gives a database with a broken invariant"),
        false => Fate::Used,
    }
}

fn text(found: &Details) -> String {
    let mut text = "                    copies  refused    used  harmful  panics  slowest s\n".to_owned();
    for kind in &found.kinds {
        let Tally { name, copies, refused, used, harmful, panics, slowest_s, .. } = kind;
        text += &format!("{name:<18}{copies:8}{refused:9}{used:8}{harmful:9}{panics:8}{slowest_s:11.2}\n");
    }
    for Find { kind, seed, what } in &found.finds {
        text += &format!(
            "{kind}: {what}; again with --seed {seed} --count 1 --forged 1 --mutated 1 --worlds 1 --turned 1 --programs 1\n"
        );
    }
    text
}

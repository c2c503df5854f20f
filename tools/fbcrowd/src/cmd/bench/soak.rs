//! `fbcrowd bench soak`: does a database that was damaged or forged ever pass, or end the program?
//!
//! Damage: one byte altered, or the file cut anywhere; the checksum must catch every one. Forgery: bytes of the payload
//! altered and sealed with a right checksum, so that decoding and every invariant are reached; what still counts as a
//! sound database must move bodies like one.

use std::ops::AddAssign;
use std::panic::{AssertUnwindSafe, catch_unwind};
use std::path::{Path, PathBuf};
use std::sync::Arc;

use fbcrowd_sim::params::Params;
use fbcrowd_sim::scenario::{AgentSpec, Scenario, View};
use fbcrowd_sim::split_mix::SplitMix64;
use fbcrowd_sim::step::Simulation;
use glam::Vec2;
use motiondb::container::{self, HEADER_LENGTH};
use motiondb::motion_db::MotionDb;
use motiondb::{file, validate};
use rayon::prelude::*;
use serde::Serialize;

use super::bar::{Bar, Found, conclude};
use crate::failure::{Answer, Failure};
use crate::output;
use crate::progress::Progress;

/// Steps for which a forged database that seems sound is simulated: a second, about a stride.
const STEPS: usize = 30;
/// Skeleton, sources and examples of a small database are as long as this, sets and simplices too.
const END_BYTES: usize = 4096;
/// Four bytes that hurt where a number, an index or a length is meant.
const HOSTILE: [u32; 8] = [
    0,
    1,
    u32::MAX,
    i32::MAX as u32,
    f32::NAN.to_bits(),
    f32::INFINITY.to_bits(),
    (-1.0_f32).to_bits(),
    1e30_f32.to_bits(),
];

/// Damage and forge a database thousands of times; every damaged one must be refused, and none may end the program.
///
/// In JSON `damaged, refused, forged, undecodable, unsound, harmless, harmful`.
#[derive(clap::Args)]
#[command(after_help = "Example:\n  fbcrowd bench soak motion.fbdb --count 10000")]
pub(super) struct Args {
    /// A sound database.
    #[arg(value_name = "FILE.fbdb")]
    database: PathBuf,
    /// Damaged copies.
    #[arg(long, value_name = "N", default_value_t = 10_000)]
    count: usize,
    /// Forged copies, which take longer.
    #[arg(long, value_name = "N", default_value_t = 1_000)]
    forged: usize,
    /// Which bytes are altered, and how.
    #[arg(long, value_name = "N", default_value_t = 1)]
    seed: u64,
    /// Print JSON.
    #[arg(long)]
    json: bool,
}

/// What became of the copies.
#[derive(Clone, Copy, Debug, Default, Serialize)]
struct Details {
    damaged: usize,
    refused: usize,
    forged: usize,
    /// No database by its form.
    undecodable: usize,
    /// An invariant caught it.
    unsound: usize,
    /// Sound, and it moved bodies like a sound one.
    harmless: usize,
    /// Sound, but bodies got nowhere or the program would have ended.
    harmful: usize,
}

pub(super) fn run(args: &Args) -> Result<Answer, Failure> {
    let bytes = file::to_bytes(&file::load(&args.database)?.0);
    let details = soak(&bytes, args);
    let count = |count: usize| count as f64;
    let found = Found {
        details,
        goals: Vec::new(),
        bars: vec![
            Bar::at_least("damaged databases refused", count(args.count), count(details.refused)),
            Bar::at_most("forged databases that do harm", 0.0, count(details.harmful)),
        ],
    };
    conclude(&found, &text(&details), args.json)
}

/// Damages and forges a database; each copy draws its own random numbers.
fn soak(bytes: &[u8], args: &Args) -> Details {
    let progress = Progress::new("copies", args.count + args.forged);
    let copy = |index: usize| {
        let mut random = SplitMix64::new(args.seed, index as u64);
        let attempt = || if index < args.count { damage(bytes, &mut random) } else { forge(bytes, &mut random) };
        let outcome = catch_unwind(AssertUnwindSafe(attempt));
        progress.advance();
        // The panic's own message names its place.
        outcome.unwrap_or_else(|_| {
            output::say(&format!("copy {index} of seed {} ends the program", args.seed));
            Details { harmful: 1, ..Details::default() }
        })
    };
    let outcomes: Vec<Details> = (0..args.count + args.forged).into_par_iter().map(copy).collect();
    progress.finish();
    let mut sum = Details::default();
    outcomes.into_iter().for_each(|outcome| sum += outcome);
    sum
}

/// Alters one byte or cuts the file.
fn damage(bytes: &[u8], random: &mut SplitMix64) -> Details {
    let mut copy = bytes.to_vec();
    let place = below(copy.len(), random);
    if random.next_u64().is_multiple_of(2) {
        copy.truncate(place);
    } else {
        copy[place] ^= 1 + below(255, random) as u8;
    }
    let refused = file::from_bytes(Path::new("damaged"), &copy).is_err();
    Details { damaged: 1, refused: usize::from(refused), ..Details::default() }
}

/// Alters the payload and seals it anew.
fn forge(bytes: &[u8], random: &mut SplitMix64) -> Details {
    let mut payload = bytes[HEADER_LENGTH..].to_vec();
    let place = forged_place(payload.len() - size_of::<u32>(), random);
    match random.next_u64() % 3 {
        0 => payload[place] ^= 1 + below(255, random) as u8,
        1 => payload[place..place + 4].copy_from_slice(&HOSTILE[below(HOSTILE.len(), random)].to_le_bytes()),
        _ => {
            let from = below(payload.len() - size_of::<u32>(), random);
            payload.copy_within(from..from + 4, place);
        }
    }
    let forged = Details { forged: 1, ..Details::default() };
    let sealed = container::seal(file::MAGIC, file::VERSION, &payload);
    let Ok((db, _)) = file::from_bytes(Path::new("forged"), &sealed) else {
        return Details { undecodable: 1, ..forged };
    };
    if validate::validate(&db).iter().any(|check| check.broken.is_some()) {
        return Details { unsound: 1, ..forged };
    }
    if moves_bodies(db) { Details { harmless: 1, ..forged } } else { Details { harmful: 1, ..forged } }
}

/// Anywhere; every other time near an end, where all stands that is not rows of poses.
fn forged_place(limit: usize, random: &mut SplitMix64) -> usize {
    let (anywhere, near) = (below(limit, random), below(limit.min(END_BYTES), random));
    match random.next_u64() % 4 {
        0 => near,
        1 => limit - 1 - near,
        _ => anywhere,
    }
}

/// Whether bodies that cross each other's way stay somewhere.
fn moves_bodies(db: MotionDb) -> bool {
    let mut simulation = Simulation::new(Arc::new(db), &crossing());
    (0..STEPS).for_each(|_| simulation.step(&mut |_| ()));
    simulation.frames().iter().all(|agent| agent.root.position_m.is_finite() && agent.pose.pelvis_m.is_finite())
}

/// Four bodies on the sides of a square, each with its goal on the other side.
fn crossing() -> Scenario {
    let agent = |position_m: Vec2| AgentSpec {
        position_m,
        facing_rad: (-position_m).to_angle(),
        goals_m: vec![-position_m],
        radius_m: 0.25,
        preferred_speed_mps: 1.33,
    };
    Scenario {
        name: "crossing".to_owned(),
        duration_s: 1.0,
        dt_s: 1.0 / 30.0,
        seed: 1,
        agents: [Vec2::X, Vec2::Y, Vec2::NEG_X, Vec2::NEG_Y].map(|side| agent(2.0 * side)).to_vec(),
        obstacles_m: Vec::new(),
        params: Params::default(),
        view: View::default(),
    }
}

fn below(limit: usize, random: &mut SplitMix64) -> usize {
    (random.next_u64() % limit as u64) as usize
}

impl AddAssign for Details {
    fn add_assign(&mut self, other: Self) {
        self.damaged += other.damaged;
        self.refused += other.refused;
        self.forged += other.forged;
        self.undecodable += other.undecodable;
        self.unsound += other.unsound;
        self.harmless += other.harmless;
        self.harmful += other.harmful;
    }
}

fn text(found: &Details) -> String {
    format!(
        "damaged  {}, of them refused {}\nforged   {}: {} cannot be decoded, {} break an invariant, {} do no harm, {} do\n",
        found.damaged, found.refused, found.forged, found.undecodable, found.unsound, found.harmless, found.harmful,
    )
}

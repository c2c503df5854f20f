//! Tries copies of one kind of input, and counts what becomes of them.

use std::panic::{AssertUnwindSafe, catch_unwind};
use std::time::Instant;

use fbcrowd_jobs::observer::Work;
use fbcrowd_jobs::{JobEvent, Observer};
use rayon::prelude::*;
use schemars::JsonSchema;
use serde::Serialize;

use crate::soak::draw::Draw;

/// Greatest duration of a copy, s, as of an input of a fuzz target.
const LONGEST_S: f64 = 10.0;

/// Outcome of one copy.
pub(crate) enum CopyOutcome {
    /// The copy was rejected.
    Rejected,
    /// The copy was used, and is sound.
    Used,
    /// The copy was used although it is invalid; with the fault.
    Harmful(&'static str),
}

/// One kind of input. A copy is made from its random draws, and read.
pub(crate) struct InputKind<'a> {
    pub(crate) name: &'static str,
    pub(crate) copies: usize,
    pub(crate) attempt: Box<dyn Fn(&mut Draw) -> CopyOutcome + Sync + 'a>,
}

/// Counts of one kind of input.
#[derive(JsonSchema, Serialize)]
pub struct InputTally {
    /// Name of the kind.
    pub name: &'static str,
    /// Number of copies.
    pub copies: usize,
    /// Number of copies that were rejected.
    pub refused: usize,
    /// Number of copies that were used and are valid.
    pub used: usize,
    /// Number of copies that were used and are invalid.
    pub harmful: usize,
    /// Number of copies that ended the program.
    pub panics: usize,
    /// Number of copies that took longer than 10 s.
    pub slow: usize,
    /// Longest duration of a copy, s.
    pub slowest_s: f64,
}

/// A copy with a fault.
#[derive(JsonSchema, Serialize)]
pub struct FaultyCopy {
    /// Name of the kind of input.
    pub kind: &'static str,
    /// Seed of the copy; with it, a single copy is made again.
    pub seed: u64,
    /// What is wrong.
    #[serde(rename = "what")]
    pub fault: &'static str,
}

/// Outcome of one copy, none where it panicked, and its duration.
struct TriedCopy {
    seed: u64,
    outcome: Option<CopyOutcome>,
    seconds: f64,
}

impl TriedCopy {
    /// What is wrong; none where nothing is.
    fn fault(&self) -> Option<&'static str> {
        match &self.outcome {
            None => Some("ends the program"),
            Some(CopyOutcome::Harmful(fault)) => Some(fault),
            Some(_) => (self.seconds > LONGEST_S).then_some("takes longer than 10 s"),
        }
    }
}

/// Tries every copy of every kind, the first with the seed, each further one with the next seed.
pub(crate) fn try_all(kinds: &[InputKind], seed: u64, observer: &Observer) -> (Vec<InputTally>, Vec<FaultyCopy>) {
    let work = Work::begin(observer, "copies", kinds.iter().map(|kind| kind.copies).sum());
    let (mut tallies, mut faulty) = (Vec::new(), Vec::new());
    for (stream, kind) in kinds.iter().enumerate() {
        let copy = |index: usize| {
            let tried = tried(kind, seed.wrapping_add(index as u64), stream as u64);
            work.advance();
            tried
        };
        let copies: Vec<TriedCopy> = (0..kind.copies).into_par_iter().map(copy).collect();
        for (seed, fault) in copies.iter().filter_map(|copy| Some((copy.seed, copy.fault()?))) {
            observer(JobEvent::Note(&format!("{}, seed {seed}: {fault}", kind.name)));
            faulty.push(FaultyCopy { kind: kind.name, seed, fault });
        }
        tallies.push(tally(kind, &copies));
    }
    work.end();
    (tallies, faulty)
}

/// Makes and reads one copy. The message of a panic, on standard error, names its place.
fn tried(kind: &InputKind, seed: u64, stream: u64) -> TriedCopy {
    let (mut draw, start) = (Draw::new(seed, stream), Instant::now());
    let outcome = catch_unwind(AssertUnwindSafe(|| (kind.attempt)(&mut draw))).ok();
    TriedCopy { seed, outcome, seconds: start.elapsed().as_secs_f64() }
}

fn tally(kind: &InputKind, copies: &[TriedCopy]) -> InputTally {
    let count = |is: fn(&TriedCopy) -> bool| copies.iter().filter(|copy| is(copy)).count();
    InputTally {
        name: kind.name,
        copies: kind.copies,
        refused: count(|copy| matches!(copy.outcome, Some(CopyOutcome::Rejected))),
        used: count(|copy| matches!(copy.outcome, Some(CopyOutcome::Used))),
        harmful: count(|copy| matches!(copy.outcome, Some(CopyOutcome::Harmful(_)))),
        panics: count(|copy| copy.outcome.is_none()),
        slow: count(|copy| copy.seconds > LONGEST_S),
        slowest_s: copies.iter().map(|copy| copy.seconds).fold(0.0, f64::max),
    }
}

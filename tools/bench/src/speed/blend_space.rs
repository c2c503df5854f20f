//! `fbcrowd bench blend-space`: the duration of a query of the blend space, which must not depend on the number of
//! examples.

use std::hint::black_box;
use std::time::Instant;

use fbcrowd_jobs::Observer;
use fbcrowd_sim::maths::SplitMix64;
use glam::{DVec3, Vec3};
use motiondb::blend_space::Locator;
use motiondb::blend_space::triangulation::build;
use motiondb::motion::Parameters;
use schemars::JsonSchema;
use serde::Serialize;

use crate::error::BenchError;
use crate::kit::report::{BenchReport, Criterion, Goal};

/// Numbers of examples: from the paper's set to the windows of long captures.
const EXAMPLES: [usize; 3] = [19, 100, 500];
/// Half the ranges of (v_f, ω_t, ω_s) that examples are drawn from, m/s, rad/s, m/s.
const HALF_RANGES: DVec3 = DVec3::new(2.0, 2.0, 1.0);
/// Size of the larger box of queries, as a multiple of the examples' box.
const AROUND: f64 = 3.0;
/// Number of queries in a round.
const QUERIES: usize = 10_000;
/// Number of rounds; the quickest counts, since the others were disturbed.
const ROUNDS: usize = 10;
/// Greatest ratio of the durations with the most and the fewest examples. The number of simplices grows fiftyfold and
/// its logarithm doubles; the rest is for memory that no longer fits a cache.
const GROWTH: f64 = 4.0;
/// Goal for the simplices of the most examples, s.
const BUILD_GOAL_S: f64 = 1.0;

/// Time queries of ever larger blend spaces.
#[derive(clap::Args)]
#[command(after_help = "Example:\n  fbcrowd bench blend-space --json")]
pub struct Args {}

/// What was measured.
#[derive(JsonSchema, Serialize)]
pub struct Details {
    /// Sets of examples, the smallest first.
    pub sets: Vec<ExampleSet>,
}

/// A set of random examples.
#[derive(JsonSchema, Serialize)]
pub struct ExampleSet {
    /// Number of examples.
    pub examples: usize,
    /// Number of simplices.
    pub simplices: usize,
    /// Duration of building the simplices, s.
    pub build_s: f64,
    /// Duration of preparing the queries, s.
    pub load_s: f64,
    /// Duration of a query from within the examples' box, ns.
    pub within_ns: f64,
    /// Duration of a query from three times that box, ns; most of them go to the nearest point of the hull.
    pub around_ns: f64,
}

/// Runs the bench.
///
/// # Errors
/// None.
pub fn run(_: &Args, _: &Observer) -> Result<BenchReport<Details>, BenchError> {
    let sets: Vec<ExampleSet> = EXAMPLES.map(measured).into();
    let (fewest, most) = (&sets[0], &sets[EXAMPLES.len() - 1]);
    let criteria = vec![
        Criterion::at_most("time of a query, 500 examples over 19", GROWTH, most.within_ns / fewest.within_ns),
        Criterion::at_most("the same from around the hull", GROWTH, most.around_ns / fewest.around_ns),
    ];
    let goals = vec![Goal { name: "simplices of 500 examples, s", measured: Some(most.build_s), goal: BUILD_GOAL_S }];
    let details = Details { sets };
    Ok(BenchReport { text: text(&details), details, goals, criteria })
}

fn measured(examples: usize) -> ExampleSet {
    let mut random = SplitMix64::new(1, examples as u64);
    let parameters = drawn(&mut random, examples, 1.0);
    let (build_s, space) = timed(|| build(&parameters));
    let (load_s, locator) = timed(|| Locator::new(&space, &parameters));
    let mut query_ns = |around: f64| {
        let queries = drawn(&mut random, QUERIES, around);
        let locate_all = || queries.iter().for_each(|&query| _ = black_box(locator.locate(query)));
        (0..ROUNDS).map(|_| timed(locate_all).0).fold(f64::INFINITY, f64::min) * 1e9 / QUERIES as f64
    };
    let (within_ns, around_ns) = (query_ns(1.0), query_ns(AROUND));
    ExampleSet { examples, simplices: space.simplices().count(), build_s, load_s, within_ns, around_ns }
}

/// Random parameters from the examples' box, `around` times as large.
fn drawn(random: &mut SplitMix64, count: usize, around: f64) -> Vec<Parameters> {
    let axis = |half_range: f64, random: &mut SplitMix64| random.within(around * half_range) as f32;
    let point = |_| Vec3::from_array(HALF_RANGES.to_array().map(|half_range| axis(half_range, random)));
    (0..count).map(point).map(Parameters::from_vec3).collect()
}

/// Duration of some work, s, and its result.
fn timed<T>(work: impl FnOnce() -> T) -> (f64, T) {
    let start = Instant::now();
    let done = work();
    (start.elapsed().as_secs_f64(), done)
}

fn text(details: &Details) -> String {
    let line = |set: &ExampleSet| {
        format!(
            "{:4} examples, {:4} simplices: built in {:5.1} ms, loaded in {:5.1} ms; a query takes {:4.0} ns, around the \
             hull {:4.0} ns\n",
            set.examples,
            set.simplices,
            1e3 * set.build_s,
            1e3 * set.load_s,
            set.within_ns,
            set.around_ns,
        )
    };
    details.sets.iter().map(line).collect()
}

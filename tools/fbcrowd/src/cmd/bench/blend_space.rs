//! `fbcrowd bench blend-space`: do queries of the blend space cost the same however many examples it holds?

use std::hint::black_box;
use std::time::Instant;

use fbcrowd_sim::maths::SplitMix64;
use glam::{DVec3, Vec3};
use motiondb::blend_space::Locator;
use motiondb::blend_space::triangulation::build;
use motiondb::motion::Parameters;
use serde::Serialize;

use crate::cmd::bench::bar::{Bar, Found, Goal, conclude};
use crate::failure::{Answer, Failure};

/// From the paper's set to the windows of long captures.
const EXAMPLES: [usize; 3] = [19, 100, 500];
/// Half the ranges of (v_f, ω_t, ω_s) that examples are drawn from, m/s, rad/s, m/s.
const HALF_RANGES: DVec3 = DVec3::new(2.0, 2.0, 1.0);
/// Queries from the same box, and from that many times around it.
const AROUND: f64 = 3.0;
const QUERIES: usize = 10_000;
/// The quickest of so many rounds counts: the others were disturbed.
const ROUNDS: usize = 10;
/// Simplices grow fiftyfold, their logarithm doubles; the rest is for memory that no longer fits a cache.
const GROWTH: f64 = 4.0;

/// Time queries of ever larger blend spaces.
///
/// In JSON `sets[] {examples, simplices, build_s, load_s, within_ns, around_ns}`: queries from within the examples'
/// box, and from three times around it, which mostly go to the hull's nearest point.
#[derive(clap::Args)]
#[command(after_help = "Example:\n  fbcrowd bench blend-space --json")]
pub(super) struct Args {
    /// Print JSON.
    #[arg(long)]
    json: bool,
}

#[derive(Serialize)]
struct Details {
    sets: Vec<Set>,
}

#[derive(Serialize)]
struct Set {
    examples: usize,
    simplices: usize,
    build_s: f64,
    load_s: f64,
    within_ns: f64,
    around_ns: f64,
}

pub(super) fn run(args: &Args) -> Result<Answer, Failure> {
    let sets: Vec<Set> = EXAMPLES.map(measured).into();
    let (least, most) = (&sets[0], &sets[EXAMPLES.len() - 1]);
    let bars = vec![
        Bar::at_most("time of a query, 500 examples over 19", GROWTH, most.within_ns / least.within_ns),
        Bar::at_most("the same from around the hull", GROWTH, most.around_ns / least.around_ns),
    ];
    let goals = vec![Goal { name: "simplices of 500 examples, s", measured: Some(most.build_s), goal: 1.0 }];
    let found = Found { details: Details { sets }, goals, bars };
    conclude(&found, &text(&found.details), args.json)
}

fn measured(examples: usize) -> Set {
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
    Set { examples, simplices: space.simplices().count(), build_s, load_s, within_ns, around_ns }
}

fn drawn(random: &mut SplitMix64, count: usize, around: f64) -> Vec<Parameters> {
    let axis = |half_range: f64, random: &mut SplitMix64| random.within(around * half_range) as f32;
    let point = |_| Vec3::from_array(HALF_RANGES.to_array().map(|half_range| axis(half_range, random)));
    (0..count).map(point).map(Parameters::from_vec3).collect()
}

fn timed<T>(work: impl FnOnce() -> T) -> (f64, T) {
    let start = Instant::now();
    let done = work();
    (start.elapsed().as_secs_f64(), done)
}

fn text(details: &Details) -> String {
    let line = |set: &Set| {
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

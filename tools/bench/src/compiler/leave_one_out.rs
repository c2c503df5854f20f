//! `fbcrowd bench leave-one-out`: how well the other examples of a set of clips stand in for each one.

use std::path::PathBuf;

use fbcrowd_jobs::Observer;
use fbcrowd_jobs::leave_one_out::{LeaveOneOut, leave_one_out};
use motiondb::motion::MotionDb;
use motiondb_compiler::compile;
use schemars::JsonSchema;
use serde::Serialize;

use crate::compiler::ground_truth::marine_files;
use crate::compiler::least_blend::{least_rmse_m, positions_m};
use crate::error::BenchError;
use crate::kit::args::MocapArg;
use crate::kit::database::bundled;
use crate::kit::report::{BenchReport, Criterion};
use crate::kit::statistics::{median, share};

/// Least share of the examples to which the blend is nearer than the nearest other example.
const BETTER_SHARE: f64 = 0.75;
/// Greatest median error over the Marine set, m. The source says "5 cm per joint", which is the root mean square over
/// all joints or the median joint; both have a criterion.
const MARINE_RMSE_M: f64 = 0.05;

/// Leave out one example after the other of the Marine, Bandai Namco and bundled sets.
///
/// The Marine clips lie in the folder's `smartbody_converted`, Bandai Namco's in `bandai_namco`.
#[derive(clap::Args)]
#[command(after_help = "Example:\n  fbcrowd bench leave-one-out --mocap my/mocap")]
pub struct Args {
    #[command(flatten)]
    mocap: MocapArg,
}

/// What was measured.
#[derive(JsonSchema, Serialize)]
pub struct Details {
    /// The sets of clips.
    pub sets: Vec<ClipSet>,
}

/// A set of clips.
#[derive(JsonSchema, Serialize)]
pub struct ClipSet {
    /// Name of the set.
    pub name: &'static str,
    /// The style of the examples, of a set that has several; empty of a set without.
    pub style: String,
    /// How near the others come to each example, as `fbcrowd inspect --leave-one-out` has it.
    pub leave_one_out: LeaveOneOut,
    /// Median over the same examples of the least RMSE over all joints that a weighted mean of the others' joint positions
    /// reaches with any weights that move the root as the example does, m; null without examples.
    pub median_least_rmse_m: Option<f32>,
}

/// Runs the bench.
///
/// # Errors
/// If the clips cannot be read, or give no database.
pub fn run(args: &Args, _: &Observer) -> Result<BenchReport<Details>, BenchError> {
    let folder = &args.mocap.mocap;
    // Each style of a set is blended by itself.
    let sets_of =
        |(name, db): (&'static str, MotionDb)| db.styles().map(|db| ClipSet::of(name, db)).collect::<Vec<ClipSet>>();
    let databases = [
        ("Marine", compiled(&marine_files(folder))?),
        ("Bandai Namco", compiled(&motiondb_compiler::clip_files(&folder.join("bandai_namco"))?)?),
        ("bundled", bundled()?),
    ];
    let sets: Vec<ClipSet> = databases.into_iter().flat_map(sets_of).collect();
    let all = sets.iter().flat_map(|set| &set.leave_one_out.examples);
    let better = share(all, |found| found.blend_is_better());
    let marine = &sets[0].leave_one_out;
    let [rmse_m, joint_rmse_m] =
        [marine.median_blended_rmse_m, marine.median_joint_blended_rmse_m].map(|median| median.map(f64::from));
    let criteria = vec![
        Criterion::at_least(
            "share of examples that the blend meets better than the nearest example",
            BETTER_SHARE,
            better,
        ),
        Criterion::at_most("median over the Marine set of the RMSE over all joints, m", MARINE_RMSE_M, rmse_m),
        Criterion::at_most("median over the Marine set of the RMSE of each joint, m", MARINE_RMSE_M, joint_rmse_m),
    ];
    let details = Details { sets };
    Ok(BenchReport { text: text(&details), details, goals: Vec::new(), criteria })
}

impl ClipSet {
    fn of(name: &'static str, db: &MotionDb) -> Self {
        let (leave_one_out, positions_m) = (leave_one_out(db), positions_m(db));
        let is_left_out = |name: &str| leave_one_out.examples.iter().any(|found| found.name == name);
        let examples = db.examples.iter().filter(|example| is_left_out(&example.name));
        let least_m = examples.filter_map(|example| least_rmse_m(db, example, &positions_m));
        let median_least_rmse_m = median(least_m.map(|least_m| least_m as f32));
        Self { name, style: db.style.clone(), leave_one_out, median_least_rmse_m }
    }
}

fn compiled(files: &[PathBuf]) -> Result<MotionDb, BenchError> {
    Ok(compile::compile_files(files, &|_| ())?.db)
}

fn text(details: &Details) -> String {
    let line = |set: &ClipSet| {
        let found = &set.leave_one_out;
        let better = found.examples.iter().filter(|found| found.blend_is_better()).count();
        let cm = |median: Option<f32>| median.map_or_else(|| "–".to_owned(), |median| format!("{:.1}", 100.0 * median));
        let medians =
            |blended: Option<f32>, nearest: Option<f32>| format!("{} cm, nearest {} cm", cm(blended), cm(nearest));
        format!(
            "{:<26}{better:3} of {:3} examples better by the blend; median {}, best mean of \
             positions {} cm; of each joint {}; {} on the hull's corners\n",
            format!("{} {}", set.name, set.style).trim_end(),
            found.examples.len(),
            medians(found.median_blended_rmse_m, found.median_nearest_rmse_m),
            cm(set.median_least_rmse_m),
            medians(found.median_joint_blended_rmse_m, found.median_joint_nearest_rmse_m),
            found.outside.len(),
        )
    };
    details.sets.iter().map(line).collect()
}

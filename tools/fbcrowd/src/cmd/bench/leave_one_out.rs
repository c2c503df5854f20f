//! `fbcrowd bench leave-one-out`: does blending carry over to motions that a database does not hold?

use std::path::{Path, PathBuf};

use motiondb::motion::MotionDb;
use motiondb_compiler::compile;
use motiondb_compiler::truth::marine_files;
use serde::Serialize;

use crate::cmd::bench::Mocap;
use crate::cmd::bench::bar::{Bar, Found, conclude};
use crate::cmd::bench::bundled::bundled;
use crate::failure::{Answer, Failure};
use crate::leave_one_out::{LeaveOneOut, leave_one_out};
use crate::statistics::share;

/// Leave out one example after the other of the Marine, Bandai Namco and bundled sets.
///
/// The Marine clips are sought in the folder's `smartbody_converted`, Bandai Namco's in `bandai_namco`.
///
/// In JSON `sets[] {name, leave_one_out}`, as `fbcrowd inspect --leave-one-out` has it.
#[derive(clap::Args)]
#[command(after_help = "Example:\n  fbcrowd bench leave-one-out --mocap my/mocap")]
pub(super) struct Args {
    #[command(flatten)]
    mocap: Mocap,
}

#[derive(Serialize)]
struct Details {
    sets: Vec<Set>,
}

#[derive(Serialize)]
struct Set {
    name: &'static str,
    leave_one_out: LeaveOneOut,
}

pub(super) fn run(args: &Args) -> Result<Answer, Failure> {
    let folder = &args.mocap.mocap;
    let set = |name, db: MotionDb| Set { name, leave_one_out: leave_one_out(&db) };
    let sets = vec![
        set("Marine", of_files(&marine_files(folder))?),
        set("Bandai Namco", of_files(&clip_files(&folder.join("bandai_namco"))?)?),
        set("bundled", bundled()?),
    ];
    let all = sets.iter().flat_map(|set| &set.leave_one_out.examples);
    let better = share(all, |found| found.blend_is_better());
    let marine = &sets[0].leave_one_out;
    let (marine_rmse_m, marine_joint_m) = (marine.median_blended_rmse_m, marine.median_joint_blended_rmse_m);
    let bars = vec![
        Bar::at_least("share of examples that the blend meets better than the nearest example", 0.75, better),
        // "5 cm per joint" can be read both ways: the root mean square over all joints, or the median joint.
        Bar::at_most("median over the Marine set of the RMSE over all joints, m", 0.05, marine_rmse_m.map(f64::from)),
        Bar::at_most("median over the Marine set of the RMSE of each joint, m", 0.05, marine_joint_m.map(f64::from)),
    ];
    let found = Found { details: Details { sets }, goals: Vec::new(), bars };
    conclude(&found, &text(&found.details), args.mocap.json)
}

fn clip_files(folder: &Path) -> Result<Vec<PathBuf>, Failure> {
    motiondb_compiler::clip_files(folder).map_err(|error| Failure::bad(error.to_string()))
}

fn of_files(files: &[PathBuf]) -> Result<MotionDb, Failure> {
    Ok(compile::compile_files(files, &|_| ())?.db)
}

fn text(details: &Details) -> String {
    let line = |set: &Set| {
        let found = &set.leave_one_out;
        let better = found.examples.iter().filter(|found| found.blend_is_better()).count();
        let cm = |median: Option<f32>| median.map_or_else(|| "–".to_owned(), |median| format!("{:.1}", 100.0 * median));
        let medians =
            |blended: Option<f32>, nearest: Option<f32>| format!("{} cm, nearest {} cm", cm(blended), cm(nearest));
        format!(
            "{:<14}{better:3} of {:3} examples better by the blend; median {}; of each joint {}; {} on the hull's corners\n",
            set.name,
            found.examples.len(),
            medians(found.median_blended_rmse_m, found.median_nearest_rmse_m),
            medians(found.median_joint_blended_rmse_m, found.median_joint_nearest_rmse_m),
            found.outside.len(),
        )
    };
    details.sets.iter().map(line).collect()
}

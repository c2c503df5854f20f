//! `fbcrowd bench quality`: whether bodies keep human poses, with every command and every time step.
//!
//! Bodies follow command sequences ([`crate::synthesis::command_sequences`]): steady walks, and changes of speed and
//! direction, by blending, by semi-procedural locomotion and by both. Each is measured
//! ([`crate::synthesis::quality_figures`]) with four time steps.

use fbcrowd_jobs::Observer;
use fbcrowd_jobs::json_schema::measures::ModesMirror;
use fbcrowd_sim::synthesis::Modes;
use motiondb::motion::MotionDb;
use rayon::prelude::*;
use schemars::JsonSchema;
use serde::Serialize;

use crate::error::BenchError;
use crate::kit::args::DatabaseArg;
use crate::kit::database::database;
use crate::kit::lone_body::context;
use crate::kit::report::{BenchReport, Criterion};
use crate::synthesis::command_sequences::{CommandSequence, command_sequences};
use crate::synthesis::quality_figures::{QualityFigures, example_peaks_mps2, figures};
use crate::synthesis::sequence_walk::walk;

/// Time steps, s: of motion capture, of games, of films, and of the planner.
const TIME_STEPS_S: [f32; 4] = [1.0 / 120.0, 1.0 / 60.0, 1.0 / 30.0, 0.1];
/// Kinds of synthesis.
const SYNTHESES: [Modes; 3] = [Modes::Blending, Modes::SemiProcedural, Modes::Hybrid];
/// Greatest slide of planted feet in a steady walk with the bundled clips, cm/s; with other clips the examples' own.
const STEADY_SLIDE_CM_S: f64 = 1.5;
/// Greatest slide of planted feet through a change, with any clips, cm/s.
const CHANGING_SLIDE_CM_S: f64 = 3.0;
/// Greatest share of the root's speed that is not in the rows.
const CORRECTION_SHARE: f64 = 0.05;

/// Measure planted feet, knees, accelerations and smoothness of bodies that follow command sequences.
#[derive(clap::Args)]
#[command(after_help = "Examples:\n  fbcrowd bench quality\n  fbcrowd bench quality --db motion.fbdb --json")]
pub struct Args {
    #[command(flatten)]
    database: DatabaseArg,
}

/// What was measured.
#[derive(JsonSchema, Serialize)]
pub struct Details {
    /// Walks: every command sequence with every synthesis at every time step.
    pub walks: Vec<WalkQuality>,
}

/// One command sequence with one synthesis at one time step.
#[derive(JsonSchema, Serialize)]
pub struct WalkQuality {
    /// Name of the command sequence.
    #[serde(rename = "errand")]
    pub sequence: &'static str,
    /// Whether the commands are constant while the walk is measured.
    pub steady: bool,
    /// Kind of synthesis.
    #[schemars(with = "ModesMirror")]
    pub synthesis: Modes,
    /// Time step, s.
    pub dt_s: f32,
    /// Measures of the walk.
    #[serde(flatten)]
    pub figures: QualityFigures,
}

/// Runs the bench.
///
/// # Errors
/// If the database cannot be read.
pub fn run(args: &Args, _: &Observer) -> Result<BenchReport<Details>, BenchError> {
    let db = database(&args.database)?;
    let walks: Vec<WalkQuality> = SYNTHESES.iter().flat_map(|&synthesis| walks(&db, synthesis)).collect();
    let criteria = criteria(&walks, args.database.database.is_none());
    let details = Details { walks };
    Ok(BenchReport { text: text(&details), details, goals: Vec::new(), criteria })
}

/// Every command sequence with one synthesis at every time step.
fn walks(db: &MotionDb, synthesis: Modes) -> Vec<WalkQuality> {
    let context = context(db.clone(), synthesis);
    let sequences = command_sequences(&context.db);
    let walks: Vec<(&CommandSequence, f32)> =
        sequences.iter().flat_map(|sequence| TIME_STEPS_S.map(|dt_s| (sequence, dt_s))).collect();
    walks
        .into_par_iter()
        .map(|(sequence, dt_s)| {
            let peaks_mps2 = example_peaks_mps2(&context.db, &context.domain, dt_s);
            let figures = figures(&walk(&context, sequence, dt_s), sequence, &db.skeleton, &peaks_mps2);
            WalkQuality { sequence: sequence.name, steady: sequence.steady, synthesis, dt_s, figures }
        })
        .collect()
}

fn criteria(walks: &[WalkQuality], is_bundled: bool) -> Vec<Criterion> {
    let greatest = |of: &dyn Fn(&WalkQuality) -> Option<f64>| walks.iter().filter_map(of).reduce(f64::max);
    let least = |of: &dyn Fn(&WalkQuality) -> Option<f64>| walks.iter().filter_map(of).reduce(f64::min);
    let steady_cm_s = |walk: &WalkQuality| walk.steady.then_some(walk.figures.slide_cm_s);
    let over_examples = |walk: &WalkQuality| steady_cm_s(walk).map(|slide| slide / walk.figures.examples_slide_cm_s);
    let changing_cm_s = |walk: &WalkQuality| (!walk.steady).then_some(walk.figures.slide_cm_s);
    let steady = if is_bundled {
        Criterion::at_most("planted-foot slide, steady, cm/s", STEADY_SLIDE_CM_S, greatest(&steady_cm_s))
    } else {
        Criterion::at_most("planted-foot slide, steady, over the examples'", 1.0, greatest(&over_examples))
    };
    let lost_share = |walk: &WalkQuality| Some(walk.figures.examples_planted_share - walk.figures.planted_share);
    vec![
        steady,
        Criterion::at_most("planted-foot slide through a change, cm/s", CHANGING_SLIDE_CM_S, greatest(&changing_cm_s)),
        Criterion::at_most("planted share lost against the examples", 0.1, greatest(&lost_share)),
        Criterion::at_least("planted soles on the ground", 0.9, least(&|walk| Some(walk.figures.grounded_share))),
        Criterion::at_most("penetration, mm", 5.0, greatest(&|walk| Some(walk.figures.penetration_mm))),
        Criterion::at_least("least flexion of a knee, degrees", 0.0, least(&|walk| Some(walk.figures.knee_min_deg))),
        Criterion::at_most(
            "joint acceleration at a switch over the clips'",
            1.5,
            greatest(&|walk| walk.figures.switch_acceleration_ratio),
        ),
        Criterion::at_most(
            "root beyond the rows, mean size over the speed",
            CORRECTION_SHARE,
            greatest(&|walk| Some(walk.figures.correction_share)),
        ),
    ]
}

/// A line for each command sequence and synthesis: slide at each time step, all other measures at their worst.
fn text(details: &Details) -> String {
    let mut text = format!("{:<32}", "slide in cm/s at dt");
    for dt_s in TIME_STEPS_S {
        text += &format!("{:>7}", format!("1/{:.0}", 1.0 / dt_s));
    }
    text += "   of  share   of ground sunk mm clear mm knee min °  rad/s foot m/s ankles m  accel switch beyond m/s  share  signed  sparc\n";
    details.walks.chunks(TIME_STEPS_S.len()).for_each(|walks| text += &line(walks));
    text
}

fn line(walks: &[WalkQuality]) -> String {
    let greatest =
        |of: fn(&QualityFigures) -> f64| walks.iter().map(|walk| of(&walk.figures)).fold(f64::NEG_INFINITY, f64::max);
    let least =
        |of: fn(&QualityFigures) -> f64| walks.iter().map(|walk| of(&walk.figures)).fold(f64::INFINITY, f64::min);
    let mut line = format!("{:<17}{:<15}", walks[0].sequence, word(walks[0].synthesis));
    for walk in walks {
        line += &format!("{:>7.2}", walk.figures.slide_cm_s);
    }
    let switch = walks.iter().filter_map(|walk| walk.figures.switch_acceleration_ratio).reduce(f64::max);
    let signed = walks.iter().map(|walk| walk.figures.signed_correction_share);
    let signed = signed.fold(0.0, |worst, share| if share.abs() > f64::abs(worst) { share } else { worst });
    line += &format!(
        "{:>5.1} {:>6.2} {:>4.2} {:>6.2} {:>7.1} {:>8.1} {:>10.1} {:>6.1} {:>8.1} {:>8.2} {:>6.2} {:>6} {:>10.3} {:>6.3} {:>7.3} {:>6.2}\n",
        greatest(|figures| figures.examples_slide_cm_s),
        least(|figures| figures.planted_share),
        greatest(|figures| figures.examples_planted_share),
        least(|figures| figures.grounded_share),
        greatest(|figures| figures.penetration_mm),
        least(|figures| figures.clearance_mm),
        least(|figures| figures.knee_min_deg),
        greatest(|figures| figures.knee_speed_max_rad_s),
        greatest(|figures| figures.foot_speed_max_mps),
        least(|figures| figures.ankles_apart_m),
        greatest(|figures| figures.acceleration_ratio),
        switch.map_or_else(|| "–".to_owned(), |ratio| format!("{ratio:.2}")),
        greatest(|figures| figures.correction_mps),
        greatest(|figures| figures.correction_share),
        signed,
        least(|figures| figures.sparc),
    );
    line
}

fn word(synthesis: Modes) -> &'static str {
    match synthesis {
        Modes::Blending => "blending",
        Modes::SemiProcedural => "semi-procedural",
        Modes::Hybrid => "hybrid",
    }
}

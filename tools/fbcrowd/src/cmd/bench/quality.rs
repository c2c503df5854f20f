//! `fbcrowd bench quality`: do bodies stay human, whatever they are asked and however long a step is?
//!
//! Bodies go on errands ([`crate::cmd::bench::quality_errands`]): steady walks, and changes of speed and direction, by blending, by
//! semi-procedural locomotion and by both. Each is measured ([`crate::cmd::bench::quality_measures`]) at four lengths of a step.

use std::path::PathBuf;

use fbcrowd_sim::synthesis::Modes;
use motiondb::motion::MotionDb;
use rayon::prelude::*;
use serde::Serialize;

use crate::cmd::bench::bar::{Bar, Found, conclude};
use crate::cmd::bench::bundled::database;
use crate::cmd::bench::quality_errands::{Errand, errands};
use crate::cmd::bench::quality_measures::{Figures, example_peaks_mps2, figures};
use crate::cmd::bench::quality_walk::walk;
use crate::cmd::bench::walker::studio;
use crate::failure::{Answer, Failure};

/// The lengths of a step, s: motion capture's, film's and games', and the planner's.
const DTS_S: [f32; 4] = [1.0 / 120.0, 1.0 / 60.0, 1.0 / 30.0, 0.1];
const SYNTHESES: [Modes; 3] = [Modes::Blending, Modes::SemiProcedural, Modes::Hybrid];
/// Planted feet of the bundled clips slide no more than this in a steady walk, cm/s; those of other clips no more than
/// in the examples.
const STEADY_SLIDE_CM_S: f64 = 1.5;
/// Whatever the clips, they slide no more than this through a change, cm/s.
const CHANGING_SLIDE_CM_S: f64 = 3.0;

/// The root moves this share of its speed beyond the rows, at most.
const CORRECTION_SHARE: f64 = 0.05;

/// Measure planted feet, knees, accelerations and smoothness of bodies on errands.
///
/// In JSON `walks[] {errand, steady, synthesis, dt_s, figures…}`.
#[derive(clap::Args)]
#[command(after_help = "Examples:\n  fbcrowd bench quality\n  fbcrowd bench quality --db motion.fbdb --json")]
pub(super) struct Args {
    /// The database; that of the bundled clips by default.
    #[arg(long = "db", value_name = "FILE.fbdb")]
    database: Option<PathBuf>,
    /// Print JSON.
    #[arg(long)]
    json: bool,
}

#[derive(Serialize)]
struct Details {
    walks: Vec<WalkFigures>,
}

/// One errand by one synthesis at one dt.
#[derive(Serialize)]
struct WalkFigures {
    errand: &'static str,
    steady: bool,
    synthesis: Modes,
    dt_s: f32,
    #[serde(flatten)]
    figures: Figures,
}

pub(super) fn run(args: &Args) -> Result<Answer, Failure> {
    let db = database(args.database.as_deref())?;
    let walks: Vec<WalkFigures> = SYNTHESES.iter().flat_map(|&synthesis| walks(&db, synthesis)).collect();
    let bars = bars(&walks, args.database.is_none());
    let details = Details { walks };
    let text = text(&details);
    conclude(&Found { details, goals: Vec::new(), bars }, &text, args.json)
}

fn walks(db: &MotionDb, synthesis: Modes) -> Vec<WalkFigures> {
    let studio = studio(db.clone(), synthesis);
    let errands = errands(&studio.db);
    let tried: Vec<(&Errand, f32)> = errands.iter().flat_map(|errand| DTS_S.map(|dt_s| (errand, dt_s))).collect();
    tried
        .into_par_iter()
        .map(|(errand, dt_s)| {
            let peaks_mps2 = example_peaks_mps2(&studio.db, &studio.domain, dt_s);
            let figures = figures(&walk(&studio, errand, dt_s), errand, &db.skeleton, &peaks_mps2);
            WalkFigures { errand: errand.name, steady: errand.steady, synthesis, dt_s, figures }
        })
        .collect()
}

fn bars(walks: &[WalkFigures], of_bundled: bool) -> Vec<Bar> {
    let greatest = |of: &dyn Fn(&WalkFigures) -> Option<f64>| walks.iter().filter_map(of).reduce(f64::max);
    let least = |of: &dyn Fn(&WalkFigures) -> Option<f64>| walks.iter().filter_map(of).reduce(f64::min);
    let steady_cm_s = |walk: &WalkFigures| walk.steady.then_some(walk.figures.slide_cm_s);
    let over_examples = |walk: &WalkFigures| steady_cm_s(walk).map(|slide| slide / walk.figures.examples_slide_cm_s);
    let changing_cm_s = |walk: &WalkFigures| (!walk.steady).then_some(walk.figures.slide_cm_s);
    let steady = if of_bundled {
        Bar::at_most("planted-foot slide, steady, cm/s", STEADY_SLIDE_CM_S, greatest(&steady_cm_s))
    } else {
        Bar::at_most("planted-foot slide, steady, over the examples'", 1.0, greatest(&over_examples))
    };
    let lost_share = |walk: &WalkFigures| Some(walk.figures.examples_planted_share - walk.figures.planted_share);
    vec![
        steady,
        Bar::at_most("planted-foot slide through a change, cm/s", CHANGING_SLIDE_CM_S, greatest(&changing_cm_s)),
        Bar::at_most("planted share lost against the examples", 0.1, greatest(&lost_share)),
        Bar::at_least("planted soles on the ground", 0.9, least(&|walk| Some(walk.figures.grounded_share))),
        Bar::at_most("penetration, mm", 5.0, greatest(&|walk| Some(walk.figures.penetration_mm))),
        Bar::at_least("least flexion of a knee, degrees", 0.0, least(&|walk| Some(walk.figures.knee_min_deg))),
        Bar::at_most(
            "joint acceleration at a switch over the clips'",
            1.5,
            greatest(&|walk| walk.figures.switch_acceleration_ratio),
        ),
        Bar::at_most(
            "root beyond the rows, mean size over the speed",
            CORRECTION_SHARE,
            greatest(&|walk| Some(walk.figures.correction_share)),
        ),
    ]
}

/// A line an errand and synthesis: slide at each dt, everything else at its worst.
fn text(details: &Details) -> String {
    let mut text = format!("{:<32}", "slide in cm/s at dt");
    for dt_s in DTS_S {
        text += &format!("{:>7}", format!("1/{:.0}", 1.0 / dt_s));
    }
    text += "   of  share   of ground sunk mm clear mm knee min °  rad/s foot m/s ankles m  accel switch beyond m/s  share  signed  sparc\n";
    details.walks.chunks(DTS_S.len()).for_each(|walks| text += &line(walks));
    text
}

fn line(walks: &[WalkFigures]) -> String {
    let greatest =
        |of: fn(&Figures) -> f64| walks.iter().map(|walk| of(&walk.figures)).fold(f64::NEG_INFINITY, f64::max);
    let least = |of: fn(&Figures) -> f64| walks.iter().map(|walk| of(&walk.figures)).fold(f64::INFINITY, f64::min);
    let mut line = format!("{:<17}{:<15}", walks[0].errand, word(walks[0].synthesis));
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

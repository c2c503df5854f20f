//! `fbcrowd bench clips`: compares the bundled clips with the speeds in their names, with published gait values, and
//! with real clips.
//!
//! All measures are computed from the compiled clips, as those of any clips: [`motiondb::quality`], the examples'
//! parameters and key times, and with `--mocap` the similarity to real clips ([`crate::compiler::similarity`]).

use std::path::PathBuf;

use clipgen::reference::{Claim, claims};
use fbcrowd_jobs::Observer;
use fbcrowd_jobs::json_schema::motion::ExampleQualityMirror;
use motiondb::motion::{MotionDb, Parameters};
use motiondb::quality::example_quality::{ExampleQuality, quality};
use schemars::JsonSchema;
use serde::Serialize;

use crate::compiler::gait_figures::{GaitFigures, off_published_walk_deg};
use crate::compiler::similarity::{GaitSimilarity, similarity};
use crate::error::BenchError;
use crate::kit::database::bundled;
use crate::kit::report::{BenchReport, Criterion};

/// Tolerance of a claimed parameter, as a share of it.
const CLAIM_SHARE: f64 = 0.01;
/// Least tolerance of each claimed parameter: m/s, rad/s, m/s.
const CLAIM_TOLERANCES: [f64; 3] = [0.01, 0.5 * std::f64::consts::PI / 180.0, 0.01];
/// Slowest walk with published adults, m/s.
const ADULT_MPS: f64 = 0.85;

/// Compare the bundled clips with the speeds in their names, with published gait values and, with --mocap, with real
/// clips.
#[derive(clap::Args)]
#[command(after_help = "Examples:\n  fbcrowd bench clips\n  fbcrowd bench clips --mocap my/mocap")]
pub struct Args {
    /// Folder of real clips, one folder below it for each source.
    #[arg(long, value_name = "DIR")]
    mocap: Option<PathBuf>,
}

/// What was measured.
#[derive(JsonSchema, Serialize)]
pub struct Details {
    /// The bundled clips.
    pub clips: Vec<BundledClip>,
    /// Similarity to real clips by class of gait; empty without `--mocap`.
    #[serde(rename = "kinds")]
    pub gait_classes: Vec<GaitSimilarity>,
}

/// One bundled clip.
#[derive(JsonSchema, Serialize)]
pub struct BundledClip {
    /// Name of the clip.
    pub name: &'static str,
    #[serde(skip)]
    claim: Claim,
    /// Greatest difference of a parameter from what the name claims, divided by its tolerance.
    pub off_claim: f64,
    /// Quality of the motion.
    #[schemars(with = "ExampleQualityMirror")]
    pub quality: ExampleQuality,
    /// Measures of gait science; null where the clip stands.
    pub gait: Option<GaitFigures>,
    /// Root mean square distance of hip, knee and ankle angles from the published walk, degrees; null except for
    /// straight walks.
    pub off_published_deg: Option<[f64; 3]>,
}

/// Runs the bench.
///
/// # Errors
/// If the real clips cannot be read, or give no database.
pub fn run(args: &Args, _: &Observer) -> Result<BenchReport<Details>, BenchError> {
    let db = bundled()?;
    let gait_classes = args.mocap.as_ref().map_or(Ok(Vec::new()), |folder| similarity(folder, &db))?;
    let details = Details { clips: clips(&db), gait_classes };
    let of_classes = details.gait_classes.iter().filter_map(similarity_criterion);
    let criteria = details.clip_criteria().into_iter().chain(of_classes).collect();
    Ok(BenchReport { text: text(&details), details, goals: Vec::new(), criteria })
}

/// Every claim that an example stands for.
fn clips(db: &MotionDb) -> Vec<BundledClip> {
    let figures = quality(db);
    let clip = |claim: Claim| {
        let index = db.examples.iter().position(|example| example.name == claim.name)?;
        let example = &db.examples[index];
        let straight_walk = claim.name.starts_with("walk_");
        Some(BundledClip {
            name: claim.name,
            off_claim: off_claim(&claim, &example.parameters),
            quality: figures[index].clone(),
            gait: GaitFigures::of(example),
            off_published_deg: if straight_walk { off_published_walk_deg(db, index) } else { None },
            claim,
        })
    };
    claims().into_iter().filter_map(clip).collect()
}

/// Greatest difference of a parameter from its claim, divided by its tolerance.
fn off_claim(claim: &Claim, found: &Parameters) -> f64 {
    let claimed = [claim.speed_mps, claim.turn_rate_rad_s, claim.strafe_mps];
    let differences = found.to_vec3().to_array().map(f64::from).into_iter().zip(claimed).zip(CLAIM_TOLERANCES);
    differences
        .map(|((found, claimed), least)| (found - claimed).abs() / (CLAIM_SHARE * claimed.abs()).max(least))
        .fold(0.0, f64::max)
}

impl Details {
    /// Greatest value of all clips; none without values.
    fn greatest(&self, value: impl Fn(&BundledClip) -> Option<f64>) -> Option<f64> {
        self.clips.iter().filter_map(value).max_by(f64::total_cmp)
    }

    /// Least value of all clips; none without values.
    fn least(&self, value: impl Fn(&BundledClip) -> Option<f64>) -> Option<f64> {
        self.clips.iter().filter_map(value).min_by(f64::total_cmp)
    }

    fn clip_criteria(&self) -> Vec<Criterion> {
        [&self.claim_criteria()[..], &self.ground_criteria(), &self.body_criteria(), &self.gait_criteria()].concat()
    }

    fn claim_criteria(&self) -> [Criterion; 2] {
        let share = self.clips.len() as f64 / claims().len() as f64;
        let off = self.greatest(|clip| Some(clip.off_claim));
        [
            Criterion::at_least("bundled clips that give an example, share", 1.0, share),
            Criterion::at_most("parameters off what the name claims, over the tolerance", 1.0, off),
        ]
    }

    fn ground_criteria(&self) -> [Criterion; 3] {
        let slide = |runs: bool| {
            self.greatest(|clip| (clip.claim.runs == runs).then_some(f64::from(clip.quality.planted_slide_cm_s)))
        };
        let sunk_mm = self.greatest(|clip| Some(clip.quality.penetration_mm.into()));
        [
            Criterion::at_most(
                "planted-foot slide of walks, turns, side-steps and backward walks, cm/s",
                1.0,
                slide(false),
            ),
            Criterion::at_most("planted-foot slide of jogs and runs, cm/s", 3.0, slide(true)),
            Criterion::at_most("ground penetration, mm", 5.0, sunk_mm),
        ]
    }

    fn body_criteria(&self) -> [Criterion; 3] {
        let seam = self.greatest(|clip| Some(clip.quality.seam_angle_ratio.into()));
        let knee_deg = self.least(|clip| Some(clip.quality.knee_flexion_min_deg.into()));
        let excess_deg = self.greatest(|clip| Some(clip.quality.range_excess_deg.into()));
        [
            Criterion::at_most("loop seam over the cycle's median step", 1.2, seam),
            Criterion::at_least("flexion of a knee, degrees", 1.0, knee_deg),
            Criterion::at_most("joints past human range, degrees", 0.0, excess_deg),
        ]
    }

    fn gait_criteria(&self) -> [Criterion; 5] {
        let duty =
            |clip: &BundledClip| clip.gait.as_ref().filter(|_| clip.claim.runs).map(|gait| mean(gait.stance_shares));
        let off_deg = self.greatest(|clip| clip.off_published_deg.map(|off| off.into_iter().fold(0.0, f64::max)));
        let toe_off_miss = self.greatest(BundledClip::toe_off_miss);
        [
            Criterion::at_most(
                "straight walks from 0.85 m/s that no published adults walk",
                0.0,
                self.walks_of_no_adults(),
            ),
            Criterion::at_most("toe-off off 50 % + half the double support, share", 0.03, toe_off_miss),
            Criterion::at_least("duty factor of a run", 0.30, self.least(duty)),
            Criterion::at_most("duty factor of a run, at most", 0.45, self.greatest(duty)),
            Criterion::at_most("straight walks off the published hip, knee or ankle, RMS, degrees", 5.0, off_deg),
        ]
    }

    fn walks_of_no_adults(&self) -> f64 {
        let walks =
            self.clips.iter().filter(|clip| clip.off_published_deg.is_some() && clip.claim.speed_mps >= ADULT_MPS);
        walks.filter(|clip| clip.adults().is_none()).count() as f64
    }
}

impl BundledClip {
    fn adults(&self) -> Option<&'static str> {
        self.gait.as_ref()?.adults(self.claim.speed_mps)
    }

    /// Distance of the toe-off from 50 % + half the double support, share of the cycle; of straight walks only. It is
    /// half of the difference between both feet's stances.
    fn toe_off_miss(&self) -> Option<f64> {
        let gait = self.gait.as_ref().filter(|_| self.off_published_deg.is_some())?;
        let wanted = 0.5 + 0.5 * gait.double_support_share;
        gait.stance_shares.map(|share| (share - wanted).abs()).into_iter().max_by(f64::total_cmp)
    }
}

/// The criterion of a class of gait; none with too few sources.
fn similarity_criterion(class: &GaitSimilarity) -> Option<Criterion> {
    let median_deg = class.median_deg.filter(|_| class.has_criterion())?;
    let farthest = class.bundled.iter().map(|found| f64::from(found.distance_deg)).max_by(f64::total_cmp);
    let name =
        format!("{}: bundled to the nearest real, at most the median from real to real, degrees", class.gait_class);
    Some(Criterion::at_most(name, f64::from(median_deg), farthest))
}

/// Mean of both feet.
fn mean([left, right]: [f64; 2]) -> f64 {
    0.5 * (left + right)
}

fn text(details: &Details) -> String {
    let mut text = format!(
        "{:<24}{:>9}{:>9}{:>9}{:>8}{:>7}{:>8}{:>8}{:>8}{:>8}  adults; hip, knee, ankle off the published, degrees\n",
        "clip", "off claim", "slide", "sink mm", "seam", "knee°", "steps/m", "stride m", "stance", "double"
    );
    for clip in &details.clips {
        text += &clip_line(clip);
    }
    for class in &details.gait_classes {
        text += &class_text(class);
    }
    text + "\n"
}

fn clip_line(clip: &BundledClip) -> String {
    let quality = &clip.quality;
    let mut line = format!(
        "{:<24}{:9.2}{:9.2}{:9.1}{:8.2}{:7.1}",
        clip.name,
        clip.off_claim,
        quality.planted_slide_cm_s,
        quality.penetration_mm,
        quality.seam_angle_ratio,
        quality.knee_flexion_min_deg
    );
    if let Some(gait) = &clip.gait {
        line += &format!(
            "{:8.1}{:8.3}{:6.1} %{:6.1} %",
            gait.cadence_steps_per_min,
            gait.stride_m,
            100.0 * mean(gait.stance_shares),
            100.0 * gait.double_support_share
        );
    }
    if let Some([hip, knee, ankle]) = clip.off_published_deg {
        line += &format!("  {}; {hip:.1}, {knee:.1}, {ankle:.1}", clip.adults().unwrap_or("–"));
    }
    line + "\n"
}

fn class_text(class: &GaitSimilarity) -> String {
    let median = class.median_deg.map_or_else(|| "–".to_owned(), |median| format!("{median:.1}°"));
    let judged = if class.has_criterion() { "" } else { "; too few sources for a criterion" };
    let mut text = format!(
        "\n{}: {} real clips of {} sources, to the nearest of another source {median} in the median{judged}\n",
        class.gait_class,
        class.real.len(),
        class.sources
    );
    for found in class.real.iter().chain(&class.bundled) {
        let own = if found.source.is_empty() { "bundled" } else { &found.source };
        let nearest = format!("{} {}", found.nearest_source, found.nearest);
        text += &format!("  {:5.1}°  {:<22}{:<44}{nearest}\n", found.distance_deg, own, found.clip);
    }
    text
}

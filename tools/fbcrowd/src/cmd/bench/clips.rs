//! `fbcrowd bench clips`: are the bundled clips what they claim to be, and what people do?
//!
//! Everything is measured on the compiled clips, as the compiler measures anybody's: [`motiondb::quality::example_quality`], the
//! examples' own parameters and key times, and with `--mocap` their likeness to real clips ([`crate::likeness`]).

use std::path::PathBuf;

use clipgen::reference::{Claim, claims};
use motiondb::motion::{MotionDb, Parameters};
use motiondb::quality::example_quality::{ExampleQuality, quality};
use serde::Serialize;

use crate::cmd::bench::bar::{Bar, Found, conclude};
use crate::cmd::bench::bundled::bundled;
use crate::failure::{Answer, Failure};
use crate::gait_figures::{GaitFigures, off_published_walk_deg};
use crate::likeness::{KindOfGait, likeness};

/// A clip may miss what its name claims by this share, and by this much: m/s, rad/s, m/s.
const CLAIM_SHARE: f64 = 0.01;
const CLAIM_LEAST: [f64; 3] = [0.01, 0.5 * std::f64::consts::PI / 180.0, 0.01];
/// Slower walks are compared with no adults: nobody published any.
const ADULT_MPS: f64 = 0.85;

/// Hold the bundled clips against what their names claim, what is published of people and, with --mocap, real clips.
///
/// In JSON `clips[] {name, off_claim, quality, gait, off_published_deg[3]}` (`off_claim`: the greatest miss of a
/// parameter over what is allowed; hip, knee, ankle) and `kinds[] {kind, sources, median_deg, real[], bundled[]}`, both
/// lists `{clip, source, distance_deg, nearest, nearest_source}`.
#[derive(clap::Args)]
#[command(after_help = "Examples:\n  fbcrowd bench clips\n  fbcrowd bench clips --mocap my/mocap")]
pub(super) struct Args {
    /// Real clips, a folder a source.
    #[arg(long, value_name = "DIR")]
    mocap: Option<PathBuf>,
    /// Print JSON.
    #[arg(long)]
    json: bool,
}

#[derive(Serialize)]
struct Details {
    clips: Vec<Clip>,
    kinds: Vec<KindOfGait>,
}

#[derive(Serialize)]
struct Clip {
    name: &'static str,
    #[serde(skip)]
    claim: Claim,
    off_claim: f64,
    quality: ExampleQuality,
    gait: Option<GaitFigures>,
    /// Of straight walks: hip, knee, ankle.
    off_published_deg: Option<[f64; 3]>,
}

pub(super) fn run(args: &Args) -> Result<Answer, Failure> {
    let db = bundled()?;
    let kinds = args.mocap.as_ref().map_or(Ok(Vec::new()), |folder| likeness(folder, &db))?;
    let details = Details { clips: clips(&db), kinds };
    let bars = details.clip_bars().into_iter().chain(details.kinds.iter().filter_map(kind_bar)).collect();
    let found = Found { details, goals: Vec::new(), bars };
    conclude(&found, &text(&found.details), args.json)
}

fn clips(db: &MotionDb) -> Vec<Clip> {
    let figures = quality(db);
    let clip = |claim: Claim| {
        let index = db.examples.iter().position(|example| example.name == claim.name)?;
        let example = &db.examples[index];
        let straight_walk = claim.name.starts_with("walk_");
        Some(Clip {
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

/// The greatest miss of a parameter over what is allowed.
fn off_claim(claim: &Claim, found: &Parameters) -> f64 {
    let claimed = [claim.speed_mps, claim.turn_rate_rad_s, claim.strafe_mps];
    let misses = found.to_vec3().to_array().map(f64::from).into_iter().zip(claimed).zip(CLAIM_LEAST);
    misses
        .map(|((found, claimed), least)| (found - claimed).abs() / (CLAIM_SHARE * claimed.abs()).max(least))
        .fold(0.0, f64::max)
}

impl Details {
    fn greatest(&self, value: impl Fn(&Clip) -> Option<f64>) -> Option<f64> {
        self.clips.iter().filter_map(value).max_by(f64::total_cmp)
    }

    fn least(&self, value: impl Fn(&Clip) -> Option<f64>) -> Option<f64> {
        self.clips.iter().filter_map(value).min_by(f64::total_cmp)
    }

    fn clip_bars(&self) -> Vec<Bar> {
        [&self.claim_bars()[..], &self.ground_bars(), &self.body_bars(), &self.gait_bars()].concat()
    }

    fn claim_bars(&self) -> [Bar; 2] {
        let share = self.clips.len() as f64 / claims().len() as f64;
        let off = self.greatest(|clip| Some(clip.off_claim));
        [
            Bar::at_least("bundled clips that give an example, share", 1.0, share),
            Bar::at_most("parameters off what the name claims, over what is allowed", 1.0, off),
        ]
    }

    fn ground_bars(&self) -> [Bar; 3] {
        let slide = |runs: bool| {
            self.greatest(|clip| (clip.claim.runs == runs).then_some(f64::from(clip.quality.planted_slide_cm_s)))
        };
        let sunk_mm = self.greatest(|clip| Some(clip.quality.penetration_mm.into()));
        [
            Bar::at_most("planted-foot slide of walks, turns, side-steps and backward walks, cm/s", 1.0, slide(false)),
            Bar::at_most("planted-foot slide of jogs and runs, cm/s", 3.0, slide(true)),
            Bar::at_most("ground penetration, mm", 5.0, sunk_mm),
        ]
    }

    fn body_bars(&self) -> [Bar; 3] {
        let seam = self.greatest(|clip| Some(clip.quality.seam_angle_ratio.into()));
        let knee_deg = self.least(|clip| Some(clip.quality.knee_flexion_min_deg.into()));
        let excess_deg = self.greatest(|clip| Some(clip.quality.range_excess_deg.into()));
        [
            Bar::at_most("loop seam over the cycle's median step", 1.2, seam),
            Bar::at_least("flexion of a knee, degrees", 1.0, knee_deg),
            Bar::at_most("joints past human range, degrees", 0.0, excess_deg),
        ]
    }

    fn gait_bars(&self) -> [Bar; 5] {
        let duty = |clip: &Clip| clip.gait.as_ref().filter(|_| clip.claim.runs).map(|gait| mean(gait.stance_shares));
        let off_deg = self.greatest(|clip| clip.off_published_deg.map(|off| off.into_iter().fold(0.0, f64::max)));
        let toe_off_miss = self.greatest(Clip::toe_off_miss);
        [
            Bar::at_most("straight walks from 0.85 m/s that no published adults walk", 0.0, self.walks_of_nobody()),
            Bar::at_most("toe-off off 50 % + half the double support, share", 0.03, toe_off_miss),
            Bar::at_least("duty factor of a run", 0.30, self.least(duty)),
            Bar::at_most("duty factor of a run, at most", 0.45, self.greatest(duty)),
            Bar::at_most("straight walks off the published hip, knee or ankle, RMS, degrees", 5.0, off_deg),
        ]
    }

    fn walks_of_nobody(&self) -> f64 {
        let walks =
            self.clips.iter().filter(|clip| clip.off_published_deg.is_some() && clip.claim.speed_mps >= ADULT_MPS);
        walks.filter(|clip| clip.adults().is_none()).count() as f64
    }
}

impl Clip {
    fn adults(&self) -> Option<&'static str> {
        self.gait.as_ref()?.adults(self.claim.speed_mps)
    }

    /// With both feet's stances from one pair of key times this is half of what the feet differ by; how long both stand
    /// is judged by the adults' bands.
    fn toe_off_miss(&self) -> Option<f64> {
        let gait = self.gait.as_ref().filter(|_| self.off_published_deg.is_some())?;
        let wanted = 0.5 + 0.5 * gait.double_support_share;
        gait.stance_shares.map(|share| (share - wanted).abs()).into_iter().max_by(f64::total_cmp)
    }
}

/// Asked only of kinds with enough sources.
fn kind_bar(kind: &KindOfGait) -> Option<Bar> {
    let median_deg = kind.median_deg.filter(|_| kind.is_judged())?;
    let farthest = kind.bundled.iter().map(|found| f64::from(found.distance_deg)).max_by(f64::total_cmp);
    let name = format!("{}: bundled to the nearest real, at most the median from real to real, degrees", kind.kind);
    Some(Bar::at_most(name, f64::from(median_deg), farthest))
}

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
    for kind in &details.kinds {
        text += &kind_text(kind);
    }
    text + "\n"
}

fn clip_line(clip: &Clip) -> String {
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

fn kind_text(kind: &KindOfGait) -> String {
    let median = kind.median_deg.map_or_else(|| "–".to_owned(), |median| format!("{median:.1}°"));
    let judged = if kind.is_judged() { "" } else { "; too few sources for a bar" };
    let mut text = format!(
        "\n{}: {} real clips of {} sources, to the nearest of another source {median} in the median{judged}\n",
        kind.kind,
        kind.real.len(),
        kind.sources
    );
    for found in kind.real.iter().chain(&kind.bundled) {
        let own = if found.source.is_empty() { "bundled" } else { &found.source };
        let nearest = format!("{} {}", found.nearest_source, found.nearest);
        text += &format!("  {:5.1}°  {:<22}{:<44}{nearest}\n", found.distance_deg, own, found.clip);
    }
    text
}

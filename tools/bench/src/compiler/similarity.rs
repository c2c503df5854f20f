//! Similarity of the bundled clips to real ones, compared with the similarity of real clips to each other.
//!
//! For each class of gait, two sets of distances ([`PoseSequence`]) are measured: each real clip to the nearest real
//! clip of *another* source folder, and each bundled clip to the nearest real clip. No bundled distance may exceed the
//! median of the real ones. A capture with several windows of one class counts once, with its longest window. Left and
//! right motions are one class, so a mirrored example is compared too. Classes have the speeds of a body with legs of
//! 0.8 m, so that the body that a set shares moves no clip into another class.

use std::path::{Path, PathBuf};

use motiondb::motion::{MotionDb, MotionExample, Parameters};
use motiondb_compiler::retarget::HumanClip;
use motiondb_compiler::{Options, compile};
use schemars::JsonSchema;
use serde::Serialize;

use crate::error::BenchError;
use crate::kit::pose_sequence::PoseSequence;
use crate::kit::statistics::median;

/// Least number of source folders with which the criterion applies.
const SOURCES_MIN: usize = 3;

/// Thigh plus shank of the body whose speeds define the classes, m.
const LEG_M: f32 = 0.8;

/// A class of gait, by its parameters on a body with legs of [`LEG_M`].
struct GaitClass {
    name: &'static str,
    contains: fn(&Parameters) -> bool,
}

/// Walks have the speeds that people choose; turns are walked.
const GAIT_CLASSES: [GaitClass; 6] = [
    GaitClass { name: "walks", contains: |found| (1.0..1.5).contains(&found.speed_mps) && is_straight(found) },
    GaitClass { name: "jogs", contains: |found| (1.9..3.0).contains(&found.speed_mps) && is_straight(found) },
    GaitClass { name: "runs", contains: |found| (3.0..6.0).contains(&found.speed_mps) && is_straight(found) },
    GaitClass {
        name: "turns",
        contains: |found| (0.3..1.6).contains(&found.speed_mps) && found.turn_rate_rad_s.abs() > 20_f32.to_radians(),
    },
    GaitClass {
        name: "side-steps",
        contains: |found| found.strafe_mps.abs() > 0.2 && found.speed_mps.abs() < found.strafe_mps.abs(),
    },
    GaitClass { name: "backward walks", contains: |found| found.speed_mps < -0.2 },
];

/// Whether a gait is straight except for gait noise: up to 10 °/s, and a tenth of the speed aside.
fn is_straight(found: &Parameters) -> bool {
    found.turn_rate_rad_s.abs() < 10_f32.to_radians() && found.strafe_mps.abs() < 0.1 * found.speed_mps
}

/// A clip, and the nearest other clip.
#[derive(Debug, JsonSchema, Serialize)]
pub struct NearestClip {
    /// Name of the clip.
    pub clip: String,
    /// Source folder of the clip; empty for a bundled clip.
    pub source: String,
    /// Distance to the nearest clip: root mean square angle between bones, degrees.
    pub distance_deg: f32,
    /// Name of the nearest clip.
    pub nearest: String,
    /// Source folder of the nearest clip.
    pub nearest_source: String,
}

/// One class of gait.
#[derive(Debug, JsonSchema, Serialize)]
pub struct GaitSimilarity {
    /// Name of the class.
    #[serde(rename = "kind")]
    pub gait_class: &'static str,
    /// Real clips, each with the nearest clip of another source.
    pub real: Vec<NearestClip>,
    /// Number of source folders with real clips of the class.
    pub sources: usize,
    /// Median of the real clips' distances, degrees; null where fewer than two sources have the class.
    pub median_deg: Option<f32>,
    /// Bundled clips, each with the nearest real clip.
    pub bundled: Vec<NearestClip>,
}

impl GaitSimilarity {
    /// Whether there are enough sources for a median distance between people.
    pub(crate) fn has_criterion(&self) -> bool {
        self.sources >= SOURCES_MIN
    }
}

/// A cycle of a database, and its mirror where the database has it.
struct RecordedCycle {
    source: String,
    capture: u32,
    clip: String,
    parameters: Parameters,
    window_s: f32,
    sequences: Vec<PoseSequence>,
}

/// The classes of gait of all folders below `mocap`, each a source, and of the bundled clips' database.
pub(crate) fn similarity(mocap: &Path, bundled: &MotionDb) -> Result<Vec<GaitSimilarity>, BenchError> {
    // A clip of one source does not take the place of another's.
    let options = Options { keep_doubtful: true, ..Options::default() };
    let real = recorded_cycles(&compile(real_clips(mocap)?, &options, &|_| ())?);
    let ours = recorded_cycles(bundled);
    Ok(GAIT_CLASSES.iter().map(|gait_class| similarity_in_class(gait_class, &real, &ours)).collect())
}

/// The human clips of all folders, each named after its folder.
fn real_clips(mocap: &Path) -> Result<Vec<HumanClip>, BenchError> {
    let mut clips = Vec::new();
    for file in motiondb_compiler::clip_files(mocap)? {
        let folder = file.parent().and_then(|folder| folder.strip_prefix(mocap).ok()).unwrap_or(Path::new(""));
        let imports = motiondb_compiler::import_file(&file).unwrap_or_default();
        clips.extend(imports.into_iter().filter_map(|import| import.outcome.ok()).map(|mut clip| {
            clip.source.file = folder.join(&clip.source.file).display().to_string();
            clip
        }));
    }
    Ok(clips)
}

/// Every recorded cycle that steps.
fn recorded_cycles(db: &MotionDb) -> Vec<RecordedCycle> {
    let steps = |example: &&MotionExample| example.key_times_s.is_some() && !example.mirrored;
    let cycle = |example: &MotionExample| {
        let file = PathBuf::from(&db.sources[example.source as usize].file);
        let own = |index: &usize| db.examples[*index].is_of_one_window_with(example);
        let sequences = (0..db.examples.len()).filter(own);
        RecordedCycle {
            source: file.parent().map_or_else(String::new, |folder| folder.display().to_string()),
            capture: example.source,
            clip: example.name.clone(),
            parameters: with_legs(&example.parameters, db.skeleton.leg_length_m(), LEG_M),
            window_s: example.window_s[1] - example.window_s[0],
            sequences: sequences.map(|index| PoseSequence::of(db, index)).collect(),
        }
    };
    db.examples.iter().filter(steps).map(cycle).collect()
}

/// Parameters of the same motion on a body with other legs, m.
fn with_legs(found: &Parameters, from_m: f32, to_m: f32) -> Parameters {
    let growth = to_m / from_m;
    Parameters { speed_mps: growth * found.speed_mps, strafe_mps: growth * found.strafe_mps, ..*found }
}

fn similarity_in_class(gait_class: &GaitClass, real: &[RecordedCycle], ours: &[RecordedCycle]) -> GaitSimilarity {
    let real = longest_of_each_capture(real.iter().filter(|cycle| (gait_class.contains)(&cycle.parameters)));
    let to_others = |cycle: &&RecordedCycle| nearest(cycle, real.iter().filter(|other| other.source != cycle.source));
    let measured: Vec<NearestClip> = real.iter().filter_map(to_others).collect();
    let ours = ours.iter().filter(|cycle| (gait_class.contains)(&cycle.parameters));
    let mut sources: Vec<&str> = real.iter().map(|cycle| cycle.source.as_str()).collect();
    sources.dedup();
    GaitSimilarity {
        gait_class: gait_class.name,
        sources: sources.len(),
        median_deg: median(measured.iter().map(|found| found.distance_deg)),
        real: measured,
        bundled: ours.filter_map(|cycle| nearest(cycle, real.iter())).collect(),
    }
}

/// The longest cycle of each capture, in order of sources.
fn longest_of_each_capture<'a>(cycles: impl Iterator<Item = &'a RecordedCycle>) -> Vec<&'a RecordedCycle> {
    let mut cycles: Vec<&RecordedCycle> = cycles.collect();
    cycles
        .sort_by(|a, b| (&a.source, &a.capture).cmp(&(&b.source, &b.capture)).then(b.window_s.total_cmp(&a.window_s)));
    cycles.dedup_by(|later, first| (&later.source, &later.capture) == (&first.source, &first.capture));
    cycles
}

/// The nearest other cycle; none if there is no other.
fn nearest<'a>(cycle: &RecordedCycle, others: impl Iterator<Item = &'a &'a RecordedCycle>) -> Option<NearestClip> {
    let distance_deg = |other: &RecordedCycle| {
        let distances = other.sequences.iter().map(|sequence| cycle.sequences[0].distance_deg(sequence));
        distances.fold(f32::INFINITY, f32::min)
    };
    let measured = others.map(|other| (distance_deg(other), other));
    let (distance_deg, other) = measured.min_by(|a, b| a.0.total_cmp(&b.0))?;
    Some(NearestClip {
        clip: cycle.clip.clone(),
        source: cycle.source.clone(),
        distance_deg,
        nearest: other.clip.clone(),
        nearest_source: other.source.clone(),
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_body_of_a_set_moves_no_clip_into_another_class() {
        let [walks, ..] = GAIT_CLASSES;
        let contained = |speed_mps: f32, leg_m: f32| {
            let found = Parameters { speed_mps, ..Parameters::default() };
            (walks.contains)(&with_legs(&found, leg_m, LEG_M))
        };
        for size in [0.8, 1.0, 1.25] {
            let found = [0.95, 1.05, 1.45, 1.55].map(|speed_mps| contained(size * speed_mps, size * LEG_M));
            assert_eq!(found, [false, true, true, false], "{size}");
        }
    }
}

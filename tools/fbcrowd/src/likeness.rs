//! Are the bundled clips as near to real ones as real ones are to each other?
//!
//! For each kind of gait: the real clips' distances ([`PoseSequence`]) to the nearest of *another* source folder, and
//! each bundled clip's distance to its nearest real one, which must be no greater than the median of those. One clip of
//! each take: where a capture has several windows of a kind the longest counts, and of a take that is there twice the
//! compiler uses one. Motions to the left and to the right are one kind: the mirrored example is tried as well.

use std::path::{Path, PathBuf};

use motiondb::motion::{MotionDb, MotionExample, Parameters};
use motiondb_compiler::{HumanClip, Options, clip_files, compile, import_file};
use serde::Serialize;

use crate::failure::Failure;
use crate::pose_sequence::PoseSequence;
use crate::statistics::median;

/// Kinds with fewer source folders are told, but nothing is asked of them.
const SOURCES_MIN: usize = 3;

/// A kind of gait, by its parameters.
struct Kind {
    name: &'static str,
    holds: fn(&Parameters) -> bool,
}

/// Straight: as gait noise leaves it, 10 °/s and a tenth of the speed aside. Walks are those that people choose; turns
/// are walked.
const KINDS: [Kind; 6] = [
    Kind { name: "walks", holds: |found| (1.0..1.5).contains(&found.speed_mps) && is_straight(found) },
    Kind { name: "jogs", holds: |found| (1.9..3.0).contains(&found.speed_mps) && is_straight(found) },
    Kind { name: "runs", holds: |found| (3.0..6.0).contains(&found.speed_mps) && is_straight(found) },
    Kind {
        name: "turns",
        holds: |found| (0.3..1.6).contains(&found.speed_mps) && found.turn_rate_rad_s.abs() > 20_f32.to_radians(),
    },
    Kind {
        name: "side-steps",
        holds: |found| found.strafe_mps.abs() > 0.2 && found.speed_mps.abs() < found.strafe_mps.abs(),
    },
    Kind { name: "backward walks", holds: |found| found.speed_mps < -0.2 },
];

fn is_straight(found: &Parameters) -> bool {
    found.turn_rate_rad_s.abs() < 10_f32.to_radians() && found.strafe_mps.abs() < 0.1 * found.speed_mps
}

/// A clip of one kind, and its nearest of others.
#[derive(Debug, Serialize)]
pub(crate) struct Nearest {
    pub(crate) clip: String,
    pub(crate) source: String,
    pub(crate) distance_deg: f32,
    pub(crate) nearest: String,
    pub(crate) nearest_source: String,
}

/// One kind of gait.
#[derive(Debug, Serialize)]
pub(crate) struct KindOfGait {
    pub(crate) kind: &'static str,
    /// Real clips, each against those of other sources.
    pub(crate) real: Vec<Nearest>,
    /// Source folders that have the kind.
    pub(crate) sources: usize,
    /// Median of the real clips' distances, degrees; null where fewer than two sources have the kind.
    pub(crate) median_deg: Option<f32>,
    /// Bundled clips against all real ones.
    pub(crate) bundled: Vec<Nearest>,
}

impl KindOfGait {
    /// Whether enough people were recorded to say how far they are from each other.
    pub(crate) fn is_judged(&self) -> bool {
        self.sources >= SOURCES_MIN
    }
}

/// A cycle, and its mirror where the database has it.
struct Motion {
    source: String,
    capture: u32,
    clip: String,
    parameters: Parameters,
    window_s: f32,
    sequences: Vec<PoseSequence>,
}

/// The kinds of gait of all folders below `mocap`, each a source, and of the bundled clips' database.
pub(crate) fn likeness(mocap: &Path, bundled: &MotionDb) -> Result<Vec<KindOfGait>, Failure> {
    let real = motions(&compile(real_clips(mocap)?, &Options::default(), &|_| ())?);
    let ours = motions(bundled);
    Ok(KINDS.iter().map(|kind| kind_of_gait(kind, &real, &ours)).collect())
}

/// The human clips of all folders, each named after its folder.
fn real_clips(mocap: &Path) -> Result<Vec<HumanClip>, Failure> {
    let failed = |error: motiondb_compiler::CompileError| Failure::bad(error.to_string());
    let mut clips = Vec::new();
    for file in clip_files(mocap).map_err(failed)? {
        let folder = file.parent().and_then(|folder| folder.strip_prefix(mocap).ok()).unwrap_or(Path::new(""));
        let imports = import_file(&file).unwrap_or_default();
        clips.extend(imports.into_iter().filter_map(|import| import.outcome.ok()).map(|mut clip| {
            clip.source.file = folder.join(&clip.source.file).display().to_string();
            clip
        }));
    }
    Ok(clips)
}

/// Every recorded motion that steps.
fn motions(db: &MotionDb) -> Vec<Motion> {
    let steps = |example: &&MotionExample| example.key_times_s.is_some() && !example.mirrored;
    let motion = |example: &MotionExample| {
        let file = PathBuf::from(&db.sources[example.source as usize].file);
        let own = |index: &usize| db.examples[*index].is_of_one_window_with(example);
        let sequences = (0..db.examples.len()).filter(own);
        Motion {
            source: file.parent().map_or_else(String::new, |folder| folder.display().to_string()),
            capture: example.source,
            clip: example.name.clone(),
            parameters: example.parameters,
            window_s: example.window_s[1] - example.window_s[0],
            sequences: sequences.map(|index| PoseSequence::of(db, index)).collect(),
        }
    };
    db.examples.iter().filter(steps).map(motion).collect()
}

fn kind_of_gait(kind: &Kind, real: &[Motion], ours: &[Motion]) -> KindOfGait {
    let real = longest_of_each_capture(real.iter().filter(|motion| (kind.holds)(&motion.parameters)));
    let to_others = |motion: &&Motion| nearest(motion, real.iter().filter(|other| other.source != motion.source));
    let measured: Vec<Nearest> = real.iter().filter_map(to_others).collect();
    let ours = ours.iter().filter(|motion| (kind.holds)(&motion.parameters));
    let mut sources: Vec<&str> = real.iter().map(|motion| motion.source.as_str()).collect();
    sources.dedup();
    KindOfGait {
        kind: kind.name,
        sources: sources.len(),
        median_deg: median(measured.iter().map(|found| found.distance_deg)),
        real: measured,
        bundled: ours.filter_map(|motion| nearest(motion, real.iter())).collect(),
    }
}

/// Of the windows of one capture the longest; in order of sources.
fn longest_of_each_capture<'a>(motions: impl Iterator<Item = &'a Motion>) -> Vec<&'a Motion> {
    let mut motions: Vec<&Motion> = motions.collect();
    motions
        .sort_by(|a, b| (&a.source, &a.capture).cmp(&(&b.source, &b.capture)).then(b.window_s.total_cmp(&a.window_s)));
    motions.dedup_by(|later, first| (&later.source, &later.capture) == (&first.source, &first.capture));
    motions
}

fn nearest<'a>(motion: &Motion, others: impl Iterator<Item = &'a &'a Motion>) -> Option<Nearest> {
    let distance_deg = |other: &Motion| {
        let distances = other.sequences.iter().map(|sequence| motion.sequences[0].distance_deg(sequence));
        distances.fold(f32::INFINITY, f32::min)
    };
    let measured = others.map(|other| (distance_deg(other), other));
    let (distance_deg, other) = measured.min_by(|a, b| a.0.total_cmp(&b.0))?;
    Some(Nearest {
        clip: motion.clip.clone(),
        source: motion.source.clone(),
        distance_deg,
        nearest: other.clip.clone(),
        nearest_source: other.source.clone(),
    })
}

//! The compiler's pipeline: clips in, motion database out, one line a stage.
//!
//! The same clips give the same bytes for any folder, file order and number of threads: sources are sorted
//! by file and clip name, examples by their own name, and parallel stages collect in that order.

use std::collections::BTreeSet;
use std::path::PathBuf;

use motiondb::memory;
use motiondb::motion::MotionDb;
use motiondb::validate::first_broken;
use rayon::prelude::*;

use crate::action::idles::idles;
use crate::action::joined_action::{in_order, joined_idles};
use crate::cache::Cache;
use crate::checks::other_up_axes::leave_out_other_up_axes;
use crate::checks::rare_frame_rates::warn_of_rare_frame_rates;
use crate::cycle::analyzed_clip::AnalyzedClip;
use crate::database::assembly::assemble;
use crate::dedup::comparison::ComparedClip;
use crate::dedup::comparison_log::ComparisonLog;
use crate::error::{CompileError, Rejection};
use crate::extra_joints::set_extra::SetExtra;
use crate::ground::head_bends::head_bends;
use crate::ground::target_body::target_body;
use crate::input::clip_set::{self, ClipSet};
use crate::input::manifest::Manifest;
use crate::input::options::Options;
use crate::progress::{CompileEvent, Observer};
use crate::retarget::human_clip::{HumanBody, HumanClip};
use crate::select::best_windows::{best_windows, windows_that_add};
use crate::select::clean_cycles::without_reached_doubtful;
use crate::select::limited_set::limited_set;
use crate::select::mirror::with_mirrors;
use crate::select::named_cycles::named_cycles;
use crate::select::one_standing::one_standing;
use crate::select::unlike_carriages::warn_of_unlike_carriages;
use crate::styles::joined_styles::joined;
use crate::styles::lent_idle::lend_idle;
use crate::styles::style_part::{StylePart, by_style};
use crate::transition::movements_without_idle::note_movements_without_idle;
use crate::transition::only_transitions::note_only_transitions;
use crate::transition::transitions::transitions;
use crate::transition::unused_corners::note_unused_corners;

/// Memory of each frame of an analysed clip beside its pose, bytes: its signatures, at 30 frames a second.
const ANALYZED_FRAME_BYTES: usize = 300;
/// Memory of each frame of a clip while it is analysed, beside its pose, bytes: 200 for each round of a loop.
const ANALYSIS_FRAME_BYTES: usize = 700;

/// A database, and the input that it could not use.
#[derive(Clone, Debug)]
pub struct Compiled {
    /// The database.
    pub db: MotionDb,
    /// Files and clips that cannot be used, in order of file name.
    pub rejected: Vec<Rejection>,
    /// Known manners in the names of clips without a style that give examples of gaits, and of their folders.
    pub unstyled_manners: BTreeSet<&'static str>,
}

/// Imports clip files and compiles them.
///
/// A file that cannot be read is reported in [`Compiled::rejected`], as is a clip that is not human.
///
/// # Errors
/// Those of [`compile`].
pub fn compile_files(files: &[PathBuf], observer: &Observer) -> Result<Compiled, CompileError> {
    compile_manifest(&Manifest::of_files(files), observer)
}

/// Imports and compiles the clips of a manifest, with its choices.
///
/// # Errors
/// Those of [`compile_files`]; also if the manifest contradicts a clip.
pub fn compile_manifest(manifest: &Manifest, observer: &Observer) -> Result<Compiled, CompileError> {
    compiled(manifest, None, observer)
}

/// As [`compile_manifest`], with results of earlier compilations. The database is the same bytes.
///
/// # Errors
/// Those of [`compile_manifest`].
pub fn compile_with_cache(manifest: &Manifest, cache: &Cache, observer: &Observer) -> Result<Compiled, CompileError> {
    compiled(manifest, Some(cache), observer)
}

fn compiled(manifest: &Manifest, cache: Option<&Cache>, observer: &Observer) -> Result<Compiled, CompileError> {
    let ClipSet { clips, rejected } = match cache {
        Some(cache) => clip_set::clip_set(manifest, &|settings| cache.import(settings), observer)?,
        None => clip_set::import_clip_set(manifest, observer)?,
    };
    if clips.is_empty() && !rejected.is_empty() {
        return Err(CompileError::NoExample { rejected, sources: Vec::new() });
    }
    match database(clips, &manifest.options, cache, observer) {
        Err(CompileError::NotStepping { stepping, .. }) => Err(manifest.not_stepping(&stepping).into()),
        Err(CompileError::NoTransition { file, kind }) => Err(manifest.no_transition(&file, kind)),
        Err(CompileError::NoExample { sources, .. }) => Err(CompileError::NoExample { rejected, sources }),
        db => {
            let db = db?;
            let unstyled_manners = manifest.unstyled_manners(&unstyled_gaits(&db));
            Ok(Compiled { db, rejected, unstyled_manners })
        }
    }
}

/// Names of the files without a style that give examples of gaits.
fn unstyled_gaits(db: &MotionDb) -> BTreeSet<&str> {
    let examples = db.of_style("").into_iter().flat_map(|db| db.examples.iter().map(move |example| (db, example)));
    let gaits = examples.filter(|(_, example)| example.key_times_s.is_some());
    gaits.map(|(db, example)| db.sources[example.source as usize].file.as_str()).collect()
}

/// Compiles imported clips into a database.
///
/// # Steps
/// 1. Sort the clips and choose the body that all examples share ([`crate::ground`]).
/// 2. Find the steady windows of each clip ([`crate::gait`]), close each into a cycle ([`crate::cycle`]), keep the best
///    of near-equal ones. Leave out clips that do not stand as their rig does, and judge frame rates (`checks`).
/// 3. Divide the clips by style (`styles`); each style is compiled by itself up to step 9. Keep one clip of each set of
///    duplicates ([`crate::dedup`]). A style that does not stand gets a brief rest, or the idle of the first style.
/// 4. Cut the idles (`action`).
/// 5. Drop doubtful cycles that clean ones reach, and windows that add nothing to the set ([`crate::select`]).
/// 6. Close the standing cycles with the period of m_sp; name all. Of several that stand keep the best: the others are
///    idles alone.
/// 7. Limit the number of examples, add mirrors, sort by name.
/// 8. Join the idles to the standing example; find the transitions and join them to the examples (`transition`).
/// 9. Assemble parameters, blend space, velocity sets, rows, extra joints ([`crate::extra_joints`]) and correspondence
///    ([`crate::database`]).
/// 10. Join the styles over one skeleton; check every invariant of the database ([`motiondb::validate`]).
///
/// # Errors
/// If there are no clips, none gives an example, the chosen m_sp does not step, a clip does not show the transition that
/// is stated, or the database is invalid.
///
/// # Examples
/// ```
/// use std::path::PathBuf;
///
/// use motiondb_compiler::{Options, compile, import_file};
///
/// let folder = PathBuf::from(env!("CARGO_MANIFEST_DIR")).join("../../assets/clips");
/// let files = ["walk_110.bvh", "turn_060_left.bvh", "idle.bvh"].map(|name| folder.join(name));
/// let mut clips = Vec::new();
/// for file in &files {
///     clips.extend(import_file(file)?.into_iter().filter_map(|import| import.outcome.ok()));
/// }
/// let db = compile(clips, &Options::default(), &|_| ())?;
/// let names: Vec<&str> = db.examples.iter().map(|example| example.name.as_str()).collect();
/// assert_eq!(names, ["idle", "turn_060_left", "turn_060_left_mirrored", "walk_110"]);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
pub fn compile(clips: Vec<HumanClip>, options: &Options, observer: &Observer) -> Result<MotionDb, CompileError> {
    database(clips, options, None, observer)
}

/// As [`compile`], with a cache of which the clips may come.
fn database(
    clips: Vec<HumanClip>,
    options: &Options,
    cache: Option<&Cache>,
    observer: &Observer,
) -> Result<MotionDb, CompileError> {
    check_memory(&clips)?;
    let mut set = TargetedClips::of(clips).ok_or(CompileError::NoClips)?;
    observer(CompileEvent::Stage("analysis of gaits"));
    let (compared, mut analyzed) = match cache {
        Some(cache) => (set.compared_by(&|clip| cache.compared(clip)), set.analyzed_with(cache)?),
        None => (set.compared(), set.analyzed()),
    };
    observer(CompileEvent::Stage("selection"));
    let TargetedClips { mut clips, body } = set;
    leave_out_other_up_axes(&mut clips, &mut analyzed);
    warn_of_rare_frame_rates(&clips, &mut analyzed);
    analyzed.iter_mut().zip(head_bends(&clips)).for_each(|(found, bend)| found.bend_head(bend));
    let extra = SetExtra::of(&clips, &analyzed, &body);
    let log = cache.map_or_else(ComparisonLog::default, |cache| cache.comparisons(&clips));
    let parts = by_style(clips, compared, analyzed).into_iter();
    let mut parts: Vec<StylePart> = parts.map(|part| part.without_duplicates(&body, &log)).collect();
    cache.into_iter().for_each(|cache| cache.close(&log));
    lend_idle(&mut parts, &body);
    let databases: Result<Vec<MotionDb>, CompileError> =
        parts.into_iter().map(|part| style_database(part, &body, &extra, options, observer)).collect();
    let db = joined(databases?).ok_or(CompileError::NoClips)?;
    observer(CompileEvent::Stage("validation"));
    valid(db)
}

/// The database of the clips of one style.
fn style_database(
    StylePart { style, clips, analyzed, .. }: StylePart,
    body: &HumanBody,
    set_extra: &SetExtra,
    options: &Options,
    observer: &Observer,
) -> Result<MotionDb, CompileError> {
    let cut = idles(&clips, &analyzed, body);
    let clean = if options.keep_doubtful { analyzed } else { without_reached_doubtful(&clips, analyzed) };
    let mut adding = windows_that_add(clean);
    warn_of_unlike_carriages(&mut adding, body);
    let named = one_standing(named_cycles(&clips, &adding, body)?, &cut, body);
    let mut selected = with_mirrors(limited_set(named, options.max_examples)).sorted()?;
    let idles = joined_idles(cut, &selected.cycles, body);
    observer(CompileEvent::Stage("transitions"));
    let actions = in_order(idles, transitions(&clips, &adding, &selected.cycles, body)?);
    note_movements_without_idle(&mut selected.sources, &clips, &adding);
    note_unused_corners(&mut selected.sources, &adding, &actions);
    note_only_transitions(&mut selected.sources, &actions);
    let extra = set_extra.motion(&selected.cycles, &actions, &clips);
    Ok(MotionDb { style, extra, ..assemble(selected, &actions, body, options.velocity_hull, observer) })
}

/// Checks that the system gives the memory that the analysis of some clips needs.
fn check_memory(clips: &[HumanClip]) -> Result<(), CompileError> {
    let frames = HumanClip::frame_count;
    let at_once = rayon::current_num_threads().min(clips.len()) * clips.iter().map(frames).max().unwrap_or(0);
    let bytes = clips.iter().map(frames).sum::<usize>() * ANALYZED_FRAME_BYTES + at_once * ANALYSIS_FRAME_BYTES;
    if memory::has_room(bytes) { Ok(()) } else { Err(CompileError::OutOfMemory { mib: bytes >> 20 }) }
}

/// Human clips in the order of a database, and the body that all examples share.
pub(crate) struct TargetedClips {
    /// The clips, sorted, each with its own name.
    pub(crate) clips: Vec<HumanClip>,
    /// The target body.
    pub(crate) body: HumanBody,
}

impl TargetedClips {
    /// Sorts clips and chooses their target body; `None` without clips.
    pub(crate) fn of(mut clips: Vec<HumanClip>) -> Option<Self> {
        clip_set::sort(&mut clips);
        let body = target_body(&clips)?;
        Some(Self { clips, body })
    }

    /// Each clip in the form in which clips are compared.
    pub(crate) fn compared(&self) -> Vec<ComparedClip> {
        self.compared_by(&ComparedClip::of)
    }

    fn compared_by(&self, compared: &(dyn Fn(&HumanClip) -> ComparedClip + Sync)) -> Vec<ComparedClip> {
        self.clips.par_iter().map(compared).collect()
    }

    /// The analysis of each clip, its windows reduced to the best. The clips have no frames afterwards, and of the poses
    /// on the target body only those of rests and movements are left.
    pub(crate) fn analyzed(&mut self) -> Vec<AnalyzedClip> {
        self.clips.par_iter_mut().map(|clip| analyzed(clip, &self.body)).collect()
    }

    /// As [`Self::analyzed`]; what a cache holds is not made again.
    fn analyzed_with(&mut self, cache: &Cache) -> Result<Vec<AnalyzedClip>, CompileError> {
        let body = &self.body;
        let with_cache = |clip: &mut HumanClip| cache.analyzed(clip, body, |clip| analyzed(clip, body));
        self.clips.par_iter_mut().map(with_cache).collect()
    }
}

/// The analysis of a clip, see [`TargetedClips::analyzed`].
fn analyzed(clip: &mut HumanClip, body: &HumanBody) -> AnalyzedClip {
    best_windows(AnalyzedClip::of(clip, body), body).keep_needed()
}

/// The database, if it holds every invariant.
fn valid(db: MotionDb) -> Result<MotionDb, CompileError> {
    match first_broken(&db) {
        Some((invariant, detail)) => Err(CompileError::InvalidDatabase { invariant, detail }),
        None => Ok(db),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::synthetic::{SyntheticWalk, database_of, idle, walk};

    fn set() -> Vec<HumanClip> {
        let at = SyntheticWalk::at;
        vec![
            walk("straight", SyntheticWalk { left_share: 0.55, ..at(1.1, 0.01, 0.0) }),
            walk("slow", SyntheticWalk { period_s: 1.3, frame_rate_hz: 120.0, ..at(0.7, 0.0, 0.0) }),
            walk("turn", at(0.6, 0.9, 0.0)),
            walk("side", at(0.1, 0.0, -0.4)),
            idle("idle", 3.0),
        ]
    }

    #[track_caller]
    fn check_rates(db: &MotionDb, name: &str, exact: [f32; 3]) {
        let example = db.examples.iter().find(|example| example.name == name).unwrap();
        let found = example.parameters.to_vec3().to_array();
        for (found, exact_value) in found.iter().zip(exact) {
            assert!((found - exact_value).abs() < 0.01, "{example:?}, not {exact:?}");
        }
    }

    #[test]
    fn walks_give_their_rates_and_mirrors() {
        let db = database_of(set(), 0);
        assert_eq!(first_broken(&db), None);
        check_rates(&db, "straight", [1.1, 0.0, 0.0]);
        check_rates(&db, "turn", [0.6, 0.9, 0.0]);
        check_rates(&db, "turn_mirrored", [0.6, -0.9, 0.0]);
        check_rates(&db, "side_mirrored", [0.1, 0.0, 0.4]);
        assert_eq!(db.examples.len(), 7, "{:?}", db.sources);
        for example in &db.examples {
            assert!(example.planted_slide_cm_s < 1.0, "{example:?}");
        }
        let straight = &db.examples[db.correspondence.as_ref().unwrap().semi_procedural as usize];
        assert_eq!(straight.name, "straight");
        assert!((straight.phase_map.left_share - 0.55).abs() < 0.02, "{straight:?}");
        assert!((straight.phase_map.period_s - 1.1).abs() < 0.01, "{straight:?}");
    }

    #[test]
    fn order_and_threads_do_not_matter() {
        let mut reversed = set();
        reversed.reverse();
        let one_thread = rayon::ThreadPoolBuilder::new().num_threads(1).build().unwrap();
        assert_eq!(database_of(set(), 0), one_thread.install(|| database_of(reversed, 0)));
    }

    #[test]
    fn bodies_that_leave_their_legs_give_no_example() {
        let mut clips = set();
        let (mut leap, mut sunk) = (walk("leap", SyntheticWalk::default()), idle("sunk", 3.0));
        leap.frames.iter_mut().skip(7).step_by(9).for_each(|pose| pose.pelvis_m.y += 8.0);
        sunk.frames.iter_mut().skip(7).step_by(9).for_each(|pose| pose.pelvis_m.z -= 2.0);
        clips.extend([leap, sunk]);
        let db = database_of(clips, 0);
        let is_broken = |name: &str| name == "leap" || name == "sunk";
        assert!(!db.examples.iter().any(|example| is_broken(&example.name)), "{:?}", db.sources);
        assert_eq!(db.examples.len(), 7);
    }

    #[test]
    fn performers_of_other_sizes_are_scaled() {
        let mut clips = set();
        clips.push(walk("giant", SyntheticWalk { size: 2.0, ..SyntheticWalk::at(2.0, 0.0, 0.0) }));
        check_rates(&database_of(clips, 0), "giant", [1.0, 0.0, 0.0]);
    }
}

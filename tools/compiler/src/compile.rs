//! The compiler: clips in, motion database out, one line a stage.
//!
//! # Steps
//! import ([`clip_set`]) → the body that all examples share (`target_skeleton`) → steady windows and their mean
//! strides (`analysis`) → of one take one copy (`duplicates`) and of near-equal windows the best (`selection`) →
//! closed cycles and their mirrors (`named_cycles`) → (v_f, ω_t, ω_s) and key times (`parameterize`) → blend space
//! ([`motiondb::blend_space::triangulation`]), velocity sets ([`velocity_hull`]), `correspondence` → [`MotionDb`], valid.
//!
//! The same clips give the same bytes whatever their folder, their order and the number of threads: sources are sorted
//! by file and clip name, examples by their own name, and parallel stages collect in that order.

use std::path::PathBuf;

use motiondb::diagnostic::{Diagnostic, Note};
use motiondb::motion::{MotionDb, MotionExample, Parameters, SourceRecord};
use motiondb::validate::first_broken;
use motiondb::velocity_sets::velocity_hull;
use rayon::prelude::*;

use crate::cycle::analysis::{Analyzed, analyze};
use crate::cycle::mean_stride::{GaitCycle, NamedCycle};
use crate::database::{correspondence, parameterize, rows};
use crate::dedup::duplicates;
use crate::error::{CompileError, Rejection};
use crate::ground::target_skeleton;
use crate::input::clip_set::{self, ClipSet};
use crate::input::manifest::Manifest;
use crate::input::options::Options;
use crate::progress::{CompileEvent, Observer};
use crate::retarget::human_clip::{HumanBody, HumanClip};
use crate::select::{coincident_examples, named_cycles, selection};

/// A database, and the input that it could not use.
#[derive(Clone, Debug)]
pub struct Compiled {
    /// The database.
    pub db: MotionDb,
    /// Files and clips that cannot be used, in order of file name.
    pub rejected: Vec<Rejection>,
}

/// Imports files, compiles their clips.
///
/// # Errors
/// As [`compile`]; a file that cannot be read is rejected like a clip that is not human, unless nothing is left.
pub fn compile_files(files: &[PathBuf], tell: &Observer) -> Result<Compiled, CompileError> {
    compile_manifest(&Manifest::of_files(files), tell)
}

/// As [`compile_files`], of the clips and by the choices of a manifest.
///
/// # Errors
/// As [`compile_files`], and where the manifest says of a clip what is not so.
pub fn compile_manifest(manifest: &Manifest, tell: &Observer) -> Result<Compiled, CompileError> {
    let ClipSet { clips, rejected } = clip_set::import_clip_set(manifest, tell)?;
    if clips.is_empty() && !rejected.is_empty() {
        return Err(CompileError::NoExample { rejected, sources: Vec::new() });
    }
    match compile(clips, &manifest.options, tell) {
        Err(CompileError::NotStepping { stepping, .. }) => Err(manifest.not_stepping(&stepping).into()),
        Err(CompileError::NoExample { sources, .. }) => Err(CompileError::NoExample { rejected, sources }),
        compiled => Ok(Compiled { db: compiled?, rejected }),
    }
}

/// Compiles clips into a database.
///
/// # Errors
/// Where no clip gives an example, or the database is unsound.
pub fn compile(mut clips: Vec<HumanClip>, options: &Options, tell: &Observer) -> Result<MotionDb, CompileError> {
    if clips.is_empty() {
        return Err(CompileError::NoClips);
    }
    clip_set::sort(&mut clips);
    let body = target_skeleton::choose(&clips);
    tell(CompileEvent::Stage("analysis of gaits"));
    let mut analyzed: Vec<Analyzed> = clips.par_iter().map(|clip| analyze(clip, &body)).collect();
    tell(CompileEvent::Stage("selection"));
    duplicates::set_aside(&clips, &mut analyzed, &body);
    selection::keep_what_adds(&mut analyzed);
    let mut sources: Vec<SourceRecord> = clips.iter().zip(&analyzed).map(|(clip, found)| found.record(clip)).collect();
    let mut cycles = named_cycles::close(&clips, analyzed, &body)?;
    selection::limit(&mut cycles, options.max_examples, &mut sources);
    named_cycles::add_mirrors(&mut cycles);
    cycles.sort_by(|a, b| a.name.cmp(&b.name));
    if cycles.is_empty() {
        return Err(CompileError::NoExample { rejected: Vec::new(), sources });
    }
    sound(assemble(cycles, sources, &body, options, tell), tell)
}

/// The database of cycles sorted by name.
fn assemble(
    named: Vec<NamedCycle>,
    mut sources: Vec<SourceRecord>,
    body: &HumanBody,
    options: &Options,
    tell: &Observer,
) -> MotionDb {
    tell(CompileEvent::Stage("parameters"));
    let examples: Vec<MotionExample> = named.iter().map(|named| parameterize::example(named, body)).collect();
    let chosen = named.iter().position(|named| named.choices.is_semi_procedural);
    let flaws: Vec<f64> = named.iter().map(|named| named.flaws).collect();
    let cycles: Vec<GaitCycle> = named.into_iter().map(|named| named.cycle).collect();
    tell(CompileEvent::Stage("blend space"));
    let parameters: Vec<Parameters> = examples.iter().map(|example| example.parameters).collect();
    let blend_space = coincident_examples::build_of_best(&parameters, &flaws);
    note_twins(&coincident_examples::twins(&parameters, &blend_space), &examples, &mut sources);
    tell(CompileEvent::Stage("assembly"));
    let mut db = MotionDb {
        skeleton: target_skeleton::skeleton(body, cycles.iter()),
        correspondence: None,
        velocity_hull: velocity_hull::build(&parameters, options.velocity_hull),
        rows: rows::flatten(&cycles),
        blend_space,
        examples,
        sources,
    };
    tell(CompileEvent::Stage("correspondence times"));
    db.correspondence = correspondence::find(&db, chosen);
    db
}

/// A database that holds every invariant.
fn sound(db: MotionDb, tell: &Observer) -> Result<MotionDb, CompileError> {
    tell(CompileEvent::Stage("validation"));
    match first_broken(&db) {
        Some((invariant, detail)) => Err(CompileError::Unsound { invariant, detail }),
        None => Ok(db),
    }
}

/// Of examples with the same parameters the best is blended; the sources of the others have a note.
fn note_twins(twins: &[[usize; 2]], examples: &[MotionExample], sources: &mut [SourceRecord]) {
    let twins = twins.iter().map(|pair| pair.map(|index| &examples[index]));
    for [unused, blended] in twins.filter(|[unused, _]| !unused.mirrored) {
        let note = Note::CoincidentExample { example: unused.name.clone(), blended: blended.name.clone() };
        sources[unused.source as usize].diagnostics.push(Diagnostic::Note(note));
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::ground::arc::Rates;
    use crate::synthetic::{Walk, idle, walk};

    fn set() -> Vec<HumanClip> {
        let with = |speed_mps, turn_rate_rad_s, strafe_mps| Walk {
            rates: Rates { speed_mps, turn_rate_rad_s, strafe_mps },
            ..Walk::default()
        };
        vec![
            walk("straight", Walk { left_share: 0.55, ..with(1.1, 0.01, 0.0) }),
            walk("slow", Walk { period_s: 1.3, frame_rate_hz: 120.0, ..with(0.7, 0.0, 0.0) }),
            walk("turn", with(0.6, 0.9, 0.0)),
            walk("side", with(0.1, 0.0, -0.4)),
            idle("idle", 3.0),
        ]
    }

    fn compiled(clips: Vec<HumanClip>) -> MotionDb {
        compile(clips, &Options::default(), &|_| ()).unwrap()
    }

    fn check_rates(db: &MotionDb, name: &str, wanted: [f32; 3]) {
        let example = db.examples.iter().find(|example| example.name == name).unwrap();
        let found = example.parameters.to_vec3().to_array();
        for (found, wanted) in found.iter().zip(wanted) {
            assert!((found - wanted).abs() < 0.01, "{example:?}, not {wanted:?}");
        }
    }

    #[test]
    fn a_set_of_walks_gives_their_rates_mirrors_and_a_valid_database() {
        let db = compiled(set());
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
        assert_eq!(compiled(set()), one_thread.install(|| compiled(reversed)));
    }

    #[test]
    fn a_body_that_leaves_its_legs_gives_no_example_and_spoils_no_other() {
        let mut clips = set();
        clips.push(walk("leap", Walk::default()));
        clips.push(idle("sunk", 3.0));
        let count = clips.len();
        clips[count - 2].frames.iter_mut().skip(7).step_by(9).for_each(|pose| pose.pelvis_m.y += 8.0);
        clips[count - 1].frames.iter_mut().skip(7).step_by(9).for_each(|pose| pose.pelvis_m.z -= 2.0);
        let db = compiled(clips);
        assert!(
            !db.examples.iter().any(|example| example.name == "leap" || example.name == "sunk"),
            "{:?}",
            db.sources
        );
        assert_eq!(db.examples.len(), 7);
    }

    #[test]
    fn a_performer_of_another_size_is_scaled() {
        let double = Walk { size: 2.0, rates: Rates { speed_mps: 2.0, ..Rates::default() }, ..Walk::default() };
        let mut clips = set();
        clips.push(walk("giant", double));
        check_rates(&compiled(clips), "giant", [1.0, 0.0, 0.0]);
    }
}

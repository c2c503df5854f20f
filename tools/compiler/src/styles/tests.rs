//! Sets with styles: each is a database of its own, and none vanishes into another.

use std::num::NonZeroUsize;

use glam::DQuat;
use motiondb::body::Joint;
use motiondb::diagnostic::{Diagnostic, Note, Warning};
use motiondb::files::database_file;
use motiondb::motion::MotionDb;
use motiondb::validate::first_broken;

use crate::retarget::human_clip::HumanClip;
use crate::survey::survey;
use crate::synthetic::{SyntheticWalk, database_of, idle, performance, recorded, walk};
use crate::{Options, compile};

fn straight(name: &str, speed_mps: f64) -> HumanClip {
    walk(name, SyntheticWalk { period_s: 1.5 - 0.4 * speed_mps, ..SyntheticWalk::at(speed_mps, 0.0, 0.0) })
}

/// The clip in a style; the elderly body is bent.
fn of(style: &str, mut clip: HumanClip) -> HumanClip {
    style.clone_into(&mut clip.style);
    if style == "elderly" {
        let bent = DQuat::from_rotation_y(0.5);
        clip.frames.iter_mut().for_each(|pose| pose.rotations[Joint::SpineLower.index()] = bent);
    }
    clip
}

fn names(db: &MotionDb) -> Vec<&str> {
    recorded(db).iter().map(|example| example.name.as_str()).collect()
}

fn styles(db: &MotionDb) -> Vec<&str> {
    db.styles().map(|db| db.style.as_str()).collect()
}

fn diagnostics(db: &MotionDb) -> Vec<&Diagnostic> {
    db.styles().flat_map(|db| &db.sources).flat_map(|source| &source.diagnostics).collect()
}

fn neutral() -> Vec<HumanClip> {
    let turn = walk("turn", SyntheticWalk::at(0.6, 0.9, 0.0));
    vec![straight("slow", 0.7), straight("walk", 1.2), turn, idle("idle", 3.0)]
}

#[test]
fn each_style_is_as_if_compiled_alone() {
    let elderly =
        || ["old_slow", "old_walk"].into_iter().zip([0.5, 0.9]).map(|(name, mps)| of("elderly", straight(name, mps)));
    let mut clips = neutral();
    clips.extend(elderly());
    clips.push(of("elderly", idle("old_idle", 4.0)));
    let db = database_of(clips.clone(), 0);
    assert_eq!(first_broken(&db), None);
    assert_eq!(styles(&db), ["", "elderly"]);
    assert_eq!(names(&db), ["idle", "slow", "turn", "walk"]);
    let old = db.of_style("elderly").unwrap();
    assert_eq!(names(old), ["old_idle", "old_slow", "old_walk"]);
    let base = |db: &MotionDb| db.examples[db.correspondence.as_ref().unwrap().semi_procedural as usize].name.clone();
    assert_eq!([base(&db), base(old)], ["walk", "old_walk"]);
    assert_eq!(old.idles().map(|idle| idle.name.as_str()).collect::<Vec<_>>(), ["old_idle"]);
    // The same clips alone, apart from the joint limits of the shared skeleton.
    let alone = database_of(neutral(), 0);
    assert_eq!((&db.examples, &db.rows, &db.actions), (&alone.examples, &alone.rows, &alone.actions));
    assert_eq!(diagnostics(&db), Vec::<&Diagnostic>::new());
    clips.reverse();
    assert_eq!(database_of(clips, 0), db);
}

#[test]
fn equal_parameters_and_copies_stay_in_their_styles() {
    let clips = vec![
        straight("walk", 1.0),
        of("elderly", straight("bent", 1.0)),
        of("copied", straight("copy", 1.0)),
        idle("idle", 3.0),
    ];
    let db = database_of(clips.clone(), 0);
    assert_eq!(styles(&db), ["", "copied", "elderly"]);
    for (style, name) in [("", "walk"), ("copied", "copy"), ("elderly", "bent")] {
        let db = db.of_style(style).unwrap();
        assert!(names(db).contains(&name) && db.blend_space.simplices.len() == 2, "{style}: {:?}", db.blend_space);
    }
}

#[test]
fn of_coincident_examples_the_poses_are_compared() {
    let other_take =
        |name: &str, speed_mps| walk(name, SyntheticWalk { period_s: 1.25, ..SyntheticWalk::at(speed_mps, 0.0, 0.0) });
    let bent = HumanClip { style: String::new(), ..of("elderly", other_take("bent", 1.0)) };
    let one = database_of(vec![straight("walk", 1.0), bent, straight("fast", 1.6), other_take("faster", 1.6)], 0);
    let alike = |found: &&Diagnostic| matches!(found, Diagnostic::Note(Note::CoincidentExample { .. }));
    let manner = |found: &&Diagnostic| match found {
        Diagnostic::Note(Note::CoincidentManners { distance_cm, .. }) => *distance_cm > 6.0,
        _ => false,
    };
    assert_eq!(diagnostics(&one).iter().filter(|found| manner(found)).count(), 1, "{:?}", one.sources);
    assert_eq!(diagnostics(&one).iter().filter(|found| alike(found)).count(), 1, "{:?}", one.sources);
}

#[test]
fn a_style_without_idle_borrows_the_neutral_one() {
    let mut clips: Vec<HumanClip> = neutral().into_iter().map(|clip| of("neutral", clip)).collect();
    clips.push(of("elderly", straight("old_walk", 0.9)));
    clips.push(of("brisk", straight("brisk_walk", 1.6)));
    let db = database_of(clips, 0);
    assert_eq!(styles(&db), ["neutral", "brisk", "elderly"]);
    let old = db.of_style("elderly").unwrap();
    assert_eq!(names(old), ["idle", "old_walk"]);
    assert_eq!(old.idles().count(), 1);
    let lent = Note::IdleOfOtherStyle { style: "elderly".into(), lender: "neutral".into() };
    assert!(old.sources.iter().any(|source| source.diagnostics == [Diagnostic::Note(lent.clone())]));
}

#[test]
fn clips_without_style_that_only_stand_serve_all_styles() {
    let clips = vec![of("brisk", straight("a", 1.6)), of("elderly", straight("b", 0.9)), idle("idle", 3.0)];
    let db = database_of(clips, 0);
    assert_eq!(styles(&db), ["brisk", "elderly"]);
    assert!(db.styles().all(|db| db.idles().count() == 1));
    let added = Diagnostic::Note(Note::AddedToStyle { style: "brisk".into() });
    assert!(diagnostics(&db).contains(&&added), "{:?}", diagnostics(&db));
}

#[test]
fn styles_without_example_or_stride_are_named() {
    let mut still = of("frozen", straight("moment", 1.0));
    still.frames.truncate(20);
    let mut clips = neutral();
    clips.extend([still, of("elderly", idle("old_idle", 3.0))]);
    let surveyed = survey(clips.clone());
    let db = database_of(clips, 0);
    assert_eq!(styles(&db), ["", "elderly"]);
    for warning in [
        Warning::StyleWithoutExample { style: "frozen".into() },
        Warning::StyleWithoutStride { style: "elderly".into() },
    ] {
        assert!(diagnostics(&db).contains(&&Diagnostic::Warning(warning.clone())), "{warning}");
    }
    let of_style = |style: &str| surveyed.iter().filter(|found| found.style == style).count();
    assert_eq!([of_style(""), of_style("frozen"), of_style("elderly")], [4, 1, 1]);
}

#[test]
fn the_limit_of_examples_holds_for_each_style() {
    let mut clips = neutral();
    clips.extend(neutral().into_iter().map(|clip| of("elderly", clip)));
    let options = Options { max_examples: NonZeroUsize::new(2), ..Options::default() };
    let db = compile(clips, &options, &|_| ()).unwrap();
    assert_eq!(names(&db), ["idle", "walk"]);
    assert_eq!(names(db.of_style("elderly").unwrap()), ["elderly idle", "elderly walk"]);
}

#[test]
fn styles_survive_the_file_and_their_faults_are_named() {
    let mut clips = neutral();
    clips.push(of("elderly", straight("old_walk", 0.9)));
    let mut db = database_of(clips, 0);
    let bytes = database_file::to_bytes(&db);
    let path = std::path::Path::new("styles.fbdb");
    assert_eq!(database_file::from_bytes(path, &bytes).unwrap().0, db);
    let unstyled = MotionDb { further_styles: Vec::new(), ..db.clone() };
    assert!(bytes.len() > database_file::to_bytes(&unstyled).len());
    let fault = |db: &MotionDb| first_broken(db).map(|(name, _)| name);
    db.further_styles[0].examples[0].window_s = [2.0, 1.0];
    assert!(first_broken(&db).unwrap().1.starts_with("style `elderly`: "));
    db.further_styles[0] = unstyled.clone();
    assert_eq!(fault(&db), Some("styles_are_unique"));
    db.further_styles[0].style = "elderly".into();
    assert_eq!(fault(&db), None);
    db.further_styles[0].skeleton.offsets_m[3].x += 0.001;
    assert_eq!(fault(&db), Some("styles_share_the_skeleton"));
    db.further_styles[0].style = "../angry".into();
    assert_eq!(fault(&db), Some("styles_are_unique"));
}

#[test]
fn a_style_without_idle_stands_as_in_a_brief_rest() {
    let capture = || {
        let part =
            |speed_mps| walk("part", SyntheticWalk { duration_s: 4.0, ..SyntheticWalk::at(speed_mps, 0.0, 0.0) });
        performance("capture", &[part(1.2), idle("part", 1.2), part(0.8)])
    };
    let used_s = |clips: Vec<HumanClip>| {
        let db = database_of(clips, 0);
        assert_eq!(first_broken(&db), None);
        diagnostics(&db).into_iter().find_map(|found| match found {
            Diagnostic::Note(Note::BriefRestUsed { rest_s }) => Some(*rest_s),
            _ => None,
        })
    };
    let Some([first_s, last_s]) = used_s(vec![capture()]) else { panic!("no rest") };
    assert!(first_s > 3.9 && last_s < 5.3 && last_s - first_s > 0.5, "{first_s} to {last_s} s");
    assert_eq!(used_s(vec![capture(), idle("idle", 3.0)]), None);
}

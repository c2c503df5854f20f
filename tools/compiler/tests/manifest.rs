//! A manifest overrides what the compiler finds, and each of its mistakes is shown at its position.

use std::collections::BTreeSet;
use std::fs;
use std::path::{Path, PathBuf};

use motiondb::diagnostic::{Diagnostic, Unfit};
use motiondb::files::{Invalid, SourceText};
use motiondb::motion::{MotionDb, MotionExample};
use motiondb_compiler::{CompileError, Compiled, Manifest, compile_manifest};
use proptest::prelude::*;

const CLIPS: &str = concat!(env!("CARGO_MANIFEST_DIR"), "/../../assets/clips");
const SCHEMA: &str = include_str!("../../../assets/manifest.schema.json");
const ALL_KEYS: &str = include_str!("../../../fuzz/corpus/manifest/all_keys.toml");
/// Uses nothing of the folder but what further tables name.
const ONLY: &str = "[[clips]]\npath = '.'\nskip = true\n";
const LEGS: &str = "left_thigh = 'LeftUpLeg'\nleft_shank = 'LeftLeg'\nleft_foot = 'LeftFoot'\n\
                    right_thigh = 'RightUpLeg'\nright_shank = 'RightLeg'\nright_foot = 'RightFoot'\n";

/// A folder with some of the bundled clips and a manifest.
fn folder(test: &str, manifest: &str) -> PathBuf {
    let folder = Path::new(env!("CARGO_TARGET_TMPDIR")).join("manifest").join(test);
    let _ = fs::remove_dir_all(&folder);
    fs::create_dir_all(folder.join("inner")).unwrap();
    for clip in ["walk_110.bvh", "turn_090_left.bvh", "walk_140.glb", "idle.bvh"] {
        fs::copy(Path::new(CLIPS).join(clip), folder.join(clip)).unwrap();
    }
    fs::copy(Path::new(CLIPS).join("walk_180.bvh"), folder.join("inner/walk_180.bvh")).unwrap();
    fs::write(folder.join("manifest.toml"), manifest).unwrap();
    folder
}

fn compile(folder: &Path) -> Result<Compiled, CompileError> {
    compile_manifest(&Manifest::read(&folder.join("manifest.toml"))?, &|_| ())
}

fn compiled(test: &str, manifest: &str) -> MotionDb {
    let compiled = compile(&folder(test, manifest)).unwrap();
    assert!(compiled.rejected.is_empty(), "{:?}", compiled.rejected);
    compiled.db
}

fn names(db: &MotionDb) -> Vec<&str> {
    db.examples.iter().map(|example| example.name.as_str()).collect()
}

fn example<'a>(db: &'a MotionDb, name: &str) -> &'a MotionExample {
    db.examples.iter().find(|example| example.name == name).unwrap_or_else(|| panic!("no {name} in {:?}", names(db)))
}

/// Checks that a manifest is rejected at a part of its text, with a message that holds all of `words`.
#[track_caller]
fn check_rejected(test: &str, manifest: &str, part: &str, words: &[&str]) {
    let error = compile(&folder(test, manifest)).unwrap_err();
    let CompileError::InvalidManifest(invalid) = error else { panic!("{error}") };
    let Invalid { text, span, message, .. } = invalid.as_ref();
    assert_eq!(&text[span.clone()], part, "{invalid}");
    assert_eq!(invalid.line(), 1 + text[..span.start].matches('\n').count(), "{invalid}");
    for word in words {
        assert!(message.contains(word), "`{word}` is missing from: {message}");
    }
}

#[test]
fn an_empty_manifest_uses_all_below_its_folder() {
    let db = compiled("empty", "");
    assert_eq!(names(&db), ["idle", "turn_090_left", "turn_090_left_mirrored", "walk_110", "walk_140", "walk_180"]);
    let skipping =
        compiled("skipping", "[[clips]]\npath = 'inner'\nskip = true\n[[clips]]\npath = 'idle.bvh'\nskip = true\n");
    assert_eq!(names(&skipping), ["turn_090_left", "turn_090_left_mirrored", "walk_110", "walk_140"]);
}

#[test]
fn a_table_leaves_other_clips_in_use() {
    let manifest = "[[clips]]\npath = 'walk_110.bvh'\nname = 'stroll'\n\n[[clips]]\npath = './inner/walk_180.bvh'\n";
    let all = ["idle", "stroll", "turn_090_left", "turn_090_left_mirrored", "walk_140", "walk_180"];
    assert_eq!(names(&compiled("named", manifest)), all);
    let animation = format!("{ONLY}[[clips]]\npath = 'walk_140.glb'\nanimation = 'walk_140'\nname = 'march'\n");
    assert_eq!(names(&compiled("animation", &animation)), ["march"]);
}

#[test]
fn a_clip_of_the_folder_is_used_once_by_whatever_path() {
    let manifest = |path: &str| format!("[[clips]]\npath = '{path}'\nname = 'stroll'\n");
    let all = ["idle", "stroll", "turn_090_left", "turn_090_left_mirrored", "walk_140", "walk_180"];
    let over_parent = manifest("../over_parent/inner/../walk_110.bvh");
    assert_eq!(names(&compiled("over_parent", &over_parent)), all);
    let absolute = folder("absolute", "");
    fs::write(absolute.join("manifest.toml"), manifest(&absolute.join("walk_110.bvh").display().to_string())).unwrap();
    let other_spelling = Manifest::read(&absolute.join("inner/../manifest.toml")).unwrap();
    assert_eq!(names(&compile_manifest(&other_spelling, &|_| ()).unwrap().db), all);
}

#[test]
fn a_stated_name_goes_to_its_clip() {
    let manifest = "[[clips]]\npath = 'inner/walk_180.bvh'\nname = 'walk_110'\n";
    let db = compiled("taken_name", manifest);
    let speeds_mps = ["walk_110", "walk_110_2"].map(|name| example(&db, name).parameters.speed_mps);
    assert!(speeds_mps[0] > 1.7 && speeds_mps[1] < 1.2, "{speeds_mps:?}");
}

#[test]
fn the_innermost_table_decides_what_is_skipped() {
    let one = format!("{ONLY}[[clips]]\npath = 'walk_110.bvh'\nskip = false\n");
    assert_eq!(names(&compiled("only_one", &one)), ["walk_110"]);
    let inner = format!("[[clips]]\npath = 'inner'\n{ONLY}");
    assert_eq!(names(&compiled("only_inner", &inner)), ["walk_180"]);
    let but_one = "[[clips]]\npath = 'inner'\nskip = true\n[[clips]]\npath = 'inner/walk_180.bvh'\nname = 'march'\n";
    assert!(names(&compiled("but_one", but_one)).contains(&"march"));
}

#[test]
fn stated_unit_axis_and_frame_rate_count() {
    let whole = "[[clips]]\npath = '.'\nmetres_per_unit = 0.011\nup = '+Y'\nframe_rate_hz = 30.0\n";
    let own =
        "[[clips]]\npath = 'walk_110.bvh'\nframe_rate_hz = 120.0\n\n[[clips]]\npath = 'walk_140.glb'\nskip = true\n";
    let found = compiled("found", "");
    let db = compiled("stated", &format!("{whole}{own}"));
    for (name, frame_rate_hz) in [("walk_110.bvh", 120.0), ("walk_180.bvh", 30.0)] {
        let of = |db: &MotionDb| db.sources.iter().find(|source| source.file == name).unwrap().clone();
        let (stated, before) = (of(&db), of(&found));
        assert_eq!(
            (stated.metres_per_unit, stated.frame_rate_hz, stated.up_axis.as_str()),
            (0.011, frame_rate_hz, "+Y")
        );
        let wanted_mps = before.speed_mps * 1.1 * frame_rate_hz / before.frame_rate_hz;
        assert!((stated.speed_mps - wanted_mps).abs() < 0.02 * wanted_mps, "{stated:?}, not {wanted_mps}");
    }
}

#[test]
fn a_contradicted_up_axis_is_reported() {
    for clip in ["walk_110.bvh", "walk_140.glb", "idle.bvh"] {
        for up in ["+X", "-X", "-Y", "+Z", "-Z"] {
            let contradicting = format!("{ONLY}[[clips]]\npath = '{clip}'\nup = '{up}'\n");
            let error = compile(&folder("contradicting", &contradicting)).unwrap_err();
            let CompileError::NoExample { sources, .. } = error else { panic!("{error}") };
            let wanted = Unfit::UpContradicted { stated: up.to_owned(), found: "+Y".to_owned() };
            assert_eq!(sources[0].diagnostics, [Diagnostic::NoExample(wanted)]);
        }
    }
}

#[test]
fn an_inhuman_gait_gives_no_example() {
    let too_slow = "[[clips]]\npath = '.'\n[[clips]]\npath = 'walk_110.bvh'\nframe_rate_hz = 1.0\n";
    let db = compiled("impossible", too_slow);
    assert!(!names(&db).contains(&"walk_110"), "{:?}", names(&db));
    let source = db.sources.iter().find(|source| source.file == "walk_110.bvh").unwrap();
    assert!(matches!(source.diagnostics[..], [Diagnostic::NoExample(Unfit::InhumanGait { .. })]), "{source:?}");
}

#[test]
fn two_parts_of_one_capture_are_two_clips() {
    let part =
        |name: &str, frames: &str| format!("[[clips]]\npath = 'walk_110.bvh'\nname = '{name}'\nframes = {frames}\n");
    let db = compiled("parts", &format!("{ONLY}{}{}", part("second", "[20, 120]"), part("first", "[1, 100]")));
    assert_eq!(names(&db), ["first", "second"]);
    assert_eq!(db.sources.len(), 2);
}

#[test]
fn the_manifest_chooses_mirrors_m_sp_and_body() {
    let choices = "semi_procedural = 'walk_180'\ntarget_skeleton = 'walk_140'\n[[clips]]\npath = '.'\n\n";
    let none = "[[clips]]\npath = 'turn_090_left.bvh'\nmirror = false\n";
    let bigger = "[[clips]]\npath = 'walk_140.glb'\nmetres_per_unit = 1.1\n";
    let db = compiled("choices", &format!("{choices}{none}{bigger}"));
    assert_eq!(names(&db), ["idle", "turn_090_left", "walk_110", "walk_140", "walk_180"]);
    let chosen = db.correspondence.as_ref().unwrap().semi_procedural as usize;
    assert_eq!(db.examples[chosen].name, "walk_180");
    let (idle, walk) = (example(&db, "idle"), example(&db, "walk_180"));
    assert!((idle.phase_map.period_s - walk.phase_map.period_s).abs() < 1e-6, "standing takes m_sp's period");
    let shank_m = |db: &MotionDb| db.skeleton.offsets_m[motiondb::body::Joint::LeftFoot.index()].length();
    let ratio = shank_m(&db) / shank_m(&compiled("unchosen", ""));
    assert!((ratio - 1.1).abs() < 0.01, "{ratio}");
}

#[test]
fn a_joint_map_finds_the_same_body() {
    let folder = folder("map", "");
    let wanted = compile(&folder).unwrap().db;
    let map = format!("[[clips]]\npath = '.'\n[[clips]]\npath = 'walk_110.bvh'\n[clips.joints]\nneck = 'Neck'\n{LEGS}");
    fs::write(folder.join("manifest.toml"), &map).unwrap();
    assert_eq!(compile(&folder).unwrap().db, wanted);
    // Left and right exchanged by hand: the body faces backward, and so does its walk.
    let exchanged = map.replace("left_", "other_").replace("right_", "left_").replace("other_", "right_");
    fs::write(folder.join("manifest.toml"), exchanged).unwrap();
    let speed_mps = |db: &MotionDb| db.sources.iter().find(|source| source.file == "walk_110.bvh").unwrap().speed_mps;
    assert!(speed_mps(&wanted) > 1.0);
    assert!(speed_mps(&compile(&folder).unwrap().db) < 0.5);
}

#[test]
fn a_stated_facing_decides_left_and_right() {
    let walk = |test: &str, forward: &str| {
        let manifest = format!("{ONLY}[[clips]]\npath = 'walk_110.bvh'\nforward = '{forward}'\n");
        let source = compiled(test, &manifest).sources.remove(0);
        let is_warned = source.diagnostics.iter().any(|found| found.code() == "forward_against_feet");
        (source.speed_mps > 1.0, source.speed_mps < -0.5, is_warned)
    };
    assert_eq!([walk("facing", "+Z"), walk("backing", "-Z")], [(true, false, false), (false, true, true)]);
}

#[test]
fn a_scenario_in_place_of_a_manifest_is_recognised() {
    let scenario = "clips = '../clips'\nduration_s = 3\n[[agents]]\nat_m = [0, 0]\n";
    check_rejected("scenario", scenario, "agents", &["this is a scenario"]);
}

#[test]
fn mistakes_are_shown_at_their_position() {
    let one = "[[clips]]\npath = 'walk_110.bvh'\n";
    let check = |test, text: &str, part, words: &[&str]| check_rejected(test, &format!("{one}{text}"), part, words);
    check("key", "speed = 1\n", "speed", &["unknown field", "metres_per_unit"]);
    check("axis", "up = 'Q'\n", "'Q'", &["not an axis"]);
    check("frames", "frames = [1, 99999]\n", "[1, 99999]", &["walk_110.bvh", "99999", "1 to"]);
    check("backwards", "frames = [9, 3]\n", "[9, 3]", &["from frame 9 to 3"]);
    check("three", "frames = [1, 9, 3]\n", "[1, 9, 3]", &["the first and the last"]);
    check("unit", "metres_per_unit = 0.0\n", "0.0", &["metres_per_unit"]);
    check("giant", "metres_per_unit = 1.0\n", "1.0", &["with 1 m a unit", "thigh and shank"]);
    check("rate", "frame_rate_hz = nan\n", "nan", &["frame_rate_hz"]);
    check("animated", "animation = 'Run'\n", "'Run'", &["`Run`"]);
    check("facing_up", "forward = '+Y'\n", "'+Y'", &["up"]);
    check("role", "joints = { nose = 'Nose' }\n", "nose", &["left_thigh"]);
    check("joint", "joints = { neck = 'Nack' }\n", "'Nack'", &["`Nack`", "Neck"]);
    check("half", "joints = { left_foot = 'LeftFoot' }\n", "left_foot", &["left_thigh"]);
    check("twice", "joints = { neck = 'Neck', head = 'Neck' }\n", "'Neck'", &["neck", "head"]);
    let tangled = format!("[clips.joints]\n{}", LEGS.replace("'LeftFoot'", "'LeftHand'"));
    check("tangled", &tangled, "'LeftHand'", &["`LeftHand`", "`LeftLeg`"]);
    check_rejected("missing", "[[clips]]\npath = 'run.bvh'\n", "'run.bvh'", &["run.bvh"]);
    check("name", "name = \"a\\nb\"\n", "\"a\\nb\"", &["control character"]);
    check("count", "frames = [1.5, 60]\n", "1.5", &["a whole number"]);
    check_rejected("zero", "max_examples = 0\n", "0", &["from 1 on"]);
    check_rejected("whole", "[[clips]]\npath = '.'\nframes = [1, 9]\n", "[1, 9]", &["folder"]);
    check_rejected("m_sp", "semi_procedural = 'run'\n", "'run'", &["`run`", "walk_110"]);
    let window = "semi_procedural = 'walk_110@02.0s'\n";
    check_rejected("window", window, "'walk_110@02.0s'", &["no walk ahead", "walk_110"]);
    check_rejected("body", "target_skeleton = 'giant'\n", "'giant'", &["`giant`", "walk_110"]);
    check("kind", "transition = 'jump'\n", "'jump'", &["unknown value `jump`", "`start`", "`pivot`"]);
    check("no_start", "transition = 'start'\n", "'start'", &["walk_110.bvh", "no start was found"]);
    check_rejected("standing", "semi_procedural = 'idle'\n", "'idle'", &["no walk straight ahead", "m_sp"]);
}

#[test]
fn a_set_of_transitions_alone_says_what_is_missing() {
    let start = format!("{ONLY}[[clips]]\npath = 'walk_110.bvh'\ntransition = 'start'\n");
    let error = compile(&folder("transition_alone", &start)).unwrap_err().to_string();
    assert!(error.contains("walk_110.bvh: the manifest states that it shows a transition"), "{error}");
}

#[test]
fn the_schema_has_the_keys_that_are_read() {
    let schema: serde_json::Value = serde_json::from_str(SCHEMA).unwrap();
    let check = |properties: &serde_json::Value, text: &str| {
        let error = compile(&folder("schema", text)).unwrap_err().to_string();
        let (_, expected) = error.split_once("expected one of ").unwrap();
        let read: BTreeSet<&str> = expected.split('`').skip(1).step_by(2).collect();
        let shown: BTreeSet<&str> = properties.as_object().unwrap().keys().map(String::as_str).collect();
        assert_eq!(read, shown);
    };
    check(&schema["properties"], "unknown = 1\n");
    let table = &schema["properties"]["clips"]["items"]["properties"];
    check(table, "[[clips]]\npath = 'walk_110.bvh'\nunknown = 1\n");
    let roles: Vec<&String> = table["joints"]["properties"].as_object().unwrap().keys().collect();
    let mut joints = motiondb::body::Joint::ALL.map(motiondb::body::Joint::name);
    joints.sort_unstable();
    assert_eq!(roles, joints);
}

proptest! {
    #[test]
    fn a_damaged_manifest_is_rejected_within_its_text(
        damage in prop::collection::vec((any::<prop::sample::Index>(), prop::char::range(' ', '~')), 1..4),
    ) {
        let mut letters: Vec<char> = ALL_KEYS.chars().collect();
        for (index, letter) in damage {
            *index.get_mut(&mut letters) = letter;
        }
        let text: String = letters.into_iter().filter(|&letter| letter != '/').collect();
        let source = SourceText { path: PathBuf::from("/nowhere/manifest.toml"), text };
        if let Err(CompileError::InvalidManifest(invalid)) = Manifest::parse(source) {
            prop_assert!(invalid.text.get(invalid.span.clone()).is_some(), "{invalid}");
        }
    }
}

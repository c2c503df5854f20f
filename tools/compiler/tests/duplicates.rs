//! The same take twice, among clips that others made, and among the bundled ones.

use std::fs;
use std::path::{Path, PathBuf};

use motiondb::motion_db::MotionDb;
use motiondb_compiler::compile::compile_manifest;
use motiondb_compiler::duplicates::pairs;
use motiondb_compiler::human_clip::HumanClip;
use motiondb_compiler::import::{clip_files, import};
use motiondb_compiler::manifest::Manifest;

const BUNDLED: &str = concat!(env!("CARGO_MANIFEST_DIR"), "/../../assets/clips");
const MOCAP: &str = concat!(env!("CARGO_MANIFEST_DIR"), "/../../../shared/mocap");

/// Every two clips of the folder that show one take, and how: CMU subject 2 on two and three skeletons (and once with a
/// lying frame time), parts and mirror images of one walk, parts of two jumps.
const SAME_TAKES: [[&str; 3]; 12] = [
    ["02_01", "002_01", "same"],
    ["002_02", "walk", "same"],
    ["002_03", "cmu_run_filtered", "same"],
    ["002_03", "02_03_wrong_frame_time", "other times"],
    ["cmu_run_filtered", "02_03_wrong_frame_time", "other times"],
    ["walk_and_ture_right", "walk_and_turn_left", "mirrored"],
    ["walk_and_ture_right", "walk_forward", "mirrored"],
    ["walk_and_turn_left", "walk_forward", "same"],
    ["kaykit_Med_MovementBasic Rig_Medium|Jump_Full_Long", "kaykit_Med_MovementBasic Rig_Medium|Jump_Idle", "same"],
    ["kaykit_Med_MovementBasic Rig_Medium|Jump_Full_Long", "kaykit_Med_MovementBasic Rig_Medium|Jump_Land", "same"],
    ["kaykit_Med_MovementBasic Rig_Medium|Jump_Full_Long", "kaykit_Med_MovementBasic Rig_Medium|Jump_Start", "same"],
    ["kaykit_Med_MovementBasic Rig_Medium|Jump_Full_Short", "kaykit_Med_MovementBasic Rig_Medium|Jump_Land", "same"],
];

fn clips(folder: &str) -> Vec<HumanClip> {
    let files = clip_files(Path::new(folder)).unwrap_or_default();
    let imports = files.iter().filter_map(|file| import(file).ok()).flatten();
    imports.filter_map(|import| import.outcome.ok()).collect()
}

/// Names of both clips, sorted, and how they are one take.
fn found(clips: &[HumanClip]) -> Vec<[String; 3]> {
    let told = pairs(clips).into_iter().map(|pair| {
        let mut names = pair.clips.map(|clip| clips[clip].name.clone());
        names.sort();
        let how = if pair.mirrored {
            "mirrored"
        } else if pair.times_differ {
            "other times"
        } else {
            "same"
        };
        let [one, other] = names;
        [one, other, how.to_owned()]
    });
    let mut told: Vec<[String; 3]> = told.collect();
    told.sort();
    told
}

#[test]
fn among_151_clips_of_others_and_ours_only_the_same_takes_are_found() {
    let mut clips = clips(MOCAP);
    if clips.is_empty() {
        return println!(
            "SKIPPED among_151_clips_of_others_and_ours_only_the_same_takes_are_found: {MOCAP} is missing"
        );
    }
    clips.extend(self::clips(BUNDLED));
    let mut wanted = SAME_TAKES.map(|[one, other, how]| {
        let mut names = [one, other];
        names.sort_unstable();
        [names[0].to_owned(), names[1].to_owned(), how.to_owned()]
    });
    wanted.sort();
    assert_eq!(found(&clips), wanted);
}

/// A folder with a bundled clip as it is and changed, compiled.
fn compiled(test: &str, clip: &str, change: impl Fn(&str) -> String) -> MotionDb {
    let folder = Path::new(env!("CARGO_TARGET_TMPDIR")).join("duplicates").join(test);
    let _ = fs::remove_dir_all(&folder);
    fs::create_dir_all(&folder).unwrap();
    let text = fs::read_to_string(Path::new(BUNDLED).join(clip)).unwrap();
    let files: Vec<PathBuf> = ["told.bvh", "twice.bvh"].iter().map(|name| folder.join(name)).collect();
    fs::write(&files[0], &text).unwrap();
    fs::write(&files[1], change(&text)).unwrap();
    compile_manifest(&Manifest::of_files(&files), &|_| ()).unwrap().db
}

/// One of the two gives examples, and both say so.
#[track_caller]
fn check_said(db: &MotionDb, giving: &str, how: &str) {
    let names: Vec<&str> = db.examples.iter().filter(|example| !example.mirrored).map(|e| e.name.as_str()).collect();
    assert_eq!(names, [giving], "{:?}", db.sources);
    for source in &db.sources {
        let other = if source.file == "told.bvh" { "twice.bvh" } else { "told.bvh" };
        let said = format!("the same take as {other}{how}");
        let surplus = format!("no example: {said}");
        let wanted =
            if source.file.starts_with(giving) { format!("{said}; no example is made of that one") } else { surplus };
        assert!(source.warnings.contains(&wanted), "{:?} lack {wanted}", source.warnings);
    }
}

/// Every second frame, at half the rate; or every frame at that rate.
fn at_half_rate(text: &str, thinned: bool) -> String {
    let (head, motion) = text.split_once("Frame Time:").unwrap();
    let mut lines = motion.lines();
    let frame_time_s: f64 = lines.next().unwrap().trim().parse().unwrap();
    let rows: Vec<&str> = lines.step_by(if thinned { 2 } else { 1 }).collect();
    let (hierarchy, _) = head.split_once("Frames:").unwrap();
    format!("{hierarchy}Frames: {}\nFrame Time: {}\n{}\n", rows.len(), 2.0 * frame_time_s, rows.join("\n"))
}

#[test]
fn a_copy_of_a_file_gives_no_second_example() {
    check_said(&compiled("copy", "walk_110.bvh", str::to_owned), "told", "");
    check_said(&compiled("idle", "idle.bvh", str::to_owned), "told", "");
}

#[test]
fn of_two_frame_rates_the_higher_gives_the_example() {
    check_said(&compiled("thinned", "turn_060_left.bvh", |text| at_half_rate(text, true)), "told", "");
    let slowed = compiled("slowed", "walk_080.bvh", |text| at_half_rate(text, false));
    assert!(slowed.sources[0].warnings[0].contains("the same take as twice.bvh, at another frame time"));
}

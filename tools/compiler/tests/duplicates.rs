//! The same take twice, among clips that others made, and among the bundled ones.

mod support;

use std::fs;
use std::path::Path;

use motiondb::diagnostic::{Diagnostic, Unfit};
use motiondb::motion::MotionDb;
use motiondb_compiler::clip_files;
use motiondb_compiler::dedup::pairs;
use motiondb_compiler::retarget::HumanClip;
use motiondb_compiler::{Manifest, compile_manifest, import_file};
use support::mocap;

const BUNDLED: &str = concat!(env!("CARGO_MANIFEST_DIR"), "/../../assets/clips");

/// Every two clips of the folder that show one take, and how: CMU subject 2 on two and three skeletons (and once with a
/// wrong frame time), parts and mirror images of one walk, parts of two jumps.
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

fn clips(folder: &Path) -> Vec<HumanClip> {
    let files = clip_files(folder).unwrap();
    let imports = files.iter().filter_map(|file| import_file(file).ok()).flatten();
    imports.filter_map(|import| import.outcome.ok()).collect()
}

/// Names of both clips, sorted, and how they are one take.
fn found(clips: &[HumanClip]) -> Vec<[String; 3]> {
    let named = pairs(clips).into_iter().map(|pair| {
        let mut names = pair.clips.map(|clip| clips[clip].name.clone());
        names.sort();
        let how = if pair.alignment.mirrored {
            "mirrored"
        } else if pair.alignment.times_differ() {
            "other times"
        } else {
            "same"
        };
        let [one, other] = names;
        [one, other, how.to_owned()]
    });
    let mut named: Vec<[String; 3]> = named.collect();
    named.sort();
    named
}

#[test]
#[ignore = "needs other people's clips: set FBCROWD_MOCAP"]
fn only_the_same_takes_are_found() {
    let mut clips = clips(&mocap());
    clips.extend(self::clips(Path::new(BUNDLED)));
    let mut wanted = SAME_TAKES.map(|[one, other, how]| {
        let mut names = [one, other];
        names.sort_unstable();
        [names[0].to_owned(), names[1].to_owned(), how.to_owned()]
    });
    wanted.sort();
    assert_eq!(found(&clips), wanted);
}

/// A folder with two changes of a bundled clip, compiled.
fn compiled(test: &str, clip: &str, changes: [&dyn Fn(&str) -> String; 2]) -> MotionDb {
    let folder = Path::new(env!("CARGO_TARGET_TMPDIR")).join("duplicates").join(test);
    let _ = fs::remove_dir_all(&folder);
    fs::create_dir_all(&folder).unwrap();
    let text = fs::read_to_string(Path::new(BUNDLED).join(clip)).unwrap();
    let files = ["one.bvh", "other.bvh"].map(|name| folder.join(name));
    files.iter().zip(changes).for_each(|(file, change)| fs::write(file, change(&text)).unwrap());
    compile_manifest(&Manifest::of_files(&files), &|_| ()).unwrap().db
}

/// The diagnostic of a clip that another clip replaces.
fn same_take_as(other: &str, frame_times_differ: bool) -> Diagnostic {
    Diagnostic::NoExample(Unfit::SameTake { other: other.to_owned(), mirrored: false, frame_times_differ })
}

/// The second change gives the example, whichever comes first by name; the first one's record names it.
#[track_caller]
fn check_second_gives(test: &str, clip: &str, changes: [&dyn Fn(&str) -> String; 2], frame_times_differ: bool) {
    let [first, second] = changes;
    for (changes, giving, surplus) in [([first, second], "other", "one"), ([second, first], "one", "other")] {
        let db = compiled(&format!("{test}_{giving}"), clip, changes);
        let recorded = db.examples.iter().filter(|example| !example.mirrored);
        assert_eq!(recorded.map(|example| &example.name).collect::<Vec<_>>(), [giving], "{:?}", db.sources);
        let source = db.sources.iter().find(|source| source.file.starts_with(surplus)).unwrap();
        let wanted = same_take_as(&format!("{giving}.bvh"), frame_times_differ);
        assert!(source.diagnostics.contains(&wanted), "{:?} lack {wanted:?}", source.diagnostics);
    }
}

/// The head up to `Frames:`, the frame time and the rows of a file.
fn taken_apart(text: &str) -> (&str, f64, Vec<Vec<f64>>) {
    let (hierarchy, motion) = text.split_once("Frames:").unwrap();
    let mut lines = motion.lines().skip(1);
    let (_, frame_time) = lines.next().unwrap().split_once(':').unwrap();
    let values = |line: &str| line.split_whitespace().map(|value| value.parse().unwrap()).collect();
    (hierarchy, frame_time.trim().parse().unwrap(), lines.map(values).collect())
}

fn written(hierarchy: &str, frame_time_s: f64, rows: &[Vec<f64>]) -> String {
    let line = |row: &Vec<f64>| row.iter().map(f64::to_string).collect::<Vec<String>>().join(" ");
    let lines: Vec<String> = rows.iter().map(line).collect();
    format!("{hierarchy}Frames: {}\nFrame Time: {frame_time_s}\n{}\n", rows.len(), lines.join("\n"))
}

/// Every second frame, at half the rate.
fn thinned(text: &str) -> String {
    let (hierarchy, frame_time_s, rows) = taken_apart(text);
    written(hierarchy, 2.0 * frame_time_s, &rows.into_iter().step_by(2).collect::<Vec<_>>())
}

/// Every frame, at half the rate: twice as long.
fn slowed(text: &str) -> String {
    let (hierarchy, frame_time_s, rows) = taken_apart(text);
    written(hierarchy, 2.0 * frame_time_s, &rows)
}

/// The same steps on the spot, or up a slope of a twentieth.
fn moved(text: &str, travels: f64, climbs: f64) -> String {
    let (hierarchy, frame_time_s, mut rows) = taken_apart(text);
    let last = rows.len() - 1;
    let way = [0, 2].map(|channel| rows[last][channel] - rows[0][channel]);
    let length = libm::hypot(way[0], way[1]);
    for (frame, row) in rows.iter_mut().enumerate() {
        let along = frame as f64 / last as f64;
        row[0] -= (1.0 - travels) * along * way[0];
        row[2] -= (1.0 - travels) * along * way[1];
        row[1] += climbs * along * length;
    }
    written(hierarchy, frame_time_s, &rows)
}

#[test]
fn a_copy_of_a_file_gives_no_second_example() {
    for clip in ["walk_110.bvh", "idle.bvh"] {
        let db = compiled(&format!("copy_{clip}"), clip, [&str::to_owned, &str::to_owned]);
        assert_eq!(db.examples.iter().filter(|example| !example.mirrored).count(), 1, "{:?}", db.sources);
        assert_eq!(db.sources[1].diagnostics, [same_take_as("one.bvh", false)]);
    }
}

#[test]
fn the_higher_frame_rate_gives_the_example() {
    check_second_gives("thinned", "turn_060_left.bvh", [&thinned, &str::to_owned], false);
}

#[test]
fn the_frame_time_of_a_human_gait_gives_the_example() {
    for clip in ["walk_110.bvh", "walk_180.bvh", "run_350.bvh", "side_060_left.bvh"] {
        check_second_gives(&format!("slowed_{clip}"), clip, [&slowed, &str::to_owned], true);
    }
}

#[test]
fn a_level_walk_beats_its_treadmill_or_slope_copy() {
    let in_place = |text: &str| moved(text, 0.0, 0.0);
    let uphill = |text: &str| moved(text, 1.0, 0.05);
    check_second_gives("in_place", "walk_110.bvh", [&in_place, &str::to_owned], false);
    check_second_gives("uphill", "walk_110.bvh", [&uphill, &str::to_owned], false);
}

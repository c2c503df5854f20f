//! Long captures give an example of each of their steady windows, with the parameters of its seconds (real clips, test
//! input only; `windows.csv` holds independently measured parameters of each second).

mod support;

use motiondb::motion::{MotionDb, MotionExample};
use motiondb_compiler::compile_files;
use support::mocap;

/// Shorter windows say little about the seconds that they lie in.
const WINDOW_MIN_S: f32 = 1.9;
/// An example may differ from the mean of its seconds, which are unsmoothed and begin and end elsewhere in the stride:
/// m/s, °/s, m/s.
const LIMITS: [f32; 3] = [0.1, 12.0, 0.1];

/// The database of one clip.
fn compiled(file: &str) -> MotionDb {
    compile_files(&[mocap().join(file)], &|_| ()).unwrap().db
}

fn recorded(db: &MotionDb) -> Vec<&MotionExample> {
    db.examples.iter().filter(|example| !example.mirrored).collect()
}

/// v_f (m/s), ω_t (°/s), ω_s (m/s) of each second of a clip.
fn seconds(file: &str) -> Vec<[f32; 3]> {
    let text = std::fs::read_to_string(mocap().join("windows.csv")).unwrap();
    let rows = text.lines().filter(|line| line.starts_with(file));
    let values = |row: &str| row.split(',').skip(2).map(|value| value.parse::<f32>().unwrap()).collect::<Vec<f32>>();
    rows.map(|row| values(row).try_into().unwrap()).collect()
}

/// The mean of the seconds that a window overlaps, weighted by the overlap.
fn mean_of(seconds: &[[f32; 3]], [start_s, end_s]: [f32; 2]) -> [f32; 3] {
    let (mut sum, mut weight) = ([0.0; 3], 0.0);
    for (second, values) in seconds.iter().enumerate() {
        let overlap = (end_s.min(second as f32 + 1.0) - start_s.max(second as f32)).max(0.0);
        weight += overlap;
        sum.iter_mut().zip(values).for_each(|(sum, value)| *sum += overlap * value);
    }
    sum.map(|sum| sum / weight)
}

#[test]
#[ignore = "needs other people's clips: set FBCROWD_MOCAP"]
fn windows_agree_with_their_seconds() {
    let files = [
        "lafan1_skeleton/egg_walking.bvh",
        "bandai_namco/dataset-1_walk_normal_001.bvh",
        "bandai_namco/dataset-1_walk-back_active_001.bvh",
        "bandai_namco/dataset-1_walk-left_masculinity_001.bvh",
        "bandai_namco/dataset-2_walk_active_001.bvh",
        "bandai_namco/dataset-2_walk-turn-left_masculine_001.bvh",
    ];
    for file in files {
        let db = compiled(file);
        let (examples, seconds) = (recorded(&db), seconds(file));
        let long = examples.iter().filter(|e| e.window_s[1] - e.window_s[0] > WINDOW_MIN_S);
        for example in long {
            let found = example.parameters;
            let found = [found.speed_mps, found.turn_rate_rad_s.to_degrees(), found.strafe_mps];
            let wanted = mean_of(&seconds, example.window_s);
            let near =
                found.iter().zip(wanted).zip(LIMITS).all(|((found, wanted), limit)| (found - wanted).abs() < limit);
            assert!(near, "{} {:?}: {found:?}, not {wanted:?}", example.name, example.window_s);
        }
        assert!(examples.iter().any(|e| e.window_s[1] - e.window_s[0] > WINDOW_MIN_S), "{file}: {examples:?}");
    }
}

#[test]
#[ignore = "needs other people's clips: set FBCROWD_MOCAP"]
fn a_capture_of_changing_speed_gives_a_rich_set() {
    let db = compiled("pfnn/LocomotionFlat04_000.bvh");
    let examples = recorded(&db);
    assert!(examples.len() >= 5, "{examples:#?}");
    assert!(examples.iter().any(|example| example.name == "LocomotionFlat04_000"));
    for (index, example) in examples.iter().enumerate() {
        let [start_s, end_s] = example.window_s;
        assert!(start_s >= 0.0 && end_s <= 20.24 && end_s - start_s > 0.4, "{example:?}");
        let own = example.name == "LocomotionFlat04_000";
        assert!(own || example.name == format!("LocomotionFlat04_000@{start_s:04.1}s"), "{example:?}");
        let apart = |other: &&&MotionExample| other.window_s[0] >= end_s - 0.05 || other.window_s[1] <= start_s + 0.05;
        assert_eq!(examples.iter().filter(apart).count(), examples.len() - 1, "window {index} overlaps another");
        assert!(example.planted_slide_cm_s < 12.0 + 8.0 * example.parameters.speed_mps, "{example:?}");
    }
    let rates = || examples.iter().map(|example| example.parameters.turn_rate_rad_s.to_degrees());
    let speeds = || examples.iter().map(|example| example.parameters.speed_mps);
    assert!(rates().fold(f32::INFINITY, f32::min) < -150.0 && rates().fold(0.0, f32::max) > 120.0, "{examples:#?}");
    assert!(speeds().fold(f32::INFINITY, f32::min) < 0.6 && speeds().fold(0.0, f32::max) > 1.6, "{examples:#?}");
}

#[test]
#[ignore = "needs other people's clips: set FBCROWD_MOCAP"]
fn every_window_of_a_turning_walk_is_found() {
    let db = compiled("lafan1_skeleton/egg_walking.bvh");
    let near = |turn_deg_s: f32| {
        let turns = recorded(&db).into_iter().map(|example| example.parameters.turn_rate_rad_s.to_degrees());
        turns.into_iter().any(|found| (found - turn_deg_s).abs() < 12.0)
    };
    assert!([87.0, -85.0, -126.0, -192.0, 119.0, 10.0].into_iter().all(near), "{:#?}", db.examples);
}

//! The paper's own database: twelve recordings of `SmartBody`'s `ChrMarine`, nineteen examples (`FbCrowd` §6; Shapiro
//! 2011; test input only).

mod support;

use std::collections::BTreeSet;
use std::path::PathBuf;

use motiondb::body::Pose;
use motiondb::motion::{MotionDb, MotionExample, PHASE_COUNT};
use motiondb::validate::validate;
use motiondb_compiler::compile_files;
use support::mocap;

/// v_f (m/s), ω_t (°/s), ω_s (m/s) of each recording as measured by others, on the whole clip.
const TABLE: [(&str, [f32; 3]); 12] = [
    ("Idle01", [0.0, 0.0, 0.0]),
    ("Meander01", [0.844, -1.1, 0.005]),
    ("Walk01", [1.104, -0.9, -0.002]),
    ("Jog01", [2.098, -5.3, -0.085]),
    ("Run01", [3.889, -6.5, 0.001]),
    ("WalkCircleRt01", [0.787, -46.5, -0.048]),
    ("WalkTightCircleRt01", [0.518, -97.2, 0.036]),
    ("RunCircleRt01", [2.282, -79.3, 0.029]),
    ("RunTightCircleRt01", [1.661, -149.8, 0.027]),
    ("Turn360Rt01", [0.185, -167.7, 0.091]),
    ("StrafeSlowRt01", [0.016, 0.4, -0.345]),
    ("StrafeFastRt01", [0.941, 0.1, -1.808]),
];

/// Planted-foot slide of the recordings by an independent script, cm/s, and what an example may slide more: the script
/// trims short contacts by whole frames.
const SLIDES_CM_S: [(&str, f32); 11] = [
    ("Turn360Rt01", 1.7),
    ("Meander01", 2.6),
    ("StrafeSlowRt01", 3.5),
    ("Walk01", 3.6),
    ("WalkTightCircleRt01", 3.9),
    ("WalkCircleRt01", 4.0),
    ("RunCircleRt01", 6.5),
    ("RunTightCircleRt01", 9.7),
    ("StrafeFastRt01", 12.4),
    ("Jog01", 15.6),
    ("Run01", 28.3),
];
const SLIDE_RATIO: f32 = 1.15;

fn files() -> Vec<PathBuf> {
    let folder = mocap().join("smartbody_converted");
    TABLE.iter().map(|(name, _)| folder.join(format!("ChrMarine_{name}.bvh"))).collect()
}

/// The database.
fn marine() -> MotionDb {
    let compiled = compile_files(&files(), &|_| ()).unwrap();
    assert!(compiled.rejected.is_empty(), "{:?}", compiled.rejected);
    compiled.db
}

fn example<'a>(db: &'a MotionDb, name: &str) -> &'a MotionExample {
    let name = format!("ChrMarine_{name}");
    db.examples.iter().find(|example| example.name == name).unwrap_or_else(|| panic!("{name} gave no example"))
}

/// [`TABLE`]'s units.
fn rates(example: &MotionExample) -> [f32; 3] {
    let found = example.parameters;
    [found.speed_mps, found.turn_rate_rad_s.to_degrees(), found.strafe_mps]
}

fn check_near(name: &str, found: [f32; 3], wanted: [f32; 3], limits: [f32; 3]) {
    for ((found, wanted), limit) in found.into_iter().zip(wanted).zip(limits) {
        assert!((found - wanted).abs() <= limit, "{name}: {found}, not {wanted} ± {limit}");
    }
}

#[test]
#[ignore = "needs other people's clips: set FBCROWD_MOCAP"]
fn twelve_recordings_give_the_papers_nineteen_examples() {
    let db = marine();
    assert_eq!(db.examples.len(), 19);
    let mirrored: BTreeSet<&str> = db.examples.iter().filter(|e| e.mirrored).map(|e| e.name.as_str()).collect();
    let turning = TABLE.iter().filter(|(name, _)| name.ends_with("Rt01"));
    let wanted: BTreeSet<String> = turning.map(|(name, _)| format!("ChrMarine_{name}_mirrored")).collect();
    assert_eq!(mirrored, wanted.iter().map(String::as_str).collect());
}

#[test]
#[ignore = "needs other people's clips: set FBCROWD_MOCAP"]
fn the_database_keeps_every_invariant() {
    let db = marine();
    for check in validate(&db) {
        assert_eq!(check.broken, None, "{}", check.name);
    }
}

#[test]
#[ignore = "needs other people's clips: set FBCROWD_MOCAP"]
fn parameters_are_those_of_the_table() {
    let db = marine();
    for (name, [speed, turn, strafe]) in TABLE {
        let limits = [(0.08 * speed.abs()).max(0.08), 8.0, (0.08 * strafe.abs()).max(0.1)];
        check_near(name, rates(example(&db, name)), [speed, turn, strafe], limits);
    }
}

#[test]
#[ignore = "needs other people's clips: set FBCROWD_MOCAP"]
fn sources_are_those_of_the_table() {
    let db = marine();
    for (name, [speed, turn, strafe]) in TABLE {
        let file = format!("ChrMarine_{name}.bvh");
        let source = db.sources.iter().find(|source| source.file == file).unwrap();
        let found = [source.speed_mps, source.turn_rate_rad_s.to_degrees(), source.strafe_mps];
        let limits = [(0.03 * speed.abs()).max(0.03), 3.0, (0.03 * strafe.abs()).max(0.04)];
        check_near(name, found, [speed, turn, strafe], limits);
    }
}

#[test]
#[ignore = "needs other people's clips: set FBCROWD_MOCAP"]
fn gait_noise_is_no_turning() {
    let db = marine();
    for name in ["Meander01", "Walk01", "Jog01", "Run01"] {
        let [_, turn, strafe] = rates(example(&db, name));
        assert_eq!([turn, strafe], [0.0, 0.0], "{name}");
    }
}

#[test]
#[ignore = "needs other people's clips: set FBCROWD_MOCAP"]
fn mirrors_negate_rates_and_shift_half_cycle() {
    let db = marine();
    for mirror in db.examples.iter().filter(|example| example.mirrored) {
        let original = example(&db, mirror.name.trim_start_matches("ChrMarine_").trim_end_matches("_mirrored"));
        assert_eq!(mirror.parameters, original.parameters.mirrored());
        assert_eq!(mirror.planted_share, original.planted_share);
        assert!((mirror.planted_slide_cm_s - original.planted_slide_cm_s).abs() < 0.2, "{}", mirror.name);
        let ([right_off, ..], [.., left_off, _]) = (mirror.key_times_s.unwrap(), original.key_times_s.unwrap());
        let period_s = original.phase_map.period_s;
        let off_s = right_off - (left_off - original.phase_map.left_share * period_s);
        assert!((off_s / period_s - (off_s / period_s).round()).abs() < 0.01, "{}: {off_s} s", mirror.name);
    }
}

#[test]
#[ignore = "needs other people's clips: set FBCROWD_MOCAP"]
fn planted_feet_slide_no_more_than_in_the_recordings() {
    let db = marine();
    for (name, slide_cm_s) in SLIDES_CM_S {
        let found = example(&db, name);
        assert!(found.planted_slide_cm_s <= SLIDE_RATIO * slide_cm_s, "{name}: {} cm/s", found.planted_slide_cm_s);
        let shares =
            if found.parameters.speed_mps > 1.5 || name == "StrafeFastRt01" { 0.28..=0.45 } else { 0.45..=0.7 };
        assert!(shares.contains(&found.planted_share), "{name}: planted for {}", found.planted_share);
    }
}

#[test]
#[ignore = "needs other people's clips: set FBCROWD_MOCAP"]
fn slide_is_measured_at_heel_joint() {
    let db = marine();
    for foot in &db.skeleton.feet {
        let heel_m = foot.measured_m[0];
        assert!((-0.12..-0.05).contains(&heel_m.z), "{heel_m} is no heel");
        assert!(foot.heel_m.z < heel_m.z && foot.heel_m.x < -0.03, "{foot:?}");
    }
}

#[test]
#[ignore = "needs other people's clips: set FBCROWD_MOCAP"]
fn feet_are_under_the_body_at_their_mid_stance() {
    let db = marine();
    for (index, example) in db.examples.iter().enumerate().filter(|(_, example)| example.key_times_s.is_some()) {
        for (phase, side) in [(0, 1), (PHASE_COUNT / 2, 0)] {
            let row = index * PHASE_COUNT + phase;
            let pose = Pose { pelvis_m: db.rows.pelvis_m[row], rotations: *db.rows.rotations(index, phase) };
            let soles = pose.forward_kinematics(&db.skeleton).sole_points_m(&db.skeleton, side);
            let along = soles[1].truncate().dot(travel(example));
            assert!(db.rows.contacts[row][side] > 0.5, "{}: side {side} is not planted", example.name);
            assert!(along.abs() < 0.25, "{}: side {side} is {along} m ahead", example.name);
            // Runners stand on the ball of the foot, the heel lifted.
            let [heel, ball, toe_tip] = soles.map(|sole| sole.z.abs());
            assert!(ball.max(toe_tip) < 0.05 && heel < 0.1, "{}: side {side} at {soles:?}", example.name);
        }
    }
}

/// Unit vector of an example's motion in the root frame.
fn travel(example: &MotionExample) -> glam::Vec2 {
    example.parameters.velocity_mps().normalize_or(glam::Vec2::X)
}

#[test]
#[ignore = "needs other people's clips: set FBCROWD_MOCAP"]
fn idle_has_the_base_walks_period() {
    let db = marine();
    let correspondence = db.correspondence.as_ref().unwrap();
    let walk = &db.examples[correspondence.semi_procedural as usize];
    assert_eq!(walk.name, "ChrMarine_Walk01");
    assert_eq!(db.examples[correspondence.blending as usize].name, "ChrMarine_Meander01");
    let idle = example(&db, "Idle01");
    assert_eq!((idle.key_times_s, idle.planted_share), (None, 1.0));
    assert_eq!(idle.phase_map.period_s, walk.phase_map.period_s);
    assert!(idle.planted_slide_cm_s < 0.1, "{}", idle.planted_slide_cm_s);
}

#[test]
#[ignore = "needs other people's clips: set FBCROWD_MOCAP"]
fn both_steps_of_the_walk_have_a_correspondence() {
    let db = marine();
    let found = db.correspondence.as_ref().unwrap();
    let map = db.examples[found.semi_procedural as usize].phase_map;
    let first = found.pairs_s.iter().filter(|pair| map.phase(pair[0]) < 0.5).count();
    assert!(first > 0 && first < found.pairs_s.len(), "{:?}", found.pairs_s);
}

#[test]
#[ignore = "needs other people's clips: set FBCROWD_MOCAP"]
fn bytes_are_independent_of_folder_and_threads() {
    let mut files = files();
    let compiled = |files: &[PathBuf]| compile_files(files, &|_| ()).unwrap().db;
    let folder = std::env::temp_dir().join(format!("fbcrowd-marine-{}", std::process::id()));
    std::fs::create_dir_all(&folder).unwrap();
    let copies: Vec<PathBuf> = files.iter().map(|file| folder.join(file.file_name().unwrap())).collect();
    for (file, copy) in files.iter().zip(&copies) {
        std::fs::copy(file, copy).unwrap();
    }
    files.reverse();
    let one_thread = rayon::ThreadPoolBuilder::new().num_threads(1).build().unwrap();
    let (here, there) = (compiled(&files), one_thread.install(|| compiled(&copies)));
    std::fs::remove_dir_all(&folder).unwrap();
    assert!(motiondb::files::database_file::to_bytes(&here) == motiondb::files::database_file::to_bytes(&there));
}

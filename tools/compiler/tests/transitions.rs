//! Claims about the transitions of other people's clips.

mod support;

use glam::Vec2;
use motiondb::motion::{Action, ActionKind, MotionDb};
use motiondb::quality::action_quality;
use motiondb::validate::first_broken;
use motiondb_compiler::compile_files;
use support::mocap;

/// Kind, displacement (m: forward, left) and turn (°) of each recorded transition of the Marine set: of the midpoint of
/// the source's hips, seen along its facing, over the stored window, by a script of others.
const MARINE: [(&str, ActionKind, [f32; 2], f32); 7] = [
    ("Idle01_ToWalk01", ActionKind::Start, [0.698, 0.009], 4.5),
    ("Walk01_ToIdle01", ActionKind::Stop, [0.853, -0.065], -2.3),
    ("Turn90Rt01", ActionKind::Turn, [0.018, 0.036], -91.4),
    ("Turn180Rt01", ActionKind::Turn, [0.066, -0.364], -182.4),
    ("Idle01_StepForwardRt01", ActionKind::Step, [0.522, -0.006], 1.6),
    ("Idle01_StepBackwardsRt01", ActionKind::Step, [-0.352, -0.004], 0.0),
    ("Idle01_StepSidewaysRt01", ActionKind::Step, [0.001, -0.237], -2.0),
];
/// Greatest difference of a displacement: the hips sway, the root does not, m.
const SWAY_M: f32 = 0.04;
/// Greatest difference of a turn: hips and shoulders turn with each step, the root does not, degrees.
const SWAY_DEG: f32 = 4.0;

/// The database of the clips in a folder.
fn database(folder: &str) -> MotionDb {
    let entries = mocap().join(folder).read_dir().unwrap().map(|entry| entry.unwrap().path());
    let mut files: Vec<_> = entries.filter(|path| path.extension().is_some_and(|kind| kind == "bvh")).collect();
    files.sort();
    let db = compile_files(&files, &|_| ()).unwrap().db;
    assert_eq!(first_broken(&db), None);
    db
}

fn transitions(db: &MotionDb) -> Vec<&Action> {
    db.actions.iter().filter(|action| action.kind != ActionKind::Idle).collect()
}

#[test]
#[ignore = "needs other people's clips: set FBCROWD_MOCAP"]
fn every_marine_transition_is_found_and_travels_as_its_source() {
    let db = database("smartbody_converted");
    assert_eq!(transitions(&db).len(), 2 * MARINE.len());
    for (name, kind, displacement_m, turn_deg) in MARINE {
        let source = format!("ChrMarine_{name}.bvh");
        let of_source = transitions(&db).into_iter().filter(|action| db.sources[action.source as usize].file == source);
        let [recorded, mirror] = of_source.collect::<Vec<_>>()[..] else { panic!("{name}") };
        for (action, side) in [(recorded, 1.0), (mirror, -1.0)] {
            let wanted_m = Vec2::new(displacement_m[0], side * displacement_m[1]);
            let (moved_m, turned_deg) = (action.displacement_m(), action.turn_rad().to_degrees());
            assert_eq!((action.kind, action.mirrored), (kind, side < 0.0), "{name}");
            assert!(moved_m.distance(wanted_m) < SWAY_M, "{name}: {moved_m}, not {wanted_m}");
            assert!((turned_deg - side * turn_deg).abs() < SWAY_DEG, "{name}: {turned_deg}°, not {turn_deg}°");
            assert_eq!(action_quality::findings(&db, action), [], "{name}");
        }
    }
}

#[test]
#[ignore = "needs other people's clips: set FBCROWD_MOCAP"]
fn marine_starts_and_stops_meet_the_walk_and_the_idle() {
    let db = database("smartbody_converted");
    for action in transitions(&db) {
        let names = [action.entry, action.exit].map(|end| db.examples[end.example as usize].name.as_str());
        let wanted = match action.kind {
            ActionKind::Start => ["ChrMarine_Idle01", "ChrMarine_Walk01"],
            ActionKind::Stop => ["ChrMarine_Walk01", "ChrMarine_Idle01"],
            _ => ["ChrMarine_Idle01"; 2],
        };
        assert_eq!(names, wanted, "{}", action.name);
    }
}

#[test]
#[ignore = "needs other people's clips: set FBCROWD_MOCAP"]
fn corners_of_walks_are_pivots() {
    let db = database("games105");
    let found: Vec<(f32, bool)> = transitions(&db)
        .iter()
        .filter(|action| action.kind == ActionKind::Pivot)
        .map(|pivot| (pivot.turn_rad().to_degrees(), pivot.mirrored))
        .collect();
    for side in [-1.0, 1.0] {
        assert!(
            found.iter().any(|(turn_deg, mirrored)| !mirrored && (side * turn_deg - 85.0).abs() < 12.0),
            "{found:?}"
        );
    }
}

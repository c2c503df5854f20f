//! Claims about size and time: bodies of children and giants keep their unit, and a doubtful unit or frame time is
//! reported.

mod zoo {
    #![allow(dead_code, reason = "shared with the zoo's own tests")]
    pub(crate) mod body;
    pub(crate) mod file;
    pub(crate) mod names;
    pub(crate) mod rig;
}

mod support;

use std::fs;
use std::path::Path;

use glam::DQuat;
use motiondb::diagnostic::{Diagnostic, Warning};
use motiondb_compiler::{HumanClip, import_bytes, import_file};
use support::mocap;
use zoo::body::{Performance, part};
use zoo::file::{self, File};
use zoo::names::tools;
use zoo::rig::{self, Rest};

/// The bundled walk by a performer with legs of this length, as a file in this unit.
fn walk(leg_m: f64, units_per_m: f64) -> HumanClip {
    performed(&Performance::read("walk_110"), leg_m, units_per_m)
}

/// A motion by a performer with legs of this length, as a file in this unit.
fn performed(body: &Performance, leg_m: f64, units_per_m: f64) -> HumanClip {
    let adult_m: f64 = ["LeftLeg", "LeftFoot"].map(|name| body.offsets_m[part(name)].length()).into_iter().sum();
    let rig = rig::build(body, &tools()[0], &[], Rest::TPose, || DQuat::IDENTITY);
    let file = File::plain(units_per_m, leg_m / adult_m);
    let text = file::write(body, &rig, &file);
    import_bytes(Path::new("walk.bvh"), text.as_bytes()).unwrap().remove(0).outcome.unwrap()
}

/// Checks the leg length that is found, and whether the report calls the unit doubtful.
#[track_caller]
fn check(leg_m: f64, units_per_m: f64, is_doubtful: bool) {
    let clip = walk(leg_m, units_per_m);
    let found_m = clip.body.leg_length_m();
    assert!((found_m / leg_m - 1.0).abs() < 0.03, "{found_m} m, not {leg_m} m, of {units_per_m} units a metre");
    let is_warning = |found: &Diagnostic| matches!(found, Diagnostic::Warning(Warning::UnitDoubtful { .. }));
    let warns = clip.source.diagnostics.iter().any(is_warning);
    assert_eq!(warns, is_doubtful, "{leg_m} m, {units_per_m} units a metre: {:?}", clip.source.diagnostics);
}

#[test]
fn a_child_in_centimetres_is_not_read_as_inches() {
    check(0.39, 100.0, true);
    check(0.40, 100.0, true);
    check(0.55, 100.0, false);
}

#[test]
fn a_giant_is_not_read_as_a_tenth() {
    // Its cadence leaves no doubt; the size has a warning of its own.
    check(2.4, 1.0, false);
    check(2.4, 100.0, false);
}

#[test]
fn adults_keep_their_unit() {
    for units_per_m in [1.0, 100.0, 1000.0] {
        check(0.84, units_per_m, false);
    }
    check(0.90, 1.0 / 0.0254, true);
}

#[test]
fn slow_motion_is_doubtful() {
    let is_doubtful = |slowness: f64| {
        let walk = Performance::read("walk_110");
        let slowed = Performance { frame_rate_hz: walk.frame_rate_hz / slowness, ..walk };
        let is_warning = |found: &Diagnostic| matches!(found, Diagnostic::Warning(Warning::FrameTimeDoubtful { .. }));
        performed(&slowed, 0.84, 100.0).source.diagnostics.iter().any(is_warning)
    };
    assert!(is_doubtful(2.0));
    assert!(!is_doubtful(1.0));
}

#[test]
#[ignore = "needs other people's clips: set FBCROWD_MOCAP"]
fn clips_of_others_keep_their_unit() {
    let index = fs::read_to_string(mocap().join("index.csv")).unwrap();
    let mut compared = 0;
    for row in index.lines().skip(1) {
        // Cells before the format may hold commas. A unit that a format states, as glTF does, is not chosen.
        let cells: Vec<&str> = row.split(',').collect();
        let Some(format) = cells.iter().position(|cell| *cell == "bvh") else { continue };
        let (file, Ok(unit_m)) = (cells[0], cells[format + 8].parse::<f32>()) else { continue };
        let Ok(imports) = import_file(&mocap().join(file)) else { continue };
        for human in imports.into_iter().filter_map(|import| import.outcome.ok()) {
            let found_m = human.source.metres_per_unit;
            assert!((found_m / unit_m - 1.0).abs() < 0.05, "{file}: {found_m} m a unit, not {unit_m}");
            compared += 1;
        }
    }
    assert!(compared >= 70, "{compared}");
}

//! A body written in code, in BVH and in glTF: every spelling of one file reads alike.

use std::path::Path;

use motiondb::diagnostic::{Diagnostic, Warning};

use super::written_body::{FRAMES, bvh_text, gltf_text};
use super::{import_bytes, only};

#[track_caller]
fn check_walks(clip: &super::HumanClip) {
    let record = &clip.source;
    assert!((record.speed_mps - 1.2).abs() < 0.01 && record.turn_rate_rad_s.abs() < 0.01, "{record:?}");
    assert_eq!(record.up_axis, "+Y");
}

#[test]
fn every_spelling_of_a_bvh_reads_alike() {
    let plain = bvh_text();
    let expected = only(import_bytes(Path::new("walk.bvh"), plain.as_bytes()));
    check_walks(&expected);
    assert_eq!(expected.source.metres_per_unit, 0.01);
    let spellings = [
        plain.replace('\n', "\r\n"),
        plain.replace('\n', "\r"),
        format!("\u{feff}{plain}"),
        plain.replace(' ', "\t").replace("Left\tArm", "Left Arm").replace("Frame\tTime:", "Frame Time:"),
        plain.replace("\n{", " {"),
        plain.replace("Frames: 40", "Frames :40").replace("rotation", "ROTATION"),
        plain.trim_end().to_owned(),
        plain.replace(" 92 ", " 9.2e1 "),
    ];
    for (index, spelling) in spellings.iter().enumerate() {
        let found = only(import_bytes(Path::new("walk.bvh"), spelling.as_bytes()));
        assert_eq!(found.frames, expected.frames, "spelling {index}");
    }
}

#[test]
fn wrong_counts_are_reported_and_all_rows_used() {
    for wrong in ["Frames: 99999999999999", "Frames: 3", "Frames: 1e7"] {
        let text = bvh_text().replace("Frames: 40", wrong);
        let clip = only(import_bytes(Path::new("walk.bvh"), text.as_bytes()));
        assert_eq!(clip.frames.len(), FRAMES);
        let is_wrong = |found: &Diagnostic| matches!(found, Diagnostic::Warning(Warning::FrameCountWrong { .. }));
        assert!(is_wrong(&clip.source.diagnostics[0]), "{:?}", clip.source.diagnostics);
    }
    let cut = bvh_text();
    let clip = only(import_bytes(Path::new("walk.bvh"), &cut.as_bytes()[..cut.len() - 20]));
    assert_eq!(clip.frames.len(), FRAMES - 1);
}

#[test]
fn malformed_bvh_is_rejected_at_its_line() {
    let check = |from: &str, to: &str, line: usize| {
        let text = bvh_text().replacen(from, to, 1);
        let message = import_bytes(Path::new("walk.bvh"), text.as_bytes()).unwrap_err().to_string();
        assert!(message.starts_with(&format!("walk.bvh: line {line}: ")), "{from} → {to}: {message}");
    };
    check("OFFSET 9 -4 0", "OFFSET 9 -4", 8);
    check("OFFSET 9 -4 0", "OFFSET 9 nan 0", 8);
    check("CHANNELS 6", "CHANNELS 5", 5);
    check("ROOT Hips", "ROOT Hips\nROOT Hips", 3);
    check("Zrotation", "Wrotation", 5);
    for frame_time in ["0", "-1", "1e-9", "nan", "100", "1e30"] {
        let line = format!("Frame Time: {frame_time}");
        check("Frame Time: 0.0333333333", &line, bvh_text().lines().count() - FRAMES);
    }
    check("CHANNELS 6", &format!("{}CHANNELS 6", "End Site\n{\n}\n".repeat(5000)), 4 + 3 * 4095 + 1);
}

#[test]
fn decimal_commas_are_reported() {
    for (point, comma) in [("OFFSET 9", "OFFSET 9,0"), ("0.0333333333", "0,0333333333")] {
        let text = bvh_text().replacen(point, comma, 1);
        let message = import_bytes(Path::new("walk.bvh"), text.as_bytes()).unwrap_err().to_string();
        assert!(message.ends_with("write numbers with points, not commas"), "{message}");
    }
}

#[test]
fn blank_lines_are_skipped_but_counted() {
    let text = format!("HIERARCHY{}nonsense", "\n".repeat(10_000_000));
    let message = import_bytes(Path::new("blank.bvh"), text.as_bytes()).unwrap_err().to_string();
    assert!(message.starts_with("blank.bvh: line 10000001: "), "{message}");
}

#[test]
fn gltf_reads_as_bvh_does_with_every_interpolation() {
    let expected = only(import_bytes(Path::new("walk.bvh"), bvh_text().as_bytes()));
    for interpolation in ["LINEAR", "STEP", "CUBICSPLINE"] {
        let clip = only(import_bytes(Path::new("walk.gltf"), gltf_text(interpolation).as_bytes()));
        check_walks(&clip);
        assert_eq!(clip.frames.len(), FRAMES);
        for (found, wanted) in clip.frames.iter().zip(&expected.frames) {
            assert!(
                (found.pelvis_m - wanted.pelvis_m).length() < 1e-5,
                "{interpolation}: {} {}",
                found.pelvis_m,
                wanted.pelvis_m
            );
        }
    }
}

#[test]
fn gltf_with_missing_bytes_is_rejected() {
    let check = |from: &str, to: &str| {
        let text = gltf_text("LINEAR").replacen(from, to, 1);
        assert!(import_bytes(Path::new("walk.gltf"), text.as_bytes()).is_err(), "{from} → {to}");
    };
    check(r#""count":40"#, r#""count":4000000000000"#);
    check(r#""byteOffset":160"#, r#""byteOffset":18446744073709551000"#);
    check(r#""byteLength":"#, r#""byteLength":9"#);
    check(r#""children":[1"#, r#""children":[0"#);
    check("data:application/octet-stream;base64,", "nowhere.bin?");
    check(r#""componentType":5126"#, r#""componentType":5123"#);
}

//! A walker in BVH and in glTF: every spelling of its file reads alike, and no mutation of it panics.

use std::fmt::Write as _;
use std::path::Path;

use base64::Engine;
use motiondb::diagnostic::{Diagnostic, Warning};
use motiondb_compiler::mutation::{Edit, mutated};
use proptest::prelude::*;

use super::{import_bytes, only};

/// Name, parent, offset in centimetres: a stiff-hipped walker of 19 joints.
const BODY: [(&str, usize, [f64; 3]); 19] = [
    ("Hips", 0, [0.0, 92.0, 0.0]),
    ("LeftUpLeg", 0, [9.0, -4.0, 0.0]),
    ("LeftLeg", 1, [0.0, -42.0, 0.0]),
    ("LeftFoot", 2, [0.0, -40.0, 0.0]),
    ("LeftToe", 3, [0.0, -5.0, 13.0]),
    ("RightUpLeg", 0, [-9.0, -4.0, 0.0]),
    ("RightLeg", 5, [0.0, -42.0, 0.0]),
    ("RightFoot", 6, [0.0, -40.0, 0.0]),
    ("RightToe", 7, [0.0, -5.0, 13.0]),
    ("Spine", 0, [0.0, 12.0, 0.0]),
    ("Chest", 9, [0.0, 20.0, 0.0]),
    ("Left Arm", 10, [17.0, 16.0, 0.0]),
    ("LeftForeArm", 11, [0.0, -27.0, 0.0]),
    ("LeftHand", 12, [0.0, -25.0, 0.0]),
    ("Right Arm", 10, [-17.0, 16.0, 0.0]),
    ("RightForeArm", 14, [0.0, -27.0, 0.0]),
    ("RightHand", 15, [0.0, -25.0, 0.0]),
    ("mixamorig:Neck", 10, [0.0, 24.0, 0.0]),
    ("Head", 17, [0.0, 10.0, 2.0]),
];
const FRAMES: usize = 40;

/// Degrees about the left–right axis of joints that move, as a walk at one stride a second at 30 frames a second.
fn flexion(joint: usize, frame: usize) -> f64 {
    let phase = std::f64::consts::TAU * frame as f64 / 30.0;
    match joint {
        1 => -25.0 * phase.sin(),
        5 => 25.0 * phase.sin(),
        2 => 20.0 - 18.0 * phase.cos(),
        6 => 20.0 + 18.0 * phase.cos(),
        11 => 20.0 * phase.sin(),
        14 => -20.0 * phase.sin(),
        12 | 15 => -15.0,
        _ => 0.0,
    }
}

/// 1.2 m/s along +Z.
fn root(frame: usize) -> [f64; 3] {
    [0.0, 92.0, 4.0 * frame as f64]
}

pub(super) fn bvh_text() -> String {
    let mut text = String::from("HIERARCHY\n");
    let mut open = Vec::new();
    for (joint, (name, parent, [x, y, z])) in BODY.iter().enumerate() {
        while joint > 0 && open.last() != Some(parent) {
            text.push_str("}\n");
            open.pop();
        }
        let position = if joint == 0 { "6 Xposition Yposition Zposition" } else { "3" };
        let keyword = if joint == 0 { "ROOT" } else { "JOINT" };
        let _ = writeln!(
            text,
            "{keyword} {name}\n{{\nOFFSET {x} {y} {z}\nCHANNELS {position} Zrotation Xrotation Yrotation"
        );
        open.push(joint);
    }
    text.push_str(&"}\n".repeat(open.len()));
    let _ = writeln!(text, "MOTION\nFrames: {FRAMES}\nFrame Time: 0.0333333333");
    for frame in 0..FRAMES {
        let [x, y, z] = root(frame);
        let _ = write!(text, "{x} {y} {z}");
        for joint in 0..BODY.len() {
            let _ = write!(text, " 0 {} 0", flexion(joint, frame));
        }
        text.push('\n');
    }
    text
}

/// The same body in metres, its buffer in a data URI.
fn gltf_text(interpolation: &str) -> String {
    let quaternion = |joint, frame| {
        let half = flexion(joint, frame).to_radians() / 2.0;
        [half.sin(), 0.0, 0.0, half.cos()]
    };
    let cubic = interpolation == "CUBICSPLINE";
    let mut floats: Vec<f32> = (0..FRAMES).map(|frame| frame as f32 / 30.0 + 1.0 / 30.0).collect();
    let mut accessors = vec![format!(
        r#"{{"bufferView":0,"componentType":5126,"count":{FRAMES},"type":"SCALAR","min":[0.0333],"max":[1.3334]}}"#
    )];
    let (mut channels, mut samplers) = (Vec::new(), Vec::new());
    for joint in 0..BODY.len() {
        for path in if joint == 0 { &["rotation", "translation"][..] } else { &["rotation"] } {
            let width = if *path == "rotation" { 4 } else { 3 };
            let start = floats.len() * 4;
            for frame in 0..FRAMES {
                let value: Vec<f64> = match *path {
                    "rotation" => quaternion(joint, frame).to_vec(),
                    _ => root(frame).map(|value| value / 100.0).to_vec(),
                };
                let tangent = vec![0.0; if cubic { width } else { 0 }];
                floats.extend([&tangent[..], &value, &tangent].concat().iter().map(|&value| value as f32));
            }
            let count = if cubic { 3 * FRAMES } else { FRAMES };
            let shape = if width == 4 { "VEC4" } else { "VEC3" };
            channels.push(format!(r#"{{"sampler":{},"target":{{"node":{joint},"path":"{path}"}}}}"#, samplers.len()));
            samplers.push(format!(r#"{{"input":0,"output":{},"interpolation":"{interpolation}"}}"#, accessors.len()));
            accessors.push(format!(
                r#"{{"bufferView":0,"byteOffset":{start},"componentType":5126,"count":{count},"type":"{shape}"}}"#
            ));
        }
    }
    let nodes: Vec<String> = BODY
        .iter()
        .enumerate()
        .map(|(joint, (name, _, offset))| {
            let children: Vec<String> =
                (1..BODY.len()).filter(|&child| BODY[child].1 == joint).map(|child| child.to_string()).collect();
            let children =
                if children.is_empty() { String::new() } else { format!(r#","children":[{}]"#, children.join(",")) };
            let [x, y, z] = offset.map(|value| value / 100.0);
            format!(r#"{{"name":"{name}","translation":[{x},{y},{z}]{children}}}"#)
        })
        .collect();
    let bytes: Vec<u8> = floats.iter().flat_map(|value| value.to_le_bytes()).collect();
    let data = base64::engine::general_purpose::STANDARD.encode(&bytes);
    let length = bytes.len();
    format!(
        r#"{{"asset":{{"version":"2.0"}},"scenes":[{{"nodes":[0]}}],"nodes":[{}],"animations":[{{"name":"walk","channels":[{}],"samplers":[{}]}}],"accessors":[{}],"bufferViews":[{{"buffer":0,"byteLength":{length}}}],"buffers":[{{"byteLength":{length},"uri":"data:application/octet-stream;base64,{data}"}}]}}"#,
        nodes.join(","),
        channels.join(","),
        samplers.join(","),
        accessors.join(",")
    )
}

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

fn edits() -> impl Strategy<Value = Vec<Edit>> {
    let edit = any::<(u64, u8, u32)>().prop_map(|(place, kind, value)| Edit { place, kind, value });
    prop::collection::vec(edit, 1..6)
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 600, failure_persistence: None, ..ProptestConfig::default() })]

    #[test]
    fn no_mutation_of_a_bvh_panics(edits in edits()) {
        let _ = import_bytes(Path::new("walk.bvh"), &mutated(bvh_text().as_bytes(), &edits));
    }

    #[test]
    fn no_mutation_of_a_bvh_header_panics(edits in edits()) {
        let text = bvh_text();
        let (head, tail) = text.split_at(text.find("MOTION").unwrap() + 60);
        let _ = import_bytes(Path::new("walk.bvh"), &[&mutated(head.as_bytes(), &edits), tail.as_bytes()].concat());
    }

    #[test]
    fn no_mutation_of_a_gltf_panics(edits in edits()) {
        let text = gltf_text("LINEAR");
        let (head, tail) = text.split_at(text.find(";base64").unwrap());
        let _ = import_bytes(Path::new("walk.gltf"), &[&mutated(head.as_bytes(), &edits), tail.as_bytes()].concat());
    }
}

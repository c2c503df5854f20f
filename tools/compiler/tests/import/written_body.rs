//! A body that walks, written as BVH and as glTF.
#![allow(unreachable_pub, reason = "tests of other crates include this file")]

use std::fmt::Write as _;

use base64::Engine;

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
/// Number of frames.
pub const FRAMES: usize = 40;

/// Degrees about the left–right axis of joints that move, as a walk at one stride a second at 30 frames a second.
fn flexion(joint: usize, frame: usize) -> f64 {
    let phase = std::f64::consts::TAU * frame as f64 / 30.0;
    match joint {
        1 => -25.0 * libm::sin(phase),
        5 => 25.0 * libm::sin(phase),
        2 => 20.0 - 18.0 * libm::cos(phase),
        6 => 20.0 + 18.0 * libm::cos(phase),
        11 => 20.0 * libm::sin(phase),
        14 => -20.0 * libm::sin(phase),
        12 | 15 => -15.0,
        _ => 0.0,
    }
}

/// 1.2 m/s along +Z.
fn root(frame: usize) -> [f64; 3] {
    [0.0, 92.0, 4.0 * frame as f64]
}

/// The body as BVH.
pub fn bvh_text() -> String {
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
pub fn gltf_text(interpolation: &str) -> String {
    let quaternion = |joint, frame| {
        let half = flexion(joint, frame).to_radians() / 2.0;
        [libm::sin(half), 0.0, 0.0, libm::cos(half)]
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

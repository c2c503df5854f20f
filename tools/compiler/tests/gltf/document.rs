//! glTF documents that the tests write: a walker, and further nodes and animations beside it.

use std::path::Path;

use base64::Engine;
use base64::engine::general_purpose::STANDARD;
use motiondb_compiler::{HumanClip, ImportedClip, import_bytes};
use serde_json::{Value, json};

/// Name, parent, offset in metres: a stiff-hipped walker of 19 joints.
pub(crate) const BODY: [(&str, usize, [f64; 3]); 19] = [
    ("Hips", 0, [0.0, 0.92, 0.0]),
    ("LeftUpLeg", 0, [0.09, -0.04, 0.0]),
    ("LeftLeg", 1, [0.0, -0.42, 0.0]),
    ("LeftFoot", 2, [0.0, -0.40, 0.0]),
    ("LeftToe", 3, [0.0, -0.05, 0.13]),
    ("RightUpLeg", 0, [-0.09, -0.04, 0.0]),
    ("RightLeg", 5, [0.0, -0.42, 0.0]),
    ("RightFoot", 6, [0.0, -0.40, 0.0]),
    ("RightToe", 7, [0.0, -0.05, 0.13]),
    ("Spine", 0, [0.0, 0.12, 0.0]),
    ("Chest", 9, [0.0, 0.20, 0.0]),
    ("LeftArm", 10, [0.17, 0.16, 0.0]),
    ("LeftForeArm", 11, [0.0, -0.27, 0.0]),
    ("LeftHand", 12, [0.0, -0.25, 0.0]),
    ("RightArm", 10, [-0.17, 0.16, 0.0]),
    ("RightForeArm", 14, [0.0, -0.27, 0.0]),
    ("RightHand", 15, [0.0, -0.25, 0.0]),
    ("Neck", 10, [0.0, 0.24, 0.0]),
    ("Head", 17, [0.0, 0.10, 0.02]),
];
pub(crate) const FRAMES: usize = 40;
const FLOAT: u32 = 5126;

/// Quaternion about the left–right axis: a walk at one stride a second at 30 frames a second.
pub(crate) fn rotation(joint: usize, frame: usize) -> [f32; 4] {
    let phase = std::f64::consts::TAU * frame as f64 / 30.0;
    let degrees = match joint {
        1 => -25.0 * libm::sin(phase),
        5 => 25.0 * libm::sin(phase),
        2 => 20.0 - 18.0 * libm::cos(phase),
        6 => 20.0 + 18.0 * libm::cos(phase),
        11 => 20.0 * libm::sin(phase),
        14 => -20.0 * libm::sin(phase),
        12 | 15 => -15.0,
        _ => 0.0,
    };
    let half = degrees.to_radians() / 2.0;
    [libm::sin(half) as f32, 0.0, 0.0, libm::cos(half) as f32]
}

/// 1.2 m/s along +Z.
pub(crate) fn root(frame: usize) -> [f32; 3] {
    [0.0, 0.92, 0.04 * frame as f32]
}

/// A document and its one buffer.
#[derive(Clone)]
pub(crate) struct Document {
    pub(crate) json: Value,
    pub(crate) bytes: Vec<u8>,
}

impl Document {
    pub(crate) fn empty() -> Self {
        let json = json!({
            "asset": { "version": "2.0" },
            "nodes": [], "animations": [], "accessors": [], "bufferViews": [], "buffers": [{}],
        });
        Self { json, bytes: Vec::new() }
    }

    /// The walker and its walk.
    pub(crate) fn walker() -> Self {
        let mut document = Self::empty();
        document.add_body("");
        document.add_walk("walk", &[0]);
        document
    }

    /// Adds a value to an array of the document; its index.
    pub(crate) fn push(&mut self, array: &str, value: Value) -> usize {
        let object = self.json.as_object_mut().unwrap();
        let array = object.entry(array).or_insert_with(|| json!([])).as_array_mut().unwrap();
        array.push(value);
        array.len() - 1
    }

    /// Adds a view of bytes; its index.
    pub(crate) fn view(&mut self, bytes: &[u8]) -> usize {
        self.bytes.resize(self.bytes.len().next_multiple_of(4), 0);
        let start = self.bytes.len();
        self.bytes.extend(bytes);
        self.push("bufferViews", json!({ "buffer": 0, "byteOffset": start, "byteLength": bytes.len() }))
    }

    /// Adds an accessor of floats; its index.
    pub(crate) fn floats(&mut self, shape: &str, values: &[f32]) -> usize {
        let width = match shape {
            "SCALAR" => 1,
            "VEC3" => 3,
            _ => 4,
        };
        let bytes: Vec<u8> = values.iter().flat_map(|value| value.to_le_bytes()).collect();
        let view = self.view(&bytes);
        let count = values.len() / width;
        self.push("accessors", json!({ "bufferView": view, "componentType": FLOAT, "count": count, "type": shape }))
    }

    /// Adds the walker's nodes, names with a suffix; its root's index.
    pub(crate) fn add_body(&mut self, suffix: &str) -> usize {
        let first = self.json["nodes"].as_array().unwrap().len();
        for (joint, (name, _, offset)) in BODY.iter().enumerate() {
            let mut node = json!({ "name": format!("{name}{suffix}"), "translation": offset });
            let children: Vec<usize> =
                (1..BODY.len()).filter(|&child| BODY[child].1 == joint).map(|child| first + child).collect();
            if !children.is_empty() {
                node["children"] = json!(children);
            }
            self.push("nodes", node);
        }
        first
    }

    /// Adds a skin of the body whose root is this node.
    pub(crate) fn add_skin(&mut self, first: usize) {
        self.push("skins", json!({ "joints": (first..first + BODY.len()).collect::<Vec<_>>() }));
    }

    /// Adds a walk of the bodies whose roots are these nodes; its index.
    pub(crate) fn add_walk(&mut self, name: &str, bodies: &[usize]) -> usize {
        let times: Vec<f32> = (0..FRAMES).map(|frame| frame as f32 / 30.0).collect();
        let input = self.floats("SCALAR", &times);
        let animation = self.push("animations", json!({ "name": name, "channels": [], "samplers": [] }));
        for &first in bodies {
            for joint in 0..BODY.len() {
                let turns: Vec<f32> = (0..FRAMES).flat_map(|frame| rotation(joint, frame)).collect();
                let output = self.floats("VEC4", &turns);
                self.channel(animation, first + joint, "rotation", input, output);
            }
            let positions: Vec<f32> = (0..FRAMES).flat_map(root).collect();
            let output = self.floats("VEC3", &positions);
            self.channel(animation, first, "translation", input, output);
        }
        animation
    }

    /// Adds a channel and its sampler.
    pub(crate) fn channel(&mut self, animation: usize, node: usize, path: &str, input: usize, output: usize) {
        let animation = &mut self.json["animations"][animation];
        let samplers = animation["samplers"].as_array_mut().unwrap();
        samplers.push(json!({ "input": input, "output": output }));
        let sampler = samplers.len() - 1;
        let channel = json!({ "sampler": sampler, "target": { "node": node, "path": path } });
        animation["channels"].as_array_mut().unwrap().push(channel);
    }

    /// Puts the walker below a node; that node's index.
    pub(crate) fn put_below(&mut self, mut node: Value, child: usize) -> usize {
        node["children"] = json!([child]);
        self.push("nodes", node)
    }

    /// The document as JSON, its buffer at an address.
    pub(crate) fn gltf_with(&self, uri: &str) -> Vec<u8> {
        let mut json = self.json.clone();
        json["buffers"][0] = json!({ "byteLength": self.bytes.len(), "uri": uri });
        serde_json::to_vec(&json).unwrap()
    }

    pub(crate) fn gltf(&self) -> Vec<u8> {
        self.gltf_with(&format!("data:application/octet-stream;base64,{}", STANDARD.encode(&self.bytes)))
    }

    pub(crate) fn glb(&self) -> Vec<u8> {
        let mut json = self.json.clone();
        json["buffers"][0] = json!({ "byteLength": self.bytes.len() });
        let mut json = serde_json::to_vec(&json).unwrap();
        json.resize(json.len().next_multiple_of(4), b' ');
        let mut buffer = self.bytes.clone();
        buffer.resize(buffer.len().next_multiple_of(4), 0);
        let word = |number: usize| (number as u32).to_le_bytes();
        let length = word(12 + 8 + json.len() + 8 + buffer.len());
        let parts: [&[u8]; 9] =
            [b"glTF", &word(2), &length, &word(json.len()), b"JSON", &json, &word(buffer.len()), b"BIN\0", &buffer];
        parts.concat()
    }

    pub(crate) fn imports(&self) -> Vec<ImportedClip> {
        import_bytes(Path::new("walk.gltf"), &self.gltf()).unwrap_or_else(|error| panic!("{error}"))
    }

    /// The one clip of the document.
    #[track_caller]
    pub(crate) fn only(&self) -> HumanClip {
        let imports = self.imports();
        assert_eq!(imports.len(), 1, "{:?}", imports.iter().map(|import| &import.clip).collect::<Vec<_>>());
        human(imports.into_iter().next().unwrap())
    }
}

#[track_caller]
pub(crate) fn human(import: ImportedClip) -> HumanClip {
    import.outcome.unwrap_or_else(|reason| panic!("{}: {reason}", import.clip))
}

#[track_caller]
pub(crate) fn check_walks(clip: &HumanClip) {
    let record = &clip.source;
    assert!((record.speed_mps - 1.2).abs() < 0.02 && record.turn_rate_rad_s.abs() < 0.02, "{record:?}");
    assert_eq!((record.up_axis.as_str(), record.metres_per_unit, clip.frames.len()), ("+Y", 1.0, FRAMES), "{record:?}");
}

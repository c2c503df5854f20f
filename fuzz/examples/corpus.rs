//! Writes the seeds that are too long to write by hand: `cargo run --example corpus`, in this folder. All of them are
//! made here.

use std::fs;
use std::path::Path;

use base64::Engine;
use base64::engine::general_purpose::STANDARD;
use fbcrowd_sim::population::{AgentId, AgentLife, Population};
use fbcrowd_sim::recording::{AgentFrame, Header, Recorder, unzip_text, write_chunk};
use fbcrowd_sim::scenario::{AgentSpec, AtGoal, Scenario, SourceSpec};
use glam::Vec2;

#[path = "../../motiondb/tests/support/mod.rs"]
mod support;

/// Rows of motion in a BVH seed: two strides, enough for an example.
const ROWS: usize = 64;
/// One animation for each interpolation of glTF, and whether its values come in threes.
const INTERPOLATIONS: [(&str, bool); 3] = [("LINEAR", false), ("STEP", false), ("CUBICSPLINE", true)];
const KEYS: usize = 3;

fn main() {
    let corpus = Path::new(env!("CARGO_MANIFEST_DIR")).join("corpus");
    let write = |name: &str, bytes: &[u8]| fs::write(corpus.join(name), bytes).expect("the corpus can be written");
    write("bvh/walk.bvh", &short_walk());
    let (json, buffer) = document();
    let data = format!(r#","uri":"data:application/octet-stream;base64,{}""#, STANDARD.encode(&buffer));
    write("gltf/limb.gltf", json.replace("@", &data).as_bytes());
    write("gltf/limb.glb", &glb(json.replace("@", "").into_bytes(), &buffer));
    write("database/small.fbdb", &motiondb::files::database_file::to_bytes(&support::small_db()));
    let recording = corpus.join("recording/two.fbrec");
    record(&recording);
    unzip(&recording, &corpus.join("recording/texts.fbrec"));
    for name in ["version_1.fbrec", "version_2.fbrec"] {
        let golden = Path::new(env!("CARGO_MANIFEST_DIR")).join("../runtime/sim/tests/golden").join(name);
        write(&format!("recording/{name}"), &fs::read(golden).expect("the golden recording can be read"));
    }
}

/// The first rows of a bundled clip.
fn short_walk() -> Vec<u8> {
    let clips = clipgen::generate();
    let walk = clips.iter().find(|clip| clip.name == "walk_180.bvh").expect("a bundled clip");
    let text = String::from_utf8_lossy(&walk.bytes);
    let motion = text.lines().position(|line| line == "MOTION").expect("a BVH file");
    text.lines().take(motion + 3 + ROWS).flat_map(|line| [line, "\n"]).collect::<String>().into_bytes()
}

/// Two nodes that turn and move, in JSON (`@`: where a buffer's address belongs), and their buffer.
fn document() -> (String, Vec<u8>) {
    let mut floats: Vec<f32> = (0..KEYS).map(|key| 0.5 * key as f32).collect();
    let mut accessors = vec![accessor(0, KEYS, "SCALAR")];
    let mut animations = Vec::new();
    for (interpolation, in_threes) in INTERPOLATIONS {
        let (mut channels, mut samplers) = (Vec::new(), Vec::new());
        for (node, path, value) in
            [(0, "translation", &[0.0, 0.9, 0.1][..]), (0, "rotation", &[0.0, 0.6, 0.0, 0.8]), (1, "scale", &[1.0; 3])]
        {
            let count = if in_threes { 3 * KEYS } else { KEYS };
            channels.push(format!(r#"{{"sampler":{},"target":{{"node":{node},"path":"{path}"}}}}"#, samplers.len()));
            samplers.push(format!(r#"{{"input":0,"output":{},"interpolation":"{interpolation}"}}"#, accessors.len()));
            accessors.push(accessor(4 * floats.len(), count, if value.len() == 4 { "VEC4" } else { "VEC3" }));
            (0..count).for_each(|_| floats.extend(value));
        }
        let (channels, samplers) = (channels.join(","), samplers.join(","));
        animations.push(format!(r#"{{"name":"{interpolation}","channels":[{channels}],"samplers":[{samplers}]}}"#));
    }
    let (accessors, animations, length) = (accessors.join(","), animations.join(","), 4 * floats.len());
    let json = format!(
        r#"{{"asset":{{"version":"2.0"}},"nodes":[{{"name":"Hips","children":[1]}},{{"name":"Spine","translation":[0,0.1,0]}}],"animations":[{animations}],"accessors":[{accessors}],"bufferViews":[{{"buffer":0,"byteLength":{length}}}],"buffers":[{{"byteLength":{length}@}}]}}"#
    );
    (json, floats.iter().flat_map(|value| value.to_le_bytes()).collect())
}

fn accessor(offset: usize, count: usize, shape: &str) -> String {
    let bounds = if offset == 0 { r#","min":[0],"max":[1]"# } else { "" };
    format!(r#"{{"bufferView":0,"byteOffset":{offset},"componentType":5126,"count":{count},"type":"{shape}"{bounds}}}"#)
}

fn glb(mut json: Vec<u8>, buffer: &[u8]) -> Vec<u8> {
    json.resize(json.len().next_multiple_of(4), b' ');
    let word = |number: usize| (number as u32).to_le_bytes();
    let length = word(12 + 8 + json.len() + 8 + buffer.len());
    let parts: [&[u8]; 9] =
        [b"glTF", &word(2), &length, &word(json.len()), b"JSON", &json, &word(buffer.len()), b"BIN\0", buffer];
    parts.concat()
}

/// Two agents in three frames; one is removed, a third one comes from a source.
fn record(path: &Path) {
    let agent =
        |y: f32| AgentSpec { position_m: Vec2::new(0.0, y), goals_m: vec![Vec2::new(5.0, y)], ..AgentSpec::default() };
    let source = SourceSpec {
        high_m: Vec2::ONE,
        to_s: 1.0,
        count: Some(2),
        facing_rad: Some(0.5),
        goal_offset_m: Some(Vec2::X),
        at_goal: AtGoal::Leave,
        ..SourceSpec::default()
    };
    let scenario = Scenario {
        name: "two".to_owned(),
        duration_s: 1.0,
        dt_s: 0.25,
        sources: vec![source],
        obstacles_m: vec![vec![Vec2::new(9.0, 9.0), Vec2::new(10.0, 9.0), Vec2::new(9.0, 10.0)]],
        ..Scenario::of(vec![agent(0.0), agent(2.0)])
    };
    let header = Header::new(&support::small_db(), 7, scenario);
    let mut population = Population::of(&header.scenario);
    population.agents.push(AgentLife::new(header.scenario.sources[0].agent(Vec2::ONE), Some(0), 1));
    let mut recorder = Recorder::create(path, &header).expect("the corpus can be written");
    for ids in [&[0, 1][..], &[0, 1, 2], &[0, 2]] {
        let agents = ids.iter().map(|&id: &u32| AgentFrame { id: AgentId(id), ..AgentFrame::default() });
        recorder.push(&agents.collect::<Vec<_>>()).expect("finite agents");
    }
    recorder.finish(&population).expect("the corpus can be written");
}

/// The recording with the texts of header and agents as they are, for the target that compresses them.
fn unzip(path: &Path, unzipped: &Path) {
    let bytes = fs::read(path).expect("it was written just now");
    let (start, mut rest) = bytes.split_at(12);
    let mut file = start.to_vec();
    while let Some((head, after)) = rest.split_first_chunk::<12>() {
        let kind = [head[0], head[1], head[2], head[3]];
        let length = u32::from_le_bytes([head[4], head[5], head[6], head[7]]) as usize;
        let (payload, after) = after.split_at(length);
        rest = after;
        let payload = match &kind {
            b"HEAD" | b"AGNT" => unzip_text(payload).expect("it was zipped just now"),
            _ => payload.to_vec(),
        };
        write_chunk(&mut file, kind, &payload).expect("memory holds it");
    }
    fs::write(unzipped, file).expect("the corpus can be written");
}

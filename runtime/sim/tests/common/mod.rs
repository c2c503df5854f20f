//! A body, a scenario and frames for the tests of recordings and measures.
#![allow(dead_code, unreachable_pub, reason = "each test target uses its own part")]

use std::io::{Read, Write};
use std::path::{Path, PathBuf};

use fbcrowd_sim::population::Population;
use fbcrowd_sim::recording::{AgentFrame, Header, RecordedDatabase, Recorder, Recording, write_chunk};
use fbcrowd_sim::scenario::{AgentSpec, Scenario};
use glam::{Vec2, Vec3};
use motiondb::body::{Foot, JOINT_COUNT, Joint, Skeleton};
use motiondb::velocity_sets::velocity_hull::VelocityHull;

/// A body of 1.75 m in round numbers.
pub fn skeleton() -> Skeleton {
    let mut offsets_m = [Vec3::new(0.0, 0.0, 0.15); JOINT_COUNT];
    offsets_m[Joint::Pelvis.index()] = Vec3::new(0.0, 0.0, 0.93);
    for side in 0..2 {
        let sign = 1.0 - 2.0 * side as f32;
        offsets_m[Joint::THIGHS[side].index()] = Vec3::new(0.0, 0.09 * sign, 0.0);
        offsets_m[Joint::SHANKS[side].index()] = Vec3::new(0.0, 0.0, -0.43);
        offsets_m[Joint::FEET[side].index()] = Vec3::new(0.0, 0.0, -0.42);
        offsets_m[Joint::TOES[side].index()] = Vec3::new(0.14, 0.0, -0.06);
        offsets_m[Joint::UPPER_ARMS[side].index()] = Vec3::new(0.0, 0.12 * sign, 0.0);
    }
    let [heel_m, ball_m, toe_tip_m] =
        [Vec3::new(-0.05, 0.0, -0.08), Vec3::new(0.14, 0.0, -0.08), Vec3::new(0.07, 0.0, -0.02)];
    let foot = Foot { heel_m, ball_m, toe_tip_m, measured_m: [heel_m, ball_m, toe_tip_m] };
    Skeleton {
        offsets_m,
        segment_ends_m: [Vec3::new(0.07, 0.0, 0.0); JOINT_COUNT],
        segment_radii_m: [0.06; JOINT_COUNT],
        limits_rad: [[Vec3::splat(-2.0), Vec3::splat(2.0)]; JOINT_COUNT],
        feet: [foot; 2],
    }
}

/// An agent that walks from one position to another, m.
pub fn agent(from: [f32; 2], to: [f32; 2]) -> AgentSpec {
    AgentSpec {
        position_m: Vec2::from(from),
        facing_rad: 0.0,
        goals_m: vec![Vec2::from(to)],
        radius_m: 0.25,
        wall_radius_m: 0.2,
        preferred_speed_mps: 1.33,
        ..AgentSpec::default()
    }
}

/// The header of a scenario of these agents.
pub fn header(agents: Vec<AgentSpec>, dt_s: f32) -> Header {
    let scenario = Scenario {
        name: "test".to_owned(),
        duration_s: 1.0,
        dt_s,
        obstacles_m: vec![vec![Vec2::new(9.0, 9.0), Vec2::new(10.0, 9.0), Vec2::new(9.0, 10.0)]],
        ..Scenario::of(agents)
    };
    Header::of(
        RecordedDatabase {
            checksum: 7,
            skeleton: skeleton(),
            velocity_hull: VelocityHull::default(),
            style: String::new(),
        },
        scenario,
    )
}

/// A body that stands upright at a position.
pub fn standing_at(position_m: Vec2) -> AgentFrame {
    let mut frame = AgentFrame::default();
    frame.root.position_m = position_m;
    frame.pose.pelvis_m = skeleton().offsets_m[0];
    frame
}

/// An empty folder of one test's own.
pub fn folder(test: &str) -> PathBuf {
    let folder = Path::new(env!("CARGO_TARGET_TMPDIR")).join(test);
    let _ = std::fs::remove_dir_all(&folder);
    std::fs::create_dir_all(&folder).unwrap();
    folder
}

/// Records frames, in each of which every agent of the scenario is present, and opens the recording.
pub fn record(path: &Path, header: &Header, frames: &[Vec<AgentFrame>]) -> Recording {
    let mut recorder = Recorder::create(path, header).unwrap();
    for frame in frames {
        recorder.push(&numbered(frame)).unwrap();
    }
    recorder.finish(&Population::of(&header.scenario)).unwrap();
    Recording::open(path).unwrap()
}

/// The agents of a frame with their indices as ids.
pub fn numbered(frame: &[AgentFrame]) -> Vec<AgentFrame> {
    frame.iter().enumerate().map(|(index, agent)| AgentFrame { id: index.into(), ..*agent }).collect()
}

/// Kind and payload of every chunk of a recording, without index and tail.
pub fn chunks(bytes: &[u8]) -> Vec<([u8; 4], Vec<u8>)> {
    let (mut rest, mut found) = (&bytes[12..], Vec::new());
    while let Some((head, after)) = rest.split_first_chunk::<12>() {
        let (kind, length) = head.split_first_chunk::<4>().unwrap();
        let (payload, after) = after.split_at(u32::from_le_bytes(*length.first_chunk().unwrap()) as usize);
        rest = after;
        if ![*b"INDX", *b"TAIL"].contains(kind) {
            found.push((*kind, payload.to_vec()));
        }
    }
    found
}

/// A recording of these chunks, with right checksums, index and tail.
pub fn file_of(chunks: &[([u8; 4], Vec<u8>)]) -> Vec<u8> {
    let (mut file, mut index) = (b"FBREC\r\n\x1a\x02\0\0\0".to_vec(), Vec::new());
    for (kind, payload) in chunks {
        if kind != b"HEAD" {
            index.extend(kind);
            index.extend((file.len() as u64).to_le_bytes());
        }
        write_chunk(&mut file, *kind, payload).unwrap();
    }
    let index_byte = file.len() as u64;
    write_chunk(&mut file, *b"INDX", &index).unwrap();
    write_chunk(&mut file, *b"TAIL", &index_byte.to_le_bytes()).unwrap();
    file
}

/// The text of a payload of zipped JSON.
pub fn unzipped(payload: &[u8]) -> String {
    let mut text = String::new();
    flate2::read::ZlibDecoder::new(&payload[4..]).read_to_string(&mut text).unwrap();
    text
}

/// The payload of a text.
pub fn zipped(text: &[u8]) -> Vec<u8> {
    let start = (text.len() as u32).to_le_bytes().to_vec();
    let mut payload = flate2::write::ZlibEncoder::new(start, flate2::Compression::none());
    payload.write_all(text).unwrap();
    payload.finish().unwrap()
}

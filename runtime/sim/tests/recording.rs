//! Recordings keep their frames, and files that are not recordings are rejected.

mod common;

use std::fs;
use std::path::Path;

use common::{agent, folder, header, numbered, record, standing_at};
use fbcrowd_sim::behaviour::Area;
use fbcrowd_sim::population::Population;
use fbcrowd_sim::recording::{
    AgentFrame, ExtraFrame, Header, RecordedExtraJoint, Recorder, Recording, RecordingError, sample_extra, write_chunk,
};
use fbcrowd_sim::scenario::{Marking, MarkingColour, MarkingShape};
use glam::{Quat, Vec2, Vec3};
use motiondb::body::Joints;
use proptest::prelude::*;

/// Frames of two agents whose joints all turn.
fn frames(count: usize) -> Vec<Vec<AgentFrame>> {
    let body = |index: usize, agent: usize| {
        let mut frame = standing_at(Vec2::new(index as f32 * 0.04, agent as f32 * 2.0));
        for (joint, rotation) in frame.pose.rotations.iter_mut().enumerate() {
            *rotation =
                Quat::from_rotation_y(0.01 * (index + joint) as f32) * Quat::from_rotation_x(0.2 * agent as f32);
        }
        frame
    };
    (0..count).map(|index| vec![body(index, 0), body(index, 1)]).collect()
}

fn two_agents() -> fbcrowd_sim::recording::Header {
    header(vec![agent([0.0, 0.0], [5.0, 0.0]), agent([0.0, 2.0], [5.0, 2.0])], 1.0 / 30.0)
}

/// Reads header and all frames, so that every byte that matters is checked.
fn read_all(path: &Path) -> Result<Vec<Vec<AgentFrame>>, RecordingError> {
    let recording = Recording::open(path)?;
    let mut agents = Vec::new();
    (0..recording.frame_count())
        .map(|index| recording.read_frame(index, &mut agents).map(|()| agents.clone()))
        .collect()
}

#[test]
fn header_and_frames_are_read_in_any_order() {
    let written = frames(9);
    let recording = record(&folder("round_trip").join("a.fbrec"), &two_agents(), &written);
    assert_eq!(recording.header(), &two_agents());
    assert_eq!(recording.frame_count(), 9);
    let mut agents = Vec::new();
    for index in [8, 0, 5, 5, 1] {
        recording.read_frame(index, &mut agents).unwrap();
        for (read, written) in agents.iter().zip(&written[index]) {
            assert_eq!(read.root, written.root);
            assert!((read.pose.pelvis_m - written.pose.pelvis_m).length() < 1e-6);
            for (read, written) in read.pose.rotations.iter().zip(&written.pose.rotations) {
                assert!(read.angle_between(*written) < 1e-3);
            }
        }
    }
}

#[test]
fn two_runs_write_the_same_bytes() {
    let folder = folder("twice");
    for name in ["a.fbrec", "b.fbrec"] {
        record(&folder.join(name), &two_agents(), &frames(20));
    }
    assert_eq!(fs::read(folder.join("a.fbrec")).unwrap(), fs::read(folder.join("b.fbrec")).unwrap());
    assert_eq!(fs::read_dir(&folder).unwrap().count(), 2);
}

#[test]
fn an_unfinished_recording_leaves_nothing() {
    let folder = folder("unfinished");
    let mut recorder = Recorder::create(&folder.join("a.fbrec"), &two_agents()).unwrap();
    recorder.push(&numbered(&frames(1)[0])).unwrap();
    drop(recorder);
    assert_eq!(fs::read_dir(&folder).unwrap().count(), 0);
}

#[test]
fn nan_or_missing_agents_are_rejected() {
    let mut recorder = Recorder::create(&folder("nan").join("a.fbrec"), &two_agents()).unwrap();
    let mut frame = numbered(&frames(1)[0]);
    assert!(matches!(recorder.push(&frame[..1]), Err(RecordingError::AgentCount { found: 1, expected: 2, .. })));
    frame[1].pose.rotations[3].x = f32::NAN;
    assert!(matches!(recorder.push(&frame), Err(RecordingError::NotFinite { agent: 1, frame: 0, .. })));
}

#[test]
fn frames_are_read_from_several_threads() {
    let recording = record(&folder("threads").join("a.fbrec"), &two_agents(), &frames(40));
    std::thread::scope(|scope| {
        for _ in 0..4 {
            scope.spawn(|| {
                let mut agents = Vec::new();
                for index in 0..40 {
                    recording.read_frame(index, &mut agents).unwrap();
                    assert_eq!(agents[0].root.position_m.x, index as f32 * 0.04);
                }
            });
        }
    });
}

#[test]
fn empty_or_broken_recording_is_rejected() {
    let path = folder("hollow").join("a.fbrec");
    Recorder::create(&path, &two_agents()).unwrap().finish(&Population::of(&two_agents().scenario)).unwrap();
    assert!(Recording::open(&path).unwrap_err().to_string().contains("the index is empty"));
    let mut broken = two_agents();
    for bone_m in [f32::INFINITY, f32::NAN, 1e30] {
        broken.databases[0].skeleton.offsets_m[4].y = bone_m;
        let message = Recorder::create(&path, &broken).unwrap_err().to_string();
        assert!(message.contains("cannot be recorded: the skeleton is out of range"), "{message}");
    }
}

#[test]
fn a_header_out_of_range_is_rejected_with_its_byte() {
    let path = folder("header_range").join("a.fbrec");
    let mut header = two_agents();
    let shape = MarkingShape::Area(Area::point(Vec2::new(77.0, 0.0)));
    header.scenario.markings = vec![Marking { shape, colour: MarkingColour::Fixed([1, 2, 3]) }];
    record(&path, &header, &frames(2));
    let bytes = fs::read(&path).unwrap();
    for (from, to, what) in [
        ("\"fixed\":[1,2,3]", "\"signal\":0", "there is no signal 0"),
        ("[77.0,0.0]", "[77e9,0.0]", "is not within 10 km"),
        ("\"name\":\"test\"", "\"name\":\"a/b\"", "cannot name a file"),
        ("\"dt_s\":0.033333335", "\"dt_s\":1e-30", "dt_s is"),
        ("\"offsets_m\":[[0.0", "\"offsets_m\":[[1e30", "the skeleton is out of range"),
        ("\"offsets_m\":[[0.0", "\"offsets_m\":[[1e39", "cannot be decoded (number out of range"),
        ("\"checksum\":7", "\"checksum\":null", "cannot be decoded (invalid type: null"),
        ("\"states\":[\"follow_path\"]", "\"states\":[]", "the header has 0 behaviour states"),
    ] {
        let forged = with_text(&bytes, *b"HEAD", |text| {
            assert!(text.contains(from), "{from} {text}");
            text.replace(from, to)
        });
        fs::write(&path, forged).unwrap();
        let message = Recording::open(&path).unwrap_err().to_string();
        assert!(message.contains("byte 12: ") && message.contains(what), "{message}");
    }
}

/// A recording in which the text of the first JSON chunk of a kind is changed; its checksum and the index match.
fn with_text(bytes: &[u8], kind: [u8; 4], change: impl Fn(&str) -> String) -> Vec<u8> {
    let mut payloads = common::chunks(bytes);
    let (_, payload) = payloads.iter_mut().find(|(found, _)| *found == kind).unwrap();
    let text = change(&common::unzipped(payload));
    *payload = common::zipped(text.as_bytes());
    common::file_of(&payloads)
}

/// A recording of two agents with two finger joints, and the rotations that were recorded.
fn with_fingers(path: &Path) -> (Recording, Vec<Vec<Quat>>) {
    let joint = |name: &str| RecordedExtraJoint { name: name.to_owned(), offset_m: Vec3::Y * 0.04 };
    let extra_joints = ["left_index_1", "left_index_2"].map(joint).to_vec();
    let header = Header { extra_joints, ..two_agents() };
    let mut recorder = Recorder::create(path, &header).unwrap();
    let curl = |frame: usize| (0..4).map(move |joint| Quat::from_rotation_x(-0.1 * (frame * 4 + joint) as f32));
    let rotations: Vec<Vec<Quat>> = (0..5).map(|frame| curl(frame).collect()).collect();
    for (frame, rotations) in frames(5).iter().zip(&rotations) {
        recorder.push_with_extra(&numbered(frame), rotations.chunks(2)).unwrap();
    }
    recorder.finish(&Population::of(&header.scenario)).unwrap();
    let recording = Recording::open(path).unwrap();
    assert_eq!(recording.header(), &header);
    (recording, rotations)
}

#[test]
fn extra_joints_come_back_in_any_order() {
    let (recording, written) = with_fingers(&folder("extra").join("a.fbrec"));
    let (mut rotations, mut agents) = (Vec::new(), Vec::new());
    for frame in [3, 0, 4] {
        recording.read_extra(frame, &mut rotations).unwrap();
        assert_eq!(rotations.len(), 4);
        let pairs = rotations.iter().zip(&written[frame]);
        assert!(pairs.into_iter().all(|(read, written)| read.angle_between(*written) < 2e-3), "{rotations:?}");
        recording.read_frame(frame, &mut agents).unwrap();
        assert_eq!(agents.len(), 2);
    }
    assert!(matches!(recording.read_extra(5, &mut rotations), Err(RecordingError::NoSuchFrame { .. })));
}

#[test]
fn extra_joints_are_blended_between_frames() {
    let (recording, written) = with_fingers(&folder("extra_between").join("a.fbrec"));
    let at = |frames: f64| sample_extra(&recording, frames / 30.0).unwrap();
    for (frames, agent, joint) in [(1.0, 0, 1), (1.25, 1, 0), (3.5, 1, 1), (9.0, 0, 0)] {
        let [before, after] = [0.0, 1.0].map(|step: f64| written[((frames + step) as usize).min(4)][2 * agent + joint]);
        let wanted = before.slerp(after, frames.fract() as f32);
        let read = at(frames).of(agent.into())[joint];
        assert!(read.angle_between(wanted) < 2e-3, "{frames}: {read}, not {wanted}");
    }
    assert!(at(1.0).of(7.into()).is_empty());
}

/// The second agent is removed in frame 3: it holds its last rotations until then.
#[test]
fn extra_joints_of_an_agent_end_with_it() {
    let path = folder("extra_removed").join("a.fbrec");
    let joint = RecordedExtraJoint { name: "left_index_1".into(), offset_m: Vec3::Y };
    let header = Header { extra_joints: vec![joint], ..two_agents() };
    let mut recorder = Recorder::create(&path, &header).unwrap();
    let curl = |frame: usize, agent: usize| Quat::from_rotation_x(-0.1 * (2 * frame + agent) as f32);
    for (frame, agents) in frames(5).iter().enumerate() {
        let present = if frame < 3 { 2 } else { 1 };
        let rotations: Vec<Quat> = (0..present).map(|agent| curl(frame, agent)).collect();
        recorder.push_with_extra(&numbered(&agents[..present]), rotations.chunks(1)).unwrap();
    }
    let mut population = Population::of(&header.scenario);
    population.agents[1].removed = Some(3);
    recorder.finish(&population).unwrap();
    let recording = Recording::open(&path).unwrap();
    let at = |frames: f64| sample_extra(&recording, frames / 30.0).unwrap();
    let [first, second] = [0, 1].map(|agent| at(2.5).of(agent.into())[0]);
    assert!(first.angle_between(curl(2, 0).slerp(curl(3, 0), 0.5)) < 2e-3);
    assert!(second.angle_between(curl(2, 1)) < 2e-3);
    let later = at(4.0);
    assert!(later.of(1.into()).is_empty());
    let completed = later.clone().completed(&at(2.0));
    assert_eq!([completed.of(0.into()), completed.of(1.into())], [later.of(0.into()), at(2.0).of(1.into())]);
    let without = record(&folder("extra_empty").join("a.fbrec"), &two_agents(), &frames(2));
    assert_eq!(sample_extra(&without, 0.01).unwrap(), ExtraFrame::default());
}

#[test]
fn a_reader_without_extra_joints_reads_the_same_bodies() {
    let (with, without) = (folder("extra_skipped").join("a.fbrec"), folder("extra_none").join("a.fbrec"));
    with_fingers(&with);
    let recording = record(&without, &two_agents(), &frames(5));
    // Such a reader ignores the key and the chunks.
    let text = |text: &str| {
        let start = text.find(",\"extra_joints\"").unwrap();
        let end = text[start + 1..].find("],\"scenario\"").unwrap() + start + 2;
        format!("{}{}", &text[..start], &text[end..])
    };
    let stripped = with_text(&fs::read(&with).unwrap(), *b"HEAD", text);
    fs::write(&with, stripped).unwrap();
    assert_eq!(read_all(&with).unwrap(), read_all(&without).unwrap());
    let bytes = fs::read(&without).unwrap();
    assert!(!bytes.windows(4).any(|window| window == b"EXTR"));
    let mut rotations = vec![Quat::IDENTITY];
    recording.read_extra(0, &mut rotations).unwrap();
    assert!(rotations.is_empty());
}

#[test]
fn extra_joints_of_another_frame_are_rejected() {
    let path = folder("extra_lost").join("a.fbrec");
    with_fingers(&path);
    let mut chunks = common::chunks(&fs::read(&path).unwrap());
    let first = chunks.iter().position(|(kind, _)| kind == b"EXTR").unwrap();
    // A frame lies between two chunks of extra joints.
    chunks.swap(first, first + 2);
    fs::write(&path, common::file_of(&chunks)).unwrap();
    let message = Recording::open(&path).unwrap().read_extra(0, &mut Vec::new()).unwrap_err().to_string();
    assert!(message.contains("this is not frame 0"), "{message}");
    chunks.remove(first);
    fs::write(&path, common::file_of(&chunks)).unwrap();
    let message = Recording::open(&path).unwrap_err().to_string();
    assert!(message.contains("does not name the extra joints of each frame"), "{message}");
}

#[test]
fn a_frame_without_the_extra_joints_of_the_header_is_rejected() {
    let joint = RecordedExtraJoint { name: "left_index_1".into(), offset_m: Vec3::Y * 0.04 };
    let header = Header { extra_joints: vec![joint], ..two_agents() };
    let path = folder("extra_missing").join("a.fbrec");
    let message = Recorder::create(&path, &header).unwrap().push(&numbered(&frames(1)[0])).unwrap_err().to_string();
    assert!(message.contains("agent 0 has 0 extra joints, but the header lists 1"), "{message}");
    let far = RecordedExtraJoint { name: "left_index_1".into(), offset_m: Vec3::Y * 400.0 };
    let header = Header { extra_joints: vec![far], ..two_agents() };
    let message = Recorder::create(&path, &header).unwrap_err().to_string();
    assert!(message.contains("an extra joint is out of range"), "{message}");
}

#[test]
fn an_index_that_repeats_a_frame_is_rejected() {
    let path = folder("again").join("a.fbrec");
    drop(record(&path, &two_agents(), &frames(3)));
    let bytes = fs::read(&path).unwrap();
    let index_byte = bytes.windows(4).rposition(|window| window == b"INDX").unwrap();
    let first: [u8; 12] = bytes[index_byte + 12..][..12].try_into().unwrap();
    let mut forged = bytes[..index_byte].to_vec();
    write_chunk(&mut forged, *b"INDX", &first.repeat(1000)).unwrap();
    write_chunk(&mut forged, *b"TAIL", &(index_byte as u64).to_le_bytes()).unwrap();
    fs::write(&path, forged).unwrap();
    assert!(matches!(Recording::open(&path), Err(RecordingError::Damaged { .. })));
}

#[test]
fn values_beyond_all_scenarios_are_rejected() {
    let mut recorder = Recorder::create(&folder("beyond").join("a.fbrec"), &two_agents()).unwrap();
    let mut agents = numbered(&frames(1)[0]);
    agents[1].root.position_m.x = 1e30;
    assert!(recorder.push(&agents).is_err());
}

#[test]
fn chunks_of_unknown_kind_are_skipped() {
    let path = folder("unknown").join("a.fbrec");
    record(&path, &two_agents(), &frames(3));
    let bytes = fs::read(&path).unwrap();
    // Between the index and the tail, where no byte offset changes.
    let (front, tail) = bytes.split_at(bytes.len() - 20);
    let mut other = b"NOTE\x02\0\0\0\0\0\0\0hi".to_vec();
    other.splice(0..0, front.iter().copied());
    fs::write(&path, [other, tail.to_vec()].concat()).unwrap();
    assert_eq!(read_all(&path).unwrap().len(), 3);
}

#[test]
fn every_truncation_is_rejected() {
    let path = folder("truncated").join("a.fbrec");
    record(&path, &two_agents(), &frames(2));
    let bytes = fs::read(&path).unwrap();
    for length in 0..bytes.len() {
        fs::write(&path, &bytes[..length]).unwrap();
        assert!(read_all(&path).is_err(), "{length} of {} bytes were accepted", bytes.len());
    }
}

#[test]
fn errors_name_file_byte_and_remedy() {
    let path = folder("messages").join("a.fbrec");
    let check = |bytes: &[u8], expected: &str| {
        fs::write(&path, bytes).unwrap();
        let message = read_all(&path).unwrap_err().to_string();
        assert!(message.starts_with(path.to_str().unwrap()) && message.contains(expected), "{message}");
    };
    record(&path, &two_agents(), &frames(2));
    let bytes = fs::read(&path).unwrap();
    check(b"HIERARCHY\nROOT Hips", "byte 0: not an FbCrowd recording; name a .fbrec file");
    check(b"", "byte 0: not an FbCrowd recording");
    check(&[&bytes[..8], &9_u32.to_le_bytes(), &bytes[12..]].concat(), "byte 8: format version 9");
    check(&bytes[..bytes.len() - 1], "simulate the scenario again");
    let mut altered = bytes.clone();
    altered[40] ^= 1;
    check(&altered, "byte 12: the checksum of the HEAD chunk is wrong");
    fs::remove_file(&path).unwrap();
    let message = Recording::open(&path).unwrap_err().to_string();
    assert!(
        message.contains("a.fbrec: cannot be read: ") && message.contains("check that the file exists"),
        "{message}"
    );
    let message = Recorder::create(&path.join("b.fbrec"), &two_agents()).unwrap_err().to_string();
    assert!(message.contains("b.fbrec: cannot be written: ") && message.contains("check that its folder"), "{message}");
    // A chunk that claims 4 GiB.
    altered.clone_from(&bytes);
    altered[16..20].fill(0xff);
    check(&altered, "byte 24: 4294967295 bytes are missing");
}

fn bytes_of_a_recording(test: &str) -> Vec<u8> {
    let path = folder(test).join("a.fbrec");
    record(&path, &two_agents(), &frames(3));
    fs::read(&path).unwrap()
}

proptest! {
    #![proptest_config(ProptestConfig { failure_persistence: None, ..ProptestConfig::default() })]

    #[test]
    fn altered_bytes_are_rejected(at in any::<prop::sample::Index>(), change in 1_u8..) {
        let mut bytes = bytes_of_a_recording("altered");
        let at = at.index(bytes.len());
        bytes[at] ^= change;
        let path = folder("altered").join("b.fbrec");
        fs::write(&path, &bytes).unwrap();
        prop_assert!(read_all(&path).is_err(), "byte {} was altered unnoticed", at);
    }

    /// The checksums are made to match, as only an attacker would.
    #[test]
    fn forged_texts_neither_panic_nor_exhaust_memory(
        kind in prop::sample::select(vec![*b"HEAD", *b"AGNT"]),
        changes in proptest::collection::vec((any::<prop::sample::Index>(), any::<u8>()), 1..4),
    ) {
        let forged = with_text(&bytes_of_a_recording("forged_text"), kind, |text| {
            let mut text = text.as_bytes().to_vec();
            for (at, value) in &changes {
                let at = at.index(text.len());
                text[at] = *value % 128;
            }
            String::from_utf8(text).unwrap()
        });
        let path = folder("forged_text").join("b.fbrec");
        fs::write(&path, forged).unwrap();
        let _ = read_all(&path);
    }

    /// The checksum is made to match, as only an attacker would.
    #[test]
    fn forged_headers_neither_panic_nor_exhaust_memory(
        changes in proptest::collection::vec((any::<prop::sample::Index>(), any::<u8>()), 1..8),
    ) {
        let mut bytes = bytes_of_a_recording("forged");
        let length = u32::from_le_bytes(bytes[16..20].try_into().unwrap()) as usize;
        for (at, value) in changes {
            bytes[24 + at.index(length)] = value;
        }
        let checksum = crc32fast::hash(&[&bytes[12..20], &bytes[24..24 + length]].concat());
        bytes[20..24].copy_from_slice(&checksum.to_le_bytes());
        let path = folder("forged").join("b.fbrec");
        fs::write(&path, &bytes).unwrap();
        let _ = read_all(&path);
    }
}

/// Root mean square of the speed that packing adds to a sole at 120 frames a second, cm/s: two independent errors per
/// difference.
fn packing_noise_cm_s(soles: impl Fn(&AgentFrame) -> [glam::Vec3; 3]) -> f64 {
    let mut frames = Vec::new();
    for index in 0..2000 {
        let mut frame = standing_at(Vec2::ZERO);
        for (joint, rotation) in frame.pose.rotations.iter_mut().enumerate() {
            let angle = |seed: f32| 0.8 * libm::sinf(seed * (index * 22 + joint) as f32);
            *rotation = Quat::from_euler(glam::EulerRot::XYZ, angle(1.3), angle(2.7), angle(3.1));
        }
        frames.push(vec![frame]);
    }
    let header = header(vec![agent([0.0, 0.0], [5.0, 0.0])], 1.0 / 120.0);
    let recording = record(&folder("noise").join("a.fbrec"), &header, &frames);
    let (mut agents, mut squares) = (Vec::new(), 0.0_f64);
    for (index, written) in frames.iter().enumerate() {
        recording.read_frame(index, &mut agents).unwrap();
        for (read, written) in soles(&agents[0]).iter().zip(soles(&written[0])) {
            squares += f64::from((*read - written).truncate().length_squared());
        }
    }
    (2.0 * squares / (3 * frames.len()) as f64).sqrt() * 120.0 * 100.0
}

#[test]
fn packing_adds_under_2_mm_s_slide() {
    let skeleton = common::skeleton();
    let soles = |frame: &AgentFrame| -> [glam::Vec3; 3] {
        let joints: Joints = frame.pose.forward_kinematics(&skeleton);
        joints.sole_points_m(&skeleton, 0)
    };
    let noise_cm_s = packing_noise_cm_s(soles);
    println!("packing noise at 120 Hz: {noise_cm_s:.3} cm/s");
    assert!(noise_cm_s < 0.2, "{noise_cm_s} cm/s");
}

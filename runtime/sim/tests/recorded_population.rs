//! Recordings of agents that come and go: they come back as they were written, forged ones are rejected, and earlier
//! versions are read.

mod common;

use std::fs;
use std::path::{Path, PathBuf};

use common::{agent, chunks, file_of, folder, header, standing_at, unzipped, zipped};
use fbcrowd_sim::behaviour::Signal;
use fbcrowd_sim::measures::{Measures, measure, write_table, write_trajectories};
use fbcrowd_sim::population::{AgentId, AgentLife, DoorPhases, Population, SourceCount};
use fbcrowd_sim::recording::{AgentFrame, Header, RecordedCharacter, Recorder, Recording, RecordingError};
use fbcrowd_sim::scenario::{AtGoal, DoorSpec, SourceSpec};
use glam::Vec2;

const DT_S: f32 = 0.25;
const SLIDE_CM_S: f32 = 1.25;
const FACING_OFFSET_RAD: f32 = 0.5;
/// Ids of the agents in each frame: 1 leaves after two frames, 2 comes with the second and leaves before the last.
const PRESENT: [&[u32]; 5] = [&[0, 1], &[0, 1, 2], &[0, 2], &[0, 2, 3, 4], &[0, 3, 4]];

/// A header with two listed agents, one source, two databases, two characters and two states.
fn wide_header() -> Header {
    let mut header = header(vec![agent([0.0, 0.0], [5.0, 0.0]), agent([0.0, 2.0], [5.0, 2.0])], DT_S);
    header.databases.push(header.databases[0].clone());
    header.databases[1].checksum = 8;
    let character = |name: &str, checksum| RecordedCharacter { name: name.to_owned(), checksum };
    header.characters = vec![character("Zoë", 1), character("b", 2)];
    header.states.push("look_around".to_owned());
    // The defaults of the program that wrote the golden file.
    let planner = &mut header.scenario.params.planner;
    (planner.relaxation_s, planner.response_s, planner.acceleration_max_mps2) = (0.54, 0.3, 1.1);
    header.scenario.sources.push(SourceSpec {
        low_m: Vec2::new(-1.0, -1.0),
        high_m: Vec2::new(1.0, 0.1),
        rate_per_s: 0.3,
        to_s: 9.0,
        count: Some(3),
        goals_m: vec![Vec2::new(7.0, 0.0)],
        preferred_speed_mps: 1.2,
        at_goal: AtGoal::Leave,
        ..SourceSpec::default()
    });
    header
}

fn population(header: &Header) -> Population {
    let mut population = Population::of(&header.scenario);
    for (x, born) in [(0.1, 1), (0.2, 3), (0.3, 3)] {
        let spec = header.scenario.sources[0].agent(Vec2::new(x, 0.0));
        population.agents.push(AgentLife::new(spec, Some(0), born));
    }
    population.agents[1].removed = Some(2);
    population.agents[2].removed = Some(4);
    let life = &mut population.agents[3];
    (life.database, life.character, life.stature, life.group) = (1, Some(1), 0.87, Some(7));
    population.sources[0] = SourceCount { born: 3, waiting: 2, blocked_frames: 4 };
    population
}

/// Agent `id` walks along x at 1 m/s from x = 0 on, 10·id m aside.
fn frame(index: usize, ids: &[u32]) -> Vec<AgentFrame> {
    let walker = |&id: &u32| AgentFrame {
        id: AgentId(id),
        state: (id % 2) as u16,
        examples_slide_cm_s: SLIDE_CM_S,
        facing_offset_rad: FACING_OFFSET_RAD,
        ..standing_at(Vec2::new(DT_S * index as f32, 10.0 * id as f32))
    };
    ids.iter().map(walker).collect()
}

fn write(path: &Path, header: &Header, population: &Population) {
    let mut recorder = Recorder::create(path, header).unwrap();
    for (index, ids) in PRESENT.iter().enumerate() {
        recorder.push(&frame(index, ids)).unwrap();
    }
    recorder.finish(population).unwrap();
}

fn written(test: &str) -> (PathBuf, Recording) {
    let path = folder(test).join("a.fbrec");
    write(&path, &wide_header(), &population(&wide_header()));
    (path.clone(), Recording::open(&path).unwrap())
}

fn read_all(path: &Path) -> Result<Vec<Vec<AgentFrame>>, RecordingError> {
    let recording = Recording::open(path)?;
    let mut agents = Vec::new();
    let read = |index| recording.read_frame(index, &mut agents).map(|()| agents.clone());
    (0..recording.frame_count()).map(read).collect()
}

#[test]
fn births_and_removals_come_back() {
    let (path, recording) = written("births");
    let header = wide_header();
    assert_eq!(recording.header(), &header);
    assert_eq!(recording.population(), &population(&header));
    assert_eq!((0..6).map(|frame| recording.agent_count(frame)).collect::<Vec<_>>(), [2, 3, 2, 4, 3, 0]);
    for (index, agents) in read_all(&path).unwrap().into_iter().enumerate() {
        let expected = frame(index, PRESENT[index]);
        let key = |agents: &[AgentFrame]| -> Vec<_> {
            agents.iter().map(|agent| (agent.id, agent.state, agent.root)).collect()
        };
        assert_eq!(key(&agents), key(&expected));
        let positions_m: Vec<_> = expected.iter().map(|agent| (agent.id, agent.root.position_m)).collect();
        assert_eq!(recording.read_positions(index).unwrap(), positions_m);
    }
    assert!(matches!(recording.read_positions(5), Err(RecordingError::NoSuchFrame { .. })));
}

#[test]
fn births_are_recorded_as_frames_show_them() {
    let (path, header) = (folder("as_shown").join("a.fbrec"), wide_header());
    let mut wrong = population(&header);
    wrong.agents.iter_mut().for_each(|life| (life.born, life.removed) = (99, Some(100)));
    write(&path, &header, &wrong);
    assert_eq!(Recording::open(&path).unwrap().population(), &population(&header));
}

#[test]
fn ids_that_do_not_count_births_are_rejected() {
    let header = wide_header();
    let check = |frames: &[&[u32]]| {
        let mut recorder = Recorder::create(&folder("ids").join("a.fbrec"), &header).unwrap();
        let (last, first) = frames.split_last().unwrap();
        first.iter().for_each(|ids| recorder.push(&frame(0, ids)).unwrap());
        assert!(matches!(recorder.push(&frame(0, last)), Err(RecordingError::AgentId { .. })), "{frames:?}");
    };
    check(&[&[0, 2]]);
    check(&[&[1, 0]]);
    check(&[&[0, 0]]);
    check(&[&[0, 1], &[0], &[0, 1]]);
    check(&[&[0, 1], &[0, 1, 3]]);
    let mut recorder = Recorder::create(&folder("ids").join("a.fbrec"), &header).unwrap();
    recorder.push(&frame(0, &[0, 1])).unwrap();
    let error = recorder.finish(&population(&header)).unwrap_err();
    assert!(matches!(error, RecordingError::AgentCount { found: 2, expected: 5, .. }), "{error}");
}

#[test]
fn any_frame_is_read_without_the_others() {
    let (path, _) = written("alone");
    let bytes = fs::read(&path).unwrap();
    let mut all = chunks(&bytes);
    // Every other frame is destroyed, its checksum included.
    for (_, payload) in all.iter_mut().filter(|(kind, _)| kind == b"FRAM").step_by(2) {
        payload.truncate(3);
    }
    fs::write(&path, file_of(&all)).unwrap();
    let recording = Recording::open(&path).unwrap();
    let mut agents = Vec::new();
    for (index, ids) in PRESENT.iter().enumerate() {
        let read = recording.read_frame(index, &mut agents);
        assert_eq!(read.is_ok(), index % 2 == 1);
        assert!(read.is_err() || agents.iter().map(|agent| agent.id.0).eq(ids.iter().copied()));
    }
}

#[test]
fn a_swapped_frame_is_noticed() {
    let (path, _) = written("swapped");
    let mut all = chunks(&fs::read(&path).unwrap());
    all.swap(1, 2);
    fs::write(&path, file_of(&all)).unwrap();
    let message = read_all(&path).unwrap_err().to_string();
    assert!(message.contains("this is not frame 0 with 2 agents"), "{message}");
}

/// Replaces a part of the text of the agents' list.
fn check_forged_list(from: &str, to: &str, expected: &str) {
    let (path, _) = written("forged_list");
    let mut all = chunks(&fs::read(&path).unwrap());
    let (_, payload) = all.iter_mut().find(|(kind, _)| kind == b"AGNT").unwrap();
    let text = unzipped(payload);
    assert!(text.contains(from), "{text}");
    *payload = zipped(text.replacen(from, to, 1).as_bytes());
    fs::write(&path, file_of(&all)).unwrap();
    let message = read_all(&path).unwrap_err().to_string();
    assert!(message.contains("byte ") && message.contains(expected), "{message}");
}

#[test]
fn every_forged_list_of_agents_is_rejected() {
    check_forged_list("\"removed\":2", "\"removed\":0", "out of range");
    check_forged_list("\"removed\":2", "\"removed\":3", "this is not frame 2");
    check_forged_list("\"removed\":2", "\"removed\":4000000000", "out of range");
    check_forged_list("\"born\":3", "\"born\":400", "do not count births");
    check_forged_list("\"stature\":0.87", "\"stature\":1e9", "out of range");
    check_forged_list("\"database\":1", "\"database\":2", "out of range");
    check_forged_list("\"character\":1", "\"character\":2", "out of range");
    check_forged_list("\"radius_m\":0.25", "\"radius_m\":1e30", "radius_m is");
    check_forged_list("\"sources\":[{", "\"sources\":[{},{", "sources");
    check_forged_list("{\"agents\":[{}", "{\"agents\":[{},{}", "has no start");
    let crowd = format!("{{\"agents\":[{{}}{}", ",{}".repeat(1_000_001));
    check_forged_list("{\"agents\":[{}", &crowd, "at most a million agents");
}

#[test]
fn a_forged_count_or_id_of_a_frame_is_rejected() {
    let (path, _) = written("forged_frame");
    let bytes = fs::read(&path).unwrap();
    let check = |change: &dyn Fn(&mut Vec<u8>)| {
        let mut all = chunks(&bytes);
        change(&mut all[2].1);
        fs::write(&path, file_of(&all)).unwrap();
        let error = read_all(&path).unwrap_err();
        assert!(error.to_string().contains("byte "), "{error}");
        Recording::open(&path).unwrap().read_positions(1).is_err()
    };
    for count in [0_u32, 2, 4, 1_000_001, u32::MAX] {
        assert!(check(&|payload| payload[4..8].copy_from_slice(&count.to_le_bytes())));
    }
    // The rows are transposed, so the first bytes of the ids stand first, and the states' after them.
    let at = |byte: usize, value: u8| {
        move |payload: &mut Vec<u8>| {
            let mut rows = Vec::new();
            std::io::Read::read_to_end(&mut flate2::read::ZlibDecoder::new(&payload[8..]), &mut rows).unwrap();
            rows[byte] = value;
            let start = payload[..8].to_vec();
            *payload = [start, zipped(&rows)[4..].to_vec()].concat();
        }
    };
    // Positions are read without states.
    for (byte, value, has_no_positions) in [(0, 1, true), (2, 1, true), (9, 255, true), (12, 2, false), (15, 1, false)]
    {
        assert_eq!(check(&at(byte, value)), has_no_positions, "{byte}");
    }
}

#[test]
fn header_without_later_keys_is_read() {
    let (path, _) = written("early");
    let mut all = chunks(&fs::read(&path).unwrap());
    let text = unzipped(&all[0].1);
    // A file of an earlier program lacks keys, one of a later program has more.
    let (before, rest) = text.split_once("\"sources\":[").unwrap();
    let after = rest.split_once("}],").unwrap().1;
    let text = format!("{before}\"weather\":{{\"rain\":[1]}},{after}").replace(",\"at_goal\":\"stay\"", "");
    all[0].1 = zipped(text.as_bytes());
    let agents = unzipped(&all.last().unwrap().1);
    let agents = agents.split_once(",\"sources\"").unwrap().0.replace(",\"source\":0", "").replace("\"source\":0,", "");
    all.last_mut().unwrap().1 = zipped(format!("{agents}}}").as_bytes());
    fs::write(&path, file_of(&all)).unwrap();
    let recording = Recording::open(&path).unwrap();
    let mut expected = wide_header();
    expected.scenario.sources.clear();
    assert_eq!(recording.header(), &expected);
}

/// A recording that an earlier program wrote.
fn golden(version: u32) -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join(format!("tests/golden/version_{version}.fbrec"))
}

/// The files stay as the first programs of versions 2 and 3 wrote them, so that no key without a default is added.
#[test]
fn versions_2_and_3_are_read() {
    for (version, slide_cm_s, facing_offset_rad) in [(2, 0.0, 0.0), (3, SLIDE_CM_S, FACING_OFFSET_RAD)] {
        let recording = Recording::open(&golden(version)).unwrap();
        assert_eq!((recording.header(), recording.population()), (&wide_header(), &population(&wide_header())));
        let frames = read_all(&golden(version)).unwrap();
        assert_eq!(frames.len(), PRESENT.len());
        let is_close = |agent: &AgentFrame| {
            let off = [agent.examples_slide_cm_s - slide_cm_s, agent.facing_offset_rad - facing_offset_rad];
            off.iter().all(|off| off.abs() < 1e-4)
        };
        assert!(frames.iter().flatten().all(is_close), "version {version}: {:?}", frames[0][0]);
    }
}

#[test]
fn version_1_is_read() {
    let path = golden(1);
    let recording = Recording::open(&path).unwrap();
    let header = recording.header();
    assert_eq!((header.scenario.name.as_str(), header.scenario.agents.len()), ("walkers", 7));
    assert_eq!((header.databases.len(), header.states.len(), recording.frame_count()), (1, 1, 17));
    assert!(header.scenario.agents.iter().all(|agent| agent.wall_radius_m == agent.radius_m));
    assert_eq!(recording.population(), &Population::of(&header.scenario));
    let frames = read_all(&path).unwrap();
    assert!(frames.iter().all(|agents| agents.iter().map(|agent| agent.id.0).eq(0..7)));
    let first_m: Vec<_> = frames[0].iter().map(|agent| (agent.id, agent.root.position_m)).collect();
    assert_eq!(recording.read_positions(0).unwrap(), first_m);
    let walked_m = frames[16][0].root.position_m.distance(header.scenario.agents[0].position_m);
    assert!((walked_m - 2.2).abs() < 0.5, "{walked_m} m");
    assert_eq!(measure(&recording).unwrap().agents, 7);
}

#[test]
fn every_cut_or_altered_version_1_is_rejected() {
    let (bytes, path) = (fs::read(golden(1)).unwrap(), folder("old").join("a.fbrec"));
    for at in (0..bytes.len()).step_by(37) {
        fs::write(&path, &bytes[..at]).unwrap();
        assert!(read_all(&path).is_err(), "cut at {at}");
        let mut altered = bytes.clone();
        altered[at] ^= 0x10;
        fs::write(&path, altered).unwrap();
        assert!(read_all(&path).is_err(), "altered at {at}");
    }
}

fn measures() -> Measures {
    measure(&written("measures").1).unwrap()
}

#[test]
fn measures_count_present_agents() {
    let measures = measures();
    assert_eq!((measures.agents, measures.born, measures.removed, measures.waiting), (5, 3, 2, 2));
    assert_eq!((measures.steps, measures.source_blocked_s), (4, 1.0));
    // Steps of agents in both frames: 2, 2, 2 and 3. Each agent's first step is from rest to 1 m/s: 4 m/s² for 5 of 9.
    assert!((measures.mean_acceleration_mps2 - 5.0 * 4.0 / 9.0).abs() < 1e-6, "{}", measures.mean_acceleration_mps2);
}

#[test]
fn collisions_count_pairs_that_are_present() {
    // 1 and 0 stand 0.25 m apart, a depth of one half, while 1 is present: one of two steps.
    let header = header(vec![agent([0.0, 0.0], [9.0, 0.0]), agent([0.0, 0.25], [9.0, 0.0])], DT_S);
    let path = folder("pairs").join("a.fbrec");
    let mut recorder = Recorder::create(&path, &header).unwrap();
    let stand = |id: u32| AgentFrame { id: AgentId(id), ..standing_at(Vec2::new(0.0, 0.25 * id as f32)) };
    for ids in [&[0, 1][..], &[0, 1], &[0]] {
        recorder.push(&ids.iter().map(|&id| stand(id)).collect::<Vec<_>>()).unwrap();
    }
    recorder.finish(&Population::of(&header.scenario)).unwrap();
    let measures = measure(&Recording::open(&path).unwrap()).unwrap();
    assert_eq!(measures.collision_rate, 0.5 / 3.0);
    assert_eq!((measures.removed, measures.minimum_separation_m), (1, Some(0.25)));
}

#[test]
fn time_to_goal_counts_from_birth() {
    let mut header = wide_header();
    // Agent 2 is born in frame 1 at (0.25, 20); half a metre before its goal it has arrived, in frame 3.
    header.scenario.sources[0].goals_m = vec![Vec2::new(1.24, 20.0)];
    let path = folder("from_birth").join("a.fbrec");
    write(&path, &header, &population(&header));
    let measures = measure(&Recording::open(&path).unwrap()).unwrap();
    assert_eq!((measures.arrived, measures.mean_time_to_goal_s), (1, Some(0.5)));
}

#[test]
fn tables_have_rows_of_present_agents() {
    let (_, recording) = written("rows");
    let mut text = Vec::new();
    write_trajectories(&recording, &mut text).unwrap();
    let text = String::from_utf8(text).unwrap();
    let lines: Vec<&str> = text.lines().collect();
    assert_eq!(lines.len(), 1 + 14);
    assert_eq!(
        [lines[0], lines[3], lines[5]],
        ["# frame id x_m y_m", "1 0 0.250000 0.000000", "1 2 0.250000 20.000000"]
    );
    let mut table = Vec::new();
    write_table(&recording, &mut table).unwrap();
    let table = String::from_utf8(table).unwrap();
    let rows: Vec<Vec<&str>> = table.lines().skip(1).map(|row| row.split(',').collect()).collect();
    let ids: Vec<u32> = rows.iter().map(|row| row[2].parse().unwrap()).collect();
    assert_eq!(ids, PRESENT.concat());
    // Agent 2 starts from rest in frame 1 and walks in frame 2.
    assert_eq!([rows[4][6], rows[6][6]], ["0.000000", "1.000000"]);
}

/// A header with an agent that stands at the origin, and a door of 2 m by 2 m beside it that is open at the start.
fn header_with_door() -> Header {
    let mut header = header(vec![agent([0.0, 0.0], [5.0, 0.0])], DT_S);
    let polygon_m = [[0.1, -1.0], [2.1, -1.0], [2.1, 1.0], [0.1, 1.0]].map(Vec2::from).to_vec();
    header.scenario.doors = vec![DoorSpec { polygon_m, signal: 0 }];
    header.scenario.behaviour.signals = vec![Signal { name: "gate".into(), green_s: 0.5, red_s: 9.0, offset_s: 0.0 }];
    header
}

/// Records five frames in which the agent stands, with these phases of the door.
fn record_door(test: &str, changes: &[u32]) -> Result<Recording, RecordingError> {
    let (path, header) = (folder(test).join("a.fbrec"), header_with_door());
    let mut recorder = Recorder::create(&path, &header)?;
    (0..5).try_for_each(|_| recorder.push(&[standing_at(Vec2::ZERO)]))?;
    let mut population = Population::of(&header.scenario);
    population.doors[0].changes = changes.to_vec();
    recorder.finish(&population)?;
    Recording::open(&path)
}

#[test]
fn doors_come_back_and_walls_are_measured_while_they_are_closed() {
    let recording = record_door("doors", &[2, 4]).unwrap();
    let doors = [DoorPhases { is_closed_at_start: false, changes: vec![2, 4] }];
    assert_eq!(recording.population().doors, doors);
    let closed: Vec<bool> = (0..5).map(|frame| doors[0].is_closed(frame)).collect();
    assert_eq!(closed, [false, false, true, true, false]);
    // Two of four frames after the start.
    assert_eq!(measure(&recording).unwrap().wall_disc_share, 0.5);
}

#[test]
fn forged_phases_of_doors_are_rejected() {
    for (index, changes) in [&[0][..], &[5], &[3, 2], &[2, 2]].into_iter().enumerate() {
        let error = record_door(&format!("forged_doors_{index}"), changes).unwrap_err();
        assert!(error.to_string().contains("door 0: a frame is out of range"), "{error}");
    }
}

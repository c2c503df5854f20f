//! Header and index of version 1.

use glam::Vec2;
use serde::Deserialize;

use crate::planning::Planner;
use crate::recording::chunk::ChunkFile;
use crate::recording::error::RecordingError;
use crate::recording::format::{HEAD, HEAD_BYTE, INDEX};
use crate::recording::header::{Header, RecordedDatabase};
use crate::recording::reader::INDEX_LIMIT_BYTES;
use crate::recording::version_1::body::{SkeletonV1, VelocityHullV1};
use crate::recording::version_1::params::ParamsV1;
use crate::scenario::{AgentSpec, Coupling, Scenario, View};

/// Size beyond which no header is decoded, bytes; that of a million agents with ten waypoints each has 150 MB.
const HEADER_LIMIT_BYTES: usize = 256 << 20;

/// The header as version 1 wrote it.
#[derive(Deserialize)]
struct HeaderV1 {
    database_checksum: u32,
    skeleton: SkeletonV1,
    velocity_hull: VelocityHullV1,
    scenario: ScenarioV1,
}

#[derive(Deserialize)]
struct ScenarioV1 {
    name: String,
    duration_s: f32,
    dt_s: f32,
    seed: u64,
    planner: PlannerV1,
    coupling: CouplingV1,
    agents: Vec<AgentSpecV1>,
    obstacles_m: Vec<Vec<Vec2>>,
    params: ParamsV1,
    view: ViewV1,
}

#[derive(Deserialize)]
enum PlannerV1 {
    Mcn,
    Orca,
    SocialForce,
}

#[derive(Deserialize)]
enum CouplingV1 {
    TwoWay,
    Discs,
    Decoupled,
}

#[derive(Deserialize)]
struct AgentSpecV1 {
    position_m: Vec2,
    facing_rad: f32,
    goals_m: Vec<Vec2>,
    radius_m: f32,
    preferred_speed_mps: f32,
}

#[derive(Deserialize)]
struct ViewV1 {
    width: u32,
    height: u32,
    frame_rate_hz: f32,
    centre_m: Option<Vec2>,
    width_m: Option<f32>,
    trail_s: f32,
    labels: bool,
}

/// Decodes and checks the `HEAD` chunk of a file of version 1.
pub(crate) fn read_header(file: &ChunkFile) -> Result<Header, RecordingError> {
    let payload = file.read_chunk(HEAD_BYTE, HEAD, HEADER_LIMIT_BYTES as u64)?;
    let config = bincode::config::standard().with_fixed_int_encoding().with_limit::<HEADER_LIMIT_BYTES>();
    let (header, used) = bincode::serde::decode_from_slice::<HeaderV1, _>(&payload, config)
        .map_err(|error| file.damaged(HEAD_BYTE, format!("the header cannot be decoded ({error})")))?;
    if used != payload.len() {
        return Err(file.damaged(HEAD_BYTE, "the header is longer than its content"));
    }
    let header = Header::from(header);
    header.check().map_err(|what| file.damaged(HEAD_BYTE, what))?;
    Ok(header)
}

/// The byte at which each frame's chunk begins, from an index of version 1.
pub(crate) fn read_index(file: &ChunkFile, index_byte: u64) -> Result<Vec<u64>, RecordingError> {
    let index = file.read_chunk(index_byte, INDEX, INDEX_LIMIT_BYTES)?;
    let (bytes @ [_, ..], []) = index.as_chunks::<8>() else {
        return Err(file.damaged(index_byte, "the index is empty or not whole"));
    };
    let frame_bytes: Vec<u64> = bytes.iter().map(|byte| u64::from_le_bytes(*byte)).collect();
    // So that a short file cannot claim many frames.
    if !frame_bytes.is_sorted_by(|a, b| a < b) {
        return Err(file.damaged(index_byte, "the index does not rise"));
    }
    Ok(frame_bytes)
}

impl From<HeaderV1> for Header {
    fn from(header: HeaderV1) -> Self {
        let HeaderV1 { database_checksum, skeleton, velocity_hull, scenario } = header;
        let (skeleton, velocity_hull) = (skeleton.into(), velocity_hull.into());
        Self::of(
            RecordedDatabase { checksum: database_checksum, skeleton, velocity_hull, style: String::new() },
            scenario.into(),
        )
    }
}

impl From<ScenarioV1> for Scenario {
    fn from(scenario: ScenarioV1) -> Self {
        let ScenarioV1 { name, duration_s, dt_s, seed, planner, coupling, agents, obstacles_m, params, view } =
            scenario;
        Self {
            name,
            duration_s,
            dt_s,
            seed,
            planner: match planner {
                PlannerV1::Mcn => Planner::Mcn,
                PlannerV1::Orca => Planner::Orca,
                PlannerV1::SocialForce => Planner::SocialForce,
            },
            coupling: match coupling {
                CouplingV1::TwoWay => Coupling::TwoWay,
                CouplingV1::Discs => Coupling::Discs,
                CouplingV1::Decoupled => Coupling::Decoupled,
            },
            obstacles_m,
            params: params.into(),
            view: view.into(),
            ..Self::of(agents.into_iter().map(AgentSpec::from).collect())
        }
    }
}

impl From<AgentSpecV1> for AgentSpec {
    fn from(agent: AgentSpecV1) -> Self {
        let AgentSpecV1 { position_m, facing_rad, goals_m, radius_m, preferred_speed_mps } = agent;
        let wall_radius_m = radius_m;
        Self { position_m, facing_rad, goals_m, radius_m, wall_radius_m, preferred_speed_mps, ..Self::default() }
    }
}

impl From<ViewV1> for View {
    fn from(view: ViewV1) -> Self {
        let ViewV1 { width, height, frame_rate_hz, centre_m, width_m, trail_s, labels } = view;
        Self { width, height, frame_rate_hz, centre_m, width_m, trail_s, labels }
    }
}

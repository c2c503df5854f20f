//! The header of a recording: what holds for all its frames, and the checks that let readers trust its numbers.

use glam::Vec3;
use motiondb::body::{BONE_MAX_M, LIMIT_MAX_RAD, Skeleton};
use motiondb::motion::MotionDb;
use motiondb::velocity_sets::velocity_hull::VelocityHull;
use serde::{Deserialize, Serialize};

use crate::recording::chunk::ChunkFile;
use crate::recording::error::RecordingError;
use crate::recording::format::{HEAD, HEAD_BYTE};
use crate::scenario::Scenario;
use crate::scenario::ranges::check_ranges;

/// Greatest velocity of a set, m/s; none of a body comes near.
const SPEED_MAX_MPS: f32 = 100.0;
/// Size beyond which no header is decoded, bytes; that of a million agents with ten waypoints each has 150 MB.
const HEADER_LIMIT_BYTES: usize = 256 << 20;

/// What holds for all frames of a recording. No timings, no dates, no paths.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Header {
    /// CRC-32 of the database that the bodies came from.
    pub database_checksum: u32,
    /// The bodies: bones, soles, capsules.
    pub skeleton: Skeleton,
    /// Velocity sets of the database: with them, any step can be planned again.
    pub velocity_hull: VelocityHull,
    /// The whole scenario: agents, obstacles, tunables, time step, view.
    pub scenario: Scenario,
}

impl Header {
    /// The header of a scenario with bodies from a database.
    pub fn new(db: &MotionDb, database_checksum: u32, scenario: Scenario) -> Self {
        let (skeleton, velocity_hull) = (db.skeleton.clone(), db.velocity_hull.clone());
        Self { database_checksum, skeleton, velocity_hull, scenario }
    }

    /// The payload of the `HEAD` chunk.
    pub(crate) fn encode(&self) -> Result<Vec<u8>, bincode::error::EncodeError> {
        bincode::serde::encode_to_vec(self, bincode_config())
    }

    /// Decodes and checks the `HEAD` chunk of a file.
    pub(crate) fn decode(file: &ChunkFile) -> Result<Self, RecordingError> {
        let payload = file.read_chunk(HEAD_BYTE, HEAD, HEADER_LIMIT_BYTES as u64)?;
        let (header, used) = bincode::serde::decode_from_slice::<Self, _>(&payload, bincode_config())
            .map_err(|error| file.damaged(HEAD_BYTE, format!("the header cannot be decoded ({error})")))?;
        if used != payload.len() {
            return Err(file.damaged(HEAD_BYTE, "the header is longer than its content"));
        }
        check_ranges(&header.scenario).map_err(|fault| file.damaged(HEAD_BYTE, fault.message))?;
        if !is_in_range(&header.skeleton) {
            return Err(file.damaged(HEAD_BYTE, "the skeleton is out of range"));
        }
        if !is_reachable(&header.velocity_hull) {
            return Err(file.damaged(HEAD_BYTE, "the velocity sets are out of range"));
        }
        Ok(header)
    }
}

fn bincode_config() -> impl bincode::config::Config {
    bincode::config::standard().with_fixed_int_encoding().with_limit::<HEADER_LIMIT_BYTES>()
}

/// Whether every bone, point and limit of a skeleton is finite and within [`BONE_MAX_M`] and [`LIMIT_MAX_RAD`]. Every
/// valid database satisfies this.
fn is_in_range(skeleton: &Skeleton) -> bool {
    let is_within = |max: f32| move |vector: Vec3| vector.is_finite() && vector.abs().max_element() <= max;
    let feet = skeleton.feet.iter();
    let points_m = feet.flat_map(|foot| [foot.heel_m, foot.ball_m, foot.toe_tip_m].into_iter().chain(foot.measured_m));
    let vectors = [skeleton.offsets_m, skeleton.segment_ends_m].into_iter().flatten();
    vectors.chain(points_m).all(is_within(BONE_MAX_M))
        && skeleton.limits_rad.iter().flatten().copied().all(is_within(LIMIT_MAX_RAD))
        && skeleton.segment_radii_m.iter().all(|radius_m| (0.0..=BONE_MAX_M).contains(radius_m))
}

/// Whether every velocity of the sets is finite and no faster than [`SPEED_MAX_MPS`].
fn is_reachable(hull: &VelocityHull) -> bool {
    let corners_mps = hull.turning_mps.iter().chain(&hull.holding_mps).chain(hull.sharp_turn_edges_mps.as_flattened());
    corners_mps.copied().all(|corner_mps| corner_mps.is_finite() && corner_mps.length() <= SPEED_MAX_MPS)
}

//! Queueing: an agent that waits behind others holds its place. `FbCrowd` does not have it.
//!
//! Agents that arrive at a queue approach those that stand there, and by equal shares these give way, also backward and
//! by metres. People who wait do not. So where the agents ahead go where the agent goes, a half-plane forbids velocities
//! against v_pref. It yields as those of agents do, so that overlapping discs still part. Where streams cross, the agents
//! ahead go elsewhere, and it has no weight: jams dissolve by stepping back.
//!
//! With the directions e of the preferred velocities, the urgency w_j of a neighbour j (`avoidance`), and the share a_j of
//! its offset along e_i, agent i queues by the share
//!
//! ```text
//! q = max(0, Σ_j w_j·a_j·(e_i·e_j) / Σ_j w_j·a_j)²,
//! ```
//!
//! and the weight of the half-plane is W·q. Discs that overlap by a millimetre still part at .1 m/s and more. People in a
//! throng touch, and do not step back for it: a body whose agent plans to go backward at less than C·q·(1 − P·p)
//! stands instead, unless its disc overlaps another by more than D. Arches before doors dissolve only because bodies step
//! back. So this speed falls with the greatest conflict p of the agent with a neighbour near by (`pressing`).
//!
//! A body that rests where its agent wants to stand does not step aside, either, for a slow plan: agents that come near
//! would move it by a few centimetres each.
//!
//! World axes, m/s.

use glam::Vec2;

use crate::planning::mcn::memory::McnMemory;
use crate::planning::orca::half_plane::{HalfPlane, HalfPlaneSource};
use crate::planning::world_view::WorldView;
use crate::world::neighbours::Neighbour;
use crate::world::neighbours::neighbour_lanes::Lanes;

/// W: weight of the half-plane where all agents ahead go the same way; that of an agent in contact is 1.
const WEIGHT: f32 = 0.7;
/// Weight below which there is no half-plane. Weights matter only where not all half-planes can be kept: elsewhere a
/// half-plane of the least weight would be kept in full.
const WEIGHT_MIN: f32 = 0.02;
/// C: speed below which no body goes backward where all agents ahead go the same way, m/s (docs/tuning.md).
const BACK_MIN_MPS: f32 = 0.45;
/// P: share by which that speed falls for an agent in full conflict with a neighbour (docs/tuning.md).
const CONFLICT_SHARE: f32 = 0.5;
/// D: overlap of two discs from which bodies part, m: shoulders yield that much, chests do not (docs/tuning.md).
const OVERLAP_MAX_M: f32 = 0.05;
/// Cosine of the angle to the direction against v_pref within which a velocity leads backward: 78°. The half-plane brings
/// many velocities to 90°, where rounding would decide.
const BACK_COS: f32 = 0.2;

/// Speed below which a body that rests, where its agent wants to stand, does not step aside, m/s (docs/tuning.md).
const ASIDE_MIN_MPS: f32 = 0.2;
/// Overlap of its disc with another from which such a body steps aside, m.
const RESTING_OVERLAP_MAX_M: f32 = 0.01;
/// Speed below which a body rests, m/s.
const RESTING_MPS: f32 = 0.03;

/// q: share by which an agent queues behind its neighbours, given their urgencies, 0 to 1.
pub(crate) fn queueing_share(world: &WorldView, agent: usize, neighbours: &[Neighbour], urgencies: &Lanes) -> f32 {
    let own_direction = world.preferred_direction(agent);
    let (mut alike, mut all) = (0.0, 0.0_f32);
    for (neighbour, urgency) in neighbours.iter().zip(urgencies) {
        let ahead = urgency * own_direction.dot(neighbour.offset_m.normalize_or_zero()).max(0.0);
        alike += ahead * own_direction.dot(world.preferred_direction(neighbour.agent as usize));
        all += ahead;
    }
    let share = if all > 0.0 { (alike / all).max(0.0) } else { 0.0 };
    share * share
}

/// The half-plane of an agent that queues by a share; none where it hardly does.
pub(crate) fn queue_half_plane(world: &WorldView, agent: usize, queueing_share: f32) -> Option<HalfPlane> {
    let weight = WEIGHT * queueing_share;
    let half_plane = HalfPlane::behind(Vec2::ZERO, -world.preferred_direction(agent), HalfPlaneSource::Queue);
    (weight > WEIGHT_MIN).then_some(HalfPlane { weight, ..half_plane })
}

/// C·q·(1 − P·p): speed below which the body of an agent does not go backward, m/s, given q and p.
pub(crate) fn back_min_mps(queueing_share: f32, greatest_conflict: f32) -> f32 {
    BACK_MIN_MPS * queueing_share * (1.0 - CONFLICT_SHARE * greatest_conflict)
}

/// Whether the body of an agent stands, rather than go backward or aside at a planned velocity.
pub(crate) fn waits(world: &WorldView, agent: usize, memory: &McnMemory, velocity_mps: Vec2) -> bool {
    let (speed_mps, back_mps) = (velocity_mps.length(), -world.preferred_direction(agent).dot(velocity_mps));
    let rests = world.preferred_mps[agent] == Vec2::ZERO && world.velocities_mps[agent].length() < RESTING_MPS;
    let goes_back = back_mps > BACK_COS * speed_mps;
    let (slower_than_mps, overlap_max_m) = match (rests, goes_back) {
        (true, _) => (ASIDE_MIN_MPS, RESTING_OVERLAP_MAX_M),
        (false, true) => (memory.back_min_mps, OVERLAP_MAX_M),
        (false, false) => return false,
    };
    let is_apart = |neighbour: &Neighbour| neighbour.radius_m - neighbour.distance_m <= overlap_max_m;
    speed_mps < slower_than_mps && memory.surroundings.neighbours.as_slice().iter().all(is_apart)
}

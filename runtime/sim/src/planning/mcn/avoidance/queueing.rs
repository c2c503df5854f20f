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

/// Whether the body of an agent waits in a queue, rather than go backward at a planned velocity.
pub(crate) fn waits(world: &WorldView, agent: usize, memory: &McnMemory, velocity_mps: Vec2) -> bool {
    let (speed_mps, back_mps) = (velocity_mps.length(), -world.preferred_direction(agent).dot(velocity_mps));
    back_mps > BACK_COS * speed_mps
        && speed_mps < memory.back_min_mps
        && memory.surroundings.greatest_overlap_m() <= OVERLAP_MAX_M
}

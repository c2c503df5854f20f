//! Resting: a body that rests where its agent wants to stand stays there. `FbCrowd` does not have it.
//!
//! An agent that wants to stand gives way to agents that come near, as all do, and its body would take a small step for
//! each of them. People who stand do not step aside for others that come slowly near. So the body stays while the plan is
//! slow and its disc hardly overlaps another; it gives way to agents that walk by. World axes, m/s.

use glam::Vec2;

use crate::planning::surroundings::Surroundings;
use crate::planning::world_view::WorldView;

/// Planned speed from which a body gives way, m/s (docs/tuning.md). In steps of .1 s a plan from rest is as fast at once, so
/// that bodies give way.
const GIVES_WAY_MPS: f32 = 0.2;
/// Overlap of its disc with another from which a body gives way, m.
const OVERLAP_MAX_M: f32 = 0.01;
/// Speed below which a body rests, m/s.
const RESTING_MPS: f32 = 0.03;

/// Whether the body of an agent stays where it is, rather than give way at a planned velocity.
pub(crate) fn stays(world: &WorldView, agent: usize, surroundings: &Surroundings, velocity_mps: Vec2) -> bool {
    let rests = world.preferred_mps[agent] == Vec2::ZERO && world.velocities_mps[agent].length() < RESTING_MPS;
    rests && velocity_mps.length() < GIVES_WAY_MPS && surroundings.greatest_overlap_m() <= OVERLAP_MAX_M
}

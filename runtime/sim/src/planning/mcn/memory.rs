//! MCN's working memory: what one plan leaves for the next, so that no plan allocates, and for an explanation of it.

use glam::Vec2;

use crate::planning::orca::half_plane::HalfPlane;
use crate::planning::plan::VelocitySet;
use crate::planning::surroundings::Surroundings;

/// Working memory of MCN for one thread. World axes, m/s.
#[derive(Clone, Debug, Default)]
pub(crate) struct McnMemory {
    /// What the agent sees.
    pub(crate) surroundings: Surroundings,
    /// v_op, m/s.
    pub(crate) adapted_mps: Vec2,
    /// Unit vector along the agent's facing.
    pub(crate) forward: Vec2,
    /// C_iW: half-planes of walls, which the programs of both velocity sets share.
    pub(crate) of_walls: Vec<HalfPlane>,
    /// C_ij: half-planes of agents and of the queue, which the programs of both velocity sets share.
    pub(crate) of_agents: Vec<HalfPlane>,
    /// Speed below which the agent's body stands rather than go backward ([`crate::planning::mcn::avoidance`]), m/s.
    pub(crate) back_min_mps: f32,
    /// Half-planes of each velocity set's program, by rank.
    pub(crate) programs: [Vec<HalfPlane>; 2],
    /// The velocity set that was chosen.
    pub(crate) set: VelocitySet,
    /// Working memory of the 3D program.
    pub(crate) projected: Vec<HalfPlane>,
}

impl McnMemory {
    /// The half-planes of the last plan, by rank: walls, stance, sharp turn, hull, agents.
    pub(crate) fn half_planes(&self) -> &[HalfPlane] {
        &self.programs[self.set as usize]
    }

    /// Bytes that the lists hold on the heap.
    pub(crate) fn heap_bytes(&self) -> usize {
        let [turning, holding] = &self.programs;
        let lists = [turning, holding, &self.projected, &self.of_walls, &self.of_agents];
        let half_planes: usize = lists.iter().map(|list| list.capacity()).sum();
        self.surroundings.heap_bytes() + half_planes * size_of::<HalfPlane>()
    }
}

//! The plans of a whole crowd, on all threads.
//!
//! Agents are planned in the order of the grid's cells, not of their indices: consecutive agents share most neighbours,
//! which are then in the cache, so an agent costs the same in a crowd of a hundred thousand as in one of a thousand.
//! Every plan is made from the frozen view alone, so neither the order nor the number of threads changes a bit.

use rayon::prelude::*;

use crate::params::Params;
use crate::planning::plan::Plan;
use crate::planning::planner::{self, Planner, PlannerMemory};
use crate::planning::world_view::WorldView;

/// Fewest agents that one thread takes at a time: enough to outweigh the hand-over, few enough to share out 100.
const CHUNK_MIN: usize = 16;
/// Chunks per thread in a large crowd: threads wait for the last chunk by less than a hundredth.
const CHUNKS: usize = 64;

/// Working memory of [`plan_all`], kept from step to step so that no step allocates.
#[derive(Clone, Debug, Default)]
pub struct CrowdPlanningMemory {
    in_cell_order: Vec<Plan>,
    /// One per chunk.
    chunk_memories: Vec<PlannerMemory>,
}

impl CrowdPlanningMemory {
    /// Bytes that the memory holds.
    pub fn size_bytes(&self) -> usize {
        size_of_val(&*self.in_cell_order) + self.chunk_memories.iter().map(PlannerMemory::size_bytes).sum::<usize>()
    }
}

/// Plans every agent; `plans` is by agent.
pub fn plan_all(
    planner: Planner,
    world: &WorldView,
    params: &Params,
    memory: &mut CrowdPlanningMemory,
    plans: &mut [Plan],
) {
    let agents = world.neighbours.in_cell_order();
    let CrowdPlanningMemory { in_cell_order, chunk_memories } = memory;
    in_cell_order.resize(agents.len(), Plan::default());
    let chunk = agents.len().div_ceil(CHUNKS * rayon::current_num_threads()).max(CHUNK_MIN);
    chunk_memories.resize_with(agents.len().div_ceil(chunk), PlannerMemory::default);
    let chunks = in_cell_order.par_chunks_mut(chunk).zip(agents.par_chunks(chunk)).zip(chunk_memories);
    chunks.for_each(|((planned, agents), memory)| {
        for (plan, &agent) in planned.iter_mut().zip(agents) {
            *plan = planner::plan(planner, world, agent as usize, params, memory);
        }
    });
    for (&plan, &agent) in in_cell_order.iter().zip(agents) {
        plans[agent as usize] = plan;
    }
}

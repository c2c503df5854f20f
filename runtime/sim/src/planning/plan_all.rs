//! The plans of a whole crowd, on all threads.
//!
//! Agents are taken in the order of the grid's cells, not of their indices: whoever comes next has mostly the same
//! neighbours, still in the cache, so an agent costs the same in a crowd of a hundred thousand as in one of a thousand.
//! Every plan is made from the frozen world alone, so neither that order nor the number of threads changes a bit.

use rayon::prelude::*;

use crate::params::Params;
use crate::planning::plan::Plan;
use crate::planning::planner::{self, Planner, Scratch};
use crate::planning::world_view::World;

/// Agents that one thread takes at a time, at least: enough to outweigh the hand-over, few enough to share out 100.
const CHUNK_MIN: usize = 16;
/// Chunks for each thread, of a great crowd: the last to be planned is waited for by less than a hundredth.
const CHUNKS: usize = 64;

/// Working memory, kept from step to step so that none is asked for in one.
#[derive(Clone, Debug, Default)]
pub struct Memory {
    in_cell_order: Vec<Plan>,
    /// Of each chunk.
    scratches: Vec<Scratch>,
}

impl Memory {
    /// What it is, bytes.
    pub fn size_bytes(&self) -> usize {
        size_of_val(&*self.in_cell_order) + self.scratches.iter().map(Scratch::size_bytes).sum::<usize>()
    }
}

/// Plans every agent; `plans` is by agent.
pub fn plan_all(planner: Planner, world: &World, params: &Params, memory: &mut Memory, plans: &mut [Plan]) {
    let agents = world.neighbours.in_cell_order();
    let Memory { in_cell_order, scratches } = memory;
    in_cell_order.resize(agents.len(), Plan::default());
    let chunk = agents.len().div_ceil(CHUNKS * rayon::current_num_threads()).max(CHUNK_MIN);
    scratches.resize_with(agents.len().div_ceil(chunk), Scratch::default);
    let chunks = in_cell_order.par_chunks_mut(chunk).zip(agents.par_chunks(chunk)).zip(scratches);
    chunks.for_each(|((planned, agents), scratch)| {
        for (plan, &agent) in planned.iter_mut().zip(agents) {
            *plan = planner::plan(planner, world, agent as usize, params, scratch);
        }
    });
    for (&plan, &agent) in in_cell_order.iter().zip(agents) {
        plans[agent as usize] = plan;
    }
}

//! The plans of a whole crowd, on all threads.
//!
//! Agents are taken in the order of the grid's cells, not of their indices: whoever comes next has mostly the same
//! neighbours, still in the cache, so an agent costs the same in a crowd of a hundred thousand as in one of a thousand.
//! Every plan is made from the frozen world alone, so neither that order nor the number of threads changes a bit.

use rayon::prelude::*;

use crate::params::Params;
use crate::plan::Plan;
use crate::planner::{self, Planner, Scratch};
use crate::world::World;

/// Agents that one thread takes at a time: enough to outweigh the hand-over, few enough to share out 100 agents.
const CHUNK: usize = 16;

/// Plans every agent; `plans` is by agent, `in_cell_order` is working memory.
pub fn plan_all(planner: Planner, world: &World, params: &Params, in_cell_order: &mut Vec<Plan>, plans: &mut [Plan]) {
    let agents = world.neighbours.in_cell_order();
    in_cell_order.resize(agents.len(), Plan::default());
    let chunks = in_cell_order.par_chunks_mut(CHUNK).zip(agents.par_chunks(CHUNK));
    chunks.for_each_init(Scratch::default, |scratch, (planned, agents)| {
        for (plan, &agent) in planned.iter_mut().zip(agents) {
            *plan = planner::plan(planner, world, agent as usize, params, scratch);
        }
    });
    for (&plan, &agent) in in_cell_order.iter().zip(agents) {
        plans[agent as usize] = plan;
    }
}

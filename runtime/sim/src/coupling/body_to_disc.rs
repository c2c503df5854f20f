//! CNS, coupled navigation and synthesis (`FbCrowd` §3.4): the disc takes position and facing from the body *as
//! synthesised*, and the planner reads the stance foot.
//!
//! World frame; metres, seconds, radians.

use glam::Vec2;
use motiondb::body::Root;

use crate::agents::Agents;
use crate::planning::plan::Plan;
use crate::synthesis::SynthesisContext;
use crate::synthesis::library::context_of;
use crate::world::obstacles::Obstacles;

/// The root of a disc that moves as planned.
pub fn as_planned(root: Root, plan: &Plan, dt_s: f32) -> Root {
    Root { position_m: root.position_m + dt_s * plan.velocity_mps, facing_rad: plan.facing_rad }
}

/// The root where its disc ends that walls hold, swept along its path from `from_m`, where it was before the step.
pub fn outside_walls(from_m: Vec2, root: Root, wall_radius_m: f32, obstacles: &Obstacles) -> Root {
    Root { position_m: obstacles.clamp_path(from_m, root.position_m, wall_radius_m), ..root }
}

/// Updates what planners read of the agents from the bodies and plans of a step; `contexts` are those of all styles.
pub(crate) fn synchronize(agents: &mut Agents, contexts: &[SynthesisContext], dt_s: f32) {
    for (index, (body, stature)) in agents.bodies.iter().zip(&agents.statures).enumerate() {
        let context = context_of(contexts, agents.styles[index]);
        let root = stature.root_of_crowd(body.root);
        let moved_m: Vec2 = root.position_m - agents.positions_m[index];
        let committed_mps = body.committed_mps(context).map(|committed_mps| stature.speed_factor() * committed_mps);
        agents.velocities_mps[index] = committed_mps.unwrap_or(moved_m / dt_s);
        agents.positions_m[index] = root.position_m;
        agents.facings_rad[index] = root.facing_rad;
        agents.planned_mps[index] = agents.plans[index].velocity_mps;
        agents.strafing_s[index] = agents.plans[index].strafing_s;
        agents.stepping_back_s[index] = agents.plans[index].stepping_back_s;
    }
}

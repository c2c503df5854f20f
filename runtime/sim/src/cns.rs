//! CNS, coupled navigation and synthesis (`FbCrowd` §3.4): the disc takes place and facing from the body *as
//! synthesised*, and the planner sees the foot that it stands on.

use glam::Vec2;
use motiondb::pose::Root;

use crate::agents::Agents;
use crate::obstacles::Obstacles;

/// The root kept out of walls, whatever the body wanted.
pub fn outside_walls(root: Root, radius_m: f32, obstacles: &Obstacles) -> Root {
    Root { position_m: obstacles.clamp_outside(root.position_m, radius_m), ..root }
}

/// Hands the bodies back to the planner.
pub fn synchronize(agents: &mut Agents, dt_s: f32) {
    for (index, body) in agents.bodies.iter().enumerate() {
        let moved_m: Vec2 = body.root.position_m - agents.positions_m[index];
        agents.velocities_mps[index] = moved_m / dt_s;
        agents.positions_m[index] = body.root.position_m;
        agents.facings_rad[index] = body.root.facing_rad;
        agents.stances[index] = agents.syntheses[index].stance;
        agents.strafing_s[index] = agents.plans[index].strafing_s;
        agents.stepping_back_s[index] = agents.plans[index].stepping_back_s;
    }
}

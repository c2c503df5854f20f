//! CNS, coupled navigation and synthesis (`FbCrowd` §3.4): the disc takes place and facing from the body *as
//! synthesised*, and the planner sees the foot that it stands on.

use glam::Vec2;
use motiondb::body::Root;
use serde::{Deserialize, Serialize};

use crate::agents::Agents;
use crate::planning::plan::Plan;
use crate::world::obstacles::Obstacles;

/// What moves the discs.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Coupling {
    /// The paper's: bodies follow the plans, and discs the bodies.
    #[default]
    TwoWay,
    /// Bodies off: each disc moves as planned and faces as planned at once, to compare planners alone. A recording
    /// shows bodies that stand and glide, no foot of which is planted.
    Discs,
    /// The user study's rival: discs move as planned, and bodies follow them exactly; see [`crate::coupling::decoupled`].
    Decoupled,
}

impl Coupling {
    /// Whether what is planned is carried out by bodies, which take it up later than a disc does.
    pub fn plans_for_bodies(self) -> bool {
        self == Self::TwoWay
    }
}

/// The root of a disc that moves as planned.
pub(crate) fn as_planned(root: Root, plan: &Plan, dt_s: f32) -> Root {
    Root { position_m: root.position_m + dt_s * plan.velocity_mps, facing_rad: plan.facing_rad }
}

/// The root kept out of walls, and on its side of them, whatever the body wanted; it stood at `from` before the step.
pub(crate) fn outside_walls(from_m: Vec2, root: Root, radius_m: f32, obstacles: &Obstacles) -> Root {
    Root { position_m: obstacles.clamp_way(from_m, root.position_m, radius_m), ..root }
}

/// Hands the bodies back to the planner.
pub(crate) fn synchronize(agents: &mut Agents, dt_s: f32) {
    for (index, body) in agents.bodies.iter().enumerate() {
        let moved_m: Vec2 = body.root.position_m - agents.positions_m[index];
        agents.velocities_mps[index] = body.committed_mps.unwrap_or(moved_m / dt_s);
        agents.positions_m[index] = body.root.position_m;
        agents.facings_rad[index] = body.root.facing_rad;
        agents.strafing_s[index] = agents.plans[index].strafing_s;
        agents.stepping_back_s[index] = agents.plans[index].stepping_back_s;
    }
}

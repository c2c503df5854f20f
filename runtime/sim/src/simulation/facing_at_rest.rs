//! What agents that stand turn to; by their plans alone they keep their facing (`FbCrowd` §4.5). World, metres, radians.

use glam::Vec2;

use crate::maths::angle::unit_vector;
use crate::planning::mcn::gradual_turn::TurningBody;
use crate::planning::mcn::orientation;
use crate::simulation::Simulation;

impl Simulation {
    /// Turns agents that stand around their goals to these, and others to the facing that their states want.
    pub(super) fn turn_at_rest(&mut self) {
        for index in 0..self.agents.count() {
            let plan = &self.agents.plans[index];
            let body_stands = plan.waits || orientation::stands(plan.velocity_mps);
            let facing_rad = || self.facing_of_taken_goal_rad(index).or_else(|| self.facing_of_state_rad(index));
            if body_stands && let Some(facing_rad) = facing_rad() {
                self.agents.plans[index].facing_rad = facing_rad;
            }
        }
    }

    /// Facing of an agent that stands around its goal, gradually towards this goal.
    fn facing_of_taken_goal_rad(&self, index: usize) -> Option<f32> {
        let agents = &self.agents;
        let goal_m = self.last_goal_m(index).filter(|_| agents.progress[index].stands_behind())?;
        let forward = unit_vector(agents.facings_rad[index]);
        let to_goal = (goal_m - agents.positions_m[index]).normalize_or(forward);
        let facing = TurningBody::AT_REST.gradual_facing(forward, to_goal);
        Some(libm::atan2f(facing.y, facing.x))
    }

    /// Facing that the state of an agent wants, where the agent wants to stand.
    fn facing_of_state_rad(&self, index: usize) -> Option<f32> {
        let wants_to_stand = self.agents.preferred_mps[index] == Vec2::ZERO;
        self.crowd.agents.get(index).filter(|_| wants_to_stand)?.aim.facing_rad()
    }
}

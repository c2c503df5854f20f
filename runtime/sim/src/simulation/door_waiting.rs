//! Agents that wait before closed doors: they brake, stand at a distance from the door, and behind each other. World,
//! metres, m/s.

use rayon::prelude::*;

use crate::route::braking::coasting_mps;
use crate::route::standing_position::StandingPosition;
use crate::simulation::standing_crowd::{Newcomer, StandingAgent, StandingCrowd};
use crate::simulation::{ROUTES_PER_TASK_MIN, Simulation};

/// Distance from a closed door at which the disc of an agent stands, m: its feet and arms clear the door.
const STAND_OFF_M: f32 = 0.5;

impl Simulation {
    /// Slows down agents whose routes lead through closed doors, and lets them stand before these.
    pub(super) fn wait_before_doors(&mut self) {
        if !self.doors.is_any_red() {
            return;
        }
        let (agents, coupling) = (&mut self.agents, self.scenario.coupling);
        let of_agents = agents.route_memory.iter().zip(&agents.radii_m).enumerate();
        let standing = of_agents.filter_map(|(index, (memory, &radius_m))| {
            let door = memory.door.as_ref()?;
            let (standing, to_front_m) = (door.standing?.now(agents.positions_m[index]), door.free_m?);
            Some(StandingAgent { index, radius_m, standing, to_front_m })
        });
        let crowd = StandingCrowd::new(standing.collect());
        let moving = agents.positions_m.par_iter().zip(&agents.velocities_mps);
        let present = moving.zip(&agents.radii_m).zip(&agents.removals).enumerate();
        let present = present.zip(agents.route_memory.par_iter_mut().zip(&mut agents.preferred_mps));
        present.with_min_len(ROUTES_PER_TASK_MIN).for_each(
            |((index, (((&position_m, &velocity_mps), &radius_m), removal)), (memory, preferred_mps))| {
                let Some(door) = memory.door.as_mut() else { return };
                let stood = door.standing.take().is_some_and(StandingPosition::is_taken);
                // Without a query in this step it does not walk.
                let Some(free_m) = door.free_m.take().filter(|_| removal.is_none()) else { return };
                let newcomer = Newcomer {
                    index,
                    position_m,
                    radius_m,
                    preferred_mps: *preferred_mps,
                    coasting_mps: coasting_mps(coupling, velocity_mps),
                    to_front_m: free_m - STAND_OFF_M,
                    stood,
                };
                let behind_others = || newcomer.approach(newcomer.to_front_m, crowd.near(&newcomer));
                let approach = newcomer.at_front().unwrap_or_else(behind_others);
                (door.standing, *preferred_mps) = (approach.standing, approach.preferred_mps);
            },
        );
    }
}

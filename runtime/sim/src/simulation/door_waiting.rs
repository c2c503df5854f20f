//! Agents that wait before closed doors: they brake, stand at a distance from the door, and behind each other. World,
//! metres, m/s.

use rayon::prelude::*;

use crate::route::braking::coasting_mps;
use crate::simulation::places_behind::{Newcomer, Standing, StandingCrowd};
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
        let rank = |index: usize| agents.route_memory[index].door.as_ref().map_or(0, |door| door.rank);
        let waiting = (0..agents.count()).filter(|&index| rank(index) > 0).map(|index| Standing {
            index,
            position_m: agents.positions_m[index],
            radius_m: agents.radii_m[index],
            rank: rank(index),
        });
        let crowd = StandingCrowd::new(waiting.collect());
        let moving = agents.positions_m.par_iter().zip(&agents.velocities_mps);
        let present = moving.zip(&agents.radii_m).zip(&agents.removals).enumerate();
        let present = present.zip(agents.route_memory.par_iter_mut().zip(&mut agents.preferred_mps));
        present.with_min_len(ROUTES_PER_TASK_MIN).for_each(
            |((index, (((&position_m, &velocity_mps), &radius_m), removal)), (memory, preferred_mps))| {
                let Some(door) = memory.door.as_mut() else { return };
                let last_rank = std::mem::take(&mut door.rank);
                // Without a query in this step it does not walk.
                let Some(free_m) = door.free_m.take().filter(|_| removal.is_none()) else { return };
                let motion = [position_m, *preferred_mps, coasting_mps(coupling, velocity_mps)];
                let newcomer = Newcomer::new(index, motion, radius_m, last_rank);
                let to_front_m = free_m - STAND_OFF_M;
                let place = newcomer
                    .place_at_front(to_front_m)
                    .unwrap_or_else(|| newcomer.place_behind(to_front_m, crowd.near(&newcomer)));
                door.rank = place.rank;
                *preferred_mps = newcomer.preferred_mps(place, *preferred_mps);
            },
        );
    }
}

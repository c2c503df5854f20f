//! Agents that wait before closed doors: they brake, stand at a distance from the door, and behind each other. World,
//! metres, m/s.
//!
//! Who waits is read as the last step left it, so the order of agents changes nothing.

use glam::Vec2;
use rayon::prelude::*;

use crate::route::braking::{braking_speed_mps, coasted_m, coasting_mps};
use crate::simulation::{ROUTES_PER_TASK_MIN, Simulation};

/// Distance from a closed door at which the disc of an agent stands, m: its feet and arms clear the door.
const STAND_OFF_M: f32 = 0.5;
/// Distance between the discs of an agent that waits and one that waits behind it, m.
const GAP_M: f32 = 0.25;
/// Distance from its place within which an agent begins to wait, m, beside the distance that it coasts.
const STOPS_M: f32 = 0.08;
/// Distance from its place beyond which an agent that waits moves up, m: a step.
const MOVES_UP_M: f32 = 0.5;
/// Cosine of the angle to the direction of an agent within which another stands before it, 45°.
const BEFORE_COS: f32 = 0.71;
/// Distance within which an agent brakes behind another that waits, m.
const BRAKES_M: f32 = 1.2;
/// Greatest number of agents that wait one behind the other: crowds that face each other do not hold each other.
const RANK_MAX: u32 = 100;

/// An agent that waits.
#[derive(Clone, Copy, Debug)]
struct Waiting {
    index: usize,
    position_m: Vec2,
    radius_m: f32,
    rank: u32,
}

/// The agents that waited in the last step, by x.
struct WaitingCrowd {
    agents: Vec<Waiting>,
    radius_max_m: f32,
}

/// An agent whose route leads through a closed door.
struct Comer {
    index: usize,
    position_m: Vec2,
    radius_m: f32,
    /// Unit direction of v_pref.
    direction: Vec2,
    /// Distance from its place within which it waits, m.
    slack_m: f32,
    /// Distance that it coasts, m.
    coast_m: f32,
}

impl Simulation {
    /// Slows down agents whose routes lead through closed doors, and lets them stand before these.
    pub(super) fn wait_before_doors(&mut self) {
        if !self.doors.is_any_red() {
            return;
        }
        let (agents, coupling) = (&mut self.agents, self.scenario.coupling);
        let rank = |index: usize| agents.route_memory[index].door.as_ref().map_or(0, |door| door.rank);
        let waiting = (0..agents.positions_m.len()).filter(|&index| rank(index) > 0).map(|index| Waiting {
            index,
            position_m: agents.positions_m[index],
            radius_m: agents.radii_m[index],
            rank: rank(index),
        });
        let crowd = WaitingCrowd::new(waiting.collect());
        let moving = agents.positions_m.par_iter().zip(&agents.velocities_mps);
        let present = moving.zip(&agents.radii_m).zip(&agents.removals).enumerate();
        let present = present.zip(agents.route_memory.par_iter_mut().zip(&mut agents.preferred_mps));
        present.with_min_len(ROUTES_PER_TASK_MIN).for_each(
            |((index, (((&position_m, &velocity_mps), &radius_m), removal)), (memory, preferred_mps))| {
                let Some(door) = memory.door.as_mut() else { return };
                let was_waiting = door.rank > 0;
                door.rank = 0;
                // Without a query in this step it does not walk.
                let Some(free_m) = door.free_m.take().filter(|_| removal.is_none()) else { return };
                let direction = preferred_mps.normalize_or_zero();
                let coast_m = coasted_m(coasting_mps(coupling, velocity_mps), direction);
                let slack_m = if was_waiting { MOVES_UP_M } else { (STOPS_M + coast_m).min(MOVES_UP_M) };
                let comer = Comer { index, position_m, radius_m, direction, slack_m, coast_m };
                let (left_m, rank) = crowd.place(&comer, free_m - STAND_OFF_M);
                door.rank = rank;
                *preferred_mps = if rank > 0 {
                    Vec2::ZERO
                } else {
                    preferred_mps.clamp_length_max(braking_speed_mps((left_m - coast_m).max(0.0)))
                };
            },
        );
    }
}

impl WaitingCrowd {
    fn new(mut agents: Vec<Waiting>) -> Self {
        agents.sort_by(|a, b| a.position_m.x.total_cmp(&b.position_m.x).then(a.index.cmp(&b.index)));
        let radius_max_m = agents.iter().map(|agent| agent.radius_m).fold(0.0, f32::max);
        Self { agents, radius_max_m }
    }

    /// Free path of an agent to its place, m, given that to the door; and its rank there, 0 where it walks on.
    fn place(&self, comer: &Comer, to_door_m: f32) -> (f32, u32) {
        if to_door_m < comer.slack_m {
            return (to_door_m, 1);
        }
        let (mut left_m, mut rank) = (to_door_m, u32::MAX);
        let reach_m = comer.radius_m + self.radius_max_m + GAP_M + BRAKES_M + comer.coast_m;
        let from = self.agents.partition_point(|other| other.position_m.x < comer.position_m.x - reach_m);
        let near = self.agents[from..].iter().take_while(|other| other.position_m.x <= comer.position_m.x + reach_m);
        for other in near.filter(|other| other.index != comer.index && other.rank < RANK_MAX) {
            let offset_m = other.position_m - comer.position_m;
            let distance_m = offset_m.length();
            if comer.direction.dot(offset_m) <= BEFORE_COS * distance_m {
                continue;
            }
            let free_m = distance_m - comer.radius_m - other.radius_m - GAP_M;
            left_m = left_m.min(free_m);
            if free_m < comer.slack_m {
                rank = rank.min(other.rank + 1);
            }
        }
        (left_m, if rank == u32::MAX { 0 } else { rank })
    }
}

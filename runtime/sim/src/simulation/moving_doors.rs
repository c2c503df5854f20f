//! Doors open and close by signal, at the beginning of a step. World, metres.
//!
//! 1. A door opens as soon as its signal is green.
//! 2. As soon as the signal is red, no route leads through the door. Agents that stand in it, or so near that a leg may
//!    be in it, walk on through it.
//! 3. The door closes as soon as there is no such agent.

use crate::simulation::Simulation;
use crate::world::obstacles::Obstacles;

impl Simulation {
    /// Opens and closes doors as their signals are now. Walls follow the doors that are closed, routes the signals.
    pub(super) fn move_doors(&mut self) {
        let Self { scenario, agents, population, doors, crowd, steps, obstacles, zone_walls, routes, .. } = self;
        let time_s = f64::from(*steps) * f64::from(scenario.dt_s);
        let (mut has_signal_changed, mut has_moved) = (false, false);
        for (index, door) in scenario.doors.iter().enumerate() {
            let is_red = !crowd.is_green(&scenario.behaviour, door.signal as usize, time_s);
            let is_closed = is_red && (doors.closed[index] || !doors.is_taken(index, agents));
            has_signal_changed |= std::mem::replace(&mut doors.red[index], is_red) != is_red;
            if std::mem::replace(&mut doors.closed[index], is_closed) != is_closed {
                population.doors[index].changes.push(*steps + 1);
                has_moved = true;
            }
        }
        if has_moved {
            *obstacles = scenario.walls_with(&doors.closed);
            *zone_walls = scenario.zone_walls(&doors.closed);
        }
        if has_signal_changed {
            doors.red_leaves = Obstacles::new(&scenario.doors_m(&doors.red).collect::<Vec<_>>());
            routes.close(scenario, &doors.red);
        }
    }

    /// Closes the doors whose signals are red at the start.
    pub(super) fn close_doors_at_start(&mut self) {
        self.move_doors();
        for (phases, is_closed) in self.population.doors.iter_mut().zip(&self.doors.closed) {
            phases.is_closed_at_start = *is_closed;
            phases.changes.clear();
        }
    }
}

//! Zones that states close to the agents in them (`closed_in`), and from when on they are walls. World, metres.

use glam::Vec2;

use crate::maths::polygon::{closest_distance_m, contains};
use crate::scenario::resolved::Scenario;

/// Overlap of a disc with a zone from which on it is still in the zone, m: more than walls let a disc in.
const WITHIN_M: f32 = 5e-3;

/// The zones that each state closes.
#[derive(Clone, Debug, Default)]
pub struct StateZones {
    /// For each state the zones that it closes, by bits; empty where no state closes any.
    by_state: Vec<u32>,
    /// Outline of each closed zone, by bit, m.
    outlines_m: Vec<Vec<Vec2>>,
}

impl StateZones {
    /// Those of a scenario.
    pub fn new(scenario: &Scenario) -> Self {
        let closed = || scenario.zones.iter().filter(|zone| zone.is_closed).take(u32::BITS as usize);
        if closed().all(|zone| zone.closed_in.is_empty()) {
            return Self::default();
        }
        let mut by_state = vec![0; scenario.behaviour.states.len()];
        for (bit, zone) in closed().enumerate() {
            for &state in &zone.closed_in {
                if let Some(zones) = by_state.get_mut(state as usize) {
                    *zones |= 1 << bit;
                }
            }
        }
        Self { by_state, outlines_m: closed().map(|zone| zone.area.outline_m()).collect() }
    }

    /// The zones that are closed to the routes of an agent in a state, given its own, by bits.
    pub fn for_routes(&self, own: u32, state: usize) -> u32 {
        own | self.by_state.get(state).copied().unwrap_or_default()
    }

    /// The zones that are walls for an agent in a state, by bits: those of its routes without the ones in which it still
    /// is. It leaves these.
    pub fn for_walls(&self, own: u32, state: usize, position_m: Vec2, wall_radius_m: f32) -> u32 {
        let closed = self.for_routes(own, state);
        let holds = |bit: usize| {
            let outline_m = &self.outlines_m[bit];
            let is_closed_by_state = (closed & !own) >> bit & 1 == 1;
            let is_within = || {
                contains(outline_m, position_m)
                    || closest_distance_m(outline_m, position_m) + f64::from(WITHIN_M) < f64::from(wall_radius_m)
            };
            is_closed_by_state && is_within()
        };
        let within = (0..self.outlines_m.len()).filter(|&bit| holds(bit)).fold(0_u32, |zones, bit| zones | 1 << bit);
        // Walls are made for the sets of `wall_sets`: without one zone, or without all that states close.
        if within.count_ones() < 2 { closed & !within } else { own }
    }

    /// The sets of zones that are closed to the routes of an agent in any state, given its own; each once.
    pub(crate) fn route_sets(&self, own: u32) -> Vec<u32> {
        let by_state = self.by_state.iter().map(|zones| own | zones);
        let mut sets: Vec<u32> = std::iter::once(own).chain(by_state).collect();
        sets.sort_unstable();
        sets.dedup();
        sets
    }

    /// The sets of zones that are walls for an agent in any state, given its own.
    pub(crate) fn wall_sets(&self, own: u32) -> Vec<u32> {
        let without_one = |set: u32| {
            let zones = (0..u32::BITS).map(|bit| 1 << bit).filter(move |zone| set & !own & zone != 0);
            std::iter::once(set).chain(zones.map(move |zone| set & !zone)).collect::<Vec<_>>()
        };
        self.route_sets(own).into_iter().flat_map(without_one).collect()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn zones() -> StateZones {
        let block = |low: f32| [[low, 0.0], [low + 2.0, 0.0], [low + 2.0, 2.0], [low, 2.0]].map(Vec2::from).to_vec();
        StateZones { by_state: vec![0, 0b110, 0b010], outlines_m: [0.0, 4.0, 8.0].map(block).to_vec() }
    }

    #[test]
    fn a_zone_becomes_a_wall_once_the_agent_is_outside() {
        let for_walls = |state, x| zones().for_walls(0b001, state, Vec2::new(x, 1.0), 0.2);
        assert_eq!([0, 1, 2].map(|state| for_walls(state, 20.0)), [0b001, 0b111, 0b011]);
        assert_eq!([5.0, 3.9, 3.8].map(|x| for_walls(1, x)), [0b101, 0b101, 0b111]);
        // Its own zones are always walls.
        assert_eq!(for_walls(1, 1.0), 0b111);
    }

    #[test]
    fn walls_are_made_for_each_set_that_can_be() {
        let sets = zones().wall_sets(0b001);
        for x in [-3.0, 1.0, 4.1, 5.0, 8.1, 20.0] {
            (0..3).for_each(|state| assert!(sets.contains(&zones().for_walls(0b001, state, Vec2::new(x, 1.0), 0.2))));
        }
        assert_eq!(zones().route_sets(0b100), [0b100, 0b110]);
    }
}

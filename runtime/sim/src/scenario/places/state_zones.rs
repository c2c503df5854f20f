//! Zones that states close to the agents in them (`closed_in`), and from when on they are walls. World, metres.

use glam::Vec2;

use crate::maths::polygon::{closest_distance_m, contains};
use crate::scenario::resolved::Scenario;

/// Overlap of a disc with a zone from which on it is still in the zone, m: more than walls let a disc in.
const WITHIN_M: f32 = 5e-3;
/// Distance between zones from which on no disc is in both, m: the diameter of a disc with twice the usual radius.
const APART_M: f32 = 1.0;
/// Greatest number of sets of zones in which an agent may be at once.
const SHARED_MAX: usize = 64;

/// The zones that each state closes.
#[derive(Clone, Debug, Default)]
pub struct StateZones {
    /// For each state the zones that it closes, by bits; empty where no state closes any.
    by_state: Vec<u32>,
    /// Outline of each closed zone, by bit, m.
    outlines_m: Vec<Vec<Vec2>>,
    /// Sets of two zones or more, by bits, that a state closes and in which an agent may be at once; sorted.
    shared: Vec<u32>,
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
        Self::of(by_state, closed().map(|zone| zone.area.outline_m()).collect())
    }

    fn of(by_state: Vec<u32>, outlines_m: Vec<Vec<Vec2>>) -> Self {
        let shared = shared_sets(&by_state, &outlines_m);
        Self { by_state, outlines_m, shared }
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
        // Walls are made for the sets of `wall_sets`. Where so many zones overlap that there are none, all are open.
        let has_walls = within.count_ones() < 2 || self.shared.binary_search(&within).is_ok();
        if has_walls { closed & !within } else { own }
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
        let without = |set: u32| {
            let by_state = set & !own;
            let zones = (0..u32::BITS).map(|bit| 1 << bit).chain(self.shared.iter().copied());
            let left = zones.filter(move |&zones| by_state & zones == zones);
            std::iter::once(set).chain(left.map(move |zones| set & !zones))
        };
        self.route_sets(own).into_iter().flat_map(without).collect()
    }
}

/// The sets of two zones or more that a state closes and that are near each other, by bits, sorted; the first of them
/// where there are too many.
fn shared_sets(by_state: &[u32], outlines_m: &[Vec<Vec2>]) -> Vec<u32> {
    let boxes_m: Vec<[Vec2; 2]> = outlines_m.iter().map(|outline_m| bounds_m(outline_m)).collect();
    let is_near = |set: u32, bit: usize| {
        (0..boxes_m.len()).all(|member| set >> member & 1 == 0 || gap_m(boxes_m[member], boxes_m[bit]) < APART_M)
    };
    let mut sets: Vec<u32> = (0..boxes_m.len()).map(|bit| 1 << bit).collect();
    let (zones, mut at) = (sets.len(), 0);
    while at < sets.len() && sets.len() < zones + SHARED_MAX {
        let set = sets[at];
        let above = u32::BITS as usize - set.leading_zeros() as usize;
        let larger = (above..zones).filter(|&bit| is_near(set, bit)).map(|bit| set | 1 << bit);
        let is_closed = |set: &u32| by_state.iter().any(|closed| closed & set == *set);
        sets.extend(larger.filter(is_closed));
        at += 1;
    }
    let mut shared: Vec<u32> = sets.into_iter().skip(zones).take(SHARED_MAX).collect();
    shared.sort_unstable();
    shared
}

fn bounds_m(outline_m: &[Vec2]) -> [Vec2; 2] {
    let low_m = outline_m.iter().copied().fold(Vec2::INFINITY, Vec2::min);
    [low_m, outline_m.iter().copied().fold(Vec2::NEG_INFINITY, Vec2::max)]
}

fn gap_m([low_m, high_m]: [Vec2; 2], [other_low_m, other_high_m]: [Vec2; 2]) -> f32 {
    (low_m - other_high_m).max(other_low_m - high_m).max(Vec2::ZERO).length()
}

#[cfg(test)]
mod tests {
    use super::*;

    fn zones() -> StateZones {
        let block = |low: f32| [[low, 0.0], [low + 2.0, 0.0], [low + 2.0, 2.0], [low, 2.0]].map(Vec2::from).to_vec();
        StateZones::of(vec![0, 0b110, 0b010], [0.0, 4.0, 8.0].map(block).to_vec())
    }

    /// Three blocks that overlap, and one apart; state 1 closes all.
    fn overlapping() -> StateZones {
        let block = |low: f32| [[low, 0.0], [low + 2.0, 0.0], [low + 2.0, 2.0], [low, 2.0]].map(Vec2::from).to_vec();
        StateZones::of(vec![0, 0b1111], [0.0, 1.0, 1.5, 8.0].map(block).to_vec())
    }

    #[test]
    fn an_agent_in_two_zones_leaves_both_and_enters_no_other() {
        let for_walls = |x| overlapping().for_walls(0, 1, Vec2::new(x, 1.0), 0.2);
        let expected = [(-1.0, 0b1111), (0.5, 0b1110), (1.1, 0b1100), (1.7, 0b1000), (2.5, 0b1001), (8.5, 0b0111)];
        assert_eq!(expected.map(|(x, _)| for_walls(x)), expected.map(|(_, zones)| zones));
        let sets = overlapping().wall_sets(0);
        assert!(expected.iter().all(|(_, zones)| sets.contains(zones)), "{sets:?}");
    }

    #[test]
    fn thirty_two_zones_on_one_another_take_bounded_memory() {
        let square = [[0.0, 0.0], [2.0, 0.0], [2.0, 2.0], [0.0, 2.0]].map(Vec2::from).to_vec();
        let zones = StateZones::of(vec![0, u32::MAX], vec![square; 32]);
        assert!(zones.shared.len() == SHARED_MAX && zones.wall_sets(0).len() < 100);
        // There are no walls for all sets: an agent in all 32 zones leaves them.
        assert_eq!(zones.for_walls(0, 1, Vec2::ONE, 0.2), 0);
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

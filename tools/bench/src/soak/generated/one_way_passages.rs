//! Agents that pass one-way zones against their direction. World, metres.
//!
//! A crowd may push an agent back over a side of a zone, so displacements against the heading are no fault by
//! themselves. An agent that enters over the exit and leaves over the entry has passed the zone the wrong way.

use std::collections::BTreeSet;

use fbcrowd_sim::world::one_way::OneWayZone;
use glam::Vec2;

/// The agents that are in one-way zones and entered them over the exit.
pub(crate) struct OneWayPassages {
    zones: Vec<OneWayZone>,
    /// Indices of agent and zone.
    from_exit: BTreeSet<(usize, usize)>,
}

impl OneWayPassages {
    pub(crate) fn new(zones: Vec<OneWayZone>) -> Self {
        Self { zones, from_exit: BTreeSet::new() }
    }

    /// Takes the displacement of an agent in a step. Whether with it the agent has passed a zone the wrong way.
    pub(crate) fn is_against(&mut self, agent: usize, from_m: Vec2, to_m: Vec2) -> bool {
        let Self { zones, from_exit } = self;
        let mut is_against = false;
        for (index, zone) in zones.iter().enumerate() {
            let [start_m, end_m, ..] = zone.corners_m;
            match (zone.holds(from_m), zone.holds(to_m)) {
                (false, true) if (from_m - end_m).dot(zone.heading) > 0.0 => drop(from_exit.insert((agent, index))),
                (false, true) => drop(from_exit.remove(&(agent, index))),
                (true, false) => {
                    let is_behind = (to_m - start_m).dot(zone.heading) < 0.0;
                    is_against |= from_exit.remove(&(agent, index)) && is_behind;
                }
                _ => {}
            }
        }
        is_against
    }

    /// Forgets where an agent entered: it is moved by its state.
    pub(crate) fn forget(&mut self, agent: usize) {
        self.from_exit.retain(|&(of, _)| of != agent);
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Whether a path along x leads against a zone from 0 to 2 m that leads to the right.
    fn is_against(path_m: &[f32]) -> bool {
        let corners_m = [[0.0, 0.0], [2.0, 0.0], [2.0, 2.0], [0.0, 2.0]].map(Vec2::from);
        let zone = OneWayZone::new(&corners_m, 0.0).expect("a rectangle");
        let mut passages = OneWayPassages::new(vec![zone]);
        let mut steps = path_m.windows(2).map(|ends_m| [ends_m[0], ends_m[1]].map(|x| Vec2::new(x, 1.0)));
        steps.any(|[from_m, to_m]| passages.is_against(7, from_m, to_m))
    }

    #[test]
    fn only_a_passage_from_exit_to_entry_is_a_fault() {
        assert!(is_against(&[3.0, 1.9, 1.0, 0.1, -0.5]));
        assert!(!is_against(&[-1.0, 0.1, 1.0, 1.9, 2.5]));
        // Pushed in over the exit and out again; born within and pushed out behind.
        assert!(!is_against(&[3.0, 1.9, 1.5, 2.5, 3.0]));
        assert!(!is_against(&[1.0, 0.1, -0.5]));
    }
}

//! Zones change the preferred velocities of the agents in them, after the route. World, metres, m/s.

use crate::simulation::Simulation;
use crate::world::one_way::not_against_mps;

impl Simulation {
    /// Multiplies v_pref of every agent by the factors of the zones that hold it, and takes away what leads against a
    /// one-way zone. An agent that leaves goes on as it went, so its v_pref has its factors already.
    pub(super) fn apply_zones(&mut self) {
        let agents = &mut self.agents;
        for zone in self.scenario.zones.iter().filter(|zone| zone.speed_factor != 1.0) {
            let [low_m, high_m] = zone.area.bounds_m();
            for (index, position_m) in agents.positions_m.iter().enumerate() {
                let is_beside = position_m.cmpge(low_m).all() && position_m.cmple(high_m).all();
                if is_beside && agents.removals[index].is_none() && zone.area.holds(*position_m) {
                    agents.preferred_mps[index] *= zone.speed_factor;
                }
            }
        }
        if self.one_way.is_empty() {
            return;
        }
        let preferred = agents.preferred_mps.iter_mut().zip(&mut agents.facing_offsets_rad);
        for ((preferred_mps, facing_offset_rad), position_m) in preferred.zip(&agents.positions_m) {
            let allowed_mps = not_against_mps(&self.one_way, *position_m, *preferred_mps);
            if allowed_mps != *preferred_mps {
                (*preferred_mps, *facing_offset_rad) = (allowed_mps, 0.0);
            }
        }
    }
}

//! Goals that agents never reach, because every area lies in zones that are closed to them: they wait.

use crate::behaviour::Movement;
use crate::scenario::places::state_zones::StateZones;
use crate::scenario::resolved::Scenario;

/// Goals of a state whose areas all lie in zones that are closed to some of its agents.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct BarredGoals {
    /// Name of the state.
    pub state: String,
    /// Name of the goals.
    pub goals: String,
    /// Indices of the zones.
    pub zones: Vec<usize>,
}

impl Scenario {
    /// The goals that some agents never reach, in the order of the states: each state once.
    pub fn barred_goals(&self) -> Vec<BarredGoals> {
        let state_zones = StateZones::new(self);
        let own_sets: Vec<u32> = self.own_zone_sets().collect();
        let of_state = |(index, state): (usize, &crate::behaviour::State)| {
            let Movement::Goals { set, .. } = state.movement else { return None };
            let goals = &self.behaviour.goals[set];
            let is_barred = |closed: &u32| goals.areas.iter().all(|goal| self.is_barred(&goal.area, *closed));
            let closed = own_sets.iter().map(|&own| state_zones.for_routes(own, index)).find(is_barred)?;
            let zones = self.closed_zones(closed).map(|(zone, _)| zone).collect();
            Some(BarredGoals { state: state.name.clone(), goals: goals.name.clone(), zones })
        };
        self.behaviour.states.iter().enumerate().filter_map(of_state).collect()
    }
}

impl std::fmt::Display for BarredGoals {
    fn fmt(&self, out: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        let Self { state, goals, zones } = self;
        let names: Vec<String> = zones.iter().map(usize::to_string).collect();
        let zones =
            if let [zone] = &names[..] { format!("zone {zone}") } else { format!("zones {}", names.join(", ")) };
        write!(out, "agents in state `{state}` wait: to some, all areas of goals `{goals}` are closed by {zones}")
    }
}

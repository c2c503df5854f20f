//! Goals that agents never reach, because every area lies in zones that are closed to them: they wait.

use crate::behaviour::Movement;
use crate::scenario::places::state_zones::StateZones;
use crate::scenario::resolved::Scenario;
use crate::scenario::source_spec::SourceSpec;

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
        let starts = self.starts_in_zones();
        let reachable: Vec<Vec<bool>> = starts.iter().map(|(state, _)| self.behaviour.reachable_from(*state)).collect();
        let of_state = |(index, state): (usize, &crate::behaviour::State)| {
            let Movement::Goals { set, .. } = state.movement else { return None };
            let goals = &self.behaviour.goals[set];
            let is_barred = |closed: &u32| goals.areas.iter().all(|goal| self.is_barred(&goal.area, *closed));
            let comes_here = starts.iter().zip(&reachable).filter(|(_, reachable)| reachable[index]);
            let mut closed_sets: Vec<u32> =
                comes_here.map(|((_, own), _)| state_zones.for_routes(*own, index)).collect();
            closed_sets.sort_unstable();
            closed_sets.dedup();
            let closed = closed_sets.into_iter().find(is_barred)?;
            let zones = self.closed_zones(closed).map(|(zone, _)| zone).collect();
            Some(BarredGoals { state: state.name.clone(), goals: goals.name.clone(), zones })
        };
        self.behaviour.states.iter().enumerate().filter_map(of_state).collect()
    }

    /// The states in which agents begin, by index, with the zones that these agents keep out of, by bits; each once.
    fn starts_in_zones(&self) -> Vec<(u32, u32)> {
        let of_source = |source: &SourceSpec| {
            let state = source.state;
            source.closed_zone_sets().into_iter().map(move |zones| (state, zones))
        };
        let of_agents = self.agents.iter().map(|agent| (agent.state, agent.closed_zones));
        let mut starts: Vec<(u32, u32)> = of_agents.chain(self.sources.iter().flat_map(of_source)).collect();
        starts.sort_unstable();
        starts.dedup();
        starts
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

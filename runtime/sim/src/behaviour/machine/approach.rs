//! Agents on their way to busy exits: how many are ahead of an agent. Metres.

use std::collections::BTreeMap;

use crate::behaviour::agent_state::{AgentState, GoalRef};
use crate::behaviour::choice::Choice;
use crate::behaviour::crowd_view::CrowdView;
use crate::behaviour::state::{Behaviour, Movement};

/// For each set of goals that some state chooses as the least busy: for each area the remaining routes of the agents that
/// go there, m, ascending.
#[derive(Debug, Default)]
pub(crate) struct Approach(BTreeMap<usize, Vec<Vec<f32>>>);

impl Approach {
    /// The routes as the last step left them.
    pub(crate) fn new(behaviour: &Behaviour, view: &CrowdView, agents: &[AgentState]) -> Self {
        let mut approach = Self::default();
        for state in &behaviour.states {
            if let Movement::Goals { set, choice: Choice::LeastBusy, .. } = state.movement {
                approach.0.insert(set, vec![Vec::new(); behaviour.goals[set].areas.len()]);
            }
        }
        if approach.0.is_empty() {
            return approach;
        }
        for (index, agent) in agents.iter().enumerate() {
            let Some(at) = agent.goal_at() else { continue };
            if let Some(areas) = approach.0.get_mut(&(at.set as usize))
                && let Some(route_m) = (view.route_m)((index, agent.state), view.positions_m[index], at)
            {
                areas[at.area as usize].push(route_m);
            }
        }
        approach.0.values_mut().flatten().for_each(|routes_m| routes_m.sort_by(f32::total_cmp));
        approach
    }

    /// Number of agents on shorter routes to an area.
    pub(crate) fn ahead(&self, at: GoalRef, route_m: f32) -> usize {
        self.routes_m(at).map_or(0, |routes_m| routes_m.partition_point(|&other_m| other_m < route_m))
    }

    /// Adds an agent that goes to an area from now on.
    pub(crate) fn join(&mut self, at: GoalRef, route_m: f32) {
        if let Some(areas) = self.0.get_mut(&(at.set as usize)) {
            let routes_m = &mut areas[at.area as usize];
            let index = routes_m.partition_point(|&other_m| other_m < route_m);
            routes_m.insert(index, route_m);
        }
    }

    /// Takes out an agent that goes elsewhere from now on.
    pub(crate) fn leave(&mut self, at: GoalRef, route_m: f32) {
        if let Some(areas) = self.0.get_mut(&(at.set as usize)) {
            let routes_m = &mut areas[at.area as usize];
            let index = routes_m.partition_point(|&other_m| other_m < route_m);
            if routes_m.get(index) == Some(&route_m) {
                routes_m.remove(index);
            }
        }
    }

    fn routes_m(&self, at: GoalRef) -> Option<&Vec<f32>> {
        self.0.get(&(at.set as usize))?.get(at.area as usize)
    }
}

//! Groups in a step of the state machine: members that are in the state of the first present member, their lead, do as it
//! does. It has reached its goal when all of them have, takes its transitions for all, and chooses for all. In a queue,
//! and in other states, each member acts for itself. Metres.

use std::collections::BTreeMap;

use crate::behaviour::agent_state::AgentState;
use crate::behaviour::crowd_view::CrowdView;
use crate::behaviour::machine::deciding::{Followers, to_goal_m};
use crate::behaviour::state::{Behaviour, Movement};

/// The groups of a step, as the last step left them.
pub(crate) struct GroupLeads {
    /// For each agent that follows a lead, the lead; both by index.
    leads: BTreeMap<usize, usize>,
    /// The followers of each lead, by index.
    followers: BTreeMap<usize, Followers>,
    /// The states that leads have entered in this step.
    entered: BTreeMap<usize, Vec<u32>>,
}

impl GroupLeads {
    /// Finds leads and followers.
    pub(crate) fn new(behaviour: &Behaviour, view: &CrowdView, agents: &[AgentState]) -> Self {
        let mut groups = Self { leads: BTreeMap::new(), followers: BTreeMap::new(), entered: BTreeMap::new() };
        for (index, &lead) in view.leads.iter().enumerate().filter(|(index, lead)| index != *lead) {
            let (agent, first) = (&agents[index], &agents[lead]);
            let is_queue = matches!(
                behaviour.states[agent.state as usize].movement,
                Movement::Goals { set, .. } if behaviour.goals[set].queue
            );
            let both_have_begun = (view.has_begun)(index) && (view.has_begun)(lead);
            if agent.state != first.state || is_queue || !both_have_begun {
                continue;
            }
            groups.leads.insert(index, lead);
            let followers = groups.followers.entry(lead).or_default();
            followers.count += 1;
            let to_goal_m = to_goal_m(behaviour, view, index, agent, view.positions_m[index]);
            followers.to_goal_m = followers.to_goal_m.max(to_goal_m.unwrap_or(0.0));
        }
        groups
    }

    /// The followers of an agent.
    pub(crate) fn followers(&self, index: usize) -> Followers {
        self.followers.get(&index).copied().unwrap_or_default()
    }

    /// Notes the states that an agent has entered.
    pub(crate) fn note(&mut self, index: usize, entered: Vec<u32>) {
        if self.followers.contains_key(&index) {
            self.entered.insert(index, entered);
        }
    }

    /// The lead that an agent follows, and the states that the lead has entered.
    pub(crate) fn followed_by(&self, index: usize) -> Option<(usize, &[u32])> {
        let lead = *self.leads.get(&index)?;
        Some((lead, self.entered.get(&lead)?))
    }
}

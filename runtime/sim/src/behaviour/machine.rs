//! One step of the state machine of all agents: transitions, goals, aims. World, metres, seconds.
//!
//! 1. Count the agents in states and areas, and look at the signals, as the last step left them; let events happen.
//! 2. For each agent in the order of ids: enter the state to which an event moves it; take the first transition whose
//!    condition holds, until none holds. An agent that takes a hundred in one step ends them there, and the fault is kept.
//! 3. Keep its goal up to date: move up in a queue, leave a busy exit for another, look again for a goal with room.
//!
//! Members of a group that are in the state of its first member do as that one does (`group_leads`).
//!
//! Rooms of goals change at once, so the order of ids decides which agent gets the last place. All else is read as it
//! was when the step began.

use glam::Vec2;

use crate::behaviour::agent_state::{AgentState, Traits};
use crate::behaviour::area::Area;
use crate::behaviour::condition::Facts;
use crate::behaviour::crowd_view::{CrowdView, Moment};
use crate::behaviour::draw::event_random;
use crate::behaviour::event::{Event, SignalOrder};
use crate::behaviour::machine::approach::Approach;
use crate::behaviour::machine::deciding::{Deciding, TRANSITIONS_MAX};
use crate::behaviour::machine::group_leads::GroupLeads;
use crate::behaviour::occupancy::Occupancy;
use crate::behaviour::state::{Behaviour, Movement};
use crate::population::AgentId;

mod approach;
mod deciding;
mod goal_keeping;
mod group_leads;

/// Distance from the end of a queue within which an agent joins it, m.
const JOINS_QUEUE_M: f32 = 1.5;

/// Transitions that do not end within a step.
#[derive(Clone, Debug, PartialEq)]
pub struct EndlessTransitions {
    /// The agent.
    pub agent: AgentId,
    /// Time of the step, s.
    pub time_s: f64,
    /// The states that the agent entered again and again, by index, each once.
    pub states: Vec<u32>,
}

impl EndlessTransitions {
    fn new(agent: AgentId, time_s: f64, mut states: Vec<u32>) -> Self {
        states.sort_unstable();
        states.dedup();
        Self { agent, time_s, states }
    }
}

/// The state machine of all agents.
#[derive(Clone, Debug, Default)]
pub struct CrowdBehaviour {
    /// What it remembers of each agent, in the order of ids.
    pub agents: Vec<AgentState>,
    /// Agents that go to, or stand in, each area.
    pub occupancy: Occupancy,
    /// Number of agents in the last step that wanted a goal of each set and found none with room.
    pub waiting: Vec<u32>,
    /// The first transitions without end.
    pub endless: Option<EndlessTransitions>,
    /// Whether each event has happened.
    happened: Vec<bool>,
    /// What events have made of each signal; empty before the first step.
    orders: Vec<SignalOrder>,
    /// What events have made of signals in the last step: the signal, by index, and what it shows.
    pub ordered: Vec<(usize, SignalOrder)>,
    /// Teleports of the last step: the agent, and where it is afterwards, m.
    pub teleports: Vec<(AgentId, Vec2)>,
}

impl CrowdBehaviour {
    /// A crowd without agents.
    pub fn new(behaviour: &Behaviour) -> Self {
        Self { occupancy: Occupancy::new(&behaviour.goals), ..Self::default() }
    }

    /// Adds an agent behind the others; it enters its state in the next step.
    pub fn add(&mut self, state: u32, traits: Traits, start_m: Vec2) {
        self.agents.push(AgentState::new(state, traits, start_m));
    }

    /// Keeps only some agents; the goals of the others become free.
    pub fn retain(&mut self, kept: &[bool]) {
        let occupancy = &mut self.occupancy;
        let mut kept = kept.iter().copied();
        self.agents.retain_mut(|agent| {
            let keep = kept.next().unwrap_or(true);
            if !keep {
                agent.remembered.retain(|(_, goal)| agent.goal.is_none_or(|present| present.at != goal.at));
                occupancy.leave(agent);
                while let Some((_, goal)) = agent.remembered.pop() {
                    agent.goal = Some(goal);
                    occupancy.leave(agent);
                }
            }
            keep
        });
    }

    /// One step.
    pub fn decide(&mut self, behaviour: &Behaviour, view: &CrowdView) {
        let moved = self.happen(behaviour, view);
        let moment = self.moment(behaviour, view);
        let mut agents = std::mem::take(&mut self.agents);
        self.waiting = vec![0; behaviour.goals.len()];
        self.teleports.clear();
        let mut leads = GroupLeads::new(behaviour, view, &agents);
        let approach = &mut Approach::new(behaviour, view, &agents);
        for index in (0..agents.len()).filter(|index| (view.has_begun)(*index)) {
            let (before, agent) = agents.split_at_mut(index);
            let agent = &mut agent[0];
            let mut deciding = Deciding {
                behaviour,
                view,
                index,
                agent,
                occupancy: &mut self.occupancy,
                approach,
                teleported_m: None,
                followers: leads.followers(index),
            };
            for event in &moved {
                deciding.be_moved(event);
            }
            let lead_goal = match leads.followed_by(index) {
                Some((lead, entered)) => {
                    deciding.follow_lead(entered);
                    before[lead].goal_at()
                }
                None => {
                    let entered = deciding.follow_transitions(&moment);
                    if self.endless.is_none() && entered.len() == TRANSITIONS_MAX {
                        self.endless = Some(EndlessTransitions::new(view.ids[index], view.time_s, entered.clone()));
                    }
                    leads.note(index, entered);
                    None
                }
            };
            self.teleports.extend(deciding.teleported_m.map(|position_m| (view.ids[index], position_m)));
            deciding.update_goal(&moment, lead_goal);
            let aim = deciding.aim();
            agent.has_new_aim = aim.position_m() != agent.aim.position_m();
            agent.aim = aim;
            if let Movement::Goals { set, .. } = behaviour.states[agent.state as usize].movement
                && agent.goal.is_none()
            {
                self.waiting[set] += 1;
            }
        }
        self.agents = agents;
    }

    /// Whether a signal, by index, is green at a time: as events have ordered, else by its phases.
    pub fn is_green(&self, behaviour: &Behaviour, signal: usize, time_s: f64) -> bool {
        match self.orders.get(signal) {
            Some(SignalOrder::Green) => true,
            Some(SignalOrder::Red) => false,
            Some(SignalOrder::Phases) | None => behaviour.signals[signal].is_green(time_s),
        }
    }

    /// Lets the events happen whose conditions hold now for the first time. Returns those that move agents.
    fn happen<'a>(&mut self, behaviour: &'a Behaviour, view: &CrowdView) -> Vec<&'a Event> {
        self.ordered.clear();
        self.happened.resize(behaviour.events.len(), false);
        self.orders.resize(behaviour.signals.len(), SignalOrder::Phases);
        if self.happened.iter().all(|happened| *happened) {
            return Vec::new();
        }
        let moment = self.moment(behaviour, view);
        let facts = Facts {
            to_goal_m: None,
            in_state_s: view.time_s,
            at_head_s: None,
            is_inside: &|_| false,
            green: &moment.green,
            numbers: &moment.numbers,
            populations: &moment.populations,
        };
        let mut moved = Vec::new();
        for (index, event) in behaviour.events.iter().enumerate() {
            let random = &mut event_random(view.seed, index);
            if !self.happened[index] && event.condition.holds(&facts, random) {
                self.happened[index] = true;
                event.signals.iter().for_each(|&(signal, order)| self.orders[signal] = order);
                self.ordered.extend(&event.signals);
                moved.extend(event.to.map(|_| event));
            }
        }
        moved
    }

    fn moment(&self, behaviour: &Behaviour, view: &CrowdView) -> Moment {
        let mut populations = vec![0; behaviour.states.len()];
        for agent in self.agents.iter().filter(|agent| agent.entries > 0) {
            populations[agent.state as usize] += 1;
        }
        let number = |area: &Area| view.positions_m.iter().filter(|&&position_m| area.holds(position_m)).count() as u32;
        Moment {
            green: (0..behaviour.signals.len()).map(|index| self.is_green(behaviour, index, view.time_s)).collect(),
            numbers: behaviour.areas.iter().map(number).collect(),
            populations,
            joining: self.joining(behaviour, view),
        }
    }

    /// For each set that is a queue, the agent beside its end that is the nearest to it.
    fn joining(&self, behaviour: &Behaviour, view: &CrowdView) -> Vec<Option<usize>> {
        let mut nearest: Vec<(f32, Option<usize>)> = vec![(JOINS_QUEUE_M, None); behaviour.goals.len()];
        for (index, agent) in self.agents.iter().enumerate() {
            let Some(goal) = agent.goal.filter(|goal| !goal.is_taken) else { continue };
            let place = &behaviour.goals[goal.at.set as usize].areas[goal.at.area as usize];
            let distance_m = place.area.distance_m(view.positions_m[index]);
            let nearest = &mut nearest[goal.at.set as usize];
            if distance_m < nearest.0 {
                *nearest = (distance_m, Some(index));
            }
        }
        nearest.into_iter().map(|(_, index)| index).collect()
    }
}

#[cfg(test)]
mod tests;

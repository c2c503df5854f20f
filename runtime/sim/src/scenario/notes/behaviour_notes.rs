//! States that no agent enters, and transitions that are never taken.

use crate::behaviour::{Behaviour, Bound, Condition, FOLLOWS_PATH, Movement, SignalOrder, State, Target};
use crate::scenario::resolved::Scenario;

/// What holds in no step, as far as the scenario alone shows it.
struct Never<'a> {
    scenario: &'a Scenario,
    /// Number of agents that are ever in the scene.
    agents: usize,
    /// Whether any agent ever has a goal that is no waypoint of its own.
    has_goals: bool,
}

/// One sentence for each state and transition without effect.
pub(crate) fn notes(scenario: &Scenario) -> Vec<String> {
    let behaviour = &scenario.behaviour;
    let entered = entered(scenario);
    let never = Never::new(scenario);
    let mut notes = Vec::new();
    for (index, state) in behaviour.states.iter().enumerate() {
        if !entered[index] {
            if state.name != FOLLOWS_PATH {
                notes.push(format!("state `{}`: no agent enters it", state.name));
            }
            continue;
        }
        for (number, transition) in state.transitions.iter().enumerate() {
            let at = |what: &str| format!("state `{}`, transition {number}: {what}", state.name);
            if let Some(why) = never.holds_in(state, &transition.condition) {
                notes.push(at(&format!("its condition never holds, because {why}")));
            } else if transition.target == Target::Back && !is_target(behaviour, index as u32) {
                notes.push(at("it leads back, but agents begin in this state and have no state before"));
            }
        }
    }
    for event in &behaviour.events {
        if let Some(why) = never.holds(&event.condition) {
            notes.push(format!("event `{}` never happens, because {why}", event.name));
        }
    }
    notes
}

/// Whether any agent may enter each state.
fn entered(scenario: &Scenario) -> Vec<bool> {
    let agents = scenario.agents.iter().map(|agent| agent.state);
    let mut starts: Vec<u32> = agents.chain(scenario.sources.iter().map(|source| source.state)).collect();
    starts.sort_unstable();
    starts.dedup();
    let mut entered = vec![false; scenario.behaviour.states.len()];
    for reachable in starts.into_iter().map(|start| scenario.behaviour.reachable_from(start)) {
        entered.iter_mut().zip(reachable).for_each(|(entered, reachable)| *entered |= reachable);
    }
    entered
}

/// Whether a transition or an event leads to a state, by index.
fn is_target(behaviour: &Behaviour, state: u32) -> bool {
    let is_entered = |transition: &Target| match transition {
        Target::States(states) => states.iter().any(|(to, weight)| *to == state && *weight > 0.0),
        Target::Back => false,
    };
    let mut transitions = behaviour.states.iter().flat_map(|state| &state.transitions);
    transitions.any(|transition| is_entered(&transition.target))
        || behaviour.events.iter().any(|event| event.to == Some(state))
}

impl<'a> Never<'a> {
    fn new(scenario: &'a Scenario) -> Self {
        let until_s = f64::from(scenario.duration_s);
        let due = |(index, source): (usize, &crate::scenario::SourceSpec)| {
            source.due_times(scenario.seed, index).take_while(|due_s| *due_s <= until_s).count()
        };
        let agents = scenario.agents.len() + scenario.sources.iter().enumerate().map(due).sum::<usize>();
        let goals = |state: &State| {
            matches!(state.movement, Movement::Goals { .. } | Movement::Mirrored { .. } | Movement::Offset { .. })
        };
        Self { scenario, agents, has_goals: scenario.behaviour.states.iter().any(goals) }
    }

    /// Why a condition never holds for an agent in a state; none where it may.
    fn holds_in(&self, state: &State, condition: &Condition) -> Option<String> {
        match condition {
            Condition::Reached(_) => self.reached_in(state),
            Condition::Served(_) => match state.movement {
                Movement::Goals { set, .. } if self.scenario.behaviour.goals[set].queue => None,
                Movement::Goals { set, .. } => {
                    Some(format!("goals `{}` are no queue", self.scenario.behaviour.goals[set].name))
                }
                _ => Some("an agent in this state stands in no queue".to_owned()),
            },
            Condition::All(parts) => parts.iter().find_map(|part| self.holds_in(state, part)),
            Condition::Any(parts) => {
                let why: Option<Vec<String>> = parts.iter().map(|part| self.holds_in(state, part)).collect();
                why.and_then(|why| why.into_iter().next())
            }
            _ => self.holds(condition),
        }
    }

    /// Why a condition that speaks of no single agent never holds; none where it may.
    fn holds(&self, condition: &Condition) -> Option<String> {
        let behaviour = &self.scenario.behaviour;
        match condition {
            Condition::After(duration_s) => {
                let [least_s, _] = duration_s.bounds();
                let until_s = self.scenario.duration_s;
                (least_s > until_s).then(|| format!("{least_s} s are more than the {until_s} s of the scenario"))
            }
            Condition::Green(signal) => {
                let is_red = !is_ever_green(self.scenario, *signal);
                is_red.then(|| format!("signal `{}` is never green", behaviour.signals[*signal].name))
            }
            Condition::Number(_, bound) | Condition::Population(_, bound) => self.number(*bound),
            Condition::All(parts) => parts.iter().find_map(|part| self.holds(part)),
            Condition::Any(parts) => {
                let why: Option<Vec<String>> = parts.iter().map(|part| self.holds(part)).collect();
                why.and_then(|why| why.into_iter().next())
            }
            _ => None,
        }
    }

    fn number(&self, bound: Bound) -> Option<String> {
        let (least, agents) = (bound.at_least as usize, self.agents);
        (least > agents).then(|| format!("there are never {least} agents, but {agents} at most"))
    }

    fn reached_in(&self, state: &State) -> Option<String> {
        let scenario = self.scenario;
        match state.movement {
            Movement::OwnPath if !has_path(scenario) => Some("no agent has a path of its own".to_owned()),
            Movement::Walk { .. } => Some("an agent in this state has no goal".to_owned()),
            Movement::Stand { .. } if !self.has_goals => Some("no state gives agents a goal".to_owned()),
            _ => None,
        }
    }
}

/// Whether any agent has waypoints of its own.
pub(crate) fn has_path(scenario: &Scenario) -> bool {
    let of_source = |source: &crate::scenario::SourceSpec| !source.goals_m.is_empty() || source.goal_offset_m.is_some();
    scenario.agents.iter().any(|agent| !agent.goals_m.is_empty()) || scenario.sources.iter().any(of_source)
}

/// Whether a signal, by index, is green at some time before the end.
pub(crate) fn is_ever_green(scenario: &Scenario, signal: usize) -> bool {
    let Some(phases) = scenario.behaviour.signals.get(signal) else { return true };
    let until_s = f64::from(scenario.duration_s);
    let [green_s, red_s, offset_s] = [phases.green_s, phases.red_s, phases.offset_s].map(f64::from);
    // It is green at the start, or its next green phase begins in time.
    let to_green_s = (offset_s).rem_euclid((green_s + red_s).max(f64::MIN_POSITIVE));
    let by_phases = green_s > 0.0 && (phases.is_green(0.0) || to_green_s <= until_s);
    let ordered = |order: &(usize, SignalOrder)| order.0 == signal && order.1 == SignalOrder::Green;
    by_phases || scenario.behaviour.events.iter().any(|event| event.signals.iter().any(ordered))
}

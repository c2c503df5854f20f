//! The behaviour of a scenario: states, and what they refer to by index. World, metres, seconds, radians.

use glam::Vec2;
use serde::{Deserialize, Serialize};

use crate::behaviour::area::Area;
use crate::behaviour::choice::Choice;
use crate::behaviour::condition::Condition;
use crate::behaviour::distribution::Distribution;
use crate::behaviour::event::Event;
use crate::behaviour::goals::{GoalArea, GoalSet};
use crate::behaviour::signal::Signal;

/// Name of the state of an agent that follows its waypoints: the first state of every behaviour that has any.
pub const FOLLOWS_PATH: &str = "follow_path";

/// All that a scenario states about behaviour. Without states, every agent follows its own waypoints.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Behaviour {
    /// The states; the first is [`FOLLOWS_PATH`], or there are none.
    pub states: Vec<State>,
    /// The sets of goals.
    pub goals: Vec<GoalSet>,
    /// The signals.
    pub signals: Vec<Signal>,
    /// The areas that conditions name.
    pub areas: Vec<Area>,
    /// What happens once to many agents and signals.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub events: Vec<Event>,
}

/// A state.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct State {
    /// Name of the state.
    pub name: String,
    /// Where an agent in this state goes.
    pub movement: Movement,
    /// What changes when an agent enters.
    pub settings: Settings,
    /// Transitions in order; the first whose condition holds is taken.
    pub transitions: Vec<Transition>,
}

/// Where an agent goes.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub enum Movement {
    /// Along its own waypoints.
    OwnPath,
    /// To an area of a set of goals.
    Goals {
        /// The set, by index.
        set: usize,
        /// How an agent chooses.
        choice: Choice,
        /// The state, by index, for which the agent remembers its choice: it takes the same area again, and keeps its
        /// place there while it is elsewhere. Several states may share a memory. None: it chooses each time it enters.
        /// A queue has no memory: an agent that leaves it joins its end again.
        memory: Option<u32>,
    },
    /// To the position opposite its start, through a point.
    Mirrored {
        /// The point, world, m.
        centre_m: Vec2,
    },
    /// To the position at an offset from its start.
    Offset {
        /// The offset, world, m.
        by_m: Vec2,
    },
    /// At a constant velocity, without a goal.
    Walk {
        /// The velocity, world, m/s.
        velocity_mps: Vec2,
    },
    /// It goes to its position in the area of its last goal, and stands there; without a goal, where it is.
    Stand {
        /// The facing.
        facing: Facing,
    },
    /// It leaves the scene.
    Leave {
        /// Before the next step, not between two steps of its feet.
        at_once: bool,
    },
}

/// Facing of an agent that stands.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
pub enum Facing {
    /// As it arrives.
    #[default]
    AsArrived,
    /// As the area of its goal states.
    OfGoal,
    /// In a direction, world, rad.
    Towards(f32),
    /// To a position, world, m.
    At(Vec2),
}

/// Changes of an agent that enters a state.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Settings {
    /// Preferred speed, m/s.
    pub preferred_speed_mps: Option<Distribution>,
    /// Factor of the preferred speed.
    pub speed_factor: Option<Distribution>,
    /// Radius of the disc that other agents see, m.
    pub radius_m: Option<Distribution>,
    /// Priority while the agent is in the state; none: its own.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub priority: Option<f32>,
    /// Position to which the agent is moved at once.
    pub teleport: Option<Area>,
    /// Whether speed and radius stay changed when the agent leaves the state.
    pub remain: bool,
}

/// A transition to another state.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Transition {
    /// When it is taken.
    pub condition: Condition,
    /// Where it leads.
    pub target: Target,
}

/// Where a transition leads.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub enum Target {
    /// To states by index, with weights.
    States(Vec<(u32, f32)>),
    /// Back to the state before.
    Back,
}

impl State {
    /// The state of agents that follow their waypoints.
    pub fn follow_path() -> Self {
        Self {
            name: FOLLOWS_PATH.to_owned(),
            movement: Movement::OwnPath,
            settings: Settings::default(),
            transitions: Vec::new(),
        }
    }
}

impl Behaviour {
    /// Whether nothing is stated.
    pub fn is_empty(&self) -> bool {
        let Self { states, goals, signals, areas, events } = self;
        states.is_empty() && goals.is_empty() && signals.is_empty() && areas.is_empty() && events.is_empty()
    }

    /// Whether a signal, by index, is green at a time, s. One that there is not is always green.
    pub fn is_green(&self, signal: usize, time_s: f64) -> bool {
        self.signals.get(signal).is_none_or(|signal| signal.is_green(time_s))
    }

    /// Names of all states, as a recording's header lists them.
    pub fn state_names(&self) -> Vec<String> {
        match self.states.is_empty() {
            true => vec![FOLLOWS_PATH.to_owned()],
            false => self.states.iter().map(|state| state.name.clone()).collect(),
        }
    }

    /// Facing of an agent that starts in a state at a position, rad; none where the state does not decide it.
    pub fn start_facing_rad(&self, state: u32, position_m: Vec2) -> Option<f32> {
        let towards = |to_m: Vec2| (to_m - position_m).try_normalize().map(|to| libm::atan2f(to.y, to.x));
        match self.states.get(state as usize)?.movement {
            Movement::Goals { set, .. } => {
                let distance_m = |area: &&GoalArea| area.area.distance_m(position_m);
                let areas = self.goals.get(set)?.areas.iter();
                towards(areas.min_by(|a, b| distance_m(a).total_cmp(&distance_m(b)))?.area.centre_m())
            }
            Movement::Mirrored { centre_m } => towards(centre_m),
            Movement::Offset { by_m } => towards(position_m + by_m),
            Movement::Walk { velocity_mps } => towards(position_m + velocity_mps),
            Movement::Stand { facing: Facing::Towards(facing_rad) } => Some(facing_rad),
            Movement::Stand { facing: Facing::At(at_m) } => towards(at_m),
            Movement::OwnPath | Movement::Stand { .. } | Movement::Leave { .. } => None,
        }
    }

    /// Priority of an agent in a state, by index; `own` where the state sets none.
    pub(crate) fn priority(&self, state: usize, own: f32) -> f32 {
        self.states.get(state).and_then(|state| state.settings.priority).unwrap_or(own)
    }

    /// Name of a state, by index.
    pub fn state_name(&self, state: usize) -> &str {
        self.states.get(state).map_or(FOLLOWS_PATH, |state| &state.name)
    }

    /// Whether an agent that has entered a state, by index, stands there for good or leaves the scene.
    pub fn is_final(&self, state: usize) -> bool {
        self.states.get(state).is_some_and(|state| match state.movement {
            Movement::Stand { .. } | Movement::Walk { velocity_mps: Vec2::ZERO } => state.transitions.is_empty(),
            Movement::Leave { .. } => true,
            _ => false,
        })
    }

    /// Index of a state by name.
    pub fn state(&self, name: &str) -> Option<usize> {
        self.states.iter().position(|state| state.name == name)
    }

    /// Whether agents that begin in the state of this index can enter each state, if every condition may hold.
    pub(crate) fn reachable_from(&self, start: u32) -> Vec<bool> {
        let mut is_reachable = vec![false; self.states.len()];
        let mut open = vec![start];
        while let Some(index) = open.pop() {
            // Without states all agents follow their waypoints.
            let Some(state) = self.states.get(index as usize).filter(|_| !is_reachable[index as usize]) else {
                continue;
            };
            is_reachable[index as usize] = true;
            open.extend(self.events.iter().filter_map(|event| event.moves(index)));
            for transition in &state.transitions {
                // `back` leads to a state that has been reached.
                if let Target::States(states) = &transition.target {
                    open.extend(states.iter().filter(|(_, weight)| *weight > 0.0).map(|(state, _)| *state));
                }
            }
        }
        is_reachable
    }

    /// Names of the states that an agent would leave and enter again within one step, without end: each has a transition
    /// that always holds, and all its targets are such states.
    pub fn endless_states(&self) -> Vec<&str> {
        let always_to = |state: &State| -> Vec<Vec<u32>> {
            let always = state.transitions.iter().filter(|transition| transition.condition.is_always_true());
            let targets = always.filter_map(|transition| match &transition.target {
                Target::States(states) => Some(states.iter().map(|(state, _)| *state).collect()),
                Target::Back => None,
            });
            targets.collect()
        };
        let always_to: Vec<Vec<Vec<u32>>> = self.states.iter().map(always_to).collect();
        let mut endless = vec![true; self.states.len()];
        loop {
            let stays = |state: usize| {
                endless[state] && always_to[state].iter().any(|to| to.iter().all(|&target| endless[target as usize]))
            };
            let next: Vec<bool> = (0..endless.len()).map(stays).collect();
            if next == endless {
                break;
            }
            endless = next;
        }
        self.states.iter().zip(endless).filter(|(_, endless)| *endless).map(|(state, _)| state.name.as_str()).collect()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn state(name: &str, transitions: &[(Condition, &[u32])]) -> State {
        let transition = |(condition, states): &(Condition, &[u32])| Transition {
            condition: condition.clone(),
            target: Target::States(states.iter().map(|&state| (state, 1.0)).collect()),
        };
        State {
            name: name.into(),
            movement: Movement::OwnPath,
            settings: Settings::default(),
            transitions: transitions.iter().map(transition).collect(),
        }
    }

    #[test]
    fn only_circles_without_a_wait_are_endless() {
        let after = Condition::After(Distribution::Constant(1.0));
        let behaviour = Behaviour {
            states: vec![
                state("a", &[(Condition::Always, &[1, 2])]),
                state("b", &[(after.clone(), &[3]), (Condition::Always, &[0])]),
                state("c", &[(Condition::Always, &[2])]),
                state("d", &[(Condition::Always, &[4])]),
                state("e", &[(after, &[3])]),
            ],
            ..Behaviour::default()
        };
        assert_eq!(behaviour.endless_states(), ["a", "b", "c"]);
    }
}

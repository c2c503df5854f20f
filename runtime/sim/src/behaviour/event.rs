//! Events: what happens once to many agents and signals, as soon as a condition holds: an alarm, an opening door.

use serde::{Deserialize, Serialize};

use crate::behaviour::condition::Condition;

/// An event.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Event {
    /// Name of the event.
    pub name: String,
    /// When it happens, for the first and only time; durations count from the start of the simulation.
    pub condition: Condition,
    /// The states whose agents enter another state, by index; none: all.
    pub from: Option<Vec<u32>>,
    /// The state that they enter, by index; none: no agent changes its state.
    pub to: Option<u32>,
    /// Signals, by index, and what they show from then on.
    pub signals: Vec<(usize, SignalOrder)>,
}

/// What an event makes of a signal.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum SignalOrder {
    /// It stays green.
    Green,
    /// It stays red.
    Red,
    /// It shows its phases again.
    Phases,
}

impl Event {
    /// Whether agents of a state, by index, enter another.
    pub(crate) fn moves(&self, state: u32) -> Option<u32> {
        self.to.filter(|_| self.from.as_ref().is_none_or(|from| from.contains(&state)))
    }
}

impl Condition {
    /// Whether the condition speaks of no single agent, so that an event may wait for it.
    pub fn is_of_crowd(&self) -> bool {
        match self {
            Self::Reached(_) | Self::Served(_) | Self::Inside(_) => false,
            Self::Always | Self::After(_) | Self::Green(_) | Self::Number(..) | Self::Population(..) => true,
            Self::All(parts) | Self::Any(parts) => parts.iter().all(Self::is_of_crowd),
            Self::Not(part) => part.is_of_crowd(),
        }
    }
}

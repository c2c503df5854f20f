//! BFSM: the behaviour state machine of the crowd (`FbCrowd` §6), stage 0 of a step: what each agent wants.
//!
//! Enters: the position of each agent, and the time. Leaves: an aim for each agent, which the route turns into its
//! preferred velocity, and its present speed and radius.
//!
//! An agent is in one state at a time. A state has a movement, settings of the agent, and transitions to other states,
//! each with a condition. Every random number depends on seed, agent, number of states entered and purpose alone: neither
//! the order of agents nor the number of threads changes it.
//!
//! Read `state` (what a state is), `condition`, `goals` and `choice` (where an agent may go, and how it chooses); then
//! `machine` (one step of all agents) with `crowd_view`, `machine::deciding` and `machine::goal_keeping` (one agent in it),
//! `machine::group_leads` (groups in it), `agent_state` and `occupancy` (what it remembers); then the nouns below: `area`,
//! `distribution`, `signal`, `event`, `draw`. World, metres, seconds, radians.

pub mod agent_state;
pub mod area;
pub(crate) mod choice;
pub mod condition;
pub mod crowd_view;
pub mod distribution;
pub(crate) mod draw;
pub mod event;
pub mod goals;
pub mod machine;
pub mod occupancy;
pub mod signal;
pub mod state;

pub use agent_state::{AgentState, Aim, GoalRef, Traits};
pub use area::Area;
pub use choice::Choice;
pub use condition::{Bound, Condition};
pub use crowd_view::CrowdView;
pub use distribution::Distribution;
pub use event::{Event, SignalOrder};
pub use goals::{GoalArea, GoalSet};
pub use machine::{CrowdBehaviour, EndlessTransitions};
pub use signal::Signal;
pub use state::{Behaviour, FOLLOWS_PATH, Facing, Movement, Settings, State, Target, Transition};

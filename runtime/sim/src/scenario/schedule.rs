//! When the agents of a source are due, where one rate for all times does not say it. Seconds.
//!
//! Rows are in the order of time. Between rows no agent is due.

use serde::{Deserialize, Serialize};

/// When agents are due.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub enum Schedule {
    /// Random times, at a rate that changes.
    Rates(Vec<RateRow>),
    /// Stated times.
    Times(Vec<TimeRow>),
}

/// A time span and its rate.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct RateRow {
    /// Time from which agents are due, s.
    pub from_s: f32,
    /// Time until which agents are due, s.
    pub to_s: f32,
    /// Mean number of agents per second.
    pub rate_per_s: f32,
}

/// A time, and the agents that are due then.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct TimeRow {
    /// Time, s.
    pub time_s: f32,
    /// Number of agents.
    pub count: u32,
}

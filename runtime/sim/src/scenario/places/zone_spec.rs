//! A zone: ground on which agents walk slower or faster than they prefer, or that some agents do not enter. World, metres.

use serde::{Deserialize, Serialize};

use crate::behaviour::Area;

/// A zone.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct ZoneSpec {
    /// The ground.
    pub area: Area,
    /// Factor of the preferred velocity of agents in the zone.
    pub speed_factor: f32,
    /// Whether the zone is closed to some agents. Bit k of [`AgentSpec::closed_zones`](crate::AgentSpec::closed_zones)
    /// stands for the k-th of these zones.
    #[serde(default, skip_serializing_if = "std::ops::Not::not")]
    pub is_closed: bool,
}

//! A zone: ground on which agents walk slower or faster than they prefer. World, metres.

use serde::{Deserialize, Serialize};

use crate::behaviour::Area;

/// A zone.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct ZoneSpec {
    /// The ground.
    pub area: Area,
    /// Factor of the preferred velocity of agents in the zone.
    pub speed_factor: f32,
}

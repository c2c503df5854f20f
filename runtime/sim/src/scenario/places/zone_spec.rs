//! A zone: ground on which agents walk slower or faster than they prefer, that they pass one way, or that some agents do
//! not enter. World, metres.

use serde::{Deserialize, Serialize};

use crate::behaviour::Area;
use crate::world::one_way::OneWayZone;

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
    /// States, by index, in which agents do not enter the zone, which is then closed.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub closed_in: Vec<u32>,
    /// Direction in which agents pass the zone, from +x counter-clockwise, degrees; none where they walk as they want.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub one_way_deg: Option<f32>,
}

impl ZoneSpec {
    /// The one-way zone; none where agents walk as they want, or its area is no rectangle along the direction.
    pub fn one_way(&self) -> Option<OneWayZone> {
        self.one_way_deg.and_then(|heading_deg| OneWayZone::new(&self.area.outline_m(), heading_deg.to_radians()))
    }
}

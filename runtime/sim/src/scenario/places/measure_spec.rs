//! What a scenario measures besides the figures of every recording: lines, areas, the egress. World, metres.

use glam::Vec2;
use serde::{Deserialize, Serialize};

use crate::behaviour::Area;

/// A line, an area or the egress, by name.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct MeasureSpec {
    /// Name in tables and plots.
    pub name: String,
    /// What is measured.
    pub place: MeasuredPlace,
}

/// Where agents are measured.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum MeasuredPlace {
    /// Ends of a line that agents cross: passages, flow, specific flow.
    Line([Vec2; 2]),
    /// An area on the ground: density, speed, level of service.
    Area(Area),
    /// The removals of agents from the scene: egress times.
    Egress,
}

//! A door: an obstacle that is absent while a signal is green. World, metres.

use glam::Vec2;
use serde::{Deserialize, Serialize};

/// A door.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct DoorSpec {
    /// The obstacle that the closed door is: a simple polygon, corners counter-clockwise, world, m.
    pub polygon_m: Vec<Vec2>,
    /// Index of the signal that opens the door while it is green.
    pub signal: u32,
}

//! Tunables of the synthesis, with units, sources and reasons.

use serde::{Deserialize, Serialize};

/// Tunables of the synthesis.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields, default)]
pub struct HmsParams {
    /// Greatest change of the root's velocity in the body's frame, m/s². People brake and start with up to about 3.
    pub acceleration_max_mps2: f32,
    /// Greatest change of the turn rate, rad/s².
    pub turn_acceleration_max_rad_s2: f32,
    /// Least time for the shares of the examples to change hands completely, s: slim simplices would else flip poses.
    pub share_change_s: f32,
    /// T_turn: the turn rate is the angle to the wanted facing divided by this time, s.
    pub turn_time_s: f32,
    /// Share of that angle by which the frame of the asked velocity leads the facing: 0 side-steps until the turn is done, 1 walks
    /// forward along the arc.
    pub facing_lead: f32,
}

impl Default for HmsParams {
    fn default() -> Self {
        Self {
            acceleration_max_mps2: 3.0,
            turn_acceleration_max_rad_s2: 8.0,
            share_change_s: 0.25,
            turn_time_s: 0.4,
            facing_lead: 0.5,
        }
    }
}

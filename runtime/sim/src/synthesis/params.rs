//! Tunables of the synthesis, as a scenario file may set them.

use serde::{Deserialize, Serialize};

use crate::synthesis::Modes;

/// How a body changes from one synthesis to the other (App. 10); `fbcrowd bench course` measures both.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Transition {
    /// At the next pair of T, at the velocity that the body has. Inertialization carries the difference of poses.
    #[default]
    Direct,
    /// The paper's transition: the body first takes the velocity of m_mb, to which the planner sees it committed.
    /// t_trans does not include the time until the body has that velocity.
    ThroughMMb,
}

/// Tunables of the synthesis. `docs/tuning.md` holds the measurements behind the defaults.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields, default)]
pub struct HmsParams {
    /// Syntheses that a body may use.
    pub modes: Modes,
    /// Transition between the syntheses.
    pub transition: Transition,
    /// Greatest change of the root's velocity in the body's frame, m/s². People brake and start with up to about 3.
    pub acceleration_max_mps2: f32,
    /// Greatest change of the turn rate, rad/s².
    pub turn_acceleration_max_rad_s2: f32,
    /// Greatest speed of ankles and wrists due to a change of weights alone, m/s: root mean square over the cycle. It
    /// keeps poses from flipping where simplices are slim.
    pub pose_change_max_mps: f32,
    /// T_turn: the turn rate is the angle to the planned facing divided by this time, s.
    pub turn_time_s: f32,
    /// d_thresh of Eq. 1, in the units of the density filter, 1/m: above it a body uses semi-procedural locomotion.
    pub density_threshold: f32,
}

impl Default for HmsParams {
    fn default() -> Self {
        Self {
            modes: Modes::Hybrid,
            transition: Transition::Direct,
            acceleration_max_mps2: 3.0,
            turn_acceleration_max_rad_s2: 8.0,
            pose_change_max_mps: 0.7,
            turn_time_s: 0.3,
            density_threshold: 0.6,
        }
    }
}

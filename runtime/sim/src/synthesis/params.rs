//! Tunables of the synthesis, with units, sources and reasons.

use serde::{Deserialize, Serialize};

/// Which syntheses a body may use (`FbCrowd` §7 compares them on its obstacle course).
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Modes {
    /// Both, by Eq. 1.
    #[default]
    Hybrid,
    /// Motion blending alone.
    Blending,
    /// Semi-procedural locomotion alone, but for standing.
    SemiProcedural,
}

/// How synthesis changes hands (App. 10); `fbcrowd bench course` measures both.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Transition {
    /// At the next pair of T, at the velocity that the body has; what differs is left to inertia.
    #[default]
    Direct,
    /// The paper's: first at m_mb's velocity, on m_mb alone where it blends; the planner sees the body committed to it.
    /// t_trans does not count the time until that velocity is reached.
    ThroughMMb,
}

/// Tunables of the synthesis.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields, default)]
pub struct HmsParams {
    /// Which syntheses a body may use.
    pub modes: Modes,
    /// How a body changes from one to the other.
    pub transition: Transition,
    /// Greatest change of the root's velocity in the body's frame, m/s². People brake and start with up to about 3.
    pub acceleration_max_mps2: f32,
    /// Greatest change of the turn rate, rad/s².
    pub turn_acceleration_max_rad_s2: f32,
    /// Fastest that ankles and wrists move because shares change hands, root mean square over the cycle, m/s: slim
    /// simplices would else flip poses. Changes between like examples are quick, however many lie on the way.
    pub pose_change_max_mps: f32,
    /// T_turn: the turn rate is the angle to the wanted facing divided by this time, s. Shorter overshoots at the turn
    /// acceleration above; longer tracks worse (a turn of 90° at 1.3 m/s: 1.4 s and 1.2 m off the planned velocity at
    /// 0.3, 2.9 s and 2.1 m at 1).
    pub turn_time_s: f32,
    /// d_thresh of Eq. 1, as the density filter counts, 1/m: where more people are about, semi-procedural locomotion
    /// follows the planner more closely than a blend.
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

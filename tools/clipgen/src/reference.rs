//! What the bundled clips are held against: what their names claim, and the published curves they take after.

use crate::catalogue::{self, Recipe};
use crate::published_curves::Style;

pub use crate::published_curves::LegFlexion;

/// What a clip's name claims.
#[derive(Clone, Debug, PartialEq)]
pub struct Claim {
    /// The clip, as its file is called without extension.
    pub name: &'static str,
    /// v_f, m/s.
    pub speed_mps: f64,
    /// ω_t, rad/s, left positive.
    pub turn_rate_rad_s: f64,
    /// ω_s, m/s, left positive.
    pub strafe_mps: f64,
    /// It has a flight phase.
    pub runs: bool,
}

/// The claims of all clips, in the order of their README.
pub fn claims() -> Vec<Claim> {
    let claim = |clip: &catalogue::Clip| Claim {
        name: clip.name,
        speed_mps: clip.motion.speed_mps,
        turn_rate_rad_s: clip.motion.turn_rate_rad_s,
        strafe_mps: clip.motion.strafe_mps,
        runs: matches!(&clip.recipe, Recipe::Steps { gait, .. } if gait.running),
    };
    catalogue::clips().iter().map(claim).collect()
}

/// Schwartz, Rozumalski and Trost (2008) at a speed, at a share of the cycle from the leg's heel strike, warped in time
/// so that toe-off falls on `toe_off` (a share of the cycle too).
pub fn published_walk(speed_mps: f64, since_strike: f64, toe_off: f64) -> LegFlexion {
    Style::walk(speed_mps).flexion(since_strike, toe_off)
}

//! What the bundled clips are compared with: the motion that their names claim, and published joint curves.

use crate::catalogue::{self, ClipRecipe};
use crate::plan::published_curves::PublishedGait;

pub use crate::plan::published_curves::LegFlexion;

/// The motion that a clip's name claims.
#[derive(Clone, Debug, PartialEq)]
pub struct Claim {
    /// File name of the clip without extension.
    pub name: &'static str,
    /// Speed v_f, m/s; negative backward.
    pub speed_mps: f64,
    /// Turn rate ω_t, rad/s; positive to the left.
    pub turn_rate_rad_s: f64,
    /// Side speed ω_s, m/s; positive to the left.
    pub strafe_mps: f64,
    /// The gait has a flight phase.
    pub runs: bool,
}

/// The claims of all clips, in the order of their README.
///
/// # Examples
/// ```
/// let claims = clipgen::reference::claims();
/// let walk = claims.iter().find(|claim| claim.name == "walk_110").ok_or("no such clip")?;
/// assert_eq!((walk.speed_mps, walk.runs), (1.1, false));
/// # Ok::<(), &str>(())
/// ```
pub fn claims() -> Vec<Claim> {
    let claim = |clip: &catalogue::PlannedClip| Claim {
        name: clip.name,
        speed_mps: clip.motion.speed_mps,
        turn_rate_rad_s: clip.motion.turn_rate_rad_s,
        strafe_mps: clip.motion.strafe_mps,
        runs: matches!(&clip.recipe, ClipRecipe::Steps { gait, .. } if gait.running),
    };
    catalogue::planned_clips().iter().map(claim).collect()
}

/// Published joint angles of a walk at a speed: Schwartz, Rozumalski and Trost (2008).
///
/// `since_strike` is the share of the cycle since the leg's heel strike; the curves are warped in time so that toe-off
/// falls on `toe_off`, a share of the cycle too.
pub fn published_walk(speed_mps: f64, since_strike: f64, toe_off: f64) -> LegFlexion {
    PublishedGait::walk(speed_mps).flexion(since_strike, toe_off)
}

//! How agents slow down before their last goals, sharp turns and closed doors. World, metres, seconds.

use glam::Vec2;

use crate::scenario::Coupling;

/// Even braking before the last goal, m/s²: a third of what a person can do at most.
pub(crate) const BRAKING_MPS2: f32 = 1.0;
/// Time remaining on the last stretch, s: there the speed falls with the distance.
const STOPPING_TIME_S: f32 = 0.5;
/// Time for which a body goes on at its speed beyond the point where its agent prefers to rest, s: plans lag behind
/// v_pref, and the feet close (docs/tuning.md).
pub(crate) const COAST_S: f32 = 0.16;

/// How an agent slows down before its last goal.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Braking {
    /// As a body can: evenly, and so early that it rests at the goal after it has coasted; then it stays until it is
    /// pushed away.
    Evenly,
    /// As a disc can, which stops at once: at full speed until the goal lies within this time, s; it never rests. The
    /// protocol under which RVO2 is measured (`fbcrowd bench table1 --discs`).
    Within(f32),
    /// Not at all: the agent walks through its goal, where it leaves the scene.
    Not,
}

impl Braking {
    /// How agents slow down, by the coupling of their simulation, in steps of `dt_s`.
    pub(crate) fn of(coupling: Coupling, dt_s: f32) -> Self {
        match coupling {
            Coupling::TwoWay | Coupling::Decoupled => Self::Evenly,
            Coupling::Discs => Self::Within(dt_s),
        }
    }
}

/// Velocity that an agent keeps until it responds to a new v_pref, m/s: that of its body; 0 of a disc.
pub(crate) fn coasting_mps(coupling: Coupling, velocity_mps: Vec2) -> Vec2 {
    if coupling == Coupling::TwoWay { velocity_mps } else { Vec2::ZERO }
}

/// Distance that an agent at a coasting velocity still moves in a direction after v_pref is 0, m.
pub(crate) fn coasted_m(coasting_mps: Vec2, direction: Vec2) -> f32 {
    COAST_S * coasting_mps.dot(direction).max(0.0)
}

/// Distance within which an agent at a speed has to brake in order to stand, m: the inverse of [`braking_speed_mps`].
pub(crate) fn braking_distance_m(speed_mps: f32) -> f32 {
    let last_stretch_mps = BRAKING_MPS2 * STOPPING_TIME_S;
    if speed_mps < last_stretch_mps {
        return speed_mps * STOPPING_TIME_S;
    }
    0.5 * (speed_mps * speed_mps / BRAKING_MPS2 + last_stretch_mps * STOPPING_TIME_S)
}

/// The speed from which even braking, then the last stretch, stop at the goal; both meet with the same slope.
pub(crate) fn braking_speed_mps(distance_m: f32) -> f32 {
    let last_stretch_m = BRAKING_MPS2 * STOPPING_TIME_S * STOPPING_TIME_S;
    if distance_m < last_stretch_m {
        return distance_m / STOPPING_TIME_S;
    }
    libm::sqrtf(2.0 * BRAKING_MPS2 * (distance_m - 0.5 * last_stretch_m))
}

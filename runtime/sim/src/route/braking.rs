//! How agents slow down before their last goals, and before closed doors. World, metres, seconds.

use glam::Vec2;

use crate::scenario::Coupling;

/// Even braking before the last goal, m/s²: a third of what a person can do at most.
pub(crate) const BRAKING_MPS2: f32 = 1.0;
/// Time remaining on the last stretch, s: there the speed falls with the distance.
const STOPPING_TIME_S: f32 = 0.5;
/// Time for which a body goes on at its speed beyond the point where its agent prefers to rest, s: plans lag behind v_pref,
/// and the feet close (docs/tuning.md).
pub(crate) const COAST_S: f32 = 0.2;

/// How an agent slows down before its last goal.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Braking {
    /// As a body can: evenly, and so early that it rests at the goal after it has coasted; then it stays until it is
    /// pushed away.
    Evenly {
        /// Velocity at which the body coasts once v_pref is 0, world, m/s; 0 of a disc that stops at once.
        velocity_mps: Vec2,
    },
    /// As a disc can, which stops at once: at full speed until the goal lies within this time, s; it never rests. The
    /// protocol under which RVO2 is measured (`fbcrowd bench table1 --discs`).
    Within(f32),
    /// Not at all: the agent walks through its goal, where it leaves the scene.
    Not,
}

impl Braking {
    /// How an agent at a velocity slows down, by the coupling of its simulation, in steps of `dt_s`.
    pub(crate) fn of(coupling: Coupling, velocity_mps: Vec2, dt_s: f32) -> Self {
        match coupling {
            Coupling::TwoWay => Self::Evenly { velocity_mps },
            Coupling::Decoupled => Self::Evenly { velocity_mps: Vec2::ZERO },
            Coupling::Discs => Self::Within(dt_s),
        }
    }

    /// Distance that the body still moves in a direction after v_pref is 0, m.
    pub(crate) fn coast_m(self, direction: Vec2) -> f32 {
        if let Self::Evenly { velocity_mps } = self { COAST_S * velocity_mps.dot(direction).max(0.0) } else { 0.0 }
    }
}

/// The speed from which even braking, then the last stretch, stop at the goal; both meet with the same slope.
pub(crate) fn braking_speed_mps(distance_m: f32) -> f32 {
    let last_stretch_m = BRAKING_MPS2 * STOPPING_TIME_S * STOPPING_TIME_S;
    if distance_m < last_stretch_m {
        return distance_m / STOPPING_TIME_S;
    }
    libm::sqrtf(2.0 * BRAKING_MPS2 * (distance_m - 0.5 * last_stretch_m))
}

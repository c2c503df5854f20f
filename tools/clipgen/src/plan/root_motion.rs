//! The motion of the root: uniform at (v_f, ω_t, ω_s), along an arc.
//!
//! Frame of the root at time 0: x forward, y left, metres, seconds, radians.

use glam::DVec2;

/// Turn rate below which the path is straight, rad/s.
const STRAIGHT_RAD_S: f64 = 1e-9;

/// Constant rates of the root.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct RootMotion {
    /// Speed v_f along the facing, m/s; negative backward.
    pub(crate) speed_mps: f64,
    /// Turn rate ω_t, rad/s; positive to the left.
    pub(crate) turn_rate_rad_s: f64,
    /// Side speed ω_s, m/s; positive to the left.
    pub(crate) strafe_mps: f64,
}

impl RootMotion {
    /// Heading after a time, rad.
    pub(crate) fn heading_rad(&self, time_s: f64) -> f64 {
        self.turn_rate_rad_s * time_s
    }

    /// Position after a time, in the frame of time 0, m.
    pub(crate) fn position_m(&self, time_s: f64) -> DVec2 {
        let velocity_mps = DVec2::new(self.speed_mps, self.strafe_mps);
        if self.turn_rate_rad_s.abs() < STRAIGHT_RAD_S {
            return velocity_mps * time_s;
        }
        let (sin, cos) = libm::sincos(self.heading_rad(time_s));
        (velocity_mps * sin + velocity_mps.perp() * (1.0 - cos)) / self.turn_rate_rad_s
    }

    /// The same motion backward in time.
    pub(crate) fn reversed(self) -> Self {
        Self { speed_mps: -self.speed_mps, turn_rate_rad_s: -self.turn_rate_rad_s, strafe_mps: -self.strafe_mps }
    }

    /// Magnitude of the velocity, m/s.
    pub(crate) fn pace_mps(&self) -> f64 {
        libm::hypot(self.speed_mps, self.strafe_mps)
    }
}

//! Where the feet stand: footprints planned in the world, seen from the moving root.
//!
//! The root moves uniformly at (v_f, ω_t, ω_s), along an arc. A footprint is put down relative to the root of
//! mid-stance and then stays where it is in the world; so seen from the root it runs backward along the same arc. Root
//! frame: x forward, y left, metres.

use glam::DVec2;

use crate::rotation::wrapped;

/// Turn rates below this make a straight path, rad/s.
const STRAIGHT_RAD_S: f64 = 1e-9;

/// How the root moves.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct RootMotion {
    /// v_f along the facing, m/s.
    pub(crate) speed_mps: f64,
    /// ω_t, counter-clockwise, rad/s.
    pub(crate) turn_rate_rad_s: f64,
    /// ω_s to the left, m/s.
    pub(crate) strafe_mps: f64,
}

impl RootMotion {
    /// Heading after a time, radians.
    pub(crate) fn heading_rad(&self, time_s: f64) -> f64 {
        self.turn_rate_rad_s * time_s
    }

    /// Place after a time in the frame of time 0, m.
    pub(crate) fn place_m(&self, time_s: f64) -> DVec2 {
        let velocity = DVec2::new(self.speed_mps, self.strafe_mps);
        if self.turn_rate_rad_s.abs() < STRAIGHT_RAD_S {
            return velocity * time_s;
        }
        let (sin, cos) = libm::sincos(self.heading_rad(time_s));
        (velocity * sin + velocity.perp() * (1.0 - cos)) / self.turn_rate_rad_s
    }

    /// The motion of the film run backward.
    pub(crate) fn reversed(self) -> Self {
        Self { speed_mps: -self.speed_mps, turn_rate_rad_s: -self.turn_rate_rad_s, strafe_mps: -self.strafe_mps }
    }

    /// Length of the velocity, m/s.
    pub(crate) fn pace_mps(&self) -> f64 {
        libm::hypot(self.speed_mps, self.strafe_mps)
    }
}

/// A standing foot: the point of the ground under the ankle of the flat foot, and where the toes point.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Footprint {
    /// In the root frame, m.
    pub(crate) ground_m: DVec2,
    /// Against the root's heading, radians.
    pub(crate) yaw_rad: f64,
}

impl Footprint {
    /// The same footprint of the world, `after_s` later, in the root frame of then.
    pub(crate) fn seen_later(&self, root: &RootMotion, after_s: f64) -> Self {
        let heading_rad = root.heading_rad(after_s);
        let (sin, cos) = libm::sincos(-heading_rad);
        let ground_m = DVec2::new(cos, sin).rotate(self.ground_m - root.place_m(after_s));
        Self { ground_m, yaw_rad: self.yaw_rad - heading_rad }
    }
}

/// Phase of a leg since its heel strike; the left leg strikes at cycle phase 0, the right leg at ½.
pub(crate) fn leg_phase(cycle_phase: f64, side: usize) -> f64 {
    wrapped(cycle_phase + 0.5 * side as f64)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn footprint_seen_from_the_root_stands_still_in_the_world() {
        let root = RootMotion { speed_mps: 0.8, turn_rate_rad_s: 1.3, strafe_mps: 0.2 };
        let print = Footprint { ground_m: DVec2::new(0.1, 0.07), yaw_rad: 0.1 };
        for step in -5..5 {
            let after_s = 0.1 * f64::from(step);
            let later = print.seen_later(&root, after_s);
            let (sin, cos) = libm::sincos(root.heading_rad(after_s));
            let world_m = root.place_m(after_s) + DVec2::new(cos, sin).rotate(later.ground_m);
            assert!(world_m.distance(print.ground_m) < 1e-12);
        }
    }
}

//! Where a foot stands: a footprint of the world, seen from the moving root.
//!
//! A footprint is set relative to the root of mid-stance and then stays where it is in the world. Seen from the root it
//! moves backward along the root's own arc. Root frame: x forward, y left, metres, radians.

use glam::DVec2;

use crate::body::rotation::wrapped;
use crate::plan::root_motion::RootMotion;

/// A standing foot.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Footprint {
    /// Point of the ground under the ankle of the flat foot, root frame, m.
    pub(crate) ground_m: DVec2,
    /// Direction of the toes against the root's heading, rad; positive to the left.
    pub(crate) yaw_rad: f64,
}

impl Footprint {
    /// The same footprint of the world, `after_s` later, in the root frame of that time.
    pub(crate) fn seen_later(&self, root: &RootMotion, after_s: f64) -> Self {
        let heading_rad = root.heading_rad(after_s);
        let (sin, cos) = libm::sincos(-heading_rad);
        let ground_m = DVec2::new(cos, sin).rotate(self.ground_m - root.position_m(after_s));
        Self { ground_m, yaw_rad: self.yaw_rad - heading_rad }
    }
}

/// Phase of a leg since its heel strike, in [0, 1); the left leg strikes at cycle phase 0, the right leg at ½.
pub(crate) fn leg_phase(cycle_phase: f64, side: usize) -> f64 {
    wrapped(cycle_phase + 0.5 * side as f64)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn footprints_stand_still_in_the_world() {
        let root = RootMotion { speed_mps: 0.8, turn_rate_rad_s: 1.3, strafe_mps: 0.2 };
        let print = Footprint { ground_m: DVec2::new(0.1, 0.07), yaw_rad: 0.1 };
        for step in -5..5 {
            let after_s = 0.1 * f64::from(step);
            let later = print.seen_later(&root, after_s);
            let (sin, cos) = libm::sincos(root.heading_rad(after_s));
            let world_m = root.position_m(after_s) + DVec2::new(cos, sin).rotate(later.ground_m);
            assert!(world_m.distance(print.ground_m) < 1e-12);
        }
    }
}

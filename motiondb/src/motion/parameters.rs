//! The three parameters of a clip (`FbCrowd` §3.1): forward speed, turn rate, side speed.

use glam::Vec3;
use serde::{Deserialize, Serialize};

/// (v_f, ω_t, ω_s).
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Parameters {
    /// v_f: along the facing, negative for back-pedalling, m/s.
    pub speed_mps: f32,
    /// ω_t: change of facing, counter-clockwise positive, rad/s.
    pub turn_rate_rad_s: f32,
    /// ω_s: to the left of the facing, m/s.
    pub strafe_mps: f32,
}

impl Parameters {
    /// As a point of the blend space, in the order above.
    pub fn to_vec3(self) -> Vec3 {
        Vec3::new(self.speed_mps, self.turn_rate_rad_s, self.strafe_mps)
    }

    /// From a point of the blend space.
    pub fn from_vec3(point: Vec3) -> Self {
        Self { speed_mps: point.x, turn_rate_rad_s: point.y, strafe_mps: point.z }
    }

    /// Those of the mirrored motion.
    #[must_use]
    pub fn mirrored(self) -> Self {
        Self { speed_mps: self.speed_mps, turn_rate_rad_s: -self.turn_rate_rad_s, strafe_mps: -self.strafe_mps }
    }
}

//! The three parameters of a motion (`FbCrowd` §3.1): forward speed v_f, turn rate ω_t and side speed ω_s.

use glam::{Vec2, Vec3};
use serde::{Deserialize, Serialize};

/// A point (v_f, ω_t, ω_s): how a motion moves the root, in the root frame.
///
/// ```
/// use motiondb::Parameters;
///
/// let left_turn = Parameters { speed_mps: 1.2, turn_rate_rad_s: 0.5, strafe_mps: 0.0 };
/// assert_eq!(left_turn.mirrored().turn_rate_rad_s, -0.5);
/// assert_eq!(Parameters::from_vec3(left_turn.to_vec3()), left_turn);
/// ```
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Parameters {
    /// v_f: speed along the facing, negative for back-pedalling, m/s.
    pub speed_mps: f32,
    /// ω_t: rate of change of the facing, counter-clockwise positive, rad/s.
    pub turn_rate_rad_s: f32,
    /// ω_s: speed to the left of the facing, m/s.
    pub strafe_mps: f32,
}

impl Parameters {
    /// The point as a vector (v_f, ω_t, ω_s).
    pub fn to_vec3(self) -> Vec3 {
        Vec3::new(self.speed_mps, self.turn_rate_rad_s, self.strafe_mps)
    }

    /// The point of a vector (v_f, ω_t, ω_s).
    pub fn from_vec3(point: Vec3) -> Self {
        Self { speed_mps: point.x, turn_rate_rad_s: point.y, strafe_mps: point.z }
    }

    /// Velocity (v_f, ω_s) of the root, in the root frame: forward and left, m/s.
    pub fn velocity_mps(self) -> Vec2 {
        Vec2::new(self.speed_mps, self.strafe_mps)
    }

    /// Parameters of the mirrored motion.
    #[must_use]
    pub fn mirrored(self) -> Self {
        Self { speed_mps: self.speed_mps, turn_rate_rad_s: -self.turn_rate_rad_s, strafe_mps: -self.strafe_mps }
    }
}

//! Leg clearance: a swinging foot passes beside the leg that stands, also where that leg does not stand as in the pose.
//!
//! Shanks do not cross in the examples. But a planted foot stays where it is while the body turns, side-steps or
//! changes direction, and the swinging one would pass through it. Where the stance foot is nearer to the path of the
//! swinging foot than in the pose, that foot moves outward by the difference. A gap that the pose itself has is enough.
//! The filter that moves the foot lags. So the displacement is that of the position which the foot reaches after this time.
//!
//! Frame of the drawn body (x forward, y left), metres.

use glam::{Vec2, Vec3};
use motiondb::body::Side;

/// Lateral distance of two ankles that pass each other, m: shanks of adults are 10 cm thick.
const GAP_M: f32 = 0.14;
/// Distance along the facing beyond which the legs do not meet, m.
const APART_M: f32 = 0.35;
/// Lag of the filter that moves the foot, s: 3/r of `LOCK_RELEASE_RATE_HZ`.
pub(crate) const LAG_S: f32 = 0.1;
/// Greatest displacement, m: a step across ends where the foot can land.
const ASIDE_MAX_M: f32 = 0.15;

/// Displacement of a swinging foot to its side, m, given its ankle [`LAG_S`] later, in the pose and as other displacements
/// move it, and the stance ankle, in the pose and as it is locked. `side` is that of the swinging foot.
pub(crate) fn aside_m(side: usize, [posed_m, moved_m]: [Vec3; 2], [stance_m, locked_m]: [Vec3; 2]) -> Vec2 {
    let sign = Side::BOTH[side].sign();
    let posed_gap_m = sign * (posed_m.y - stance_m.y);
    let lacking_m = posed_gap_m.min(GAP_M) - sign * (moved_m.y - locked_m.y);
    let along = ((moved_m.x - locked_m.x) / APART_M).clamp(-1.0, 1.0);
    Vec2::new(0.0, sign * (1.0 - along * along) * lacking_m.clamp(0.0, ASIDE_MAX_M))
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Displacement of the left foot from 10 cm beside the pose's right one, where that one stands elsewhere.
    fn displaced_m(locked_x_m: f32, locked_y_m: f32) -> Vec2 {
        aside_m(0, [Vec3::new(0.0, 0.1, 0.1); 2], [Vec3::new(0.0, -0.1, 0.0), Vec3::new(locked_x_m, locked_y_m, 0.0)])
    }

    #[test]
    fn a_foot_passes_beside_a_leg_that_stands_in_its_path() {
        assert!((displaced_m(0.0, 0.0).y - 0.04).abs() < 1e-6);
        assert_eq!(displaced_m(0.0, -0.1), Vec2::ZERO);
        assert_eq!(displaced_m(0.0, -0.3), Vec2::ZERO);
        assert!(displaced_m(0.0, 0.3).y == ASIDE_MAX_M && displaced_m(0.4, 0.0) == Vec2::ZERO);
    }

    #[test]
    fn a_gap_as_in_the_pose_is_enough() {
        let narrow = aside_m(0, [Vec3::new(0.0, 0.03, 0.1); 2], [Vec3::new(0.0, -0.03, 0.0); 2]);
        assert_eq!(narrow, Vec2::ZERO);
    }
}

//! How far the planned facing is ahead of the body's (our addition to `FbCrowd` §4.5).
//!
//! Synthesis turns a body to the planned facing within T_turn = 0.3 s. In a queue the preferred facing jumps whenever the
//! velocity does, by 60 to 120°, and bodies would turn as suddenly. People turn at rest by taking steps, which they do
//! not for a small angle, and faster the faster they walk. So the planned facing is ahead of the body's facing by
//!
//! ```text
//! min(β·min(1, s_0 + s_1·v), a_0 + a_1·v + a_2·t),   β = max(0, α − d_0·max(0, 1 − v/v_0))
//! ```
//!
//! where α is the angle to the preferred facing and v the body's speed. A body that cannot step aside goes only where it
//! faces; it turns for any angle, and sooner: d_0 = 0, and a greater s_1. An agent that turns before it walks turns
//! quickly; t, from 0 to 1, is how much it does ([`crate::planning::mcn::turn_first`]). World axes, m/s, radians.

use glam::Vec2;

/// s_0: share of the angle by which a standing body's plan is ahead (docs/tuning.md).
const SHARE_AT_REST: f32 = 0.3;
/// s_1: how much that share grows with the speed, 1/(m/s).
const SHARE_PER_MPS: f32 = 0.25;
/// s_1 of a body that cannot step aside, 1/(m/s): with less it circles about its goal.
const SHARE_PER_MPS_AHEAD: f32 = 0.5;
/// a_0: greatest angle by which a standing body's plan is ahead, rad: 20°, 70 °/s within T_turn.
const AHEAD_AT_REST_RAD: f32 = 0.35;
/// a_1: how much that angle grows with the speed, rad/(m/s).
const AHEAD_RAD_PER_MPS: f32 = 0.15;
/// a_2: how much that angle grows for an agent that turns before it walks, rad; with a_0 a body turns at 130 °/s.
const AHEAD_TURNING_RAD: f32 = 0.35;
/// d_0: angle to the preferred facing for which a standing body does not turn, rad: 17°.
const TOLERANCE_AT_REST_RAD: f32 = 0.3;
/// v_0: speed from which on a body turns for any angle, m/s.
const TURNS_AT_MPS: f32 = 0.6;

/// What the turn of a body depends on.
#[derive(Clone, Copy, Debug)]
pub(crate) struct TurningBody {
    /// v: its speed, m/s.
    pub(crate) speed_mps: f32,
    /// Whether it can step aside.
    pub(crate) steps_aside: bool,
    /// t: how much it turns before it walks, 0 to 1.
    pub(crate) turns_first: f32,
}

impl TurningBody {
    /// A body that stands on its feet.
    pub(crate) const AT_REST: Self = Self { speed_mps: 0.0, steps_aside: true, turns_first: 0.0 };

    /// The facing to plan for this body, which faces `forward`: between both, towards `facing`. Unit vectors.
    pub(crate) fn gradual_facing(&self, forward: Vec2, facing: Vec2) -> Vec2 {
        let angle_rad = libm::atan2f(forward.perp_dot(facing), forward.dot(facing));
        let tolerance_rad = if self.steps_aside { TOLERANCE_AT_REST_RAD } else { 0.0 };
        let tolerance_rad = tolerance_rad * (1.0 - self.speed_mps / TURNS_AT_MPS).max(0.0);
        let angle_rad = (angle_rad.abs() - tolerance_rad).max(0.0).copysign(angle_rad);
        let share_per_mps = if self.steps_aside { SHARE_PER_MPS } else { SHARE_PER_MPS_AHEAD };
        let share = (SHARE_AT_REST + share_per_mps * self.speed_mps).min(1.0);
        let ahead_max_rad =
            AHEAD_AT_REST_RAD + AHEAD_RAD_PER_MPS * self.speed_mps + AHEAD_TURNING_RAD * self.turns_first;
        let ahead_rad = (share * angle_rad).clamp(-ahead_max_rad, ahead_max_rad);
        let (sin, cos) = libm::sincosf(ahead_rad);
        Vec2::new(cos, sin).rotate(forward)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The angle ahead of a body that faces +x, rad.
    fn ahead_rad(facing_rad: f32, speed_mps: f32) -> f32 {
        let (sin, cos) = libm::sincosf(facing_rad);
        TurningBody { speed_mps, ..TurningBody::AT_REST }.gradual_facing(Vec2::X, Vec2::new(cos, sin)).to_angle()
    }

    #[test]
    fn plan_of_a_small_turn_is_ahead_by_the_share_of_the_speed() {
        for (speed_mps, share) in [(0.6, 0.45), (1.4, 0.65), (3.0, 1.0)] {
            for facing_rad in [-0.5, -0.1, 0.0, 0.1, 0.5] {
                let error_rad = ahead_rad(facing_rad, speed_mps) - share * facing_rad;
                assert!(error_rad.abs() < 1e-5, "{facing_rad} rad at {speed_mps} m/s");
            }
        }
    }

    #[test]
    fn plan_is_ahead_by_at_most_the_angle_of_its_speed() {
        for (speed_mps, expected_rad) in [(0.0, 0.35), (1.0, 0.5), (2.0, 0.65)] {
            for facing_rad in [1.5f32, 3.0] {
                assert!((ahead_rad(facing_rad, speed_mps) - expected_rad).abs() < 1e-5);
                assert!((ahead_rad(-facing_rad, speed_mps) + expected_rad).abs() < 1e-5);
            }
        }
    }

    #[test]
    fn standing_body_does_not_turn_for_a_small_angle() {
        assert_eq!(ahead_rad(0.25, 0.0), 0.0);
        assert!(ahead_rad(0.25, 0.4) > 0.03 && ahead_rad(-0.25, 0.4) < -0.03);
        let ahead_only = TurningBody { steps_aside: false, ..TurningBody::AT_REST };
        assert!(ahead_only.gradual_facing(Vec2::X, Vec2::from_angle(0.25)).y > 0.05);
    }

    #[test]
    fn body_that_cannot_step_aside_turns_sooner() {
        let ahead_rad = |steps_aside| {
            let body = TurningBody { speed_mps: 1.0, steps_aside, turns_first: 0.0 };
            body.gradual_facing(Vec2::X, Vec2::from_angle(0.4)).to_angle()
        };
        assert!((ahead_rad(true) - 0.22).abs() < 1e-5 && (ahead_rad(false) - 0.32).abs() < 1e-5);
    }

    #[test]
    fn standing_body_turns_less_than_a_walking_one() {
        assert!(ahead_rad(0.5, 0.0) < 0.2 && ahead_rad(0.5, 1.4) > 0.3);
    }
}

//! Excess lean: what a body leans beyond the clips that it plays.
//!
//! A body leans as [`crate::synthesis::pose::lean::balance`] describes. With the velocity v and the turn rate ω_t of the
//! drawn motion, which have no stride ripple,
//!
//! ```text
//! whole body  → atan(ω_t × v / g) − lean of the played motion,
//! trunk       → .45·(atan((dv/dt + ω_t × v) / g) − lean of the played motion).
//! ```
//!
//! The played motion leans by itself: each example by its own v and ω_t. So nothing is added to an example at its own
//! parameters, and a body that walks straight on by a mix of circles is upright.
//!
//! In curves the whole body tilts over its feet, the trunk by less. The pelvis stays over the root, and the feet land
//! outward. Where the velocity changes the trunk tilts alone: people who start tilt it forward, by 0.5 to 1.7° for each
//! m/s² of the start (`docs/tuning.md`), and they tilt it backward to brake. The head keeps its orientation.
//!
//! Filters of the third order follow both, so that neither rate nor acceleration of a tilt jumps.
//!
//! Root frame (x forward, y left, z up); m/s, m/s², radians.

use glam::Vec2;
use motiondb::body::Skeleton;
use motiondb::motion::Parameters;

use crate::maths::angle::unit_vector;
use crate::synthesis::TimeStep;
use crate::synthesis::pose::lean::balance::{balanced_lean_rad, lean_in_curve_rad};
use crate::synthesis::pose::lean::incline::{TRUNK_SHARE, is_upright, tilt_trunk};
use crate::synthesis::pose::leg::FootPose;
use crate::synthesis::pose::posture::Posture;

/// Greatest excess, rad: that of an emergency stop, 3 m/s².
const LEAN_MAX_RAD: f32 = 0.297;
/// Speed below which a body has no direction of travel, m/s.
const RESTING_MPS: f32 = 0.2;

/// The excess lean of a body. Tilts are forward and to the left, rad, with their rates of change, rad/s, and their
/// accelerations, rad/s².
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(crate) struct ExcessLean {
    /// Parameters of the drawn motion after the last step.
    pub(super) drawn: Parameters,
    /// Tilt of the whole body over its feet.
    pub(super) body_rad: [Vec2; 3],
    /// Tilt of the trunk, in all.
    pub(super) trunk_rad: [Vec2; 3],
}

impl ExcessLean {
    /// Follows the drawn motion over one step. The played motion leans by itself: the whole body, and the trunk as a share
    /// of the second lean.
    pub(crate) fn follow(&mut self, drawn: Parameters, [body_rad, trunk_rad]: [Vec2; 2], step: &TimeStep) {
        let excess_rad = |lean_rad: Vec2, played_rad: Vec2| (lean_rad - played_rad).clamp_length_max(LEAN_MAX_RAD);
        let velocity_mps = drawn.velocity_mps();
        let acceleration_mps2 =
            (velocity_mps - self.drawn.velocity_mps()) / step.dt_s + drawn.turn_rate_rad_s * velocity_mps.perp();
        self.drawn = drawn;
        let body_rad = excess_rad(lean_in_curve_rad(&drawn), body_rad);
        if body_rad != Vec2::ZERO || self.body_rad != [Vec2::ZERO; 3] {
            step.body_lean.approach(&mut self.body_rad, body_rad);
        }
        step.lean
            .approach(&mut self.trunk_rad, TRUNK_SHARE * excess_rad(balanced_lean_rad(acceleration_mps2), trunk_rad));
    }

    /// Leans a posture. Its pelvis keeps its height above the straighter leg, as in a deformed walk.
    pub(crate) fn lean(&self, posture: &mut Posture, skeleton: &Skeleton) {
        let (body_rad, trunk_rad) = (self.body_rad[0], self.trunk_rad[0]);
        if is_upright(body_rad) {
            tilt_trunk(&mut posture.pose, trunk_rad);
            return;
        }
        let outward_m = posture.incline(body_rad, trunk_rad);
        let (turn_rate_rad_s, velocity_mps) = (self.drawn.turn_rate_rad_s, self.drawn.velocity_mps());
        let square_m2ps2 = velocity_mps.length_squared() + RESTING_MPS * RESTING_MPS;
        let feet = posture.feet.map(|foot| {
            // The root comes to the foot after a time, and has turned by then: feet on a wider arc hold, too.
            let ahead_s = velocity_mps.dot(foot.ankle_m.truncate()) / square_m2ps2;
            let moved_m = unit_vector(turn_rate_rad_s * ahead_s).rotate(outward_m);
            FootPose { ankle_m: foot.ankle_m + moved_m.extend(0.0), ..foot }
        });
        posture.move_feet(feet, skeleton);
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn walking(speed_mps: f32, turn_rate_rad_s: f32) -> Parameters {
        Parameters { speed_mps, turn_rate_rad_s, strafe_mps: 0.0 }
    }

    /// Tilts of body and trunk after each step of a motion by time, degrees; the played motion does not lean.
    fn tilts_deg(seconds: f32, dt_s: f32, motion: impl Fn(f32) -> Parameters) -> Vec<[Vec2; 2]> {
        let (mut lean, step) = (ExcessLean::default(), TimeStep::new(dt_s));
        let mut tilt_deg = |index: usize| {
            lean.follow(motion(index as f32 * dt_s), [Vec2::ZERO; 2], &step);
            [lean.body_rad[0], lean.trunk_rad[0]].map(|tilt_rad| tilt_rad * 1_f32.to_degrees())
        };
        (1..=(seconds / dt_s).round() as usize).map(&mut tilt_deg).collect()
    }

    #[test]
    fn bodies_lean_into_starts_stops_and_curves() {
        for dt_s in [1.0 / 120.0, 1.0 / 30.0, 0.1] {
            let speeds = |time_s: f32| walking(1.6 * time_s.min(0.8) - 1.6 * (time_s - 3.0).clamp(0.0, 0.8), 0.0);
            let tilts_deg = tilts_deg(5.0, dt_s, speeds);
            let at_deg = |time_s: f32| tilts_deg[(time_s / dt_s).round() as usize - 1][1].x;
            assert!(tilts_deg.iter().all(|tilts_deg| tilts_deg[0] == Vec2::ZERO));
            assert!((1.5..5.0).contains(&at_deg(0.7)) && (-5.0..-1.5).contains(&at_deg(3.7)), "dt {dt_s}");
            assert!(at_deg(2.9).abs() < 0.05 && at_deg(5.0).abs() < 0.15, "dt {dt_s}");
        }
        let left_deg = tilts_deg(3.0, 1.0 / 60.0, |_| walking(1.2, 0.8));
        let [body_deg, trunk_deg] = left_deg[179];
        assert!(body_deg.distance(Vec2::new(0.0, 5.6)) < 0.1 && trunk_deg.distance(0.45 * body_deg) < 0.1);
    }

    #[test]
    fn starts_do_not_jerk_the_trunk() {
        let dt_s = 1.0 / 120.0;
        let tilts_deg = tilts_deg(3.0, dt_s, |time_s| walking((3.0 * (time_s - 1.0)).clamp(0.0, 1.4), 0.0));
        let bends =
            tilts_deg.windows(3).map(|three| (three[0][1] - 2.0 * three[1][1] + three[2][1]).x.abs() / (dt_s * dt_s));
        let greatest_rad_s2 = bends.fold(0.0, f32::max).to_radians();
        assert!(greatest_rad_s2 < 35.0, "{greatest_rad_s2} rad/s²"); // a tilt that jumps: 2,000
    }
}

//! Excess lean: what a body leans beyond the clips that it plays.
//!
//! A body leans as [`crate::synthesis::pose::lean::balance`] describes, by its present acceleration
//!
//! ```text
//! a = dv/dt + ω_t × v,   lean → atan(a/g) − lean of the played motion,
//! ```
//!
//! where v and ω_t are those of the drawn motion, which have no stride ripple. The played motion leans by itself: each
//! example by its own v and ω_t. So nothing is added to an example at its own parameters, and a body that walks straight
//! on by a mix of circles is upright.
//!
//! The part of the lean *across* the travel, in curves, tilts the whole body over its feet. The pelvis stays over the
//! root, and the feet land outward. The trunk tilts by about half of the lean in any direction: less than the legs in
//! curves, and alone *along* the travel: people who start tilt it forward, by 0.5 to 1.7° for each m/s² of the start
//! (`docs/tuning.md`), and they tilt it backward to brake. The head keeps its orientation.
//!
//! A filter of the third order follows the lean, so that neither rate nor acceleration of the body jumps.
//!
//! Root frame (x forward, y left, z up); m/s, m/s², radians.

use glam::Vec2;
use motiondb::motion::Parameters;

use crate::maths::angle::unit_vector;
use crate::synthesis::TimeStep;
use crate::synthesis::pose::lean::balance::balanced_lean_rad;
use crate::synthesis::pose::lean::incline::{TRUNK_SHARE, is_upright};
use crate::synthesis::pose::posture::Posture;

/// Greatest excess, rad: that of an emergency stop, 3 m/s².
const LEAN_MAX_RAD: f32 = 0.297;
/// Speed below which a body has no direction of travel, m/s.
const RESTING_MPS: f32 = 0.2;

/// The excess lean of a body.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(crate) struct ExcessLean {
    /// Parameters of the drawn motion after the last step.
    pub(super) drawn: Parameters,
    /// Lean forward and to the left, rad, its rate of change, rad/s, and its acceleration, rad/s².
    pub(super) lean_rad: [Vec2; 3],
}

impl ExcessLean {
    /// Follows the drawn motion over one step. The played motion leans by `played_rad`.
    pub(crate) fn follow(&mut self, drawn: Parameters, played_rad: Vec2, step: &TimeStep) {
        let velocity_mps = drawn.velocity_mps();
        let turning_mps2 = drawn.turn_rate_rad_s * velocity_mps.perp();
        let acceleration_mps2 = (velocity_mps - self.drawn.velocity_mps()) / step.dt_s + turning_mps2;
        self.drawn = drawn;
        let excess_rad = balanced_lean_rad(acceleration_mps2) - played_rad;
        step.lean.approach(&mut self.lean_rad, excess_rad.clamp_length_max(LEAN_MAX_RAD));
    }

    /// Leans a posture.
    pub(crate) fn lean(&self, posture: &mut Posture) {
        let lean_rad = self.lean_rad[0];
        if is_upright(lean_rad) {
            return;
        }
        let Parameters { turn_rate_rad_s, .. } = self.drawn;
        let velocity_mps = self.drawn.velocity_mps();
        let square_m2ps2 = velocity_mps.length_squared() + RESTING_MPS * RESTING_MPS;
        let aside_mps = velocity_mps.perp();
        let across_rad = aside_mps.dot(lean_rad) / square_m2ps2 * aside_mps;
        let outward_m = posture.incline(across_rad, TRUNK_SHARE * lean_rad);
        for foot in &mut posture.feet {
            // The root comes to the foot after a time, and has turned by then: feet on a wider arc hold, too.
            let ahead_s = velocity_mps.dot(foot.ankle_m.truncate()) / square_m2ps2;
            foot.ankle_m += unit_vector(turn_rate_rad_s * ahead_s).rotate(outward_m).extend(0.0);
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::synthesis::pose::lean::incline::TRUNK_SHARE;

    fn walking(speed_mps: f32, turn_rate_rad_s: f32) -> Parameters {
        Parameters { speed_mps, turn_rate_rad_s, strafe_mps: 0.0 }
    }

    /// Leans forward and to the left after each step of a motion by time, degrees; the played motion does not lean.
    fn leans_deg(seconds: f32, dt_s: f32, motion: impl Fn(f32) -> Parameters) -> Vec<Vec2> {
        let (mut lean, step) = (ExcessLean::default(), TimeStep::new(dt_s));
        let mut lean_deg = |index: usize| {
            lean.follow(motion(index as f32 * dt_s), Vec2::ZERO, &step);
            lean.lean_rad[0] * 1_f32.to_degrees()
        };
        (1..=(seconds / dt_s).round() as usize).map(&mut lean_deg).collect()
    }

    #[test]
    fn bodies_lean_into_starts_stops_and_curves() {
        for dt_s in [1.0 / 120.0, 1.0 / 30.0, 0.1] {
            let speeds = |time_s: f32| walking(1.6 * time_s.min(0.8) - 1.6 * (time_s - 3.0).clamp(0.0, 0.8), 0.0);
            let leans_deg = leans_deg(5.0, dt_s, speeds);
            let at_deg = |time_s: f32| leans_deg[(time_s / dt_s).round() as usize - 1].x;
            assert!((3.5..11.0).contains(&at_deg(0.7)) && (-11.0..-3.5).contains(&at_deg(3.7)), "dt {dt_s}");
            assert!(at_deg(2.9).abs() < 0.1 && at_deg(5.0).abs() < 0.3, "dt {dt_s}");
        }
        let left_deg = leans_deg(3.0, 1.0 / 60.0, |_| walking(1.2, 0.8));
        assert!(left_deg[179].distance(Vec2::new(0.0, 5.6)) < 0.1, "{}", left_deg[179]);
    }

    #[test]
    fn starts_do_not_jerk_the_trunk() {
        let dt_s = 1.0 / 120.0;
        let leans_deg = leans_deg(3.0, dt_s, |time_s| walking((3.0 * (time_s - 1.0)).clamp(0.0, 1.4), 0.0));
        let bends = leans_deg.windows(3).map(|three| (three[0] - 2.0 * three[1] + three[2]).x.abs() / (dt_s * dt_s));
        let greatest_rad_s2 = bends.fold(0.0, f32::max).to_radians();
        assert!(TRUNK_SHARE * greatest_rad_s2 < 35.0, "{greatest_rad_s2} rad/s²"); // a tilt that jumps: 2,000
    }
}

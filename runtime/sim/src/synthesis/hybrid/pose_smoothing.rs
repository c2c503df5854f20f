//! Pose smoothing: the drawn motion follows the active motion with a short lag.
//!
//! Weights and parameters change at limited rates that begin and end at once; joints that followed at once would jerk.
//! So the pose is that of a mix, and of an m_sp, that lag a little; planted feet are locked meanwhile. The root does
//! not depend on it, so tracking is as accurate as without.
//!
//! A body that reverses would step with the wrong foot: a foot that has just landed behind a backward walk would be
//! about to leave the ground in a forward one. Gait in the other direction is nearly gait in reversed time (Winter,
//! Pluck, Yang 1989), and phases 0 and ½ are mid-stances. So on reversal the gait phase φ becomes 1 − φ, at which the
//! feet keep their positions.
//!
//! Body frame (x forward, y left); m/s, rad/s, seconds.

use glam::Vec2;
use motiondb::motion::{MotionDb, Parameters};

use crate::synthesis::blending::ExampleMix;
use crate::synthesis::semi_procedural::deformation::travel_direction;
use crate::synthesis::{Mode, TimeStep};

/// The motion that is drawn.
#[derive(Clone, Copy, Debug)]
pub struct SmoothedMotion {
    /// Examples that are drawn while the body blends.
    pub mix: ExampleMix,
    /// Parameters of m_sp that are drawn in semi-procedural locomotion.
    pub(crate) parameters: Parameters,
    /// Direction of travel to which m_sp is deformed; it lags when the body turns about.
    pub(crate) travel: Vec2,
    /// Rate of change of `travel`, 1/s.
    travel_rate_hz: Vec2,
}

impl SmoothedMotion {
    /// The drawn motion of a body that stands.
    pub(crate) fn standing(mix: ExampleMix) -> Self {
        Self { mix, parameters: Parameters::default(), travel: Vec2::X, travel_rate_hz: Vec2::ZERO }
    }

    /// Follows the active motion over one step, in the active mode. Returns whether the body reverses: its travel
    /// points against the drawn one.
    pub(crate) fn follow(
        &mut self,
        mode: Mode,
        mix: &ExampleMix,
        parameters: Parameters,
        db: &MotionDb,
        step: &TimeStep,
    ) -> bool {
        let fraction = 1.0 - step.smoothing_left;
        let drawn = match mode {
            Mode::Blending | Mode::Transition => {
                self.mix.approach_mix(mix, fraction);
                self.mix.parameters(db)
            }
            Mode::SemiProcedural => {
                self.parameters = interpolated(self.parameters, parameters, fraction);
                self.parameters
            }
        };
        // A body at rest keeps its direction.
        let travel = travel_direction(drawn, self.travel);
        let (off, rate_hz) = step.travel.decayed(self.travel - travel, self.travel_rate_hz);
        (self.travel, self.travel_rate_hz) = (travel + off, rate_hz);
        self.travel.dot(travel) < 0.0
    }

    /// Reverses the travel.
    pub(crate) fn reverse(&mut self) {
        (self.travel, self.travel_rate_hz) = (-self.travel, -self.travel_rate_hz);
    }

    /// The drawn motion shortly ([`TimeStep::look_back_s`]) before the end of the step that began at `before`.
    pub(crate) fn earlier(&self, before: &Self, step: &TimeStep) -> Self {
        let fraction = step.look_back_s / step.dt_s;
        let mut earlier = *self;
        earlier.mix.approach_mix(&before.mix, fraction);
        earlier.parameters = interpolated(self.parameters, before.parameters, fraction);
        earlier.travel -= step.look_back_s * self.travel_rate_hz;
        earlier
    }
}

fn interpolated(from: Parameters, to: Parameters, fraction: f32) -> Parameters {
    Parameters::from_vec3(from.to_vec3() + fraction * (to.to_vec3() - from.to_vec3()))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::test_db::test_db;

    /// Number of reversals of a body whose velocity (forward, left) changes evenly, m/s.
    fn reversals(from_mps: Vec2, to_mps: Vec2) -> usize {
        let (db, step, mix) = (test_db(), TimeStep::new(1.0 / 60.0), ExampleMix::new(&Default::default()));
        let mut smoothed = SmoothedMotion::standing(mix);
        let mut reverses = |share: f32| {
            let Vec2 { x: speed_mps, y: strafe_mps } = from_mps.lerp(to_mps, share.clamp(0.0, 1.0));
            let parameters = Parameters { speed_mps, strafe_mps, ..Parameters::default() };
            let reverses = smoothed.follow(Mode::SemiProcedural, &mix, parameters, &db, &step);
            if reverses {
                smoothed.reverse();
            }
            reverses
        };
        (-60..120).filter(|&index| reverses(index as f32 / 40.0)).count()
    }

    #[test]
    fn the_gait_reverses_once_with_the_body() {
        let (forward_mps, left_mps) = (Vec2::new(1.0, 0.0), Vec2::new(0.0, 0.5));
        assert_eq!(reversals(forward_mps, -0.5 * forward_mps), 1);
        assert_eq!(reversals(left_mps, -left_mps), 1);
        assert_eq!([left_mps, Vec2::ZERO, 0.5 * forward_mps].map(|to_mps| reversals(forward_mps, to_mps)), [0; 3]);
    }
}

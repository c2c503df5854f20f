//! Accumulates planned displacement that is too slow to walk; the body takes one step when it reaches 0.2 m.
//!
//! In a jam the planner creeps past neighbours at a few cm/s. A body that stands
//! ([`crate::synthesis::command::step_state`]) would never follow, and two bodies that wait for each other would stand
//! forever. A body that waits in a queue makes no such step, and forgets what has accumulated.
//!
//! World frame; metres, seconds.

use glam::Vec2;

use crate::planning::plan::Plan;
use crate::synthesis::TimeStep;

/// Planned speed below which displacement accumulates, and speed of the step, m/s: about that of the least steps.
const STEP_SPEED_MPS: f32 = 0.35;
/// Accumulated displacement that starts a step, m: a small step.
const STEP_M: f32 = 0.2;
/// Greatest accumulated displacement, m: a body that was held up for long makes up for no more than one step.
const DISPLACEMENT_MAX_M: f32 = 0.25;

/// Planned displacement that the root has not made yet.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(crate) struct DisplacementAccumulator {
    /// Accumulated displacement, m.
    displacement_m: Vec2,
    /// Whether the body takes its step.
    steps: bool,
}

impl DisplacementAccumulator {
    /// The plan with the velocity that the body is to have: that of the step, while there is one; none while it waits.
    /// `actual_mps` is the velocity of the root in the last step.
    pub(crate) fn follow(&mut self, plan: &Plan, actual_mps: Vec2, step: &TimeStep) -> Plan {
        if plan.waits {
            *self = Self::default();
            return Plan { velocity_mps: Vec2::ZERO, ..*plan };
        }
        let creeps = plan.velocity_mps.length() < STEP_SPEED_MPS;
        if !creeps {
            *self = Self::default();
            return *plan;
        }
        let displacement_m =
            step.displacement_left * self.displacement_m + step.dt_s * (plan.velocity_mps - actual_mps);
        self.displacement_m = displacement_m.clamp_length_max(DISPLACEMENT_MAX_M);
        let still_planned = self.displacement_m.dot(plan.velocity_mps) > 0.0;
        self.steps = still_planned && (self.steps || self.displacement_m.length() > STEP_M);
        if !self.steps {
            return *plan;
        }
        Plan { velocity_mps: STEP_SPEED_MPS * self.displacement_m.normalize_or_zero(), ..*plan }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Forward speeds after accumulation, for planned ones and a root at rest, m/s.
    fn followed_mps(planned_mps: impl Iterator<Item = f32>) -> Vec<f32> {
        let mut accumulator = DisplacementAccumulator::default();
        let plan = |speed_mps| Plan { velocity_mps: Vec2::new(speed_mps, 0.0), ..Plan::default() };
        planned_mps
            .map(|speed_mps| accumulator.follow(&plan(speed_mps), Vec2::ZERO, &TimeStep::new(0.1)).velocity_mps.x)
            .collect()
    }

    #[test]
    fn creeping_accumulates_to_a_step() {
        let speeds_mps = followed_mps(std::iter::repeat_n(0.1, 60));
        let first = speeds_mps.iter().position(|&speed_mps| speed_mps == STEP_SPEED_MPS);
        assert!((20..40).contains(&first.unwrap()), "{first:?}");
    }

    #[test]
    fn swaying_about_rest_makes_no_step() {
        let speeds_mps = followed_mps((0..200).map(|step| if step / 5 % 2 == 0 { 0.2 } else { -0.2 }));
        assert!(speeds_mps.iter().all(|speed_mps| speed_mps.abs() < STEP_SPEED_MPS));
    }

    #[test]
    fn a_body_does_not_move_while_it_waits() {
        let mut accumulator = DisplacementAccumulator::default();
        // Its plan leads back and ahead in turns.
        let mut follow = |step: usize| {
            let waits = step % 10 < 5;
            let plan = Plan { velocity_mps: Vec2::new(if waits { -0.3 } else { 0.3 }, 0.0), waits, ..Plan::default() };
            accumulator.follow(&plan, Vec2::ZERO, &TimeStep::new(0.1)).velocity_mps.x
        };
        let followed_mps: Vec<f32> = (0..60).map(&mut follow).collect();
        assert_eq!(followed_mps[..10], [0.0, 0.0, 0.0, 0.0, 0.0, 0.3, 0.3, 0.3, 0.3, 0.3]);
        assert!(followed_mps.iter().all(|speed_mps| *speed_mps < STEP_SPEED_MPS));
    }

    #[test]
    fn a_plan_to_walk_is_unchanged() {
        assert_eq!(followed_mps([1.3, 0.8, 1.0].into_iter()), [1.3, 0.8, 1.0]);
    }
}

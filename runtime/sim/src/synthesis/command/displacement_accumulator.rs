//! What a standing body owes the planner: a plan too slow for the least step is saved up, and paid with a step.
//!
//! In a jam the planner creeps past its neighbours at a few cm/s. A body that stands (see [`crate::synthesis::command::stand_or_step`]) would never
//! follow, and two who wait for each other's creeping would stand for ever. So the distance planned and not walked is
//! added up; once it makes a small step, the body takes that step where the planner wanted it. World, metres, seconds.

use glam::Vec2;

use crate::planning::plan::Plan;
use crate::synthesis::time_step::TimeStep;

/// What is planned slower than this is saved up, and paid at this speed, m/s: about that of the least steps.
const PAYING_SPEED_MPS: f32 = 0.35;
/// Owed as much, a small step, the body takes it, m.
const STEP_M: f32 = 0.2;
/// The most that is owed, m: who was held up for long makes up for no more than that step.
const OWED_MAX_M: f32 = 0.25;
/// What is owed is forgotten with this time constant, s: creeping slower than 5 cm/s never adds up to a step.
pub(crate) const FORGETTING_TIME_S: f32 = 4.0;

/// The distance owed.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Owed {
    distance_m: Vec2,
    paying: bool,
}

impl Owed {
    /// The plan as the body takes it, given the velocity that its last step really had.
    pub fn settle(&mut self, plan: &Plan, walked_mps: Vec2, step: &TimeStep) -> Plan {
        let creeps = plan.velocity_mps.length() < PAYING_SPEED_MPS;
        if !creeps {
            *self = Self::default();
            return *plan;
        }
        let owed_m = step.owed * self.distance_m + step.dt_s * (plan.velocity_mps - walked_mps);
        self.distance_m = owed_m.clamp_length_max(OWED_MAX_M);
        let wanted = self.distance_m.dot(plan.velocity_mps) > 0.0;
        self.paying = wanted && (self.paying || self.distance_m.length() > STEP_M);
        if !self.paying {
            return *plan;
        }
        Plan { velocity_mps: PAYING_SPEED_MPS * self.distance_m.normalize_or_zero(), ..*plan }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn settled(speeds_mps: impl Iterator<Item = f32>) -> Vec<f32> {
        let mut owed = Owed::default();
        let plan = |speed_mps| Plan { velocity_mps: Vec2::new(speed_mps, 0.0), ..Plan::default() };
        speeds_mps
            .map(|speed_mps| owed.settle(&plan(speed_mps), Vec2::ZERO, &TimeStep::new(0.1)).velocity_mps.x)
            .collect()
    }

    #[test]
    fn creeping_is_saved_up_until_it_makes_a_step() {
        let taken_mps = settled(std::iter::repeat_n(0.1, 60));
        let first = taken_mps.iter().position(|&speed_mps| speed_mps == PAYING_SPEED_MPS);
        assert!((20..40).contains(&first.unwrap()), "{first:?}");
    }

    #[test]
    fn swaying_about_rest_makes_none() {
        let taken_mps = settled((0..200).map(|step| if step / 5 % 2 == 0 { 0.2 } else { -0.2 }));
        assert!(taken_mps.iter().all(|speed_mps| speed_mps.abs() < PAYING_SPEED_MPS));
    }

    #[test]
    fn a_plan_to_walk_passes_unchanged() {
        assert_eq!(settled([1.3, 0.8, 1.0].into_iter()), [1.3, 0.8, 1.0]);
    }
}

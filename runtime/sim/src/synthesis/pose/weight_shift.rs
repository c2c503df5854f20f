//! Weight shift: before the first step a body moves its weight over the foot that stays. `FbCrowd` does not have it.
//!
//! People who begin to walk move their weight to the stance foot before the other one lifts (Brenière and Do 1986, *J.
//! Biomech.* 19, 1035–1040). Here the pelvis, and with it the trunk, moves sideways by a share of its distance from the
//! stance foot, from the start until the swinging foot lands; then the walk's own sway carries the weight. A filter of
//! the third order moves it, so that its acceleration does not jump. Feet and root do not depend on it.
//!
//! Root frame of the drawn body (y left), metres, seconds.

use motiondb::body::RootFrame;

use crate::synthesis::TimeStep;
use crate::synthesis::pose::FootLock;

/// Share of the distance from the pelvis to the stance foot by which the weight shifts.
const SHARE: f32 = 0.45;
/// Greatest shift, m.
const SHIFT_MAX_M: f32 = 0.06;

/// The weight shift of a body.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(crate) struct WeightShift {
    /// The foot that stays, until the first step has landed.
    stance: Option<usize>,
    /// Whether the other foot has left the ground.
    has_lifted: bool,
    /// Shift to the left, m, its rate of change, m/s, and its acceleration, m/s².
    shift_m: [f32; 3],
}

impl WeightShift {
    /// Begins a first step that leaves one foot on the ground.
    pub(crate) fn begin(&mut self, stance: usize) {
        (self.stance, self.has_lifted) = (Some(stance), false);
    }

    /// Moves the weight over one step; returns the shift to the left, m. The locks are those of the last step,
    /// `pelvis_m` is where the pose has its pelvis, to the left.
    pub(crate) fn follow(&mut self, locks: &[FootLock; 2], pelvis_m: f32, frame: &RootFrame, step: &TimeStep) -> f32 {
        let target_m = self.stance.map_or(0.0, |stance| {
            let stance_m = frame.to_local(locks[stance].ball_m()).y - pelvis_m;
            (SHARE * stance_m).clamp(-SHIFT_MAX_M, SHIFT_MAX_M)
        });
        if let Some(stance) = self.stance {
            let swings = !locks[1 - stance].planted();
            self.stance = Some(stance).filter(|_| locks[stance].planted() && (swings || !self.has_lifted));
            self.has_lifted |= swings;
        }
        step.weight_shift.approach(&mut self.shift_m, target_m);
        self.shift_m[0]
    }
}

#[cfg(test)]
mod tests {
    use std::sync::Arc;

    use glam::{Vec2, Vec3};
    use motiondb::body::Root;

    use crate::planning::plan::Plan;
    use crate::synthesis::{HmsParams, SynthesisContext};
    use crate::test_db::test_db;

    const DT_S: f32 = 1.0 / 60.0;

    /// Pelvis in the root frame and balls of the feet in the world, m, and planted feet of a body that starts after
    /// 1 s, after each step.
    fn start(velocity_mps: Vec2) -> Vec<(Vec3, [Vec3; 2], [bool; 2])> {
        let context = SynthesisContext::new(Arc::new(test_db()), HmsParams::default());
        let plan = |time_s: f32, _: &Root| Plan {
            velocity_mps: if time_s < 1.0 { Vec2::ZERO } else { velocity_mps },
            time_to_collision_s: f32::INFINITY,
            ..Plan::default()
        };
        context.walk_alone(0.3, 6.0, DT_S, plan, |body, output| {
            let joints = output.pose.forward_kinematics(&context.db.skeleton);
            let ball_m = |side: usize| body.root.to_world(joints.sole_points_m(&context.db.skeleton, side)[1]);
            let planted = [0, 1].map(|side| body.contact.locks[side].planted());
            (output.pose.pelvis_m, [0, 1].map(ball_m), planted)
        })
    }

    #[test]
    fn the_weight_is_over_the_stance_foot_when_the_other_lifts() {
        for velocity_mps in [Vec2::new(1.3, 0.0), Vec2::new(1.2, 0.5), Vec2::new(1.2, -0.5)] {
            let steps = start(velocity_mps);
            let lift = steps.iter().position(|step| step.2 != [true; 2]).unwrap();
            let stance = usize::from(!steps[lift].2[0]);
            let towards_m = |step: usize| {
                let to_stance = (steps[lift].1[stance] - steps[lift].1[1 - stance]).y.signum();
                to_stance * (steps[step].0.y - steps[50].0.y)
            };
            assert!((0.015..0.07).contains(&towards_m(lift)), "{velocity_mps}: {} m", towards_m(lift));
            let stance_m = |step: usize| steps[step].1[stance];
            assert!((60..lift).all(|step| stance_m(step).distance(stance_m(60)) < 1e-3), "{velocity_mps}: it slides");
        }
    }

    #[test]
    fn the_shift_ends_with_the_first_step_and_does_not_jerk() {
        let steps = start(Vec2::new(1.3, 0.0));
        let aside_m = |step: usize| steps[step].0.y;
        let walking_m = (240..360).map(aside_m).sum::<f32>() / 120.0;
        assert!(walking_m.abs() < 0.01, "{walking_m} m");
        let bend_mps2 =
            |step: usize| (aside_m(step - 1) - 2.0 * aside_m(step) + aside_m(step + 1)).abs() / (DT_S * DT_S);
        let greatest_mps2 = (55..120).map(bend_mps2).fold(0.0, f32::max);
        assert!(greatest_mps2 < 4.0, "{greatest_mps2} m/s²");
    }
}

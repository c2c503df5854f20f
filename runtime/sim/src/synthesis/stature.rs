//! Stature: bodies larger or smaller than the database's skeleton, by dynamic similarity. `FbCrowd` does not have it.
//!
//! A body of another size walks alike at an equal Froude number v²/(g·leg) (Alexander and Jayes 1983): with the size s,
//! lengths grow with s, times and velocities with √s, accelerations and angles not at all. So a body lives in a world
//! of its own size, in which it is as large as the skeleton: its plan, its root and its time step are taken into that
//! world, and what the crowd reads of it is taken back. Poses stay in it; the crowd's world shows them s times as
//! large, about the root.
//!
//! Metres, seconds, radians.

use motiondb::body::Root;

use crate::planning::plan::{Plan, Stance, StanceFoot};
use crate::synthesis::{BodyOutput, TimeStep};

/// The size of a body, relative to the skeleton.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Stature {
    /// s.
    size: f32,
    /// √s.
    sqrt_size: f32,
}

impl Stature {
    /// The stature of a body that is `size` times as large as the skeleton.
    pub fn new(size: f32) -> Self {
        Self { size, sqrt_size: libm::sqrtf(size) }
    }

    /// Velocities of the body, divided by those of a body of the skeleton's size.
    pub fn speed_factor(self) -> f32 {
        self.sqrt_size
    }

    /// A root of the body's world in the crowd's.
    pub fn root_of_crowd(self, root: Root) -> Root {
        Root { position_m: self.size * root.position_m, ..root }
    }

    /// A root of the crowd's world in the body's.
    pub fn root_of_body(self, root: Root) -> Root {
        Root { position_m: root.position_m / self.size, ..root }
    }

    /// A plan of the crowd's world in the body's.
    pub fn plan_of_body(self, plan: &Plan) -> Plan {
        let Plan { velocity_mps, time_to_collision_s, strafing_s, stepping_back_s, gap_m, room, .. } = *plan;
        Plan {
            velocity_mps: velocity_mps / self.sqrt_size,
            time_to_collision_s: time_to_collision_s / self.sqrt_size,
            strafing_s: strafing_s / self.sqrt_size,
            stepping_back_s: stepping_back_s / self.sqrt_size,
            gap_m: gap_m.map(|sides_m| sides_m.map(|side_m| side_m / self.size)),
            room: room.scaled(1.0 / self.size),
            ..*plan
        }
    }

    /// A time step of the crowd in the body's world.
    pub fn step_of_body(self, step: &TimeStep) -> TimeStep {
        if self.sqrt_size == 1.0 { *step } else { TimeStep::new(step.dt_s / self.sqrt_size) }
    }

    /// The output of a body in the crowd's world; its pose stays.
    pub fn output_of_crowd(self, output: &BodyOutput) -> BodyOutput {
        let foot = output.stance.foot.map(|foot| StanceFoot {
            side: foot.side,
            heel_m: self.size * foot.heel_m,
            ball_m: self.size * foot.ball_m,
            toe_m: self.size * foot.toe_m,
            swing_m: self.size * foot.swing_m,
            time_to_landing_s: self.sqrt_size * foot.time_to_landing_s,
        });
        BodyOutput {
            stance: Stance { foot },
            examples_slide_cm_s: self.sqrt_size * output.examples_slide_cm_s,
            ..*output
        }
    }
}

#[cfg(test)]
mod tests {
    use std::sync::Arc;

    use glam::Vec2;

    use super::*;
    use crate::synthesis::{Body, HmsParams, SynthesisContext};
    use crate::test_db::test_db;

    /// Displacement of a body that is to walk at a speed, m, and its strides, in 4 s after 2 s.
    fn walk(size: f32, speed_mps: f32) -> (f32, f32) {
        let (context, stature) = (SynthesisContext::new(Arc::new(test_db()), HmsParams::default()), Stature::new(size));
        let step = stature.step_of_body(&TimeStep::new(1.0 / 60.0));
        let plan = stature.plan_of_body(&Plan { velocity_mps: Vec2::new(speed_mps, 0.0), ..Plan::default() });
        let (mut body, _) = Body::standing(&context, Root::default(), 0.0);
        let (mut from_m, mut strides) = (0.0, 0.0);
        for index in 0..360 {
            let phase = body.motion.phase;
            body.advance(&context, &plan, &step);
            body.synthesize(&context, &step);
            if index == 120 {
                from_m = stature.root_of_crowd(body.root).position_m.x;
            } else if index > 120 {
                strides += (body.motion.phase - phase).rem_euclid(1.0);
            }
        }
        (stature.root_of_crowd(body.root).position_m.x - from_m, strides)
    }

    #[test]
    fn a_child_walks_as_fast_in_more_steps() {
        let (adult, child) = (walk(1.0, 0.9), walk(0.64, 0.9));
        assert!((adult.0 - child.0).abs() < 0.02 * adult.0, "{adult:?} {child:?}");
        assert!(child.1 > 1.2 * adult.1, "{adult:?} {child:?}");
    }

    #[test]
    fn at_an_equal_froude_number_strides_grow_with_the_size() {
        let (adult, child) = (walk(1.0, 1.1), walk(0.64, 1.1 * 0.8));
        assert!((child.1 / adult.1 * 0.8 - 1.0).abs() < 0.03, "{adult:?} {child:?}");
        assert!((child.0 / child.1 / (adult.0 / adult.1) / 0.64 - 1.0).abs() < 0.03, "{adult:?} {child:?}");
    }

    #[test]
    fn the_skeletons_own_size_changes_no_bit() {
        let (stature, step) = (Stature::new(1.0), TimeStep::new(0.1));
        let root = Root { position_m: Vec2::new(0.1, -7.3), facing_rad: 2.0 };
        let plan = Plan { velocity_mps: Vec2::new(1.1, 0.3), time_to_collision_s: f32::INFINITY, ..Plan::default() };
        assert_eq!(stature.root_of_body(stature.root_of_crowd(root)), root);
        assert_eq!(stature.plan_of_body(&plan), plan);
        assert_eq!(stature.step_of_body(&step).dt_s, step.dt_s);
    }
}

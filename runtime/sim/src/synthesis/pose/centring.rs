//! Centring: the pelvis of a standing body moves over its feet. `FbCrowd` does not have it.
//!
//! Feet that stand near enough to their places stay there ([`crate::synthesis::pose::settling_step`]), up to 7 cm off. A
//! pelvis that kept its own place would stand beside them, on bent knees. So it moves by the mean of what both feet are off,
//! slowly: a body that has just stopped does not creep. Root frame of the drawn body, metres.

use glam::Vec2;

use crate::synthesis::TimeStep;
use crate::synthesis::pose::FootLock;

/// The centring of a body.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(crate) struct Centring {
    /// Displacement of the pelvis, m, its rate of change, m/s, and its acceleration, m/s², forward and left.
    moved_m: [Vec2; 3],
}

impl Centring {
    /// Moves the pelvis over one step, given the locks after the last one and how far each foot is from its place, m;
    /// returns its displacement, m. A body that steps returns to its own place.
    pub(crate) fn follow(&mut self, stands: bool, locks: &[FootLock; 2], off_m: &[Vec2; 2], step: &TimeStep) -> Vec2 {
        let target_m = match stands {
            true if locks.iter().all(FootLock::planted) => 0.5 * (off_m[0] + off_m[1]),
            // The pelvis waits for a foot that settles.
            true => self.moved_m[0],
            false => Vec2::ZERO,
        };
        step.centring.approach(&mut self.moved_m, target_m);
        self.moved_m[0]
    }
}

#[cfg(test)]
mod tests {
    use std::sync::Arc;

    use glam::Vec2;
    use motiondb::body::{Joint, Root};

    use crate::planning::plan::Plan;
    use crate::synthesis::{HmsParams, Modes, SynthesisContext};
    use crate::test_db::test_db;

    #[test]
    fn the_pelvis_of_a_standing_body_comes_to_rest_over_its_feet() {
        let params = HmsParams { modes: Modes::Blending, ..HmsParams::default() };
        let context = SynthesisContext::new(Arc::new(test_db()), params);
        for stop_s in [2.0, 2.2, 2.4, 2.6, 2.8] {
            let plan = |time_s: f32, _: &Root| Plan {
                velocity_mps: if time_s < stop_s { Vec2::X } else { Vec2::ZERO },
                time_to_collision_s: f32::INFINITY,
                ..Plan::default()
            };
            let beside_m = context.walk_alone(0.3, 7.0, 1.0 / 60.0, plan, |_, output| {
                let joints = output.pose.forward_kinematics(&context.db.skeleton);
                let [left_m, right_m] = Joint::FEET.map(|foot| joints.positions_m[foot.index()]);
                (output.pose.pelvis_m - 0.5 * (left_m + right_m)).truncate()
            });
            let (at_first, at_last) = (beside_m[0], beside_m[beside_m.len() - 1]);
            assert!(at_last.distance(at_first) < 0.01, "stopped at {stop_s} s: {at_last}, {at_first} m");
        }
    }
}

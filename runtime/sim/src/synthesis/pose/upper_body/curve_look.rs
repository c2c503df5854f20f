//! Where the head of a clip looks because the clip goes round a curve: into it (Grasso et al. 1996, *NeuroReport* 7,
//! 1170–1174). That look belongs to the curve of the clip. A body that goes elsewhere looks along its own plan
//! ([`crate::synthesis::pose::upper_body::look_at`]), so the head of the clip is turned ahead first.
//!
//! Where a clip goes straight on, or its head looks out of the curve, the look is a habit and stays.
//!
//! Angles are relative to the root's facing, counter-clockwise from above, radians.

use glam::Vec3;
use motiondb::body::{Joint, Pose, Skeleton};

use crate::maths::angle::yaw;
use crate::synthesis::pose::upper_body::yaw_limit::within_limits_rad;

/// Greatest time by which a head looks ahead of its curve, s: captured circles show .2 to .45 s.
const AHEAD_MAX_S: f32 = 0.5;
/// Look below which the pose is left unchanged, rad.
const AHEAD_RAD: f32 = 1e-3;
/// Shares of the joints in the look.
const SHARES: [(Joint, f32); 2] = [(Joint::Neck, 0.5), (Joint::Head, 0.5)];

/// The look of the mean pose of a clip into its curve, rad.
pub(crate) fn curve_look_rad(mean: &Pose, turn_rate_rad_s: f32, skeleton: &Skeleton) -> f32 {
    let ahead = mean.forward_kinematics(skeleton).orientations[Joint::Head.index()] * Vec3::X;
    let greatest_rad = AHEAD_MAX_S * turn_rate_rad_s;
    libm::atan2f(ahead.y, ahead.x).clamp(greatest_rad.min(0.0), greatest_rad.max(0.0))
}

/// Turns the head of a pose back by a look, within the joint limits.
pub(crate) fn turn_ahead(pose: &mut Pose, look_rad: f32, skeleton: &Skeleton) {
    if look_rad.abs() < AHEAD_RAD {
        return;
    }
    for (joint, share) in SHARES {
        let rotation = &mut pose.rotations[joint.index()];
        let [least, greatest] = skeleton.limits_rad[joint.index()];
        let turn_rad = within_limits_rad(-share * look_rad, *rotation, [least.z, greatest.z]);
        *rotation = yaw(turn_rad) * *rotation;
    }
}

#[cfg(test)]
mod tests {
    use std::sync::Arc;

    use motiondb::body::Root;
    use motiondb::motion::{MotionDb, PHASE_COUNT, Parameters};

    use super::*;
    use crate::synthesis::command::plan_requesting;
    use crate::synthesis::{HmsParams, Modes, SynthesisContext};
    use crate::test_db::test_db;

    /// The test database, in which the head of one example turns by an angle.
    fn with_look(name: &str, look_rad: f32) -> MotionDb {
        let mut db = test_db();
        let example = db.examples.iter().position(|example| example.name == name).unwrap();
        let joints = db.rows.rotations.len() / (db.examples.len() * PHASE_COUNT);
        for row in example * PHASE_COUNT..(example + 1) * PHASE_COUNT {
            let head = &mut db.rows.rotations[row * joints + Joint::Head.index()];
            *head = yaw(look_rad) * *head;
        }
        db
    }

    /// Mean yaw of the head of a body that moves steadily, rad.
    fn head_yaw_rad(db: MotionDb, speed_mps: f32, turn_rate_rad_s: f32) -> f32 {
        let params = HmsParams { modes: Modes::Blending, ..HmsParams::default() };
        let context = SynthesisContext::new(Arc::new(db), params.clone());
        let requested = Parameters { speed_mps, turn_rate_rad_s, strafe_mps: 0.0 };
        let plan = |_: f32, root: &Root| plan_requesting(requested, root, &params);
        let ahead = context.walk_alone(0.3, 8.0, 1.0 / 30.0, plan, |_, output| {
            output.pose.forward_kinematics(&context.db.skeleton).orientations[Joint::Head.index()] * Vec3::X
        });
        let mean: Vec3 = ahead[120..].iter().sum();
        libm::atan2f(mean.y, mean.x)
    }

    #[test]
    fn the_look_into_a_curve_is_that_of_the_plan() {
        let [ahead_rad, into_rad] = [0.0, 0.4].map(|look_rad| head_yaw_rad(with_look("turn_left", look_rad), 0.7, 1.2));
        assert!(ahead_rad > 0.2 && (into_rad - ahead_rad).abs() < 0.02, "{ahead_rad} {into_rad}");
    }

    #[test]
    fn a_look_straight_on_or_out_of_the_curve_is_a_habit() {
        let look_rad = |turn_rate_rad_s: f32| {
            let db = with_look("walk", 0.3);
            curve_look_rad(&db.rows.mean_pose(2), turn_rate_rad_s, &db.skeleton)
        };
        assert_eq!([look_rad(0.0), look_rad(-1.0)], [0.0; 2]);
        assert!((look_rad(1.0) - 0.3).abs() < 0.01 && (look_rad(0.2) - 0.1).abs() < 1e-6);
    }
}

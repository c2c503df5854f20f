//! Look-at: head and chest turn before the body does. `FbCrowd` does not have it.
//!
//! People turn the head into a turn before the body: by some 200 ms on curved paths (Grasso et al. 1996, *NeuroReport*
//! 7, 1170–1174; Courtine and Schieppati 2003, *Eur. J. Neurosci.* 18, 177–190), and the more the sharper the turn
//! (Sreenivasa et al. 2008, *Exp. Brain Res.* 191, 313–320). The look-at angle, relative to the facing, follows the
//! planned facing and direction of travel like a critically damped spring. A body turns at the angle to its planned
//! facing divided by T_turn ([`crate::synthesis::command::blend_query`]), so on a circle the look-at leads it by
//! T_turn.
//!
//! Spine, neck and head share the angle, each within its joint limits. Root and legs do not depend on it.
//!
//! Angles are relative to the root's facing, counter-clockwise from above, radians; time in seconds.

use motiondb::body::{Joint, Pose, Skeleton};

use crate::maths::angle::{unit_vector, wrap_rad, yaw};
use crate::planning::plan::Plan;
use crate::synthesis::TimeStep;
use crate::synthesis::pose::upper_body::yaw_limit::within_limits_rad;

/// Greatest look-at angle, rad: in turns by 90° and more the head shows some 45° against the trunk, the eyes the rest.
const ANGLE_MAX_RAD: f32 = std::f32::consts::FRAC_PI_4;
/// Side speed at which a body looks half-way to its direction of travel, m/s: a walk's.
const LOOK_SPEED_MPS: f32 = 1.2;
/// Angle below which the pose is left unchanged, rad.
const AHEAD_RAD: f32 = 1e-3;
/// Shares of the joints in the angle, from the chest up.
const SHARES: [(Joint, f32); 4] =
    [(Joint::SpineMiddle, 0.1), (Joint::SpineUpper, 0.2), (Joint::Neck, 0.35), (Joint::Head, 0.35)];

/// The look-at angle of a body.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(crate) struct LookAt {
    /// Angle to the facing, rad.
    angle_rad: f32,
    /// Rate of change of the angle, rad/s.
    rate_rad_s: f32,
}

impl LookAt {
    /// Follows a plan over one step, exactly, for a body that faces `facing_rad` in the world.
    pub(crate) fn follow(&mut self, plan: &Plan, facing_rad: f32, step: &TimeStep) {
        let target_rad = target_rad(plan, facing_rad);
        let (off_rad, rate_rad_s) = step.look_at.decayed(self.angle_rad - target_rad, self.rate_rad_s);
        (self.angle_rad, self.rate_rad_s) = (target_rad + off_rad, rate_rad_s);
    }

    /// Turns chest and head of a pose, within the joint limits.
    pub(crate) fn turn(&self, pose: &mut Pose, skeleton: &Skeleton) {
        if self.angle_rad.abs() < AHEAD_RAD {
            return;
        }
        for (joint, share) in SHARES {
            let rotation = &mut pose.rotations[joint.index()];
            let [least, greatest] = skeleton.limits_rad[joint.index()];
            let turn_rad = within_limits_rad(share * self.angle_rad, *rotation, [least.z, greatest.z]);
            *rotation = yaw(turn_rad) * *rotation;
        }
    }
}

/// The angle to look at, rad: along the planned facing, and to the side the faster the body is to walk there. A body
/// that steps back looks along its facing.
fn target_rad(plan: &Plan, facing_rad: f32) -> f32 {
    let local_mps = unit_vector(-plan.facing_rad).rotate(plan.velocity_mps);
    let aside_rad = libm::atan2f(local_mps.y, local_mps.x.max(0.0) + LOOK_SPEED_MPS);
    let target_rad = wrap_rad(plan.facing_rad + aside_rad - facing_rad).clamp(-ANGLE_MAX_RAD, ANGLE_MAX_RAD);
    if target_rad.is_finite() { target_rad } else { 0.0 }
}

#[cfg(test)]
mod tests {
    use glam::{Quat, Vec2, Vec3};
    use motiondb::body::JOINT_COUNT;

    use super::*;
    use crate::synthesis::pose::upper_body::yaw_limit::yaw_rad;
    use crate::test_db::skeleton;

    const STANDING: Pose = Pose { pelvis_m: Vec3::new(0.0, 0.0, 0.92), rotations: [Quat::IDENTITY; JOINT_COUNT] };

    /// Look-at angles of a body that faces 0 throughout, after each step of a plan by time, rad.
    fn angles_rad(seconds: f32, dt_s: f32, plan: impl Fn(f32) -> Plan) -> Vec<f32> {
        let mut look_at = LookAt::default();
        (0..(seconds / dt_s).round() as usize)
            .map(|step| {
                look_at.follow(&plan(step as f32 * dt_s), 0.0, &TimeStep::new(dt_s));
                look_at.angle_rad
            })
            .collect()
    }

    fn facing(facing_rad: f32) -> Plan {
        Plan { facing_rad, ..Plan::default() }
    }

    #[test]
    fn the_angle_does_not_depend_on_the_step() {
        let [fine_rad, coarse_rad] = [1.0 / 120.0, 0.1].map(|dt_s| angles_rad(0.3, dt_s, |_| facing(0.6)));
        assert!((fine_rad[fine_rad.len() - 1] - coarse_rad[coarse_rad.len() - 1]).abs() < 1e-4);
    }

    #[test]
    fn plans_that_alternate_do_not_jerk_the_head() {
        let dt_s = 1.0 / 60.0;
        let alternating = |time_s: f32| facing(if (time_s / 0.4) as i32 % 2 == 0 { 3.0 } else { -3.0 });
        let angles_rad = angles_rad(8.0, dt_s, alternating);
        assert!(angles_rad.iter().all(|angle_rad| angle_rad.abs() <= ANGLE_MAX_RAD));
        assert!(angles_rad.windows(2).all(|pair| (pair[1] - pair[0]).abs() / dt_s < 7.0)); // 400 °/s, as in a start
    }

    #[test]
    fn the_head_turns_and_nothing_below_the_chest_moves() {
        let skeleton = skeleton();
        let mut pose = STANDING;
        LookAt { angle_rad: 0.5, rate_rad_s: 0.0 }.turn(&mut pose, &skeleton);
        let (before, after) = (STANDING.forward_kinematics(&skeleton), pose.forward_kinematics(&skeleton));
        let ahead = after.orientations[Joint::Head.index()] * Vec3::X;
        assert!((libm::atan2f(ahead.y, ahead.x) - 0.5).abs() < 1e-4);
        let legs = Joint::LeftThigh.index()..;
        assert_eq!(before.positions_m[legs.clone()], after.positions_m[legs]);
    }

    #[test]
    fn no_joint_turns_beyond_its_limit() {
        let mut skeleton = skeleton();
        skeleton.limits_rad[Joint::Neck.index()] = [Vec3::splat(-0.1), Vec3::splat(0.1)];
        for (neck_rad, expected_rad) in [(0.0, 0.1), (0.3, 0.3), (-0.3, 0.1)] {
            let mut pose = STANDING;
            pose.rotations[Joint::Neck.index()] = Quat::from_rotation_z(neck_rad);
            LookAt { angle_rad: 2.0, rate_rad_s: 0.0 }.turn(&mut pose, &skeleton);
            assert!((yaw_rad(pose.rotations[Joint::Neck.index()]) - expected_rad).abs() < 1e-5);
        }
    }

    #[test]
    fn a_body_looks_aside_but_not_backward() {
        let looked_rad = |velocity_mps| target_rad(&Plan { velocity_mps, ..Plan::default() }, 0.0);
        assert!(looked_rad(Vec2::new(0.0, 0.6)) > 0.3 && looked_rad(Vec2::new(1.2, -0.2)) < -0.05);
        assert_eq!(looked_rad(Vec2::new(-0.8, 0.0)), 0.0);
        assert_eq!(looked_rad(Vec2::new(f32::NAN, 0.0)), 0.0);
    }
}

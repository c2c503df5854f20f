//! Head and chest turn first when the body will turn (`FbCrowd` has nothing of it).
//!
//! People turn the head into a turn before the body follows: by some 200 ms on curved paths (Grasso et al. 1996,
//! *NeuroReport* 7, 1170–1174; Courtine and Schieppati 2003, *Eur. J. Neurosci.* 18, 177–190), and all the more the
//! sharper the turn (Sreenivasa et al. 2008, *Exp. Brain Res.* 191, 313–320). Here the *gaze*, an angle to the facing,
//! makes for where the body is asked to face and to go, like a critically damped spring. Since a body turns by the
//! angle to its wanted facing divided by T_turn (see [`crate::synthesis::command::blend_query`]), the gaze on a circle leads it by T_turn.
//!
//! The angle is shared out over spine, neck and head, each within its limits. Root and legs know nothing of it.
//! Radians, seconds; angles against the root's facing, counter-clockwise from above.

use std::f32::consts::PI;

use glam::Quat;
use motiondb::body::{Joint, Pose, Root, Skeleton};

use crate::maths::angle::{direction, wrap_rad, yaw};
use crate::planning::plan::Plan;
use crate::synthesis::time_step::TimeStep;

/// Eyes do what is further aside, rad: of turns by 90° and more the head shows some 45° against the trunk.
const GAZE_MAX_RAD: f32 = std::f32::consts::FRAC_PI_4;
/// Rate of the spring, 1/s. From straight ahead to the greatest angle the head then turns at 200 °/s, as in a glance.
pub(crate) const RATE_HZ: f32 = 12.0;
/// Who walks aside at this speed looks halfway to where he goes, m/s: a walk's.
const LOOK_SPEED_MPS: f32 = 1.2;
/// A gaze this near to the facing is along it, rad.
const AHEAD_RAD: f32 = 1e-3;
/// Shares of joints in the gaze, from the chest up.
const SHARES: [(Joint, f32); 4] =
    [(Joint::SpineMiddle, 0.1), (Joint::SpineUpper, 0.2), (Joint::Neck, 0.35), (Joint::Head, 0.35)];

/// Where a body looks.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Gaze {
    angle_rad: f32,
    rate_rad_s: f32,
}

impl Gaze {
    /// Lets a step pass, in which the gaze makes for what a plan asks of a body at `root`; exactly over a step.
    pub fn follow(&mut self, plan: &Plan, root: &Root, step: &TimeStep) {
        let wanted_rad = wanted_rad(plan, root.facing_rad);
        let (off_rad, rate_rad_s) = step.gaze.pass(self.angle_rad - wanted_rad, self.rate_rad_s);
        (self.angle_rad, self.rate_rad_s) = (wanted_rad + off_rad, rate_rad_s);
    }

    /// Turns chest and head of a pose, as far as its joints go.
    pub fn turn(&self, pose: &mut Pose, skeleton: &Skeleton) {
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

/// As much of a turn as a joint's limits leave.
fn within_limits_rad(turn_rad: f32, rotation: Quat, [least_rad, greatest_rad]: [f32; 2]) -> f32 {
    // An arc is at most π/2 times its sine, so no yaw is greater than π·|z|: mostly far from the limits.
    if PI * rotation.z.abs() + turn_rad.abs() <= greatest_rad.min(-least_rad) {
        return turn_rad;
    }
    // A pose beyond a limit is left where it is.
    let yaw_rad = yaw_rad(rotation);
    (yaw_rad + turn_rad).clamp(least_rad.min(yaw_rad), greatest_rad.max(yaw_rad)) - yaw_rad
}

/// About the vertical, as joint limits count it.
fn yaw_rad(rotation: Quat) -> f32 {
    if rotation.w < 0.0 { -rotation } else { rotation }.to_scaled_axis().z
}

/// The angle to where a body is asked to face and to go: ahead of the wanted facing, and the more to a side the faster
/// it is to walk there. Nobody looks where he steps back to.
fn wanted_rad(plan: &Plan, facing_rad: f32) -> f32 {
    let local_mps = direction(-plan.facing_rad).rotate(plan.velocity_mps);
    let aside_rad = libm::atan2f(local_mps.y, local_mps.x.max(0.0) + LOOK_SPEED_MPS);
    let wanted_rad = wrap_rad(plan.facing_rad + aside_rad - facing_rad).clamp(-GAZE_MAX_RAD, GAZE_MAX_RAD);
    if wanted_rad.is_finite() { wanted_rad } else { 0.0 }
}

#[cfg(test)]
mod tests {
    use glam::{Vec2, Vec3};
    use motiondb::body::JOINT_COUNT;

    use super::*;
    use crate::test_db::skeleton;

    const STANDING: Pose = Pose { pelvis_m: Vec3::new(0.0, 0.0, 0.92), rotations: [Quat::IDENTITY; JOINT_COUNT] };

    /// The gaze of a body that keeps its facing, 0, after each step of a plan of time.
    fn gazes(seconds: f32, dt_s: f32, plan: impl Fn(f32) -> Plan) -> Vec<Gaze> {
        let mut gaze = Gaze::default();
        (0..(seconds / dt_s).round() as usize)
            .map(|step| {
                gaze.follow(&plan(step as f32 * dt_s), &Root::default(), &TimeStep::new(dt_s));
                gaze
            })
            .collect()
    }

    fn facing(facing_rad: f32) -> Plan {
        Plan { facing_rad, ..Plan::default() }
    }

    #[test]
    fn the_gaze_does_not_depend_on_the_length_of_a_step() {
        let [fine, coarse] = [1.0 / 120.0, 0.1].map(|dt_s| gazes(0.3, dt_s, |_| facing(0.6)));
        assert!((fine[fine.len() - 1].angle_rad - coarse[coarse.len() - 1].angle_rad).abs() < 1e-4);
    }

    #[test]
    fn plans_that_flip_over_neither_jerk_the_head_nor_turn_it_beyond_its_greatest_angle() {
        let dt_s = 1.0 / 60.0;
        let flips = |time_s: f32| facing(if (time_s / 0.4) as i32 % 2 == 0 { 3.0 } else { -3.0 });
        let angles_rad: Vec<f32> = gazes(8.0, dt_s, flips).iter().map(|gaze| gaze.angle_rad).collect();
        assert!(angles_rad.iter().all(|angle_rad| angle_rad.abs() <= GAZE_MAX_RAD));
        assert!(angles_rad.windows(2).all(|pair| (pair[1] - pair[0]).abs() / dt_s < 7.0)); // 400 °/s, as in a start
    }

    #[test]
    fn the_head_shows_the_gaze_and_nothing_below_the_chest_moves() {
        let skeleton = skeleton();
        let mut pose = STANDING;
        Gaze { angle_rad: 0.5, rate_rad_s: 0.0 }.turn(&mut pose, &skeleton);
        let (before, after) = (STANDING.forward_kinematics(&skeleton), pose.forward_kinematics(&skeleton));
        let ahead = after.orientations[Joint::Head.index()] * Vec3::X;
        assert!((ahead.y.atan2(ahead.x) - 0.5).abs() < 1e-4);
        let legs = Joint::LeftThigh.index()..;
        assert_eq!(before.positions_m[legs.clone()], after.positions_m[legs]);
    }

    #[test]
    fn no_joint_is_turned_beyond_its_limit_and_one_that_is_there_stays() {
        let mut skeleton = skeleton();
        skeleton.limits_rad[Joint::Neck.index()] = [Vec3::splat(-0.1), Vec3::splat(0.1)];
        for (neck_rad, shown_rad) in [(0.0, 0.1), (0.3, 0.3), (-0.3, 0.1)] {
            let mut pose = STANDING;
            pose.rotations[Joint::Neck.index()] = Quat::from_rotation_z(neck_rad);
            Gaze { angle_rad: 2.0, rate_rad_s: 0.0 }.turn(&mut pose, &skeleton);
            assert!((yaw_rad(pose.rotations[Joint::Neck.index()]) - shown_rad).abs() < 1e-5);
        }
    }

    #[test]
    fn people_look_where_they_walk_aside_and_not_where_they_step_back_to() {
        let looked_rad = |velocity_mps| wanted_rad(&Plan { velocity_mps, ..Plan::default() }, 0.0);
        assert!(looked_rad(Vec2::new(0.0, 0.6)) > 0.3 && looked_rad(Vec2::new(1.2, -0.2)) < -0.05);
        assert_eq!(looked_rad(Vec2::new(-0.8, 0.0)), 0.0);
        assert_eq!(looked_rad(Vec2::new(f32::NAN, 0.0)), 0.0);
    }
}

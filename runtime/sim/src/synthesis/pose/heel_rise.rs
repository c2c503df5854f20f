//! A heel rises before the hips come down: where the leg behind would have to stretch, its foot turns about its toes.
//!
//! So people keep their hips up in long strides (Kerrigan, Della Croce, Marciello, Riley 2000, "A refined view of the
//! determinants of gait: significance of heel rise"); legs with flat feet would crouch. With ℓ what the leg lacks more
//! than it does in the pose, u the direction from hip to ankle and t the joint of the toes seen from the ankle, the
//! foot turns by
//!
//! ```text
//! ℓ/(u · (y × t)),   y the foot's axis to the left,
//! ```
//!
//! to first order what brings its ankle as near to the hip as it must be, and no further than people do. Its toes stay
//! as they are. All vectors are in the root frame (x forward, y left, z up), metres.

use glam::{Quat, Vec3};
use motiondb::body::{Pose, Skeleton};

use crate::maths::decay::soft_maximum;
use crate::synthesis::pose::leg::{FootPose, Leg};
use crate::synthesis::pose::pelvis::{EXTENSION, SOFTNESS_M};

/// Furthest that a heel rises for this, rad: half of what the foot turns by until it leaves in a quick walk.
const RISE_MAX_RAD: f32 = 0.6;
/// A leg counts as behind in full from this sine on, of its inclination along the foot, and not at all where it is
/// upright.
const BEHIND: f32 = 0.25;
/// Least of what turning the foot by 1 rad shortens the leg by, m: a foot under its hip rises in vain.
const SHORTENED_MIN_M: f32 = 0.05;

/// A foot whose heel has risen where its leg, which the pose has bent, would have to stretch; the pose's toes bend.
pub(crate) fn raised(pose: &mut Pose, skeleton: &Skeleton, side: usize, leg: &Leg, foot: &FootPose) -> FootPose {
    let to_ankle_m = foot.ankle_m - leg.hip_m();
    let behind_m = -to_ankle_m.truncate().dot((foot.orientation * Vec3::X).truncate());
    let (length_m, posed_m) = (to_ankle_m.length(), leg.foot().ankle_m.distance(leg.hip_m()));
    if behind_m <= 0.0 || length_m <= posed_m {
        return *foot;
    }
    let lacking_m = lacking_m(leg, length_m) - lacking_m(leg, posed_m);
    let [.., toe] = Leg::joints(side);
    let (axis, to_toes_m) = (foot.orientation * Vec3::Y, foot.orientation * skeleton.offsets_m[toe]);
    let shortened_m = (to_ankle_m.dot(axis.cross(to_toes_m)) / length_m).max(SHORTENED_MIN_M);
    let half = 0.5 * limited(smooth_step(behind_m / (BEHIND * length_m)) * lacking_m / shortened_m);
    pose.rotations[toe] = turned(-half * Vec3::Y) * pose.rotations[toe];
    let rise = turned(half * axis);
    FootPose { ankle_m: foot.ankle_m + to_toes_m - rise * to_toes_m, orientation: rise * foot.orientation }
}

/// From 0 to 1 without an edge, over the range from 0 to 1.
fn smooth_step(share: f32) -> f32 {
    let share = share.min(1.0);
    share * share * (3.0 - 2.0 * share)
}

/// What a leg lacks of a length, softly.
fn lacking_m(leg: &Leg, length_m: f32) -> f32 {
    let extent_m = EXTENSION * (leg.bones_m[0] + leg.bones_m[1]);
    SOFTNESS_M * soft_maximum((length_m - extent_m) / SOFTNESS_M)
}

/// An angle, never beyond its limit.
fn limited(angle_rad: f32) -> f32 {
    let over = angle_rad / RISE_MAX_RAD;
    angle_rad / libm::sqrtf(1.0 + over * over)
}

/// The rotation by a small angle, of which half is given, about an axis.
fn turned(half: Vec3) -> Quat {
    Quat::from_xyzw(half.x, half.y, half.z, 1.0).normalize()
}

#[cfg(test)]
mod tests {
    use motiondb::body::{JOINT_COUNT, Joint};

    use super::*;
    use crate::synthesis::pose::leg::legs;
    use crate::test_db::skeleton;

    /// A standing body's right foot, left behind by a length, before and after; the hip.
    fn left_behind(behind_m: f32) -> (FootPose, FootPose, Vec3) {
        let skeleton = skeleton();
        let mut pose = Pose { pelvis_m: skeleton.offsets_m[0], rotations: [Quat::IDENTITY; JOINT_COUNT] };
        let legs = legs(&pose, &skeleton);
        let mut foot = legs[1].foot();
        foot.ankle_m.x -= behind_m;
        let risen = raised(&mut pose, &skeleton, 1, &legs[1], &foot);
        (foot, risen, legs[1].hip_m())
    }

    #[test]
    fn a_foot_left_behind_turns_about_its_toes_until_its_leg_reaches() {
        let toes_m = skeleton().offsets_m[Joint::RightToe.index()];
        for behind_m in [0.1, 0.2, 0.3, 0.4] {
            let (flat, risen, hip_m) = left_behind(behind_m);
            let toes_moved_m = risen.ankle_m + risen.orientation * toes_m - flat.ankle_m - toes_m;
            assert!(toes_moved_m.length() < 1e-5);
            assert!(risen.ankle_m.distance(hip_m) < flat.ankle_m.distance(hip_m));
            assert!(risen.orientation.angle_between(flat.orientation) <= RISE_MAX_RAD);
        }
    }

    #[test]
    fn a_foot_under_or_before_its_hip_stays_flat() {
        for behind_m in [0.0, -0.2, -0.4] {
            let (flat, risen, _) = left_behind(behind_m);
            assert_eq!(flat, risen);
        }
    }
}

//! Heel rise: where the leg behind would have to stretch, its foot turns about its toes before the pelvis drops.
//!
//! It keeps the pelvis high in long strides (Kerrigan, Della Croce, Marciello, Riley 2000, "A refined view of the
//! determinants of gait: significance of heel rise"); a body with flat feet would crouch. ℓ is the length that the leg
//! lacks beyond what it lacks in the pose. u is the direction from hip to ankle, t the toe joint relative to the ankle,
//! y the foot's axis to the left. The foot turns by
//!
//! ```text
//! ℓ/(u · (y × t)),
//! ```
//!
//! which to first order brings the ankle as near to the hip as it must be; the angle is limited to what people do. The
//! toes keep their position.
//!
//! Root frame (x forward, y left, z up), metres.

use glam::{Quat, Vec3};
use motiondb::body::{Pose, Skeleton};

use crate::maths::decay::{smooth_step, soft_maximum};
use crate::synthesis::pose::leg::{FootPose, PosedLeg};
use crate::synthesis::pose::leg_length::EXTENSION;
use crate::synthesis::pose::pelvis::SOFTNESS_M;

/// Limit of the angle by which a heel rises, rad: half of the foot's turn until toe-off in a quick walk.
const RISE_MAX_RAD: f32 = 0.6;
/// Sine of a leg's backward inclination from which on its heel rises in full. An upright leg's heel does not rise.
const BEHIND_SINE: f32 = 0.25;
/// Least change of the leg's length per radian of the foot's turn, m: under its hip a foot turns in vain.
const SHORTENING_MIN_M: f32 = 0.05;

/// The target of a foot with its heel raised as far as its leg would have to stretch. Bends the toes in `pose`.
pub(crate) fn raised(pose: &mut Pose, skeleton: &Skeleton, side: usize, leg: &PosedLeg, foot: &FootPose) -> FootPose {
    let to_ankle_m = foot.ankle_m - leg.hip_m();
    let behind_m = -to_ankle_m.truncate().dot((foot.orientation * Vec3::X).truncate());
    let (length_m, posed_m) = (to_ankle_m.length(), leg.foot().ankle_m.distance(leg.hip_m()));
    if behind_m <= 0.0 || length_m <= posed_m {
        return *foot;
    }
    let lacking_m = lacking_m(leg, length_m) - lacking_m(leg, posed_m);
    let [.., toe] = PosedLeg::joints(side);
    let (axis, to_toes_m) = (foot.orientation * Vec3::Y, foot.orientation * skeleton.offsets_m[toe]);
    let shortening_m = (to_ankle_m.dot(axis.cross(to_toes_m)) / length_m).max(SHORTENING_MIN_M);
    let half_rad = 0.5 * soft_limited_rad(smooth_step(behind_m / (BEHIND_SINE * length_m)) * lacking_m / shortening_m);
    pose.rotations[toe] = small_rotation(-half_rad * Vec3::Y) * pose.rotations[toe];
    let rise = small_rotation(half_rad * axis);
    FootPose { ankle_m: foot.ankle_m + to_toes_m - rise * to_toes_m, orientation: rise * foot.orientation }
}

/// Length by which a leg is too short for a distance from hip to ankle, softly, m.
fn lacking_m(leg: &PosedLeg, distance_m: f32) -> f32 {
    let length_m = EXTENSION * (leg.bones_m[0] + leg.bones_m[1]);
    SOFTNESS_M * soft_maximum((distance_m - length_m) / SOFTNESS_M)
}

/// An angle that approaches [`RISE_MAX_RAD`] and never exceeds it, rad.
fn soft_limited_rad(angle_rad: f32) -> f32 {
    let ratio = angle_rad / RISE_MAX_RAD;
    angle_rad / libm::sqrtf(1.0 + ratio * ratio)
}

/// The rotation about an axis by a small angle, given axis × half the angle, rad.
fn small_rotation(half_rad: Vec3) -> Quat {
    Quat::from_xyzw(half_rad.x, half_rad.y, half_rad.z, 1.0).normalize()
}

#[cfg(test)]
mod tests {
    use motiondb::body::{JOINT_COUNT, Joint};

    use super::*;
    use crate::synthesis::pose::leg::legs;
    use crate::test_db::skeleton;

    /// The right foot of a standing body, `behind_m` behind its own: flat, with its heel raised, and the hip, m.
    fn left_behind(behind_m: f32) -> (FootPose, FootPose, Vec3) {
        let skeleton = skeleton();
        let mut pose = Pose { pelvis_m: skeleton.offsets_m[0], rotations: [Quat::IDENTITY; JOINT_COUNT] };
        let legs = legs(&pose, &skeleton);
        let mut foot = legs[1].foot();
        foot.ankle_m.x -= behind_m;
        let raised = raised(&mut pose, &skeleton, 1, &legs[1], &foot);
        (foot, raised, legs[1].hip_m())
    }

    #[test]
    fn a_foot_left_behind_turns_about_its_toes() {
        let toes_m = skeleton().offsets_m[Joint::RightToe.index()];
        for behind_m in [0.1, 0.2, 0.3, 0.4] {
            let (flat, raised, hip_m) = left_behind(behind_m);
            let toes_moved_m = raised.ankle_m + raised.orientation * toes_m - flat.ankle_m - toes_m;
            assert!(toes_moved_m.length() < 1e-5);
            assert!(raised.ankle_m.distance(hip_m) < flat.ankle_m.distance(hip_m));
            assert!(raised.orientation.angle_between(flat.orientation) <= RISE_MAX_RAD);
        }
    }

    #[test]
    fn a_foot_under_or_before_its_hip_stays_flat() {
        for behind_m in [0.0, -0.2, -0.4] {
            let (flat, raised, _) = left_behind(behind_m);
            assert_eq!(flat, raised);
        }
    }
}

//! Squeeze: a body turns its shoulders where there is little room beside them, and holds its arms still. `FbCrowd` does
//! not have it.
//!
//! People turn their shoulders in gaps below 1.3 times their breadth (Warren and Whang 1987, *J. Exp. Psychol.: Hum.
//! Percept. Perform.* 13, 371–383), so that they keep that room. A body does so in the gap that it walks through
//! ([`crate::planning::gap`]), and where walls and bodies leave it as little elbow room ([`crate::planning::elbow_room`]).
//! With the width A of the narrower one and the breadth S,
//!
//! ```text
//! cos ψ = A/(1.3·S),   ψ ≤ 45°.
//! ```
//!
//! The shoulder on the nearer side turns forward. The spine shares the angle within its joint limits, and neck and head
//! turn back: the gaze stays ahead. Root, pelvis and legs do not depend on it.
//!
//! Angles counter-clockwise from above, radians; metres.

use motiondb::body::{Joint, Pose, Skeleton};

use crate::maths::angle::yaw;
use crate::synthesis::TimeStep;
use crate::synthesis::pose::upper_body::yaw_limit::within_limits_rad;
use crate::synthesis::traits::{ArmRotations, swing_arms};

/// Width, divided by the breadth of the shoulders, below which shoulders turn.
const WIDE: f32 = 1.3;
/// Greatest turn of the shoulders, rad.
const ANGLE_MAX_RAD: f32 = std::f32::consts::FRAC_PI_4;
/// Angle above which the turn keeps its side, rad.
const KEPT_RAD: f32 = 0.1;
/// Angle below which the pose is left unchanged, rad.
const AHEAD_RAD: f32 = 1e-3;
/// Share of the swing that arms lose at the greatest angle.
const STILL_ARMS: f32 = 0.7;
/// Joints that turn, and their shares of the angle; neck and head take it back.
const SHARES: [(Joint, f32); 5] = [
    (Joint::SpineLower, 0.3),
    (Joint::SpineMiddle, 0.35),
    (Joint::SpineUpper, 0.35),
    (Joint::Neck, -0.5),
    (Joint::Head, -0.5),
];

/// The turn of a body's shoulders.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(crate) struct Squeeze {
    /// Angle, rad, its rate of change, rad/s, and its acceleration, rad/s².
    angle_rad: [f32; 3],
    /// Whether the left shoulder turns forward.
    left_first: bool,
}

impl Squeeze {
    /// Follows over one step the narrower of two gaps, that which the body walks through and its elbow room: the
    /// distances to the left and right end of each, m; none where there is none.
    pub(crate) fn follow(&mut self, gaps_m: [Option<[f32; 2]>; 2], breadth_m: f32, step: &TimeStep) {
        let width_m = |[left_m, right_m]: &[f32; 2]| left_m + right_m;
        let narrower_m = gaps_m.into_iter().flatten().min_by(|a, b| width_m(a).total_cmp(&width_m(b)));
        let target_rad = narrower_m.map_or(0.0, |gap_m| {
            if self.angle_rad[0].abs() < KEPT_RAD {
                self.left_first = gap_m[0] < gap_m[1];
            }
            let share = (width_m(&gap_m) / (WIDE * breadth_m)).clamp(0.0, 1.0);
            let size_rad = libm::acosf(share).min(ANGLE_MAX_RAD);
            if self.left_first { -size_rad } else { size_rad }
        });
        step.squeeze.approach(&mut self.angle_rad, target_rad);
    }

    /// Turns the shoulders of a pose, and stills its arms about their means in the base walk.
    pub(crate) fn turn(&self, pose: &mut Pose, arm_means: &ArmRotations, skeleton: &Skeleton) {
        let angle_rad = self.angle_rad[0];
        if angle_rad.abs() < AHEAD_RAD {
            return;
        }
        let swing = 1.0 - STILL_ARMS * (angle_rad.abs() / ANGLE_MAX_RAD).min(1.0);
        swing_arms(pose, arm_means, [swing; 2]);
        for (joint, share) in SHARES {
            let rotation = &mut pose.rotations[joint.index()];
            let [least, greatest] = skeleton.limits_rad[joint.index()];
            *rotation = yaw(within_limits_rad(share * angle_rad, *rotation, [least.z, greatest.z])) * *rotation;
        }
    }
}

/// Breadth of the shoulders in a rest pose: between the shoulder joints, and the girth of both upper arms, m.
pub(crate) fn shoulder_breadth_m(skeleton: &Skeleton) -> f32 {
    let to_joint_m = |arm: Joint| {
        let clavicle_m = arm.parent().map_or(0.0, |joint| skeleton.offsets_m[joint.index()].y.abs());
        clavicle_m + skeleton.offsets_m[arm.index()].y.abs() + skeleton.segment_radii_m[arm.index()]
    };
    Joint::UPPER_ARMS.into_iter().map(to_joint_m).sum()
}

#[cfg(test)]
mod tests {
    use glam::Vec3;

    use super::*;
    use crate::synthesis::traits::arm_rotations;
    use crate::test_db::test_db;

    /// Turn of the shoulders after a second between gaps of widths, divided by the breadth, degrees.
    fn turned_deg(widths: [Option<f32>; 2]) -> f32 {
        let (mut squeeze, step) = (Squeeze::default(), TimeStep::new(1.0 / 60.0));
        let gaps_m = widths.map(|width| width.map(|width| [0.25 * width; 2]));
        (0..60).for_each(|_| squeeze.follow(gaps_m, 0.5, &step));
        squeeze.angle_rad[0].abs().to_degrees()
    }

    #[test]
    fn shoulders_turn_in_gaps_below_1_3_breadths() {
        let [wider, gap, narrow, narrowest] = [1.5, 1.2, 1.0, 0.8].map(|width| turned_deg([Some(width), None]));
        assert!(wider < 0.1 && gap > 10.0 && narrow > 30.0 && narrowest <= 45.01, "{wider} {gap} {narrow} {narrowest}");
    }

    #[test]
    fn the_narrower_of_gap_and_elbow_room_counts() {
        let narrow_deg = turned_deg([Some(1.0), None]);
        for widths in [[None, Some(1.0)], [Some(1.0), Some(1.2)], [Some(1.2), Some(1.0)]] {
            assert_eq!(turned_deg(widths), narrow_deg, "{widths:?}");
        }
        assert_eq!(turned_deg([None; 2]), 0.0);
    }

    #[test]
    fn the_nearer_shoulder_turns_forward_and_keeps_turning() {
        let step = TimeStep::new(1.0 / 60.0);
        for (gap_m, sign) in [([0.2, 0.25], -1.0), ([0.25, 0.2], 1.0)] {
            let mut squeeze = Squeeze::default();
            (0..40).for_each(|_| squeeze.follow([Some(gap_m), None], 0.5, &step));
            (0..40).for_each(|_| squeeze.follow([Some([gap_m[1], gap_m[0]]), None], 0.5, &step));
            assert!(sign * squeeze.angle_rad[0] > 0.3, "{gap_m:?}: {squeeze:?}");
        }
    }

    #[test]
    fn the_shoulders_turn_and_the_gaze_stays() {
        let db = test_db();
        let before = db.rows.pose(2, 10);
        let mut pose = before;
        let mean = arm_rotations(&db.rows.mean_pose(2));
        Squeeze { angle_rad: [0.5, 0.0, 0.0], left_first: false }.turn(&mut pose, &mean, &db.skeleton);
        let [from, to] = [before, pose].map(|pose| pose.forward_kinematics(&db.skeleton));
        let ahead_rad = |joints: &motiondb::body::Joints, joint: Joint| {
            let ahead = joints.orientations[joint.index()] * Vec3::X;
            libm::atan2f(ahead.y, ahead.x)
        };
        let turn_rad = |joint: Joint| ahead_rad(&to, joint) - ahead_rad(&from, joint);
        assert!((turn_rad(Joint::SpineUpper) - 0.5).abs() < 0.02, "{}", turn_rad(Joint::SpineUpper));
        assert!(turn_rad(Joint::Head).abs() < 0.02, "{}", turn_rad(Joint::Head));
        let legs = Joint::LeftThigh.index()..;
        assert_eq!(from.positions_m[legs.clone()], to.positions_m[legs]);
    }
}

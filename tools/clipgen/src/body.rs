//! The body that all bundled clips are made on: 1.75 m tall, of published proportions.
//!
//! Segment lengths are the shares of body height of Drillis and Contini (1966) as printed in Winter, *Biomechanics and
//! Motor Control of Human Movement* (Fig. 4.1): thigh .245, shank .246, ankle height .039, foot .152, upper arm .186,
//! forearm .146, hand .108, shoulder height .818. Those shares name surface landmarks for the breadths (hips .191,
//! shoulders .259), so the joint centres lie inside them. Frame of the rest pose (a T-pose): x forward, y left, z up,
//! metres; the root is the midpoint of the hips.

use glam::{DQuat, DVec3};

/// Body height, m.
pub(crate) const HEIGHT_M: f64 = 1.75;
/// Hip to knee, m.
pub(crate) const THIGH_M: f64 = 0.245 * HEIGHT_M;
/// Knee to ankle, m.
pub(crate) const SHANK_M: f64 = 0.246 * HEIGHT_M;
/// Ankle over the sole, m.
pub(crate) const ANKLE_HEIGHT_M: f64 = 0.039 * HEIGHT_M;
/// Hip joint centres from the midline: about half of the bi-trochanteric breadth of .191 H, m.
pub(crate) const HALF_HIP_M: f64 = 0.050 * HEIGHT_M;
/// Shoulder joint centres from the midline: the acromia stand at .129 H, the joints 4 cm inside, m.
pub(crate) const HALF_SHOULDER_M: f64 = 0.106 * HEIGHT_M;
/// Rearmost point of the heel that bears weight, behind the ankle: the foot of .152 H begins 6 cm behind it, m.
pub(crate) const HEEL_X_M: f64 = -0.050;
/// Ball of the foot (metatarsophalangeal joint) ahead of the ankle: 73 % of the foot's length from its rear, m.
pub(crate) const BALL_X_M: f64 = 0.132;
/// Tip of the toes ahead of the ankle, m.
pub(crate) const TOE_TIP_X_M: f64 = 0.200;
/// The toe joint over the sole, m.
pub(crate) const TOE_JOINT_HEIGHT_M: f64 = 0.022;

/// Number of joints, sole points included.
pub(crate) const JOINT_COUNT: usize = 28;
/// Lowest joint of the spine; two more follow.
pub(crate) const SPINE: usize = 1;
/// Upper chest, which carries neck and clavicles.
pub(crate) const CHEST: usize = 3;
/// Base of the neck.
pub(crate) const NECK: usize = 4;
/// Base of the skull.
pub(crate) const HEAD: usize = 5;
/// Inner end of each clavicle, `[left, right]`.
pub(crate) const CLAVICLES: [usize; 2] = [6, 10];
/// Shoulder of each arm.
pub(crate) const ARMS: [usize; 2] = [7, 11];
/// Elbow of each arm.
pub(crate) const FOREARMS: [usize; 2] = [8, 12];
/// Wrist of each arm.
pub(crate) const HANDS: [usize; 2] = [9, 13];
/// Hip of each leg.
pub(crate) const THIGHS: [usize; 2] = [14, 21];
/// Knee of each leg.
pub(crate) const SHANKS: [usize; 2] = [15, 22];
/// Ankle of each leg.
pub(crate) const FEET: [usize; 2] = [16, 23];
/// Toe joint of each foot.
pub(crate) const TOES: [usize; 2] = [17, 24];

/// A joint at rest.
#[derive(Clone, Copy, Debug)]
pub(crate) struct JointAtRest {
    /// Its name in the file.
    pub(crate) name: &'static str,
    /// Its parent; the root names itself.
    pub(crate) parent: usize,
    /// Relative to the parent, m.
    pub(crate) offset_m: DVec3,
    /// Where its segment ends, for joints without children.
    pub(crate) end_m: Option<DVec3>,
}

/// All joints, each parent before its children and in the depth-first order that BVH wants.
pub(crate) fn joints_at_rest() -> [JointAtRest; JOINT_COUNT] {
    let joint = |name, parent, x, y, z| JointAtRest { name, parent, offset_m: DVec3::new(x, y, z), end_m: None };
    let tip = |name, parent, x, y, z, end| JointAtRest { end_m: Some(end), ..joint(name, parent, x, y, z) };
    let crown = DVec3::new(0.0, 0.0, 0.185);
    let fingers = |side: f64| DVec3::new(0.0, side * 0.108 * HEIGHT_M, 0.0);
    let point = DVec3::ZERO;
    let (upper_arm, forearm) = (0.186 * HEIGHT_M, 0.146 * HEIGHT_M);
    let (toe_drop, toe_length) = (TOE_JOINT_HEIGHT_M - ANKLE_HEIGHT_M, TOE_TIP_X_M - BALL_X_M);
    [
        joint("Hips", 0, 0.0, 0.0, 0.0),
        joint("Spine", 0, -0.015, 0.0, 0.095),
        joint("Spine1", 1, -0.005, 0.0, 0.120),
        joint("Spine2", 2, 0.0, 0.0, 0.130),
        joint("Neck", 3, 0.0, 0.0, 0.205),
        tip("Head", 4, 0.015, 0.0, 0.090, crown),
        joint("LeftShoulder", 3, 0.015, 0.022, 0.162),
        joint("LeftArm", 6, -0.020, HALF_SHOULDER_M - 0.022, -0.005),
        joint("LeftForeArm", 7, 0.0, upper_arm, 0.0),
        tip("LeftHand", 8, 0.0, forearm, 0.0, fingers(1.0)),
        joint("RightShoulder", 3, 0.015, -0.022, 0.162),
        joint("RightArm", 10, -0.020, -(HALF_SHOULDER_M - 0.022), -0.005),
        joint("RightForeArm", 11, 0.0, -upper_arm, 0.0),
        tip("RightHand", 12, 0.0, -forearm, 0.0, fingers(-1.0)),
        joint("LeftUpLeg", 0, 0.0, HALF_HIP_M, 0.0),
        joint("LeftLeg", 14, 0.0, 0.0, -THIGH_M),
        joint("LeftFoot", 15, 0.0, 0.0, -SHANK_M),
        joint("LeftToeBase", 16, BALL_X_M, 0.0, toe_drop),
        tip("LeftToeSole", 17, toe_length, 0.0, -TOE_JOINT_HEIGHT_M, point),
        tip("LeftHeelSole", 16, HEEL_X_M, 0.0, -ANKLE_HEIGHT_M, point),
        tip("LeftBallSole", 16, BALL_X_M, 0.0, -ANKLE_HEIGHT_M, point),
        joint("RightUpLeg", 0, 0.0, -HALF_HIP_M, 0.0),
        joint("RightLeg", 21, 0.0, 0.0, -THIGH_M),
        joint("RightFoot", 22, 0.0, 0.0, -SHANK_M),
        joint("RightToeBase", 23, BALL_X_M, 0.0, toe_drop),
        tip("RightToeSole", 24, toe_length, 0.0, -TOE_JOINT_HEIGHT_M, point),
        tip("RightHeelSole", 23, HEEL_X_M, 0.0, -ANKLE_HEIGHT_M, point),
        tip("RightBallSole", 23, BALL_X_M, 0.0, -ANKLE_HEIGHT_M, point),
    ]
}

/// One frame: the root in the world and every joint's rotation against its parent.
#[derive(Clone, Debug)]
pub(crate) struct Pose {
    /// Midpoint of the hips, m.
    pub(crate) hips_m: DVec3,
    /// Local rotations; the root's against the world.
    pub(crate) rotations: [DQuat; JOINT_COUNT],
}

impl Pose {
    /// Every joint's place in the world, m.
    #[cfg(test)]
    pub(crate) fn positions_m(&self) -> [DVec3; JOINT_COUNT] {
        let mut places = [self.hips_m; JOINT_COUNT];
        let mut turns = self.rotations;
        for (index, joint) in joints_at_rest().iter().enumerate().skip(1) {
            places[index] = places[joint.parent] + turns[joint.parent] * joint.offset_m;
            turns[index] = turns[joint.parent] * self.rotations[index];
        }
        places
    }
}

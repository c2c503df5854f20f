//! The skeleton that all bundled clips are made on: 1.75 m tall, of published proportions.
//!
//! Segment lengths are the shares of body height of Drillis and Contini (1966) as printed in Winter, *Biomechanics and
//! Motor Control of Human Movement* (Fig. 4.1): thigh .245, shank .246, ankle height .039, foot .152, upper arm .186,
//! forearm .146, hand .108, shoulder height .818. The breadths among them (hips .191, shoulders .259) are those of
//! surface landmarks, so the joint centres lie inside. Frame of the rest pose (a T-pose): x forward, y left, z up,
//! metres; the root is the midpoint of the hips.

use glam::DVec3;

/// Height of the body, m.
pub(crate) const HEIGHT_M: f64 = 1.75;
/// Length of the thigh, hip to knee, m.
pub(crate) const THIGH_M: f64 = 0.245 * HEIGHT_M;
/// Length of the shank, knee to ankle, m.
pub(crate) const SHANK_M: f64 = 0.246 * HEIGHT_M;
/// Height of the ankle above the sole, m.
pub(crate) const ANKLE_HEIGHT_M: f64 = 0.039 * HEIGHT_M;
/// Distance of a hip joint centre from the midline, m: about half of the bi-trochanteric breadth of .191 H.
pub(crate) const HALF_HIP_M: f64 = 0.050 * HEIGHT_M;
/// Distance of a shoulder joint centre from the midline, m: the acromia lie at .129 H, the joints 4 cm inside.
pub(crate) const HALF_SHOULDER_M: f64 = 0.106 * HEIGHT_M;
/// Rearmost point of the heel that bears weight, ahead of the ankle, m; the foot of .152 H begins 6 cm behind the
/// ankle.
pub(crate) const HEEL_X_M: f64 = -0.050;
/// Ball of the foot (metatarsophalangeal joint) ahead of the ankle, m: 73 % of the foot's length from its rear.
pub(crate) const BALL_X_M: f64 = 0.132;
/// Tip of the toes ahead of the ankle, m.
pub(crate) const TOE_TIP_X_M: f64 = 0.200;
/// Height of the toe joint above the sole, m.
pub(crate) const TOE_JOINT_HEIGHT_M: f64 = 0.022;

/// Number of joints, sole points included.
pub(crate) const JOINT_COUNT: usize = 28;
/// Index of the lowest joint of the spine; two more follow.
pub(crate) const SPINE: usize = 1;
/// Index of the upper chest, which carries neck and clavicles.
pub(crate) const CHEST: usize = 3;
/// Index of the base of the neck.
pub(crate) const NECK: usize = 4;
/// Index of the base of the skull.
pub(crate) const HEAD: usize = 5;
/// Indices of the inner ends of the clavicles, `[left, right]`.
pub(crate) const CLAVICLES: [usize; 2] = [6, 10];
/// Indices of the shoulders, `[left, right]`.
pub(crate) const ARMS: [usize; 2] = [7, 11];
/// Indices of the elbows, `[left, right]`.
pub(crate) const FOREARMS: [usize; 2] = [8, 12];
/// Indices of the wrists, `[left, right]`.
pub(crate) const HANDS: [usize; 2] = [9, 13];
/// Indices of the hips, `[left, right]`.
pub(crate) const THIGHS: [usize; 2] = [14, 21];
/// Indices of the knees, `[left, right]`.
pub(crate) const SHANKS: [usize; 2] = [15, 22];
/// Indices of the ankles, `[left, right]`.
pub(crate) const FEET: [usize; 2] = [16, 23];
/// Indices of the toe joints, `[left, right]`; toe, heel and ball on the sole follow each.
pub(crate) const TOES: [usize; 2] = [17, 24];

/// A joint at rest.
#[derive(Clone, Copy, Debug)]
pub(crate) struct JointAtRest {
    /// Name in the file.
    pub(crate) name: &'static str,
    /// Index of the parent; the root is its own parent.
    pub(crate) parent: usize,
    /// Position relative to the parent, m.
    pub(crate) offset_m: DVec3,
    /// End of the segment relative to the joint, m; only of joints without children, zero for points on the sole.
    pub(crate) end_m: Option<DVec3>,
}

/// All joints, each parent before its children, in the depth-first order of BVH.
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

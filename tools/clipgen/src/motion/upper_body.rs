//! Trunk, head and arms.
//!
//! The chest counter-rotates the pelvis (3–5° above 1 m/s), leans with speed and banks into turns; the three joints of
//! the spine share the rotation from pelvis to chest. The head stays level and looks where the body will be. Arms swing
//! in antiphase to the leg of their side: foremost shortly before the other heel strikes. They hang from a chest that
//! yaws, but their swing is counted against the vertical. Root frame: x forward, y left, z up, radians.

use glam::DQuat;

use crate::body::rotation::{about_x, about_y, about_z, share_of, wave};
use crate::body::skeleton::{ARMS, CHEST, CLAVICLES, FOREARMS, HANDS, HEAD, JOINT_COUNT, NECK, SPINE};
use crate::motion::pelvis::PelvisPose;
use crate::plan::GaitPlan;
use crate::plan::gait_plan::UpperBodyAmplitudes;

/// Lead of the foremost hand before the trunk's farthest turn, share of the stride: opposite to the thigh.
const ARM_LEAD: f64 = 0.05;
/// Share by which the left arm swings more, and the right arm less, than the mean: the left swings some 20 % farther in
/// 334 adults (Killeen et al. 2018, *Sci. Rep.* 8, doi 10.1038/s41598-018-31151-9).
const LEFT_ARM_SHARE: f64 = 0.10;
/// Lag of the elbow's greatest bend behind the shoulder's, share of the stride.
const ELBOW_LAG: f64 = 0.04;
/// Amplitude of the trunk's nod, twice a stride, forward as each foot takes the load, rad.
const NOD_RAD: f64 = 0.012;
/// Dip of the chest towards the stance side, share of the pelvis's list.
const CHEST_LIST_SHARE: f64 = 0.60;
/// Share of a turn's bank that the chest takes; the legs take the rest (`LEAN_ARM_M` of the gait plan).
const CHEST_BANK_SHARE: f64 = 0.90;
/// Share of a turn's bank that the head takes.
const HEAD_BANK_SHARE: f64 = 0.40;
/// Turn of the upper arms inward, rad: the hands swing towards the midline.
const ARM_INWARD_RAD: f64 = 0.24;
/// Further turn inward per bend of the elbow, rad/rad.
const ARM_INWARD_PER_ELBOW: f64 = 0.13;
/// Shares of the lower and the middle spine in a twist: of the 45° that human trunks allow (AAOS, *Joint Motion*, 1965)
/// the lumbar vertebrae give a few, the upper thoracic ones most.
const SPINE_TWIST_SHARES: [f64; 2] = [1.0 / 9.0, 1.0 / 3.0];
/// Share of the arm's flexion that the clavicle follows.
const CLAVICLE_SHARE: f64 = 0.12;
/// Bend of a relaxed wrist, rad.
const WRIST_RAD: f64 = 0.10;
/// Pitch of the gaze downward, rad.
const GAZE_DOWN_RAD: f64 = 0.05;

/// Orientations of chest, head and arms at one moment, against the root's heading, rad.
#[derive(Clone, Copy, Debug)]
pub(crate) struct UpperBodyPose {
    /// Yaw of the chest; positive to the left.
    pub(crate) chest_yaw_rad: f64,
    /// Pitch of the chest; positive forward.
    pub(crate) chest_pitch_rad: f64,
    /// Roll of the chest; positive with the left side up.
    pub(crate) chest_roll_rad: f64,
    /// Yaw of the head; positive to the left.
    pub(crate) head_yaw_rad: f64,
    /// Roll of the head; positive with the left side up.
    pub(crate) head_roll_rad: f64,
    /// Arms, `[left, right]`.
    pub(crate) arms: [ArmPose; 2],
}

/// Angles of an arm, rad.
#[derive(Clone, Copy, Debug)]
pub(crate) struct ArmPose {
    /// Flexion of the shoulder, forward from hanging.
    pub(crate) flexion_rad: f64,
    /// Angle outward from hanging.
    pub(crate) out_rad: f64,
    /// Bend of the elbow.
    pub(crate) elbow_rad: f64,
}

/// The upper body of a gait at a cycle phase (0 at the left heel strike), with its amplitudes there.
pub(crate) fn upper_body_pose(gait: &GaitPlan, amplitudes: &UpperBodyAmplitudes, cycle_phase: f64) -> UpperBodyPose {
    let chest_wave = wave(cycle_phase - gait.yaw_peak);
    let list_wave = wave(cycle_phase - gait.mid_stance());
    UpperBodyPose {
        chest_yaw_rad: amplitudes.chest_yaw_rad * chest_wave,
        chest_pitch_rad: amplitudes.lean_rad + NOD_RAD * wave(2.0 * cycle_phase - 0.2),
        chest_roll_rad: -CHEST_BANK_SHARE * amplitudes.bank_rad - CHEST_LIST_SHARE * gait.pelvis.list_rad * list_wave
            + amplitudes.side_lag_rad * 0.5 * (1.0 + wave(cycle_phase)),
        head_yaw_rad: amplitudes.look_rad,
        head_roll_rad: -HEAD_BANK_SHARE * amplitudes.bank_rad,
        arms: [(0.5, 1.0 + LEFT_ARM_SHARE), (0.0, 1.0 - LEFT_ARM_SHARE)].map(|(foremost, share)| {
            let since = cycle_phase - foremost - gait.yaw_peak + ARM_LEAD;
            ArmPose {
                flexion_rad: amplitudes.arm_mean_rad + share * amplitudes.arm_swing_rad * wave(since),
                out_rad: amplitudes.arm_out_rad,
                elbow_rad: amplitudes.elbow_rad + amplitudes.elbow_swing_rad * wave(since - ELBOW_LAG),
            }
        }),
    }
}

impl UpperBodyPose {
    /// Sets the rotations of the joints from spine to hands.
    pub(crate) fn write(&self, pelvis: &PelvisPose, rotations: &mut [DQuat; JOINT_COUNT]) {
        let chest = about_x(self.chest_roll_rad) * about_z(self.chest_yaw_rad) * about_y(self.chest_pitch_rad);
        let head = about_x(self.head_roll_rad) * about_z(self.head_yaw_rad) * about_y(GAZE_DOWN_RAD);
        rotations[SPINE..=CHEST].copy_from_slice(&spine(pelvis.rotation.inverse() * chest));
        rotations[NECK..=HEAD].fill(share_of(chest.inverse() * head, 0.5));
        for (side, arm) in self.arms.iter().enumerate() {
            arm.write(side, self.chest_yaw_rad, chest, rotations);
        }
    }
}

/// Rotations of the spine's three joints, from pelvis to chest: bends are shared evenly, twists as the vertebrae allow.
fn spine(whole: DQuat) -> [DQuat; 3] {
    let twist_rad = 2.0 * libm::atan2(whole.z, whole.w);
    let bend = share_of(whole * about_z(-twist_rad), 1.0 / 3.0);
    let [lower, middle] = [0, 1].map(|joint| bend * about_z(SPINE_TWIST_SHARES[joint] * twist_rad));
    [lower, middle, (lower * middle).inverse() * whole]
}

impl ArmPose {
    /// Sets the rotations of one arm. Rest is a T-pose: the arm is lowered, turned inward, then swung.
    fn write(&self, side: usize, chest_yaw_rad: f64, chest: DQuat, rotations: &mut [DQuat; JOINT_COUNT]) {
        let sign = if side == 0 { 1.0 } else { -1.0 };
        let lowered = about_x(-sign * (std::f64::consts::FRAC_PI_2 - self.out_rad));
        let inward_rad = ARM_INWARD_RAD + ARM_INWARD_PER_ELBOW * self.elbow_rad;
        let hanging = about_y(-self.flexion_rad) * lowered * about_y(inward_rad);
        let clavicle = about_z(-sign * CLAVICLE_SHARE * self.flexion_rad);
        rotations[CLAVICLES[side]] = clavicle;
        rotations[ARMS[side]] = (chest * clavicle).inverse() * about_z(chest_yaw_rad) * hanging;
        rotations[FOREARMS[side]] = about_z(-sign * self.elbow_rad);
        rotations[HANDS[side]] = about_z(-sign * WRIST_RAD);
    }
}

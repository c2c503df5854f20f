//! Trunk, head and arms.
//!
//! The chest counter-rotates the pelvis (3–5° above 1 m/s), leans with speed and banks into turns; the spine's three
//! joints share what lies between pelvis and chest. The head stays level and looks where the body will be. Arms swing
//! in antiphase to the leg of their side: foremost shortly before the other heel strikes. They hang from a chest that
//! yaws but their swing is counted against the vertical. Root frame.

use glam::DQuat;

use crate::body::{ARMS, CHEST, CLAVICLES, FOREARMS, HANDS, HEAD, JOINT_COUNT, NECK, SPINE};
use crate::cadence::{Gait, UpperBodySwing};
use crate::pelvis::PelvisPose;
use crate::rotation::{about_x, about_y, about_z, share_of, wave};

/// The foremost hand comes this much before the trunk is turned farthest, share of the stride: opposite to the thigh.
const ARM_LEAD: f64 = 0.05;
/// The left arm swings farther than the right, right- or left-handed: of 334 adults walking at their own speed by some
/// 20 % in the mean (Killeen et al. 2018, *Sci. Rep.* 8, doi 10.1038/s41598-018-31151-9); each by this share.
const LEFT_ARM_SHARE: f64 = 0.10;
/// The elbow's greatest bend comes after the shoulder's, share of the stride.
const ELBOW_LAG: f64 = 0.04;
/// The trunk nods twice a stride, forward as each foot takes the load, radians.
const NOD_RAD: f64 = 0.012;
/// The chest dips towards the stance side by this share of the pelvis's list, radians.
const CHEST_LIST_SHARE: f64 = 0.60;
/// Shares of a turn's bank that chest and head take; the legs take what is left of it (`cadence::LEAN_ARM_M`).
const CHEST_BANK_SHARE: f64 = 0.90;
const HEAD_BANK_SHARE: f64 = 0.40;
/// Upper arms turn inward, so that the hands swing towards the midline, the more the elbow is bent: radians, and per
/// radian of the elbow.
const ARM_INWARD_RAD: f64 = 0.24;
const ARM_INWARD_PER_ELBOW: f64 = 0.13;
/// Shares of the lower and the middle spine in a twist: of the 45° to a side that people's trunks allow (AAOS, *Joint
/// Motion*, 1965), the lumbar vertebrae give a few, the upper thoracic ones most.
const SPINE_TWIST_SHARES: [f64; 2] = [1.0 / 9.0, 1.0 / 3.0];
/// Clavicles follow the arm by this share.
const CLAVICLE_SHARE: f64 = 0.12;
/// A relaxed wrist, radians.
const WRIST_RAD: f64 = 0.10;
/// The gaze falls a little, radians.
const GAZE_DOWN_RAD: f64 = 0.05;

/// Where chest, head and arms are at one moment, against the root's heading; radians.
#[derive(Clone, Copy, Debug)]
pub(crate) struct UpperBody {
    /// Yaw, left positive.
    pub(crate) chest_yaw_rad: f64,
    /// Forward pitch.
    pub(crate) chest_pitch_rad: f64,
    /// Left side up.
    pub(crate) chest_roll_rad: f64,
    /// Yaw, left positive.
    pub(crate) head_yaw_rad: f64,
    /// Left side up.
    pub(crate) head_roll_rad: f64,
    /// `[left, right]`.
    pub(crate) arms: [Arm; 2],
}

/// An arm, radians.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Arm {
    /// Forward from hanging.
    pub(crate) flexion_rad: f64,
    /// Out from hanging.
    pub(crate) out_rad: f64,
    /// Bend of the elbow.
    pub(crate) elbow_rad: f64,
}

/// Of a gait at a cycle phase (0 at the left heel strike); `style` is its own or a variation of it.
pub(crate) fn in_gait(gait: &Gait, style: &UpperBodySwing, cycle_phase: f64) -> UpperBody {
    let chest_wave = wave(cycle_phase - gait.yaw_peak);
    let list_wave = wave(cycle_phase - gait.mid_stance());
    UpperBody {
        chest_yaw_rad: style.chest_yaw_rad * chest_wave,
        chest_pitch_rad: style.lean_rad + NOD_RAD * wave(2.0 * cycle_phase - 0.2),
        chest_roll_rad: -CHEST_BANK_SHARE * style.bank_rad - CHEST_LIST_SHARE * gait.pelvis.list_rad * list_wave
            + style.side_lag_rad * 0.5 * (1.0 + wave(cycle_phase)),
        head_yaw_rad: style.look_rad,
        head_roll_rad: -HEAD_BANK_SHARE * style.bank_rad,
        arms: [(0.5, 1.0 + LEFT_ARM_SHARE), (0.0, 1.0 - LEFT_ARM_SHARE)].map(|(foremost, share)| {
            let since = cycle_phase - foremost - gait.yaw_peak + ARM_LEAD;
            Arm {
                flexion_rad: style.arm_mean_rad + share * style.arm_swing_rad * wave(since),
                out_rad: style.arm_out_rad,
                elbow_rad: style.elbow_rad + style.elbow_swing_rad * wave(since - ELBOW_LAG),
            }
        }),
    }
}

impl UpperBody {
    /// Writes the joints from spine to hands.
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

/// The spine's three joints, from pelvis to chest: bends are shared evenly, twists as they allow.
fn spine(whole: DQuat) -> [DQuat; 3] {
    let twist_rad = 2.0 * libm::atan2(whole.z, whole.w);
    let bend = share_of(whole * about_z(-twist_rad), 1.0 / 3.0);
    let [lower, middle] = [0, 1].map(|joint| bend * about_z(SPINE_TWIST_SHARES[joint] * twist_rad));
    [lower, middle, (lower * middle).inverse() * whole]
}

impl Arm {
    /// Rest is a T-pose: the arm is lowered, turned inward, then swung.
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

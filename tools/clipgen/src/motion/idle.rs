//! Standing at ease: even on both legs, or mostly on one, whose knee is nearly straight and whose hip is higher.
//!
//! Of 41 adults who stood at ease most stood unevenly at any time, with the weight in one of two preferred positions
//! (Prado-Rico and Duarte 2019, *Motor Control* 23); one stays there for minutes (Duarte and Zatsiorsky 1999, *Motor Control*
//! 3: a shift to the side every 199 ± 148 s). So a clip keeps its side, and a body changes it as it changes its clip. Within
//! a clip the body breathes 15 times a minute, sways and looks about. The feet never move; the hips move over them.
//! Amounts without a source are set by eye. Root frame: x forward, y left, z up, metres, radians.

use glam::{DQuat, DVec3};

use crate::body::ClipPose;
use crate::body::leg_ik::reach_m;
use crate::body::rotation::{about_x, about_z, wave};
use crate::body::skeleton::{ANKLE_HEIGHT_M, CLAVICLES, JOINT_COUNT};
use crate::motion::foot_roll::FootPlacement;
use crate::motion::pelvis::{PelvisPose, hip_m};
use crate::motion::stepping::set_leg;
use crate::motion::upper_body::{ArmPose, UpperBodyPose};
use crate::plan::{FRAME_RATE_HZ, SlowChange};

/// Breaths per second.
const BREATHS_HZ: f64 = 0.25;
/// Fastest of the slow changes, Hz: most of the sway of a standing body is slower.
const SWAY_HZ: f64 = 0.25;
/// Sway forward, root mean square, m.
const AHEAD_M: f64 = 0.004;
/// Sway to the side, root mean square, m.
const ASIDE_M: f64 = 0.003;
/// Flexion of a knee that bears the weight, rad: 5°.
const LOADED_KNEE_RAD: f64 = 0.087;
/// Height over which the hips pass from one bearing leg to the other, m.
const HANDOVER_M: f64 = 0.0008;
/// Displacement of the hips where the weight is on one leg, m: it bears four fifths.
const SHIFT_M: f64 = 0.065;
/// Rise of that leg's hip over the other, rad.
const LIST_RAD: f64 = 0.09;
/// Dip of the chest towards that leg, share of the rise.
const CHEST_DIP_SHARE: f64 = 0.4;
/// Distance of the ankles from the midline, m: feet a little wider than the hips.
const HALF_WIDTH_M: f64 = 0.105;
/// Ankles ahead of the hips, m: the weight is over the middle of the feet.
const ANKLE_X_M: f64 = -0.03;
/// Share of the gaze that the chest follows.
const CHEST_GAZE_SHARE: f64 = 0.15;

/// How a body stands in a clip. Pairs are `[left, right]`.
#[derive(Clone, Copy, Debug)]
pub(crate) struct StandingPlan {
    /// Frames of the loop.
    frames: usize,
    /// Position of the weight, from -1 (on the right leg) to 1 (on the left).
    weight: f64,
    /// Slow change of that position, root mean square.
    weight_change: f64,
    /// Position of each foot ahead of the usual one, m.
    ahead_m: [f64; 2],
    /// Direction of the toes outward, rad.
    toe_out_rad: [f64; 2],
    /// Flexion of the shoulders, rad.
    arm_rad: [f64; 2],
    /// Bend of the elbows, rad.
    elbow_rad: [f64; 2],
    /// Gaze to the side, root mean square, rad.
    gaze_rad: f64,
}

/// Even on both legs.
pub(crate) const EVEN: StandingPlan = StandingPlan {
    frames: 450,
    weight: 0.0,
    weight_change: 0.1,
    ahead_m: [0.0; 2],
    toe_out_rad: [0.16; 2],
    arm_rad: [0.0, 0.01],
    elbow_rad: [0.22, 0.19],
    gaze_rad: 0.10,
};
/// Mostly on the left leg; the right one is at ease, a little ahead and turned out.
pub(crate) const ON_LEFT: StandingPlan = StandingPlan {
    frames: 330,
    weight: 0.85,
    weight_change: 0.06,
    ahead_m: [0.0, 0.05],
    toe_out_rad: [0.12, 0.30],
    arm_rad: [-0.03, 0.03],
    elbow_rad: [0.16, 0.28],
    gaze_rad: 0.22,
};
/// Mostly on the right leg; the left one is at ease.
pub(crate) const ON_RIGHT: StandingPlan = StandingPlan {
    frames: 390,
    weight: -0.75,
    weight_change: 0.08,
    ahead_m: [0.035, 0.0],
    toe_out_rad: [0.26, 0.14],
    arm_rad: [0.02, -0.03],
    elbow_rad: [0.26, 0.17],
    gaze_rad: 0.20,
};

/// A body that stands as in the plan of a clip.
struct StandingBody<'a> {
    plan: &'a StandingPlan,
    change: SlowChange,
}

/// The frames of the clip of this name; the last is the first again.
pub(crate) fn idle_frames(name: &str, plan: &StandingPlan) -> Vec<ClipPose> {
    let waves = libm::round(SWAY_HZ * plan.frames as f64 / FRAME_RATE_HZ) as usize;
    let body = StandingBody { plan, change: SlowChange::of_clip(name, waves) };
    (0..=plan.frames).map(|frame| body.pose(frame as f64 / plan.frames as f64)).collect()
}

impl StandingBody<'_> {
    /// The pose at a share of the clip.
    fn pose(&self, share: f64) -> ClipPose {
        let breath = self.breath(share);
        let feet = [0, 1].map(|side| self.foot(side));
        let pelvis = self.pelvis(&feet, share);
        let mut rotations = [DQuat::IDENTITY; JOINT_COUNT];
        rotations[0] = pelvis.rotation;
        for (side, foot) in feet.iter().enumerate() {
            set_leg(&pelvis, foot, side, &mut rotations);
        }
        self.upper_body(share).write(&pelvis, &mut rotations);
        for (side, sign) in [1.0, -1.0].into_iter().enumerate() {
            // The shoulders rise with the breath.
            rotations[CLAVICLES[side]] = about_x(sign * 0.018 * breath) * rotations[CLAVICLES[side]];
        }
        ClipPose { hips_m: pelvis.hips_m, rotations }
    }

    /// Position of the weight, from -1 (on the right leg) to 1 (on the left).
    fn weight(&self, share: f64) -> f64 {
        self.plan.weight + self.plan.weight_change * self.change.at(0, share)
    }

    fn breath(&self, share: f64) -> f64 {
        let breaths = libm::round(BREATHS_HZ * self.plan.frames as f64 / FRAME_RATE_HZ);
        wave(breaths * share - 0.3)
    }

    fn foot(&self, side: usize) -> FootPlacement {
        let sign = if side == 0 { 1.0 } else { -1.0 };
        FootPlacement {
            ankle_m: DVec3::new(ANKLE_X_M + self.plan.ahead_m[side], sign * HALF_WIDTH_M, ANKLE_HEIGHT_M),
            yaw_rad: sign * self.plan.toe_out_rad[side],
            pitch_rad: 0.0,
            roll_rad: 0.0,
            toe_bend_rad: 0.0,
        }
    }

    /// The pelvis as high over the feet as the straighter leg lets it be.
    fn pelvis(&self, feet: &[FootPlacement; 2], share: f64) -> PelvisPose {
        let (weight, yaw_rad) = (self.weight(share), 0.012 * self.change.at(1, share));
        let (ahead_m, aside_m) = (AHEAD_M * self.change.at(2, share), ASIDE_M * self.change.at(3, share));
        let mut pelvis = PelvisPose {
            hips_m: DVec3::new(ahead_m, SHIFT_M * weight + aside_m, 0.0),
            rotation: about_z(yaw_rad) * about_x(LIST_RAD * weight),
            yaw_rad,
        };
        let reach_m = reach_m(LOADED_KNEE_RAD);
        let [left_m, right_m] = [0, 1].map(|side| {
            let to_ankle_m = feet[side].ankle_m - hip_m(&pelvis, side);
            to_ankle_m.z + libm::sqrt(reach_m * reach_m - to_ankle_m.truncate().length_squared())
        });
        pelvis.hips_m.z = 0.5 * (left_m + right_m - libm::hypot(left_m - right_m, 2.0 * HANDOVER_M));
        pelvis
    }

    fn upper_body(&self, share: f64) -> UpperBodyPose {
        let (breath, list_rad) = (self.breath(share), LIST_RAD * self.weight(share));
        let gaze_rad = self.plan.gaze_rad * self.change.at(4, share);
        UpperBodyPose {
            chest_yaw_rad: CHEST_GAZE_SHARE * gaze_rad,
            chest_pitch_rad: 0.030 - 0.012 * breath,
            chest_roll_rad: -CHEST_DIP_SHARE * list_rad,
            head_yaw_rad: gaze_rad,
            head_roll_rad: 0.2 * list_rad + 0.012 * self.change.at(5, share),
            arms: [0, 1].map(|side| ArmPose {
                flexion_rad: self.plan.arm_rad[side] + 0.012 * breath + 0.012 * self.change.at(6 + side as u64, share),
                out_rad: 0.13 + 0.008 * breath,
                elbow_rad: self.plan.elbow_rad[side] + 0.015 * breath + 0.02 * self.change.at(8 + side as u64, share),
            }),
        }
    }
}

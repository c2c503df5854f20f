//! Standing: breath, and the shift of the weight from foot to foot and back.
//!
//! Six seconds: two breaths (20 a minute, the upper end of rest) and one shift of the weight, both of which close on
//! themselves. The feet never move; the hips move over them. Root frame: x forward, y left, z up, metres, radians.

use glam::{DQuat, DVec3};

use crate::body::ClipPose;
use crate::body::rotation::{about_x, about_z, wave};
use crate::body::skeleton::{ANKLE_HEIGHT_M, CLAVICLES, HEIGHT_M, JOINT_COUNT};
use crate::motion::foot_roll::FootPlacement;
use crate::motion::pelvis::PelvisPose;
use crate::motion::stepping::set_leg;
use crate::motion::upper_body::{ArmPose, UpperBodyPose};

/// Period of the clip, frames.
const FRAMES: usize = 180;
/// Breaths per period.
const BREATHS: f64 = 2.0;
/// Distance of the ankles from the midline, m: feet a little wider than the hips.
const HALF_WIDTH_M: f64 = 0.105;
/// Ankles ahead of the hips, m: the weight is over the middle of the feet.
const ANKLE_X_M: f64 = -0.03;
/// Direction of the toes outward, rad.
const TOE_OUT_RAD: f64 = 0.16;
/// Height of the hips, m: knees flexed by some 8°.
const HIP_HEIGHT_M: f64 = 0.5265 * HEIGHT_M;

/// The frames of the clip; the last is the first again.
pub(crate) fn idle_frames() -> Vec<ClipPose> {
    (0..=FRAMES).map(|frame| pose(frame as f64 / FRAMES as f64)).collect()
}

/// The pose at a share of the period.
fn pose(shift: f64) -> ClipPose {
    let weight = wave(shift) + 0.15 * wave(2.0 * shift - 0.1);
    let breath = wave(BREATHS * shift - 0.3);
    let (list_rad, yaw_rad) = (0.022 * weight, 0.020 * wave(shift - 0.05));
    let pelvis = PelvisPose {
        hips_m: DVec3::new(0.004 * wave(2.0 * shift - 0.2), 0.022 * weight, HIP_HEIGHT_M),
        rotation: about_z(yaw_rad) * about_x(list_rad),
        yaw_rad,
    };
    let mut rotations = [DQuat::IDENTITY; JOINT_COUNT];
    rotations[0] = pelvis.rotation;
    for (side, sign) in [1.0, -1.0].into_iter().enumerate() {
        set_leg(&pelvis, &standing_foot(sign), side, &mut rotations);
    }
    upper_body(weight, breath, shift).write(&pelvis, &mut rotations);
    for (side, sign) in [1.0, -1.0].into_iter().enumerate() {
        // The shoulders rise with the breath.
        rotations[CLAVICLES[side]] = about_x(sign * 0.018 * breath) * rotations[CLAVICLES[side]];
    }
    ClipPose { hips_m: pelvis.hips_m, rotations }
}

fn standing_foot(sign: f64) -> FootPlacement {
    FootPlacement {
        ankle_m: DVec3::new(ANKLE_X_M, sign * HALF_WIDTH_M, ANKLE_HEIGHT_M),
        yaw_rad: sign * TOE_OUT_RAD,
        pitch_rad: 0.0,
        roll_rad: 0.0,
        toe_bend_rad: 0.0,
    }
}

fn upper_body(weight: f64, breath: f64, shift: f64) -> UpperBodyPose {
    UpperBodyPose {
        chest_yaw_rad: -0.020 * wave(shift - 0.05),
        chest_pitch_rad: 0.030 - 0.012 * breath,
        chest_roll_rad: -0.012 * weight,
        head_yaw_rad: 0.05 * wave(shift - 0.2),
        head_roll_rad: -0.006 * weight,
        arms: [1.0, -1.0].map(|sign| ArmPose {
            flexion_rad: 0.02 + 0.012 * breath + sign * 0.008 * weight,
            out_rad: 0.13 + 0.008 * breath,
            elbow_rad: 0.26 + 0.015 * breath,
        }),
    }
}

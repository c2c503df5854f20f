//! Standing: breathing, and the weight going from foot to foot and back.
//!
//! Six seconds: two breaths (20 a minute, the upper end of rest) and one shift of the weight, both of which close on
//! themselves. The feet never move; the hips move over them.

use glam::{DQuat, DVec3};

use crate::body::{ANKLE_HEIGHT_M, CLAVICLES, HEIGHT_M, JOINT_COUNT, Pose};
use crate::foot_roll::Foot;
use crate::pelvis::PelvisPose;
use crate::rotation::{about_x, about_z, wave};
use crate::stepping::write_leg;
use crate::upper_body::{Arm, UpperBody};

/// Frames of the clip's period.
const FRAMES: usize = 180;
/// Breaths in the period.
const BREATHS: f64 = 2.0;
/// Ankles from the midline: feet a little wider than the hips, m.
const HALF_WIDTH_M: f64 = 0.105;
/// Ankles behind the hips, so that the weight is over the middle of the feet, m.
const ANKLE_X_M: f64 = -0.03;
/// Toes outward, radians.
const TOE_OUT_RAD: f64 = 0.16;
/// Height of the hips: knees flexed by some 8°, m.
const HIP_HEIGHT_M: f64 = 0.5265 * HEIGHT_M;

/// The clip's frames; the last is the first again.
pub(crate) fn frames() -> Vec<Pose> {
    (0..=FRAMES).map(|frame| pose(frame as f64 / FRAMES as f64)).collect()
}

fn pose(shift: f64) -> Pose {
    let weight = wave(shift) + 0.15 * wave(2.0 * shift - 0.1);
    let breath = wave(BREATHS * shift - 0.3);
    let (list_rad, yaw_rad) = (0.022 * weight, 0.020 * wave(shift - 0.05));
    let pelvis = PelvisPose {
        place_m: DVec3::new(0.004 * wave(2.0 * shift - 0.2), 0.022 * weight, HIP_HEIGHT_M),
        rotation: about_z(yaw_rad) * about_x(list_rad),
        yaw_rad,
    };
    let mut rotations = [DQuat::IDENTITY; JOINT_COUNT];
    rotations[0] = pelvis.rotation;
    for (side, sign) in [1.0, -1.0].into_iter().enumerate() {
        write_leg(&pelvis, &standing_foot(sign), side, &mut rotations);
    }
    upper_body(weight, breath, shift).write(&pelvis, &mut rotations);
    for (side, sign) in [1.0, -1.0].into_iter().enumerate() {
        // Shoulders rise with the breath.
        rotations[CLAVICLES[side]] = about_x(sign * 0.018 * breath) * rotations[CLAVICLES[side]];
    }
    Pose { hips_m: pelvis.place_m, rotations }
}

fn standing_foot(sign: f64) -> Foot {
    Foot {
        ankle_m: DVec3::new(ANKLE_X_M, sign * HALF_WIDTH_M, ANKLE_HEIGHT_M),
        yaw_rad: sign * TOE_OUT_RAD,
        pitch_rad: 0.0,
        roll_rad: 0.0,
        toe_bend_rad: 0.0,
    }
}

fn upper_body(weight: f64, breath: f64, shift: f64) -> UpperBody {
    UpperBody {
        chest_yaw_rad: -0.020 * wave(shift - 0.05),
        chest_pitch_rad: 0.030 - 0.012 * breath,
        chest_roll_rad: -0.012 * weight,
        head_yaw_rad: 0.05 * wave(shift - 0.2),
        head_roll_rad: -0.006 * weight,
        arms: [1.0, -1.0].map(|sign| Arm {
            flexion_rad: 0.02 + 0.012 * breath + sign * 0.008 * weight,
            out_rad: 0.13 + 0.008 * breath,
            elbow_rad: 0.26 + 0.015 * breath,
        }),
    }
}

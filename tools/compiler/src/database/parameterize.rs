//! GaitCycle → MotionExample: (v_f, ω_t, ω_s) freed of gait noise, key times, slide.
//!
//! Snapping: an |ω_t| below 3 °/s is 0, and with it a small ω_s. What is snapped must not make planted feet slide, so a
//! small ω_s is taken out by turning the root frame onto the direction of travel: the body then walks straight with its
//! shoulders a few degrees off, as it did. The snapped turn is left to the feet: at most 3 °/s about a point some 15 cm
//! away, below 1 cm/s.

use std::f64::consts::PI;

use glam::DQuat;
use motiondb::diagnostic::{Diagnostic, Note};
use motiondb::motion::MotionExample;

use crate::cycle::foot_slide;
use crate::cycle::mean_stride::{GaitCycle, NamedCycle};
use crate::ground::arc::{Rates, rotation};
use crate::retarget::human_clip::HumanBody;

/// Slower turning is gait noise: 3 °/s.
const SNAPPED_TURN_RAD_S: f64 = 3.0 * PI / 180.0;
/// And so is a smaller side speed, m/s …
const SNAPPED_STRAFE_MPS: f64 = 0.1;
/// … of a body that goes somewhere: from here on the direction of travel is off the facing by 11° at most, m/s.
const GOING_MPS: f64 = 0.5;
/// Less than this is not worth a word: over 10 s of walking it shows as 10°, 30 cm.
const NOTICED_RAD_S: f64 = 1.0 * PI / 180.0;
const NOTICED_MPS: f64 = 0.03;

/// Takes gait noise out of a cycle's rates; reports what was taken, if it can be noticed.
pub(crate) fn snap(cycle: &mut GaitCycle) -> Vec<Diagnostic> {
    let found = cycle.rates;
    let mut snapped = Vec::new();
    if found.turn_rate_rad_s.abs() >= SNAPPED_TURN_RAD_S {
        return snapped;
    }
    cycle.rates.turn_rate_rad_s = 0.0;
    if found.turn_rate_rad_s.abs() > NOTICED_RAD_S {
        let turn_rate_rad_s = found.turn_rate_rad_s as f32;
        snapped.push(Diagnostic::Note(Note::TurnRateSnapped { turn_rate_rad_s, from_s: None }));
    }
    if found.strafe_mps.abs() < SNAPPED_STRAFE_MPS && found.speed_mps.abs() > GOING_MPS {
        face_along_travel(cycle);
        if found.strafe_mps.abs() > NOTICED_MPS {
            let strafe_mps = found.strafe_mps as f32;
            snapped.push(Diagnostic::Note(Note::StrafeSnapped { strafe_mps, from_s: None }));
        }
    }
    snapped
}

/// Turns the root frame so that the body moves straight forward or straight back.
fn face_along_travel(cycle: &mut GaitCycle) {
    let Rates { speed_mps, strafe_mps, turn_rate_rad_s } = cycle.rates;
    let off_rad = libm::atan(strafe_mps / speed_mps);
    for row in &mut cycle.rows {
        row.pelvis_m = (rotation(-off_rad) * row.pelvis_m.truncate()).extend(row.pelvis_m.z);
        row.rotations[0] = DQuat::from_rotation_z(-off_rad) * row.rotations[0];
    }
    let speed_mps = libm::copysign(libm::hypot(speed_mps, strafe_mps), speed_mps);
    cycle.rates = Rates { speed_mps, strafe_mps: 0.0, turn_rate_rad_s };
}

/// The example of a cycle.
pub(crate) fn example(named: &NamedCycle, body: &HumanBody) -> MotionExample {
    let cycle = &named.cycle;
    let (feet, slide) = (foot_slide::feet(cycle, body), foot_slide::measure(cycle, body));
    MotionExample {
        name: named.name.clone(),
        source: named.source,
        window_s: named.window_s.map(|second| second as f32),
        mirrored: named.mirrored,
        parameters: cycle.rates.to_parameters(),
        phase_map: cycle.phase_map,
        key_times_s: if cycle.steps { feet.key_times_s() } else { None },
        planted_slide_cm_s: slide.slide_cm_s as f32,
        planted_share: slide.planted_share as f32,
    }
}

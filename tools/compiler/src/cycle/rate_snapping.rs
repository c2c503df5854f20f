//! Snapping: frees the rates of a cycle from gait noise, so that noise makes no asymmetric velocity sets.
//!
//! A |ω_t| below 3 °/s becomes 0, and with it a small ω_s (definition "Example" of `docs/definitions.md`). What is snapped
//! must not make planted feet slide. So a small ω_s is removed by turning the root frame onto the direction of travel:
//! the body then walks straight with its shoulders a few degrees off, as it did. The snapped turn is left to the feet:
//! at most 3 °/s about a point some 15 cm away, below 1 cm/s. Root frame: metres, radians.

use std::f64::consts::PI;

use glam::DQuat;
use motiondb::diagnostic::{Diagnostic, Note};

use crate::cycle::gait_cycle::GaitCycle;
use crate::ground::root_arc::Rates;
use crate::ground::rotations::ground_rotation;

/// Turn rate below which turning is gait noise, rad/s: 3 °/s.
const SNAPPED_TURN_RAD_S: f64 = 3.0 * PI / 180.0;
/// Side speed below which it is gait noise of a body that travels, m/s.
const SNAPPED_STRAFE_MPS: f64 = 0.1;
/// The same as a share of the speed: a travel 5.7° off the facing. The greater of both limits counts.
const SNAPPED_STRAFE_SHARE: f64 = 0.1;
/// Speed from which a body travels, m/s: its direction of travel is then off the facing by 11° at most.
const TRAVELLING_MPS: f64 = 0.5;
/// Least snapped turn rate that is reported, rad/s: 1 °/s, 10° over 10 s of walking.
const REPORTED_TURN_RAD_S: f64 = 1.0 * PI / 180.0;
/// Least snapped side speed that is reported, m/s: 30 cm over 10 s of walking.
const REPORTED_STRAFE_MPS: f64 = 0.03;

/// Snaps the rates of a cycle; returns notes on what was removed, where it can be noticed.
pub(crate) fn snap_rates(cycle: &mut GaitCycle) -> Vec<Diagnostic> {
    let measured = cycle.rates;
    let mut notes = Vec::new();
    if measured.turn_rate_rad_s.abs() >= SNAPPED_TURN_RAD_S {
        return notes;
    }
    cycle.rates.turn_rate_rad_s = 0.0;
    if measured.turn_rate_rad_s.abs() > REPORTED_TURN_RAD_S {
        let turn_rate_rad_s = measured.turn_rate_rad_s as f32;
        notes.push(Diagnostic::Note(Note::TurnRateSnapped { turn_rate_rad_s, from_s: None }));
    }
    let noise_mps = SNAPPED_STRAFE_MPS.max(SNAPPED_STRAFE_SHARE * measured.speed_mps.abs());
    if measured.strafe_mps.abs() < noise_mps && measured.speed_mps.abs() > TRAVELLING_MPS {
        face_along_travel(cycle);
        if measured.strafe_mps.abs() > REPORTED_STRAFE_MPS {
            let strafe_mps = measured.strafe_mps as f32;
            notes.push(Diagnostic::Note(Note::StrafeSnapped { strafe_mps, from_s: None }));
        }
    }
    notes
}

/// Turns the root frame so that the body moves straight forward or straight back.
fn face_along_travel(cycle: &mut GaitCycle) {
    let Rates { speed_mps, strafe_mps, turn_rate_rad_s } = cycle.rates;
    let off_rad = libm::atan(strafe_mps / speed_mps);
    for row in &mut cycle.rows {
        row.pelvis_m = (ground_rotation(-off_rad) * row.pelvis_m.truncate()).extend(row.pelvis_m.z);
        row.rotations[0] = DQuat::from_rotation_z(-off_rad) * row.rotations[0];
    }
    let speed_mps = libm::copysign(libm::hypot(speed_mps, strafe_mps), speed_mps);
    cycle.rates = Rates { speed_mps, strafe_mps: 0.0, turn_rate_rad_s };
}

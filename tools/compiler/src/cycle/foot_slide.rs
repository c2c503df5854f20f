//! Planted-foot slide of a cycle, measured as in the database ([`motiondb::quality::planted_feet`]), and what to think of it.

use glam::DVec3;
use motiondb::diagnostic::{Diagnostic, Unfit, Warning};
use motiondb::quality::example_quality;
use motiondb::quality::planted_feet::{self, CycleFeet, FootSlide};
use motiondb::validate;

use crate::cycle::mean_stride::GaitCycle;
use crate::retarget::human_clip::{HumanBody, HumanJoints};

/// A foot planted for less of the cycle than in a sprint is worth a warning.
const SUSPECT_SHARE: f64 = 0.2;
/// More slide than this, and than this share of the body's speed, is no stance at all: blended into a crowd it drags
/// all feet. Noisy captures: 18 cm/s; hand-keyed runs: 7 %.
const EXCESSIVE_SLIDE_CM_S: f64 = 25.0;
const EXCESSIVE_SLIDE_SHARE: f64 = 0.2;
/// Nor is there one where feet are planted for less than this share of the cycle; sprinters' are for 0.22.
const NO_STANCE_SHARE: f64 = 0.14;

/// Slide and planted share of both feet, the cycle repeated along its arc.
pub(crate) fn measure(cycle: &GaitCycle, body: &HumanBody) -> FootSlide {
    let rates = cycle.rates;
    let velocity = DVec3::new(rates.speed_mps, rates.turn_rate_rad_s, rates.strafe_mps);
    planted_feet::foot_slide(&feet(cycle, body), velocity)
}

/// The feet of a cycle as the database will have them: whether a foot is planted is read from contacts as they are
/// stored.
pub(crate) fn feet(cycle: &GaitCycle, body: &HumanBody) -> CycleFeet {
    let joints: Vec<HumanJoints> = cycle.rows.iter().map(|row| row.forward_kinematics(body)).collect();
    CycleFeet {
        points_m: [0, 1].map(|side| joints.iter().map(|joints| joints.measured_points_m(body, side)).collect()),
        contacts: [0, 1].map(|side| cycle.contacts.iter().map(|contact| f64::from(contact[side] as f32)).collect()),
        phase_map: cycle.phase_map,
    }
}

/// Why a cycle shows no stance that a crowd could be made of, if so; or one that contradicts its landmarks or its root.
pub(crate) fn excess(cycle: &GaitCycle, body: &HumanBody) -> Option<Unfit> {
    let FootSlide { slide_cm_s, planted_share } = measure(cycle, body);
    let speed_cm_s = 100.0 * libm::hypot(cycle.rates.speed_mps, cycle.rates.strafe_mps);
    if planted_share < NO_STANCE_SHARE {
        return Some(Unfit::FeetHardlyPlanted { planted_share: planted_share as f32 });
    }
    if slide_cm_s > EXCESSIVE_SLIDE_CM_S.max(EXCESSIVE_SLIDE_SHARE * speed_cm_s) {
        return Some(Unfit::FeetSlide { slide_cm_s: slide_cm_s as f32 });
    }
    validate::contradiction(&feet(cycle, body), cycle.rates.to_parameters())
}

/// Warnings for a cycle whose feet are no model of standing on the ground.
pub(crate) fn lint(cycle: &GaitCycle, body: &HumanBody) -> Vec<Diagnostic> {
    let FootSlide { slide_cm_s, planted_share } = measure(cycle, body);
    let slide = Warning::FeetSlide { slide_cm_s: slide_cm_s as f32, from_s: None };
    let share = Warning::FeetHardlyPlanted { planted_share: planted_share as f32, from_s: None };
    let found = [(relative_slide(cycle, body) > 1.0, slide), (planted_share < SUSPECT_SHARE, share)];
    found.into_iter().filter(|(is_so, _)| *is_so).map(|(_, warning)| Diagnostic::Warning(warning)).collect()
}

/// The slide of a cycle over that from which on it is suspect.
pub(crate) fn relative_slide(cycle: &GaitCycle, body: &HumanBody) -> f64 {
    let speed_mps = libm::hypot(cycle.rates.speed_mps, cycle.rates.strafe_mps);
    measure(cycle, body).slide_cm_s / f64::from(example_quality::suspect_slide_cm_s(speed_mps as f32))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::ground::arc::Rates;
    use crate::synthetic::{self, Walk, cycle_of};

    #[test]
    fn feet_that_stand_still_do_not_slide_and_a_wrong_root_speed_is_their_slide() {
        let clip = synthetic::walk("walk", Walk::default());
        let mut cycle = cycle_of(&clip);
        let still = measure(&cycle, &clip.body);
        assert!(still.slide_cm_s < 0.5, "{still:?}");
        assert!((still.planted_share - 0.6).abs() < 0.06, "{still:?}");
        cycle.rates = Rates { speed_mps: cycle.rates.speed_mps + 0.1, ..cycle.rates };
        assert!((measure(&cycle, &clip.body).slide_cm_s - 10.0).abs() < 0.5);
    }
}

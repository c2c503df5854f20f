//! Planted-foot slide of a cycle, measured as in the database, and the verdicts on it.
//!
//! Definition "Planted-foot slide" of `docs/definitions.md`; measure: [`motiondb::quality::planted_feet`]. Cycles are
//! in the root frame, which moves along its arc: metres, seconds.

use glam::DVec3;
use motiondb::diagnostic::{Diagnostic, Unfit, Warning};
use motiondb::quality::example_quality;
use motiondb::quality::planted_feet::{self, CycleFeet, FootSlide};
use motiondb::validate;

use crate::cycle::gait_cycle::GaitCycle;
use crate::ground::root_arc::Rates;
use crate::retarget::human_clip::{HumanBody, HumanJoints};

/// Slide above which a cycle shows no stance, cm/s on the performer: blended into a crowd it drags all feet. Noisy
/// captures reach 18.
const EXCESSIVE_SLIDE_CM_S: f64 = 25.0;
/// The same as a share of the body's speed; the greater of both limits counts. Hand-keyed runs reach 0.07.
const EXCESSIVE_SLIDE_SHARE: f64 = 0.2;
/// Share of the cycle below which a planted foot is not a stance; sprinters' feet are planted for 0.22.
const NO_STANCE_SHARE: f64 = 0.14;

/// Slide and planted share of both feet, the cycle repeated along its arc.
pub(crate) fn foot_slide(cycle: &GaitCycle, body: &HumanBody) -> FootSlide {
    let rates = cycle.rates;
    let velocity = DVec3::new(rates.speed_mps, rates.turn_rate_rad_s, rates.strafe_mps);
    planted_feet::foot_slide(&cycle_feet(cycle, body), velocity)
}

/// Sets the velocity of the root of a cycle whose clip is in place: its planted feet stand as still as any velocity lets
/// them. The speed that import found serves to find the contacts; on the target's feet another one may fit better.
pub(crate) fn follow_feet(cycle: &mut GaitCycle, body: &HumanBody) {
    let found = planted_feet::implied_velocity_mps(&cycle_feet(cycle, body), cycle.rates.turn_rate_rad_s);
    if let Some(velocity_mps) = found {
        cycle.rates = Rates { speed_mps: velocity_mps.x, strafe_mps: velocity_mps.y, ..cycle.rates };
    }
}

/// The feet of a cycle as the database stores them: contacts are rounded to f32.
pub(crate) fn cycle_feet(cycle: &GaitCycle, body: &HumanBody) -> CycleFeet {
    let joints: Vec<HumanJoints> = cycle.rows.iter().map(|row| row.forward_kinematics(body)).collect();
    CycleFeet {
        points_m: [0, 1].map(|side| joints.iter().map(|joints| joints.measured_points_m(body, side)).collect()),
        contacts: [0, 1].map(|side| cycle.contacts.iter().map(|contact| f64::from(contact[side] as f32)).collect()),
        phase_map: cycle.phase_map,
    }
}

/// Why the feet of a cycle make it unfit, if they do: no stance, or contacts that contradict its landmarks or its root.
/// The body is `growth` times as large as the performer. Slide is judged at the performer's size, so that the verdict
/// does not depend on the other clips of the set.
pub(crate) fn unfit_feet(cycle: &GaitCycle, body: &HumanBody, growth: f64, slide: &FootSlide) -> Option<Unfit> {
    let FootSlide { slide_cm_s, planted_share } = *slide;
    let speed_cm_s = 100.0 * cycle.rates.speed_over_ground_mps();
    if planted_share < NO_STANCE_SHARE {
        return Some(Unfit::FeetHardlyPlanted { planted_share: planted_share as f32 });
    }
    if slide_cm_s > (growth * EXCESSIVE_SLIDE_CM_S).max(EXCESSIVE_SLIDE_SHARE * speed_cm_s) {
        return Some(Unfit::FeetSlide { slide_cm_s: slide_cm_s as f32 });
    }
    validate::contradiction(&cycle_feet(cycle, body), cycle.rates.to_parameters())
}

/// Warnings for a cycle whose feet slide or are hardly planted.
pub(crate) fn foot_warnings(rates: &Rates, slide: &FootSlide) -> Vec<Diagnostic> {
    let FootSlide { slide_cm_s, planted_share } = *slide;
    let (_, [least_share, _]) = example_quality::usual_planted_share(rates.speed_over_ground_mps() as f32);
    let slides = Warning::FeetSlide { slide_cm_s: slide_cm_s as f32, from_s: None };
    let hardly_planted = Warning::FeetHardlyPlanted { planted_share: planted_share as f32, from_s: None };
    let found =
        [(relative_slide(rates, slide) > 1.0, slides), (planted_share < f64::from(least_share), hardly_planted)];
    found.into_iter().filter(|(is_so, _)| *is_so).map(|(_, warning)| Diagnostic::Warning(warning)).collect()
}

/// Slide, divided by the least suspect slide at this speed.
pub(crate) fn relative_slide(rates: &Rates, slide: &FootSlide) -> f64 {
    slide.slide_cm_s / f64::from(example_quality::suspect_slide_cm_s(rates.speed_over_ground_mps() as f32))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::synthetic::{self, SyntheticWalk, cycle_of};

    #[test]
    fn standing_feet_do_not_slide() {
        let clip = synthetic::walk("walk", SyntheticWalk::default());
        let still = foot_slide(&cycle_of(&clip), &clip.body);
        assert!(still.slide_cm_s < 0.5, "{still:?}");
        assert!((still.planted_share - 0.6).abs() < 0.06, "{still:?}");
    }

    #[test]
    fn a_wrong_root_speed_is_slide() {
        let clip = synthetic::walk("walk", SyntheticWalk::default());
        let mut cycle = cycle_of(&clip);
        cycle.rates.speed_mps += 0.1;
        assert!((foot_slide(&cycle, &clip.body).slide_cm_s - 10.0).abs() < 0.5);
    }

    #[test]
    fn a_walk_needs_more_stance_than_a_run() {
        let slide = FootSlide { slide_cm_s: 2.0, planted_share: 0.25 };
        let warnings = |speed_mps: f64| foot_warnings(&Rates { speed_mps, ..Rates::default() }, &slide).len();
        assert_eq!([1.2, 4.0].map(warnings), [1, 0]);
    }

    #[test]
    fn the_root_of_a_clip_in_place_follows_its_feet() {
        let clip = synthetic::walk("walk", SyntheticWalk::at(1.2, 0.1, 0.2));
        let mut cycle = cycle_of(&clip);
        let exact = cycle.rates;
        (cycle.rates.speed_mps, cycle.rates.strafe_mps) = (1.5, 0.0);
        follow_feet(&mut cycle, &clip.body);
        let (found, exact) = (cycle.rates.to_parameters().to_vec3(), exact.to_parameters().to_vec3());
        assert!(found.distance(exact) < 5e-3, "{found}, not {exact}");
    }

    #[test]
    fn slide_is_judged_on_the_performer() {
        let clip = synthetic::walk("walk", SyntheticWalk::default());
        let mut cycle = cycle_of(&clip);
        cycle.rates.speed_mps += 0.35;
        let slide = foot_slide(&cycle, &clip.body);
        let slides = |growth: f64| {
            let unfit = unfit_feet(&cycle, &clip.body, growth, &slide);
            matches!(unfit, Some(Unfit::FeetSlide { .. }))
        };
        assert!(slides(1.0) && slides(0.5), "{slide:?}");
        assert!(!slides(2.4), "{slide:?}");
    }
}

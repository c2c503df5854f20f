//! Planted-foot slide of a cycle (`definitions.md`): mean horizontal speed of the contact point over the middle 80 % of
//! each contact.
//!
//! A foot is planted where its contact row is at least ½; its contact point is the lowest of three, as in
//! [`crate::contacts`].

use glam::DVec3;
use motiondb::motion_db::PHASE_COUNT;

use crate::arc::Arc;
use crate::contacts::lowest_points;
use crate::cycle::GaitCycle;
use crate::human_clip::HumanBody;

/// Cut from each end of a contact, as a share of it.
const TRIMMED_SHARE: f64 = 0.1;
/// More slide than this is worth a warning: clean walks have 3–8 cm/s, runs 6 cm/s more for each m/s
/// (`definitions.md`).
const SUSPECT_SLIDE_CM_S: f64 = 12.0;
const SUSPECT_SLIDE_CM_S_PER_MPS: f64 = 8.0;
/// And so is a foot planted for less of the cycle than in a sprint.
const SUSPECT_SHARE: f64 = 0.2;
/// More slide than this, and than this share of the body's speed, is no stance at all: blended into a crowd it drags
/// all feet. Noisy captures: 18 cm/s; hand-keyed runs: 7 % (`definitions.md`).
const EXCESSIVE_SLIDE_CM_S: f64 = 25.0;
const EXCESSIVE_SLIDE_SHARE: f64 = 0.2;
/// Nor is there one where feet are planted for less than this share of the cycle; sprinters' are for 0.22.
const NO_STANCE_SHARE: f64 = 0.14;
/// A foot is planted from this contact on.
pub const PLANTED: f64 = 0.5;

/// What the planted feet of a cycle do.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct FootSlide {
    /// Mean speed of planted contact points, cm/s.
    pub slide_cm_s: f64,
    /// Share of the cycle that a foot is planted, mean of both.
    pub planted_share: f64,
}

/// Slide and planted share of both feet, the cycle repeated along its arc.
pub fn measure(cycle: &GaitCycle, body: &HumanBody) -> FootSlide {
    let (mut speeds, mut planted_rows) = (Vec::new(), 0);
    for side in 0..2 {
        let feet: Vec<[DVec3; 3]> =
            cycle.rows.iter().map(|row| row.forward_kinematics(body).measured_points_m(body, side)).collect();
        let lowest = lowest_points(&feet, PHASE_COUNT);
        for (start, length) in contacts(cycle, side) {
            planted_rows += length;
            let trim = (TRIMMED_SHARE * length as f64 + 0.5) as usize;
            for row in start + trim..start + length - trim {
                speeds.push(point_speed_mps(cycle, &feet, lowest[row % PHASE_COUNT].0, row as isize));
            }
        }
    }
    let slide_cm_s = if speeds.is_empty() { 0.0 } else { 100.0 * speeds.iter().sum::<f64>() / speeds.len() as f64 };
    FootSlide { slide_cm_s, planted_share: planted_rows as f64 / (2 * PHASE_COUNT) as f64 }
}

/// Why a cycle shows no stance that a crowd could be made of, if so.
pub fn excess(cycle: &GaitCycle, body: &HumanBody) -> Option<String> {
    let FootSlide { slide_cm_s, planted_share } = measure(cycle, body);
    let speed_cm_s = 100.0 * libm::hypot(cycle.rates.speed_mps, cycle.rates.strafe_mps);
    if planted_share < NO_STANCE_SHARE {
        return Some(format!("its feet are planted for only {:.0} % of the cycle", 100.0 * planted_share));
    }
    (slide_cm_s > EXCESSIVE_SLIDE_CM_S.max(EXCESSIVE_SLIDE_SHARE * speed_cm_s))
        .then(|| format!("its planted feet slide by {slide_cm_s:.0} cm/s"))
}

/// Warnings for a cycle whose feet are no model of standing on the ground.
pub fn lint(cycle: &GaitCycle, body: &HumanBody) -> Vec<String> {
    let FootSlide { slide_cm_s, planted_share } = measure(cycle, body);
    let speed_mps = libm::hypot(cycle.rates.speed_mps, cycle.rates.strafe_mps);
    let mut warnings = Vec::new();
    if slide_cm_s > SUSPECT_SLIDE_CM_S + SUSPECT_SLIDE_CM_S_PER_MPS * speed_mps {
        warnings.push(format!("planted feet slide by {slide_cm_s:.0} cm/s"));
    }
    if planted_share < SUSPECT_SHARE {
        warnings.push(format!("feet are planted for only {:.0} % of the cycle", 100.0 * planted_share));
    }
    warnings
}

/// First row and length of each contact of one foot; one that passes phase 0 counts once.
pub fn contacts(cycle: &GaitCycle, side: usize) -> Vec<(usize, usize)> {
    let planted = |row: usize| cycle.contacts[row % PHASE_COUNT][side] >= PLANTED;
    if (0..PHASE_COUNT).all(planted) {
        return vec![(0, PHASE_COUNT)];
    }
    (0..PHASE_COUNT)
        .filter(|&row| planted(row) && !planted(row + PHASE_COUNT - 1))
        .map(|row| (row, (row..).take_while(|&row| planted(row)).count()))
        .collect()
}

/// Horizontal world speed of one contact point at a row.
fn point_speed_mps(cycle: &GaitCycle, feet: &[[DVec3; 3]], point: usize, row: isize) -> f64 {
    let arc = Arc { rates: cycle.rates, ..Arc::default() };
    let at = |row: isize| {
        let time_s = cycle.row_time_s(row);
        (arc.to_world(feet[GaitCycle::wrap(row)][point], time_s), time_s)
    };
    let ((before_m, before_s), (after_m, after_s)) = (at(row - 1), at(row + 1));
    (after_m - before_m).truncate().length() / (after_s - before_s)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::arc::Rates;
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

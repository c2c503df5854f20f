//! Mirrored examples: left and right exchanged, half a cycle later.
//!
//! A turn or a side-step serves both sides unless the set has its counterpart (definition "Mirroring" of
//! `docs/definitions.md`).

use std::f64::consts::PI;

use crate::cycle::mirrored::{mirrored_cycle, mirrored_rates};
use crate::ground::root_arc::Rates;
use crate::input::unique_names;
use crate::retarget::human_clip::Choices;
use crate::select::named_cycles::{NamedCycle, SelectedCycles};

/// Least turn rate of an example that is mirrored, rad/s: 10 °/s.
const TURN_MIN_RAD_S: f64 = 10.0 * PI / 180.0;
/// Least side speed of an example that is mirrored, m/s.
const STRAFE_MIN_MPS: f64 = 0.15;
/// Greatest difference in speed of a counterpart from the mirrored rates, m/s.
const COUNTERPART_SPEED_MPS: f64 = 0.15;
/// Greatest difference in turn rate of a counterpart from the mirrored rates, rad/s: 10 °/s.
const COUNTERPART_TURN_RAD_S: f64 = 10.0 * PI / 180.0;
/// Both as a share of the mirrored rates; the greater of both limits counts.
const COUNTERPART_SHARE: f64 = 0.15;

/// Adds the mirrors that a manifest requests of cycles that step, else those of one-sided cycles without a counterpart.
pub(crate) fn with_mirrors(mut selected: SelectedCycles) -> SelectedCycles {
    let cycles = &mut selected.cycles;
    let rates: Vec<Rates> = cycles.iter().map(|named| named.cycle.rates).collect();
    let mirrors: Vec<NamedCycle> = cycles
        .iter()
        .filter(|named| named.cycle.steps)
        .filter(|named| named.choices.mirror.unwrap_or_else(|| needs_mirror(&named.cycle.rates, &rates)))
        .map(|named| NamedCycle {
            name: format!("{}_mirrored", named.name),
            mirrored: true,
            choices: Choices::default(),
            cycle: mirrored_cycle(&named.cycle),
            ..*named
        })
        .collect();
    cycles.extend(mirrors);
    unique_names::make_unique(cycles.iter_mut().map(|cycle| &mut cycle.name));
    selected
}

/// Whether an example of a set needs a mirror: it is one-sided, and the set has no counterpart.
fn needs_mirror(rates: &Rates, set: &[Rates]) -> bool {
    let one_sided = rates.turn_rate_rad_s.abs() > TURN_MIN_RAD_S || rates.strafe_mps.abs() > STRAFE_MIN_MPS;
    one_sided && !set.iter().any(|other| is_counterpart(&mirrored_rates(rates), other))
}

fn is_counterpart(mirrored: &Rates, other: &Rates) -> bool {
    let speed = libm::hypot(mirrored.speed_mps, mirrored.strafe_mps);
    let speed_limit = COUNTERPART_SPEED_MPS.max(COUNTERPART_SHARE * speed);
    let turn_limit = COUNTERPART_TURN_RAD_S.max(COUNTERPART_SHARE * mirrored.turn_rate_rad_s.abs());
    (mirrored.speed_mps - other.speed_mps).abs() <= speed_limit
        && (mirrored.strafe_mps - other.strafe_mps).abs() <= speed_limit
        && (mirrored.turn_rate_rad_s - other.turn_rate_rad_s).abs() <= turn_limit
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn examples_with_a_counterpart_need_no_mirror() {
        let left = Rates { speed_mps: 0.8, turn_rate_rad_s: 0.8, strafe_mps: 0.0 };
        let right = Rates { speed_mps: 0.85, turn_rate_rad_s: -0.75, strafe_mps: 0.02 };
        let straight = Rates { speed_mps: 1.2, turn_rate_rad_s: 0.1, strafe_mps: 0.1 };
        assert!(needs_mirror(&left, &[left, straight]));
        assert!(!needs_mirror(&left, &[left, right, straight]));
        assert!(!needs_mirror(&straight, &[left, straight]));
    }
}

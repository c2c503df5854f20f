//! Mirrored examples: left and right exchanged, half a cycle later.
//!
//! A turn or a side-step serves both sides unless the set has its counterpart (definition "Mirroring" of
//! `docs/definitions.md`). Root frame: the mirror is the plane y = 0.

use std::f64::consts::PI;

use glam::{DQuat, DVec3};
use motiondb::body::{JOINT_COUNT, Joint};
use motiondb::motion::{PHASE_COUNT, PhaseMap};

use crate::cycle::gait_cycle::GaitCycle;
use crate::ground::root_arc::Rates;
use crate::input::unique_names;
use crate::retarget::human_clip::{Choices, HumanPose};
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

/// Adds the mirrors that a manifest requests, else those of one-sided cycles without a counterpart.
pub(crate) fn with_mirrors(mut selected: SelectedCycles) -> SelectedCycles {
    let cycles = &mut selected.cycles;
    let rates: Vec<Rates> = cycles.iter().map(|named| named.cycle.rates).collect();
    let mirrors: Vec<NamedCycle> = cycles
        .iter()
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

/// Rates of the mirrored motion.
fn mirrored_rates(rates: &Rates) -> Rates {
    // 0 − x, so that 0 stays 0 and does not become −0.
    Rates { turn_rate_rad_s: 0.0 - rates.turn_rate_rad_s, strafe_mps: 0.0 - rates.strafe_mps, ..*rates }
}

/// The mirrored cycle; its phase 0 is the original's left mid-stance.
fn mirrored_cycle(cycle: &GaitCycle) -> GaitCycle {
    let half_a_cycle_later = |row: usize| (row + PHASE_COUNT / 2) % PHASE_COUNT;
    GaitCycle {
        rows: (0..PHASE_COUNT).map(|row| mirrored_pose(&cycle.rows[half_a_cycle_later(row)])).collect(),
        contacts: (0..PHASE_COUNT)
            .map(|row| {
                let [left, right] = cycle.contacts[half_a_cycle_later(row)];
                [right, left]
            })
            .collect(),
        phase_map: PhaseMap { left_share: 1.0 - cycle.phase_map.left_share, ..cycle.phase_map },
        rates: mirrored_rates(&cycle.rates),
        steps: cycle.steps,
    }
}

/// The pose in the mirror y = 0 of its frame. The list of extra joints keeps its order: each is then the mirrored joint.
pub(crate) fn mirrored_pose(pose: &HumanPose) -> HumanPose {
    let mut rotations = [DQuat::IDENTITY; JOINT_COUNT];
    for joint in Joint::ALL {
        rotations[joint.mirrored().index()] = mirrored_rotation(pose.rotations[joint.index()]);
    }
    let extra = pose.extra.iter().copied().map(mirrored_rotation).collect();
    HumanPose { pelvis_m: pose.pelvis_m * DVec3::new(1.0, -1.0, 1.0), rotations, extra }
}

/// The rotation in the mirror y = 0 of its frame.
pub(crate) fn mirrored_rotation(DQuat { x, y, z, w }: DQuat) -> DQuat {
    DQuat::from_xyzw(-x, y, -z, w)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::synthetic::{self, SyntheticWalk, cycle_of};

    #[test]
    fn a_mirror_of_a_mirror_is_the_original() {
        let walk = SyntheticWalk { left_share: 0.54, ..SyntheticWalk::at(0.6, 0.9, -0.2) };
        let cycle = cycle_of(&synthetic::walk("turn", walk));
        let twice = mirrored_cycle(&mirrored_cycle(&cycle));
        assert_eq!(twice.rates, cycle.rates);
        assert_eq!(twice.contacts, cycle.contacts);
        assert_eq!(twice.rows, cycle.rows);
    }

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

//! Mirrored examples: left and right exchanged, half a cycle later.
//!
//! A turn or a side-step serves both ways unless the set has its counterpart. Root frame: the mirror is the plane y =
//! 0.

use std::f64::consts::PI;

use glam::{DQuat, DVec3};
use motiondb::body::{JOINT_COUNT, Joint};
use motiondb::motion::{PHASE_COUNT, PhaseMap};

use crate::cycle::mean_stride::GaitCycle;
use crate::ground::arc::Rates;
use crate::retarget::human_clip::HumanPose;

/// An example that turns or side-steps by more than this is worth a mirror: 10 °/s, 0.15 m/s.
const TURN_MIN_RAD_S: f64 = 10.0 * PI / 180.0;
const STRAFE_MIN_MPS: f64 = 0.15;
/// Another example this near to the mirrored rates is the counterpart: m/s (or this share of the speed), rad/s (or this
/// share).
const COUNTERPART_SPEED_MPS: f64 = 0.15;
const COUNTERPART_TURN_RAD_S: f64 = 10.0 * PI / 180.0;
const COUNTERPART_SHARE: f64 = 0.15;

/// Whether an example is mirrored in a set of examples, itself among them.
pub(crate) fn wants_mirror(rates: &Rates, set: &[Rates]) -> bool {
    let one_sided = rates.turn_rate_rad_s.abs() > TURN_MIN_RAD_S || rates.strafe_mps.abs() > STRAFE_MIN_MPS;
    one_sided && !set.iter().any(|other| is_counterpart(&mirrored_rates(rates), other))
}

fn is_counterpart(wanted: &Rates, other: &Rates) -> bool {
    let speed = libm::hypot(wanted.speed_mps, wanted.strafe_mps);
    let speed_limit = COUNTERPART_SPEED_MPS.max(COUNTERPART_SHARE * speed);
    let turn_limit = COUNTERPART_TURN_RAD_S.max(COUNTERPART_SHARE * wanted.turn_rate_rad_s.abs());
    (wanted.speed_mps - other.speed_mps).abs() <= speed_limit
        && (wanted.strafe_mps - other.strafe_mps).abs() <= speed_limit
        && (wanted.turn_rate_rad_s - other.turn_rate_rad_s).abs() <= turn_limit
}

/// Rates of the mirrored motion.
pub(crate) fn mirrored_rates(rates: &Rates) -> Rates {
    // 0 − x, so that 0 stays 0 and does not become −0.
    Rates { turn_rate_rad_s: 0.0 - rates.turn_rate_rad_s, strafe_mps: 0.0 - rates.strafe_mps, ..*rates }
}

/// The mirrored cycle; its phase 0 is the original's left mid-stance.
pub(crate) fn mirror(cycle: &GaitCycle) -> GaitCycle {
    let half_a_cycle_on = |row: usize| (row + PHASE_COUNT / 2) % PHASE_COUNT;
    GaitCycle {
        rows: (0..PHASE_COUNT).map(|row| mirror_pose(&cycle.rows[half_a_cycle_on(row)])).collect(),
        contacts: (0..PHASE_COUNT)
            .map(|row| {
                let [left, right] = cycle.contacts[half_a_cycle_on(row)];
                [right, left]
            })
            .collect(),
        phase_map: PhaseMap { left_share: 1.0 - cycle.phase_map.left_share, ..cycle.phase_map },
        rates: mirrored_rates(&cycle.rates),
        steps: cycle.steps,
    }
}

/// The pose in the mirror y = 0.
pub(crate) fn mirror_pose(pose: &HumanPose) -> HumanPose {
    let mut rotations = [DQuat::IDENTITY; JOINT_COUNT];
    for joint in Joint::ALL {
        let DQuat { x, y, z, w } = pose.rotations[joint.index()];
        rotations[joint.mirrored().index()] = DQuat::from_xyzw(-x, y, -z, w);
    }
    HumanPose { pelvis_m: pose.pelvis_m * DVec3::new(1.0, -1.0, 1.0), rotations }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::synthetic::{self, Walk, cycle_of};

    #[test]
    fn a_mirror_of_a_mirror_is_the_original() {
        let rates = Rates { speed_mps: 0.6, turn_rate_rad_s: 0.9, strafe_mps: -0.2 };
        let cycle = cycle_of(&synthetic::walk("turn", Walk { rates, left_share: 0.54, ..Walk::default() }));
        let twice = mirror(&mirror(&cycle));
        assert_eq!(twice.rates, cycle.rates);
        assert_eq!(twice.contacts, cycle.contacts);
        for (back, row) in twice.rows.iter().zip(&cycle.rows) {
            assert_eq!(back, row);
        }
    }

    #[test]
    fn a_counterpart_makes_the_mirror_needless() {
        let left = Rates { speed_mps: 0.8, turn_rate_rad_s: 0.8, strafe_mps: 0.0 };
        let right = Rates { speed_mps: 0.85, turn_rate_rad_s: -0.75, strafe_mps: 0.02 };
        let straight = Rates { speed_mps: 1.2, turn_rate_rad_s: 0.1, strafe_mps: 0.1 };
        assert!(wants_mirror(&left, &[left, straight]));
        assert!(!wants_mirror(&left, &[left, right, straight]));
        assert!(!wants_mirror(&straight, &[left, straight]));
    }
}

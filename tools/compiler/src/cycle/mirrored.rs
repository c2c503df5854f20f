//! Mirror images of poses and cycles: left and right exchanged. A frame's mirror is its plane y = 0.

use glam::{DQuat, DVec3};
use motiondb::body::{JOINT_COUNT, Joint};
use motiondb::motion::{PHASE_COUNT, PhaseMap};

use crate::cycle::gait_cycle::GaitCycle;
use crate::ground::root_arc::Rates;
use crate::retarget::human_clip::HumanPose;

/// Rates of the mirrored motion.
pub(crate) fn mirrored_rates(rates: &Rates) -> Rates {
    // 0 − x, so that 0 stays 0 and does not become −0.
    Rates { turn_rate_rad_s: 0.0 - rates.turn_rate_rad_s, strafe_mps: 0.0 - rates.strafe_mps, ..*rates }
}

/// The mirrored cycle; its phase 0 is the original's left mid-stance.
pub(crate) fn mirrored_cycle(cycle: &GaitCycle) -> GaitCycle {
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
}

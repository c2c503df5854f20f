//! One closed cycle of a gait, sampled at 64 uniform phases: what an example is made of.

use glam::DVec3;
use motiondb::body::Joint;
use motiondb::motion::PhaseMap;
use motiondb::statistics::mean;
use serde::{Deserialize, Serialize};

use crate::ground::root_arc::Rates;
use crate::retarget::human_clip::{HumanBody, HumanJoints, HumanPose};
use crate::rig::carriage::Carriage;
use crate::rig::roles::ARMS;

/// Share of the cycle with both feet in the air from which a gait is a run. Jogs: 0.2; brisk walks whose contacts are detected
/// too short: up to 0.1.
const RUN_FLIGHT_SHARE: f64 = 0.15;

/// One closed cycle; phase 0 is right mid-stance. Root frame: x forward, y left, z up, metres.
#[derive(Clone, Debug, Serialize, Deserialize)]
pub struct GaitCycle {
    /// Poses at uniform phases, in the root frame.
    pub rows: Vec<HumanPose>,
    /// Contact of each foot at each phase, `[left, right]`: 1 on the ground, 0 in the air, ½ at both ends of a stance.
    pub contacts: Vec<[f64; 2]>,
    /// Map from phase to time.
    pub phase_map: PhaseMap,
    /// Constant rates of the root.
    pub rates: Rates,
    /// The body steps; otherwise it stands.
    pub steps: bool,
}

impl GaitCycle {
    /// Whether the body runs: both feet are in the air for a part of the cycle.
    pub(crate) fn is_run(&self) -> bool {
        let flies = |contacts: &&[f64; 2]| contacts.iter().all(|contact| *contact < 0.5);
        self.contacts.iter().filter(flies).count() as f64 > RUN_FLIGHT_SHARE * self.contacts.len() as f64
    }

    /// The joints of a body at each phase.
    pub(crate) fn joints(&self, body: &HumanBody) -> Vec<HumanJoints> {
        self.rows.iter().map(|pose| pose.forward_kinematics(body)).collect()
    }

    /// Mean distance of the joints of two cycles at equal phases, m.
    pub(crate) fn distance_m(&self, other: &Self, body: &HumanBody) -> f64 {
        let (joints, others) = (self.joints(body), other.joints(body));
        mean(joints.iter().zip(&others).map(|(one, other)| one.mean_distance_m(other))).unwrap_or_default()
    }

    /// The mean carriage over the cycle.
    pub(crate) fn carriage(&self, body: &HumanBody) -> Carriage {
        let joints = self.joints(body);
        let mean_of = |[from, to]: [Joint; 2]| {
            let direction =
                |joints: &HumanJoints| (joints.position_m(to) - joints.position_m(from)).normalize_or_zero();
            joints.iter().map(direction).sum::<DVec3>().as_vec3()
        };
        let bone = |part: usize, side: usize| mean_of([ARMS[side][part], ARMS[side][part + 1]]);
        let arms = [bone(0, 0), bone(0, 1), bone(1, 0), bone(1, 1)];
        Carriage { arms, trunk: mean_of([Joint::Pelvis, Joint::Neck]) }
    }
}

//! One closed cycle of a gait, sampled at 64 uniform phases: what an example is made of.

use motiondb::motion::PhaseMap;
use serde::{Deserialize, Serialize};

use crate::ground::root_arc::Rates;
use crate::retarget::human_clip::HumanPose;

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
    /// Share of the cycle with both feet in the air.
    pub(crate) fn flight_share(&self) -> f64 {
        let flies = |contacts: &&[f64; 2]| contacts.iter().all(|contact| *contact < 0.5);
        self.contacts.iter().filter(flies).count() as f64 / self.contacts.len().max(1) as f64
    }
}

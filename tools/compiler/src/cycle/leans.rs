//! Whether the body of a cycle leans as bodies hardly do on level ground: ground that is tilted, a trunk that is bent.
//!
//! Root frame: x forward, y left, z up.

use glam::DVec3;
use motiondb::body::Joint;
use motiondb::diagnostic::{Diagnostic, Warning};
use motiondb::statistics::mean;
use motiondb::velocity_sets::velocity_hull::goes_straight;

use crate::cycle::gait_cycle::GaitCycle;
use crate::retarget::human_clip::{HumanBody, HumanJoints};
use crate::rig::body_angles::trunk_lean_deg;

/// Greatest lean to a side of a body that goes straight on, ankles to neck, degrees; mean over the cycle. Captures of nine
/// sources reach 1.8.
const ASIDE_MAX_DEG: f64 = 4.0;
/// Greatest lean of the trunk of an upright gait, degrees; mean over the cycle. Sprints reach 25.
const TRUNK_MAX_DEG: f64 = 40.0;

/// The warnings about how a body leans.
pub(crate) fn lean_warnings(cycle: &GaitCycle, body: &HumanBody) -> impl Iterator<Item = Diagnostic> {
    let joints = cycle.joints(body);
    let upward: DVec3 = joints.iter().map(ankles_to_neck).sum();
    let aside_deg = libm::atan2(upward.y, upward.z).to_degrees();
    let trunks_deg = joints.iter().map(|joints| trunk_lean_deg(|joint| joints.position_m(joint)));
    let trunk_deg = mean(trunks_deg).unwrap_or_default();
    let is_tilted = goes_straight(&cycle.rates.to_parameters()) && aside_deg.abs() > ASIDE_MAX_DEG;
    let tilted = is_tilted.then_some(Warning::LeansAside { lean_deg: aside_deg as f32, from_s: None });
    let bent = (trunk_deg > TRUNK_MAX_DEG).then_some(Warning::TrunkBent { lean_deg: trunk_deg as f32, from_s: None });
    tilted.into_iter().chain(bent).map(Diagnostic::Warning)
}

/// Direction from the middle of both ankles to the neck.
fn ankles_to_neck(joints: &HumanJoints) -> DVec3 {
    let [left, right] = Joint::FEET.map(|foot| joints.position_m(foot));
    (joints.position_m(Joint::Neck) - 0.5 * (left + right)).normalize_or_zero()
}

#[cfg(test)]
mod tests {
    use glam::DQuat;

    use super::*;
    use crate::synthetic::{self, SyntheticWalk, cycle_of};

    /// Codes of the warnings about a walk that is turned as a whole and whose trunk is bent.
    fn codes(tilt_deg: f64, bend_deg: f64) -> Vec<&'static str> {
        let clip = synthetic::walk("walk", SyntheticWalk::default());
        let mut cycle = cycle_of(&clip);
        for pose in &mut cycle.rows {
            let tilt = DQuat::from_rotation_x(-tilt_deg.to_radians());
            (pose.pelvis_m, pose.rotations[0]) = (tilt * pose.pelvis_m, tilt * pose.rotations[0]);
            let spine = &mut pose.rotations[Joint::SpineLower.index()];
            *spine = DQuat::from_rotation_y(bend_deg.to_radians()) * *spine;
        }
        lean_warnings(&cycle, &clip.body).map(|found| found.code()).collect()
    }

    #[test]
    fn tilted_ground_and_bent_trunks_are_reported() {
        assert!(codes(0.0, 0.0).is_empty() && codes(3.0, 15.0).is_empty());
        assert_eq!(codes(6.0, 0.0), ["leans_aside"]);
        assert_eq!(codes(-6.0, 0.0), ["leans_aside"]);
        assert_eq!(codes(0.0, 70.0), ["trunk_bent"]);
    }
}

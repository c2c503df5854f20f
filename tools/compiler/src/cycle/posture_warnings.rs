//! Whether the body of a cycle is held as bodies hardly are on level ground: on ground that is tilted, with a trunk that is
//! bent or twisted.
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
/// Greatest lean of the trunk of an upright body, degrees; mean over the cycle or the rest. Sprints reach 25.
const TRUNK_MAX_DEG: f64 = 40.0;
/// Greatest angle on the ground between shoulders and hips, degrees; mean over the cycle. No capture of fifteen sources
/// reaches it.
const TWIST_MAX_DEG: f64 = 20.0;

/// The warnings about how the body of a cycle leans and twists.
pub(crate) fn posture_warnings(cycle: &GaitCycle, body: &HumanBody) -> impl Iterator<Item = Diagnostic> {
    let joints = cycle.joints(body);
    let upward: DVec3 = joints.iter().map(ankles_to_neck).sum();
    let aside_deg = libm::atan2(upward.y, upward.z).to_degrees();
    let trunks_deg = joints.iter().map(|joints| trunk_lean_deg(|joint| joints.position_m(joint)));
    let trunk_deg = mean(trunks_deg).unwrap_or_default();
    let is_tilted = goes_straight(&cycle.rates.to_parameters()) && aside_deg.abs() > ASIDE_MAX_DEG;
    let tilted = is_tilted.then_some(Warning::LeansAside { lean_deg: aside_deg as f32, from_s: None });
    let twist_deg = mean(joints.iter().map(twist_rad)).unwrap_or_default().to_degrees();
    let is_twisted = twist_deg.abs() > TWIST_MAX_DEG;
    let twisted = is_twisted.then_some(Warning::TrunkTwisted { twist_deg: twist_deg as f32, from_s: None });
    tilted.into_iter().chain(twisted).map(Diagnostic::Warning).chain(bent_trunk(trunk_deg))
}

/// The warning about a trunk that leans so far, degrees; none for an upright one.
pub(crate) fn bent_trunk(lean_deg: f64) -> Option<Diagnostic> {
    let bent = Warning::TrunkBent { lean_deg: lean_deg as f32, from_s: None };
    (lean_deg > TRUNK_MAX_DEG).then_some(Diagnostic::Warning(bent))
}

/// Angle on the ground from the hips to the shoulders, rad; positive to the left.
fn twist_rad(joints: &HumanJoints) -> f64 {
    let [hips, shoulders] = [Joint::THIGHS, Joint::UPPER_ARMS].map(|pair| {
        let [left, right] = pair.map(|joint| joints.position_m(joint).truncate());
        left - right
    });
    hips.angle_to(shoulders)
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
        let found = warnings(tilt_deg, DQuat::from_rotation_y(bend_deg.to_radians()));
        found.iter().map(Diagnostic::code).collect()
    }

    /// The warnings about a walk that is turned as a whole and whose trunk turns.
    fn warnings(tilt_deg: f64, trunk: DQuat) -> Vec<Diagnostic> {
        let clip = synthetic::walk("walk", SyntheticWalk::default());
        let mut cycle = cycle_of(&clip);
        for pose in &mut cycle.rows {
            let tilt = DQuat::from_rotation_x(-tilt_deg.to_radians());
            (pose.pelvis_m, pose.rotations[0]) = (tilt * pose.pelvis_m, tilt * pose.rotations[0]);
            let spine = &mut pose.rotations[Joint::SpineLower.index()];
            *spine = trunk * *spine;
        }
        posture_warnings(&cycle, &clip.body).collect()
    }

    #[test]
    fn tilted_ground_and_bent_trunks_are_reported() {
        assert!(codes(0.0, 0.0).is_empty() && codes(3.0, 15.0).is_empty());
        assert_eq!(codes(6.0, 0.0), ["leans_aside"]);
        assert_eq!(codes(-6.0, 0.0), ["leans_aside"]);
        assert_eq!(codes(0.0, 70.0), ["trunk_bent"]);
        let twists_deg = [10.0f64, 30.0, -30.0].map(|twist_deg| {
            let found = warnings(0.0, DQuat::from_rotation_z(twist_deg.to_radians()));
            found.into_iter().find_map(|found| match found {
                Diagnostic::Warning(Warning::TrunkTwisted { twist_deg, .. }) => Some(twist_deg),
                _ => None,
            })
        });
        assert!(matches!(twists_deg, [None, Some(20.0..40.0), Some(-40.0..-20.0)]), "{twists_deg:?}");
    }
}

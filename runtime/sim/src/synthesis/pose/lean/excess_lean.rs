//! Lean: the trunk tilts in the direction in which the body accelerates. `FbCrowd` does not have it.
//!
//! People who start tilt the trunk forward, by 0.5 to 1.7° for each m/s² of the start (`docs/tuning.md`); they tilt it
//! backward to brake, and inward in curves (Courtine and Schieppati 2003, *Eur. J. Neurosci.* 18, 177–190). Here the
//! tilt follows the acceleration of the drawn motion, which has no stride ripple. With velocity v and turn rate ω_t in
//! the body's frame,
//!
//! ```text
//! a = dv/dt + ω_t × v,   tilt → γ·a,
//! ```
//!
//! by a filter of the third order, so that neither rate nor acceleration of the trunk jumps. The trunk tilts as a whole
//! above the pelvis. The head keeps its orientation: the gaze stays level. Root, pelvis and legs do not depend on it.
//!
//! Root frame (x forward, y left, z up); m/s, m/s², radians.

use glam::{Quat, Vec2};
use motiondb::body::{Joint, Pose};
use motiondb::motion::Parameters;

use crate::maths::angle::rotation;
use crate::synthesis::TimeStep;

/// γ: tilt for each unit of acceleration, rad per m/s² (2.6°): in a start, which the filter evens out, half a degree.
const TILT_RAD_PER_MPS2: f32 = 0.046;
/// Greatest acceleration that counts, m/s²: that of an emergency stop.
const ACCELERATION_MAX_MPS2: f32 = 3.0;
/// Tilt below which the pose is left unchanged, rad.
const UPRIGHT_RAD: f32 = 1e-4;
/// Joints from the foot of the spine to the neck, which carry the head.
const TRUNK: [Joint; 4] = [Joint::SpineLower, Joint::SpineMiddle, Joint::SpineUpper, Joint::Neck];

/// The lean of a body.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(crate) struct Lean {
    /// Velocity of the drawn motion after the last step, m/s.
    velocity_mps: Vec2,
    /// Tilt forward and to the left, rad, its rate of change, rad/s, and its acceleration, rad/s².
    tilt_rad: [Vec2; 3],
}

impl Lean {
    /// Follows the drawn motion over one step. `clip_mps2` is the part of its acceleration into which the trunk leans in
    /// the clip that is played.
    pub(crate) fn follow(&mut self, drawn: &Parameters, clip_mps2: Vec2, step: &TimeStep) {
        let velocity_mps = drawn.velocity_mps();
        let turning_mps2 = drawn.turn_rate_rad_s * velocity_mps.perp();
        let acceleration_mps2 = (velocity_mps - self.velocity_mps) / step.dt_s + turning_mps2 - clip_mps2;
        self.velocity_mps = velocity_mps;
        let target_rad = TILT_RAD_PER_MPS2 * acceleration_mps2.clamp_length_max(ACCELERATION_MAX_MPS2);
        step.lean.approach(&mut self.tilt_rad, target_rad);
    }

    /// Tilts the trunk of a pose, and keeps the orientation of its head.
    pub(crate) fn tilt(&self, pose: &mut Pose) {
        tilt_trunk(pose, self.tilt_rad[0]);
    }
}

/// Tilts the trunk of a pose forward and to the left, rad, and keeps the orientation of its head.
pub(crate) fn tilt_trunk(pose: &mut Pose, tilt_rad: Vec2) {
    if tilt_rad.length_squared() < UPRIGHT_RAD * UPRIGHT_RAD {
        return;
    }
    let pelvis = pose.rotations[Joint::Pelvis.index()];
    // z × tilt, in the frame of the pelvis.
    let tilt = rotation(pelvis.conjugate() * tilt_rad.perp().extend(0.0));
    let chain = |pose: &Pose| TRUNK.iter().fold(Quat::IDENTITY, |chain, joint| chain * pose.rotations[joint.index()]);
    let neck = chain(pose);
    let spine = &mut pose.rotations[TRUNK[0].index()];
    *spine = tilt * *spine;
    let head = &mut pose.rotations[Joint::Head.index()];
    *head = neck.conjugate() * tilt.conjugate() * neck * *head;
}

#[cfg(test)]
mod tests {
    use std::sync::Arc;

    use motiondb::body::{Joints, Root};

    use super::*;
    use crate::planning::plan::Plan;
    use crate::synthesis::{HmsParams, Modes, SynthesisContext};
    use crate::test_db::test_db;

    fn walking(speed_mps: f32, turn_rate_rad_s: f32) -> Parameters {
        Parameters { speed_mps, turn_rate_rad_s, strafe_mps: 0.0 }
    }

    /// Tilts forward and to the left after each step of a motion by time, degrees.
    fn tilts_deg(seconds: f32, dt_s: f32, motion: impl Fn(f32) -> Parameters) -> Vec<Vec2> {
        let (mut lean, step) = (Lean::default(), TimeStep::new(dt_s));
        let mut tilt_deg = |index: usize| {
            lean.follow(&motion(index as f32 * dt_s), Vec2::ZERO, &step);
            lean.tilt_rad[0] * 1_f32.to_degrees()
        };
        (1..=(seconds / dt_s).round() as usize).map(&mut tilt_deg).collect()
    }

    #[test]
    fn bodies_lean_into_starts_stops_and_curves() {
        for dt_s in [1.0 / 120.0, 1.0 / 30.0, 0.1] {
            let speeds = |time_s: f32| walking(1.6 * time_s.min(0.8) - 1.6 * (time_s - 3.0).clamp(0.0, 0.8), 0.0);
            let tilts_deg = tilts_deg(5.0, dt_s, speeds);
            let at_deg = |time_s: f32| tilts_deg[(time_s / dt_s).round() as usize - 1].x;
            assert!((1.5..5.0).contains(&at_deg(0.7)) && (-5.0..-1.5).contains(&at_deg(3.7)), "dt {dt_s}");
            assert!(at_deg(2.9).abs() < 0.05 && at_deg(5.0).abs() < 0.15, "dt {dt_s}");
        }
        let left_deg = tilts_deg(3.0, 1.0 / 60.0, |_| walking(1.2, 0.8));
        assert!(left_deg[179].x.abs() < 0.05 && (1.0..4.0).contains(&left_deg[179].y), "{}", left_deg[179]);
    }

    #[test]
    fn starts_do_not_jerk_the_trunk() {
        let dt_s = 1.0 / 120.0;
        let tilts_deg = tilts_deg(3.0, dt_s, |time_s| walking((3.0 * (time_s - 1.0)).clamp(0.0, 1.4), 0.0));
        let bends = tilts_deg.windows(3).map(|three| (three[0] - 2.0 * three[1] + three[2]).x.abs() / (dt_s * dt_s));
        let greatest_rad_s2 = bends.fold(0.0, f32::max).to_radians();
        assert!(greatest_rad_s2 < 35.0, "{greatest_rad_s2} rad/s²"); // a tilt that jumps: 2,000
    }

    #[test]
    fn the_trunk_tilts_and_the_head_stays_level() {
        let db = test_db();
        let before = db.rows.pose(2, 10);
        let mut pose = before;
        let lean = Lean { tilt_rad: [Vec2::new(0.05, -0.03), Vec2::ZERO, Vec2::ZERO], ..Lean::default() };
        lean.tilt(&mut pose);
        let [joints_before, joints] = [before, pose].map(|pose| pose.forward_kinematics(&db.skeleton));
        let trunk = |joints: &Joints| {
            let [neck_m, spine_m] = [Joint::Neck, Joint::SpineLower].map(|joint| joints.positions_m[joint.index()]);
            (neck_m - spine_m).normalize()
        };
        let moved = trunk(&joints) - trunk(&joints_before);
        assert!((moved.x - 0.05).abs() < 5e-3 && (moved.y + 0.03).abs() < 5e-3, "{moved}");
        let head = |joints: &Joints| joints.orientations[Joint::Head.index()];
        assert!(head(&joints).angle_between(head(&joints_before)) < 1e-3);
        let legs = Joint::LeftThigh.index()..;
        assert_eq!(joints.positions_m[legs.clone()], joints_before.positions_m[legs]);
    }

    #[test]
    fn the_drawn_trunk_leans_with_every_synthesis() {
        for modes in [Modes::Blending, Modes::Hybrid] {
            let context = SynthesisContext::new(Arc::new(test_db()), HmsParams { modes, ..HmsParams::default() });
            let plan = |time_s: f32, _: &Root| Plan {
                velocity_mps: Vec2::new(if (1.0..4.0).contains(&time_s) { 1.3 } else { 0.0 }, 0.0),
                ..Plan::default()
            };
            let forward_m = context.walk_alone(0.3, 6.0, 1.0 / 60.0, plan, |_, output| {
                let joints = output.pose.forward_kinematics(&context.db.skeleton);
                (joints.positions_m[Joint::Neck.index()] - joints.positions_m[Joint::Pelvis.index()]).x
            });
            let mean_m = |from: usize, to: usize| forward_m[from..to].iter().sum::<f32>() / (to - from) as f32;
            let (start_m, walk_m, stop_m) = (mean_m(66, 96), mean_m(150, 230), mean_m(246, 276));
            assert!(start_m > walk_m + 0.01 && stop_m < walk_m - 0.01, "{start_m} {walk_m} {stop_m} m");
        }
    }
}

//! The root's path over one stride: an arc, followed uniformly in time.
//!
//! Definition "Root trajectory" of `docs/definitions.md`. With heading θ(t) = θ₀ + ω_t·t the root moves at constant
//! (v_f, ω_s) in its own turning frame, so that
//!
//! ```text
//! p(t) = p₀ + R(θ₀)·J(ω_t·t)·(v_f, ω_s)·t,   J(a) = [sin a, cos a − 1; 1 − cos a, sin a] / a.
//! ```
//!
//! The rest of the pelvis's path (sway, surge, bob, yaw) belongs to the pose. So root velocities blend linearly, and
//! the planner sees no gait. Samples and arcs are in the world frame: metres, seconds, radians, Z up.

use glam::{DMat2, DQuat, DVec2};
use motiondb::motion::Parameters;
use motiondb::statistics::mean;
use serde::{Deserialize, Serialize};

use crate::ground::rotations::ground_rotation;
use crate::retarget::human_clip::HumanPose;

/// Rounds of the fit; each shrinks what the sway at the stride's ends leaves a hundredfold.
const FIT_ROUNDS: usize = 4;
/// Angle below which J comes from its series, whose next term is a³/24, rad.
const SMALL_ANGLE_RAD: f64 = 1e-4;

/// (v_f, ω_t, ω_s) in f64, as the analysis of clips needs them.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Rates {
    /// Speed along the facing v_f, m/s; negative backward.
    pub speed_mps: f64,
    /// Turn rate ω_t, rad/s; positive to the left.
    pub turn_rate_rad_s: f64,
    /// Side speed ω_s, m/s; positive to the left.
    pub strafe_mps: f64,
}

impl Rates {
    /// Speed over the ground, m/s.
    pub fn speed_over_ground_mps(&self) -> f64 {
        libm::hypot(self.speed_mps, self.strafe_mps)
    }

    /// The rates as a database stores them, in f32.
    pub fn to_parameters(self) -> Parameters {
        Parameters {
            speed_mps: self.speed_mps as f32,
            turn_rate_rad_s: self.turn_rate_rad_s as f32,
            strafe_mps: self.strafe_mps as f32,
        }
    }
}

/// The path of a root that moves at constant rates.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct RootArc {
    /// Position p₀ of the root at time 0, world, m.
    pub start_m: DVec2,
    /// Facing θ₀ at time 0, rad.
    pub facing_rad: f64,
    /// Constant rates of the root in its own frame.
    pub rates: Rates,
}

/// Hips and facing at one time of a stride.
#[derive(Clone, Copy, Debug)]
pub struct RootSample {
    /// Time since the stride's first sample, s.
    pub time_s: f64,
    /// Midpoint of the hips on the ground, world, m.
    pub hips_m: DVec2,
    /// Facing without jumps of 2π, rad.
    pub facing_rad: f64,
}

impl RootArc {
    /// Position (m) and facing (rad) of the root at a time.
    pub fn at(&self, time_s: f64) -> (DVec2, f64) {
        let angle_rad = self.rates.turn_rate_rad_s * time_s;
        let velocity_mps = DVec2::new(self.rates.speed_mps, self.rates.strafe_mps);
        let travelled_m = ground_rotation(self.facing_rad) * (mean_rotation(angle_rad) * velocity_mps) * time_s;
        (self.start_m + travelled_m, self.facing_rad + angle_rad)
    }

    /// The same motion, its time 0 moved to a later time (earlier where negative).
    #[must_use]
    pub fn shifted(&self, time_s: f64) -> Self {
        let (start_m, facing_rad) = self.at(time_s);
        Self { start_m, facing_rad, rates: self.rates }
    }

    /// A pose of the world in the frame of the root at a time.
    pub fn relative(&self, pose: &HumanPose, time_s: f64) -> HumanPose {
        relative_to(self.at(time_s), pose)
    }

    /// The arc of a stride: hips equal in the root frame at both ends, residuals of mean zero between them.
    ///
    /// `samples` are uniform in time; the last one is a whole stride after the first.
    pub fn fit(samples: &[RootSample]) -> Self {
        let (Some(first), Some(last)) = (samples.first(), samples.last()) else { return Self::default() };
        let inner = &samples[..samples.len() - 1];
        let turn_rate_rad_s = (last.facing_rad - first.facing_rad) / last.time_s;
        let facings_rad = inner.iter().map(|sample| sample.facing_rad - turn_rate_rad_s * sample.time_s);
        let rates = Rates { turn_rate_rad_s, ..Rates::default() };
        let mut arc = Self { start_m: first.hips_m, facing_rad: mean(facings_rad).unwrap_or(first.facing_rad), rates };
        for _ in 0..FIT_ROUNDS {
            arc.close_over(first, last);
            // The mean residual is taken in the turning frame: it moves the root aside of this arc all along.
            let residual_m = |sample: &RootSample| {
                let (position_m, facing_rad) = arc.at(sample.time_s);
                ground_rotation(-facing_rad) * (sample.hips_m - position_m)
            };
            let mean_residual_m = mean(inner.iter().map(residual_m)).unwrap_or_default();
            arc.start_m += ground_rotation(arc.facing_rad) * mean_residual_m;
        }
        arc
    }

    /// Sets the speeds so that the hips at both ends have the same position in the root's frame.
    fn close_over(&mut self, first: &RootSample, last: &RootSample) {
        let angle_rad = self.rates.turn_rate_rad_s * last.time_s;
        let sway_m = first.hips_m - self.start_m;
        let travelled_m = last.hips_m - first.hips_m - (ground_rotation(angle_rad) * sway_m - sway_m);
        let in_root_frame_m = ground_rotation(-self.facing_rad) * travelled_m;
        let velocity_mps = mean_rotation(angle_rad).inverse() * in_root_frame_m / last.time_s;
        self.rates.speed_mps = velocity_mps.x;
        self.rates.strafe_mps = velocity_mps.y;
    }
}

/// A pose of the world in the frame of a root with a position (m) and a facing (rad).
pub(crate) fn relative_to((position_m, facing_rad): (DVec2, f64), pose: &HumanPose) -> HumanPose {
    let ground_m = ground_rotation(-facing_rad) * (pose.pelvis_m.truncate() - position_m);
    let mut rotations = pose.rotations;
    rotations[0] = DQuat::from_rotation_z(-facing_rad) * rotations[0];
    HumanPose { pelvis_m: ground_m.extend(pose.pelvis_m.z), rotations, extra: pose.extra.clone() }
}

/// J(a): the mean of all rotations from 0 to a.
fn mean_rotation(angle_rad: f64) -> DMat2 {
    let (sin, cos) = libm::sincos(angle_rad);
    let (along, across) = if angle_rad.abs() < SMALL_ANGLE_RAD {
        (1.0 - angle_rad * angle_rad / 6.0, 0.5 * angle_rad)
    } else {
        (sin / angle_rad, (1.0 - cos) / angle_rad)
    };
    DMat2::from_cols(DVec2::new(along, across), DVec2::new(-across, along))
}

#[cfg(test)]
mod tests {
    use std::f64::consts::TAU;

    use super::*;

    /// The fit recovers a known arc from hips that sway about it in its own frame.
    #[track_caller]
    fn check_fit(rates: Rates) {
        let truth = RootArc { start_m: DVec2::new(0.3, -1.0), facing_rad: 0.7, rates };
        let period_s = 0.9;
        let samples: Vec<RootSample> = (0..=64)
            .map(|k| {
                let (time_s, phase_rad) = (period_s * f64::from(k) / 64.0, TAU * f64::from(k) / 64.0);
                let (position_m, facing_rad) = truth.at(time_s);
                let sway_m = DVec2::new(0.01 * libm::sin(2.0 * phase_rad), 0.03 * libm::cos(phase_rad));
                let hips_m = position_m + ground_rotation(facing_rad) * sway_m;
                RootSample { time_s, hips_m, facing_rad: facing_rad + 0.05 * libm::sin(phase_rad + 0.4) }
            })
            .collect();
        let arc = RootArc::fit(&samples);
        let error = |a: f64, b: f64| (a - b).abs();
        assert!(error(arc.rates.speed_mps, rates.speed_mps) < 2e-3, "{arc:?}");
        assert!(error(arc.rates.strafe_mps, rates.strafe_mps) < 2e-3, "{arc:?}");
        assert!(error(arc.rates.turn_rate_rad_s, rates.turn_rate_rad_s) < 1e-9, "{arc:?}");
        assert!((arc.start_m - truth.start_m).length() < 2e-3, "{arc:?}");
    }

    #[test]
    fn fit_finds_the_arc_under_sway_and_yaw() {
        check_fit(Rates { speed_mps: 1.2, turn_rate_rad_s: 0.0, strafe_mps: 0.0 });
        check_fit(Rates { speed_mps: 1.66, turn_rate_rad_s: -2.6, strafe_mps: 0.1 });
        check_fit(Rates { speed_mps: 0.1, turn_rate_rad_s: 2.9, strafe_mps: -0.4 });
    }
}

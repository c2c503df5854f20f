//! The root's path over one stride: an arc, followed uniformly in time. What else the pelvis does (sway, surge, bob,
//! yaw) belongs to the pose, so that root velocities blend linearly and the planner sees no gait.
//!
//! With heading θ(t) = θ₀ + ω_t·t the root moves at (v_f, ω_s) in its own turning frame, so that
//!
//! ```text
//! p(t) = p₀ + R(θ₀)·J(ω_t·t)·(v_f, ω_s)·t,   J(a) = [sin a, cos a − 1; 1 − cos a, sin a] / a.
//! ```
//!
//! All that is left of the pelvis's path, its sway, surge, bob and yaw, belongs to the pose. World frame, metres,
//! seconds, radians.

use glam::{DMat2, DQuat, DVec2, DVec3};
use motiondb::motion::Parameters;

use crate::retarget::human_clip::HumanPose;

/// Rounds of the fit: the sway at the stride's ends turns with the body, and each round shrinks what is left of it a
/// hundredfold.
const FIT_ROUNDS: usize = 4;
/// Below this angle J is taken from its series, whose next term is a³/24.
const SMALL_ANGLE_RAD: f64 = 1e-4;

/// (v_f, ω_t, ω_s) in f64, while clips are analysed.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Rates {
    /// v_f, m/s.
    pub speed_mps: f64,
    /// ω_t, rad/s.
    pub turn_rate_rad_s: f64,
    /// ω_s, to the left, m/s.
    pub strafe_mps: f64,
}

impl Rates {
    /// As the database stores them.
    pub fn to_parameters(self) -> Parameters {
        Parameters {
            speed_mps: self.speed_mps as f32,
            turn_rate_rad_s: self.turn_rate_rad_s as f32,
            strafe_mps: self.strafe_mps as f32,
        }
    }
}

/// A root that moves at constant rates.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Arc {
    /// Root at time 0.
    pub start_m: DVec2,
    /// Facing at time 0.
    pub facing_rad: f64,
    /// Constant rates.
    pub rates: Rates,
}

/// Hips and facing at one time of a stride.
#[derive(Clone, Copy, Debug)]
pub struct RootSample {
    /// Seconds since the stride's first sample.
    pub time_s: f64,
    /// Midpoint of the hips on the ground.
    pub hips_m: DVec2,
    /// Facing, unwrapped.
    pub facing_rad: f64,
}

impl Arc {
    /// Position and facing at a time.
    pub fn at(&self, time_s: f64) -> (DVec2, f64) {
        let angle = self.rates.turn_rate_rad_s * time_s;
        let velocity = DVec2::new(self.rates.speed_mps, self.rates.strafe_mps);
        let travelled = rotation(self.facing_rad) * (mean_rotation(angle) * velocity) * time_s;
        (self.start_m + travelled, self.facing_rad + angle)
    }

    /// The same motion with its clock's zero moved to a later time (earlier where negative).
    #[must_use]
    pub fn shifted(&self, time_s: f64) -> Self {
        let (start_m, facing_rad) = self.at(time_s);
        Self { start_m, facing_rad, rates: self.rates }
    }

    /// A pose of the world in the frame of the root at a time.
    pub fn relative(&self, pose: &HumanPose, time_s: f64) -> HumanPose {
        let (position_m, facing_rad) = self.at(time_s);
        let ground = rotation(-facing_rad) * (pose.pelvis_m.truncate() - position_m);
        let mut rotations = pose.rotations;
        rotations[0] = DQuat::from_rotation_z(-facing_rad) * rotations[0];
        HumanPose { pelvis_m: ground.extend(pose.pelvis_m.z), rotations }
    }

    /// A point of the root frame in the world.
    pub fn to_world(&self, point_m: DVec3, time_s: f64) -> DVec3 {
        let (position_m, facing_rad) = self.at(time_s);
        (position_m + rotation(facing_rad) * point_m.truncate()).extend(point_m.z)
    }

    /// The arc that carries the mean root over one stride: its ends a stride apart, its residuals of mean zero.
    ///
    /// `samples` are uniform in time, the last one a whole stride after the first.
    pub fn fit(samples: &[RootSample]) -> Self {
        let (Some(first), Some(last)) = (samples.first(), samples.last()) else { return Self::default() };
        let inner = &samples[..samples.len() - 1];
        let turn_rate_rad_s = (last.facing_rad - first.facing_rad) / last.time_s;
        let facing_rad = mean(inner.iter().map(|s| s.facing_rad - turn_rate_rad_s * s.time_s));
        let mut arc = Self { start_m: first.hips_m, facing_rad, rates: Rates { turn_rate_rad_s, ..Rates::default() } };
        for _ in 0..FIT_ROUNDS {
            arc.close_over(first, last);
            // The mean is taken in the turning frame: an arc beside this one, not a shifted copy of it.
            let off = |sample: &RootSample| {
                let (position_m, facing_rad) = arc.at(sample.time_s);
                rotation(-facing_rad) * (sample.hips_m - position_m)
            };
            let mean_off = rotation(arc.facing_rad) * mean_vec(inner.iter().map(off));
            arc.start_m += mean_off;
        }
        arc
    }

    /// Sets the speeds so that the hips at both ends have the same place in the root's frame.
    fn close_over(&mut self, first: &RootSample, last: &RootSample) {
        let angle = self.rates.turn_rate_rad_s * last.time_s;
        let sway = first.hips_m - self.start_m;
        let travelled = last.hips_m - first.hips_m - (rotation(angle) * sway - sway);
        let velocity = mean_rotation(angle).inverse() * (rotation(-self.facing_rad) * travelled) / last.time_s;
        self.rates.speed_mps = velocity.x;
        self.rates.strafe_mps = velocity.y;
    }
}

/// Rotation of the ground plane, counter-clockwise.
pub(crate) fn rotation(angle_rad: f64) -> DMat2 {
    let (sin, cos) = libm::sincos(angle_rad);
    DMat2::from_cols(DVec2::new(cos, sin), DVec2::new(-sin, cos))
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

fn mean(values: impl ExactSizeIterator<Item = f64>) -> f64 {
    let count = values.len() as f64;
    values.sum::<f64>() / count
}

fn mean_vec(values: impl ExactSizeIterator<Item = DVec2>) -> DVec2 {
    let count = values.len() as f64;
    values.sum::<DVec2>() / count
}

#[cfg(test)]
mod tests {
    use std::f64::consts::TAU;

    use super::*;

    /// A known arc, its hips swaying about it in its own frame, comes back from its samples.
    fn check_fit(rates: Rates) {
        let truth = Arc { start_m: DVec2::new(0.3, -1.0), facing_rad: 0.7, rates };
        let period_s = 0.9;
        let samples: Vec<RootSample> = (0..=64)
            .map(|k| {
                let (time_s, phase) = (period_s * f64::from(k) / 64.0, TAU * f64::from(k) / 64.0);
                let (position, facing) = truth.at(time_s);
                let sway = DVec2::new(0.01 * libm::sin(2.0 * phase), 0.03 * libm::cos(phase));
                let facing_rad = facing + 0.05 * libm::sin(phase + 0.4);
                RootSample { time_s, hips_m: position + rotation(facing) * sway, facing_rad }
            })
            .collect();
        let arc = Arc::fit(&samples);
        let off = |a: f64, b: f64| (a - b).abs();
        assert!(off(arc.rates.speed_mps, rates.speed_mps) < 2e-3, "{arc:?}");
        assert!(off(arc.rates.strafe_mps, rates.strafe_mps) < 2e-3, "{arc:?}");
        assert!(off(arc.rates.turn_rate_rad_s, rates.turn_rate_rad_s) < 1e-9, "{arc:?}");
        assert!((arc.start_m - truth.start_m).length() < 2e-3, "{arc:?}");
    }

    #[test]
    fn fit_finds_the_arc_under_sway_and_yaw() {
        check_fit(Rates { speed_mps: 1.2, turn_rate_rad_s: 0.0, strafe_mps: 0.0 });
        check_fit(Rates { speed_mps: 1.66, turn_rate_rad_s: -2.6, strafe_mps: 0.1 });
        check_fit(Rates { speed_mps: 0.1, turn_rate_rad_s: 2.9, strafe_mps: -0.4 });
    }
}

//! The pelvis about the root's path: height, sway, surge, list, rotation, tilt.
//!
//! Walking: the pelvis rides over the stance leg as over an inverted pendulum. Its height is the one at which the
//! stance knee would have its published flexion, smoothed to four waves a stride and lowered wherever a leg,
//! standing or about to strike, would be overstretched. Running: at the top of flight the hips fall with g, which at
//! the step's frequency gives the amplitude g/(4π/P)² (3.3 cm at 2.7 steps/s: a drop of 7 cm). The list has the
//! published shape (Schwartz et al. 2008, free class), the rotation its amplitude. Root frame, metres.

use glam::{DQuat, DVec2, DVec3};

use crate::body::{HALF_HIP_M, HEIGHT_M};
use crate::cadence::Gait;
use crate::legs::reach_m;
use crate::rotation::{about_x, about_y, about_z, wave};
use crate::steps::Steps;

const GRAVITY_MPS2: f64 = 9.81;
/// Samples of each stride when fitting the height.
const SAMPLES: usize = 120;
/// Fastest wave of the fitted height, a stride; the slowest is one over the clip.
const HARMONICS: usize = 4;
/// The trailing leg's say in the height fades over this share of the stride before the other foot strikes.
const HANDOVER_SHARE: f64 = 0.05;
/// Share of a turn's bank that the pelvis takes.
const BANK_SHARE: f64 = 0.70;

/// The pelvis at one moment.
#[derive(Clone, Copy, Debug)]
pub(crate) struct PelvisPose {
    /// Midpoint of the hips, m.
    pub(crate) place_m: DVec3,
    /// Against the root's heading.
    pub(crate) rotation: DQuat,
    /// Yaw within it, radians.
    pub(crate) yaw_rad: f64,
}

/// Height by phase: mean, then (cosine, sine) of each harmonic of the whole clip, m.
#[derive(Clone, Debug)]
pub(crate) struct Height {
    mean_m: f64,
    strides: usize,
    harmonics_m: Vec<DVec2>,
}

impl Height {
    /// At a phase, m.
    pub(crate) fn at_m(&self, phase: f64) -> f64 {
        let (sin, cos) = libm::sincos(std::f64::consts::TAU * phase / self.strides as f64);
        let (base, mut turned) = (DVec2::new(cos, sin), DVec2::X);
        let mut height_m = self.mean_m;
        for harmonic_m in &self.harmonics_m {
            turned = base.rotate(turned);
            height_m += harmonic_m.dot(turned);
        }
        height_m
    }

    /// The height whose samples come nearest to the wanted ones.
    pub(crate) fn through(steps: &Steps, wanted_m: &[f64]) -> Self {
        let strides = steps.variation.strides();
        let harmonics_m = vec![DVec2::ZERO; HARMONICS * strides];
        let mut height = Self { mean_m: mean(wanted_m.iter().copied()), strides, harmonics_m };
        if steps.gait.running {
            height.harmonics_m[2 * strides - 1] = flight_harmonic_m(steps.gait);
            return height;
        }
        for (index, harmonic) in height.harmonics_m.iter_mut().enumerate() {
            let against = |shift: f64| {
                let angle = |i: usize| (index + 1) as f64 * phase_of(i) / strides as f64 - shift;
                2.0 * mean(wanted_m.iter().enumerate().map(|(i, z)| z * wave(angle(i))))
            };
            *harmonic = DVec2::new(against(0.0), against(0.25));
        }
        height
    }

    /// By how much the hips are too high for a leg to reach its ankle, m; 0 where it does.
    pub(crate) fn overstretch_m(&self, steps: &Steps, phase: f64, side: usize, ankle_m: DVec3) -> f64 {
        let highest_m = hips_over_m(steps, ankle_m, phase, side, reach_m(steps.gait.least_knee_rad));
        (self.at_m(phase) - highest_m).max(0.0)
    }

    /// All of it lower.
    pub(crate) fn lowered_by_m(&self, drop_m: f64) -> Self {
        Self { mean_m: self.mean_m - drop_m, ..self.clone() }
    }
}

/// The pelvis at a phase (0 at a left heel strike).
pub(crate) fn pose(steps: &Steps, height: &Height, phase: f64) -> PelvisPose {
    let mut pose = level_pose(steps, phase);
    pose.place_m.z = height.at_m(phase);
    pose
}

/// The pelvis without its height.
fn level_pose(steps: &Steps, phase: f64) -> PelvisPose {
    let Steps { gait, variation, .. } = steps;
    let swing = variation.of_pelvis(&gait.pelvis, phase);
    let since_mid_stance = phase - gait.mid_stance();
    let yaw_rad = -swing.rotation_rad * wave(phase - gait.yaw_peak);
    let list_rad = swing.list_rad * list_shape(phase) - BANK_SHARE * gait.upper_body.bank_rad;
    // List and bank outermost: about the heading they leave the facing alone.
    let tilt_rad = gait.style.tilt_beyond_standing_deg().to_radians();
    PelvisPose {
        place_m: DVec3::new(
            -swing.surge_m * wave(2.0 * since_mid_stance - 0.25),
            swing.sway_m * wave(since_mid_stance),
            0.0,
        ),
        rotation: about_x(list_rad) * about_z(yaw_rad) * about_y(tilt_rad),
        yaw_rad,
    }
}

/// The published obliquity, left side up, scaled to ±1; its even harmonics cancel between the sides.
fn list_shape(p: f64) -> f64 {
    (1.85 * wave(p) + 2.12 * wave(p - 0.25) - 1.19 * wave(3.0 * p) + 0.22 * wave(3.0 * p - 0.25)) / 4.0
}

/// The hip joint of a side, m.
pub(crate) fn hip_m(pelvis: &PelvisPose, side: usize) -> DVec3 {
    let outward = if side == 0 { HALF_HIP_M } else { -HALF_HIP_M };
    pelvis.place_m + pelvis.rotation * DVec3::new(0.0, outward, 0.0)
}

/// Heights over the clip at which the standing knees would have their published flexion, m.
pub(crate) fn wanted_heights_m(steps: &Steps) -> Vec<f64> {
    (0..SAMPLES * steps.variation.strides()).map(|sample| wanted_height_m(steps, phase_of(sample))).collect()
}

fn wanted_height_m(steps: &Steps, phase: f64) -> f64 {
    let gait = steps.gait;
    let (mut sum, mut weights) = (0.0, 0.0);
    for side in 0..2 {
        let (stance, p) = steps.stance_at(side, phase);
        if p > gait.toe_off {
            continue;
        }
        let knee_rad = gait.style.flexion(p, gait.toe_off).knee_deg.to_radians();
        let until_other = if gait.running { gait.toe_off } else { 0.5 };
        let weight = (until_other - p) / HANDOVER_SHARE;
        let weight = weight.clamp(0.0, 1.0) + 1e-6;
        sum += weight * hips_over_m(steps, stance.foot(p).ankle_m, phase, side, reach_m(knee_rad));
        weights += weight;
    }
    if weights > 0.0 { sum / weights } else { 0.53 * HEIGHT_M }
}

/// Height of the hips' midpoint at which a leg spans `reach_m`.
fn hips_over_m(steps: &Steps, ankle_m: DVec3, phase: f64, side: usize, reach_m: f64) -> f64 {
    let hip_m = hip_m(&level_pose(steps, phase), side);
    let aside_squared = (hip_m - ankle_m).truncate().length_squared();
    ankle_m.z + libm::sqrt((reach_m * reach_m - aside_squared).max(0.0)) - hip_m.z
}

/// Lowest at both mid-stances.
fn flight_harmonic_m(gait: &Gait) -> DVec2 {
    let step_rate_rad_s = 2.0 * std::f64::consts::TAU / gait.period_s();
    let amplitude_m = GRAVITY_MPS2 / (step_rate_rad_s * step_rate_rad_s);
    let angle = 2.0 * gait.mid_stance();
    -amplitude_m * DVec2::new(wave(angle), wave(angle - 0.25))
}

/// Phase of a sample.
pub(crate) fn phase_of(sample: usize) -> f64 {
    sample as f64 / SAMPLES as f64
}

fn mean(values: impl ExactSizeIterator<Item = f64>) -> f64 {
    let count = values.len() as f64;
    values.sum::<f64>() / count
}

//! The pelvis about the root's path: height, sway, surge, list, rotation, tilt.
//!
//! Walking: the pelvis rides over the stance leg as over an inverted pendulum. Its height is the one at which the
//! stance knee would have its published flexion, smoothed to four waves a stride and lowered wherever a leg,
//! standing or about to strike, would be overstretched. Running: at the top of flight the hips fall with g, which at
//! the step's frequency gives the amplitude g/(4π/P)² (3.3 cm at 2.7 steps/s: a drop of 7 cm). The list has the
//! published shape (Schwartz et al. 2008, free class), the rotation its amplitude. Root frame: x forward, y left, z up,
//! metres, radians.

use glam::{DQuat, DVec2, DVec3};

use crate::body::leg_ik::reach_m;
use crate::body::rotation::{about_x, about_y, about_z, wave};
use crate::body::skeleton::{HALF_HIP_M, HEIGHT_M};
use crate::motion::steps::PlannedSteps;
use crate::plan::GaitPlan;
use crate::plan::published_curves::GRAVITY_MPS2;

/// Samples of each stride to which the height is fitted.
const SAMPLES: usize = 120;
/// Fastest wave of the fitted height, per stride; the slowest is one wave over the clip.
const HARMONICS: usize = 4;
/// Share of the stride, before the other foot strikes, over which the weight of the trailing leg in the height fades.
const HANDOVER_SHARE: f64 = 0.05;
/// Share of a turn's bank that the pelvis takes.
const BANK_SHARE: f64 = 0.70;

/// The pelvis at one moment.
#[derive(Clone, Copy, Debug)]
pub(crate) struct PelvisPose {
    /// Midpoint of the hips, root frame, m.
    pub(crate) hips_m: DVec3,
    /// Orientation against the root's heading.
    pub(crate) rotation: DQuat,
    /// Yaw within `rotation`, rad.
    pub(crate) yaw_rad: f64,
}

/// Height of the hips as a function of the phase: a Fourier series over the whole clip.
#[derive(Clone, Debug)]
pub(crate) struct PelvisHeight {
    /// Mean height, m.
    mean_m: f64,
    /// Strides of the clip.
    strides: usize,
    /// (Cosine, sine) of each harmonic, m.
    harmonics_m: Vec<DVec2>,
}

impl PelvisHeight {
    /// Height at a phase, m.
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

    /// The height whose samples are nearest to the given ones.
    pub(crate) fn through(steps: &PlannedSteps, samples_m: &[f64]) -> Self {
        let strides = steps.variation.strides();
        let harmonics_m = vec![DVec2::ZERO; HARMONICS * strides];
        let mut height = Self { mean_m: mean(samples_m.iter().copied()), strides, harmonics_m };
        if steps.gait.running {
            height.harmonics_m[2 * strides - 1] = flight_harmonic_m(steps.gait);
            return height;
        }
        for (index, harmonic) in height.harmonics_m.iter_mut().enumerate() {
            let against = |shift: f64| {
                let angle = |i: usize| (index + 1) as f64 * phase_of(i) / strides as f64 - shift;
                2.0 * mean(samples_m.iter().enumerate().map(|(i, z)| z * wave(angle(i))))
            };
            *harmonic = DVec2::new(against(0.0), against(0.25));
        }
        height
    }

    /// Height of the hips above the greatest at which a leg reaches its ankle, m; 0 where it reaches.
    pub(crate) fn overstretch_m(&self, steps: &PlannedSteps, phase: f64, side: usize, ankle_m: DVec3) -> f64 {
        let highest_m = hips_over_m(steps, ankle_m, phase, side, reach_m(steps.gait.least_knee_rad));
        (self.at_m(phase) - highest_m).max(0.0)
    }

    /// The same heights, lowered.
    pub(crate) fn lowered_by_m(&self, drop_m: f64) -> Self {
        Self { mean_m: self.mean_m - drop_m, ..self.clone() }
    }
}

/// The pelvis at a phase, strides (0 at a left heel strike).
pub(crate) fn pelvis_pose(steps: &PlannedSteps, height: &PelvisHeight, phase: f64) -> PelvisPose {
    let mut pose = level_pose(steps, phase);
    pose.hips_m.z = height.at_m(phase);
    pose
}

/// The pelvis without its height.
fn level_pose(steps: &PlannedSteps, phase: f64) -> PelvisPose {
    let PlannedSteps { gait, variation, .. } = steps;
    let amplitudes = variation.of_pelvis(&gait.pelvis, phase);
    let since_mid_stance = phase - gait.mid_stance();
    let yaw_rad = -amplitudes.rotation_rad * wave(phase - gait.yaw_peak);
    let list_rad = amplitudes.list_rad * list_shape(phase) - BANK_SHARE * gait.upper_body.bank_rad;
    // List and bank are outermost: about the heading they do not change the facing.
    let tilt_rad = gait.style.tilt_beyond_standing_deg().to_radians();
    PelvisPose {
        hips_m: DVec3::new(
            -amplitudes.surge_m * wave(2.0 * since_mid_stance - 0.25),
            amplitudes.sway_m * wave(since_mid_stance),
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

/// Position of the hip joint of a side, root frame, m.
pub(crate) fn hip_m(pelvis: &PelvisPose, side: usize) -> DVec3 {
    let outward = if side == 0 { HALF_HIP_M } else { -HALF_HIP_M };
    pelvis.hips_m + pelvis.rotation * DVec3::new(0.0, outward, 0.0)
}

/// Heights over the clip at which the stance knees have their published flexion, m.
pub(crate) fn published_heights_m(steps: &PlannedSteps) -> Vec<f64> {
    (0..SAMPLES * steps.variation.strides()).map(|sample| published_height_m(steps, phase_of(sample))).collect()
}

/// Height of the hips at which the stance knees have their published flexion, m; of both legs the weighted mean.
fn published_height_m(steps: &PlannedSteps, phase: f64) -> f64 {
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

/// Height of the hips' midpoint at which hip and ankle of a leg are `reach_m` apart, m.
fn hips_over_m(steps: &PlannedSteps, ankle_m: DVec3, phase: f64, side: usize, reach_m: f64) -> f64 {
    let hip_m = hip_m(&level_pose(steps, phase), side);
    let aside_squared = (hip_m - ankle_m).truncate().length_squared();
    ankle_m.z + libm::sqrt((reach_m * reach_m - aside_squared).max(0.0)) - hip_m.z
}

/// (Cosine, sine) of the hips' free fall in flight, m: lowest at both mid-stances.
fn flight_harmonic_m(gait: &GaitPlan) -> DVec2 {
    let step_rate_rad_s = 2.0 * std::f64::consts::TAU / gait.period_s();
    let amplitude_m = GRAVITY_MPS2 / (step_rate_rad_s * step_rate_rad_s);
    let angle = 2.0 * gait.mid_stance();
    -amplitude_m * DVec2::new(wave(angle), wave(angle - 0.25))
}

/// Phase of a sample, strides.
pub(crate) fn phase_of(sample: usize) -> f64 {
    sample as f64 / SAMPLES as f64
}

/// The arithmetic mean of at least one value.
fn mean(values: impl ExactSizeIterator<Item = f64>) -> f64 {
    let count = values.len() as f64;
    values.sum::<f64>() / count
}

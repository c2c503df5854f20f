//! The pelvis about the root's path: height, sway, surge, list, rotation, tilt.
//!
//! Walking: the pelvis rides over the stance leg as over an inverted pendulum. Its height is the one at which the
//! stance knee would have its published flexion, smoothed to four harmonics of the stride and lowered wherever a leg,
//! standing or about to strike, would be overstretched. Running: at the top of flight the hips fall with g, which at
//! the step's frequency gives the amplitude g/(4π/P)² (3.3 cm at 2.7 steps/s: a drop of 7 cm). The list has the
//! published shape (Schwartz et al. 2008, free class), the rotation its amplitude. Root frame, metres.

use glam::{DQuat, DVec3};

use crate::body::{HALF_HIP_M, HEIGHT_M};
use crate::cadence::Gait;
use crate::footsteps::leg_phase;
use crate::legs::reach_m;
use crate::rotation::{about_x, about_y, about_z, wave};
use crate::swing::Stance;

const GRAVITY_MPS2: f64 = 9.81;
/// Samples of the stride when fitting the height.
pub(crate) const SAMPLES: usize = 120;
/// Harmonics of the stride in the fitted height.
const HARMONICS: usize = 4;
/// The trailing leg's say in the height fades over this share of the stride before the other foot strikes.
const HANDOVER_SHARE: f64 = 0.05;
/// Share of a turn's bank that the pelvis takes.
const BANK_SHARE: f64 = 0.6;
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

/// Height by cycle phase: mean, then (cosine, sine) of each harmonic, m.
#[derive(Clone, Debug)]
pub(crate) struct Height {
    mean_m: f64,
    harmonics_m: [[f64; 2]; HARMONICS],
}

impl Height {
    /// At a cycle phase, m.
    pub(crate) fn at_m(&self, cycle_phase: f64) -> f64 {
        let mut height_m = self.mean_m;
        for (index, [cosine, sine]) in self.harmonics_m.iter().enumerate() {
            let angle = (index + 1) as f64 * cycle_phase;
            height_m += cosine * wave(angle) + sine * wave(angle - 0.25);
        }
        height_m
    }

    /// The height whose samples come nearest to the wanted ones.
    pub(crate) fn through(gait: &Gait, wanted_m: &[f64; SAMPLES]) -> Self {
        let mut height = Self { mean_m: mean(wanted_m.iter().copied()), harmonics_m: [[0.0; 2]; HARMONICS] };
        if gait.running {
            height.harmonics_m[1] = flight_harmonic_m(gait);
            return height;
        }
        for (index, harmonic) in height.harmonics_m.iter_mut().enumerate() {
            let against = |shift: f64| {
                let angle = |i: usize| (index + 1) as f64 * phase_of(i) - shift;
                2.0 * mean(wanted_m.iter().enumerate().map(|(i, z)| z * wave(angle(i))))
            };
            *harmonic = [against(0.0), against(0.25)];
        }
        height
    }

    /// By how much the hips are too high for a leg to reach its ankle, m; 0 where it does.
    pub(crate) fn overstretch_m(&self, gait: &Gait, cycle_phase: f64, side: usize, ankle_m: DVec3) -> f64 {
        (self.at_m(cycle_phase) - hips_over_m(gait, ankle_m, cycle_phase, side, reach_m(gait.least_knee_rad))).max(0.0)
    }

    /// All of it lower.
    pub(crate) fn lowered_by_m(&self, drop_m: f64) -> Self {
        Self { mean_m: self.mean_m - drop_m, ..self.clone() }
    }
}

/// The pelvis at a cycle phase (0 at the left heel strike).
pub(crate) fn pose(gait: &Gait, height: &Height, cycle_phase: f64) -> PelvisPose {
    let mut pose = level_pose(gait, cycle_phase);
    pose.place_m.z = height.at_m(cycle_phase);
    pose
}

/// The pelvis without its height.
fn level_pose(gait: &Gait, cycle_phase: f64) -> PelvisPose {
    let swing = &gait.pelvis;
    let since_mid_stance = cycle_phase - gait.mid_stance();
    let yaw_rad = -swing.rotation_rad * wave(cycle_phase - gait.yaw_peak);
    let list_rad = swing.list_rad * list_shape(cycle_phase) - BANK_SHARE * gait.upper_body.bank_rad;
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

/// Heights over the stride at which the standing knees would have their published flexion, m.
pub(crate) fn wanted_heights_m(gait: &Gait, stances: &[Stance; 2]) -> [f64; SAMPLES] {
    std::array::from_fn(|sample| wanted_height_m(gait, stances, phase_of(sample)))
}

fn wanted_height_m(gait: &Gait, stances: &[Stance; 2], cycle_phase: f64) -> f64 {
    let (mut sum, mut weights) = (0.0, 0.0);
    for (side, stance) in stances.iter().enumerate() {
        let Some(p) = standing_phase(gait, cycle_phase, side) else { continue };
        let knee_rad = gait.style.flexion(p, gait.toe_off).knee_deg.to_radians();
        let until_other = if gait.running { gait.toe_off } else { 0.5 };
        let weight = (until_other - p) / HANDOVER_SHARE;
        let weight = weight.clamp(0.0, 1.0) + 1e-6;
        sum += weight * hips_over_m(gait, stance.foot(p).ankle_m, cycle_phase, side, reach_m(knee_rad));
        weights += weight;
    }
    if weights > 0.0 { sum / weights } else { 0.53 * HEIGHT_M }
}

/// Height of the hips' midpoint at which a leg spans `reach_m`.
fn hips_over_m(gait: &Gait, ankle_m: DVec3, cycle_phase: f64, side: usize, reach_m: f64) -> f64 {
    let hip_m = hip_m(&level_pose(gait, cycle_phase), side);
    let aside_squared = (hip_m - ankle_m).truncate().length_squared();
    ankle_m.z + libm::sqrt((reach_m * reach_m - aside_squared).max(0.0)) - hip_m.z
}

/// The leg's phase where it stands.
fn standing_phase(gait: &Gait, cycle_phase: f64, side: usize) -> Option<f64> {
    let p = leg_phase(cycle_phase, side);
    (p <= gait.toe_off).then_some(p)
}

/// Lowest at both mid-stances.
fn flight_harmonic_m(gait: &Gait) -> [f64; 2] {
    let step_rate_rad_s = 2.0 * std::f64::consts::TAU / gait.period_s();
    let amplitude_m = GRAVITY_MPS2 / (step_rate_rad_s * step_rate_rad_s);
    let angle = 2.0 * gait.mid_stance();
    [-amplitude_m * wave(angle), -amplitude_m * wave(angle - 0.25)]
}

/// Cycle phase of a sample.
pub(crate) fn phase_of(sample: usize) -> f64 {
    sample as f64 / SAMPLES as f64
}

fn mean(values: impl ExactSizeIterator<Item = f64>) -> f64 {
    let count = values.len() as f64;
    values.sum::<f64>() / count
}

//! Published flexion curves of hip, knee and ankle over a gait cycle, by speed.
//!
//! Walking: means of Schwartz, Rozumalski, Trost (2008), *J. Biomech.* 41, five classes of v* = v/√(g·leg), as Fourier
//! series f(p) = a0 + Σ (a_k cos 2πkp + b_k sin 2πkp), p = 0 at the leg's heel strike. Between two classes the curves
//! are mixed by v*. Jogging: ten samples a cycle at 2.8 m/s, joined by the trigonometric polynomial through them.
//! Degrees; flexion and dorsiflexion positive; the hip is counted against the pelvis, which tilts forward.

use crate::body::skeleton::{SHANK_M, THIGH_M};

/// v* in the middle of the five classes: very slow, slow, free, fast, very fast.
const CLASS_CENTRES: [f64; 5] = [0.19, 0.295, 0.4315, 0.568, 0.70];
/// Published phase of toe-off in each class.
const CLASS_TOE_OFF: [f64; 5] = [0.68, 0.62, 0.59, 0.58, 0.56];
/// Mean forward tilt of the pelvis in each class, degrees.
const CLASS_TILT_DEG: [f64; 5] = [12.0, 11.0, 11.6, 13.3, 16.6];
/// Phase of toe-off in the jog.
const JOG_TOE_OFF: f64 = 0.36;
/// Mean forward tilt of the pelvis in the jog, degrees.
const JOG_TILT_DEG: f64 = 17.0;
/// Acceleration of gravity g, m/s².
pub(crate) const GRAVITY_MPS2: f64 = 9.81;

/// a0, then (a_k, b_k), degrees.
type FourierSeries = (f64, &'static [(f64, f64)]);

/// Flexion of the hip against the pelvis in each class.
#[expect(clippy::approx_constant, reason = "−3.14 is a published coefficient")]
const HIP: [FourierSeries; 5] = [
    (16.78, &[(14.20, -1.13), (-0.09, -3.08), (-0.49, 0.46), (0.02, -0.07)]),
    (17.70, &[(17.41, -3.32), (-2.16, -2.44), (-0.07, 1.48), (0.09, -0.17)]),
    (18.45, &[(20.87, -3.19), (-3.14, -1.54), (-0.10, 1.62), (-0.10, -0.09)]),
    (20.01, &[(24.01, -3.32), (-3.90, -0.89), (-0.08, 1.71), (-0.12, -0.05)]),
    (22.44, &[(25.71, -4.96), (-4.29, -1.22), (-0.31, 1.48), (-0.19, 0.03)]),
];
/// Flexion of the knee in each class.
const KNEE: [FourierSeries; 5] = [
    (16.13, &[(-0.35, -15.44), (-9.39, -0.36), (-1.68, 3.65), (0.20, 0.70), (-0.23, 0.32), (0.01, 0.22)]),
    (20.02, &[(-2.94, -18.26), (-12.21, 4.51), (-0.04, 4.59), (-0.17, 0.30), (-0.48, 0.60), (0.13, 0.26)]),
    (22.87, &[(-1.91, -18.75), (-13.63, 7.00), (-0.70, 4.31), (-0.87, 0.63), (-0.54, 0.73), (0.07, 0.20)]),
    (24.00, &[(-0.39, -18.99), (-14.04, 9.08), (-0.73, 4.20), (-1.12, 0.52), (-0.50, 0.69), (0.02, 0.06)]),
    (23.43, &[(1.13, -21.48), (-13.81, 9.22), (-0.82, 3.69), (-1.29, 0.38), (-0.32, 0.51), (0.02, -0.06)]),
];
/// Dorsiflexion of the ankle in each class.
const ANKLE: [FourierSeries; 5] = [
    (3.15, &[(-6.09, 1.22), (1.83, -3.30), (-2.73, -1.73), (-0.14, 0.94), (0.52, -0.26), (0.03, -0.10)]),
    (2.00, &[(-4.97, 4.14), (1.81, -5.89), (-4.30, -0.19), (1.60, 1.25), (0.36, -1.44), (-0.20, 0.26)]),
    (0.75, &[(-2.05, 7.09), (0.82, -7.22), (-4.60, 0.86), (2.20, 0.24), (-0.52, -1.38), (0.26, 0.55)]),
    (-0.62, &[(0.16, 7.49), (-1.13, -7.48), (-4.15, 1.72), (2.09, -0.76), (-0.94, -0.86), (0.61, 0.35)]),
    (-1.29, &[(2.52, 6.80), (-3.35, -7.57), (-2.97, 2.03), (1.38, -1.27), (-0.69, -0.28), (0.59, -0.01)]),
];

/// Flexion of the hip in the jog, at tenths of the cycle, degrees.
const JOG_HIP: [f64; 10] = [38.0, 33.0, 17.0, 2.0, -7.0, 4.0, 23.0, 42.0, 51.0, 46.0];
/// Flexion of the knee in the jog, at tenths of the cycle, degrees.
const JOG_KNEE: [f64; 10] = [18.0, 41.0, 43.0, 24.0, 27.0, 59.0, 89.0, 93.0, 65.0, 28.0];
/// Dorsiflexion of the ankle in the jog, at tenths of the cycle, degrees.
const JOG_ANKLE: [f64; 10] = [5.0, 17.0, 23.0, 1.0, -21.0, -12.0, -2.0, 3.0, 5.0, 7.0];

/// The published curves that a gait follows.
#[derive(Clone, Copy, Debug)]
pub(crate) enum PublishedGait {
    /// Schwartz's walking curves.
    Walk {
        /// Normalised speed v* = v/√(g·leg).
        normalised_speed: f64,
    },
    /// The jogging curves.
    Jog,
}

/// Angles of a leg in the sagittal plane, degrees.
#[derive(Clone, Copy, Debug)]
pub struct LegFlexion {
    /// Angle of the thigh to the vertical, positive forward: hip flexion less pelvic tilt.
    pub thigh_deg: f64,
    /// Flexion of the knee.
    pub knee_deg: f64,
    /// Dorsiflexion of the ankle.
    pub ankle_deg: f64,
}

impl PublishedGait {
    /// The walking curves of a speed.
    pub(crate) fn walk(speed_mps: f64) -> Self {
        Self::Walk { normalised_speed: speed_mps / libm::sqrt(GRAVITY_MPS2 * (THIGH_M + SHANK_M)) }
    }

    /// The curves at phase `p` since the leg's heel strike, warped in time so that their toe-off falls on `toe_off`.
    pub(crate) fn flexion(&self, p: f64, toe_off: f64) -> LegFlexion {
        match *self {
            Self::Jog => {
                let q = warped(p, toe_off, JOG_TOE_OFF);
                let thigh_deg = through_samples(&JOG_HIP, q) - JOG_TILT_DEG;
                LegFlexion {
                    thigh_deg,
                    knee_deg: through_samples(&JOG_KNEE, q),
                    ankle_deg: through_samples(&JOG_ANKLE, q),
                }
            }
            Self::Walk { normalised_speed } => {
                let mix = |values: &[f64; 5]| mixed(normalised_speed, |class| values[class]);
                let q = warped(p, toe_off, mix(&CLASS_TOE_OFF));
                let curve =
                    |series: &[FourierSeries; 5]| mixed(normalised_speed, |class| series_value(&series[class], q));
                let thigh_deg = curve(&HIP) - mix(&CLASS_TILT_DEG);
                LegFlexion { thigh_deg, knee_deg: curve(&KNEE), ankle_deg: curve(&ANKLE) }
            }
        }
    }

    /// Forward tilt of the pelvis beyond that of the free class, which counts as standing, degrees.
    pub(crate) fn tilt_beyond_standing_deg(&self) -> f64 {
        match *self {
            Self::Jog => 0.5 * (JOG_TILT_DEG - CLASS_TILT_DEG[2]),
            Self::Walk { normalised_speed } => {
                0.5 * (mixed(normalised_speed, |class| CLASS_TILT_DEG[class]) - CLASS_TILT_DEG[2])
            }
        }
    }
}

impl LegFlexion {
    /// Position of the ankle relative to the hip, `[ahead, up]`, m; up is negative.
    pub(crate) fn ankle_from_hip_m(&self) -> [f64; 2] {
        let (thigh_sin, thigh_cos) = libm::sincos(self.thigh_deg.to_radians());
        let (shank_sin, shank_cos) = libm::sincos((self.thigh_deg - self.knee_deg).to_radians());
        [THIGH_M * thigh_sin + SHANK_M * shank_sin, -THIGH_M * thigh_cos - SHANK_M * shank_cos]
    }

    /// Pitch of the sole, rad; positive with the toes up.
    pub(crate) fn foot_pitch_rad(&self) -> f64 {
        (self.thigh_deg - self.knee_deg + self.ankle_deg).to_radians()
    }
}

/// Phase of the published curves: maps [0, `toe_off`] on [0, `published`] and the rest on the rest.
fn warped(p: f64, toe_off: f64, published: f64) -> f64 {
    if p < toe_off { p * published / toe_off } else { 1.0 - (1.0 - p) * (1.0 - published) / (1.0 - toe_off) }
}

/// A value mixed from the two classes on either side of v*; the outermost class beyond.
fn mixed(normalised_speed: f64, of_class: impl Fn(usize) -> f64) -> f64 {
    let above = CLASS_CENTRES.partition_point(|centre| *centre < normalised_speed).clamp(1, 4);
    let (low, high) = (CLASS_CENTRES[above - 1], CLASS_CENTRES[above]);
    let share = ((normalised_speed - low) / (high - low)).clamp(0.0, 1.0);
    of_class(above - 1) * (1.0 - share) + of_class(above) * share
}

/// Value of a series at phase `p`, degrees.
fn series_value(series: &FourierSeries, p: f64) -> f64 {
    let mut sum = series.0;
    for (index, (a, b)) in series.1.iter().enumerate() {
        let (sin, cos) = libm::sincos(std::f64::consts::TAU * (index + 1) as f64 * p);
        sum += a * cos + b * sin;
    }
    sum
}

/// The trigonometric polynomial through ten samples: Σ y_j D(p − j/10), D the Dirichlet kernel.
fn through_samples(samples: &[f64; 10], p: f64) -> f64 {
    let kernel = |x: f64| {
        let cosine = |k: i32| libm::cos(std::f64::consts::TAU * f64::from(k) * x);
        (1.0 + 2.0 * (cosine(1) + cosine(2) + cosine(3) + cosine(4)) + cosine(5)) / 10.0
    };
    samples.iter().enumerate().map(|(j, y)| y * kernel(p - j as f64 / 10.0)).sum()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn free_walks_have_human_knee_angles() {
        let style = PublishedGait::Walk { normalised_speed: 0.4315 };
        assert!(style.flexion(0.0, 0.59).knee_deg < 10.0);
        let peak = (0..100).map(|i| style.flexion(f64::from(i) / 100.0, 0.62).knee_deg).fold(0.0, f64::max);
        assert!((55.0..65.0).contains(&peak), "{peak}");
    }

    #[test]
    fn the_jog_passes_through_its_samples() {
        assert!((through_samples(&JOG_KNEE, 0.7) - 93.0).abs() < 1e-9);
        assert!((through_samples(&JOG_KNEE, 0.15) - 46.0).abs() < 4.0);
    }
}

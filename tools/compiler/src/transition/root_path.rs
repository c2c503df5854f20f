//! The path of the root over a transition: smooth, at both ends with the position, the direction and the velocities of
//! the examples there, between them as near to the body as a path without the oscillation of steps can be.
//!
//! Each of x, y and facing is a polynomial of the share s of the duration:
//!
//! ```text
//! p(s) = h(s) + s²·(1 − s)²·(c₀ + c₁·s + …)
//! ```
//!
//! h is the cubic of the ends (Hermite). The second term is 0 at both ends with its derivative. Its few coefficients are
//! those of least squares: p then has no room for the oscillation of steps, as definition "Root trajectory" of
//! `docs/definitions.md` requires. Metres, seconds, radians; the velocities of the ends are in the world.

use glam::DVec3;

use crate::ground::root_arc::Rates;
use crate::ground::rotations::ground_rotation;
use crate::transition::joint_state::Placement;

/// Coefficients of the path beside the cubic. Two of them follow the sway of a body over 1.5 s, one follows a fifth.
const COEFFICIENTS: usize = 1;
/// Duration for each further coefficient, s: nearly two strides, so that the path follows turns but no steps.
const FURTHER_S: f64 = 2.0;

/// A root at an end of a path, and the rates at which it moves there.
#[derive(Clone, Copy, Debug)]
pub(crate) struct PathEnd {
    /// Position and facing; the facing of the last end has no jump of 2π from that of the first.
    pub(crate) root: Placement,
    /// Rates in its own frame.
    pub(crate) rates: Rates,
}

impl PathEnd {
    /// Position and facing as one vector (m, m, rad).
    fn value(&self) -> DVec3 {
        let (position_m, facing_rad) = self.root;
        position_m.extend(facing_rad)
    }

    /// Rate of change of [`PathEnd::value`], 1/s.
    fn rate(&self) -> DVec3 {
        let Rates { speed_mps, turn_rate_rad_s, strafe_mps } = self.rates;
        let velocity_mps = ground_rotation(self.root.1) * glam::DVec2::new(speed_mps, strafe_mps);
        velocity_mps.extend(turn_rate_rad_s)
    }
}

/// The roots of a transition at uniform times, from the first end to the last, near `followed`: position and facing of
/// the body at each time, from which the root may differ as at the ends.
pub(crate) fn root_path(ends: &[PathEnd; 2], followed: &[Placement], duration_s: f64) -> Vec<Placement> {
    let last = followed.len() - 1;
    let share = |index: usize| index as f64 / last as f64;
    let body = |index: usize| followed[index].0.extend(followed[index].1);
    let gaps = [ends[0].value() - body(0), ends[1].value() - body(last)];
    let cubic: Vec<DVec3> = (0..=last).map(|index| hermite(ends, share(index), duration_s)).collect();
    let left_over: Vec<DVec3> =
        (0..=last).map(|index| body(index) + gaps[0].lerp(gaps[1], share(index)) - cubic[index]).collect();
    let mut path = cubic;
    for basis in orthonormal_basis(last + 1, COEFFICIENTS + (duration_s / FURTHER_S) as usize) {
        let coefficient: DVec3 = basis.iter().zip(&left_over).map(|(value, left)| *left * *value).sum();
        path.iter_mut().zip(&basis).for_each(|(point, value)| *point += coefficient * *value);
    }
    path.into_iter().map(|point| (point.truncate(), point.z)).collect()
}

/// The cubic of both ends at a share of the duration.
fn hermite(ends: &[PathEnd; 2], share: f64, duration_s: f64) -> DVec3 {
    let (s, rest) = (share, 1.0 - share);
    let values = ends[0].value() * (1.0 + 2.0 * s) * rest * rest + ends[1].value() * s * s * (3.0 - 2.0 * s);
    values + (ends[0].rate() * s * rest * rest - ends[1].rate() * s * s * rest) * duration_s
}

/// s²·(1 − s)²·sᵏ at uniform shares, made orthonormal by Gram and Schmidt.
fn orthonormal_basis(count: usize, size: usize) -> Vec<Vec<f64>> {
    let mut basis: Vec<Vec<f64>> = Vec::new();
    for power in 0..size.min(count.saturating_sub(2)) {
        let value = |index: usize| {
            let s = index as f64 / (count - 1) as f64;
            let window = s * (1.0 - s);
            (0..power).fold(window * window, |product, _| product * (2.0 * s - 1.0))
        };
        let mut function: Vec<f64> = (0..count).map(value).collect();
        for other in &basis {
            let along: f64 = function.iter().zip(other).map(|(a, b)| a * b).sum();
            function.iter_mut().zip(other).for_each(|(a, b)| *a -= along * b);
        }
        let length = libm::sqrt(function.iter().map(|value| value * value).sum());
        basis.push(function.into_iter().map(|value| value / length).collect());
    }
    basis
}

#[cfg(test)]
mod tests {
    use std::f64::consts::TAU;

    use glam::DVec2;

    use super::*;

    /// A body that speeds up evenly to 1.2 m/s within 1.5 s while it sways by 3 cm with its steps.
    #[test]
    fn a_start_follows_the_body_without_its_sway() {
        let count = 91;
        let true_m = |time_s: f64| 0.4 * time_s * time_s;
        let followed = |index: usize| {
            let time_s = index as f64 / 60.0;
            let sway_m = 0.03 * libm::sin(TAU * time_s / 1.1);
            (DVec2::new(true_m(time_s), sway_m), 0.05 * libm::sin(TAU * time_s / 1.1))
        };
        let followed: Vec<Placement> = (0..count).map(followed).collect();
        let rates = Rates { speed_mps: 1.2, ..Rates::default() };
        let end = |x_m: f64, rates| PathEnd { root: (DVec2::new(x_m, 0.0), 0.0), rates };
        let ends = [end(0.0, Rates::default()), end(true_m(1.5), rates)];
        let path = root_path(&ends, &followed, 1.5);
        assert_eq!((path[0], path[count - 1]), (ends[0].root, ends[1].root));
        for (index, (position_m, _)) in path.iter().enumerate() {
            assert!((position_m.x - true_m(index as f64 / 60.0)).abs() < 0.01, "{index}: {position_m}");
            assert!(position_m.y.abs() < 0.025, "{index}: {position_m}");
        }
        let speed_mps = |index: usize| path[index + 1].0.distance(path[index].0) * 60.0;
        assert!(speed_mps(0) < 0.03 && (speed_mps(count - 2) - 1.2).abs() < 0.03);
    }
}

//! Forces between agents, and from walls, by the universal power law (`FbCrowd` §4.3, App. 9.1, Eq. 11).
//!
//! The force is the gradient of the energy E(τ) = k τ⁻² e^(−τ/τ_0) of the time to collision τ (Karamouzas, Skinner, Guy
//! 2014), in closed form. Walls act alike, on the capsule of a segment grown by the agent's radius. Masses are 1, so
//! forces are accelerations. World axes, metres, seconds.

use glam::Vec2;

use crate::world::time_to_collision::{disc_with_disc, disc_with_side, discriminant};

/// Least time to collision, s: keeps the force finite, far above the limit of the acceleration.
const TIME_MIN_S: f32 = 1e-2;

/// The two constants of the interaction.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct PowerLaw {
    /// k: strength, m².
    pub(crate) strength: f32,
    /// τ_0: time ahead beyond which interactions fade, s.
    pub(crate) horizon_s: f32,
}

/// f_ij: the force on disc i from disc j, m/s², given p_j − p_i, v_i − v_j and r_i + r_j.
pub(crate) fn agent_force_mps2(offset_m: Vec2, relative_mps: Vec2, radius_m: f32, law: &PowerLaw) -> Vec2 {
    // Discs that overlap shrink to the depth of their overlap, as in the authors' code, whose values `fbcrowd bench
    // table1 --discs` reproduces. Overlaps of more than half are left to the half-plane.
    let distance_m = offset_m.length();
    let radius_m = if distance_m < radius_m { radius_m - distance_m } else { radius_m };
    let time_s = disc_with_disc(offset_m, relative_mps, radius_m);
    if time_s <= 0.0 || time_s.is_infinite() {
        return Vec2::ZERO;
    }
    let speed_squared = relative_mps.length_squared();
    let approach = relative_mps.dot(offset_m);
    let root = discriminant(offset_m, relative_mps, radius_m).sqrt();
    let along = relative_mps - (approach * relative_mps - speed_squared * offset_m) / root;
    -steepness(time_s, law) / speed_squared * along // Eq. 11
}

/// f_iW: the force from a wall's segment, m/s²; `ends_m` are relative to the disc's centre.
pub(crate) fn wall_force_mps2(ends_m: [Vec2; 2], velocity_mps: Vec2, radius_m: f32, law: &PowerLaw) -> Vec2 {
    let side_s = disc_with_side(ends_m, velocity_mps, radius_m);
    let ends_s = ends_m.map(|end_m| disc_with_disc(end_m, velocity_mps, radius_m));
    if side_s > ends_s[0].min(ends_s[1]) || side_s.is_infinite() {
        let nearer = usize::from(ends_s[1] < ends_s[0]);
        return agent_force_mps2(ends_m[nearer], velocity_mps, radius_m, law);
    }
    let along = (ends_m[1] - ends_m[0]).normalize();
    steepness(side_s, law) / velocity_mps.perp_dot(along) * along.perp()
}

/// −dE/dτ = k e^(−τ/τ_0) τ⁻² (2/τ + 1/τ_0).
fn steepness(time_s: f32, law: &PowerLaw) -> f32 {
    let time_s = time_s.max(TIME_MIN_S);
    let energy = law.strength * libm::expf(-time_s / law.horizon_s) / (time_s * time_s);
    energy * (2.0 / time_s + 1.0 / law.horizon_s)
}

#[cfg(test)]
mod tests {
    use proptest::prelude::*;

    use super::*;
    use crate::world::time_to_collision::disc_with_segment;

    const LAW: PowerLaw = PowerLaw { strength: 1.5, horizon_s: 3.0 };

    fn vector(bound: f32) -> impl Strategy<Value = Vec2> {
        (-bound..bound, -bound..bound).prop_map(Vec2::from)
    }

    /// E(τ) = k τ⁻² e^(−τ/τ_0), in f64 from here on, so that its differences mean something.
    fn energy(time_s: f32) -> f64 {
        let time_s = f64::from(time_s);
        f64::from(LAW.strength) / (time_s * time_s) * libm::exp(-time_s / f64::from(LAW.horizon_s))
    }

    /// −∇E by the own position, by central differences.
    fn downhill(time_s: impl Fn(Vec2) -> f32) -> Vec2 {
        let step_m = 4e-3;
        let along = |axis: Vec2| energy(time_s(axis * step_m)) - energy(time_s(-axis * step_m));
        -Vec2::new(along(Vec2::X) as f32, along(Vec2::Y) as f32) / (2.0 * step_m)
    }

    /// Differences over 8 mm are off by some per cent where a disc of 0.2 m curves away from the path.
    fn check(force_mps2: Vec2, expected_mps2: Vec2) {
        let tolerance = 0.1 * expected_mps2.length() + 0.02;
        assert!(force_mps2.distance(expected_mps2) < tolerance, "{force_mps2} {expected_mps2}");
    }

    proptest! {
        #![proptest_config(ProptestConfig::with_cases(2000))]

        #[test]
        fn agent_force_is_slope_of_energy(
            offset in vector(4.0), velocity in vector(2.0), radius in 0.3f32..0.8,
        ) {
            let time_s = |moved| disc_with_disc(offset - moved, velocity, radius);
            let force_mps2 = agent_force_mps2(offset, velocity, radius, &LAW);
            let now_s = time_s(Vec2::ZERO);
            prop_assert!(now_s.is_finite() || force_mps2 == Vec2::ZERO);
            // Near a graze the slope is unbounded and differences mean nothing.
            if (0.3..8.0).contains(&now_s) && disc_with_disc(offset, velocity, 0.93 * radius).is_finite() {
                check(force_mps2, downhill(time_s));
            }
        }

        #[test]
        fn wall_force_is_slope_of_energy(
            first in vector(4.0), second in vector(4.0), velocity in vector(2.0), radius in 0.2f32..0.5,
        ) {
            prop_assume!(first.distance(second) > 0.5);
            let time_s = |moved, radius_m| disc_with_segment([first - moved, second - moved], velocity, radius_m);
            let exact_s = time_s(Vec2::ZERO, radius);
            let force_mps2 = wall_force_mps2([first, second], velocity, radius, &LAW);
            prop_assert!(exact_s.is_finite() || force_mps2 == Vec2::ZERO);
            if (0.3..8.0).contains(&exact_s) && time_s(Vec2::ZERO, 0.93 * radius) < exact_s * 1.3 {
                check(force_mps2, downhill(|moved| time_s(moved, radius)));
            }
        }
    }

    #[test]
    fn an_agent_that_moves_away_exerts_no_force() {
        assert_eq!(agent_force_mps2(Vec2::X, -Vec2::X, 0.5, &LAW), Vec2::ZERO);
    }

    #[test]
    fn overlapping_agents_push_apart_by_a_finite_force() {
        let force_mps2 = agent_force_mps2(Vec2::new(0.3, 0.0), Vec2::X, 0.5, &LAW);
        assert!(force_mps2.is_finite() && force_mps2.x < -1.0);
        assert_eq!(agent_force_mps2(Vec2::new(0.2, 0.0), Vec2::X, 0.5, &LAW), Vec2::ZERO);
        assert_eq!(agent_force_mps2(Vec2::ZERO, Vec2::X, 0.5, &LAW), Vec2::ZERO);
    }
}

//! The preferred velocity, adapted to who comes (`FbCrowd` §4.3, App. 9.1, Eqs. 9 and 11).
//!
//! The force between two agents is the universal power law of Karamouzas, Skinner, Guy 2014: the gradient of the energy
//! E(τ) = k τ⁻² e^(−τ/τ_0) of their time to collision τ, in closed form. Walls act alike, on the capsule that a segment
//! grown by the agent's radius makes. Masses are 1, so forces are accelerations, m/s².
//!
//! Integrated over many steps Eq. 9 is stiff and stalls crowds: it is evaluated afresh each step and only modulates
//! v_pref.

use glam::Vec2;

use crate::planning::mcn::params::McnParams;
use crate::world::time_to_collision::{disc_with_disc, disc_with_side, discriminant};

/// Floor of the time to collision, s: keeps the force finite; far inside the reach of the clamp on the acceleration.
const TIME_MIN_S: f32 = 1e-2;

/// The interaction's two constants.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PowerLaw {
    /// k, m².
    pub strength: f32,
    /// τ_0, s: interactions that lie farther ahead fade.
    pub horizon_s: f32,
}

/// Eq. 9, one explicit step of `lead` from the present velocity, the acceleration limited; `forces` is Σ f_ij + Σ f_iW.
pub(crate) fn adapted_mps(
    velocity_mps: Vec2,
    preferred_mps: Vec2,
    forces_mps2: Vec2,
    lead_s: f32,
    params: &McnParams,
) -> Vec2 {
    let driving_mps2 = (preferred_mps - velocity_mps) / params.relaxation_s;
    let acceleration_mps2 = (driving_mps2 + forces_mps2).clamp_length_max(params.acceleration_max_mps2);
    velocity_mps + lead_s * acceleration_mps2
}

/// Eq. 11: the force on disc i from disc j; `offset` p_j − p_i, `velocity` v_i − v_j, `radius` r_i + r_j.
pub(crate) fn agent_force_mps2(offset_m: Vec2, velocity_mps: Vec2, radius_m: f32, law: &PowerLaw) -> Vec2 {
    // Discs that overlap shrink to as much as they overlap: so does the authors' code, whose figures come out by
    // `fbcrowd bench table1 --discs`. Those that overlap by more than half are left to the collision's half-plane.
    let distance_m = offset_m.length();
    let radius_m = if distance_m < radius_m { radius_m - distance_m } else { radius_m };
    let time_s = disc_with_disc(offset_m, velocity_mps, radius_m);
    if time_s <= 0.0 || time_s.is_infinite() {
        return Vec2::ZERO;
    }
    let speed_squared = velocity_mps.length_squared();
    let approach = velocity_mps.dot(offset_m);
    let root = discriminant(offset_m, velocity_mps, radius_m).sqrt();
    let along = velocity_mps - (approach * velocity_mps - speed_squared * offset_m) / root;
    -steepness(time_s, law) / speed_squared * along
}

/// f_iW: the force from a segment; `corners` relative to the disc's centre.
pub(crate) fn wall_force_mps2(corners_m: [Vec2; 2], velocity_mps: Vec2, radius_m: f32, law: &PowerLaw) -> Vec2 {
    let side_s = disc_with_side(corners_m, velocity_mps, radius_m);
    let ends_s = corners_m.map(|corner_m| disc_with_disc(corner_m, velocity_mps, radius_m));
    if side_s > ends_s[0].min(ends_s[1]) || side_s.is_infinite() {
        let nearer = usize::from(ends_s[1] < ends_s[0]);
        return agent_force_mps2(corners_m[nearer], velocity_mps, radius_m, law);
    }
    let along = (corners_m[1] - corners_m[0]).normalize();
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
        f64::from(LAW.strength) / (time_s * time_s) * (-time_s / f64::from(LAW.horizon_s)).exp()
    }

    /// −∇E over the own position, by central differences.
    fn downhill(time_s: impl Fn(Vec2) -> f32) -> Vec2 {
        let step_m = 4e-3;
        let along = |axis: Vec2| energy(time_s(axis * step_m)) - energy(time_s(-axis * step_m));
        -Vec2::new(along(Vec2::X) as f32, along(Vec2::Y) as f32) / (2.0 * step_m)
    }

    /// Differences over 8 mm are off by some per cent where a ball of 0.2 m curves away from the path.
    fn check(force_mps2: Vec2, expected_mps2: Vec2) {
        let tolerance = 0.1 * expected_mps2.length() + 0.02;
        assert!(force_mps2.distance(expected_mps2) < tolerance, "{force_mps2} {expected_mps2}");
    }

    proptest! {
        #![proptest_config(ProptestConfig::with_cases(2000))]

        #[test]
        fn the_force_between_agents_is_the_downhill_slope_of_their_energy(
            offset in vector(4.0), velocity in vector(2.0), radius in 0.3f32..0.8,
        ) {
            let time_s = |moved| disc_with_disc(offset - moved, velocity, radius);
            let force_mps2 = agent_force_mps2(offset, velocity, radius, &LAW);
            let now_s = time_s(Vec2::ZERO);
            prop_assert!(now_s.is_finite() || force_mps2 == Vec2::ZERO);
            // Near a graze the slope is without bound and differences mean nothing.
            if (0.3..8.0).contains(&now_s) && disc_with_disc(offset, velocity, 0.93 * radius).is_finite() {
                check(force_mps2, downhill(time_s));
            }
        }

        #[test]
        fn the_force_of_a_wall_is_the_downhill_slope_of_its_energy(
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
    fn nobody_in_the_way_leaves_the_driving_force_alone() {
        let params = McnParams::default();
        let adapted = adapted_mps(Vec2::X, Vec2::new(1.0, 0.54), Vec2::ZERO, 0.1, &params);
        assert!(adapted.distance(Vec2::new(1.0, 0.1)) < 1e-6);
        assert_eq!(agent_force_mps2(Vec2::X, -Vec2::X, 0.5, &LAW), Vec2::ZERO);
    }

    #[test]
    fn overlapping_agents_push_apart_without_bound_or_nan() {
        let force_mps2 = agent_force_mps2(Vec2::new(0.3, 0.0), Vec2::X, 0.5, &LAW);
        assert!(force_mps2.is_finite() && force_mps2.x < -1.0);
        assert_eq!(agent_force_mps2(Vec2::new(0.2, 0.0), Vec2::X, 0.5, &LAW), Vec2::ZERO);
        assert_eq!(agent_force_mps2(Vec2::ZERO, Vec2::X, 0.5, &LAW), Vec2::ZERO);
    }
}

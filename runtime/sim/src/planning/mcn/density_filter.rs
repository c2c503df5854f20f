//! The density filter: an agent walks no faster than the crowd ahead allows (`FbCrowd` §4.3; Narang et al. 2015;
//! constants of Menge's PedVO, Curtis, Best, Manocha 2016).
//!
//! 1. Density ρ is measured at a critical point 1 m ahead: the sum of one-dimensional Gaussians of a few neighbours (so
//!    ρ is in 1/m), in which sideways distance counts more.
//! 2. The fundamental diagram turns density into speed: a stride needs the space S = 0.48/ρ.
//! 3. Directions on an arc around the preference are tried, and averaged by the progress that they allow. An average
//!    instead of the best keeps the velocity from jumping between directions.
//!
//! Two departures from Menge (docs/tuning.md):
//! - Walls do not count. The diagram is of people who walk behind each other; a wall beside the path is not a queue,
//!   and a wall ahead is avoided as a wall.
//! - A neighbour that clears the path counts for less. The diagram is of one-way flow, and a neighbour that comes or
//!   crosses has gone by the time the agent is there.
//!
//! World axes, metres, seconds.

use glam::Vec2;

use crate::maths::decay::decay;
use crate::planning::mcn::params::McnParams;
use crate::world::neighbours::neighbour_lanes::{Lanes, NeighbourLanes};

/// Distance of the critical point, m: Menge.
const AHEAD_M: f32 = 1.0;
/// Weight of sideways against forward distance: Menge.
const SIDEWAYS: f32 = 2.5;
/// σ of a neighbour's Gaussian, m: Menge.
const SIGMA_M: f32 = 1.5;
/// Free space of a stride times density: S = SPACE/ρ, Menge.
const SPACE: f32 = 0.48;
/// Farthest neighbour that counts, m. With all of them, at one agent/m², agents would walk at a third to half of
/// Weidmann's speed, and stall.
const RANGE_M: f32 = 5.0;
/// Speed of clearing the path, aside or towards the agent, from which a neighbour does not count, m/s: twice a walk of
/// 1.33, so that a neighbour that comes or crosses at a walk counts half.
const CLEARING_MPS: f32 = 2.66;
/// 1/√2π.
const GAUSS: f32 = 0.398_942_3;
/// Cosine and sine of the arc's directions beside straight ahead: ±20°, ±40°.
const ARC: [Vec2; 4] = [
    Vec2::new(0.939_692_6, 0.342_020_1),
    Vec2::new(0.939_692_6, -0.342_020_1),
    Vec2::new(0.766_044_4, 0.642_787_6),
    Vec2::new(0.766_044_4, -0.642_787_6),
];

/// The filtered velocity and the density ahead.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Filtered {
    /// v_op, m/s.
    pub(crate) velocity_mps: Vec2,
    /// ρ along the unfiltered velocity, 1/m.
    pub(crate) density: f32,
}

/// Scales v_op down to what the density ahead allows, on the arc around it, for an agent that walks at `own_mps` and
/// plans for a step of `dt_s`.
pub(crate) fn filter(
    velocity_mps: Vec2,
    own_mps: Vec2,
    neighbours: &NeighbourLanes,
    dt_s: f32,
    params: &McnParams,
) -> Filtered {
    let speed_mps = velocity_mps.length();
    let ahead = velocity_mps.normalize_or_zero();
    let weights = weights(ahead, own_mps, neighbours);
    let shares_ahead = shares(ahead, neighbours);
    let density = density(&shares_ahead);
    let ahead_mps = speed_limit_mps(weighted_density(&shares_ahead, &weights), params);
    if speed_mps <= ahead_mps {
        return Filtered { velocity_mps, density };
    }
    let limit_mps =
        |direction: Vec2| speed_limit_mps(weighted_density(&shares(direction, neighbours), &weights), params);
    let (direction, allowed_mps) = on_the_arc(ahead, ahead_mps, speed_mps, limit_mps);
    // A limit is taken up like v_pref (Eq. 9), not at once: the density flickers as neighbours come and go.
    let left = 1.0 - (dt_s / params.relaxation_s).min(1.0);
    let eased_mps = allowed_mps + left * (own_mps.length() - allowed_mps).max(0.0);
    Filtered { velocity_mps: eased_mps.min(speed_mps) * direction, density }
}

/// Direction and speed allowed to an agent that would walk at `speed_mps` along `ahead`, where `ahead_mps` is allowed:
/// the mean over the arc, each direction weighted by the fourth power of the progress that its limit allows.
fn on_the_arc(ahead: Vec2, ahead_mps: f32, speed_mps: f32, limit_mps: impl Fn(Vec2) -> f32) -> (Vec2, f32) {
    let weight = |along: f32, allowed_mps: f32| {
        let progress = along * allowed_mps / speed_mps;
        progress * progress * progress * progress
    };
    let mut sum = weight(1.0, ahead_mps);
    let (mut directions, mut sum_mps) = (sum * ahead, sum * ahead_mps);
    for turn in ARC {
        let direction = turn.rotate(ahead);
        let allowed_mps = speed_mps.min(limit_mps(direction));
        let weight = weight(turn.x, allowed_mps);
        directions += weight * direction;
        sum_mps += weight * allowed_mps;
        sum += weight;
    }
    // The arc counts by as much as straight ahead is closed, so that nothing jumps where it begins to close.
    let closed = 1.0 - ahead_mps / speed_mps;
    let direction = ahead.lerp(directions.normalize_or(ahead), closed).normalize_or(ahead);
    (direction, ahead_mps + closed * (sum_mps / sum - ahead_mps))
}

/// ρ of all neighbours at the critical point along a unit direction, 1/m.
pub(crate) fn density_ahead(ahead: Vec2, neighbours: &NeighbourLanes) -> f32 {
    density(&shares(ahead, neighbours))
}

/// Each neighbour's Gaussian at the critical point along a unit direction, without its normaliser.
fn shares(ahead: Vec2, neighbours: &NeighbourLanes) -> Lanes {
    std::array::from_fn(|lane| {
        let offset_m = neighbours.offset_m(lane);
        let from_critical_m = offset_m - AHEAD_M * ahead;
        let (along_m, across_m) = (from_critical_m.dot(ahead), SIDEWAYS * from_critical_m.perp_dot(ahead));
        let share = decay((along_m * along_m + across_m * across_m) * (0.5 / (SIGMA_M * SIGMA_M)));
        if offset_m.length_squared() <= RANGE_M * RANGE_M { share } else { 0.0 }
    })
}

/// ρ of the shares, 1/m.
fn density(shares: &Lanes) -> f32 {
    shares.iter().sum::<f32>() * GAUSS / SIGMA_M
}

/// ρ of the shares, each by its weight, 1/m.
fn weighted_density(shares: &Lanes, weights: &Lanes) -> f32 {
    density(&std::array::from_fn(|lane| weights[lane] * shares[lane]))
}

/// Weight of each neighbour for an agent that would walk along `ahead`: less for one that clears the path faster.
fn weights(ahead: Vec2, own_mps: Vec2, neighbours: &NeighbourLanes) -> Lanes {
    std::array::from_fn(|lane| {
        let velocity_mps = own_mps - neighbours.relative_mps(lane);
        let clearing_mps = (-velocity_mps.dot(ahead)).max(0.0) + velocity_mps.perp_dot(ahead).abs();
        (1.0 - clearing_mps / CLEARING_MPS).max(0.0)
    })
}

/// The fundamental diagram: v_max = S² / (½ (1 + buffer)/factor)², never below the floor.
pub(crate) fn speed_limit_mps(density: f32, params: &McnParams) -> f32 {
    let space = SPACE / density.max(f32::MIN_POSITIVE);
    let stride = 0.5 * (1.0 + params.density_buffer) / params.density_factor;
    (space / stride * (space / stride)).max(params.density_speed_min_mps)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::measures::pedestrian_studies::measured_section::weidmann_mps;
    use crate::world::neighbours::NEIGHBOUR_COUNT;

    /// The greatest time step, s.
    const DT_S: f32 = 0.25;

    /// Neighbours at these offsets, at the agent's own velocity.
    fn at(offsets_m: &[Vec2]) -> NeighbourLanes {
        moving(offsets_m, Vec2::ZERO)
    }

    fn moving(offsets_m: &[Vec2], relative_mps: Vec2) -> NeighbourLanes {
        let mut neighbours = NeighbourLanes::default();
        for (lane, &offset_m) in offsets_m.iter().enumerate() {
            neighbours.set(lane, offset_m, relative_mps, 0.5);
        }
        neighbours
    }

    /// Offsets of the ten nearest agents in a staggered lattice of a density, 1/m².
    fn staggered(per_m2: f32) -> Vec<Vec2> {
        let apart_m = (2.0 / (3.0_f32.sqrt() * per_m2)).sqrt();
        let offset_m = |row: i32, column: i32| {
            apart_m * Vec2::new(0.75_f32.sqrt() * row as f32, column as f32 + 0.5 * row.rem_euclid(2) as f32)
        };
        let lattice = (-8..=8).flat_map(|row| (-8..=8).map(move |column| offset_m(row, column)));
        let mut offsets_m: Vec<Vec2> = lattice.filter(|offset_m| offset_m.length() > 0.0).collect();
        offsets_m.sort_by(|a, b| a.length_squared().total_cmp(&b.length_squared()));
        offsets_m.truncate(NEIGHBOUR_COUNT);
        offsets_m
    }

    /// The filter of an agent that walks at 1.3 m/s along +x among others of one velocity.
    fn filtered(offsets_m: &[Vec2], others_mps: Vec2) -> Filtered {
        let own_mps = 1.3 * Vec2::X;
        filter(own_mps, own_mps, &moving(offsets_m, own_mps - others_mps), DT_S, &McnParams::default())
    }

    /// As near as RiMEA test 4 requires, at densities at which the filter slows agents: below 1.5/m² avoidance does.
    #[test]
    fn a_staggered_lattice_follows_weidmanns_diagram() {
        for per_m2 in [1.5, 1.75, 2.0, 2.25, 2.5] {
            let limit_mps = speed_limit_mps(density_ahead(Vec2::X, &at(&staggered(per_m2))), &McnParams::default());
            let expected_mps = weidmann_mps(f64::from(per_m2)) as f32;
            assert!((limit_mps - expected_mps).abs() < 0.15, "{per_m2}/m²: {limit_mps}, {expected_mps} m/s");
        }
    }

    #[test]
    fn free_path_keeps_speed_jam_does_not_stall() {
        let params = McnParams::default();
        let free = filter(Vec2::new(1.3, 0.2), Vec2::ZERO, &at(&[Vec2::new(-2.0, 0.0)]), DT_S, &params);
        assert_eq!(free.velocity_mps, Vec2::new(1.3, 0.2));
        let jam = filter(Vec2::new(1.3, 0.0), Vec2::ZERO, &at(&staggered(8.0)), DT_S, &params);
        assert!(jam.velocity_mps.length() > 0.8 * params.density_speed_min_mps && jam.velocity_mps.length() < 0.5);
        assert_eq!(filter(Vec2::ZERO, Vec2::ZERO, &at(&staggered(8.0)), DT_S, &params).velocity_mps, Vec2::ZERO);
    }

    #[test]
    fn neighbours_that_clear_the_path_slow_less() {
        let crowd = staggered(1.5);
        let [standing, along, coming, crossing] = [Vec2::ZERO, 0.8 * Vec2::X, -1.33 * Vec2::X, 1.33 * Vec2::Y]
            .map(|others_mps| filtered(&crowd, others_mps).velocity_mps.x);
        assert!(standing < 1.2 && (standing - along).abs() < 1e-5, "{standing} {along}");
        assert!(coming > standing + 0.05 && (coming - crossing).abs() < 1e-5, "{standing} {coming} {crossing}");
    }

    #[test]
    fn leans_to_the_emptier_side() {
        let crowd_on_the_left: Vec<Vec2> = (0..8).map(|index| Vec2::new(0.6 + 0.2 * index as f32, 0.5)).collect();
        let filtered = filter(Vec2::new(1.3, 0.0), Vec2::ZERO, &at(&crowd_on_the_left), DT_S, &McnParams::default());
        assert!(filtered.velocity_mps.y < -0.02 && filtered.velocity_mps.x > 0.2, "{filtered:?}");
    }
}

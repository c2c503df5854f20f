//! The density filter: no faster than the crowd ahead allows (`FbCrowd` §4.3; Narang et al. 2015; constants of Menge's
//! PedVO).
//!
//! Density is felt at a critical point 1 m ahead, from a few neighbours, each a Gaussian in one dimension (so ρ is in
//! 1/m), in which sideways distance counts more. The fundamental diagram turns density into speed: a stride needs the
//! space S = 0.48/ρ. Directions on an arc around the preference are tried, and averaged by the progress that they
//! allow: an average instead of the best, so that the velocity does not jump from one direction to another.

use glam::Vec2;

use super::params::McnParams;
use crate::around::{Around, LANES};
use crate::decay::decay;

/// Menge: distance of the critical point, m.
const AHEAD_M: f32 = 1.0;
/// Menge: perpendicular offsets count this much more.
const SIDEWAYS: f32 = 2.5;
/// Menge: σ of an agent's share, m.
const AGENT_SIGMA_M: f32 = 1.5;
/// Menge: σ of a wall's share, m.
const WALL_SIGMA_M: f32 = 0.75;
/// Menge: free space of a stride, S = SPACE/ρ.
const SPACE: f32 = 0.48;
/// Neighbours farther than this are not felt, m; with all of them the diagram would stall the crowd
/// (`facts/planning.md` §2).
const RANGE_M: f32 = 5.0;
/// 1/√2π.
const GAUSS: f32 = 0.398_942_3;
/// Cosine and sine of the arc's directions: 0, ±20°, ±40°.
const ARC: [Vec2; 5] = [
    Vec2::new(1.0, 0.0),
    Vec2::new(0.939_692_6, 0.342_020_1),
    Vec2::new(0.939_692_6, -0.342_020_1),
    Vec2::new(0.766_044_4, 0.642_787_6),
    Vec2::new(0.766_044_4, -0.642_787_6),
];

/// The filtered velocity and the density met along it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Filtered {
    /// v_op, m/s.
    pub velocity_mps: Vec2,
    /// ρ along the unfiltered velocity, 1/m.
    pub density: f32,
}

/// Scales v_op down to what the density ahead allows, on the arc around it, for who walks at `now` m/s. `walls` are
/// offsets from the agent's centre.
pub fn filter(velocity_mps: Vec2, now_mps: f32, agents: &Around, walls_m: &[Vec2], params: &McnParams) -> Filtered {
    let speed_mps = velocity_mps.length();
    let ahead = velocity_mps.normalize_or_zero();
    let density = density_ahead(ahead, agents, walls_m);
    let ahead_mps = speed_limit_mps(density, params);
    if speed_mps <= ahead_mps {
        return Filtered { velocity_mps, density };
    }
    let (mut directions, mut sum_mps, mut weights) = (Vec2::ZERO, 0.0, 0.0);
    for turned in ARC {
        let direction = turned.rotate(ahead);
        let allowed_mps = speed_mps.min(speed_limit_mps(density_ahead(direction, agents, walls_m), params));
        let progress = turned.x * allowed_mps / speed_mps;
        let weight = progress * progress * progress * progress;
        directions += weight * direction;
        sum_mps += weight * allowed_mps;
        weights += weight;
    }
    // The arc has its say by as much as the way ahead is closed, so that nothing jumps where it begins to be.
    let closed = 1.0 - ahead_mps / speed_mps;
    let direction = ahead.lerp(directions.normalize_or(ahead), closed).normalize_or(ahead);
    let allowed_mps = ahead_mps + closed * (sum_mps / weights - ahead_mps);
    // A limit is taken up as v_pref is (Eq. 9), not at once: the density flickers as neighbours come and go.
    let left = 1.0 - (params.response_s / params.relaxation_s).min(1.0);
    let eased_mps = allowed_mps + left * (now_mps - allowed_mps).max(0.0);
    Filtered { velocity_mps: eased_mps.min(speed_mps) * direction, density }
}

/// ρ at the critical point along a unit direction, 1/m.
pub fn density_ahead(ahead: Vec2, agents: &Around, walls_m: &[Vec2]) -> f32 {
    let agent = |lane: usize| {
        let offset_m = Vec2::new(agents.x_m[lane], agents.y_m[lane]);
        let share = share(offset_m, ahead, AGENT_SIGMA_M);
        if offset_m.length_squared() <= RANGE_M * RANGE_M { share } else { 0.0 }
    };
    let of_agents: [f32; LANES] = std::array::from_fn(agent);
    let of_walls = walls_m.iter().map(|&offset_m| share(offset_m, ahead, WALL_SIGMA_M));
    of_agents.into_iter().chain(of_walls).sum::<f32>() * GAUSS / AGENT_SIGMA_M
}

/// What one adds to ρ, but for the normaliser: a wall has its own σ in the exponent and the agents' in the normaliser, as
/// in Menge.
#[inline]
fn share(offset_m: Vec2, ahead: Vec2, sigma_m: f32) -> f32 {
    let from_critical_m = offset_m - AHEAD_M * ahead;
    let (along_m, across_m) = (from_critical_m.dot(ahead), SIDEWAYS * from_critical_m.perp_dot(ahead));
    decay((along_m * along_m + across_m * across_m) * (0.5 / (sigma_m * sigma_m)))
}

/// The fundamental diagram: v_max = S² / (½ (1 + buffer)/factor)², never below the floor.
pub fn speed_limit_mps(density: f32, params: &McnParams) -> f32 {
    let space = SPACE / density.max(f32::MIN_POSITIVE);
    let stride = 0.5 * (1.0 + params.density_buffer) / params.density_factor;
    (space / stride * (space / stride)).max(params.density_speed_min_mps)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// As many as there are lanes for.
    fn around(places_m: &[Vec2]) -> Around {
        let mut around = Around::default();
        places_m.iter().enumerate().for_each(|(lane, &place_m)| around.put(lane, place_m, Vec2::ZERO, 0.5));
        around
    }

    /// The ten nearest of a square lattice of a density, 1/m².
    fn lattice(per_m2: f32) -> Vec<Vec2> {
        let spacing_m = 1.0 / per_m2.sqrt();
        let mut places: Vec<Vec2> = (-4..=4)
            .flat_map(|x| (-4..=4).map(move |y| spacing_m * Vec2::new(x as f32, y as f32)))
            .filter(|place_m| place_m.length() > 0.0 && place_m.length() <= RANGE_M)
            .collect();
        places.sort_by(|a, b| a.length_squared().total_cmp(&b.length_squared()));
        places.truncate(10);
        places
    }

    /// ρ ahead of an agent whose ten nearest neighbours are spread evenly over the disc that they fill at a density,
    /// 1/m².
    fn density_amid_ten(per_m2: f32) -> f32 {
        let radius_m = (10.0 / (std::f32::consts::PI * per_m2)).sqrt();
        let places: Vec<Vec2> = (-50..=50)
            .flat_map(|x| (-50..=50).map(move |y| Vec2::new(x as f32, y as f32) / 50.0))
            .filter(|place| place.length() <= 1.0)
            .map(|place| radius_m * place)
            .collect();
        let of_some = |places_m: &[Vec2]| density_ahead(Vec2::X, &around(places_m), &[]);
        places.chunks(LANES).map(of_some).sum::<f32>() * 10.0 / places.len() as f32
    }

    #[test]
    fn follows_weidmanns_fundamental_diagram() {
        for per_m2 in [1.0, 1.5, 2.0, 2.5] {
            let expected_mps = 1.34 * (1.0 - libm::expf(-1.913 * (1.0 / per_m2 - 1.0 / 5.4)));
            let limit_mps = speed_limit_mps(density_amid_ten(per_m2), &McnParams::default());
            assert!((limit_mps / expected_mps - 1.0).abs() < 0.15, "{per_m2}/m²: {limit_mps}, {expected_mps} m/s");
        }
    }

    #[test]
    fn a_free_way_is_left_alone_and_nobody_is_stalled() {
        let params = McnParams::default();
        let free = filter(Vec2::new(1.3, 0.2), 0.0, &around(&[Vec2::new(-2.0, 0.0)]), &[], &params);
        assert_eq!(free.velocity_mps, Vec2::new(1.3, 0.2));
        let jam = filter(Vec2::new(1.3, 0.0), 0.0, &around(&lattice(8.0)), &[], &params);
        assert!(jam.velocity_mps.length() > 0.8 * params.density_speed_min_mps && jam.velocity_mps.length() < 0.5);
        assert_eq!(filter(Vec2::ZERO, 0.0, &around(&lattice(8.0)), &[], &params).velocity_mps, Vec2::ZERO);
    }

    #[test]
    fn leans_to_the_emptier_side() {
        let crowd_on_the_left: Vec<Vec2> = (0..8).map(|index| Vec2::new(0.6 + 0.2 * index as f32, 0.5)).collect();
        let filtered = filter(Vec2::new(1.3, 0.0), 0.0, &around(&crowd_on_the_left), &[], &McnParams::default());
        assert!(filtered.velocity_mps.y < -0.02 && filtered.velocity_mps.x > 0.2, "{filtered:?}");
    }
}

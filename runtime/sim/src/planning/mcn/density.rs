//! The density filter: no faster than the crowd ahead allows (`FbCrowd` §4.3; Narang et al. 2015; constants of Menge's
//! PedVO).
//!
//! Density is felt at a critical point 1 m ahead, from a few neighbours, each a Gaussian in one dimension (so ρ is in
//! 1/m), in which sideways distance counts more. The fundamental diagram turns density into speed: a stride needs the
//! space S = 0.48/ρ. Directions on an arc around the preference are tried, and averaged by the progress that they
//! allow: an average instead of the best, so that the velocity does not jump from one direction to another.
//!
//! Where it departs from Menge, each measured by `fbcrowd bench rimea` (test 4, the diagram; test 12, doors), `bench
//! emergence` and `bench table1`:
//! - Walls do not count. The diagram is of people who walk behind each other; a wall beside one's way is no queue, and
//!   one ahead is avoided as a wall. Counted, the posts of a door keep people waiting before it.
//! - Whoever clears the way counts for less: the diagram is of one-way flow, and those who come or cross have gone by
//!   the time that one is there. Counted in full, they slow a crossing that collision avoidance passes through
//!   smoothly.
//!
//! World axes, metres, seconds.

use glam::Vec2;

use crate::maths::decay::decay;
use crate::planning::mcn::params::McnParams;
use crate::world::neighbour_lanes::{Around, Lanes};

/// Menge: distance of the critical point, m.
const AHEAD_M: f32 = 1.0;
/// Menge: perpendicular offsets count this much more.
const SIDEWAYS: f32 = 2.5;
/// Menge: σ of a share, m.
const SIGMA_M: f32 = 1.5;
/// Menge: free space of a stride, S = SPACE/ρ.
const SPACE: f32 = 0.48;
/// Neighbours farther than this are not felt, m; with all of them, at one agent/m², people would walk at a third to
/// half of Weidmann's speed, and stall.
const RANGE_M: f32 = 5.0;
/// Who moves aside or towards one as fast as this does not count, m/s: two walks of 1.33, so that who comes or crosses
/// at a walk counts half.
const CLEARING_MPS: f32 = 2.66;
/// 1/√2π.
const GAUSS: f32 = 0.398_942_3;
/// Cosine and sine of the arc's directions beside the way ahead: ±20°, ±40°.
const ARC: [Vec2; 4] = [
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

/// Scales v_op down to what the density ahead allows, on the arc around it, for who walks at `own` m/s and takes a plan
/// up within `lead` seconds.
pub(crate) fn filter(velocity_mps: Vec2, own_mps: Vec2, agents: &Around, lead_s: f32, params: &McnParams) -> Filtered {
    let speed_mps = velocity_mps.length();
    let ahead = velocity_mps.normalize_or_zero();
    let weights = in_the_way(ahead, own_mps, agents);
    let met = shares(ahead, agents);
    let (density, ahead_mps) = (density(&met), speed_limit_mps(weighed(&met, &weights), params));
    if speed_mps <= ahead_mps {
        return Filtered { velocity_mps, density };
    }
    let limit_mps = |direction: Vec2| speed_limit_mps(weighed(&shares(direction, agents), &weights), params);
    let (direction, allowed_mps) = on_the_arc(ahead, ahead_mps, speed_mps, limit_mps);
    // A limit is taken up as v_pref is (Eq. 9), not at once: the density flickers as neighbours come and go.
    let left = 1.0 - (lead_s / params.relaxation_s).min(1.0);
    let eased_mps = allowed_mps + left * (own_mps.length() - allowed_mps).max(0.0);
    Filtered { velocity_mps: eased_mps.min(speed_mps) * direction, density }
}

/// The direction to take and the speed allowed there, for who would walk at `speed` m/s along `ahead`, where
/// `ahead_mps` is allowed: the mean over the arc, each direction by the fourth power of the progress that its limit
/// allows.
fn on_the_arc(ahead: Vec2, ahead_mps: f32, speed_mps: f32, limit_mps: impl Fn(Vec2) -> f32) -> (Vec2, f32) {
    let weight = |along: f32, allowed_mps: f32| {
        let progress = along * allowed_mps / speed_mps;
        progress * progress * progress * progress
    };
    let mut all = weight(1.0, ahead_mps);
    let (mut directions, mut sum_mps) = (all * ahead, all * ahead_mps);
    for turned in ARC {
        let direction = turned.rotate(ahead);
        let allowed_mps = speed_mps.min(limit_mps(direction));
        let weight = weight(turned.x, allowed_mps);
        directions += weight * direction;
        sum_mps += weight * allowed_mps;
        all += weight;
    }
    // The arc has its say by as much as the way ahead is closed, so that nothing jumps where it begins to be.
    let closed = 1.0 - ahead_mps / speed_mps;
    let direction = ahead.lerp(directions.normalize_or(ahead), closed).normalize_or(ahead);
    (direction, ahead_mps + closed * (sum_mps / all - ahead_mps))
}

/// ρ of all neighbours at the critical point along a unit direction, 1/m.
pub(crate) fn density_ahead(ahead: Vec2, agents: &Around) -> f32 {
    density(&shares(ahead, agents))
}

/// What each neighbour adds to ρ at the critical point along a unit direction, but for the normaliser.
fn shares(ahead: Vec2, agents: &Around) -> Lanes {
    std::array::from_fn(|lane| {
        let offset_m = agents.offset_m(lane);
        let from_critical_m = offset_m - AHEAD_M * ahead;
        let (along_m, across_m) = (from_critical_m.dot(ahead), SIDEWAYS * from_critical_m.perp_dot(ahead));
        let share = decay((along_m * along_m + across_m * across_m) * (0.5 / (SIGMA_M * SIGMA_M)));
        if offset_m.length_squared() <= RANGE_M * RANGE_M { share } else { 0.0 }
    })
}

/// ρ of shares, 1/m.
fn density(shares: &Lanes) -> f32 {
    shares.iter().sum::<f32>() * GAUSS / SIGMA_M
}

/// The same, each by its weight.
fn weighed(shares: &Lanes, weights: &Lanes) -> f32 {
    density(&std::array::from_fn(|lane| weights[lane] * shares[lane]))
}

/// How much each neighbour counts for who would walk along `ahead`: the less, the faster it clears the way.
fn in_the_way(ahead: Vec2, own_mps: Vec2, agents: &Around) -> Lanes {
    std::array::from_fn(|lane| {
        let velocity_mps = own_mps - agents.velocity_mps(lane);
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

    const LEAD_S: f32 = 0.3;

    /// As many as there are lanes for.
    fn around(places_m: &[Vec2]) -> Around {
        let mut around = Around::default();
        places_m.iter().enumerate().for_each(|(lane, &place_m)| around.put(lane, place_m, Vec2::ZERO, 0.5));
        around
    }

    /// The ten nearest of people in rows, each row staggered against the next, of a density, 1/m².
    fn staggered(per_m2: f32) -> Vec<Vec2> {
        let apart_m = (2.0 / (3.0_f32.sqrt() * per_m2)).sqrt();
        let place_m = |row: i32, place: i32| {
            apart_m * Vec2::new(0.75_f32.sqrt() * row as f32, place as f32 + 0.5 * row.rem_euclid(2) as f32)
        };
        let mut places_m: Vec<Vec2> = (-8..=8).flat_map(|row| (-8..=8).map(move |place| place_m(row, place))).collect();
        places_m.retain(|place_m| place_m.length() > 0.0);
        places_m.sort_by(|a, b| a.length_squared().total_cmp(&b.length_squared()));
        places_m.truncate(NEIGHBOUR_COUNT);
        places_m
    }

    /// Who walks at 1.3 m/s along +x, beside others who stand or walk as fast.
    fn filtered(places_m: &[Vec2], others_mps: Vec2) -> Filtered {
        let mut agents = around(places_m);
        let relative_mps = 1.3 * Vec2::X - others_mps;
        places_m.iter().enumerate().for_each(|(lane, &place_m)| agents.put(lane, place_m, relative_mps, 0.5));
        filter(1.3 * Vec2::X, 1.3 * Vec2::X, &agents, LEAD_S, &McnParams::default())
    }

    /// As near as RiMEA test 4 asks for, where the filter slows anybody: below 1.5/m² avoidance does.
    #[test]
    fn people_in_staggered_rows_follow_weidmanns_fundamental_diagram() {
        for per_m2 in [1.5, 1.75, 2.0, 2.25, 2.5] {
            let limit_mps = speed_limit_mps(density_ahead(Vec2::X, &around(&staggered(per_m2))), &McnParams::default());
            let expected_mps = weidmann_mps(f64::from(per_m2)) as f32;
            assert!((limit_mps - expected_mps).abs() < 0.15, "{per_m2}/m²: {limit_mps}, {expected_mps} m/s");
        }
    }

    #[test]
    fn a_free_way_is_left_alone_and_nobody_is_stalled() {
        let params = McnParams::default();
        let free = filter(Vec2::new(1.3, 0.2), Vec2::ZERO, &around(&[Vec2::new(-2.0, 0.0)]), LEAD_S, &params);
        assert_eq!(free.velocity_mps, Vec2::new(1.3, 0.2));
        let jam = filter(Vec2::new(1.3, 0.0), Vec2::ZERO, &around(&staggered(8.0)), LEAD_S, &params);
        assert!(jam.velocity_mps.length() > 0.8 * params.density_speed_min_mps && jam.velocity_mps.length() < 0.5);
        assert_eq!(filter(Vec2::ZERO, Vec2::ZERO, &around(&staggered(8.0)), LEAD_S, &params).velocity_mps, Vec2::ZERO);
    }

    #[test]
    fn who_stands_or_walks_ahead_slows_one_more_than_who_comes_or_crosses() {
        let crowd = staggered(1.5);
        let [standing, along, coming, crossing] = [Vec2::ZERO, 0.8 * Vec2::X, -1.33 * Vec2::X, 1.33 * Vec2::Y]
            .map(|others_mps| filtered(&crowd, others_mps).velocity_mps.x);
        assert!(standing < 1.2 && (standing - along).abs() < 1e-5, "{standing} {along}");
        assert!(coming > standing + 0.05 && (coming - crossing).abs() < 1e-5, "{standing} {coming} {crossing}");
    }

    #[test]
    fn leans_to_the_emptier_side() {
        let crowd_on_the_left: Vec<Vec2> = (0..8).map(|index| Vec2::new(0.6 + 0.2 * index as f32, 0.5)).collect();
        let filtered =
            filter(Vec2::new(1.3, 0.0), Vec2::ZERO, &around(&crowd_on_the_left), LEAD_S, &McnParams::default());
        assert!(filtered.velocity_mps.y < -0.02 && filtered.velocity_mps.x > 0.2, "{filtered:?}");
    }
}

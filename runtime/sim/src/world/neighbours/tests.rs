//! Searches against a look at every agent.

use glam::Vec2;
use proptest::prelude::*;

use super::neighbour::RANKING_HORIZON_S;
use super::rank::{LATER_SQUARED_M2PS2, squared_rank};
use super::*;

fn by_brute_force(query: &NeighbourQuery, positions_m: &[Vec2], velocities_mps: &[Vec2], horizon_s: f32) -> Vec<u32> {
    let mut ranked: Vec<(f32, u32)> = (0..positions_m.len())
        .filter(|&other| other != query.agent)
        .map(|other| (positions_m[other] - query.position_m, other))
        .filter(|(offset_m, _)| offset_m.length_squared() <= query.range_m * query.range_m)
        .map(|(offset_m, other)| {
            (squared_rank(offset_m, query.velocity_mps - velocities_mps[other], horizon_s), other as u32)
        })
        .collect();
    ranked.sort_by(|a, b| a.0.total_cmp(&b.0).then(a.1.cmp(&b.1)));
    ranked.into_iter().take(NEIGHBOUR_COUNT).map(|(_, other)| other).collect()
}

fn check(positions_m: &[Vec2], velocities_mps: &[Vec2], range_m: f32) {
    check_horizon(0.0, positions_m, velocities_mps, range_m);
    check_horizon(RANKING_HORIZON_S, positions_m, velocities_mps, range_m);
}

fn check_horizon(horizon_s: f32, positions_m: &[Vec2], velocities_mps: &[Vec2], range_m: f32) {
    let radii_m = vec![0.25; positions_m.len()];
    let mut search = NeighbourSearch::default();
    search.rebuild(positions_m, velocities_mps, &radii_m, horizon_s);
    let mut nearest = NearestNeighbours::default();
    for agent in 0..positions_m.len() {
        let query = NeighbourQuery {
            agent,
            position_m: positions_m[agent],
            velocity_mps: velocities_mps[agent],
            radius_m: radii_m[agent],
            range_m,
        };
        search.nearest(&query, &mut nearest);
        let found: Vec<u32> = nearest.as_slice().iter().map(|neighbour| neighbour.agent).collect();
        assert_eq!(found, by_brute_force(&query, positions_m, velocities_mps, horizon_s));
    }
}

fn vectors(bound: f32, count: usize) -> impl Strategy<Value = Vec<Vec2>> {
    proptest::collection::vec((-bound..bound, -bound..bound).prop_map(Vec2::from), count)
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(64))]

    #[test]
    fn finds_what_a_full_search_finds(
        positions in vectors(15.0, 120), velocities in vectors(1.5, 120), range in 1.0f32..12.0,
    ) {
        check(&positions, &velocities, range);
    }

    #[test]
    fn finds_the_same_in_a_crowd_with_stragglers(
        mut positions in vectors(2.0, 60), velocities in vectors(1.5, 60), far in vectors(300.0, 3),
    ) {
        positions[..3].copy_from_slice(&far);
        check(&positions, &velocities, 10.0);
    }
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(24))]

    #[test]
    fn finds_neighbours_in_piles_and_fast_crowds(
        mut positions in vectors(15.0, 260), mut velocities in vectors(1.5, 260), fast in vectors(1e4, 2),
        pile in vectors(0.05, 200),
    ) {
        // More than a cell of the outer grid may hold, so the pile gets a grid of its own.
        positions[60..].copy_from_slice(&pile);
        velocities[59..61].copy_from_slice(&fast);
        check(&positions, &velocities, 10.0);
    }
}

#[test]
fn breaks_ties_by_index_among_coinciding_agents() {
    check(&[Vec2::ZERO; 30], &[Vec2::ZERO; 30], 10.0);
    check(&[], &[], 10.0);
    check(&[Vec2::new(1e4, -7.0)], &[Vec2::X], 10.0);
}

#[test]
fn prefers_the_fast_approacher_to_a_nearer_companion() {
    let mut positions_m: Vec<Vec2> = (0..11).map(|index| Vec2::new(0.0, 1.0 + 0.4 * index as f32)).collect();
    let mut velocities_mps = vec![Vec2::X; 11];
    positions_m[0] = Vec2::ZERO;
    positions_m.push(Vec2::new(6.0, 0.0));
    velocities_mps.push(-Vec2::X);
    let (mut search, mut nearest) = (NeighbourSearch::default(), NearestNeighbours::default());
    for (horizon_s, taken) in [(RANKING_HORIZON_S, true), (0.0, false)] {
        search.rebuild(&positions_m, &velocities_mps, &[0.25; 12], horizon_s);
        let query =
            NeighbourQuery { agent: 0, position_m: Vec2::ZERO, velocity_mps: Vec2::X, radius_m: 0.25, range_m: 10.0 };
        search.nearest(&query, &mut nearest);
        assert_eq!(nearest.as_slice().iter().any(|neighbour| neighbour.agent == 11), taken);
    }
}

proptest! {
    #[test]
    fn rank_is_least_distance_plus_delay(
        offset in vectors(5.0, 1), velocity in vectors(3.0, 1), horizon_s in 0.0f32..3.0,
    ) {
        let (offset_m, relative_mps) = (offset[0], velocity[0]);
        let squared_at = |time_s: f32| {
            (offset_m - time_s * relative_mps).length_squared() + LATER_SQUARED_M2PS2 * time_s * time_s
        };
        let tried = (0..=1000).map(|step| squared_at(horizon_s * step as f32 / 1000.0)).fold(f32::INFINITY, f32::min);
        let found = squared_rank(offset_m, relative_mps, horizon_s);
        prop_assert!(found <= tried + 1e-4 && found >= tried - 1e-3, "{found} {tried}");
    }
}

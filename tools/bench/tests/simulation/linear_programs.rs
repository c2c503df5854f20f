//! Solutions of the planner's linear programs against all velocities of a grid.

use fbcrowd_bench::soak::generated::linear_program::{SPEED_MAX_MPS, fault_of};
use fbcrowd_sim::planning::orca::{HalfPlane, HalfPlaneSource, Solution, solve};
use glam::Vec2;
use proptest::prelude::*;

fn half_planes(counts: std::ops::Range<usize>) -> impl Strategy<Value = Vec<HalfPlane>> {
    let one = (0.0f32..std::f32::consts::TAU, -0.6f32..1.5, 0.2f32..3.0);
    let one = one.prop_map(|(angle, distance_mps, weight)| {
        let (sin, cos) = libm::sincosf(angle);
        let outward = Vec2::new(cos, sin);
        HalfPlane { weight, ..HalfPlane::behind(distance_mps * outward, outward, HalfPlaneSource::Stance) }
    });
    proptest::collection::vec(one, counts)
}

#[track_caller]
fn check(half_planes: &[HalfPlane], firm: usize, optimal_mps: Vec2) {
    let solution = solve(half_planes, firm, optimal_mps, SPEED_MAX_MPS, &mut Vec::new());
    assert!(solution.satisfied_count == half_planes.len() || solution.satisfied_count <= firm);
    assert_eq!(fault_of(half_planes, firm, optimal_mps, &solution), None, "{solution:?}");
}

fn optimal() -> impl Strategy<Value = Vec2> {
    (-2.5f32..2.5, -2.5f32..2.5).prop_map(Vec2::from)
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(400))]

    #[test]
    fn no_velocity_of_the_grid_is_better(
        half_planes in half_planes(1..12), firm in 0usize..6, optimal in optimal(),
    ) {
        check(&half_planes, firm.min(half_planes.len()), optimal);
    }

    #[test]
    fn no_grid_velocity_yields_less_in_crowd(
        mut half_planes in half_planes(4..9), firm in 0usize..4, optimal in optimal(),
    ) {
        for half_plane in &mut half_planes {
            half_plane.point_mps += 0.8 * half_plane.direction.perp();
        }
        check(&half_planes, firm, optimal);
    }
}

#[test]
fn an_agent_between_firm_half_planes_is_solved() {
    let behind = |outward: Vec2, reach_mps: f32, source| HalfPlane::behind(reach_mps * outward, outward, source);
    // The wall wants 0.2 m/s back, the hull at least 0.1 m/s ahead.
    let wall = behind(Vec2::X, -0.2, HalfPlaneSource::Obstacle(0));
    let hull = [(-Vec2::X, -0.1), (Vec2::Y, 0.5), (-Vec2::Y, 0.5)];
    let hull = hull.map(|(outward, reach_mps)| behind(outward, reach_mps, HalfPlaneSource::TurningHull));
    for away in [Vec2::X, -Vec2::X, Vec2::Y] {
        let agent = HalfPlane { weight: 100.0, ..behind(-away, -1.5, HalfPlaneSource::Agent(0)) };
        check(&[wall, hull[0], hull[1], hull[2], agent], 4, Vec2::ZERO);
    }
}

#[test]
fn wrong_solutions_are_found() {
    let half_planes = [HalfPlane::behind(0.5 * Vec2::X, Vec2::X, HalfPlaneSource::Stance)];
    let is_wrong = |x, satisfied| {
        let solution = Solution { velocity_mps: Vec2::new(x, 0.0), satisfied_count: satisfied };
        fault_of(&half_planes, 0, Vec2::X, &solution).is_some()
    };
    assert!(!is_wrong(0.5, 1) && is_wrong(0.6, 1) && is_wrong(0.3, 1) && is_wrong(0.5, 0));
}

//! The compiler's simplices and the runtime's locator together: a query reaches the nearest point of the examples'
//! hull, and shares change without a jump.

use glam::Vec3;
use motiondb::blend_space::triangulation::build;
use motiondb::blend_space::{BlendSpace, Locator, Shares};
use motiondb::motion::Parameters;
use proptest::prelude::*;

/// Examples with their blend space and its locator.
struct LocatedExamples {
    space: BlendSpace,
    parameters: Vec<Parameters>,
    locator: Locator,
}

fn located(points: &[Vec3]) -> LocatedExamples {
    let parameters: Vec<Parameters> = points.iter().map(|&point| Parameters::from_vec3(point)).collect();
    let space = build(&parameters);
    LocatedExamples { locator: Locator::new(&space, &parameters), space, parameters }
}

fn random(count: usize, seed: u32) -> Vec<Vec3> {
    let mut state = seed;
    let mut next = || {
        state = state.wrapping_mul(1_664_525).wrapping_add(1_013_904_223);
        (state >> 8) as f32 / (1 << 24) as f32
    };
    (0..count).map(|_| Vec3::new(3.0 * next(), 2.0 * next(), next())).collect()
}

fn reached(set: &LocatedExamples, shares: &Shares) -> Vec3 {
    (0..4).map(|k| set.parameters[shares.examples[k] as usize].to_vec3() * shares.shares[k]).sum()
}

/// x is the nearest point of a hull to p if no example c lies further towards p: (p − x)·(c − x) ≤ 0. Inside, x is p
/// itself.
#[track_caller]
fn check_nearest(set: &LocatedExamples, query: Vec3) {
    let shares = set.locator.locate(Parameters::from_vec3(query));
    assert!((shares.shares.iter().sum::<f32>() - 1.0).abs() < 1e-5, "{shares:?}");
    let scaled = |point: Vec3| set.space.scaled(Parameters::from_vec3(point));
    let (requested, found) = (scaled(query), scaled(reached(set, &shares)));
    let distance = (requested - found).length();
    // A distance as small as rounding has no direction.
    if distance > 1e-4 {
        let further = |at: &Parameters| (requested - found).dot(set.space.scaled(*at) - found) / distance;
        let furthest = set.parameters.iter().map(further).fold(0.0, f32::max);
        assert!(furthest < 3e-3, "{query} became {} with {furthest} to spare: {shares:?}", reached(set, &shares));
    }
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(200))]
    #[test]
    fn queries_reach_the_nearest_point_of_the_hull(
        points in prop::collection::vec(prop::array::uniform3(-2i8..3), 4..40),
        queries in prop::collection::vec(prop::array::uniform3(-12i8..13), 20),
    ) {
        let set = located(&points.iter().map(|point| Vec3::from(point.map(f32::from))).collect::<Vec<_>>());
        for query in queries {
            // Halves meet corners, edges and faces; the others come from far away.
            check_nearest(&set, Vec3::from(query.map(f32::from)) * 0.5);
            check_nearest(&set, Vec3::from(query.map(f32::from)) * 1e3);
        }
    }
}

#[test]
fn large_set_and_midpoints_are_reached() {
    let set = located(&random(300, 1));
    for simplex in set.space.simplices() {
        let corner = |k: usize| set.parameters[simplex[k] as usize].to_vec3();
        for mixture in [corner(0), 0.5 * (corner(0) + corner(3)), (corner(0) + corner(1) + corner(2)) / 3.0] {
            let shares = set.locator.locate(Parameters::from_vec3(mixture));
            assert!(reached(&set, &shares).distance(mixture) < 1e-5, "{mixture}");
        }
    }
    random(2000, 7).into_iter().for_each(|query| check_nearest(&set, 2.0 * query - Vec3::new(1.5, 1.0, 0.5)));
}

/// The greatest change of any example's share from one query to the next, on straight paths through the hull and
/// around.
fn largest_jump(set: &LocatedExamples, steps: u32) -> f32 {
    let ends = random(24, 3).into_iter().map(|end| 2.0 * end - Vec3::new(1.5, 1.0, 0.5)).collect::<Vec<_>>();
    let mut largest: f32 = 0.0;
    for path in ends.windows(2) {
        let mut before: Option<Vec<f32>> = None;
        for step in 0..=steps {
            let shares = set.locator.locate(Parameters::from_vec3(path[0].lerp(path[1], step as f32 / steps as f32)));
            let mut now = vec![0.0; set.parameters.len()];
            (0..4).for_each(|k| now[shares.examples[k] as usize] += shares.shares[k]);
            if let Some(before) = before {
                largest = before.iter().zip(&now).map(|(a, b)| (a - b).abs()).fold(largest, f32::max);
            }
            before = Some(now);
        }
    }
    largest
}

#[test]
fn shares_are_continuous_in_and_around_the_hull() {
    let flat = random(30, 5).into_iter().map(|point| Vec3::new(point.x, point.y, 0.0)).collect::<Vec<_>>();
    for set in [located(&random(30, 2)), located(&flat)] {
        let (coarse, fine) = (largest_jump(&set, 2_000), largest_jump(&set, 64_000));
        assert!(fine < 0.02 && fine < 0.15 * coarse, "{coarse}, {fine}");
    }
}

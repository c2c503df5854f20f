//! Routes through one-way zones on wild grounds, against a visibility graph with directions.

use glam::{DVec2, Vec2};

use super::visibility_graph::VisibilityGraph;
use super::wild_ground::WildGround;
use crate::maths::random::SplitMix64;
use crate::route::field::{RouteField, RouteGoal, RoutePosition, shortest_route};
use crate::route::mesh::{FreeSpace, Ground, RouteMesh};
use crate::world::one_way::OneWayZone;

/// Greatest relative difference of lengths: f32, and the tolerance of 5 mm against a zone's heading.
const TOLERANCE: f32 = 2e-5;
/// Number of goals on a ground.
const GOALS: u32 = 2;

/// A zone of a random size, in a random direction; every second one along the axes.
fn zone(random: &mut SplitMix64) -> OneWayZone {
    let mut within = |reach: f64| random.within(reach) as f32;
    let (at_m, size_m) = (Vec2::new(within(8.0), within(8.0)), Vec2::new(within(3.0), within(3.0)).abs() + 1.0);
    let turn_rad = std::f32::consts::FRAC_PI_2 * (within(4.0)).round();
    let turn_rad = if within(1.0) > 0.0 { turn_rad } else { turn_rad + within(1.0) };
    let (at_m, size_m) = if within(1.0) > 0.0 { ((2.0 * at_m).round() / 2.0, size_m.round()) } else { (at_m, size_m) };
    let corners_m = [[0.0, 0.0], [1.0, 0.0], [1.0, 1.0], [0.0, 1.0]]
        .map(|at| at_m + Vec2::from_angle(turn_rad).rotate(Vec2::from(at) * size_m));
    OneWayZone::new(&corners_m, turn_rad).expect("a rectangle along its heading")
}

fn zones(random: &mut SplitMix64) -> Vec<OneWayZone> {
    let mut zones: Vec<OneWayZone> = Vec::new();
    for _ in 0..4 {
        let zone = zone(random);
        if zones.iter().all(|other| !zone.overlaps(other)) {
            zones.push(zone);
        }
    }
    zones
}

#[derive(Debug, Default)]
struct Tally {
    queries: u32,
    without_route: u32,
    /// Queries whose route is longer than without zones, or does not exist.
    turned: u32,
    wrong: u32,
}

fn check_ground(seed: u64, starts: u32, tally: &mut Tally) {
    let (wild, mut random) = (WildGround::new(seed), SplitMix64::new(seed, 3));
    let zones = zones(&mut random);
    let ground = Ground { one_way: &zones, ..wild.ground() };
    let contours_m = FreeSpace::new(&ground, wild.wall_radius_m).expect("small numbers").contours_m();
    let uncut = RouteMesh::new(&ground, wild.wall_radius_m).expect("small numbers");
    let mesh = uncut.clone().with_one_way(&zones).expect("small numbers");
    let mut point_m =
        || (0..200).map(|_| wild.point(&mut random)).find(|at_m| uncut.triangle_at(DVec2::from(*at_m)).is_some());
    let mut graph = VisibilityGraph::new(&contours_m, &uncut);
    graph.zones = &zones;
    for _ in 0..GOALS {
        let Some(goal_m) = point_m() else { return };
        let field = RouteField::new(&mesh, RouteGoal::Points(vec![goal_m]));
        for _ in 0..starts {
            let Some(start_m) = point_m() else { return };
            let ours_m = field.step(&mesh, start_m, &mut RoutePosition::default()).map(|step| step.distance_m);
            let single_m = shortest_route(&mesh, start_m, goal_m).map(|route| route.length_m);
            let exact_m = graph.length_m(start_m, goal_m);
            let free_m = shortest_route(&uncut, start_m, goal_m).map(|route| route.length_m);
            let differs = |a: Option<f32>, b: Option<f32>| match (a, b) {
                (Some(a), Some(b)) => (a - b).abs() > TOLERANCE * b.max(1.0),
                (a, b) => a != b,
            };
            tally.queries += 1;
            tally.without_route += u32::from(exact_m.is_none());
            tally.turned += u32::from(differs(exact_m, free_m));
            if differs(ours_m, exact_m) || differs(single_m, exact_m) {
                tally.wrong += 1;
                eprintln!("{seed}: {start_m} {goal_m}: field {ours_m:?}, single {single_m:?}, exact {exact_m:?}");
            }
        }
    }
}

fn check_seeds(seeds: std::ops::Range<u64>, starts: u32) {
    let mut tally = Tally::default();
    seeds.for_each(|seed| check_ground(seed, starts, &mut tally));
    eprintln!("{tally:?}");
    assert!(tally.wrong == 0 && tally.turned > tally.queries / 20, "{tally:?}");
}

#[test]
fn routes_through_one_way_zones_are_those_of_brute_force() {
    check_seeds(0..7, 8);
}

#[test]
#[ignore = "takes ten minutes: 7,000 routes by brute force"]
fn thousands_of_routes_through_one_way_zones_are_those_of_brute_force() {
    check_seeds(1000..1070, 50);
}

//! Fields against other people's search, single routes, and the distance to walls.

mod one_way;
mod queries;
mod visibility_graph;
mod wild_ground;

use glam::{DVec2, Vec2};
use polyanya::Triangulation;
use polyanya_glam::Vec2 as OracleVec2;

use self::visibility_graph::VisibilityGraph;
use self::wild_ground::WildGround;
use super::*;
use crate::maths::random::SplitMix64;
use crate::route::mesh::{FreeSpace, RouteMesh};

/// Greatest relative difference of lengths, f32 of the oracle.
const TOLERANCE: f32 = 1e-5;
const GOALS: u64 = 10;
const STARTS: u64 = 100;

/// How the queries of a ground compare.
#[derive(Clone, Copy, Debug, Default)]
struct Tally {
    queries: usize,
    without_route: usize,
    /// The oracle finds no route, and the visibility graph agrees with ours.
    oracle_none: usize,
    /// The oracle's route is longer, and the visibility graph agrees with ours.
    oracle_longer: usize,
    /// The oracle's route is shorter, so cuts a corner, and the visibility graph agrees with ours.
    oracle_shorter: usize,
    ours_wrong: usize,
}

/// Everything that one ground needs.
struct Case {
    wild: WildGround,
    contours_m: Vec<Vec<DVec2>>,
    mesh: RouteMesh,
    oracle: Vec<polyanya::Mesh>,
}

impl Case {
    fn new(seed: u64) -> Self {
        let wild = WildGround::new(seed);
        let space = FreeSpace::new(&wild.ground(), wild.wall_radius_m).expect("coordinates are small");
        let contours_m = space.contours_m();
        let mesh = RouteMesh::of(&space).expect("coordinates are small");
        let oracle = oracle(&contours_m);
        Self { wild, contours_m, mesh, oracle }
    }

    fn point_on_mesh(&self, random: &mut SplitMix64) -> Option<Vec2> {
        let mut points_m = (0..1000).map(|_| self.wild.point(random));
        points_m.find(|point_m| self.mesh.triangle_at(DVec2::from(*point_m)).is_some())
    }

    fn oracle_length_m(&self, from_m: Vec2, to_m: Vec2) -> Option<f32> {
        let [from_m, to_m] = [from_m, to_m].map(|at_m| OracleVec2::new(at_m.x, at_m.y));
        let lengths_m = self.oracle.iter().filter_map(|mesh| {
            let holds = mesh.point_in_mesh(from_m) && mesh.point_in_mesh(to_m);
            holds.then(|| mesh.path(from_m, to_m)).flatten().map(|path| path.length)
        });
        lengths_m.reduce(f32::min)
    }

    fn tally(&self, seed: u64) -> Tally {
        let (mut random, mut tally) = (SplitMix64::new(seed, 2), Tally::default());
        for _ in 0..GOALS {
            let Some(goal_m) = self.point_on_mesh(&mut random) else { break };
            let field = RouteField::new(&self.mesh, RouteGoal::Points(vec![goal_m]));
            for start in 0..STARTS {
                let Some(start_m) = self.point_on_mesh(&mut random) else { break };
                let step = field.step(&self.mesh, start_m, &mut RoutePosition::default());
                let ours_m = step.map(|step| step.distance_m);
                self.compare(start_m, goal_m, ours_m, &mut tally);
                if start.is_multiple_of(20) {
                    self.check_route(&field, start_m, goal_m, ours_m);
                }
            }
        }
        tally
    }

    fn compare(&self, start_m: Vec2, goal_m: Vec2, ours_m: Option<f32>, tally: &mut Tally) {
        let oracle_m = self.oracle_length_m(start_m, goal_m);
        tally.queries += 1;
        tally.without_route += usize::from(ours_m.is_none());
        let differs = |a: Option<f32>, b: Option<f32>| match (a, b) {
            (Some(a), Some(b)) => (a - b).abs() > TOLERANCE * b.max(1.0),
            (a, b) => a != b,
        };
        if differs(ours_m, oracle_m) {
            let exact_m = VisibilityGraph::new(&self.contours_m, &self.mesh).length_m(start_m, goal_m);
            if differs(ours_m, exact_m) {
                tally.ours_wrong += 1;
                eprintln!("{start_m} {goal_m}: {ours_m:?}, oracle {oracle_m:?}, exact {exact_m:?}");
            } else if oracle_m.is_none() {
                tally.oracle_none += 1;
            } else if oracle_m > exact_m && exact_m.is_some() {
                tally.oracle_longer += 1;
            } else {
                tally.oracle_shorter += 1;
            }
        }
    }

    /// The corners of a route give its length, the single search finds the same, and no stretch is near a wall.
    fn check_route(&self, field: &RouteField, start_m: Vec2, goal_m: Vec2, ours_m: Option<f32>) {
        let corners_m = field.corners_m(&self.mesh, start_m, &mut RoutePosition::default());
        let single = shortest_route(&self.mesh, start_m, goal_m);
        assert_eq!((ours_m.is_some(), ours_m.is_some()), (corners_m.is_some(), single.is_some()));
        let (Some(ours_m), Some(corners_m), Some(single)) = (ours_m, corners_m, single) else { return };
        assert!(
            (single.length_m - ours_m).abs() <= 2e-6 * ours_m.max(1.0),
            "{start_m} {goal_m}: {} {ours_m}",
            single.length_m
        );
        assert_eq!(corners_m.last(), Some(&goal_m));
        for corners_m in [corners_m, single.corners_m] {
            let stretches = std::iter::once(&start_m).chain(&corners_m).zip(&corners_m);
            let length_m: f32 = stretches.clone().map(|(from_m, to_m)| from_m.distance(*to_m)).sum();
            assert!((length_m - ours_m).abs() <= 1e-5 * ours_m.max(1.0), "{start_m} {goal_m}: {length_m} {ours_m}");
            for (&from_m, &to_m) in stretches {
                let clearance_m = self.clearance_m(from_m, to_m);
                assert!(clearance_m >= self.wild.wall_radius_m, "{from_m} {to_m}: {clearance_m}");
            }
        }
    }

    /// Distance of a straight path from the nearest wall, m.
    fn clearance_m(&self, from_m: Vec2, to_m: Vec2) -> f32 {
        let rooms_m = if self.wild.walkable_m.len() == 1 { &self.wild.walkable_m[..] } else { &[] };
        let polygons_m = self.wild.obstacles_m.iter().chain(rooms_m.iter().map(|room| &room.outline_m));
        let edges_m = polygons_m.flat_map(|corners_m| corners_m.iter().zip(corners_m.iter().cycle().skip(1)));
        let path = crate::maths::segment_distance::Segment { from_m: from_m.extend(0.0), to_m: to_m.extend(0.0) };
        let distance_m = |(a_m, b_m): (&Vec2, &Vec2)| {
            let edge = crate::maths::segment_distance::Segment { from_m: a_m.extend(0.0), to_m: b_m.extend(0.0) };
            crate::maths::segment_distance::distance_m(&path, &edge)
        };
        edges_m.map(distance_m).fold(f32::INFINITY, f32::min)
    }
}

/// The free space as meshes of other people's search, one for each connected piece.
fn oracle(contours_m: &[Vec<DVec2>]) -> Vec<polyanya::Mesh> {
    let corners = |contour_m: &Vec<DVec2>| -> Vec<OracleVec2> {
        contour_m.iter().map(|at_m| OracleVec2::new(at_m.x as f32, at_m.y as f32)).collect()
    };
    let area_m2 = |contour_m: &Vec<DVec2>| -> f64 {
        (1..contour_m.len()).map(|at| contour_m[at - 1].perp_dot(contour_m[at])).sum::<f64>()
            + contour_m[contour_m.len() - 1].perp_dot(contour_m[0])
    };
    let mut meshes: Vec<Triangulation> = Vec::new();
    for contour_m in contours_m {
        // Each piece is an outer contour and the holes that follow it.
        if area_m2(contour_m) > 0.0 {
            meshes.push(Triangulation::from_outer_edges(&corners(contour_m)));
        } else if let Some(mesh) = meshes.last_mut() {
            mesh.add_obstacle(corners(contour_m));
        }
    }
    meshes.into_iter().map(|triangulation| triangulation.as_navmesh()).collect()
}

fn check_seeds(seeds: std::ops::Range<u64>) {
    let mut all = Tally::default();
    for seed in seeds {
        let tally = Case::new(seed).tally(seed);
        all.queries += tally.queries;
        all.without_route += tally.without_route;
        all.oracle_none += tally.oracle_none;
        all.oracle_longer += tally.oracle_longer;
        all.oracle_shorter += tally.oracle_shorter;
        all.ours_wrong += tally.ours_wrong;
    }
    eprintln!("{all:?}");
    assert_eq!(all.ours_wrong, 0, "{all:?}");
}

#[test]
fn lengths_are_those_of_other_search() {
    check_seeds(0..20);
}

#[test]
#[ignore = "takes half a minute: 105,000 routes"]
fn thousands_of_lengths_are_those_of_other_search() {
    check_seeds(1000..1105);
}

//! Queries of fields on small grounds: areas, positions and goals off the mesh, memory.

use glam::Vec2;

use super::wild_ground::WildGround;
use crate::maths::random::SplitMix64;
use crate::route::field::{RouteField, RouteGoal, RoutePosition, RouteStep, shortest_route};
use crate::route::mesh::{Ground, RouteMesh};

const WALL_RADIUS_M: f32 = 0.2;

fn block(x: f32, y: f32, width_m: f32, depth_m: f32) -> Vec<Vec2> {
    [[x, y], [x + width_m, y], [x + width_m, y + depth_m], [x, y + depth_m]].map(Vec2::from).to_vec()
}

/// Open ground with a wall from (0, −5) to (0.1, 5).
fn wall() -> RouteMesh {
    let obstacles_m = [block(0.0, -5.0, 0.1, 10.0)];
    RouteMesh::new(&Ground { obstacles_m: &obstacles_m, ..Ground::default() }, WALL_RADIUS_M).expect("small numbers")
}

fn step(mesh: &RouteMesh, goal: RouteGoal, from_m: [f32; 2]) -> Option<RouteStep> {
    RouteField::new(mesh, goal).step(mesh, Vec2::from(from_m), &mut RoutePosition::default())
}

fn point(x: f32, y: f32) -> RouteGoal {
    RouteGoal::Points(vec![Vec2::new(x, y)])
}

#[test]
fn a_route_leads_around_a_wall_corner_by_corner() {
    let mesh = wall();
    let field = RouteField::new(&mesh, point(3.0, 4.0));
    let from_m = Vec2::new(-3.0, 4.0);
    let corners_m = field.corners_m(&mesh, from_m, &mut RoutePosition::default()).expect("open ground");
    assert!(corners_m[..corners_m.len() - 1].iter().all(|corner_m| corner_m.y > 5.0 && corner_m.x.abs() < 0.4));
    let step = field.step(&mesh, from_m, &mut RoutePosition::default()).expect("open ground");
    assert_eq!((step.next_m, step.after_m, step.entry_m), (corners_m[0], Some(corners_m[1]), None));
    assert!((6.48..6.49).contains(&step.distance_m), "{step:?}");
}

#[test]
fn areas_are_entered_at_their_nearest_point() {
    let mesh = wall();
    let polygon = RouteGoal::Polygon(block(3.0, -1.0, 2.0, 2.0));
    let near = step(&mesh, polygon.clone(), [1.0, 0.3]).expect("open ground");
    assert_eq!((near.next_m, near.distance_m), (Vec2::new(3.0, 0.3), 2.0));
    let inside = step(&mesh, polygon.clone(), [4.0, 0.3]).expect("open ground");
    assert_eq!((inside.next_m, inside.distance_m), (Vec2::new(4.0, 0.3), 0.0));
    assert!(step(&mesh, polygon, [-3.0, 0.0]).expect("open ground").next_m.y.abs() > 5.0);
    let line = RouteGoal::Line([Vec2::new(3.0, -4.0), Vec2::new(3.0, 4.0)]);
    assert_eq!(step(&mesh, line, [5.0, 1.1]).expect("open ground").next_m, Vec2::new(3.0, 1.1));
    let disc = RouteGoal::Disc { centre_m: Vec2::new(5.0, 0.0), radius_m: 1.0 };
    assert_eq!(step(&mesh, disc, [3.0, 0.0]).expect("open ground").next_m, Vec2::new(4.0, 0.0));
}

#[test]
fn a_goal_beside_a_wall_is_reached_over_the_mesh() {
    let (mesh, goal_m) = (wall(), Vec2::new(0.15, 1.0));
    let field = RouteField::new(&mesh, point(goal_m.x, goal_m.y));
    let (mut remembered, mut position_m) = (RoutePosition::default(), Vec2::new(3.0, 3.0));
    for _ in 0..100 {
        let step = field.step(&mesh, position_m, &mut remembered).expect("open ground");
        position_m += (step.next_m - position_m).clamp_length_max(0.05);
    }
    assert!(position_m.distance(goal_m) < 1e-3, "{position_m}");
}

#[test]
fn an_agent_off_the_mesh_returns_to_its_own_side() {
    let mesh = wall();
    let field = RouteField::new(&mesh, point(3.0, 0.0));
    let position_m = Vec2::new(-0.01, 3.0);
    let step = field.step(&mesh, position_m, &mut RoutePosition::default()).expect("open ground");
    let entry_m = step.entry_m.expect("too near to the wall");
    assert!((-0.21..=-0.2).contains(&entry_m.x) && entry_m.y == 3.0, "{step:?}");
    let aim_m = step.aim_m(position_m);
    assert!(aim_m.x < -0.2 && aim_m.y > 3.1, "{aim_m}");
    // Outside the box of open ground.
    let far = field.step(&mesh, Vec2::new(3.0, 500.0), &mut RoutePosition::default()).expect("open ground");
    assert!((far.distance_m - 500.0).abs() < 1.0 && far.entry_m.is_some(), "{far:?}");
}

#[test]
fn walls_between_parts_are_not_passed() {
    let obstacles_m =
        [block(0.0, 0.0, 9.0, 0.1), block(0.0, 0.0, 0.1, 9.0), block(8.9, 0.0, 0.1, 9.0), block(0.0, 8.9, 9.0, 0.1)];
    let ground = Ground { obstacles_m: &obstacles_m, ..Ground::default() };
    let mesh = RouteMesh::new(&ground, WALL_RADIUS_M).expect("small numbers");
    assert_eq!(step(&mesh, point(-3.0, 4.0), [4.0, 4.0]), None);
    assert_eq!(shortest_route(&mesh, Vec2::splat(4.0), Vec2::new(-3.0, 4.0)), None);
    let field = RouteField::new(&mesh, point(8.0, 4.0));
    let mut remembered = RoutePosition::default();
    assert!(field.step(&mesh, Vec2::new(1.0, 4.0), &mut remembered).is_some());
    // Pushed into the wall, and nearer to its other side.
    let pushed = field.step(&mesh, Vec2::new(-0.05, 4.0), &mut remembered).expect("remembers the room");
    assert!(pushed.entry_m.is_some_and(|entry_m| entry_m.x > 0.3), "{pushed:?}");
}

#[test]
fn nothing_to_walk_on_gives_no_route() {
    let mesh = RouteMesh::default();
    assert_eq!(step(&mesh, point(0.0, 0.0), [1.0, 0.0]), None);
    assert_eq!(shortest_route(&mesh, Vec2::ZERO, Vec2::X), None);
    assert_eq!(step(&wall(), RouteGoal::Points(Vec::new()), [1.0, 0.0]), None);
}

#[test]
fn far_from_the_origin_routes_are_the_same() {
    let far_m = Vec2::new(9_984.0, -9_984.0);
    let lengths_m = [Vec2::ZERO, far_m].map(|shift_m| {
        let wall_m = block(0.0, -5.0, 0.125, 10.0).iter().map(|corner_m| *corner_m + shift_m).collect::<Vec<_>>();
        let ground = Ground { obstacles_m: &[wall_m], ..Ground::default() };
        let mesh = RouteMesh::new(&ground, WALL_RADIUS_M).expect("within 16 km");
        let [start_m, goal_m] = [Vec2::new(-3.0, 4.0), Vec2::new(3.0, 4.0)].map(|at_m| at_m + shift_m);
        let field = RouteField::new(&mesh, RouteGoal::Points(vec![goal_m]));
        field.step(&mesh, start_m, &mut RoutePosition::default()).map(|step| step.distance_m)
    });
    assert!(lengths_m[0].is_some() && lengths_m[0] == lengths_m[1], "{lengths_m:?}");
    let mesh = wall();
    assert!(RouteMesh::new(&Ground { points_m: &[Vec2::splat(f32::MAX)], ..Ground::default() }, 0.2).is_err());
    assert!(RouteMesh::new(&Ground::default(), f32::NAN).is_err());
    assert!(step(&mesh, point(1e30, 0.0), [3.0, 0.0]).is_some_and(|step| step.distance_m > 1e29));
}

#[test]
fn memory_changes_no_answer() {
    for seed in [7, 8, 9, 12] {
        let (wild, mut random) = (WildGround::new(seed), SplitMix64::new(seed, 3));
        let mesh = RouteMesh::new(&wild.ground(), wild.wall_radius_m).expect("coordinates are small");
        let field = RouteField::new(&mesh, RouteGoal::Points(vec![wild.point(&mut random)]));
        let (mut remembered, mut position_m) = (RoutePosition::default(), wild.point(&mut random));
        for _ in 0..2000 {
            position_m += Vec2::new(random.within(0.4) as f32, random.within(0.4) as f32);
            let fresh = field.step(&mesh, position_m, &mut RoutePosition::default());
            let walked = field.step(&mesh, position_m, &mut remembered);
            let [fresh_m, walked_m] =
                [fresh, walked].map(|step| step.filter(|step| step.entry_m.is_none()).map(|step| step.distance_m));
            let same = fresh_m.zip(walked_m).is_none_or(|(fresh_m, walked_m)| (fresh_m - walked_m).abs() < 1e-5);
            assert!(same, "{position_m}: {fresh:?} {walked:?}");
        }
    }
}

#[test]
fn fields_are_the_same_on_any_thread() {
    use rayon::prelude::*;
    let wild = WildGround::new(4);
    let mesh = RouteMesh::new(&wild.ground(), wild.wall_radius_m).expect("coordinates are small");
    let goals_m: Vec<Vec2> = (0..8).map(|at| Vec2::splat(at as f32)).collect();
    let field = |goal_m: &Vec2| format!("{:?}", RouteField::new(&mesh, RouteGoal::Points(vec![*goal_m])));
    let alone: Vec<String> = goals_m.iter().map(field).collect();
    assert_eq!(goals_m.par_iter().map(field).collect::<Vec<String>>(), alone);
}

#[test]
fn clearance_keeps_wild_meshes_whole() {
    for seed in 0..300 {
        let wild = WildGround::new(seed);
        let before = RouteMesh::new(&wild.ground(), wild.wall_radius_m).expect("coordinates are small");
        let mesh = before.clone().with_clearance(0.15);
        assert_eq!(mesh.part_count(), before.part_count());
        for triangle in 0..mesh.triangle_count() as u32 {
            let corners_m = mesh.corners_m(triangle);
            let [a_m, b_m, c_m] = corners_m;
            assert!((b_m - a_m).perp_dot(c_m - a_m) > 0.0, "ground {seed}: {corners_m:?}");
            let points_m = [a_m, b_m, c_m, (a_m + b_m + c_m) / 3.0, a_m.midpoint(b_m)];
            for point_m in points_m {
                let near = before.nearest(point_m, None, None).expect("triangles");
                assert!(near.point_m.distance(point_m) < 2e-3, "ground {seed}: {point_m} is too near to a wall");
            }
        }
    }
}

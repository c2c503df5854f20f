//! Agents that find their way: around corners, walls and holes, and back when they are pushed.

use std::path::PathBuf;
use std::sync::Arc;

use glam::Vec2;
use motiondb::files::SourceText;

use crate::route::KeepSide;
use crate::route::mesh::WalkablePolygon;
use crate::scenario::{AgentSpec, Coupling, Scenario, parse};
use crate::simulation::Simulation;
use crate::test_db::test_db;

/// Distance from its goal within which an agent has arrived, m.
const ARRIVED_M: f32 = 0.5;

fn block(low: [f32; 2], high: [f32; 2]) -> Vec<Vec2> {
    [low, [high[0], low[1]], high, [low[0], high[1]]].map(Vec2::from).to_vec()
}

/// Agents side by side, 0.7 m apart, with a goal each.
fn agents(count: usize, from_m: [f32; 2], to_m: [f32; 2]) -> Vec<AgentSpec> {
    let agent = |index: usize| {
        let aside_m = 0.7 * index as f32;
        let position_m = Vec2::from(from_m) + Vec2::new(0.0, aside_m);
        AgentSpec { position_m, goals_m: vec![Vec2::from(to_m) + Vec2::new(aside_m, 0.0)], ..AgentSpec::default() }
    };
    (0..count).map(agent).collect()
}

/// Simulates; no root ever overlaps a wall. Returns the simulation at its end.
fn walked(scenario: &Scenario, duration_s: f32) -> Simulation {
    let mut simulation = Simulation::new(Arc::new(test_db()), scenario);
    let walls = scenario.walls();
    for _ in 0..(duration_s / scenario.dt_s) as usize {
        simulation.step(&mut |_| {});
        for (frame, agent) in simulation.frames().iter().zip(&scenario.agents) {
            assert!(walls.depth_m(frame.root.position_m, agent.wall_radius_m) < 1e-3, "{}", frame.root.position_m);
        }
    }
    simulation
}

fn check_all_arrive(scenario: &Scenario, duration_s: f32) {
    let simulation = walked(scenario, duration_s);
    for (frame, agent) in simulation.frames().iter().zip(&scenario.agents) {
        let (at_m, goal_m) = (frame.root.position_m, agent.goals_m[0]);
        assert!(at_m.distance(goal_m) < ARRIVED_M, "{at_m} instead of {goal_m}");
    }
}

/// A corner of a corridor of 2 m.
fn corner() -> Vec<Vec<Vec2>> {
    vec![block([-1.0, 2.0], [5.0, 9.0]), block([-1.0, -0.3], [7.3, 0.0]), block([7.0, 0.0], [7.3, 9.0])]
}

#[test]
fn agents_walk_around_a_corner() {
    for keep in [KeepSide::Right, KeepSide::Left, KeepSide::None] {
        let mut scenario = Scenario { obstacles_m: corner(), ..Scenario::of(agents(2, [0.5, 0.65], [5.5, 8.0])) };
        scenario.params.route.keep = keep;
        check_all_arrive(&scenario, 25.0);
    }
}

#[test]
fn a_goal_behind_a_wall_is_reached_around_it() {
    let obstacles_m = vec![block([3.0, -4.0], [3.2, 4.0])];
    check_all_arrive(&Scenario { obstacles_m, ..Scenario::of(agents(2, [0.0, 0.0], [6.0, 0.0])) }, 25.0);
}

#[test]
fn walkable_ground_holds_agents_and_leads_around_its_holes() {
    let walkable_m = vec![
        WalkablePolygon { outline_m: block([-1.0, -3.0], [5.0, 3.0]), holes_m: vec![block([2.0, -2.9], [3.0, 1.5])] },
        WalkablePolygon { outline_m: block([4.0, -3.0], [8.0, 3.0]), holes_m: Vec::new() },
    ];
    check_all_arrive(&Scenario { walkable_m, ..Scenario::of(agents(2, [0.0, -1.0], [6.0, -1.0])) }, 25.0);
}

#[test]
fn an_enclosure_keeps_agents_in_and_others_out() {
    let enclosures_m = vec![block([-1.0, -1.0], [2.0, 1.0])];
    let mut inside = agents(1, [0.0, 0.0], [6.0, 0.0]);
    inside.extend(agents(1, [6.0, 0.0], [0.0, 0.0]));
    // Neither has a route; a scenario file would not be read.
    let simulation = walked(&Scenario { enclosures_m: enclosures_m.clone(), ..Scenario::of(inside) }, 12.0);
    assert!(simulation.frames()[0].root.position_m.x < 2.0 && simulation.frames()[1].root.position_m.x > 2.0);
    check_all_arrive(&Scenario { enclosures_m, ..Scenario::of(agents(1, [-3.0, 0.0], [5.0, 0.0])) }, 20.0);
}

#[test]
fn a_pushed_agent_finds_back() {
    let mut scenario = Scenario { obstacles_m: corner(), ..Scenario::of(agents(1, [0.5, 1.0], [6.0, 8.0])) };
    // Walks around the corner, and then from far back, as if a crowd had carried it there.
    let mut simulation = walked(&scenario, 8.0);
    let carried = AgentSpec { position_m: Vec2::new(-3.0, 5.0), ..scenario.agents[0].clone() };
    assert!(simulation.add(carried.clone()).is_some());
    (0..900).for_each(|_| simulation.step(&mut |_| {}));
    for frame in simulation.frames() {
        assert!(frame.root.position_m.distance(Vec2::new(6.0, 8.0)) < 1.2, "{}", frame.root.position_m);
    }
    scenario.agents = vec![carried];
    check_all_arrive(&scenario, 25.0);
}

/// A hall with a zone that is closed to visitors, who have as many starts before it as staff.
const CLOSED_ZONE: &str = "
    duration_s = 30
    walkable = [{ polygon_m = [[-3, -4], [10, -4], [10, 4], [-3, 4]] }]
    [profiles.visitor]
    [profiles.staff]
    preferred_speed_mps = 1.2
    [[zones]]
    circle_m = [4, 0, 1.5]
    closed_to = ['visitor']
    [[agents]]
    grid = { columns = 2, rows = 4, spacing_m = 0.8, centre_m = [0, -0.4] }
    goal_offset_m = [8, 0]
    profile = 'visitor'
    [[agents]]
    grid = { columns = 1, rows = 4, spacing_m = 0.8, centre_m = [-1.5, 0] }
    goal_offset_m = [9.5, 0]
    at_goal = 'leave_at_once'
    profile = 'staff'
    [[sources]]
    rect_m = [8.5, -1, 9, 1]
    rate_per_s = 0.5
    goals_m = [[-2, 0]]
    at_goal = 'leave'
    profile = { visitor = 1, staff = 1 }
";

#[test]
fn agents_stay_outside_zones_that_are_closed_to_them() {
    for coupling in [Coupling::TwoWay, Coupling::Decoupled, Coupling::Discs] {
        let text = SourceText { path: PathBuf::from("zone.toml"), text: CLOSED_ZONE.into() };
        let scenario = Scenario { coupling, ..parse(&text).unwrap().0 };
        let mut simulation = Simulation::new(Arc::new(test_db()), &scenario);
        let (zone, mut staff_inside) = (&scenario.zones[0].area, [0; 2]);
        for _ in 0..scenario.steps() {
            simulation.step(&mut |_| {});
            for frame in simulation.frames() {
                let (at_m, spec) = (frame.root.position_m, simulation.population().spec(frame.id));
                let is_from_source = usize::from(frame.id.index() >= scenario.agents.len());
                if spec.closed_zones == 0 {
                    staff_inside[is_from_source] += usize::from(zone.holds(at_m));
                } else {
                    assert!(zone.distance_m(at_m) > spec.wall_radius_m - 1e-3, "{coupling:?}: {at_m}");
                }
            }
        }
        assert!(staff_inside[0] > 20 && staff_inside[1] > 20, "{coupling:?}: {staff_inside:?}");
        let visitors = simulation.population().agents.iter().filter(|life| life.spec.closed_zones == 1);
        assert!(visitors.clone().skip(8).any(|life| life.removed.is_some()));
        for frame in simulation.frames().iter().filter(|frame| frame.id.index() < 8) {
            let goal_m = scenario.agents[frame.id.index()].goals_m[0];
            assert!(frame.root.position_m.distance(goal_m) < 1.5, "{coupling:?}: {}", frame.root.position_m);
        }
    }
}

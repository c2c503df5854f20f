//! Claims about whole steps: determinism, arrival, walls, couplings; and about agents that behave, come and go, find their
//! routes, wait before doors, walk in groups, and have priorities and sizes.

use std::path::PathBuf;

use glam::Vec2;
use motiondb::files::SourceText;

use super::*;
use crate::maths::angle::wrap_rad;
use crate::planning::planner::Planner;
use crate::scenario::{AgentSpec, parse};
use crate::synthesis::Mode;
use crate::synthesis::blending::BlendDomain;
use crate::test_db::{db_with_fingers, test_db};

mod behaviour;
mod closed_in;
mod door;
mod group;
mod one_way;
mod places;
mod priority;
mod route;
mod stature;
mod taken_goals;
mod turning;
mod turnover;
mod wild_behaviour;

/// Agents on a circle; the goal of each is the opposite point.
pub(crate) fn antipodal(count: usize, radius_m: f32) -> Scenario {
    let agent = |index: usize| {
        let angle_rad = std::f32::consts::TAU * index as f32 / count as f32;
        let position_m = Vec2::from_angle(angle_rad) * radius_m;
        AgentSpec {
            position_m,
            facing_rad: angle_rad + std::f32::consts::PI,
            goals_m: vec![-position_m],
            radius_m: 0.25,
            wall_radius_m: 0.2,
            preferred_speed_mps: 1.3,
            ..AgentSpec::default()
        }
    };
    Scenario { name: "antipodal".into(), duration_s: 30.0, ..Scenario::of((0..count).map(agent).collect()) }
}

/// The scenario of a text.
fn scenario_of(text: &str) -> Scenario {
    parse(&SourceText { path: PathBuf::from("test.toml"), text: text.to_owned() }).unwrap().0
}

fn started(scenario: &Scenario) -> Simulation {
    Simulation::new(Arc::new(test_db()), scenario)
}

/// Runs a scenario to its end; `watch` sees every step and the time after it, s.
fn run(scenario: &Scenario, mut watch: impl FnMut(&Simulation, f64)) -> Simulation {
    let mut simulation = started(scenario);
    for step in 1..=scenario.steps() {
        simulation.step(&mut |_| {});
        watch(&simulation, step as f64 * f64::from(scenario.dt_s));
    }
    assert_eq!(simulation.endless_transitions(), None);
    simulation
}

fn simulated(scenario: &Scenario, steps: usize) -> Vec<AgentFrame> {
    let mut simulation = Simulation::new(Arc::new(test_db()), scenario);
    (0..steps).for_each(|_| simulation.step(&mut |_| {}));
    simulation.frames().to_vec()
}

#[test]
fn one_and_two_threads_give_equal_bits() {
    let mut scenario = antipodal(100, 14.0);
    scenario.obstacles_m = vec![[(-3.0, -0.5), (3.0, -0.5), (3.0, 0.5), (-3.0, 0.5)].map(Vec2::from).to_vec()];
    let pool = |threads| rayon::ThreadPoolBuilder::new().num_threads(threads).build().unwrap();
    let both = [pool(1), pool(2)];
    let mut simulations = [0, 1].map(|_| Simulation::new(Arc::new(test_db()), &scenario));
    for step in 0..300 {
        for (simulation, pool) in simulations.iter_mut().zip(&both) {
            pool.install(|| simulation.step(&mut |_| {}));
        }
        assert!(simulations[0].frames() == simulations[1].frames(), "step {step}");
    }
}

#[test]
fn extra_joints_are_equal_for_any_number_of_threads() {
    let scenario = antipodal(60, 8.0);
    let pool = |threads| rayon::ThreadPoolBuilder::new().num_threads(threads).build().unwrap();
    let played = |db: MotionDb, threads: usize| {
        let mut simulation = Simulation::new(Arc::new(db), &scenario);
        pool(threads).install(|| (0..240).for_each(|_| simulation.step(&mut |_| {})));
        let rotations: Vec<Vec<Quat>> = simulation.extra_rotations().map(<[Quat]>::to_vec).collect();
        (simulation.frames().to_vec(), rotations)
    };
    let [one, three] = [1, 3].map(|threads| played(db_with_fingers(), threads));
    assert_eq!(one, three);
    assert!(one.1.iter().all(|rotations| rotations.len() == 2) && one.1[0] != one.1[1]);
    // The poses are those of a database without them.
    let (frames, rotations) = played(test_db(), 2);
    assert!(frames == one.0 && rotations.iter().all(Vec::is_empty));
}

#[test]
fn all_agents_cross_the_circle_and_stand() {
    let scenario = antipodal(17, 8.0);
    let frames = simulated(&scenario, 900);
    for (frame, agent) in frames.iter().zip(&scenario.agents) {
        let off_m = frame.root.position_m.distance(agent.goals_m[0]);
        assert!(off_m < 0.5, "{off_m} m");
        assert_eq!(frame.contacts, [1.0; 2]);
    }
}

#[test]
fn bodies_start_with_every_planner_and_step() {
    for planner in [Planner::Mcn, Planner::Orca, Planner::SocialForce] {
        for dt_s in [1.0 / 120.0, 1.0 / 60.0, 0.1] {
            let scenario = Scenario { planner, dt_s, ..antipodal(1, 4.0) };
            let [frame] = simulated(&scenario, (2.0 / dt_s) as usize)[..] else { unreachable!() };
            let walked_m = frame.root.position_m.distance(scenario.agents[0].position_m);
            assert!(walked_m > 1.0, "{planner:?} in steps of {dt_s} s: {walked_m} m");
        }
    }
}

#[test]
fn no_root_enters_a_wall() {
    let mut scenario = antipodal(1, 4.0);
    let wall = [(-0.5, -6.0), (0.5, -6.0), (0.5, 6.0), (-0.5, 6.0)];
    scenario.obstacles_m = vec![wall.map(Vec2::from).to_vec()];
    let mut simulation = Simulation::new(Arc::new(test_db()), &scenario);
    for _ in 0..300 {
        simulation.step(&mut |_| {});
        let position_m = simulation.frames()[0].root.position_m;
        assert!(simulation.obstacles.depth_m(position_m, 0.2) < 1e-4, "{position_m}");
    }
}

#[test]
fn discs_move_as_planned_outside_walls() {
    let mut scenario = antipodal(6, 4.0);
    scenario.coupling = Coupling::Discs;
    scenario.obstacles_m = vec![[(-0.5, -0.5), (0.5, -0.5), (0.5, 0.5), (-0.5, 0.5)].map(Vec2::from).to_vec()];
    let mut simulation = Simulation::new(Arc::new(test_db()), &scenario);
    for _ in 0..300 {
        let before = simulation.frames().to_vec();
        simulation.step(&mut |_| {});
        for (before, after) in before.iter().zip(simulation.frames()) {
            let planned_m = before.root.position_m + scenario.dt_s * after.planned_mps;
            let position_m = after.root.position_m;
            let is_near = planned_m.abs().max_element() < 0.8;
            assert!(is_near || position_m == planned_m, "{position_m} instead of {planned_m}");
            let depth_m = simulation.obstacles.depth_m(position_m, 0.2);
            assert!(depth_m == 0.0, "{position_m} lies {depth_m} m in the wall");
        }
    }
}

#[test]
fn decoupled_bodies_follow_their_discs_exactly() {
    let mut scenario = antipodal(17, 4.0);
    (scenario.planner, scenario.coupling) = (Planner::Orca, Coupling::Decoupled);
    let db = test_db();
    let turn_max_rad = BlendDomain::new(&db).turn_rate_max_rad_s * scenario.dt_s;
    let mut simulation = Simulation::new(Arc::new(db), &scenario);
    for _ in 0..300 {
        let before = simulation.frames().to_vec();
        simulation.step(&mut |_| {});
        for (before, after) in before.iter().zip(simulation.frames()) {
            assert_eq!(after.root.position_m, before.root.position_m + scenario.dt_s * after.planned_mps);
            let turned_rad = wrap_rad(after.root.facing_rad - before.root.facing_rad);
            assert!(turned_rad.abs() <= 1.001 * turn_max_rad && after.mode == Mode::Blending);
        }
    }
}

#[test]
fn stages_end_in_the_order_of_the_paper() {
    let mut stages = Vec::new();
    Simulation::new(Arc::new(test_db()), &antipodal(2, 3.0)).step(&mut |stage| stages.push(stage));
    assert_eq!(stages, [Stage::Route, Stage::Neighbours, Stage::Planning, Stage::Synthesis, Stage::Coupling]);
}

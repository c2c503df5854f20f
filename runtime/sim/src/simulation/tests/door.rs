//! Claims about doors that open and close by signal.

use std::path::PathBuf;
use std::sync::Arc;

use glam::Vec2;
use motiondb::files::SourceText;

use crate::behaviour::{Behaviour, Signal};
use crate::maths::random::SplitMix64;
use crate::route::mesh::WalkablePolygon;
use crate::scenario::{AgentSpec, Coupling, DoorSpec, Scenario, SourceSpec, parse};
use crate::simulation::Simulation;
use crate::test_db::test_db;

/// Half the thickness of the wall between the two rooms, m.
const HALF_WALL_M: f32 = 0.1;
/// Depth of a disc in a wall that counts as none, m: rounding.
const TOUCH_M: f32 = 1e-3;

fn block(low: [f32; 2], high: [f32; 2]) -> Vec<Vec2> {
    [low, [high[0], low[1]], high, [low[0], high[1]]].map(Vec2::from).to_vec()
}

/// A signal that is red for a time, then green.
fn opens_at(time_s: f32) -> Signal {
    Signal { name: format!("at {time_s}"), green_s: 1e4, red_s: time_s, offset_s: time_s }
}

/// Two rooms of 8 m by 8 m, left and right of x = 0, with a wall between that has a door of a width for each signal.
fn rooms(doors: &[([f32; 2], Signal)], agents: Vec<AgentSpec>) -> Scenario {
    let (mut obstacles_m, mut from_m) = (Vec::new(), -4.5);
    let leaf = |[low_m, high_m]: [f32; 2]| block([-HALF_WALL_M, low_m], [HALF_WALL_M, high_m]);
    for ([low_m, high_m], _) in doors {
        obstacles_m.push(leaf([from_m, *low_m]));
        from_m = *high_m;
    }
    obstacles_m.push(leaf([from_m, 4.5]));
    let door = |(index, (sides_m, _)): (usize, &([f32; 2], Signal))| DoorSpec {
        polygon_m: leaf(*sides_m),
        signal: index as u32,
    };
    Scenario {
        obstacles_m,
        doors: doors.iter().enumerate().map(door).collect(),
        behaviour: Behaviour {
            signals: doors.iter().map(|(_, signal)| signal.clone()).collect(),
            ..Behaviour::default()
        },
        walkable_m: vec![WalkablePolygon { outline_m: block([-8.0, -4.0], [8.0, 4.0]), holes_m: Vec::new() }],
        ..Scenario::of(agents)
    }
}

/// Agents in a column in the left room, with goals in the right room.
fn agents(count: usize) -> Vec<AgentSpec> {
    let agent = |index: usize| {
        let at_m = Vec2::new(0.8 * (index / 6) as f32, 0.8 * (index % 6) as f32 - 2.0);
        let (position_m, goal_m) = (Vec2::new(-7.0, 0.0) + at_m, Vec2::new(6.5, 0.0) + at_m * Vec2::new(-1.0, 1.0));
        AgentSpec { position_m, goals_m: vec![goal_m], ..AgentSpec::default() }
    };
    (0..count).map(agent).collect()
}

/// Simulates. In each step no disc overlaps the walls with the doors as they are in it; `seen` receives the simulation.
fn walk(scenario: &Scenario, duration_s: f32, seen: &mut dyn FnMut(&Simulation)) -> Simulation {
    let mut simulation = Simulation::new(Arc::new(test_db()), scenario);
    let mut walls = (Vec::new(), scenario.walls());
    for step in 0..(duration_s / scenario.dt_s) as u32 {
        simulation.step(&mut |_| {});
        let closed = simulation.population().closed_doors(step + 1);
        if closed != walls.0 {
            walls = (closed.clone(), scenario.walls_with(&closed));
        }
        for frame in simulation.frames() {
            let (at_m, spec) = (frame.root.position_m, simulation.population().spec(frame.id));
            assert!(walls.1.depth_m(at_m, spec.wall_radius_m) < TOUCH_M, "step {step}: {at_m}, doors {closed:?}");
        }
        seen(&simulation);
    }
    simulation
}

fn arrived(simulation: &Simulation) -> usize {
    let is_there = |frame: &&crate::AgentFrame| {
        let goal_m = simulation.population().spec(frame.id).goals_m[0];
        frame.root.position_m.distance(goal_m) < 0.7
    };
    simulation.frames().iter().filter(is_there).count()
}

/// Two rooms with random doors, phases and agents, some of which start in the right room.
fn wild(seed: u64, coupling: Coupling) -> Scenario {
    let mut random = SplitMix64::new(seed, 0);
    let mut doors = Vec::new();
    for index in 0..1 + seed % 3 {
        let middle_m = -2.6 + 2.6 * index as f32 + random.within(0.4) as f32;
        let half_m = 0.45 + 0.35 * random.unit() as f32;
        let [green_s, red_s, offset_s] = [1.5, 4.0, 0.0].map(|least_s| least_s + 4.0 * random.unit() as f32);
        doors.push(([middle_m - half_m, middle_m + half_m], Signal { name: String::new(), green_s, red_s, offset_s }));
    }
    let mut agents = agents(8);
    for (index, agent) in agents.iter_mut().enumerate().filter(|(index, _)| index % 3 == 0) {
        let goal_m = agent.position_m;
        *agent = AgentSpec { position_m: agent.goals_m[0], goals_m: vec![goal_m], ..agent.clone() };
        agent.preferred_speed_mps += 0.05 * index as f32;
    }
    Scenario { coupling, seed, ..rooms(&doors, agents) }
}

#[test]
fn no_agent_passes_a_closed_door() {
    let mut passed = 0;
    for seed in 0..12 {
        let scenario = wild(seed, [Coupling::TwoWay, Coupling::Discs, Coupling::Decoupled][seed as usize / 2 % 3]);
        let mut before: Vec<Vec2> = scenario.agents.iter().map(|agent| agent.position_m).collect();
        walk(&scenario, 30.0, &mut |simulation| {
            let after: Vec<Vec2> = simulation.frames().iter().map(|frame| frame.root.position_m).collect();
            for (from_m, to_m) in before.iter().zip(&after).filter(|(from_m, to_m)| from_m.x * to_m.x < 0.0) {
                passed += 1;
                let closed = simulation.population().closed_doors(simulation.steps);
                let is_free = |(door, is_closed): (&DoorSpec, &bool)| {
                    let sides_m = [door.polygon_m[0].y, door.polygon_m[2].y];
                    !is_closed && [from_m.y, to_m.y].iter().all(|y_m| (sides_m[0]..sides_m[1]).contains(y_m))
                };
                assert!(scenario.doors.iter().zip(&closed).any(is_free), "seed {seed}: {from_m} to {to_m}");
            }
            before = after;
        });
    }
    assert!(passed > 60, "{passed}");
}

#[test]
fn doors_close_on_no_agent() {
    for seed in 20..26 {
        let scenario = wild(seed, Coupling::Discs);
        let mut closings = 0;
        let mut before: Vec<Vec2> = Vec::new();
        walk(&scenario, 30.0, &mut |simulation| {
            let (population, frame) = (simulation.population(), simulation.steps);
            for (phases, door) in population.doors.iter().zip(&scenario.doors) {
                if phases.changes.contains(&frame) && phases.is_closed(frame) && frame > 1 {
                    closings += 1;
                    let leaf = crate::world::obstacles::Obstacles::new(std::slice::from_ref(&door.polygon_m));
                    assert!(before.iter().all(|at_m| leaf.depth_m(*at_m, 0.2) == 0.0), "seed {seed}, frame {frame}");
                }
            }
            before = simulation.frames().iter().map(|frame| frame.root.position_m).collect();
        });
        assert!(closings > 2);
    }
}

#[test]
fn agents_wait_calmly_and_all_arrive_after_the_door_opens() {
    let scenario = rooms(&[([-0.6, 0.6], opens_at(20.0))], agents(12));
    let mut walked_m = 0.0;
    let mut before: Vec<Vec2> = scenario.agents.iter().map(|agent| agent.position_m).collect();
    let simulation = walk(&scenario, 60.0, &mut |simulation| {
        let after: Vec<Vec2> = simulation.frames().iter().map(|frame| frame.root.position_m).collect();
        if (450..595).contains(&simulation.steps) {
            walked_m += before.iter().zip(&after).map(|(from_m, to_m)| from_m.distance(*to_m)).sum::<f32>();
            // Twelve agents with room between them stand up to 3.5 m deep.
            let near = after.iter().filter(|at_m| at_m.distance(Vec2::ZERO) < 3.5).count();
            assert!(after.iter().all(|at_m| at_m.x < TOUCH_M - 0.2 - HALF_WALL_M) && near > 10, "{after:?}");
        }
        before = after;
    });
    // 12 agents in 4.8 s.
    assert!(walked_m < 1.0, "{walked_m} m");
    assert_eq!(arrived(&simulation), 12);
}

#[test]
fn a_runner_brakes_evenly_before_a_closed_door() {
    let runner = AgentSpec {
        position_m: Vec2::new(-7.5, 0.0),
        goals_m: vec![Vec2::new(6.0, 0.0)],
        preferred_speed_mps: 2.5,
        ..AgentSpec::default()
    };
    let scenario = rooms(&[([-0.6, 0.6], opens_at(1e4))], vec![runner]);
    let (mut before_mps, mut greatest_drop_mps) = (0.0_f32, 0.0_f32);
    let simulation = walk(&scenario, 12.0, &mut |simulation| {
        let preferred_mps = simulation.agents.preferred_mps[0].length();
        if preferred_mps > 0.0 {
            greatest_drop_mps = greatest_drop_mps.max(before_mps - preferred_mps);
        }
        before_mps = preferred_mps;
    });
    let at_m = simulation.agents.positions_m[0];
    assert!(before_mps == 0.0 && (-1.3..-0.6).contains(&at_m.x), "{at_m}, {before_mps} m/s");
    assert!(greatest_drop_mps < 0.2, "{greatest_drop_mps} m/s in a step");
}

#[test]
fn a_crowd_that_streams_through_stops_at_red() {
    let signal = Signal { name: "gate".into(), green_s: 6.0, red_s: 1e4, offset_s: 4.0 };
    // Of many more agents one may be shut in beside the door, by others that stand and wait, and hold it open.
    let simulation = walk(&rooms(&[([-0.6, 0.6], signal)], agents(18)), 20.0, &mut |_| {});
    let passed = simulation.frames().iter().filter(|frame| frame.root.position_m.x > 0.0).count();
    assert!((3..15).contains(&passed), "{passed}");
    let changes = &simulation.population().doors[0].changes;
    // Green at 4 s, red at 10 s; the agents in the door need a moment.
    assert!(changes[0] == 121 && (301..480).contains(&changes[1]), "{changes:?}");
}

#[test]
fn agents_take_the_other_door_while_one_is_closed() {
    let doors = [([-0.6, 0.6], opens_at(1e4)), ([2.4, 3.6], opens_at(0.0))];
    let simulation = walk(&rooms(&doors, agents(6)), 30.0, &mut |_| {});
    assert_eq!(arrived(&simulation), 6);
    assert_eq!(simulation.population().closed_doors(900), [true, false]);
}

#[test]
fn a_source_has_no_room_in_a_closed_door() {
    let source = SourceSpec {
        to_s: 12.0,
        count: Some(1),
        goals_m: vec![Vec2::new(6.0, 0.0)],
        preferred_speed_mps: 1.3,
        ..SourceSpec::default()
    };
    let scenario = Scenario { sources: vec![source], ..rooms(&[([-0.6, 0.6], opens_at(10.0))], Vec::new()) };
    let simulation = walk(&scenario, 15.0, &mut |_| {});
    assert!(simulation.population().agents[0].born > 300, "{:?}", simulation.population().sources);
    assert!(simulation.population().sources[0].blocked_frames > 100);
}

/// Final x of an agent that starts at the origin and chooses among exits in a hall with a door at x = 3.
fn exit_taken_m(signal: &str, exits: &str) -> f32 {
    let text = format!(
        "duration_s = 30
        walkable = [{{ polygon_m = [[-8, -2], [8, -2], [8, 2], [-8, 2]] }}]
        [signals.gate]
        {signal}
        [[obstacles]]
        polygon_m = [[3, -2], [3.2, -2], [3.2, 2], [3, 2]]
        open = 'gate'
        [goals.exits]
        areas = {exits}
        [states.walk]
        go = 'exits'
        [[agents]]
        at_m = [0, 0]
        state = 'walk'"
    );
    let (scenario, _) = parse(&SourceText { path: PathBuf::from("hall.toml"), text }).unwrap();
    walk(&scenario, 30.0, &mut |_| {}).frames()[0].root.position_m.x
}

#[test]
fn goals_behind_closed_doors_are_the_last_choice() {
    let [opens_late, never] = ["green_s = 100\nred_s = 9\noffset_s = 9", "green_s = 1\nred_s = 900\noffset_s = 900"];
    let [east, west] = ["{ rect_m = [5, -1, 6, 1] }", "{ rect_m = [-7, -1, -6, 1] }"];
    let both = format!("[{east}, {west}]");
    assert!(exit_taken_m("green_s = 100\nred_s = 9", &both) > 4.5);
    assert!(exit_taken_m(opens_late, &both) < -5.5);
    assert!(exit_taken_m(opens_late, &format!("[{east}]")) > 4.5);
    let waits_m = exit_taken_m(never, &format!("[{east}]"));
    assert!((2.0..2.6).contains(&waits_m), "{waits_m}");
}

#[test]
fn threads_change_nothing() {
    let scenario = Scenario { agents: agents(24), ..wild(5, Coupling::TwoWay) };
    let pool = |threads| rayon::ThreadPoolBuilder::new().num_threads(threads).build().unwrap();
    let run = |threads| {
        pool(threads).install(|| {
            let simulation = walk(&scenario, 15.0, &mut |_| {});
            (simulation.frames().to_vec(), simulation.population().clone())
        })
    };
    let one = run(1);
    assert!(one == run(2) && one == run(4));
    assert!(one.1.doors.iter().any(|door| door.changes.len() > 2));
}

#[test]
fn an_event_opens_a_door() {
    const ALARM: &str = "duration_s = 20
        [signals.gate]
        green_s = 0
        red_s = 1
        [events.alarm]
        when = { after_s = 6 }
        signals = { gate = 'green' }
        [[obstacles]]
        polygon_m = [[0, -9], [0.2, -9], [0.2, -0.6], [0, -0.6]]
        [[obstacles]]
        polygon_m = [[0, 0.6], [0.2, 0.6], [0.2, 9], [0, 9]]
        [[obstacles]]
        polygon_m = [[0.05, -0.6], [0.15, -0.6], [0.15, 0.6], [0.05, 0.6]]
        open = 'gate'
        [[walkable]]
        polygon_m = [[-6, -5], [6, -5], [6, 5], [-6, 5]]
        [[agents]]
        grid = { columns = 2, rows = 2, spacing_m = 1, centre_m = [-3, 0] }
        goal_offset_m = [6, 0]
    ";
    let source = SourceText { path: PathBuf::from("alarm.toml"), text: ALARM.to_owned() };
    let scenario = parse(&source).unwrap().0;
    let mut simulation = Simulation::new(Arc::new(test_db()), &scenario);
    let mut passed_at_6_s = 0;
    for step in 1..=scenario.steps() {
        simulation.step(&mut |_| {});
        let passed = simulation.frames().iter().filter(|frame| frame.root.position_m.x > 0.2).count();
        if step == 180 {
            passed_at_6_s = passed;
        }
        assert!(step < scenario.steps() || passed == 4, "{passed} passed");
    }
    assert_eq!(passed_at_6_s, 0);
    // Lamps in pictures follow the event too.
    let is_green = |time_s| simulation.population().is_green(&scenario, 0, time_s);
    assert_eq!([0.0, 5.9, 6.1, 19.0].map(is_green), [false, false, true, true]);
}

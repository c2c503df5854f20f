//! Claims about the state machine: points that walk straight to their aims. World, metres, seconds.

use proptest::prelude::*;

use super::*;
use crate::behaviour::agent_state::Aim;
use crate::behaviour::agent_state::GoalRef;
use crate::behaviour::choice::Choice;
use crate::behaviour::condition::{Bound, Condition};
use crate::behaviour::distribution::Distribution;
use crate::behaviour::event::{Event, SignalOrder};
use crate::behaviour::goals::{GoalArea, GoalSet};
use crate::behaviour::signal::Signal;
use crate::behaviour::state::{Facing, Settings, State, Target, Transition};

const STEP_S: f64 = 0.1;

/// Points that walk straight to what they want.
struct Points {
    behaviour: Behaviour,
    crowd: CrowdBehaviour,
    positions_m: Vec<Vec2>,
    ids: Vec<AgentId>,
    steps: u32,
}

impl Points {
    fn new(behaviour: Behaviour, starts_m: Vec<Vec2>, state: u32) -> Self {
        let mut crowd = CrowdBehaviour::new(&behaviour);
        let traits = Traits { preferred_speed_mps: 1.0, radius_m: 0.25 };
        starts_m.iter().for_each(|&start_m| crowd.add(state, traits, start_m));
        let ids = (0..starts_m.len()).map(AgentId::from).collect();
        Self { behaviour, crowd, positions_m: starts_m, ids, steps: 0 }
    }

    fn time_s(&self) -> f64 {
        f64::from(self.steps) * STEP_S
    }

    fn step(&mut self) {
        let goals = &self.behaviour.goals;
        let route_m = |_: (usize, u32), from_m: Vec2, goal: GoalRef| {
            Some(goals[goal.set as usize].areas[goal.area as usize].area.distance_m(from_m))
        };
        let view = CrowdView {
            time_s: f64::from(self.steps) * STEP_S,
            seed: 1,
            ids: &self.ids,
            positions_m: &self.positions_m,
            leads: &[],
            route_m: &route_m,
            open_route_m: None,
            path_end_m: &|_| None,
            has_come_to_goal: &|_| false,
            is_clear: &|_, _| true,
            has_begun: &|_| true,
        };
        self.crowd.decide(&self.behaviour, &view);
        for (position_m, agent) in self.positions_m.iter_mut().zip(&self.crowd.agents) {
            let towards = |to_m: Vec2| (to_m - *position_m).clamp_length_max(agent.traits.preferred_speed_mps * 0.1);
            *position_m += match agent.aim {
                Aim::Goal { position_m: to_m, .. } | Aim::Position(to_m) => towards(to_m),
                Aim::Velocity(velocity_mps) => velocity_mps * 0.1,
                Aim::OwnPath | Aim::Stay { .. } | Aim::Leave { .. } => Vec2::ZERO,
            };
        }
        for (id, position_m) in &self.crowd.teleports {
            self.positions_m[id.index()] = *position_m;
        }
        self.steps += 1;
        self.check_occupancy();
    }

    fn run(&mut self, time_s: f64) {
        while self.time_s() < time_s {
            self.step();
        }
    }

    /// Every area holds as many agents as have it for a goal, and no more than it has room for.
    fn check_occupancy(&self) {
        let mut expected: Vec<Vec<u32>> = self.behaviour.goals.iter().map(|set| vec![0; set.areas.len()]).collect();
        for agent in &self.crowd.agents {
            let goals = agent.goal.iter().filter(|goal| goal.is_taken).map(|goal| goal.at);
            let remembered = agent.remembered.iter().map(|(_, goal)| goal.at);
            let mut held: Vec<GoalRef> = goals.chain(remembered).collect();
            held.sort_by_key(|goal| (goal.set, goal.area));
            held.dedup();
            held.iter().for_each(|goal| expected[goal.set as usize][goal.area as usize] += 1);
        }
        for (set, (goals, expected)) in self.behaviour.goals.iter().zip(&expected).enumerate() {
            assert_eq!(self.crowd.occupancy.of_set(set), expected, "{}", goals.name);
            let has_room = expected.iter().enumerate().all(|(area, &taken)| taken <= goals.capacity(area));
            assert!(has_room, "{}: {expected:?}", goals.name);
        }
    }

    fn states(&self) -> Vec<&str> {
        self.crowd.agents.iter().map(|agent| self.behaviour.states[agent.state as usize].name.as_str()).collect()
    }
}

fn go(name: &str, set: usize, choice: Choice, transitions: Vec<Transition>) -> State {
    let movement = Movement::Goals { set, choice, memory: None };
    State { name: name.into(), movement, settings: Settings::default(), transitions }
}

fn stand(name: &str, transitions: Vec<Transition>) -> State {
    let movement = Movement::Stand { facing: Facing::OfGoal };
    State { name: name.into(), movement, settings: Settings::default(), transitions }
}

fn when(condition: Condition, states: &[u32]) -> Transition {
    Transition { condition, target: Target::States(states.iter().map(|&state| (state, 1.0)).collect()) }
}

fn after(time_s: f32) -> Condition {
    Condition::After(Distribution::Constant(time_s))
}

/// A row of places, a metre apart.
fn places(count: usize, capacity: Option<u32>, queue: bool) -> GoalSet {
    let place = |index: usize| GoalArea {
        area: Area::Disc { centre_m: Vec2::new(10.0 - index as f32, 0.0), radius_m: 0.3 },
        facing_rad: Some(0.5),
        capacity,
        weight: 1.0,
    };
    GoalSet { name: "places".into(), areas: (0..count).map(place).collect(), queue }
}

fn row(count: usize) -> Vec<Vec2> {
    (0..count).map(|index| Vec2::new(-0.5 * index as f32, 0.4)).collect()
}

#[test]
fn a_visit_goes_through_its_states() {
    let states = vec![
        go("walk", 0, Choice::Nearest, vec![when(Condition::Reached(0.0), &[1])]),
        stand("look", vec![when(after(2.0), &[2])]),
        State { movement: Movement::Leave { at_once: false }, ..stand("gone", vec![]) },
    ];
    let mut points =
        Points::new(Behaviour { states, goals: vec![places(1, None, false)], ..<_>::default() }, row(1), 0);
    points.run(9.0);
    assert_eq!(points.states(), ["walk"]);
    points.run(11.0);
    assert_eq!(points.states(), ["look"]);
    let agent = &points.crowd.agents[0];
    assert!(matches!(agent.aim, Aim::Goal { facing_rad: Some(0.5), .. }), "{:?}", agent.aim);
    points.run(12.5);
    assert_eq!((points.states(), points.crowd.agents[0].aim), (vec!["gone"], Aim::Leave { at_once: false }));
    assert_eq!(points.crowd.occupancy.of_set(0), [0]);
}

#[test]
fn agents_without_a_free_goal_wait_for_one() {
    let states = vec![
        go("walk", 0, Choice::Nearest, vec![when(Condition::Reached(0.0), &[1])]),
        stand("look", vec![when(after(3.0), &[2])]),
        State { movement: Movement::Walk { velocity_mps: Vec2::Y }, ..stand("off", vec![]) },
    ];
    let behaviour = Behaviour { states, goals: vec![places(2, Some(1), false)], ..Behaviour::default() };
    let mut points = Points::new(behaviour, row(3), 0);
    points.step();
    assert_eq!(points.crowd.waiting, [1]);
    assert_eq!(points.crowd.agents[2].aim, Aim::Stay { facing_rad: None });
    points.run(60.0);
    assert_eq!((points.states(), &*points.crowd.waiting), (vec!["off"; 3], &[0][..]));
}

#[test]
fn a_queue_serves_in_order_of_arrival() {
    let states = vec![
        go("line", 0, Choice::Nearest, vec![when(Condition::Served(Distribution::Constant(2.0)), &[1])]),
        State { movement: Movement::Walk { velocity_mps: Vec2::Y }, ..stand("served", vec![]) },
    ];
    let behaviour = Behaviour { states, goals: vec![places(4, None, true)], ..Behaviour::default() };
    // The later an agent's id, the nearer it starts.
    let starts_m = row(4).into_iter().rev().collect();
    let mut points = Points::new(behaviour, starts_m, 0);
    let mut served = Vec::new();
    while points.time_s() < 60.0 {
        points.step();
        for (index, state) in points.states().into_iter().enumerate() {
            if state == "served" && !served.contains(&index) {
                served.push(index);
                let since_s = points.time_s();
                assert!(since_s >= 2.0 * served.len() as f64, "{since_s} s");
            }
        }
    }
    assert_eq!(served, [3, 2, 1, 0]);
}

#[test]
fn a_full_queue_serves_everyone() {
    let states = vec![
        go("line", 0, Choice::Nearest, vec![when(Condition::Served(Distribution::Constant(0.5)), &[1])]),
        State { movement: Movement::Leave { at_once: false }, ..stand("served", vec![]) },
    ];
    let behaviour = Behaviour { states, goals: vec![places(2, None, true)], ..Behaviour::default() };
    let mut points = Points::new(behaviour, row(9), 0);
    points.step();
    assert_eq!(points.crowd.waiting, [0]);
    points.run(40.0);
    assert_eq!(points.states(), ["served"; 9]);
}

#[test]
fn a_remembered_goal_is_kept_and_taken_again() {
    let memory = Movement::Goals { set: 0, choice: Choice::Random, memory: Some(0) };
    let states = vec![
        State { movement: memory, ..stand("home", vec![when(Condition::Reached(0.0), &[1])]) },
        State { movement: Movement::Offset { by_m: Vec2::Y }, ..stand("away", vec![when(after(12.0), &[0])]) },
    ];
    let behaviour = Behaviour { states, goals: vec![places(3, Some(1), false)], ..Behaviour::default() };
    let mut points = Points::new(behaviour, row(3), 0);
    points.step();
    let chosen: Vec<GoalRef> = points.crowd.agents.iter().map(|agent| agent.goal.unwrap().at).collect();
    for _ in 0..900 {
        points.step();
        for (agent, &chosen) in points.crowd.agents.iter().zip(&chosen) {
            assert!(agent.goal.is_none_or(|goal| goal.at == chosen));
        }
        assert_eq!(points.crowd.occupancy.of_set(0), [1, 1, 1]);
    }
    assert!(points.crowd.agents.iter().all(|agent| agent.entries > 4));
}

#[test]
fn settings_end_with_their_state_or_remain() {
    let hurry = |remain| Settings { speed_factor: Some(Distribution::Constant(2.0)), remain, ..Settings::default() };
    let states = vec![
        State { settings: hurry(false), ..stand("hurry", vec![when(after(1.0), &[1])]) },
        State { settings: hurry(true), ..stand("stay quick", vec![when(after(1.0), &[2])]) },
        stand("end", vec![]),
    ];
    let mut points = Points::new(Behaviour { states, ..Behaviour::default() }, row(1), 0);
    let mut speeds = Vec::new();
    for _ in 0..25 {
        points.step();
        speeds.push(points.crowd.agents[0].traits.preferred_speed_mps);
    }
    assert!(speeds.iter().all(|&speed_mps| speed_mps == 2.0), "{speeds:?}");
    points.behaviour.states[1].settings.remain = false;
    let mut points = Points::new(points.behaviour, row(1), 0);
    points.run(2.5);
    assert_eq!(points.crowd.agents[0].traits.preferred_speed_mps, 1.0);
}

#[test]
fn speed_factors_that_remain_have_a_bound() {
    let settings = Settings { speed_factor: Some(Distribution::Constant(9.0)), remain: true, ..Settings::default() };
    let states = vec![State { settings, ..stand("hurry", vec![when(after(0.1), &[0])]) }];
    let mut points = Points::new(Behaviour { states, ..Behaviour::default() }, row(1), 0);
    points.run(9.0);
    assert_eq!(points.crowd.agents[0].traits.preferred_speed_mps, 10.0);
}

#[test]
fn signals_and_numbers_let_agents_go() {
    let bound = Bound { at_least: 0, at_most: 2 };
    let cross = Condition::All(vec![Condition::Green(0), Condition::Number(0, bound)]);
    let states = vec![
        stand("wait", vec![when(cross, &[1])]),
        State { movement: Movement::Walk { velocity_mps: Vec2::X }, ..stand("cross", vec![]) },
    ];
    let signals = vec![Signal { name: "light".into(), green_s: 5.0, red_s: 5.0, offset_s: 3.0 }];
    // All three stand in the area, so it is never free enough.
    let areas = vec![Area::Disc { centre_m: Vec2::ZERO, radius_m: 3.0 }];
    let behaviour = Behaviour { states, signals, areas, ..Behaviour::default() };
    let mut three = Points::new(behaviour.clone(), row(3), 0);
    three.run(20.0);
    assert_eq!(three.states(), ["wait"; 3]);
    let mut two = Points::new(behaviour, row(2), 0);
    two.run(3.0);
    assert_eq!(two.states(), ["wait"; 2]);
    two.run(3.2);
    assert_eq!(two.states(), ["cross"; 2]);
}

#[test]
fn positions_in_an_area_are_apart() {
    let mut apart_m: Vec<f32> = Vec::new();
    for shift in 0..20 {
        let area = Area::rectangle(Vec2::new(10.0, shift as f32), Vec2::new(12.0, 2.0 + shift as f32));
        let area = GoalArea { area, facing_rad: None, capacity: None, weight: 1.0 };
        let goals = vec![GoalSet { name: "booth".into(), areas: vec![area], queue: false }];
        let states = vec![go("go", 0, Choice::Nearest, vec![])];
        let mut points = Points::new(Behaviour { states, goals, ..Behaviour::default() }, row(5), 0);
        points.step();
        let held_m: Vec<Vec2> = points.crowd.agents.iter().filter_map(|agent| agent.aim.position_m()).collect();
        let pairs =
            held_m.iter().enumerate().flat_map(|(index, a)| held_m[..index].iter().map(move |b| a.distance(*b)));
        apart_m.push(pairs.fold(f32::INFINITY, f32::min));
    }
    // Five agents have 4 m²: drawn anywhere, every second booth has two within 0.4 m of each other.
    assert!(apart_m.iter().all(|&apart_m| apart_m > 0.45), "{apart_m:?}");
}

#[test]
fn a_teleport_moves_the_agent_at_once() {
    let settings = Settings { teleport: Some(Area::point(Vec2::new(5.0, 5.0))), ..Settings::default() };
    let states = vec![stand("here", vec![when(after(1.0), &[1])]), State { settings, ..stand("there", vec![]) }];
    let mut points = Points::new(Behaviour { states, ..Behaviour::default() }, row(1), 0);
    points.run(1.2);
    assert_eq!(points.positions_m, [Vec2::new(5.0, 5.0)]);
}

#[test]
fn a_teleported_agent_leaves_the_area_at_once() {
    // As in a periodic corridor: the state after the teleport asks for the area that the agent has just left.
    let settings = Settings { teleport: Some(Area::point(Vec2::new(5.0, 5.0))), ..Settings::default() };
    let jump = State { settings, ..stand("jump", vec![when(Condition::Always, &[0])]) };
    let states = vec![stand("wait", vec![when(Condition::Inside(0), &[1])]), jump];
    let areas = vec![Area::Disc { centre_m: Vec2::ZERO, radius_m: 1.0 }];
    let mut points = Points::new(Behaviour { states, areas, ..Behaviour::default() }, row(1), 0);
    points.run(0.3);
    assert_eq!(points.crowd.endless, None);
    assert_eq!((points.states()[0], points.positions_m[0]), ("wait", Vec2::new(5.0, 5.0)));
}

#[test]
fn an_event_moves_agents_of_its_states_once() {
    let signals = vec![Signal { name: "door".into(), green_s: 0.0, red_s: 1.0, offset_s: 0.0 }];
    let states = vec![
        stand("sit", vec![when(Condition::Green(0), &[2])]),
        stand("flee", vec![when(after(1.0), &[0])]),
        stand("out", vec![]),
    ];
    let event = |condition, to, signals| Event { name: "event".into(), condition, from: Some(vec![0]), to, signals };
    let events = vec![
        event(after(1.0), Some(1), vec![]),
        event(Condition::Population(1, Bound { at_least: 0, at_most: 0 }), None, vec![]),
        event(after(3.0), None, vec![(0, SignalOrder::Green)]),
    ];
    let mut two = Points::new(Behaviour { states, signals, events, ..Behaviour::default() }, row(2), 0);
    two.run(0.95);
    assert_eq!(two.states(), ["sit"; 2]);
    two.run(1.15);
    assert_eq!(two.states(), ["flee"; 2]);
    two.run(2.5);
    assert_eq!(two.states(), ["sit"; 2], "the event happens once");
    two.run(3.15);
    assert_eq!(two.states(), ["out"; 2]);
}

#[test]
fn transitions_without_end_are_stopped_and_named() {
    let states = vec![
        stand("wait", vec![when(after(1.0), &[1])]),
        stand("a", vec![when(Condition::Always, &[2])]),
        stand("b", vec![when(Condition::Always, &[1])]),
    ];
    let mut points = Points::new(Behaviour { states, ..Behaviour::default() }, row(2), 0);
    points.run(0.95);
    assert_eq!(points.crowd.endless, None);
    points.run(2.0);
    assert_eq!(points.crowd.endless, Some(EndlessTransitions { agent: AgentId(0), time_s: 1.0, states: vec![1, 2] }));
}

#[test]
fn states_may_be_entered_twice_in_a_step() {
    let mut states = vec![stand("a", vec![when(Condition::Always, &[0, 1])]), stand("b", vec![])];
    states[0].transitions[0].target = Target::States(vec![(0, 1.0), (1, 1.0)]);
    let mut points = Points::new(Behaviour { states, ..Behaviour::default() }, row(40), 0);
    points.step();
    assert_eq!((points.states(), &points.crowd.endless), (vec!["b"; 40], &None));
    assert!(points.crowd.agents.iter().any(|agent| agent.entries > 3));
}

fn any_condition() -> impl Strategy<Value = Condition> {
    let leaf = prop_oneof![
        (0.0f32..4.0).prop_map(after),
        (0.0f32..1.0).prop_map(Condition::Reached),
        (0.0f32..2.0).prop_map(|time_s| Condition::Served(Distribution::Uniform { from: 0.0, to: time_s })),
        Just(Condition::Green(0)),
        Just(Condition::Inside(0)),
        (0u32..5).prop_map(|at_most| Condition::Population(0, Bound { at_least: 0, at_most })),
        (0u32..5).prop_map(|at_most| Condition::Number(0, Bound { at_least: 0, at_most })),
    ];
    leaf.prop_recursive(2, 6, 3, |inner| {
        prop_oneof![
            proptest::collection::vec(inner.clone(), 1..3).prop_map(Condition::All),
            proptest::collection::vec(inner.clone(), 1..3).prop_map(Condition::Any),
            inner.prop_map(|part| Condition::Not(Box::new(part))),
        ]
    })
}

fn any_movement() -> impl Strategy<Value = Movement> {
    let choice = prop_oneof![
        Just(Choice::Nearest),
        Just(Choice::Farthest),
        Just(Choice::Random),
        Just(Choice::Weighted),
        Just(Choice::NearestOf(2)),
        Just(Choice::LeastBusy)
    ];
    prop_oneof![
        (0usize..2, choice, proptest::option::of(0u32..2)).prop_map(|(set, choice, memory)| Movement::Goals {
            set,
            choice,
            memory
        }),
        Just(Movement::Stand { facing: Facing::OfGoal }),
        Just(Movement::Walk { velocity_mps: Vec2::new(0.3, -0.2) }),
        Just(Movement::Mirrored { centre_m: Vec2::new(5.0, 0.0) }),
    ]
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(300))]

    #[test]
    fn wild_machines_lose_no_goal_and_no_agent(
        states in proptest::collection::vec(
            (any_movement(), proptest::collection::vec((any_condition(), 0u32..4), 0..4)), 4,
        ),
        removed in 0usize..6,
    ) {
        let state = |(movement, transitions): (Movement, Vec<(Condition, u32)>)| State {
            movement,
            ..stand("any", transitions.into_iter().map(|(condition, to)| when(condition, &[to])).collect())
        };
        let behaviour = Behaviour {
            states: states.into_iter().map(state).collect(),
            goals: vec![places(3, Some(2), false), places(4, None, true)],
            signals: vec![Signal { name: "light".into(), green_s: 2.0, red_s: 1.0, offset_s: 0.0 }],
            areas: vec![Area::Disc { centre_m: Vec2::new(8.0, 0.0), radius_m: 2.0 }],
            events: Vec::new(),
        };
        let mut points = Points::new(behaviour, row(6), 0);
        points.run(15.0);
        let kept: Vec<bool> = (0..6).map(|index| index != removed).collect();
        points.crowd.retain(&kept);
        points.positions_m.remove(removed);
        points.ids.remove(removed);
        points.run(30.0);
        points.crowd.retain(&[false; 5]);
        points.check_occupancy();
        prop_assert!(points.crowd.agents.is_empty());
    }
}

//! Claims about agents that come and go.

use std::sync::Arc;

use glam::Vec2;
use proptest::prelude::*;

use crate::agents::Removal;
use crate::behaviour::Area;
use crate::maths::random::SplitMix64;
use crate::planning::plan::PLANTED_CONTACT;
use crate::population::{AgentId, SourceCount};
use crate::recording::frame::AgentFrame;
use crate::scenario::coupling::Coupling;
use crate::scenario::{AgentSpec, AtGoal, Scenario, SourceSpec, ZoneSpec};
use crate::simulation::Simulation;
use crate::simulation::tests::antipodal;
use crate::test_db::test_db;

/// An agent that walks 20 m along x from a position.
fn walker(x: f32, y: f32) -> AgentSpec {
    let position_m = Vec2::new(x, y);
    AgentSpec { position_m, goals_m: vec![position_m + Vec2::new(20.0, 0.0)], ..AgentSpec::default() }
}

/// A source whose agents walk `ahead_m` along x and leave.
fn source(low_m: Vec2, high_m: Vec2, rate_per_s: f32, ahead_m: f32) -> SourceSpec {
    SourceSpec {
        low_m,
        high_m,
        rate_per_s,
        to_s: 1_000.0,
        goal_offset_m: Some(Vec2::new(ahead_m, 0.0)),
        at_goal: AtGoal::Leave,
        ..SourceSpec::default()
    }
}

fn started(scenario: &Scenario) -> Simulation {
    Simulation::new(Arc::new(test_db()), scenario)
}

fn steps(simulation: &mut Simulation, count: usize) {
    (0..count).for_each(|_| simulation.step(&mut |_| {}));
}

fn ids(simulation: &Simulation) -> Vec<u32> {
    simulation.frames().iter().map(|agent| agent.id.0).collect()
}

/// Two sources that face each other, beside walls.
fn busy() -> Scenario {
    let mut back = source(Vec2::new(8.0, -1.5), Vec2::new(8.0, 1.5), 2.0, -12.0);
    back.at_goal = AtGoal::LeaveAtOnce;
    let wall = |y: f32| [(-6.0, y), (10.0, y), (10.0, y + 0.3), (-6.0, y + 0.3)].map(Vec2::from).to_vec();
    Scenario {
        sources: vec![source(Vec2::new(-4.0, -1.5), Vec2::new(-3.0, 1.5), 2.0, 12.0), back],
        obstacles_m: vec![wall(-2.3), wall(2.0)],
        ..antipodal(3, 1.5)
    }
}

#[test]
fn one_and_two_threads_give_equal_bits_with_sources() {
    let pool = |threads| rayon::ThreadPoolBuilder::new().num_threads(threads).build().unwrap();
    let both = [pool(1), pool(2)];
    let mut simulations = [0, 1].map(|_| started(&busy()));
    // Long enough for more than five agents to be removed.
    for step in 0..500 {
        for (simulation, pool) in simulations.iter_mut().zip(&both) {
            pool.install(|| simulation.step(&mut |_| {}));
        }
        assert!(simulations[0].frames() == simulations[1].frames(), "step {step}");
    }
    assert_eq!(simulations[0].population(), simulations[1].population());
    let removed = simulations[0].population().agents.iter().filter(|life| life.removed.is_some()).count();
    assert!(removed > 5 && simulations[0].frames().len() > 10, "{removed} removed");
}

#[test]
fn agents_far_away_change_no_bit_of_others() {
    // The others' arrays close up and grow, and keep their order.
    let scenario = antipodal(8, 3.0);
    let (mut alone, mut busy) = (started(&scenario), started(&scenario));
    let mut visitors = Vec::new();
    for step in 0..200 {
        if step % 7 == 0 {
            visitors.extend(busy.add(walker(500.0, step as f32)));
        }
        if step % 11 == 0 {
            visitors.pop().into_iter().for_each(|id| assert!(busy.remove(id, Removal::AtOnce)));
        }
        steps(&mut alone, 1);
        steps(&mut busy, 1);
        assert_eq!(alone.frames(), &busy.frames()[..8], "step {step}");
    }
}

#[test]
fn a_new_agent_stands_at_its_start_and_walks() {
    let mut simulation = started(&antipodal(2, 3.0));
    steps(&mut simulation, 10);
    let id = simulation.add(walker(20.0, 1.0)).unwrap();
    assert_eq!((id, ids(&simulation)), (AgentId(2), vec![0, 1, 2]));
    let born = simulation.frames()[2];
    assert_eq!((born.root.position_m, born.contacts), (Vec2::new(20.0, 1.0), [1.0; 2]));
    assert_eq!(simulation.population().agents[2].born, 10);
    steps(&mut simulation, 60);
    assert!(simulation.frames()[2].root.position_m.x > 21.0);
}

#[test]
fn agents_without_room_are_not_added() {
    let mut scenario = antipodal(2, 3.0);
    scenario.obstacles_m = vec![[(9.0, -1.0), (10.0, -1.0), (10.0, 1.0), (9.0, 1.0)].map(Vec2::from).to_vec()];
    let mut simulation = started(&scenario);
    assert_eq!(simulation.add(walker(3.0, 0.49)), None);
    assert_eq!([simulation.add(walker(9.5, 0.0)), simulation.add(walker(8.9, 0.0))], [None; 2]);
    assert_eq!(simulation.add(AgentSpec { radius_m: f32::NAN, ..walker(30.0, 0.0) }), None);
    assert_eq!(simulation.add(AgentSpec { goals_m: Vec::new(), ..walker(30.0, 0.0) }), None);
    assert_eq!(ids(&simulation), [0, 1]);
    assert_eq!(simulation.add(walker(3.0, 0.5)), Some(AgentId(2)));
    assert_eq!(simulation.add(walker(8.8, 0.0)), Some(AgentId(3)));
}

#[test]
fn agents_are_removed_between_two_steps_of_their_feet() {
    let is_planted = |agent: &AgentFrame| agent.contacts.map(|contact| contact >= PLANTED_CONTACT);
    for request_step in 60..90 {
        let mut simulation = started(&Scenario::of(vec![walker(0.0, 0.0)]));
        steps(&mut simulation, request_step);
        let id = AgentId(0);
        assert!(simulation.remove(id, Removal::BetweenSteps));
        let (mut before, mut waited) = (None, 0);
        // The last frame with the agent, and the one before it.
        while let [agent] = simulation.frames() {
            let last = (before, *agent);
            before = Some(*agent);
            steps(&mut simulation, 1);
            waited += 1;
            if simulation.frames().is_empty() && waited > 1 {
                let [was, is] = [last.0.as_ref().map(is_planted).unwrap(), is_planted(&last.1)];
                let has_landed = (0..2).any(|side| is[side] && !was[side]);
                assert!(is == [true; 2] || has_landed, "{was:?} {is:?}");
            }
        }
        assert!(waited < 30, "{waited} steps");
        let removed = simulation.population().agents[0].removed;
        assert_eq!(removed, Some((request_step + waited) as u32));
        assert!(!simulation.remove(id, Removal::AtOnce));
    }
}

#[test]
fn removal_at_once_ends_before_the_next_step() {
    for coupling in [Coupling::TwoWay, Coupling::Discs, Coupling::Decoupled] {
        let mut simulation = started(&Scenario { coupling, ..antipodal(3, 3.0) });
        steps(&mut simulation, 70);
        assert!(simulation.remove(AgentId(1), Removal::AtOnce) && simulation.remove(AgentId(1), Removal::BetweenSteps));
        assert_eq!(ids(&simulation), [0, 1, 2]);
        steps(&mut simulation, 1);
        assert_eq!((ids(&simulation), simulation.population().agents[1].removed), (vec![0, 2], Some(71)));
    }
}

#[test]
fn agents_leave_at_their_goals_at_full_speed() {
    for (at_goal, coupling) in [
        (AtGoal::Leave, Coupling::TwoWay),
        (AtGoal::LeaveAtOnce, Coupling::TwoWay),
        (AtGoal::Leave, Coupling::Discs),
        (AtGoal::Leave, Coupling::Decoupled),
    ] {
        let agent = AgentSpec { goals_m: vec![Vec2::new(4.0, 0.0)], at_goal, ..walker(0.0, 0.0) };
        let mut simulation = started(&Scenario { coupling, ..Scenario::of(vec![agent]) });
        let (mut before_m, mut last_m) = (Vec2::ZERO, Vec2::ZERO);
        while let [agent] = simulation.frames() {
            (before_m, last_m) = (last_m, agent.root.position_m);
            steps(&mut simulation, 1);
            assert!(simulation.steps < 300);
        }
        assert!(last_m.x > 3.5 && last_m.x < 4.6, "{at_goal:?} {coupling:?} {last_m}");
        assert!((last_m - before_m).length() * 30.0 > 1.1, "{at_goal:?} {coupling:?}");
    }
}

#[test]
fn a_blocked_source_waits_and_counts() {
    // An agent stands on the source for 100 steps; about two agents a second are due.
    let at_m = Vec2::new(0.0, 0.0);
    let stander = AgentSpec { goals_m: vec![at_m], ..walker(0.0, 0.0) };
    let scenario = Scenario { sources: vec![source(at_m, at_m, 2.0, 10.0)], ..Scenario::of(vec![stander]) };
    let first_s = scenario.sources[0].due_times(scenario.seed, 0).next().unwrap();
    let due_by =
        |now_s: f64| scenario.sources[0].due_times(scenario.seed, 0).take_while(|due_s| *due_s <= now_s).count() as u32;
    let mut simulation = started(&scenario);
    steps(&mut simulation, 100);
    let count = simulation.population().sources[0];
    let due = due_by(100.0 * f64::from(scenario.dt_s));
    let blocked_frames = 100 - (first_s / f64::from(scenario.dt_s)).ceil() as u32 + 1;
    assert_eq!(count, SourceCount { born: 0, waiting: due, blocked_frames });
    assert!(simulation.remove(AgentId(0), Removal::AtOnce));
    steps(&mut simulation, 400);
    let count = simulation.population().sources[0];
    assert_eq!(count.born + count.waiting, due_by(500.0 * f64::from(scenario.dt_s)));
    assert!(count.born > 5, "{count:?}");
}

#[test]
fn an_agent_of_zones_without_walls_is_not_added() {
    let area = Area::rectangle(Vec2::new(40.0, 40.0), Vec2::new(42.0, 42.0));
    let mut scenario = antipodal(4, 4.0);
    scenario.zones = vec![ZoneSpec { area, speed_factor: 1.0, is_closed: true, closed_in: vec![], one_way_deg: None }];
    let outsider = AgentSpec { closed_zones: 1, ..walker(0.0, 20.0) };
    assert_eq!(started(&scenario).add(outsider.clone()), None);
    scenario.agents[0].closed_zones = 1;
    assert!(started(&scenario).add(outsider).is_some());
}

#[test]
fn agents_of_an_area_appear_in_it_apart_from_walls() {
    let scenario = busy();
    let mut simulation = started(&scenario);
    for _ in 0..400 {
        let before = simulation.population().agents.len();
        steps(&mut simulation, 1);
        for life in &simulation.population().agents[before..] {
            let area = &scenario.sources[life.source.unwrap() as usize];
            let position_m = life.spec.position_m;
            assert!(position_m.cmpge(area.low_m).all() && position_m.cmple(area.high_m).all(), "{position_m}");
            assert!(simulation.obstacles.depth_m(position_m, life.spec.wall_radius_m) < 1e-3);
        }
    }
    assert!(simulation.population().agents.len() > 20);
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 12, failure_persistence: None, ..ProptestConfig::default() })]

    /// A list of ids is the model: births append, removals delete.
    #[test]
    fn no_id_is_used_twice_and_no_agent_is_lost(seed in any::<u64>()) {
        let mut random = SplitMix64::new(seed, 0);
        let scenario = Scenario { coupling: Coupling::Discs, ..antipodal(5, 4.0) };
        let mut simulation = started(&scenario);
        let (mut model, mut next, mut leaving): (Vec<u32>, u32, Vec<u32>) = ((0..5).collect(), 5, Vec::new());
        for step in 0..120_u32 {
            for _ in 0..random.next_u64() % 3 {
                let spec = walker(random.within(6.0) as f32, random.within(6.0) as f32);
                let is_free = simulation.frames().iter().all(|agent| {
                    agent.root.position_m.distance(spec.position_m) >= 0.5
                });
                let id = simulation.add(spec);
                prop_assert_eq!(id, is_free.then_some(AgentId(next)));
                if is_free {
                    model.push(next);
                    next += 1;
                }
            }
            for _ in 0..random.next_u64() % 3 {
                let id = (random.next_u64() % u64::from(next + 2)) as u32;
                let removal = if random.unit() < 0.5 { Removal::AtOnce } else { Removal::BetweenSteps };
                prop_assert_eq!(simulation.remove(AgentId(id), removal), model.contains(&id));
                leaving.push(id);
            }
            prop_assert_eq!(ids(&simulation), model.clone());
            steps(&mut simulation, 1);
            model.retain(|id| !leaving.contains(id));
            for id in leaving.drain(..).filter(|id| *id < next) {
                let life = &simulation.population().agents[id as usize];
                prop_assert!(life.removed.is_some_and(|removed| removed <= step + 1) && life.born <= step);
            }
            prop_assert_eq!(ids(&simulation), model.clone());
            prop_assert_eq!(simulation.population().agents.len(), next as usize);
        }
    }
}

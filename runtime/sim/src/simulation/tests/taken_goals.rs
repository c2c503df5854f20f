//! Claims about agents whose goals others have taken.

use super::*;
use crate::agents::Removal;
use crate::maths::random::SplitMix64;

/// Least distance between two agents that stand, m: their discs overlap by a tenth.
const APART_M: f32 = 0.45;

/// Agents at random positions around a goal that all share.
fn gathering(count: usize, seed: u64) -> Scenario {
    let mut random = SplitMix64::new(seed, 0);
    let mut agents: Vec<AgentSpec> = Vec::new();
    while agents.len() < count {
        let position_m = Vec2::new(random.within(8.0) as f32, random.within(8.0) as f32);
        if position_m.length() > 2.0 && agents.iter().all(|agent| agent.position_m.distance(position_m) > 0.8) {
            agents.push(AgentSpec { position_m, goals_m: vec![Vec2::ZERO], ..AgentSpec::default() });
        }
    }
    Scenario { duration_s: 25.0, ..Scenario::of(agents) }
}

#[test]
fn agents_with_one_goal_stand_around_it() {
    for (count, seed) in [(2, 1), (8, 2), (8, 3), (25, 4)] {
        let mut walked_m = 0.0;
        let simulation = run(&gathering(count, seed), |simulation, time_s| {
            if time_s > 20.0 {
                let speeds_mps = simulation.agents.velocities_mps.iter().map(|velocity_mps| velocity_mps.length());
                walked_m += simulation.scenario.dt_s * speeds_mps.sum::<f32>();
            }
        });
        assert!(walked_m < 0.02 * count as f32, "{count} agents walk {walked_m} m in 5 s");
        let at_m = &simulation.agents.positions_m;
        let radius_m = 0.5 * (count as f32).sqrt() + 0.8;
        assert!(at_m.iter().all(|at_m| at_m.length() < radius_m), "{at_m:?}");
        let mut pairs = (0..count).flat_map(|a| (0..a).map(move |b| (a, b)));
        assert!(pairs.all(|(a, b)| at_m[a].distance(at_m[b]) > APART_M), "{at_m:?}");
    }
}

#[test]
fn agents_move_up_when_one_goes() {
    let agent =
        |x_m: f32| AgentSpec { position_m: Vec2::new(x_m, 0.0), goals_m: vec![Vec2::ZERO], ..AgentSpec::default() };
    let mut simulation = started(&Scenario::of([-3.0, -6.0, -7.5].map(agent).to_vec()));
    for _ in 0..2 {
        (0..(12.0 / simulation.scenario.dt_s) as usize).for_each(|_| simulation.step(&mut |_| {}));
        let left_m: Vec<f32> = simulation.agents.positions_m.iter().map(|at_m| at_m.length()).collect();
        let nearest = (0..left_m.len()).min_by(|&a, &b| left_m[a].total_cmp(&left_m[b])).unwrap();
        assert!(left_m[nearest] < 0.3, "{left_m:?}");
        simulation.agents.removals[nearest] = Some(Removal::AtOnce);
    }
}

#[test]
fn an_agent_beyond_a_wall_goes_on_around_it() {
    let agents = [Vec2::new(0.0, 0.2), Vec2::new(0.0, -5.0)];
    let agents =
        agents.map(|position_m| AgentSpec { position_m, goals_m: vec![Vec2::new(0.0, 0.4)], ..AgentSpec::default() });
    let wall_m = [(-3.0, -0.1), (3.0, -0.1), (3.0, 0.0), (-3.0, 0.0)].map(Vec2::from).to_vec();
    let scenario = Scenario { obstacles_m: vec![wall_m], duration_s: 25.0, ..Scenario::of(agents.to_vec()) };
    let at_m = run(&scenario, |_, _| {}).agents.positions_m[1];
    assert!(at_m.y > 0.0 && at_m.distance(Vec2::new(0.0, 0.4)) < 1.0, "{at_m}");
}

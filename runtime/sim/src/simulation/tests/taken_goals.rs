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
fn agents_brake_before_they_stand_behind_others() {
    for seed in 5..8 {
        let (mut before_mps, mut halts, mut restarts) = (vec![Vec2::ZERO; 25], 0, 0);
        run(&gathering(25, seed), |simulation, _| {
            let preferred_mps = &simulation.agents.preferred_mps;
            let halted = |(before_mps, now_mps): (&Vec2, &Vec2)| *now_mps == Vec2::ZERO && before_mps.length() > 0.8;
            let set_out = |(before_mps, now_mps): (&Vec2, &Vec2)| halted((now_mps, before_mps));
            halts += before_mps.iter().zip(preferred_mps).filter(|pair| halted(*pair)).count();
            restarts += before_mps.iter().zip(preferred_mps).filter(|pair| set_out(*pair)).count();
            before_mps.clone_from(preferred_mps);
        });
        // All start once.
        assert!(halts < 5 && restarts < 25 + 5, "seed {seed}: {halts} halt from a walk, {restarts} start to walk");
    }
}

/// v_pref of agents with one goal after some steps, m/s.
fn preferred_mps(positions_m: &[Vec2]) -> Vec<Vec2> {
    let agent = |&position_m: &Vec2| AgentSpec { position_m, goals_m: vec![Vec2::ZERO], ..AgentSpec::default() };
    let mut simulation = started(&Scenario::of(positions_m.iter().map(agent).collect()));
    (0..4).for_each(|_| simulation.step(&mut |_| {}));
    simulation.agents.preferred_mps
}

#[test]
fn the_nearer_of_two_agents_goes_on_to_the_goal() {
    let [near_m, far_m] = [Vec2::new(-1.0, 0.0), 1.1 * Vec2::from_angle(std::f32::consts::FRAC_PI_3)];
    let alone_mps = preferred_mps(&[near_m])[0];
    let (first, last) = (preferred_mps(&[near_m, far_m]), preferred_mps(&[far_m, near_m]));
    for (near_mps, far_mps) in [(first[0], first[1]), (last[1], last[0])] {
        assert!(near_mps.distance(alone_mps) < 0.05, "{near_mps}, alone {alone_mps}");
        assert!(far_mps.length() < 0.6 * near_mps.length(), "{far_mps}");
    }
}

#[test]
fn agents_that_stand_around_a_goal_face_it() {
    let simulation = run(&gathering(12, 9), |_, _| {});
    let agents = &simulation.agents;
    for (index, progress) in agents.progress.iter().enumerate().filter(|(_, progress)| progress.stands_behind()) {
        let off_rad = wrap_rad((-agents.positions_m[index]).to_angle() - agents.facings_rad[index]);
        assert!(off_rad.abs() < 0.5, "agent {index} at {}: {off_rad} rad, {progress:?}", agents.positions_m[index]);
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
        // In steps of .1 s those that come behind push the first one on by a step, before they stand.
        assert!(left_m[nearest] < 0.5, "{left_m:?}");
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

//! Claims about what avoidance adds to the paper: queueing, slowing and pressing. Metres, m/s.

use glam::Vec2;

use crate::planning::mcn::tests::{Scene, WALK, alone, check_switch};

/// An agent that stands; the next one stands close ahead, goes in a direction, and steps back.
fn pushed_back(way: Vec2) -> Scene {
    let mut scene = Scene::new(&[[0.0, 0.0], [0.52, 0.0]]);
    scene.velocities_mps = vec![Vec2::ZERO, -0.3 * WALK];
    scene.preferred_mps[1] = way;
    scene
}

#[test]
fn an_agent_holds_its_place_in_a_queue_alone() {
    check_switch(&pushed_back(WALK), &pushed_back(WALK.perp()), |parts| parts.queueing = false);
    let [queues, meets] = [WALK, -WALK].map(|way| pushed_back(way).plan().velocity_mps.x);
    assert!(queues > 0.5 * meets && meets < -0.05, "{queues} {meets}");
}

/// An agent stands between two others; a third, ahead, overlaps it. The three prefer a velocity.
fn crowded(way: Vec2) -> Scene {
    let mut scene = Scene::new(&[[0.0, 0.0], [0.48, 0.0], [0.05, 0.5], [0.05, -0.5]]);
    scene.velocities_mps.fill(Vec2::ZERO);
    scene.preferred_mps[1..].fill(way);
    scene
}

#[test]
fn a_body_waits_in_a_queue_alone() {
    let plans = [WALK, -WALK, WALK.perp()].map(|way| crowded(way).plan());
    assert!(plans.iter().all(|plan| plan.velocity_mps.x < 0.0), "{plans:?}");
    assert_eq!(plans.map(|plan| plan.waits), [true, false, false]);
    // Chests do not overlap.
    let waits_at = |distance_m: f32| {
        let mut scene = crowded(WALK);
        scene.positions_m[1].x = distance_m;
        scene.plan().waits
    };
    assert!(waits_at(0.46) && !waits_at(0.43));
    // It yields to one that comes back at a walk.
    let mut walked_into = crowded(WALK);
    walked_into.velocities_mps[1] = -WALK;
    let plan = walked_into.plan();
    assert!(!plan.waits && plan.velocity_mps.x < -0.2, "{plan:?}");
}

#[test]
fn a_body_steps_back_sooner_in_an_arch() {
    // The agent ahead comes back slowly; one beside it prefers another direction.
    let mut scene = crowded(WALK);
    scene.velocities_mps[1] = -0.3 * WALK;
    let queues = scene.plan();
    scene.preferred_mps[2] = WALK.perp();
    let presses = scene.plan();
    assert!(queues.waits && !presses.waits, "{queues:?} {presses:?}");
    scene.params.planner.parts.pressing = false;
    assert!(scene.plan().waits);
}

#[test]
fn a_body_at_rest_does_not_step_aside() {
    // An agent that wants to stand; another comes towards it from a distance, m.
    let plan = |own_mps: Vec2, distance_m: f32| {
        let mut scene = Scene::new(&[[0.0, 0.0], [-distance_m, 0.1]]);
        // In longer steps a plan from rest is faster at once.
        scene.dt_s = 1.0 / 60.0;
        scene.velocities_mps = vec![own_mps, 0.3 * WALK];
        scene.preferred_mps[0] = Vec2::ZERO;
        scene.plan()
    };
    let [rests, overlaps, moves] = [(Vec2::ZERO, 0.75), (Vec2::ZERO, 0.45), (0.1 * WALK, 0.75)]
        .map(|(own_mps, distance_m)| plan(own_mps, distance_m));
    assert!(rests.velocity_mps != Vec2::ZERO && rests.waits, "{rests:?}");
    assert!(!overlaps.waits && !moves.waits, "{overlaps:?} {moves:?}");
}

/// An agent before its goal; the next one walks close behind, and prefers a velocity.
fn followed(preferred_mps: Vec2) -> Scene {
    let mut scene = Scene::new(&[[0.0, 0.0], [-0.7, 0.0]]);
    scene.velocities_mps = vec![WALK; 2];
    scene.preferred_mps = vec![0.3 * WALK, preferred_mps];
    scene
}

#[test]
fn an_agent_brakes_before_its_goal_with_another_behind() {
    check_switch(&followed(WALK), &alone(0.3 * WALK), |parts| parts.slowing = false);
    let mut scene = followed(WALK);
    let [alone_mps, with_mps] = [alone(0.3 * WALK), scene.clone()].map(|scene| scene.plan().velocity_mps.x);
    scene.params.planner.parts.slowing = false;
    let without_mps = scene.plan().velocity_mps.x;
    assert!(with_mps < without_mps && with_mps < alone_mps + 0.02, "{alone_mps} {with_mps} {without_mps}");
}

/// An agent that stands; the next one stands in contact ahead, and prefers a velocity.
fn in_contact(preferred_mps: Vec2) -> Scene {
    let mut scene = Scene::new(&[[0.0, 0.0], [0.5, 0.0]]);
    scene.velocities_mps = vec![Vec2::ZERO; 2];
    scene.preferred_mps[1] = preferred_mps;
    scene
}

#[test]
fn an_agent_at_rest_presses_on_except_in_a_queue() {
    check_switch(&in_contact(WALK.perp()), &in_contact(WALK), |parts| parts.pressing = false);
    let [across, alike] = [WALK.perp(), WALK].map(|preferred_mps| in_contact(preferred_mps).plan().velocity_mps.x);
    assert!(across > alike + 0.05, "{across} {alike}");
}

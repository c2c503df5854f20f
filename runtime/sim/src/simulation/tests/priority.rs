//! Claims about priorities.

use glam::Vec2;

use crate::simulation::tests::{self, scenario_of};

/// Greatest distance that each of two agents leaves its straight path, m. They walk towards each other.
fn aside_m(first: &str, second: &str) -> [f32; 2] {
    let text = format!(
        "duration_s = 16
        [profiles.vip]
        priority = 1
        [profiles.first_lady]
        inherits = 'vip'
        [states.hurry]
        go = 'east'
        set = {{ priority = 1 }}
        [goals.east]
        areas = [{{ point_m = [8, 0.1] }}]
        [[agents]]
        at_m = [-8, 0.1]
        goals_m = [[8, 0.1]]
        {first}
        [[agents]]
        at_m = [8, 0]
        goals_m = [[-8, 0]]
        {second}"
    );
    let mut aside_m = [0.0_f32; 2];
    let simulation = tests::run(&scenario_of(&text), |simulation, _| {
        for (aside_m, frame) in aside_m.iter_mut().zip(simulation.frames()) {
            *aside_m = aside_m.max(frame.root.position_m.y.abs());
        }
    });
    let roots_m: Vec<Vec2> = simulation.frames().iter().map(|frame| frame.root.position_m).collect();
    assert!(roots_m[0].x > 7.0 && roots_m[1].x < -7.0, "{roots_m:?}");
    aside_m
}

#[test]
fn the_agent_of_lower_priority_steps_aside() {
    let equal = aside_m("", "");
    for first in ["profile = 'first_lady'", "state = 'hurry'"] {
        let aside_m = aside_m(first, "");
        assert!(aside_m[0] < equal[0] - 0.1 && aside_m[1] > equal[1] + 0.1, "{first}: {aside_m:?}, equal {equal:?}");
    }
    let both = aside_m("state = 'hurry'", "profile = 'first_lady'");
    assert!((both[0] - equal[0]).abs() < 0.02, "{both:?}, equal {equal:?}");
}

/// Time at which an agent of a priority is 6 m from its start, s; nine agents walk towards it.
fn passing_time_s(priority: f32) -> f64 {
    let text = format!(
        "duration_s = 20
        profiles.first = {{ priority = {priority} }}
        [[agents]]
        at_m = [0, 0]
        goals_m = [[12, 0]]
        profile = 'first'
        [[agents]]
        grid = {{ columns = 3, rows = 3, spacing_m = 0.9, centre_m = [10, 0], jitter_m = 0.1 }}
        goal_offset_m = [-16, 0]"
    );
    let mut passed_s = f64::INFINITY;
    tests::run(&scenario_of(&text), |simulation, time_s| {
        if simulation.frames()[0].root.position_m.x > 6.0 {
            passed_s = passed_s.min(time_s);
        }
    });
    passed_s
}

#[test]
fn right_of_way_delays_no_agent() {
    let [first_s, equal_s] = [1.0, 0.0].map(passing_time_s);
    assert!(first_s < equal_s + 0.1 && first_s < 6.0, "{first_s} s with priority, {equal_s} s without");
}

//! Zones that states close: agents walk around them in these states, and leave those in which they are.

use glam::Vec2;

use super::{run, scenario_of};

const LAWN: &str = "clips = '.'\nzones = [{ rect_m = [4, -2, 8, 2], closed_in = ['walk', 'home'] }]\n\
    goals = { right = { areas = [{ point_m = [12, 0] }] }, left = { areas = [{ point_m = [0, 0] }] } }\n";

/// Whether the path of the only agent leads through the zone in each state, by index.
fn crossed(text: &str) -> Vec<bool> {
    let scenario = scenario_of(&format!("{LAWN}{text}"));
    let mut crossed = vec![false; scenario.behaviour.states.len()];
    let end = run(&scenario, |simulation, _| {
        let frame = &simulation.frames()[0];
        crossed[usize::from(frame.state)] |= scenario.zones[0].area.holds(frame.root.position_m);
    });
    let at_m = end.frames()[0].root.position_m;
    assert!(at_m.distance(Vec2::ZERO) < 0.5, "{at_m}");
    crossed
}

#[test]
fn agents_cross_a_zone_in_the_states_that_do_not_close_it() {
    let crossed = crossed(
        "duration_s = 60\nagents = [{ at_m = [0, 0], state = 'walk' }]\n\
         [states.walk]\ngo = 'right'\nthen = [{ when = { reached_m = 0.5 }, to = 'across' }]\n\
         [states.across]\ngo = 'left'\nthen = [{ when = { reached_m = 0.5 }, to = 'again' }]\n\
         [states.again]\ngo = 'right'\nthen = [{ when = { reached_m = 0.5 }, to = 'home' }]\n\
         [states.home]\ngo = 'left'\n",
    );
    // Without a state; across, again, home, walk.
    assert_eq!(crossed, [false, true, true, false, false]);
}

#[test]
fn agents_leave_a_zone_that_their_state_closes() {
    let crossed = crossed(
        "duration_s = 40\nagents = [{ at_m = [0, 0], state = 'across' }]\n\
         [states.across]\ngo = 'right'\nthen = [{ when = { after_s = 5 }, to = 'home' }]\n[states.home]\ngo = 'left'\n\
         [states.walk]\ngo = 'left'\n",
    );
    assert!(crossed[1] && crossed[2]);
}

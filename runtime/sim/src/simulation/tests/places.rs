//! Claims about places: queues, booths, full goals, and zones.

use crate::maths::angle::wrap_rad;
use crate::simulation::tests::behaviour::{run, states};

#[test]
fn a_till_serves_one_after_the_other() {
    const TILL: &str = "
        [goals.till]
        queue = true
        areas = [{ point_m = [6, 0] }, { point_m = [5.2, 0] }, { point_m = [4.4, 0] }, { point_m = [3.6, 0] }]
        [goals.exit]
        areas = [{ rect_m = [5.5, 7, 6.5, 8] }]
        [states.line_up]
        go = 'till'
        then = [{ when = { served_s = 3 }, to = 'leave' }]
        [states.leave]
        go = 'exit'
        then = [{ when = { reached_m = 0 }, to = 'gone' }]
        [states.gone]
        remove = 'at_once'
        [[agents]]
        grid = { columns = 4, rows = 1, spacing_m = 1.2, centre_m = [-1, -1] }
        state = 'line_up'
    ";
    let mut served: Vec<(u32, f64)> = Vec::new();
    let simulation = run(TILL, |simulation, time_s| {
        for (frame, state) in simulation.frames().iter().zip(states(simulation)) {
            if state == "leave" && served.iter().all(|(id, _)| *id != frame.id.0) {
                served.push((frame.id.0, time_s));
            }
        }
    });
    // The agent that starts nearest comes first.
    assert_eq!(served.iter().map(|(id, _)| *id).collect::<Vec<_>>(), [3, 2, 1, 0]);
    assert!(served.windows(2).all(|pair| pair[1].1 - pair[0].1 >= 3.0), "{served:?}");
    assert!(simulation.frames().is_empty(), "{:?}", states(&simulation));
}

#[test]
fn a_visitor_faces_its_booths_and_goes() {
    const BOOTHS: &str = "
        [goals.booths]
        choose = 'random'
        capacity = 1
        areas = [
            { rect_m = [-1, 4, 1, 5], facing_deg = 90 },
            { rect_m = [-1, -5, 1, -4], facing_deg = -90 },
            { rect_m = [4, -1, 5, 1], facing_deg = 180 },
        ]
        [states.walk]
        go = 'booths'
        then = [{ when = { reached_m = 0 }, to = 'look' }]
        [states.look]
        stand = { facing = 'goal' }
        then = [{ when = { after_s = 5 }, to = { walk = 3, gone = 1 } }]
        [states.gone]
        remove = true
        [[agents]]
        grid = { columns = 3, rows = 1, spacing_m = 1.2 }
        state = 'walk'
    ";
    let (mut looks, mut faced, mut before) = (0, 0, vec![String::new(); 3]);
    let simulation = run(BOOTHS, |simulation, _| {
        for (index, (frame, state)) in simulation.frames().iter().zip(states(simulation)).enumerate() {
            let id = frame.id.index();
            if state != "look" && before[id] == "look" {
                looks += 1;
                let behaviour = &simulation.scenario.behaviour;
                let areas = &behaviour.goals[0].areas;
                let place = areas.iter().find(|area| area.area.distance_m(frame.root.position_m) < 0.3).unwrap();
                let off_rad = wrap_rad(frame.root.facing_rad - place.facing_rad.unwrap()).abs();
                faced += usize::from(off_rad < 0.35);
            }
            before[id] = state.to_owned();
            assert!(simulation.crowd.occupancy.of_set(0).iter().all(|&taken| taken <= 1), "agent {index}");
        }
    });
    assert!(looks >= 5 && faced * 10 >= looks * 9, "{faced} of {looks}; {:?}", states(&simulation));
}

#[test]
fn a_full_goal_makes_agents_wait() {
    const ONE_SEAT: &str = "
        [goals.seat]
        capacity = 1
        areas = [{ circle_m = [4, 0, 0.4] }]
        [states.walk]
        go = 'seat'
        then = [{ when = { reached_m = 0 }, to = 'sit' }]
        [states.sit]
        stand = {}
        then = [{ when = { after_s = 4 }, to = 'gone' }]
        [states.gone]
        remove = 'at_once'
        [[agents]]
        grid = { columns = 1, rows = 3, spacing_m = 1.2 }
        state = 'walk'
    ";
    let simulation = run(ONE_SEAT, |simulation, _| {
        let count = states(simulation).iter().filter(|state| **state == "sit").count();
        assert!(count <= 1, "{count} sit");
    });
    let count = simulation.population().goals[0];
    assert_eq!((count.waiting, count.waiting_max), (0, 2));
    assert!(count.waiting_steps > 100 && simulation.frames().is_empty(), "{count:?}");
}

#[test]
fn agents_walk_slower_in_a_zone() {
    let text = "
        [[zones]]
        rect_m = [3, -2, 6, 2]
        speed_factor = 0.5
        [[agents]]
        at_m = [0, 0]
        goals_m = [[12, 0]]
        preferred_speed_mps = 1.2
        at_goal = 'leave'
        [[agents]]
        at_m = [0, 4]
        goals_m = [[12, 4]]
        preferred_speed_mps = 1.2
        at_goal = 'leave'
    ";
    let mut slow = 0;
    let simulation = run(text, |simulation, _| {
        for frame in simulation.frames() {
            let position_m = frame.root.position_m;
            let is_inside = frame.id.0 == 0 && position_m.x > 3.2 && position_m.x < 5.8;
            slow += usize::from(is_inside && (frame.preferred_mps.length() - 0.6).abs() < 1e-5);
        }
    });
    let removed = [0, 1].map(|id| simulation.population().agents[id].removed.unwrap());
    // 3 m at half the speed take 2.5 s longer: 50 steps.
    assert!(slow > 60 && removed[0].abs_diff(removed[1] + 50) < 16, "{slow}, {removed:?}");
}

#[test]
fn an_area_in_a_zone_that_is_closed_to_an_agent_is_not_chosen() {
    let text = "
        [profiles.visitor]
        preferred_speed_mps = 1.3
        [[zones]]
        rect_m = [2, -3, 8, 3]
        closed_to = ['visitor']
        [goals.rooms]
        choose = 'random'
        areas = [{ rect_m = [4, -1, 6, 1] }, { rect_m = [-6, -1, -4, 1] }]
        [states.go]
        go = 'rooms'
        [[agents]]
        grid = { columns = 2, rows = 6, spacing_m = 1, centre_m = [0, 0] }
        profile = 'visitor'
        state = 'go'
        [[agents]]
        grid = { columns = 2, rows = 3, spacing_m = 1, centre_m = [0, 7] }
        state = 'go'
    ";
    let simulation = run(&format!("coupling = 'discs'\n{text}"), |_, _| {});
    let right_of = |agents: std::ops::Range<usize>| {
        simulation.frames()[agents].iter().filter(|frame| frame.root.position_m.x > 1.0).count()
    };
    assert_eq!((right_of(0..12), right_of(12..18) > 0), (0, true));
    let waits = simulation.population().goals[0].waiting_steps;
    assert_eq!(waits, 0, "every visitor has a goal");
}

#[test]
fn agents_in_a_queue_face_its_head() {
    let text = "
        [goals.till]
        queue = true
        areas = [{ point_m = [0, 0] }, { point_m = [0.9, 0] }, { point_m = [1.8, 0] }, { point_m = [1.8, 0.9] }]
        [states.pay]
        go = 'till'
        then = [{ when = { served_s = 100 }, to = 'gone' }]
        [states.gone]
        remove = true
        [[agents]]
        grid = { columns = 4, rows = 1, spacing_m = 1.5, centre_m = [1, 6] }
        state = 'pay'
    ";
    let simulation = run(text, |_, _| {});
    let mut facings: Vec<(f32, f32)> = simulation
        .frames()
        .iter()
        .map(|frame| (frame.root.position_m.x + frame.root.position_m.y, frame.root.facing_rad))
        .collect();
    facings.sort_by(|a, b| a.0.total_cmp(&b.0));
    let expected_rad = [std::f32::consts::PI, std::f32::consts::PI, std::f32::consts::PI, -std::f32::consts::FRAC_PI_2];
    for ((_, facing_rad), expected_rad) in facings.iter().zip(expected_rad) {
        assert!(wrap_rad(facing_rad - expected_rad).abs() < 0.15, "{facings:?}");
    }
}

//! Claims about groups that walk together.

use glam::Vec2;

use crate::simulation::Simulation;
use crate::simulation::tests::{self, scenario_of};

fn run(text: &str, mut watch: impl FnMut(&Simulation)) -> Simulation {
    tests::run(&scenario_of(&format!("duration_s = 40\n{text}")), |simulation, _| watch(simulation))
}

fn positions_m(simulation: &Simulation) -> Vec<Vec2> {
    simulation.frames().iter().map(|frame| frame.root.position_m).collect()
}

/// Share of the samples of one step in which a predicate holds.
fn share(samples: &[(f32, f32)], holds: impl Fn(&(f32, f32)) -> bool) -> f32 {
    samples.iter().filter(|sample| holds(sample)).count() as f32 / samples.len() as f32
}

#[test]
fn a_pair_of_different_speeds_walks_abreast() {
    const PAIR: &str = "
        [profiles.mixed]
        preferred_speed_mps = { uniform = [0.9, 1.6] }
        [[agents]]
        grid = { columns = 1, rows = 2, spacing_m = 1.2 }
        goal_offset_m = [30, 0]
        groups = { 2 = 1 }
        profile = 'mixed'
    ";
    let mut offsets_m: Vec<(f32, f32)> = Vec::new();
    let simulation = run(PAIR, |simulation| {
        let roots_m = positions_m(simulation);
        if (4.0..24.0).contains(&roots_m[0].x) {
            let offset_m = (roots_m[1] - roots_m[0]).abs();
            offsets_m.push((offset_m.x, offset_m.y));
        }
    });
    assert!(simulation.population().agents.iter().all(|life| life.group == Some(0)));
    assert!(share(&offsets_m, |(ahead_m, _)| *ahead_m < 0.4) > 0.95, "{:?}", offsets_m.last());
    assert!(share(&offsets_m, |(_, aside_m)| (0.5..1.1).contains(aside_m)) > 0.95, "{:?}", offsets_m.last());
}

#[test]
fn a_member_ahead_waits_for_the_others() {
    const APART: &str = "
        [[agents]]
        grid = { columns = 2, rows = 1, spacing_m = 4.5 }
        goals_m = [[25, 0]]
        groups = { 2 = 1 }
    ";
    let mut ahead_m: Vec<(f32, f32)> = Vec::new();
    run(APART, |simulation| {
        let roots_m = positions_m(simulation);
        if (9.0..20.0).contains(&roots_m[1].x) {
            ahead_m.push(((roots_m[1].x - roots_m[0].x).abs(), 0.0));
        }
    });
    assert!(!ahead_m.is_empty() && share(&ahead_m, |(ahead_m, _)| *ahead_m < 0.6) > 0.9, "{:?}", ahead_m.first());
}

#[test]
fn a_group_passes_a_narrow_door_in_a_file() {
    const DOOR: &str = "
        [[agents]]
        grid = { columns = 1, rows = 4, spacing_m = 0.8 }
        goal_offset_m = [14, 0]
        groups = { 4 = 1 }
        [[obstacles]]
        polygon_m = [[6, 0.5], [6.3, 0.5], [6.3, 8], [6, 8]]
        [[obstacles]]
        polygon_m = [[6, -8], [6.3, -8], [6.3, -0.5], [6, -0.5]]
    ";
    let simulation = run(DOOR, |_| {});
    let at_goals = positions_m(&simulation).iter().filter(|root_m| (root_m.x - 14.0).abs() < 0.7).count();
    assert_eq!(at_goals, 4, "{:?}", positions_m(&simulation));
}

#[test]
fn a_group_visits_one_booth_and_leaves_together() {
    const BOOTHS: &str = "
        [goals.booths]
        choose = 'random'
        capacity = 3
        areas = [{ rect_m = [5, 4, 7, 5] }, { rect_m = [5, -5, 7, -4] }, { rect_m = [-7, 4, -5, 5] }]
        [goals.exit]
        areas = [{ rect_m = [9, -1, 10, 1] }]
        [states.walk]
        go = 'booths'
        then = [{ when = { reached_m = 0.2 }, to = 'look' }]
        [states.look]
        stand = {}
        then = [{ when = { after_s = { uniform = [2, 6] } }, to = 'leave' }]
        [states.leave]
        go = 'exit'
        then = [{ when = { reached_m = 0 }, to = 'gone' }]
        [states.gone]
        remove = 'at_once'
        [[agents]]
        grid = { columns = 3, rows = 3, spacing_m = 0.9 }
        state = 'walk'
        groups = { 3 = 1 }
    ";
    let mut apart = 0;
    let mut visits = 0;
    let simulation = run(BOOTHS, |simulation| {
        for group in &simulation.walking_groups().members {
            let agents = &simulation.crowd.agents;
            let is_apart = |of: &dyn Fn(usize) -> u32| group.iter().any(|&member| of(member) != of(group[0]));
            apart += usize::from(is_apart(&|member| agents[member].state));
            apart += usize::from(is_apart(&|member| agents[member].goal_at().map_or(9, |goal| goal.area)));
            visits += usize::from(simulation.frames()[group[0]].state == 3);
        }
    });
    assert_eq!(apart, 0);
    assert!(visits > 50 && simulation.frames().is_empty(), "{visits}, {} left", simulation.frames().len());
}

#[test]
fn a_source_sends_whole_groups() {
    const SOURCE: &str = "
        [[sources]]
        rect_m = [-12, -2, -9, 2]
        rate_per_s = 0.5
        goal_offset_m = [24, 0]
        at_goal = 'leave'
        groups = { 1 = 1, 2 = 1, 3 = 1 }
    ";
    let simulation = run(SOURCE, |_| {});
    let lives = &simulation.population().agents;
    let sizes = |first: usize| lives.iter().filter(|life| life.group == Some(first as u32)).count();
    let groups: Vec<usize> = (0..lives.len()).map(sizes).filter(|&size| size > 0).collect();
    // The last group ends with the source.
    let (last, whole) = groups.split_last().unwrap();
    assert!(whole.len() >= 3 && whole.iter().all(|size| (2..=3).contains(size)) && *last <= 3, "{groups:?}");
    let delays = lives.iter().filter_map(|life| Some(lives[life.group? as usize].born.abs_diff(life.born)));
    assert!(delays.max().unwrap() <= 30);
}

#[test]
fn members_take_neighbouring_seats() {
    const SEATS: &str = "
        [goals.seats]
        choose = 'random'
        capacity = 1
        areas = [{ point_m = [6, 5] }, { point_m = [6, -5] }, { point_m = [7, 5] }, { point_m = [7, -5] }]
        [states.sit_down]
        go = 'seats'
        then = [{ when = { reached_m = 0 }, to = 'sit' }]
        [states.sit]
        stand = {}
        [[agents]]
        grid = { columns = 2, rows = 2, spacing_m = 1.2 }
        state = 'sit_down'
        groups = { 2 = 1 }
    ";
    let simulation = run(SEATS, |_| {});
    let roots_m = positions_m(&simulation);
    for group in &simulation.walking_groups().members {
        let apart_m = roots_m[group[0]].distance(roots_m[group[1]]);
        assert!((0.6..1.4).contains(&apart_m), "{roots_m:?}");
    }
    assert!(simulation.frames().iter().all(|frame| frame.state == 1), "all sit");
}

//! Claims about crowds with behaviour: small scenarios from text to their last step.

use glam::Vec2;

use crate::measures::Measuring;
use crate::population::AgentLife;
use crate::scenario::Scenario;
use crate::simulation::Simulation;
use crate::simulation::tests::{self, scenario_of, started};

/// The scenario of a text, a minute of steps of 0.05 s.
fn scenario(text: &str) -> Scenario {
    scenario_of(&format!("duration_s = 60\ndt_s = 0.05\n{text}"))
}

/// A text as a scenario, run to its end; `watch` sees every step with its time in seconds.
pub(super) fn run(text: &str, watch: impl FnMut(&Simulation, f64)) -> Simulation {
    tests::run(&scenario(text), watch)
}

/// Name of the state of each present agent.
pub(super) fn states(simulation: &Simulation) -> Vec<&str> {
    let names = &simulation.scenario.behaviour.states;
    simulation.frames().iter().map(|frame| names[usize::from(frame.state)].name.as_str()).collect()
}

const CROSSING: &str = "
    [signals.crossing]
    green_s = 8
    red_s = 12
    offset_s = 6
    [goals.far_side]
    areas = [{ rect_m = [5, -4, 7, 4] }]
    [states.wait]
    stand = { facing_deg = 0 }
    then = [{ when = { green = 'crossing' }, to = 'cross' }]
    [states.cross]
    go = 'far_side'
    then = [{ when = { reached_m = 0 }, to = 'gone' }]
    [states.gone]
    remove = true
    [[agents]]
    grid = { columns = 2, rows = 4, spacing_m = 1.0, centre_m = [-4, 0] }
    state = 'wait'
    [[sources]]
    rect_m = [-8, -2, -6, 2]
    rate_per_s = 0.4
    state = 'wait'
";

#[test]
fn no_agent_enters_on_red() {
    let mut before: Vec<(u32, u16)> = Vec::new();
    let mut crossings = 0;
    let simulation = run(CROSSING, |simulation, time_s| {
        let wait = simulation.scenario.behaviour.state("wait").unwrap() as u16;
        let signal = &simulation.scenario.behaviour.signals[0];
        for frame in simulation.frames() {
            let starts = frame.state != wait && before.contains(&(frame.id.0, wait));
            crossings += usize::from(starts);
            assert!(!starts || signal.is_green(time_s - 0.05), "agent {} at {time_s} s", frame.id.0);
        }
        before = simulation.frames().iter().map(|frame| (frame.id.0, frame.state)).collect();
    });
    let removed = simulation.population().agents.iter().filter(|life| life.removed.is_some()).count();
    assert!(crossings >= 15 && removed >= 12, "{crossings} crossings, {removed} removed");
}

#[test]
fn an_agent_that_stands_at_its_goal_has_reached_it() {
    // A body stops up to half a step before its goal; the goals are points, reached within 1 cm.
    const THERE_AND_BACK: &str = "
        [goals.points]
        areas = [{ point_m = [3, 0.4] }, { point_m = [3, 1.9] }, { point_m = [3, 3.4] }]
        capacity = 1
        [states.there]
        go = 'points'
        then = [{ when = { reached_m = 0.01 }, to = 'return' }]
        [states.return]
        go = { offset_m = [0, 0] }
        then = [{ when = { reached_m = 0.01 }, to = 'home' }]
        [states.home]
        stand = {}
        [[agents]]
        grid = { columns = 1, rows = 3, spacing_m = 1.5, centre_m = [0, 1.5] }
        state = 'there'
    ";
    let mut turned_m: [Option<f32>; 3] = [None; 3];
    let simulation = run(THERE_AND_BACK, |simulation, _| {
        for (frame, state) in simulation.frames().iter().zip(states(simulation)) {
            if state == "return" {
                turned_m[frame.id.index()].get_or_insert(frame.root.position_m.x);
            }
        }
    });
    assert_eq!(states(&simulation), ["home"; 3]);
    // None turns back before it has stood near its goal.
    assert!(turned_m.iter().flatten().all(|x_m| (x_m - 3.0).abs() < 0.6), "{turned_m:?}");
}

#[test]
fn measures_count_the_visits_of_states() {
    const ONE_STANDS: &str = "
        [goals.point]
        areas = [{ point_m = [3, 0] }]
        [states.walk]
        go = 'point'
        then = [{ when = { reached_m = 0 }, to = 'stand' }]
        [states.stand]
        stand = {}
        [[agents]]
        at_m = [0, 0]
        state = 'walk'
        [[agents]]
        at_m = [0, 5]
        goals_m = [[2, 5]]
    ";
    let scenario = scenario(ONE_STANDS);
    let mut simulation = started(&scenario);
    let skeleton = simulation.database().skeleton.clone();
    let mut measuring = Measuring::new(&skeleton, &scenario, simulation.population(), simulation.frames());
    for _ in 0..200 {
        simulation.step(&mut |_| {});
        measuring.push(simulation.population(), simulation.frames());
    }
    let measures = measuring.finish(simulation.population());
    let visits: Vec<(&str, usize, usize)> =
        measures.states.iter().map(|state| (state.state.as_str(), state.visited, state.at_end)).collect();
    assert_eq!(visits, [("follow_path", 1, 1), ("stand", 1, 1), ("walk", 1, 0)]);
    let times_s: f64 = measures.states.iter().filter_map(|state| state.mean_time_s).sum();
    assert!((times_s - 2.0 * 201.0 * 0.05).abs() < 1e-4, "{times_s}");
    assert_eq!((measures.arrived, measures.stalled), (2, 0));
}

const CHANGES: &str = "
    [areas.middle]
    circle_m = [0, 0, 1]
    [goals.ends]
    choose = 'farthest'
    areas = [{ circle_m = [-6, 0, 1] }, { circle_m = [6, 0, 1] }]
    [states.to_and_fro]
    go = 'ends'
    set = { speed_factor = { uniform = [0.7, 1.2] }, radius_m = { uniform = [0.15, 0.3] } }
    then = [{ when = { reached_m = 0 }, to = { to_and_fro = 1, jump = 1, turn = 1 } }]
    [states.turn]
    stand = { facing_m = [0, 0] }
    then = [{ when = { after_s = { normal = [2, 1], min = 0.5 } }, to = 'back' }]
    [states.jump]
    stand = {}
    set = { teleport = { rect_m = [-3, 4, 3, 8] } }
    then = [{ when = { after_s = 1 }, to = { to_and_fro = 3, follow_path = 1 } }]
    [[agents]]
    grid = { columns = 8, rows = 5, spacing_m = 1.0 }
    goal_offset_m = [0, 10]
    state = 'to_and_fro'
    [[agents]]
    circle = { count = 6, radius_m = 9 }
    [[sources]]
    rect_m = [-9, -6, 9, -4]
    rate_per_s = 0.5
    goal_offset_m = [0, 12]
    at_goal = 'leave'
";

#[test]
fn one_two_and_four_threads_give_equal_bits() {
    let scenario = scenario(CHANGES);
    let pools = [1, 2, 4].map(|threads| rayon::ThreadPoolBuilder::new().num_threads(threads).build().unwrap());
    let mut simulations = pools.each_ref().map(|_| started(&scenario));
    for step in 0..500 {
        for (simulation, pool) in simulations.iter_mut().zip(&pools) {
            pool.install(|| simulation.step(&mut |_| {}));
        }
        assert!(simulations[1..].iter().all(|other| other.frames() == simulations[0].frames()), "step {step}");
    }
    let agents = &simulations[0].population().agents;
    assert!(simulations[1..].iter().all(|other| other.population().agents == *agents));
    let changed = |has: fn(&AgentLife) -> bool| agents.iter().filter(|life| has(life)).count();
    assert!(changed(|life| !life.radii_m.is_empty()) >= 40 && changed(|life| !life.teleports.is_empty()) > 5);
    assert!(changed(|life| life.removed.is_some()) > 0);
}

#[test]
fn teleports_are_no_slide_of_planted_feet() {
    const PERIODIC: &str = "
        [areas.end]
        rect_m = [4, -1, 9, 1]
        [states.walk]
        walk_mps = [1.2, 0]
        then = [{ when = { inside = 'end' }, to = 'jump' }]
        [states.jump]
        stand = {}
        set = { teleport = { point_m = [-4, 0] } }
        then = [{ to = 'walk' }]
        [[agents]]
        at_m = [0, 0]
        state = 'walk'
    ";
    let scenario = scenario(PERIODIC);
    let mut simulation = started(&scenario);
    let skeleton = simulation.database().skeleton.clone();
    let mut measuring = Measuring::new(&skeleton, &scenario, simulation.population(), simulation.frames());
    for _ in 0..600 {
        simulation.step(&mut |_| {});
        measuring.push(simulation.population(), simulation.frames());
    }
    assert!(simulation.population().agents[0].teleports.len() >= 3);
    let slide_cm_s = measuring.finish(simulation.population()).planted_slide_cm_s;
    assert!(slide_cm_s.is_some_and(|slide_cm_s| slide_cm_s < 2.0), "{slide_cm_s:?}");
}

#[test]
fn a_teleported_body_stands_where_it_was_moved() {
    let mut jumps = 0;
    run(CHANGES, |simulation, time_s| {
        let step = (time_s / 0.05).round() as u32;
        for frame in simulation.frames() {
            let life = &simulation.population().agents[frame.id.index()];
            if life.is_teleported(step) {
                jumps += 1;
                let position_m = frame.root.position_m;
                assert!(position_m.y >= 4.0 && position_m.x.abs() <= 3.0, "{position_m}");
                assert_eq!(frame.contacts, [1.0; 2]);
            }
        }
    });
    assert!(jumps > 10);
}

#[test]
fn endless_transitions_are_kept_as_a_fault() {
    let text = "
        [areas.trap]
        rect_m = [3, -2, 6, 2]
        [states.walk]
        walk_mps = [1.2, 0]
        then = [{ when = { inside = 'trap' }, to = 'turn' }]
        [states.turn]
        stand = {}
        then = [{ when = { inside = 'trap' }, to = 'walk' }]
        [[agents]]
        at_m = [0, 0]
        state = 'walk'
    ";
    let mut simulation = started(&scenario(text));
    (0..100).for_each(|_| simulation.step(&mut |_| {}));
    let fault = simulation.endless_transitions().unwrap();
    assert_eq!((fault.agent.0, &*fault.states), (0, &[1, 2][..]));
    assert!(fault.time_s > 1.0 && fault.time_s < 5.0, "{}", fault.time_s);
}

#[test]
fn agents_without_a_state_move_as_without_behaviour() {
    let agents = "[[agents]]\ncircle = { count = 9, radius_m = 4 }\n";
    let with = format!("{agents}[states.idle]\nstand = {{}}\n");
    let mut simulations = [agents, &with].map(|text| started(&scenario(text)));
    for _ in 0..300 {
        simulations.iter_mut().for_each(|simulation| simulation.step(&mut |_| {}));
        assert_eq!(simulations[0].frames(), simulations[1].frames());
    }
    assert!(simulations[0].frames()[0].root.position_m.distance(Vec2::new(-4.0, 0.0)) < 1.0);
}

#[test]
fn agents_of_sources_are_born_facing_their_goal() {
    let text = "
        [goals.west]
        areas = [{ point_m = [-8, 0] }]
        [states.walk]
        go = 'west'
        [[sources]]
        at_m = [0, 0]
        schedule = [[0.5, 1]]
        state = 'walk'
        [[sources]]
        at_m = [0, 3]
        schedule = [[0.5, 1]]
        state = 'walk'
        facing_deg = 90
    ";
    let simulation = run(text, |_, _| {});
    let facings_rad: Vec<f32> = simulation.population().agents.iter().map(|life| life.spec.facing_rad.abs()).collect();
    assert_eq!(facings_rad, [std::f32::consts::PI, std::f32::consts::FRAC_PI_2]);
}

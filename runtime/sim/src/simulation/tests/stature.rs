//! Claims about bodies of other sizes than the database's skeleton.

use motiondb::body::Joint;

use crate::measures::Measuring;
use crate::simulation::tests::{run, scenario_of};

const CHILDREN: &str = "
    duration_s = 12
    profiles.child = { stature = 0.6 }
    [[agents]]
    at_m = [0, 0]
    goals_m = [[11, 0]]
    [[agents]]
    at_m = [0, 6]
    goals_m = [[11, 6]]
    profile = 'child'
";

#[test]
fn children_are_slower_and_smaller() {
    let scenario = scenario_of(CHILDREN);
    let [adult, child] = &scenario.agents[..] else { unreachable!() };
    assert!((child.preferred_speed_mps / adult.preferred_speed_mps - 0.6_f32.sqrt()).abs() < 1e-6);
    assert!((child.radius_m / adult.radius_m - 0.6).abs() < 1e-6 && child.wall_radius_m <= child.radius_m);
    let (mut greatest_mps, mut arrival_s) = ([0.0_f32; 2], [0.0; 2]);
    let simulation = run(&scenario, |simulation, time_s| {
        let frames = simulation.frames().iter().zip(&simulation.agents.velocities_mps);
        for (index, (frame, velocity_mps)) in frames.enumerate() {
            greatest_mps[index] = greatest_mps[index].max(velocity_mps.length());
            if frame.root.position_m.x < 10.0 {
                arrival_s[index] = time_s;
            }
        }
    });
    let statures: Vec<f32> = simulation.population().agents.iter().map(|life| life.stature).collect();
    assert!(statures[0] != 1.0 && statures[1] == 0.6, "{statures:?}");
    assert!((greatest_mps[0] - 1.33).abs() < 0.05 && (greatest_mps[1] - 1.03).abs() < 0.05, "{greatest_mps:?}");
    assert!(arrival_s[1] > 1.2 * arrival_s[0] && arrival_s[1] < 11.5, "{arrival_s:?}");
}

#[test]
fn the_feet_of_a_child_hold() {
    let scenario = scenario_of(CHILDREN);
    let skeleton = crate::test_db::skeleton();
    let mut simulation = crate::simulation::tests::started(&scenario);
    let mut measuring = Measuring::new(&skeleton, &scenario, simulation.population(), simulation.frames());
    let mut lowest_m: f32 = 0.0;
    for _ in 0..scenario.steps() {
        simulation.step(&mut |_| {});
        measuring.push(simulation.population(), simulation.frames());
        let child = &simulation.frames()[1];
        let joints = child.pose.forward_kinematics(&skeleton).sized(0.6);
        let soles_m = [0, 1].map(|side| joints.sole_points_m(&skeleton.sized(0.6), side).map(|point_m| point_m.z));
        lowest_m = soles_m.as_flattened().iter().copied().fold(lowest_m, f32::min);
        let head_m = joints.positions_m[Joint::Head.index()].z;
        let adult_m = simulation.frames()[0].pose.forward_kinematics(&skeleton).positions_m[Joint::Head.index()].z;
        assert!((head_m / adult_m - 0.6).abs() < 0.03, "{head_m} m, adult {adult_m} m");
    }
    let measures = measuring.finish(simulation.population());
    assert_eq!(measures.arrived, 2);
    assert!(measures.planted_slide_cm_s.unwrap() < 0.5 && lowest_m > -0.005, "{measures:?}, {lowest_m} m");
}

#[test]
fn bodies_of_discs_and_sources_have_a_size() {
    let text = "
        duration_s = 6
        coupling = 'decoupled'
        planner = 'orca'
        profiles.child = { stature = { uniform = [0.5, 0.7] }, radius_m = 0.2, preferred_speed_mps = 0.9 }
        [[sources]]
        at_m = [0, 0]
        rate_per_s = 1
        goals_m = [[9, 0]]
        profile = 'child'
    ";
    let simulation = run(&scenario_of(text), |_, _| {});
    let lives = &simulation.population().agents;
    assert!(lives.len() > 2 && lives.windows(2).all(|pair| pair[0].stature != pair[1].stature));
    for life in lives {
        assert!((0.5..=0.7).contains(&life.stature), "{}", life.stature);
        assert_eq!((life.spec.radius_m, life.spec.preferred_speed_mps), (0.2, 0.9));
    }
}

#[test]
fn adults_differ_in_size_and_keep_their_speed() {
    let walker = |y_m: usize| format!("[[agents]]\nat_m = [0, {y_m}]\ngoals_m = [[20, {y_m}]]\n");
    let text = format!("duration_s = 6\n{}", (0..6).map(|index| walker(4 * index)).collect::<String>());
    let simulation = run(&scenario_of(&text), |_, _| {});
    let lives = &simulation.population().agents;
    for (life, velocity_mps) in lives.iter().zip(&simulation.agents.velocities_mps) {
        assert!((0.88..=1.12).contains(&life.stature) && life.stature != 1.0, "{}", life.stature);
        assert!((velocity_mps.length() - 1.33).abs() < 0.03, "{velocity_mps}");
        assert_eq!(life.spec.radius_m, lives[0].spec.radius_m);
    }
    assert!(lives.windows(2).all(|pair| pair[0].stature != pair[1].stature));
}

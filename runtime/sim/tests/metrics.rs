//! Measures of recordings, with values computed by hand.

mod common;

use common::{agent, folder, header, record, standing_at};
use fbcrowd_sim::measures::{Measures, measure, write_trajectories};
use fbcrowd_sim::planning::VelocitySet;
use fbcrowd_sim::recording::{AgentFrame, Header};
use glam::{Quat, Vec2, Vec3};
use motiondb::body::{Joint, Skeleton};

const DT_S: f32 = 0.1;

fn measured(test: &str, header: &Header, frames: &[Vec<AgentFrame>]) -> Measures {
    measure(&record(&folder(test).join("a.fbrec"), header, frames)).unwrap()
}

fn walker(goal_x: f32) -> Header {
    header(vec![agent([0.0, 0.0], [goal_x, 0.0])], DT_S)
}

/// One agent along x, feet in the air.
fn path(positions_m: impl IntoIterator<Item = f32>) -> Vec<Vec<AgentFrame>> {
    let frame = |x: f32| AgentFrame { contacts: [0.0; 2], ..standing_at(Vec2::new(x, 0.0)) };
    positions_m.into_iter().map(|x| vec![frame(x)]).collect()
}

fn check(found: f64, expected: f64) {
    assert!((found - expected).abs() < 1e-4 * (1.0 + expected.abs()), "{found}, not {expected}");
}

#[test]
fn acceleration_counts_from_rest_to_the_arrival() {
    // 1 m/s at once, kept for ten steps, then a stop: 10 m/s² twice in twenty steps, once in those nine before x = 0.9
    // > 1.4 − 0.5 − ε.
    let positions = (0..=20).map(|step| 0.1 * step.min(10) as f32);
    let measures = measured("acceleration", &walker(1.39), &path(positions));
    assert_eq!((measures.agents, measures.steps, measures.arrived, measures.stalled), (1, 20, 1, 0));
    check(measures.mean_acceleration_mps2, 20.0 / 20.0);
    check(measures.mean_acceleration_before_arrival_mps2, 10.0 / 9.0);
    check(measures.mean_time_to_goal_s.unwrap(), 0.9);
}

#[test]
fn without_an_arrival_there_is_no_time_to_goal() {
    let measures = measured("no_arrival", &walker(50.0), &path((0..5).map(|step| step as f32)));
    assert_eq!((measures.arrived, measures.mean_time_to_goal_s, measures.planted_slide_cm_s), (0, None, None));
}

#[test]
fn five_seconds_of_standing_stall_before_arrival_only() {
    let stood = |steps: i32, goal: f32, preferred_mps: Vec2, test| {
        let mut frames = path((0..=steps).map(|_| 0.0));
        frames.iter_mut().for_each(|frame| frame[0].preferred_mps = preferred_mps);
        measured(test, &walker(goal), &frames).stalled
    };
    assert_eq!(stood(49, 9.0, Vec2::X, "stall_short"), 0);
    assert_eq!(stood(50, 9.0, Vec2::X, "stall"), 1);
    assert_eq!(stood(90, 0.3, Vec2::X, "stall_arrived"), 0);
    assert_eq!(stood(90, 9.0, Vec2::ZERO, "wants_to_stand"), 0);
}

#[test]
fn tracking_error_is_the_distance_from_the_planned_position() {
    let mut frames = path((0..5).map(|step| 0.1 * step as f32));
    for frame in &mut frames {
        frame[0].planned_mps = Vec2::new(1.0, 0.5);
    }
    check(measured("tracking", &walker(9.0), &frames).root_tracking_error_m, 0.05);
    frames[2][0].planned_mps = Vec2::new(1.0, 2.0);
    check(measured("worst", &walker(9.0), &frames).root_tracking_worst_m, 0.2);
}

#[test]
fn heading_error_counts_in_the_turning_set() {
    // Three steps at 60° to the facing, of which one is a side-step, and one ahead.
    let aside = 0.1 * Vec2::from_angle(std::f32::consts::FRAC_PI_3);
    let moves = [(aside, VelocitySet::Turning); 2];
    let moves = moves.into_iter().chain([(aside, VelocitySet::Holding), (0.1 * Vec2::X, VelocitySet::Turning)]);
    let (mut position_m, mut frames) = (Vec2::ZERO, vec![vec![standing_at(Vec2::ZERO)]]);
    for (moved, set) in moves {
        position_m += moved;
        frames.push(vec![AgentFrame { set, ..standing_at(position_m) }]);
    }
    let measures = measured("heading", &walker(50.0), &frames);
    check(measures.heading_error_deg, 40.0);
    check(measures.walking_heading_error_deg, 45.0);
}

#[test]
fn two_agents_at_one_position_collide_all_the_time() {
    let header = header(vec![agent([0.0, 0.0], [5.0, 0.0]), agent([9.0, 0.0], [5.0, 0.0])], DT_S);
    let frames = vec![vec![standing_at(Vec2::ONE); 2]; 8];
    check(measured("collide", &header, &frames).collision_rate, 0.5);
}

#[test]
fn separation_counts_between_frames() {
    let header = header(vec![agent([-1.0, 0.2], [5.0, 0.0]), agent([0.0, 0.0], [5.0, 0.0])], DT_S);
    let frames: Vec<_> = [-1.0, 1.0, 3.0].map(|x| vec![standing_at(Vec2::new(x, 0.2)), standing_at(Vec2::ZERO)]).into();
    check(measured("separation", &header, &frames).minimum_separation_m.unwrap(), 0.2);
    assert_eq!(measured("alone", &walker(9.0), &path([0.0, 1.0])).minimum_separation_m, None);
}

#[test]
fn a_detour_counts_until_the_arrival() {
    // 3 m aside, then 4 m along x to the position of arrival, 5 m from the start by the hypotenuse; the rest does not
    // count.
    let mut path_m: Vec<Vec2> = (0..=30).map(|step| Vec2::new(0.0, 0.1 * step as f32)).collect();
    path_m.extend((1..=40).map(|step| Vec2::new(0.1 * step as f32, 3.0)));
    path_m.extend((1..=20).map(|step| Vec2::new(4.0, 3.0 - 0.1 * step as f32)));
    let frames: Vec<_> = path_m.into_iter().map(|position_m| vec![standing_at(position_m)]).collect();
    let header = |agent| header(vec![agent], DT_S);
    let direct = header(agent([0.0, 0.0], [4.49, 3.0]));
    check(measured("detour", &direct, &frames).path_over_straight_line.unwrap(), 7.0 / 5.0);
    let mut over_corner = agent([0.0, 0.0], [0.0, 3.0]);
    over_corner.goals_m.push(Vec2::new(4.49, 3.0));
    check(measured("waypoint", &header(over_corner), &frames).path_over_straight_line.unwrap(), 1.0);
}

#[test]
fn a_round_trip_ends_after_its_waypoints() {
    let out_and_back_m = (0..=20).chain((0..20).rev()).map(|step| 0.1 * step as f32);
    let mut there_and_back = agent([0.0, 0.0], [2.0, 0.0]);
    there_and_back.goals_m.push(Vec2::new(0.03, 0.0));
    let measures = measured("round_trip", &header(vec![there_and_back], DT_S), &path(out_and_back_m));
    check(measures.mean_time_to_goal_s.unwrap(), 3.5);
    check(measures.path_over_straight_line.unwrap(), 1.0);
}

#[test]
fn strafing_and_stepping_back_count_at_held_facing() {
    // Facing x: ten steps to the left, five backward, five forward, five standing, all but the forward ones at held
    // facing.
    let moves = [(10, Vec2::Y), (5, Vec2::NEG_X), (5, Vec2::X), (5, Vec2::ZERO)];
    let (mut position_m, mut frames) = (Vec2::ZERO, vec![vec![standing_at(Vec2::ZERO)]]);
    for (count, direction) in moves {
        for _ in 0..count {
            position_m += 0.1 * direction;
            let set = if direction == Vec2::X { VelocitySet::Turning } else { VelocitySet::Holding };
            frames.push(vec![AgentFrame { set, ..standing_at(position_m) }]);
        }
    }
    let measures = measured("sidewards", &walker(50.0), &frames);
    check(measures.strafing_share, 10.0 / 25.0);
    check(measures.stepping_back_share, 5.0 / 25.0);
}

#[test]
fn bodies_penetrate_by_their_deepest_overlap() {
    let header = header(vec![agent([0.0, 0.0], [5.0, 0.0]), agent([9.0, 0.0], [5.0, 0.0])], DT_S);
    let pair = |y: f32| vec![standing_at(Vec2::ZERO), standing_at(Vec2::new(0.0, y))];
    // Every bone is 7 cm along x with a radius of 6 cm, so side by side the outermost bones decide.
    let widest_m = widest_m(header.skeleton());
    let frames = vec![pair(3.0), pair(2.0 * widest_m + 0.11), pair(2.0 * widest_m + 0.13)];
    let measures = measured("bodies", &header, &frames);
    check(measures.body_penetration_max_mm, 10.0);
    check(measures.body_penetration_touching_mm.unwrap(), 10.0);
    check(measures.body_penetration_mm, 10.0 / (2.0 * 2.0));
    check(measures.body_touching_share, 0.5);
    assert_eq!(measured("apart", &header, &vec![pair(3.0); 3]).body_penetration_touching_mm, None);
}

/// Distance of the outermost bone from the root, sideways, m.
fn widest_m(skeleton: &Skeleton) -> f32 {
    let joints = standing_at(Vec2::ZERO).pose.forward_kinematics(skeleton);
    joints.positions_m.iter().map(|position_m| position_m.y).fold(0.0, f32::max)
}

/// A left foot planted in frames 10 to 29 that slides at 3 cm/s, but at 50 cm/s in the first and the last of them.
fn sliding() -> Vec<Vec<AgentFrame>> {
    let mut x = 0.0;
    let frame = |step: i32| {
        let planted = (10..30).contains(&step);
        x += if (12..=28).contains(&step) { 0.003 } else { 0.05 };
        let mut frame = standing_at(Vec2::new(x, 0.0));
        frame.contacts = [if planted { 0.6 } else { 0.4 }, 0.0];
        frame.examples_slide_cm_s = if planted { 2.0 } else { 9.0 };
        vec![frame]
    };
    (0..40).map(frame).collect()
}

#[test]
fn slide_counts_over_the_middle_of_each_contact() {
    let measures = measured("slide", &walker(9.0), &sliding());
    check(measures.planted_slide_cm_s.unwrap(), 3.0);
    check(measures.examples_slide_cm_s.unwrap(), 2.0);
    check(measures.planted_share, 20.0 / 80.0);
}

#[test]
fn feet_at_the_goal_do_not_dilute_the_slide() {
    // After its arrival the body stands on its left foot as long as it walked.
    let mut frames = sliding();
    let there = AgentFrame { contacts: [1.0, 0.0], ..frames[39][0] };
    frames.extend(vec![vec![there]; 40]);
    let goal_x = there.root.position_m.x + 0.49;
    let measures = measured("slide_arrived", &walker(goal_x), &frames);
    assert_eq!(measures.arrived, 1);
    check(measures.planted_slide_cm_s.unwrap(), 3.0);
    check(measures.planted_share, 20.0 / 80.0);
}

#[test]
fn a_contact_cut_short_by_the_end_counts() {
    let measures = measured("slide_cut", &walker(9.0), &sliding()[..27]);
    check(measures.planted_slide_cm_s.unwrap(), 3.0);
}

#[test]
fn foot_rolling_over_toe_does_not_slide() {
    // The heel rises about the toe tip, which the body's motion keeps fixed.
    let tip_m = |frame: &AgentFrame| {
        let skeleton = common::skeleton();
        frame.pose.forward_kinematics(&skeleton).sole_points_m(&skeleton, 0)[2]
    };
    let rolling = |step: i32| {
        let mut frame = standing_at(Vec2::ZERO);
        frame.contacts = [1.0, 0.0];
        frame.pose.rotations[Joint::LeftFoot.index()] = Quat::from_rotation_y(0.02 * step as f32);
        let off_m = tip_m(&frame) - tip_m(&standing_at(Vec2::ZERO));
        frame.pose.pelvis_m -= off_m;
        vec![frame]
    };
    let frames: Vec<_> = (1..30).map(rolling).collect();
    let slide = measured("roll", &walker(9.0), &frames).planted_slide_cm_s.unwrap();
    assert!(slide < 0.05, "{slide} cm/s");
}

#[test]
fn without_soles_the_lowest_joint_is_the_contact_point() {
    // Foot flat: ankle and ball are both at their planted heights, and the ankle comes first. Heel up: the ball, which
    // is fixed, takes over.
    let mut header = walker(9.0);
    let toe_end_m = header.skeleton().segment_ends_m[Joint::LeftToe.index()];
    let joints_m = [Vec3::ZERO, header.skeleton().offsets_m[Joint::LeftToe.index()], toe_end_m];
    header.databases[0].skeleton.feet.iter_mut().for_each(|foot| foot.measured_m = joints_m);
    let ball_m =
        |frame: &AgentFrame| frame.pose.forward_kinematics(header.skeleton()).positions_m[Joint::LeftToe.index()];
    let rolling = |step: i32| {
        let mut frame = standing_at(Vec2::ZERO);
        frame.contacts = [1.0, 0.0];
        frame.pose.rotations[Joint::LeftFoot.index()] = Quat::from_rotation_y(0.05 + 0.02 * step as f32);
        frame.pose.rotations[Joint::LeftToe.index()] = Quat::from_rotation_y(-0.05 - 0.02 * step as f32);
        let off_m = ball_m(&frame) - ball_m(&standing_at(Vec2::ZERO));
        frame.pose.pelvis_m -= off_m;
        vec![frame]
    };
    let frames: Vec<_> = (1..30).map(rolling).collect();
    let slide = measured("joints", &header, &frames).planted_slide_cm_s.unwrap();
    assert!(slide < 0.05, "{slide} cm/s");
}

#[test]
fn trajectories_have_a_line_per_frame() {
    let header = header(vec![agent([0.0, 0.0], [5.0, 0.0]), agent([9.0, 0.0], [5.0, 0.0])], DT_S);
    let frames = vec![vec![standing_at(Vec2::new(1.0, 2.0)), standing_at(Vec2::new(-0.5, 0.25))]; 2];
    let recording = record(&folder("trajectories").join("a.fbrec"), &header, &frames);
    let mut text = Vec::new();
    write_trajectories(&recording, &mut text).unwrap();
    let line = "1.000000 2.000000 -0.500000 0.250000\n";
    assert_eq!(String::from_utf8(text).unwrap(), line.repeat(2));
}

#[test]
fn a_thousand_agents_are_measured() {
    let agents = (0..1000).map(|i| agent([(i % 40) as f32, (i / 40) as f32], [0.0, 0.0])).collect();
    let frame = |step: i32| {
        (0..1000).map(move |i| standing_at(Vec2::new((i % 40) as f32 + 0.04 * step as f32, (i / 40) as f32)))
    };
    let frames: Vec<Vec<AgentFrame>> = (0..30).map(|step| frame(step).collect()).collect();
    let path = folder("thousand").join("a.fbrec");
    let recording = record(&path, &header(agents, 1.0 / 30.0), &frames);
    let begin = std::time::Instant::now();
    assert_eq!(measure(&recording).unwrap().collision_rate, 0.0);
    let size = std::fs::metadata(&path).unwrap().len() as f64;
    println!(
        "{:.1} ms a frame, {:.1} bytes an agent and frame",
        begin.elapsed().as_secs_f64() * 1e3 / 30.0,
        size / 30e3
    );
}

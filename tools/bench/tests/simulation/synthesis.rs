//! Bodies that follow changing commands by blending: feet hold, soles stay on the ground, bodies come to rest.

use std::f32::consts::FRAC_PI_2;
use std::path::Path;
use std::sync::Arc;

use fbcrowd_sim::measures::{FootSlide, PlantedSlide};
use fbcrowd_sim::planning::Plan;
use fbcrowd_sim::recording::AgentFrame;
use fbcrowd_sim::scenario;
use fbcrowd_sim::simulation::Simulation;
use fbcrowd_sim::synthesis::SynthesisContext;
use fbcrowd_sim::synthesis::TimeStep;
use fbcrowd_sim::synthesis::{Body, BodyOutput};
use fbcrowd_sim::synthesis::{HmsParams, Modes};
use fbcrowd_sim::world::obstacles::Obstacles;
use glam::{Quat, Vec2};
use motiondb::body::Joint;
use motiondb::body::Root;
use motiondb::motion::MotionDb;

use super::clips::{bundled, marine};

const DT_S: f32 = 1.0 / 30.0;
const SECONDS: f32 = 16.0;
/// Starts, turns to both sides, a side-step, a step back, and a stop.
fn command_sequence(time_s: f32, root: &Root) -> Plan {
    let towards = |angle_rad: f32, speed_mps: f32| Plan {
        velocity_mps: Vec2::from_angle(angle_rad) * speed_mps,
        facing_rad: angle_rad,
        ..Plan::default()
    };
    let held = |velocity_mps| Plan { velocity_mps, facing_rad: root.facing_rad, ..Plan::default() };
    match time_s {
        t if t < 0.5 => held(Vec2::ZERO),
        t if t < 3.0 => towards(0.0, 1.3),
        t if t < 5.0 => towards(FRAC_PI_2, 1.3),
        t if t < 7.0 => towards(-2.0, 0.8),
        t if t < 8.5 => held(root.forward().perp() * 0.45),
        t if t < 10.0 => held(root.forward() * -0.5),
        t if t < 12.0 => towards(0.0, 1.5),
        _ => held(Vec2::ZERO),
    }
}

/// One body at each of eight phases follows the command sequence; `observe` gets every step.
fn walk(db: &MotionDb, mut observe: impl FnMut(&Root, &BodyOutput)) -> FootSlide {
    let context =
        SynthesisContext::new(Arc::new(db.clone()), HmsParams { modes: Modes::Blending, ..HmsParams::default() });
    let start = |index: usize| Body::standing(&context, Root::default(), index as f32 / 8.0);
    let mut bodies: Vec<Body> = (0..8).map(|index| start(index).0).collect();
    let mut slide = PlantedSlide::new(bodies.len(), DT_S);
    let time_step = TimeStep::new(DT_S);
    for step in 0..(SECONDS / DT_S) as usize {
        let frames = bodies.iter_mut().map(|body| {
            body.advance(&context, &command_sequence(step as f32 * DT_S, &body.root), &time_step);
            let synthesis = body.synthesize(&context, &time_step);
            observe(&body.root, &synthesis);
            AgentFrame {
                root: body.root,
                contacts: synthesis.contacts,
                examples_slide_cm_s: synthesis.examples_slide_cm_s,
                pose: synthesis.pose,
                ..AgentFrame::default()
            }
        });
        let frames: Vec<AgentFrame> = frames.collect();
        let joints: Vec<_> = frames.iter().map(|frame| frame.pose.forward_kinematics(&db.skeleton)).collect();
        slide.push(&db.skeleton, &frames, &joints);
    }
    slide.finish()
}

#[test]
fn feet_of_the_bundled_clips_hold_through_changes() {
    let slide = walk(&bundled(), |_, _| {});
    assert!(slide.slide_cm_s.unwrap() <= 1.0 && slide.planted_share > 0.5, "{slide:?}");
}

#[test]
#[ignore = "needs other people's clips: set FBCROWD_MOCAP"]
fn feet_slide_less_than_in_real_clips() {
    let slide = walk(&marine(), |_, _| {});
    assert!(slide.slide_cm_s.unwrap() < slide.examples_slide_cm_s.unwrap(), "{slide:?}");
}

/// No sole sinks into the ground, and no body crouches.
fn check_height(db: &MotionDb) {
    let lowest_pelvis_m = db.rows.pelvis_m.iter().map(|pelvis| pelvis.z).fold(f32::INFINITY, f32::min);
    walk(db, |_, synthesis| {
        let joints = synthesis.pose.forward_kinematics(&db.skeleton);
        let soles_m = [0, 1].map(|side| joints.sole_points_m(&db.skeleton, side));
        assert!(soles_m.iter().flatten().all(|point| point.z > -0.005), "{soles_m:?}");
        assert!(synthesis.pose.pelvis_m.z > lowest_pelvis_m - 0.05, "{}", synthesis.pose.pelvis_m);
    });
}

#[test]
fn no_sole_sinks_and_no_body_crouches() {
    check_height(&bundled());
}

#[test]
#[ignore = "needs other people's clips: set FBCROWD_MOCAP"]
fn soles_and_pelvis_stay_up_with_real_clips() {
    check_height(&marine());
}

#[test]
fn knees_neither_snap_nor_lock() {
    let db = bundled();
    let mut knees_rad = vec![Vec::new(); 8];
    let mut count = 0;
    walk(&db, |_, synthesis| {
        let knee_rad = |shank: Joint| synthesis.pose.rotations[shank.index()].angle_between(Quat::IDENTITY);
        knees_rad[count % 8].push(Joint::SHANKS.map(knee_rad));
        count += 1;
    });
    for (earlier, later) in knees_rad.iter().flat_map(|body| body.iter().zip(&body[1..])) {
        for side in 0..2 {
            assert!(earlier[side] > 0.1, "{} rad", earlier[side]); // a leg of full length has 0.09
            let speed_rad_s = (later[side] - earlier[side]).abs() / DT_S;
            assert!(speed_rad_s < 10.0, "{speed_rad_s} rad/s"); // a runner's swing has 8.5, a reversal from a step back 9.7
        }
    }
}

/// A body that has stopped rests.
fn check_rest(db: &MotionDb) {
    let mut roots = Vec::new();
    walk(db, |root, _| roots.push(*root));
    let (before, last) = (&roots[roots.len() - 16..roots.len() - 8], &roots[roots.len() - 8..]);
    assert_eq!(before, last);
}

#[test]
fn a_body_that_has_stopped_rests() {
    check_rest(&bundled());
}

#[test]
#[ignore = "needs other people's clips: set FBCROWD_MOCAP"]
fn a_body_that_has_stopped_rests_with_real_clips() {
    check_rest(&marine());
}

#[test]
fn all_agents_leave_the_room_outside_the_walls() {
    let file = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../assets/scenarios/bottleneck.toml");
    let (scenario, _) = scenario::file::read(&file).unwrap();
    let obstacles = Obstacles::new(&scenario.obstacles_m);
    let mut simulation = Simulation::new(Arc::new(bundled()), &scenario);
    let mut arrived = vec![false; scenario.agents.len()];
    for _ in 0..(scenario.duration_s / scenario.dt_s) as usize {
        simulation.step(&mut |_| {});
        for ((frame, agent), arrived) in simulation.frames().iter().zip(&scenario.agents).zip(&mut arrived) {
            let position_m = frame.root.position_m;
            assert!(obstacles.depth_m(position_m, agent.wall_radius_m) == 0.0, "{position_m}");
            *arrived |= position_m.distance(*agent.goals_m.last().unwrap()) < 0.5;
        }
    }
    // The wall of the door ends at 0.2 m.
    assert!(simulation.frames().iter().all(|frame| frame.root.position_m.x > 1.0));
    // Goals are 0.9 m apart: two agents that stand at theirs may close the way to the goal between them.
    let short = arrived.iter().filter(|&&arrived| !arrived).count();
    assert!(short <= 1, "{short} agents end before their goals");
}

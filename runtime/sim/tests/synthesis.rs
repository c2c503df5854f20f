//! Synthesised bodies on compiled clips: the bundled ones, and recordings of people where they are available.

mod clips;

use std::f32::consts::FRAC_PI_2;
use std::path::Path;
use std::sync::Arc;

use fbcrowd_sim::measures::{FootSlide, PlantedSlide};
use fbcrowd_sim::planning::Plan;
use fbcrowd_sim::recording::AgentFrame;
use fbcrowd_sim::scenario;
use fbcrowd_sim::simulation::Simulation;
use fbcrowd_sim::synthesis::{Body, BodyOutput, HmsParams, Modes, SynthesisContext, TimeStep};
use fbcrowd_sim::world::obstacles::Obstacles;
use glam::{Quat, Vec2};
use motiondb::body::{Joint, Root};
use motiondb::motion::MotionDb;

use crate::clips::{bundled, marine};

const DT_S: f32 = 1.0 / 30.0;
const SECONDS: f32 = 16.0;

/// Start, turns to both sides, a side-step, a step back, and a stop: every change of speed and direction.
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

/// Lets one body at each of eight phases follow the command sequence; `observe` receives every step.
fn walk(db: &MotionDb, mut observe: impl FnMut(&Root, &BodyOutput)) -> FootSlide {
    let context =
        SynthesisContext::new(Arc::new(db.clone()), HmsParams { modes: Modes::Blending, ..HmsParams::default() });
    let start = |index: usize| Body::standing(&context, Root::default(), index as f32 / 8.0);
    let mut bodies: Vec<Body> = (0..8).map(|index| start(index).0).collect();
    let mut slide = PlantedSlide::new(&db.skeleton, bodies.len(), DT_S);
    let time_step = TimeStep::new(DT_S);
    for step in 0..(SECONDS / DT_S) as usize {
        let frames = bodies.iter_mut().map(|body| {
            body.advance(&context, &command_sequence(step as f32 * DT_S, &body.root), &time_step);
            let output = body.synthesize(&context, &time_step);
            observe(&body.root, &output);
            AgentFrame {
                root: body.root,
                contacts: output.contacts,
                examples_slide_cm_s: output.examples_slide_cm_s,
                pose: output.pose,
                ..AgentFrame::default()
            }
        });
        let frames: Vec<AgentFrame> = frames.collect();
        let joints: Vec<_> = frames.iter().map(|frame| frame.pose.forward_kinematics(&db.skeleton)).collect();
        slide.push(&frames, &joints);
    }
    slide.finish()
}

#[test]
fn feet_of_bundled_clips_hold_through_every_change() {
    let slide = walk(&bundled(), |_, _| {});
    assert!(slide.slide_cm_s.unwrap() <= 1.0 && slide.planted_share > 0.5, "{slide:?}");
}

#[test]
fn feet_of_real_clips_slide_less_than_in_the_clips() {
    let Some(db) = marine("feet_of_real_clips_slide_less_than_in_the_clips") else { return };
    let slide = walk(&db, |_, _| {});
    assert!(slide.slide_cm_s.unwrap() < slide.examples_slide_cm_s.unwrap(), "{slide:?}");
}

#[test]
fn no_sole_sinks_and_no_body_crouches() {
    let databases = [Some(bundled()), marine("no_sole_sinks_and_no_body_crouches")];
    for db in databases.into_iter().flatten() {
        let lowest_pelvis_m = db.rows.pelvis_m.iter().map(|pelvis| pelvis.z).fold(f32::INFINITY, f32::min);
        walk(&db, |_, output| {
            let joints = output.pose.forward_kinematics(&db.skeleton);
            let soles_m = [0, 1].map(|side| joints.sole_points_m(&db.skeleton, side));
            assert!(soles_m.iter().flatten().all(|point| point.z > -0.005), "{soles_m:?}");
            assert!(output.pose.pelvis_m.z > lowest_pelvis_m - 0.05, "{}", output.pose.pelvis_m);
        });
    }
}

#[test]
fn knees_neither_snap_nor_lock() {
    let db = bundled();
    let mut knees_rad = vec![Vec::new(); 8];
    let mut observed = 0;
    walk(&db, |_, output| {
        let knee_rad = |shank: Joint| output.pose.rotations[shank.index()].angle_between(Quat::IDENTITY);
        knees_rad[observed % 8].push(Joint::SHANKS.map(knee_rad));
        observed += 1;
    });
    for (earlier, later) in knees_rad.iter().flat_map(|body| body.iter().zip(&body[1..])) {
        for side in 0..2 {
            assert!(earlier[side] > 0.1, "{} rad", earlier[side]); // 0.09 at the full length of the leg
            let speed_rad_s = (later[side] - earlier[side]).abs() / DT_S;
            // 8.5 in a runner's swing, 9.7 in a reversal from a step back.
            assert!(speed_rad_s < 10.0, "{speed_rad_s} rad/s");
        }
    }
}

#[test]
fn a_stopped_body_rests() {
    let databases = [Some(bundled()), marine("a_stopped_body_rests")];
    for db in databases.into_iter().flatten() {
        let mut roots = Vec::new();
        walk(&db, |root, _| roots.push(*root));
        let (before, last) = (&roots[roots.len() - 16..roots.len() - 8], &roots[roots.len() - 8..]);
        assert_eq!(before, last);
    }
}

#[test]
fn all_agents_leave_the_room_outside_its_walls() {
    let file = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../assets/scenarios/bottleneck.toml");
    let (scenario, _) = scenario::file::read(&file).unwrap();
    let obstacles = Obstacles::new(&scenario.obstacles_m);
    let mut simulation = Simulation::new(Arc::new(bundled()), &scenario);
    let mut arrived = vec![false; scenario.agents.len()];
    for _ in 0..(scenario.duration_s / scenario.dt_s) as usize {
        simulation.step(&mut |_| {});
        for ((frame, agent), arrived) in simulation.frames().iter().zip(&scenario.agents).zip(&mut arrived) {
            let position_m = frame.root.position_m;
            let clamped_m = obstacles.clamp_outside(position_m, agent.radius_m);
            assert!(clamped_m.distance(position_m) < 1e-3, "{position_m}");
            *arrived |= position_m.distance(*agent.goals_m.last().unwrap()) < 0.5;
        }
    }
    assert!(arrived.iter().all(|&arrived| arrived), "{arrived:?}");
}

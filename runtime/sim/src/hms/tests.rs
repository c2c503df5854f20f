//! Claims about whole bodies, on the analytic database of [`crate::test_db`].

use std::f32::consts::{FRAC_PI_2, PI, TAU};

use glam::{Vec2, Vec3};
use motiondb::motion_db::MotionDb;
use motiondb::pose::Root;
use proptest::prelude::*;

use super::asked::Space;
use super::params::HmsParams;
use super::{Body, Motion, Synthesis};
use crate::plan::Plan;
use crate::test_db::test_db;

const DT_S: f32 = 1.0 / 30.0;

struct Walk {
    db: MotionDb,
    steps: Vec<(Root, Synthesis)>,
}

/// Lets a body follow a plan that depends on time and on where it is.
fn walk(seconds: f32, dt_s: f32, plan: impl Fn(f32, &Root) -> Plan) -> Walk {
    let db = test_db();
    let (space, params) = (Space::new(&db), HmsParams::default());
    let motion = Motion { db: &db, space: &space, params: &params };
    let (mut body, first) = Body::standing(&motion, Root::default(), 0.3);
    let mut steps = vec![(body.root, first)];
    for step in 0..(seconds / dt_s) as usize {
        body.advance(&motion, &plan(step as f32 * dt_s, &body.root), dt_s);
        steps.push((body.root, body.synthesize(&motion, dt_s)));
    }
    Walk { db, steps }
}

fn towards(angle_rad: f32, speed_mps: f32) -> Plan {
    Plan { velocity_mps: Vec2::from_angle(angle_rad) * speed_mps, facing_rad: angle_rad, ..Plan::default() }
}

fn soles_m(walk: &Walk, side: usize) -> Vec<[Vec3; 3]> {
    let skeleton = &walk.db.skeleton;
    let sole = |(root, synthesis): &(Root, Synthesis)| {
        let points = synthesis.pose.forward_kinematics(skeleton).sole_points_m(skeleton, side);
        points.map(|point| root.to_world(point))
    };
    walk.steps.iter().map(sole).collect()
}

/// Planted-foot slide, cm/s, and planted share, as `definitions.md` measures them.
fn planted_slide(walk: &Walk, dt_s: f32) -> (f32, f32) {
    let (mut speeds, mut planted_steps) = (Vec::new(), 0);
    for side in 0..2 {
        let soles_m = soles_m(walk, side);
        let planted: Vec<bool> = walk.steps.iter().map(|step| step.1.contacts[side] >= 0.5).collect();
        planted_steps += planted.iter().filter(|&&planted| planted).count();
        let mut start = 0;
        for run in planted.chunk_by(|a, b| a == b) {
            let (first, margin) = (start, (run.len() as f32 * 0.1).round() as usize);
            start += run.len();
            if !run[0] {
                continue;
            }
            for step in (first + margin).max(1)..(first + run.len() - margin).min(soles_m.len() - 1) {
                let lowest = (0..3).min_by(|&a, &b| soles_m[step][a].z.total_cmp(&soles_m[step][b].z)).unwrap();
                let moved_m = soles_m[step + 1][lowest] - soles_m[step - 1][lowest];
                speeds.push(100.0 * moved_m.truncate().length() / (2.0 * dt_s));
            }
        }
    }
    (speeds.iter().sum::<f32>() / speeds.len() as f32, planted_steps as f32 / (2 * walk.steps.len()) as f32)
}

#[test]
fn probe() {
    let plan = |time_s: f32, root: &Root| match time_s {
        t if t < 0.5 => Plan::default(),
        t if t < 4.0 => towards(0.0, 1.3),
        t if t < 7.0 => towards(FRAC_PI_2, 1.3),
        t if t < 9.0 => towards(PI, 0.8),
        t if t < 11.0 => Plan { velocity_mps: Vec2::new(0.0, 0.5), facing_rad: PI, ..Plan::default() },
        _ => Plan { facing_rad: root.facing_rad, ..Plan::default() },
    };
    let walk = walk(13.0, DT_S, plan);
    println!("slide {:?}", planted_slide(&walk, DT_S));
    for (index, (root, synthesis)) in walk.steps.iter().enumerate() {
        let low = [0, 1].map(|side| soles_m(&walk, side)[index].iter().map(|p| p.z).fold(9.0, f32::min));
        println!(
            "{:6.3} {:6.3} {:6.3} facing {:6.3} contacts {:?} low {:.4} {:.4} pelvis {:.3}",
            index as f32 * DT_S,
            root.position_m.x,
            root.position_m.y,
            root.facing_rad,
            synthesis.contacts,
            low[0],
            low[1],
            synthesis.pose.pelvis_m.z
        );
    }
}

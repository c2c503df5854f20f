//! Whole bodies, on the analytic database of [`crate::test_db`].

use std::f32::consts::{FRAC_PI_2, TAU};
use std::sync::Arc;

use glam::{Vec2, Vec3};
use motiondb::body::{Joint, Root};
use motiondb::motion::{MotionDb, Parameters};
use proptest::prelude::*;

use crate::maths::arc::parameters_between;
use crate::planning::elbow_room::ElbowRoom;
use crate::planning::plan::{PLANTED_CONTACT, Plan};
use crate::synthesis::blending::{BlendDomain, ExampleMix};
use crate::synthesis::command::plan_requesting;
use crate::synthesis::{BodyOutput, HmsParams, Mode, Modes, SynthesisContext};
use crate::test_db::test_db;

const DT_S: f32 = 1.0 / 30.0;

struct Walk {
    db: Arc<MotionDb>,
    steps: Vec<(Root, BodyOutput)>,
}

/// Lets a body follow a plan of time and root, by blending alone.
fn walk(seconds: f32, dt_s: f32, plan: impl Fn(f32, &Root) -> Plan) -> Walk {
    let params = HmsParams { modes: Modes::Blending, ..HmsParams::default() };
    let context = SynthesisContext::new(Arc::new(test_db()), params);
    let steps = context.walk_alone(0.3, seconds, dt_s, plan, |body, output| (body.root, *output));
    Walk { db: context.db, steps }
}

fn towards(angle_rad: f32, speed_mps: f32) -> Plan {
    Plan { velocity_mps: Vec2::from_angle(angle_rad) * speed_mps, facing_rad: angle_rad, ..Plan::default() }
}

fn soles_m(walk: &Walk, side: usize) -> Vec<[Vec3; 3]> {
    let skeleton = &walk.db.skeleton;
    let sole = |(root, output): &(Root, BodyOutput)| {
        let points = output.pose.forward_kinematics(skeleton).sole_points_m(skeleton, side);
        points.map(|point| root.to_world(point))
    };
    walk.steps.iter().map(sole).collect()
}

/// Planted-foot slide over the middle of each contact, cm/s, and planted share, by the blended contacts.
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

/// Start, turns to both sides, a side-step, a step back, and a stop: every change of speed and direction.
fn command_sequence(time_s: f32, root: &Root) -> Plan {
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

#[test]
fn planted_feet_hold_through_every_change() {
    for dt_s in [1.0 / 60.0, DT_S, 0.1] {
        let walk = walk(14.0, dt_s, command_sequence);
        let (slide_cm_s, planted_share) = planted_slide(&walk, dt_s);
        assert!(slide_cm_s <= 1.0, "dt {dt_s}: {slide_cm_s} cm/s");
        assert!((0.5..0.8).contains(&planted_share), "dt {dt_s}: {planted_share}");
    }
}

#[test]
fn soles_stay_on_or_above_the_ground() {
    let walk = walk(14.0, DT_S, command_sequence);
    for side in 0..2 {
        let lowest_m = soles_m(&walk, side).into_iter().flatten().map(|point| point.z).fold(f32::INFINITY, f32::min);
        assert!(lowest_m > -0.005, "{lowest_m}");
    }
}

#[test]
fn feet_move_without_jumps() {
    let dt_s = 1.0 / 60.0;
    let walk = walk(14.0, dt_s, command_sequence);
    for side in 0..2 {
        let balls_m: Vec<Vec3> = soles_m(&walk, side).into_iter().map(|sole| sole[1]).collect();
        let fastest_mps = balls_m.windows(2).map(|pair| pair[0].distance(pair[1]) / dt_s).fold(0.0, f32::max);
        assert!(fastest_mps < 6.5, "{fastest_mps} m/s"); // four times the fastest walk
    }
}

#[test]
fn swinging_feet_move_back_from_a_wall_beside_the_body() {
    let farthest_m = |room: ElbowRoom| {
        let walk = walk(4.0, 1.0 / 60.0, |_, _| Plan { room, ..towards(0.0, 1.1) });
        soles_m(&walk, 0).iter().skip(60).flatten().map(|point_m| point_m.y).fold(f32::NEG_INFINITY, f32::max)
    };
    let free_m = farthest_m(ElbowRoom::default());
    let moved_m = free_m - farthest_m(ElbowRoom::ending_at([free_m * Vec2::Y]));
    assert!((0.01..0.1).contains(&moved_m), "{moved_m} of {free_m}");
}

#[test]
fn the_foot_on_the_side_makes_the_first_step() {
    for (angle_rad, side) in [(1.2, 0), (-1.2, 1)] {
        let walk = walk(1.0, DT_S, |_, _| Plan { facing_rad: 0.0, ..towards(angle_rad, 0.5) });
        let first = walk.steps.iter().find(|step| step.1.contacts != [1.0; 2] && step.1.stance.foot.is_some());
        assert_eq!(first.unwrap().1.stance.foot.unwrap().side, 1 - side, "towards {angle_rad}");
    }
}

#[test]
fn alternating_plans_do_not_make_a_body_tremble() {
    let plan = |time_s: f32, _: &Root| {
        let turned_rad = if (time_s / DT_S).round() as i32 % 2 == 0 { 0.1 } else { -0.1 };
        Plan { velocity_mps: Vec2::from_angle(turned_rad) * 1.3, ..towards(0.0, 1.3) }
    };
    let walk = walk(4.0, DT_S, plan);
    let aside_mps: Vec<f32> =
        walk.steps[60..].windows(2).map(|pair| (pair[1].0.position_m.y - pair[0].0.position_m.y) / DT_S).collect();
    let jump_mps = aside_mps.windows(2).map(|pair| (pair[1] - pair[0]).abs()).fold(0.0, f32::max);
    assert!(jump_mps < 0.1, "{jump_mps} m/s"); // of the plan's 0.26 m/s
}

#[test]
fn the_root_accelerates_within_limits() {
    let walk = walk(14.0, DT_S, command_sequence);
    let velocities: Vec<Vec2> =
        walk.steps.windows(2).map(|pair| (pair[1].0.position_m - pair[0].0.position_m) / DT_S).collect();
    let changes = velocities.windows(2).map(|pair| pair[0].distance(pair[1]) / DT_S);
    // 3 m/s² in the body's frame, and the greatest turn rate times the speed.
    assert!(changes.fold(0.0, f32::max) < 4.5);
    let even: Vec<f32> = velocities[60..85].iter().map(|velocity| velocity.length()).collect();
    assert!(even.iter().all(|speed| (speed - 1.3).abs() < 1e-3), "{even:?}");
}

#[test]
fn a_standing_body_turns_to_the_planned_facing() {
    let walk = walk(4.0, DT_S, |_, _| Plan { facing_rad: 2.5, ..Plan::default() });
    let root = walk.steps[walk.steps.len() - 1].0;
    assert!((root.facing_rad - 2.5).abs() < 0.2 && root.position_m.length() < 0.5, "{root:?}");
    assert!(planted_slide(&walk, DT_S).0 < 1.0);
}

#[test]
fn a_stopped_body_stands_upright_on_its_feet() {
    for stop_s in [2.0, 2.1, 2.2, 2.3, 2.4, 2.5, 2.6, 2.7] {
        let plan = |time_s: f32, _: &Root| towards(0.0, if time_s < stop_s { 1.4 } else { 0.0 });
        let walk = walk(6.0, DT_S, plan);
        let (first, last) = (&walk.steps[0].1, &walk.steps[walk.steps.len() - 1].1);
        let crouch_m = first.pose.pelvis_m.z - last.pose.pelvis_m.z;
        assert!(crouch_m < 0.03, "stopped at {stop_s}: {crouch_m} m");
        for side in 0..2 {
            let ball_m = |step: &BodyOutput| {
                step.pose.forward_kinematics(&walk.db.skeleton).sole_points_m(&walk.db.skeleton, side)[1]
            };
            let off_m = ball_m(first).distance(ball_m(last));
            assert!(off_m < 0.12, "stopped at {stop_s}: {off_m} m");
        }
    }
}

#[test]
fn a_stopping_body_soon_has_its_feet_together() {
    // The plan of an agent that has come to its goal fades by a factor of e in 0.4 s.
    let plan = |time_s: f32, _: &Root| towards(0.0, 1.3 * libm::expf(((3.0 - time_s) / 0.4).min(0.0)));
    for offset in 0..5 {
        let walk = walk(8.0, DT_S, |time_s, root| plan(time_s - 0.1 * offset as f32, root));
        let speeds_mps: Vec<f32> =
            walk.steps.windows(2).map(|pair| (pair[1].0.position_m - pair[0].0.position_m).length() / DT_S).collect();
        let braked = speeds_mps.iter().rposition(|&speed_mps| speed_mps > 0.5).unwrap();
        let is_in_air = |step: &(Root, BodyOutput)| step.1.contacts.iter().any(|contact| *contact < PLANTED_CONTACT);
        let landed = walk.steps.iter().rposition(is_in_air).unwrap();
        let closing_s = DT_S * (landed - braked) as f32;
        assert!(closing_s < 1.5, "{offset}: the last foot lands {closing_s} s after 0.5 m/s");
    }
}

/// Least time for which a foot stood before it lifted, s, of those that had landed.
fn shortest_stand_s(contacts: &[[f32; 2]], dt_s: f32) -> f32 {
    let stands = |side: usize| {
        let planted: Vec<bool> = contacts.iter().map(|contacts| contacts[side] >= PLANTED_CONTACT).collect();
        let runs: Vec<&[bool]> = planted.chunk_by(|a, b| a == b).collect();
        // Neither the first nor the last: its beginning or its end is not known.
        let inner = runs.get(1..runs.len() - 1).unwrap_or_default();
        inner.iter().filter(|run| run[0]).map(|run| run.len() as f32 * dt_s).fold(f32::INFINITY, f32::min)
    };
    stands(0).min(stands(1))
}

#[test]
fn a_foot_that_has_just_landed_stays_where_a_body_goes_on() {
    let params = HmsParams { modes: Modes::Blending, ..HmsParams::default() };
    let context = SynthesisContext::new(Arc::new(test_db()), params);
    for again_s in (0..24).map(|step| 2.4 + 0.05 * step as f32) {
        let plan = |time_s: f32, _: &Root| towards(0.0, if time_s < 2.0 || time_s > again_s { 1.0 } else { 0.0 });
        let contacts = context.walk_alone(0.3, again_s + 2.0, DT_S, plan, |_, output| output.contacts);
        let stood_s = shortest_stand_s(&contacts, DT_S);
        assert!(stood_s > 0.2, "goes on at {again_s} s: a foot lifts {stood_s} s after it has landed");
    }
}

#[test]
fn a_foot_in_the_air_does_not_land_where_slow_steps_change_to_blending() {
    let context = SynthesisContext::new(Arc::new(test_db()), HmsParams::default());
    for slower_s in (0..10).map(|step| 1.5 + 0.1 * step as f32) {
        // Something is near, so the body leaves semi-procedural locomotion only because it becomes slow.
        let plan = |time_s: f32, _: &Root| towards(0.0, if time_s < slower_s { 0.8 } else { 0.25 });
        let steps = context.walk_alone(0.3, 5.0, DT_S, plan, |body, _| {
            let motion = &body.motion;
            (motion.mode, motion.now(&context).active.contacts(&context, motion.phase))
        });
        let last = steps.iter().rposition(|(mode, _)| *mode == Mode::SemiProcedural).unwrap();
        let (before, after) = (steps[last].1, steps[last + 1].1);
        let swings = |side: &usize| before[*side] < PLANTED_CONTACT;
        let side = (0..2).find(swings).unwrap();
        assert!(after[side] < PLANTED_CONTACT, "slower at {slower_s} s: {before:?}, then {after:?}");
    }
}

#[test]
fn the_head_leads_the_body_into_a_turn() {
    for (dt_s, angle_rad) in [(1.0 / 60.0, FRAC_PI_2), (DT_S, -0.8), (0.1, FRAC_PI_2), (DT_S, -2.0)] {
        let walk = walk(6.0, dt_s, |time_s, _| towards(if time_s < 2.0 { 0.0 } else { angle_rad }, 1.2));
        let [body_s, head_s] = [0, 1].map(|of_head| {
            let halfway = |(root, output): &(Root, BodyOutput)| {
                let joints = output.pose.forward_kinematics(&walk.db.skeleton);
                let ahead = joints.orientations[Joint::Head.index()] * Vec3::X;
                let head_rad = libm::atan2f(ahead.y, ahead.x) * of_head as f32;
                (root.facing_rad + head_rad) / angle_rad > 0.5
            };
            walk.steps.iter().position(halfway).unwrap() as f32 * dt_s
        });
        let lead_s = body_s - head_s;
        assert!(lead_s > 0.2 - dt_s && lead_s < 0.5 + dt_s, "dt {dt_s}, {angle_rad} rad: {lead_s} s");
    }
}

#[test]
fn straight_stays_straight() {
    let walk = walk(10.0, DT_S, |_, _| towards(0.0, 1.1));
    assert!(walk.steps.iter().all(|(root, _)| root.position_m.y.abs() < 1e-4 && root.facing_rad.abs() < 1e-4));
}

#[test]
fn a_circle_closes() {
    let (turn_rate_rad_s, speed_mps, steps) = (1.2, 0.7, 200);
    let dt_s = TAU / turn_rate_rad_s / steps as f32;
    let lead_rad = turn_rate_rad_s * HmsParams::default().turn_time_s;
    // At a constant angle α ahead of the facing, the request is cos α of the planned speed.
    let plan = |_: f32, root: &Root| towards(root.facing_rad + lead_rad, speed_mps / libm::cosf(lead_rad));
    let walk = walk(12.0, dt_s, plan);
    let (from, to) = (walk.steps[walk.steps.len() - 1 - steps].0, walk.steps[walk.steps.len() - 1].0);
    assert!(from.position_m.distance(to.position_m) < 0.01, "{from:?} {to:?}");
}

#[test]
fn a_body_with_a_creeping_plan_stands_still() {
    let velocity_mps = |time_s: f32| Vec2::from_angle(3.0 * time_s) * 0.05;
    let walk =
        walk(4.0, DT_S, |time_s, _| Plan { velocity_mps: velocity_mps(time_s), facing_rad: 0.0, ..Plan::default() });
    assert!(walk.steps.iter().all(|(root, _)| root.position_m == Vec2::ZERO && root.facing_rad == 0.0));
}

#[test]
fn shares_of_time_hold_planted_feet() {
    let db = test_db();
    let mix = ExampleMix::new(&BlendDomain::new(&db).locate(Parameters { speed_mps: 0.8, ..Parameters::default() }));
    assert_eq!(mix.entries().len(), 2);
    let (small, speed_mps) = (1e-3, 0.8);
    for phase in [0.45, 0.5, 0.55] {
        let ball_m = |phase: f32| {
            let joints = mix.weights(&db, phase).pose(&db, phase).forward_kinematics(&db.skeleton);
            joints.sole_points_m(&db.skeleton, 0)[1]
        };
        let back_mps =
            (ball_m(phase - small) - ball_m(phase + small)).x / (2.0 * small) * mix.phase_rate_hz(&db, phase);
        assert!((back_mps - speed_mps).abs() < 0.02, "phase {phase}: {back_mps} m/s");
    }
}

proptest! {
    #[test]
    fn inside_the_hull_a_body_does_what_is_requested(weights in prop::array::uniform11(0.0f32..1.0)) {
        let db = test_db();
        let sum: f32 = weights[1..].iter().sum();
        let weighted = db.examples[1..].iter().zip(&weights[1..]);
        let terms = weighted.map(|(example, weight)| example.parameters.to_vec3() * *weight);
        let requested = Parameters::from_vec3(terms.sum::<Vec3>() / sum * (1.0 - 0.1 * weights[0]));
        prop_assume!(BlendDomain::new(&db).reachable(requested).idle_share < 0.3);
        let params = HmsParams::default();
        let plan = |_: f32, root: &Root| plan_requesting(requested, root, &params);
        let roots: Vec<Root> = walk(6.0, DT_S, plan).steps[120..].iter().map(|step| step.0).collect();
        let moves = roots.windows(2).map(|pair| parameters_between(&pair[0], &pair[1], DT_S).to_vec3());
        let mean = moves.sum::<Vec3>() / (roots.len() - 1) as f32;
        prop_assert!(mean.distance(requested.to_vec3()) < 2e-3, "{mean} instead of {requested:?}");
    }

    #[test]
    fn random_plans_give_valid_poses(plans in prop::collection::vec((any::<f32>(), any::<f32>(), any::<f32>()), 40)) {
        let plan = |time_s: f32, _: &Root| {
            let (x, y, facing_rad) = plans[(time_s / DT_S).round() as usize];
            Plan { velocity_mps: Vec2::new(x, y), facing_rad, ..Plan::default() }
        };
        for (root, output) in walk(1.3, DT_S, plan).steps {
            prop_assert!(root.position_m.is_finite() && root.facing_rad.is_finite());
            prop_assert!(output.pose.pelvis_m.is_finite());
            prop_assert!(output.pose.rotations.iter().all(|rotation| rotation.is_normalized()));
        }
    }
}

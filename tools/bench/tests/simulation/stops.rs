//! Starts, stops and reversals: no foot hangs in the air or is dragged, and a reversal keeps the stance foot planted.

use std::f32::consts::TAU;
use std::sync::Arc;

use fbcrowd_sim::planning::Plan;
use fbcrowd_sim::scenario::{AgentSpec, Scenario};
use fbcrowd_sim::simulation::Simulation;
use fbcrowd_sim::synthesis::SynthesisContext;
use fbcrowd_sim::synthesis::command::plan_requesting;
use fbcrowd_sim::synthesis::{HmsParams, Modes};
use glam::{Vec2, Vec3};
use motiondb::body::Root;
use motiondb::motion::MotionDb;
use motiondb::motion::Parameters;

use super::clips::{bundled, bundled_walk_and_idle, marine, marine_without};

const DT_S: f32 = 1.0 / 60.0;
/// Number of times within a stride at which a command changes.
const CHANGES: usize = 16;
/// Duration of a stride, s.
const STRIDE_S: f32 = 1.1;

/// Walk, run, side-step, step back, turn, stroll: v_f m/s, ω_t rad/s, ω_s m/s.
const GAITS: [[f32; 3]; 6] =
    [[1.2, 0.0, 0.0], [2.5, 0.0, 0.0], [0.0, 0.0, 0.4], [-0.5, 0.0, 0.0], [0.1, 1.5, 0.0], [0.3, 0.0, 0.0]];
/// Least height of a foot in the air, m.
const AIR_M: f32 = 0.02;
/// Greatest speed of a foot that hangs in the air, m/s.
const HANGS_MPS: f32 = 0.05;
/// Greatest height of a foot on the ground, m.
const GROUND_M: f32 = 0.005;
/// Least speed of a swinging foot that is dragged along the ground, m/s.
const DRAGS_MPS: f32 = 0.4;

/// One step of a body.
struct BodyStep {
    root: Root,
    contacts: [f32; 2],
    /// Heel, ball and toe tip of each foot, world.
    soles_m: [[Vec3; 3]; 2],
}

/// The steps of a body that follows a plan of time and root.
fn walk(context: &SynthesisContext, seconds: f32, plan: impl Fn(f32, &Root) -> Plan) -> Vec<BodyStep> {
    let skeleton = &context.db.skeleton;
    context.walk_alone(0.0, seconds, DT_S, plan, |body, synthesis| {
        let joints = synthesis.pose.forward_kinematics(skeleton);
        let soles_m = [0, 1].map(|side| joints.sole_points_m(skeleton, side).map(|point| body.root.to_world(point)));
        BodyStep { root: body.root, contacts: synthesis.contacts, soles_m }
    })
}

fn parameters([speed_mps, turn_rate_rad_s, strafe_mps]: [f32; 3]) -> Parameters {
    Parameters { speed_mps, turn_rate_rad_s, strafe_mps }
}

/// Longest durations in which a foot hangs in the air, and in which it is dragged along the ground, s.
fn faults_s(steps: &[BodyStep]) -> [f32; 2] {
    let mut longest_s = [0.0_f32; 2];
    for side in 0..2 {
        let mut lasting_s = [0.0_f32; 2];
        for pair in steps.windows(2) {
            let height_m = pair[1].soles_m[side].iter().fold(f32::INFINITY, |low, point| low.min(point.z));
            let speed_mps = (pair[1].soles_m[side][1] - pair[0].soles_m[side][1]).length() / DT_S;
            let swings = pair[1].contacts[side] < 0.5;
            let hangs = height_m > AIR_M && speed_mps < HANGS_MPS;
            let drags = swings && height_m < GROUND_M && speed_mps > DRAGS_MPS;
            for (fault, is_so) in [hangs, drags].into_iter().enumerate() {
                lasting_s[fault] = if is_so { lasting_s[fault] + DT_S } else { 0.0 };
                longest_s[fault] = longest_s[fault].max(lasting_s[fault]);
            }
        }
    }
    longest_s
}

fn context(db: MotionDb) -> SynthesisContext {
    SynthesisContext::new(Arc::new(db), HmsParams { modes: Modes::Blending, ..HmsParams::default() })
}

/// The paper's clips, all and without those that stand, turn in place or side-step.
fn real_contexts() -> Vec<(&'static str, SynthesisContext)> {
    let all = ("marine", context(marine()));
    let without = [("no idle", "Idle"), ("no turn in place", "Turn360"), ("no side-step", "Strafe")];
    std::iter::once(all).chain(without.map(|(name, word)| (name, context(marine_without(word))))).collect()
}

/// Positions of the balls of the feet in the root frame, m.
fn balls_m(step: &BodyStep) -> [Vec2; 2] {
    let ball_m = |side: usize| step.soles_m[side][1].truncate() - step.root.position_m;
    [0, 1].map(|side| Vec2::from_angle(-step.root.facing_rad).rotate(ball_m(side)))
}

#[track_caller]
fn check_stop(name: &str, context: &SynthesisContext, gait: [f32; 3], stop_s: f32) {
    let command = |time_s: f32| parameters(if time_s < stop_s { gait } else { [0.0; 3] });
    let plan = |time_s: f32, root: &Root| plan_requesting(command(time_s), root, &context.params);
    let steps = walk(context, stop_s + 3.0, plan);
    let after = &steps[(stop_s / DT_S) as usize..];
    let last = &after[after.len() - 1];
    let resting_s = DT_S * after.iter().filter(|step| step.root == last.root).count() as f32;
    assert!(resting_s > 1.4 && last.contacts == [1.0; 2], "{name} {gait:?} at {stop_s}: rests for {resting_s} s");
    let off_m = balls_m(last).into_iter().zip(balls_m(&steps[0])).map(|(ball_m, first_m)| ball_m.distance(first_m));
    assert!(off_m.fold(0.0, f32::max) < 0.1, "{name} {gait:?} at {stop_s}: {:?}", balls_m(last));
    check_feet(name, after);
}

#[track_caller]
fn check_feet(name: &str, steps: &[BodyStep]) {
    let [hangs_s, drags_s] = faults_s(steps);
    assert!(hangs_s < 0.1, "{name}: a foot hangs in the air for {hangs_s} s");
    // Toes that leave the ground gently stay low for up to 0.17 s.
    assert!(drags_s < 0.2, "{name}: a foot is dragged for {drags_s} s");
}

/// A body that stops finishes its step and stands on both feet.
fn check_stops(name: &str, context: &SynthesisContext) {
    for gait in GAITS {
        change_times_s().for_each(|stop_s| check_stop(name, context, gait, stop_s));
    }
}

#[test]
fn a_stop_ends_on_both_feet() {
    check_stops("bundled", &context(bundled()));
}

#[test]
#[ignore = "needs other people's clips: set FBCROWD_MOCAP"]
fn a_stop_ends_on_both_feet_with_real_clips() {
    real_contexts().iter().for_each(|(name, context)| check_stops(name, context));
}

/// Longest time from when the root of a body rests until its last foot has landed, s, over all phases of a stride.
fn longest_closing_s(modes: Modes, gait: [f32; 3]) -> f32 {
    let context = SynthesisContext::new(Arc::new(bundled()), HmsParams { modes, ..HmsParams::default() });
    let closing_s = |stop_s: f32| {
        let command = |time_s: f32| parameters(if time_s < stop_s { gait } else { [0.0; 3] });
        let plan = |time_s: f32, root: &Root| plan_requesting(command(time_s), root, &context.params);
        let steps = walk(&context, stop_s + 4.0, plan);
        let rests = |pair: &[BodyStep]| pair[0].root.position_m.distance(pair[1].root.position_m) < 0.05 * DT_S;
        let resting = steps.windows(2).rposition(|pair| !rests(pair)).unwrap_or(0);
        let lifted = steps.iter().rposition(|step| step.contacts != [1.0; 2]).unwrap_or(0);
        DT_S * lifted.saturating_sub(resting) as f32
    };
    change_times_s().map(closing_s).fold(0.0, f32::max)
}

#[test]
fn a_body_that_comes_to_rest_closes_its_feet_at_once() {
    for modes in [Modes::Blending, Modes::SemiProcedural] {
        for gait in [[1.2, 0.0, 0.0], [0.6, 0.0, 0.0]] {
            // A stance of 0.4 s, then a step of 0.38 s with each foot.
            let closing_s = longest_closing_s(modes, gait);
            assert!(closing_s < 1.25, "{modes:?} from {gait:?}: feet close {closing_s} s after the root rests");
        }
    }
}

/// A standing body starts in every direction.
fn check_starts(name: &str, context: &SynthesisContext) {
    for direction in 0..8 {
        let angle_rad = TAU * direction as f32 / 8.0;
        let velocity_mps = 0.9 * Vec2::from_angle(angle_rad);
        let steps = walk(context, 3.0, |_, _| Plan { velocity_mps, facing_rad: angle_rad, ..Plan::default() });
        let gained_m = steps[steps.len() - 1].root.position_m.dot(Vec2::from_angle(angle_rad));
        // Of 2.7 m; turning takes 1.5 s without a clip that turns in place.
        assert!(gained_m > 0.9, "{name} towards {angle_rad}: {gained_m} m");
        check_feet(name, &steps);
    }
}

#[test]
fn a_standing_body_starts_in_every_direction() {
    check_starts("bundled", &context(bundled()));
}

#[test]
#[ignore = "needs other people's clips: set FBCROWD_MOCAP"]
fn a_standing_body_starts_with_real_clips() {
    real_contexts().iter().for_each(|(name, context)| check_starts(name, context));
}

/// A plan that changes its velocity from `begin_s` on, at 2.5 m/s², and holds its facing; with its duration, s.
fn changing(from: Vec3, to: Vec3, begin_s: f32) -> (f32, impl Fn(f32, &Root) -> Plan) {
    let change_s = (to - from).length() / 2.5;
    let command = move |time_s: f32| from.lerp(to, ((time_s - begin_s) / change_s).clamp(0.0, 1.0));
    let plan = move |time_s: f32, _: &Root| {
        let Vec3 { x: ahead_mps, z: aside_mps, .. } = command(time_s);
        Plan { velocity_mps: Vec2::new(ahead_mps, aside_mps), ..Plan::default() }
    };
    (begin_s + change_s + 1.0, plan)
}

/// Times at which a command changes, at all phases of a stride, s.
fn change_times_s() -> impl Iterator<Item = f32> {
    (0..CHANGES).map(|change| 4.0 + STRIDE_S * change as f32 / CHANGES as f32)
}

#[test]
fn a_reversal_does_not_end_at_rest() {
    let context = context(bundled());
    let reversals = [([-0.5, 0.0, 0.0], [1.4, 0.0, 0.0]), ([1.1, 0.0, 0.0], [-0.5, 0.0, 0.0])];
    let sideways = [([0.0, 0.0, 0.3], [0.0, 0.0, -0.3]), ([0.0, 0.0, -0.3], [0.0, 0.0, 0.3])];
    for (from, to) in reversals.into_iter().chain(sideways) {
        let [from, to] = [Vec3::from(from), Vec3::from(to)];
        for (begin_s, dt_s) in change_times_s().flat_map(|begin_s| [1.0 / 120.0, DT_S, 0.1].map(|dt_s| (begin_s, dt_s)))
        {
            let (seconds, plan) = changing(from, to, begin_s);
            let roots = context.walk_alone(0.0, seconds, dt_s, plan, |body, _| body.root);
            let [before, last] = [&roots[roots.len() - 2], &roots[roots.len() - 1]];
            let walked_mps = (last.position_m - before.position_m) / dt_s;
            let off_mps = walked_mps.distance(Vec2::new(to.x, to.z));
            assert!(
                off_mps < 0.1,
                "from {from} to {to} at {begin_s} s in steps of {dt_s} s: walks at {walked_mps} m/s"
            );
        }
    }
}

/// Mean distance by which hips come down from standing in a reversal, over all phases of a stride, m.
fn mean_lowering_m(context: &SynthesisContext, from: Vec3, to: Vec3) -> f32 {
    let lowering_m = |begin_s: f32| {
        let (seconds, plan) = changing(from, to, begin_s);
        let hips_m = context.walk_alone(0.0, seconds, DT_S, plan, |_, synthesis| synthesis.pose.pelvis_m.z);
        hips_m[0] - hips_m[(begin_s / DT_S) as usize..].iter().copied().fold(f32::INFINITY, f32::min)
    };
    change_times_s().map(lowering_m).sum::<f32>() / CHANGES as f32
}

#[test]
fn a_reversal_keeps_the_stance_foot_planted() {
    let [back, ahead] = [Vec3::new(-0.5, 0.0, 0.0), Vec3::new(1.1, 0.0, 0.0)];
    // On the wrong foot, with a phase that goes on, it is 10 and 12 cm, and 7 and 5.
    for (modes, limits_m) in [(Modes::Blending, [0.08, 0.055]), (Modes::SemiProcedural, [0.08, 0.05])] {
        let context = SynthesisContext::new(Arc::new(bundled()), HmsParams { modes, ..HmsParams::default() });
        for (from, to, limit_m) in [(back, ahead, limits_m[0]), (ahead, back, limits_m[1])] {
            let lowering_m = mean_lowering_m(&context, from, to);
            assert!(lowering_m < limit_m, "{modes:?} from {from} to {to}: hips come down by {lowering_m} m");
        }
    }
}

#[test]
#[ignore = "needs other people's clips: set FBCROWD_MOCAP"]
fn a_side_step_without_a_clip_moves_no_body() {
    let db = marine_without("Strafe");
    let context = SynthesisContext::of_complete(Arc::new(db), HmsParams::default());
    let steps = walk(&context, 3.0, |_, _| Plan { velocity_mps: Vec2::new(0.0, 0.5), ..Plan::default() });
    assert!(steps.iter().all(|step| step.root == Root::default()));
}

/// A standing body, which may be made of steps, stands on the ground.
fn check_standing(name: &str, context: &SynthesisContext) {
    let step = &walk(context, 0.1, |_, root| plan_requesting(Parameters::default(), root, &context.params))[5];
    let heights_m = step.soles_m.as_flattened().iter().map(|point| point.z);
    let highest_m = heights_m.fold(0.0_f32, |highest_m, height_m| highest_m.max(height_m.abs()));
    assert!(highest_m < 0.04, "{name}: {:?}", step.soles_m);
}

#[test]
fn a_standing_body_stands_on_the_ground() {
    check_standing("bundled", &context(bundled()));
}

#[test]
#[ignore = "needs other people's clips: set FBCROWD_MOCAP"]
fn a_body_made_of_steps_stands_on_the_ground() {
    real_contexts().iter().for_each(|(name, context)| check_standing(name, context));
}

/// Distances by which lone bodies come to rest beyond their goals, m.
fn beyond_goals_m(db: MotionDb) -> Vec<f32> {
    let agent = |index: usize| {
        let position_m = Vec2::new(0.0, 5.0 * index as f32);
        AgentSpec {
            position_m,
            goals_m: vec![position_m + (6.0 + 0.17 * index as f32) * Vec2::X],
            radius_m: 0.25,
            wall_radius_m: 0.2,
            preferred_speed_mps: [0.9, 1.33, 1.6][index % 3],
            ..AgentSpec::default()
        }
    };
    let scenario = Scenario { duration_s: 15.0, dt_s: DT_S, ..Scenario::of((0..12).map(agent).collect()) };
    let mut simulation = Simulation::new(Arc::new(db), &scenario);
    for _ in 0..(scenario.duration_s / DT_S) as usize {
        simulation.step(&mut |_| {});
    }
    let frames = simulation.frames();
    frames.iter().zip(&scenario.agents).map(|(frame, agent)| (frame.root.position_m - agent.goals_m[0]).x).collect()
}

/// Checks that bodies rest at their goals on average, and none farther off than `off_max_m`: half of a closing step.
fn check_rests_at_goals(name: &str, db: MotionDb, off_max_m: f32) {
    let beyond_m = beyond_goals_m(db);
    let mean_m = beyond_m.iter().sum::<f32>() / beyond_m.len() as f32;
    assert!(mean_m.abs() < 0.06 && beyond_m.iter().all(|m| m.abs() < off_max_m), "{name}: {mean_m} m, {beyond_m:?}");
}

#[test]
fn lone_bodies_rest_at_their_goals() {
    check_rests_at_goals("bundled", bundled(), 0.1);
    check_rests_at_goals("a walk and an idle", bundled_walk_and_idle(), 0.25);
}

#[test]
#[ignore = "needs other people's clips: set FBCROWD_MOCAP"]
fn lone_bodies_rest_at_their_goals_with_real_clips() {
    check_rests_at_goals("Marine", marine(), 0.25);
}

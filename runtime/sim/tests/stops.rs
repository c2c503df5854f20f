//! Claims about starts, stops and turning back on compiled clips: no step is left in mid-air, no foot is dragged, and
//! who goes the other way does so on the feet that it has.

mod clips;

use std::f32::consts::TAU;
use std::sync::Arc;

use fbcrowd_sim::planning::Plan;
use fbcrowd_sim::synthesis::blending::Space;
use fbcrowd_sim::synthesis::command::asking;
use fbcrowd_sim::synthesis::library::Studio;
use fbcrowd_sim::synthesis::{HmsParams, Modes};
use glam::{Vec2, Vec3};
use motiondb::body::Root;
use motiondb::motion::{MotionDb, Parameters};

use crate::clips::{bundled, marine, marine_without};

const DT_S: f32 = 1.0 / 60.0;
/// Moments of a stride at which a body is told to stop.
const MOMENTS: usize = 16;
const STRIDE_S: f32 = 1.1;

/// Walk, run, side-step, step back, turn, stroll: (v_f, ω_t, ω_s).
const WAYS: [[f32; 3]; 6] =
    [[1.2, 0.0, 0.0], [2.5, 0.0, 0.0], [0.0, 0.0, 0.4], [-0.5, 0.0, 0.0], [0.1, 1.5, 0.0], [0.3, 0.0, 0.0]];
/// A foot this high is in the air, m, and hangs if it is slower than this, m/s.
const AIR_M: f32 = 0.02;
const HANGS_MPS: f32 = 0.05;
/// A swinging foot this low and this quick is dragged, m and m/s.
const GROUND_M: f32 = 0.005;
const DRAGS_MPS: f32 = 0.4;

/// One step of a body.
struct Step {
    root: Root,
    contacts: [f32; 2],
    /// Heel, ball and toe tip of each foot, world.
    soles_m: [[Vec3; 3]; 2],
}

fn go(studio: &Studio, seconds: f32, plan: impl Fn(f32, &Root) -> Plan) -> Vec<Step> {
    let skeleton = &studio.db.skeleton;
    studio.walk(0.0, seconds, DT_S, plan, |body, synthesis| {
        let joints = synthesis.pose.forward_kinematics(skeleton);
        let soles_m = [0, 1].map(|side| joints.sole_points_m(skeleton, side).map(|point| body.root.to_world(point)));
        Step { root: body.root, contacts: synthesis.contacts, soles_m }
    })
}

fn way([speed_mps, turn_rate_rad_s, strafe_mps]: [f32; 3]) -> Parameters {
    Parameters { speed_mps, turn_rate_rad_s, strafe_mps }
}

/// Longest times that a foot hangs still in the air, and that it is dragged along the ground, s.
fn faults_s(steps: &[Step]) -> [f32; 2] {
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

fn studio(db: MotionDb) -> Studio {
    Studio::new(Arc::new(db), HmsParams { modes: Modes::Blending, ..HmsParams::default() })
}

/// Both, and the paper's clips without those that stand, turn on the spot, or side-step.
fn studios(test: &str) -> Vec<(&'static str, Studio)> {
    let mut found = vec![("bundled", bundled())];
    found.extend(marine(test).map(|db| ("marine", db)));
    for (name, without) in [("no idle", "Idle"), ("no turn on the spot", "Turn360"), ("no side-step", "Strafe")] {
        found.extend(marine_without(test, without).map(|db| (name, db)));
    }
    found.into_iter().map(|(name, db)| (name, studio(db))).collect()
}

/// Where the balls of the feet are, from the root, in its frame.
fn balls_m(step: &Step) -> [Vec2; 2] {
    let ball_m = |side: usize| step.soles_m[side][1].truncate() - step.root.position_m;
    [0, 1].map(|side| Vec2::from_angle(-step.root.facing_rad).rotate(ball_m(side)))
}

#[track_caller]
fn check_stop(name: &str, studio: &Studio, asked: [f32; 3], stop_s: f32) {
    let asked_at = |time_s: f32| way(if time_s < stop_s { asked } else { [0.0; 3] });
    let plan = |time_s: f32, root: &Root| asking(asked_at(time_s), root, &studio.params);
    let steps = go(studio, stop_s + 3.0, plan);
    let after = &steps[(stop_s / DT_S) as usize..];
    let last = &after[after.len() - 1];
    let resting_s = DT_S * after.iter().filter(|step| step.root == last.root).count() as f32;
    assert!(resting_s > 1.4 && last.contacts == [1.0; 2], "{name} {asked:?} at {stop_s}: rests for {resting_s} s");
    let off_m = balls_m(last).into_iter().zip(balls_m(&steps[0])).map(|(ball_m, first_m)| ball_m.distance(first_m));
    assert!(off_m.fold(0.0, f32::max) < 0.25, "{name} {asked:?} at {stop_s}: {:?}", balls_m(last));
    check_feet(name, after);
}

#[track_caller]
fn check_feet(name: &str, steps: &[Step]) {
    let [hangs_s, drags_s] = faults_s(steps);
    assert!(hangs_s < 0.1, "{name}: a foot hangs in the air for {hangs_s} s");
    // Toes that leave the ground gently stay low for up to 0.17 s.
    assert!(drags_s < 0.2, "{name}: a foot is dragged for {drags_s} s");
}

#[test]
fn whoever_is_told_to_stop_finishes_the_step_and_stands_on_both_feet() {
    for (name, studio) in studios("whoever_is_told_to_stop_finishes_the_step_and_stands_on_both_feet") {
        for asked in WAYS {
            for moment in 0..MOMENTS {
                check_stop(name, &studio, asked, 4.0 + STRIDE_S * moment as f32 / MOMENTS as f32);
            }
        }
    }
}

#[test]
fn whoever_stands_starts_in_every_direction() {
    for (name, studio) in studios("whoever_stands_starts_in_every_direction") {
        for direction in 0..8 {
            let angle_rad = TAU * direction as f32 / 8.0;
            let velocity_mps = 0.9 * Vec2::from_angle(angle_rad);
            let steps = go(&studio, 3.0, |_, _| Plan { velocity_mps, facing_rad: angle_rad, ..Plan::default() });
            let gained_m = steps[steps.len() - 1].root.position_m.dot(Vec2::from_angle(angle_rad));
            // Of 2.7 m; turning about takes 1.5 s where nobody turns on the spot.
            assert!(gained_m > 0.9, "{name} towards {angle_rad}: {gained_m} m");
            check_feet(name, &steps);
        }
    }
}

/// Asked to change its way from `begin_s` on, at 2.5 m/s²; holds its facing.
fn changing(from: Vec3, to: Vec3, begin_s: f32) -> (f32, impl Fn(f32, &Root) -> Plan) {
    let change_s = (to - from).length() / 2.5;
    let asked = move |time_s: f32| from.lerp(to, ((time_s - begin_s) / change_s).clamp(0.0, 1.0));
    let plan = move |time_s: f32, _: &Root| {
        let Vec3 { x: ahead_mps, z: aside_mps, .. } = asked(time_s);
        Plan { velocity_mps: Vec2::new(ahead_mps, aside_mps), ..Plan::default() }
    };
    (begin_s + change_s + 1.0, plan)
}

/// Moments of a stride, s.
fn moments_s() -> impl Iterator<Item = f32> {
    (0..MOMENTS).map(|moment| 4.0 + STRIDE_S * moment as f32 / MOMENTS as f32)
}

#[test]
fn whoever_is_asked_to_go_the_other_way_does_not_stay_at_rest_on_the_way_there() {
    let studio = studio(bundled());
    let reversals = [([-0.5, 0.0, 0.0], [1.4, 0.0, 0.0]), ([1.1, 0.0, 0.0], [-0.5, 0.0, 0.0])];
    let sidewards = [([0.0, 0.0, 0.3], [0.0, 0.0, -0.3]), ([0.0, 0.0, -0.3], [0.0, 0.0, 0.3])];
    for (from, to) in reversals.into_iter().chain(sidewards) {
        let [from, to] = [Vec3::from(from), Vec3::from(to)];
        for (begin_s, dt_s) in moments_s().flat_map(|moment_s| [1.0 / 120.0, DT_S, 0.1].map(|dt_s| (moment_s, dt_s))) {
            let (seconds, plan) = changing(from, to, begin_s);
            let roots = studio.walk(0.0, seconds, dt_s, plan, |body, _| body.root);
            let [before, last] = [&roots[roots.len() - 2], &roots[roots.len() - 1]];
            let gone_mps = (last.position_m - before.position_m) / dt_s;
            let off_mps = gone_mps.distance(Vec2::new(to.x, to.z));
            assert!(off_mps < 0.1, "from {from} to {to} at {begin_s} s in steps of {dt_s} s: goes at {gone_mps} m/s");
        }
    }
}

/// How far hips come down below where they are in standing, m, the mean over the moments of a stride at which a body
/// turns back.
fn mean_lowering_m(studio: &Studio, from: Vec3, to: Vec3) -> f32 {
    let lowering_m = |begin_s: f32| {
        let (seconds, plan) = changing(from, to, begin_s);
        let hips_m = studio.walk(0.0, seconds, DT_S, plan, |_, synthesis| synthesis.pose.pelvis_m.z);
        hips_m[0] - hips_m[(begin_s / DT_S) as usize..].iter().copied().fold(f32::INFINITY, f32::min)
    };
    moments_s().map(lowering_m).sum::<f32>() / MOMENTS as f32
}

#[test]
fn whoever_goes_back_the_way_it_came_does_so_on_the_feet_that_it_has() {
    let [back, ahead] = [Vec3::new(-0.5, 0.0, 0.0), Vec3::new(1.1, 0.0, 0.0)];
    for modes in [Modes::Blending, Modes::SemiProcedural] {
        let studio = Studio::new(Arc::new(bundled()), HmsParams { modes, ..HmsParams::default() });
        // On the wrong feet, as where phases go on: 10 and 12 cm, and 7 and 5.
        for (from, to, limit_m) in [(back, ahead, 0.08), (ahead, back, 0.047)] {
            let lowering_m = mean_lowering_m(&studio, from, to);
            assert!(lowering_m < limit_m, "{modes:?} from {from} to {to}: hips come down by {lowering_m} m");
        }
    }
}

#[test]
fn nobody_is_led_astray_by_a_side_step_that_no_clip_has() {
    let Some(db) = marine_without("nobody_is_led_astray_by_a_side_step_that_no_clip_has", "Strafe") else { return };
    // As it is: completed, it has side-steps.
    let studio = Studio { space: Space::new(&db), hybrid: None, params: HmsParams::default(), db: Arc::new(db) };
    let steps = go(&studio, 3.0, |_, _| Plan { velocity_mps: Vec2::new(0.0, 0.5), ..Plan::default() });
    assert!(steps.iter().all(|step| step.root == Root::default()));
}

#[test]
fn a_standing_body_made_of_steps_stands_upright_on_the_ground() {
    for (name, studio) in studios("a_standing_body_made_of_steps_stands_upright_on_the_ground") {
        let step = &go(&studio, 0.1, |_, root| asking(Parameters::default(), root, &studio.params))[5];
        let heights_m = step.soles_m.as_flattened().iter().map(|point| point.z);
        let highest_m = heights_m.fold(0.0_f32, |highest_m, height_m| highest_m.max(height_m.abs()));
        assert!(highest_m < 0.04, "{name}: {:?}", step.soles_m);
    }
}

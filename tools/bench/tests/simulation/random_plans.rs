//! No plan breaks a body: with every synthesis, time step and threat of a collision.

use std::f32::consts::PI;
use std::sync::{Arc, LazyLock};

use fbcrowd_sim::planning::Plan;
use fbcrowd_sim::synthesis::SynthesisContext;
use fbcrowd_sim::synthesis::{HmsParams, Modes};
use glam::Vec2;
use motiondb::body::Joint;
use proptest::prelude::*;

use super::clips::bundled;

/// Number of plans, one after the other.
const PLANS: usize = 12;
/// Durations of a plan, s.
const PLAN_S: [f32; 3] = [0.15, 0.4, 1.2];
/// Time steps, s.
const STEPS_S: [f32; 3] = [1.0 / 120.0, 1.0 / 30.0, 0.1];
/// Greatest depth of a sole under the ground, m: a fifth of the limit of `fbcrowd bench quality`.
const SUNK_MAX_M: f32 = 1e-3;
/// Least flexion of a knee, rad: rounding.
const KNEE_MIN_RAD: f32 = -1e-2;
/// Least height of the pelvis, divided by that in standing: a deep crouch.
const CROUCH: f32 = 0.7;

static STUDIOS: LazyLock<[SynthesisContext; 3]> = LazyLock::new(|| {
    let db = Arc::new(bundled());
    [Modes::Blending, Modes::SemiProcedural, Modes::Hybrid]
        .map(|modes| SynthesisContext::new(Arc::clone(&db), HmsParams { modes, ..HmsParams::default() }))
});

/// Plans of human walks, and now and then any numbers.
fn plan() -> impl Strategy<Value = Plan> {
    let human = (0.0f32..2.2, -PI..PI, -PI..PI).prop_map(|(speed_mps, direction_rad, facing_rad)| Plan {
        velocity_mps: Vec2::from_angle(direction_rad) * speed_mps,
        facing_rad,
        ..Plan::default()
    });
    let any = (any::<f32>(), any::<f32>(), any::<f32>()).prop_map(|(x, y, facing_rad)| Plan {
        velocity_mps: Vec2::new(x, y),
        facing_rad,
        ..Plan::default()
    });
    let threat = prop_oneof![Just(f32::INFINITY), 0.0f32..3.0];
    (prop_oneof![9 => human.boxed(), 1 => any.boxed()], threat, 0.0f32..1.0)
        .prop_map(|(plan, time_to_collision_s, density)| Plan { time_to_collision_s, density, ..plan })
}

/// The fault of a body that follows plans, each for `plan_s`, and its time; none where nothing is wrong.
fn fault(context: &SynthesisContext, plans: &[Plan], plan_s: f32, phase: f32, dt_s: f32) -> Option<String> {
    let skeleton = &context.db.skeleton;
    let follow = |time_s: f32, _: &_| plans[((time_s / plan_s) as usize).min(plans.len() - 1)];
    let walked =
        context.walk_alone(phase, PLANS as f32 * plan_s, dt_s, follow, |body, synthesis| (body.root, synthesis.pose));
    let standing_m = walked[0].1.pelvis_m.z;
    walked.iter().enumerate().find_map(|(step, (root, pose))| {
        let joints = pose.forward_kinematics(skeleton);
        let sole_m = [0, 1].map(|side| joints.sole_points_m(skeleton, side).map(|point_m| point_m.z));
        let lowest_m = sole_m.as_flattened().iter().copied().fold(f32::INFINITY, f32::min);
        let knees_rad = Joint::SHANKS.map(|shank| {
            let turn = pose.rotations[shank.index()];
            2.0 * libm::atanf(turn.y / turn.w)
        });
        let wrong = if !root.position_m.is_finite() || !root.facing_rad.is_finite() || !pose.pelvis_m.is_finite() {
            "has no finite position".into()
        } else if !pose.rotations.iter().all(|rotation| rotation.is_normalized()) {
            "has no unit rotation".into()
        } else if lowest_m < -SUNK_MAX_M {
            format!("has a foot {lowest_m} m above the ground")
        } else if knees_rad.iter().any(|&knee_rad| knee_rad < KNEE_MIN_RAD) {
            format!("bends its knees by {knees_rad:?}")
        } else if pose.pelvis_m.z < CROUCH * standing_m {
            format!("crouches to {} m", pose.pelvis_m.z)
        } else {
            return None;
        };
        Some(format!("after {} s: {wrong}", step as f32 * dt_s))
    })
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(48))]

    #[test]
    fn no_plan_breaks_a_body(
        plans in prop::collection::vec(plan(), PLANS),
        plan_s in prop::sample::select(&PLAN_S),
        phase in 0.0f32..1.0,
    ) {
        for context in &*STUDIOS {
            for dt_s in STEPS_S {
                let found = fault(context, &plans, plan_s, phase, dt_s);
                prop_assert!(found.is_none(), "{:?}, dt {dt_s}: {}", context.params.modes, found.unwrap());
            }
        }
    }
}

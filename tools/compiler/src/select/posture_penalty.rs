//! Posture penalty of a gait: bent legs, a bent trunk, a raised arm, arms that carry, a limp. It is a speed, m/s, so that
//! it can be weighed against the speed of another gait.

use motiondb::statistics::mean;

use crate::cycle::gait_cycle::GaitCycle;
use crate::cycle::mirrored::mirrored_cycle;
use crate::retarget::human_clip::{HumanBody, HumanJoints};
use crate::rig::body_angles::{arms_deg, trunk_lean_deg};

/// Least height of the hips over the ankle of the straighter leg without penalty, leg lengths; mean over the cycle.
/// Walks of the development set: 0.91 to 0.98 straight on, 0.90 in a quick curve.
const STRAIGHT_LEGS: f64 = 0.9;
/// Penalty of lower hips, m/s a leg length: hips at 0.86 leg lengths cost 0.6 m/s.
const BENT_LEGS_MPS: f64 = 15.0;
/// Greatest lean of the trunk without penalty, degrees; mean over the cycle.
const LEAN_DEG: f64 = 15.0;
/// Penalty of a deeper lean, m/s a degree, beside that of its effort: one of 45° costs 0.9 m/s.
const LEAN_MPS: f64 = 0.03;
/// Greatest angle of the higher wrist, seen from its shoulder, off straight down without penalty, degrees; mean over the
/// cycle. In runs, with bent elbows, this angle reaches 50.
const ARM_DEG: f64 = 60.0;
/// Penalty of a higher arm, m/s a degree, beside that of its effort: a level arm costs 0.3 m/s.
const ARM_MPS: f64 = 0.01;
/// Penalty of arms and trunk that are held, m/s for an effort of 1 ([`Carriage::effort`](crate::rig::carriage::Carriage)):
/// a body that carries a box loses to one that walks, at equal speed.
const EFFORT_MPS: f64 = 0.3;
/// Mean distance of the joints from the mirror image, half a cycle later, without penalty, m. Captured walks straight on: 0.015
/// to 0.033, with a limp 0.047 and more, with one arm held 0.06 and more.
const ONE_SIDED_M: f64 = 0.03;
/// Penalty of a greater distance, m/s a metre: a limp costs 0.2 m/s.
const ONE_SIDED_MPS: f64 = 10.0;

/// Penalty as bad as a flaw of 1, m/s: the width of a cell of near-equal rates.
const FLAW_MPS: f64 = 0.25;

/// The posture penalty of a gait, m/s; near 0 for a body that walks upright with hanging arms.
pub(crate) fn posture_penalty_mps(cycle: &GaitCycle, body: &HumanBody) -> f64 {
    let joints = cycle.joints(body);
    let mean_of = |value: &dyn Fn(&HumanJoints) -> f64| mean(joints.iter().map(value)).unwrap_or_default();
    let legs = mean_of(&straighter_leg_m) / body.leg_length_m();
    let lean_deg = mean_of(&|joints| trunk_lean_deg(|joint| joints.position_m(joint)));
    let arm_deg = [0, 1].map(|side| mean_of(&|joints| arms_deg(|joint| joints.position_m(joint))[side]));
    let higher_arm_deg = arm_deg[0].max(arm_deg[1]);
    BENT_LEGS_MPS * (STRAIGHT_LEGS - legs).max(0.0)
        + LEAN_MPS * (lean_deg - LEAN_DEG).max(0.0)
        + ARM_MPS * (higher_arm_deg - ARM_DEG).max(0.0)
        + EFFORT_MPS * cycle.carriage(body).effort()
        + ONE_SIDED_MPS * (mirrored_cycle(cycle).distance_m(cycle, body) - ONE_SIDED_M).max(0.0)
}

/// The posture penalty as flaws of a window ([`crate::cycle::flaws`]).
pub(crate) fn posture_flaws(cycle: &GaitCycle, body: &HumanBody) -> f64 {
    posture_penalty_mps(cycle, body) / FLAW_MPS
}

/// Height of the hips over the ankle of the straighter leg, m.
fn straighter_leg_m(joints: &HumanJoints) -> f64 {
    let [left_m, right_m] = joints.hip_heights_m();
    left_m.max(right_m)
}

//! Posture penalty of a gait: bent legs, a bent trunk, a raised arm. It is a speed, m/s, so that it can be weighed against
//! the speed of another gait.

use glam::DVec3;
use motiondb::body::Joint;
use motiondb::statistics::mean;

use crate::checks::spread_arms::angle_deg;
use crate::cycle::gait_cycle::GaitCycle;
use crate::retarget::human_clip::{HumanBody, HumanJoints};
use crate::rig::roles::ARMS;

/// Least height of the hips over the ankle of the straighter leg without penalty, leg lengths; mean over the cycle. Walks of the development set: 0.91 to 0.98 straight on, 0.90 in a quick curve.
const STRAIGHT_LEGS: f64 = 0.9;
/// Penalty of lower hips, m/s a leg length: hips at 0.86 leg lengths cost 0.6 m/s.
const BENT_LEGS_MPS: f64 = 15.0;
/// Greatest lean of the trunk without penalty, degrees; mean over the cycle.
const LEAN_DEG: f64 = 15.0;
/// Penalty of a deeper lean, m/s a degree: one of 45° costs 0.9 m/s.
const LEAN_MPS: f64 = 0.03;
/// Greatest angle of the higher wrist, seen from its shoulder, off straight down without penalty, degrees; mean over the
/// cycle. In runs, with bent elbows, this angle reaches 50.
const ARM_DEG: f64 = 60.0;
/// Penalty of a higher arm, m/s a degree: a level arm costs 0.3 m/s.
const ARM_MPS: f64 = 0.01;

/// The posture penalty of a gait, m/s; 0 for a body that walks upright with hanging arms.
pub(crate) fn posture_penalty_mps(cycle: &GaitCycle, body: &HumanBody) -> f64 {
    let joints: Vec<HumanJoints> = cycle.rows.iter().map(|pose| pose.forward_kinematics(body)).collect();
    let mean_of = |value: &dyn Fn(&HumanJoints) -> f64| mean(joints.iter().map(value)).unwrap_or_default();
    let legs = mean_of(&straighter_leg_m) / body.leg_length_m();
    let bent_mps = BENT_LEGS_MPS * (STRAIGHT_LEGS - legs).max(0.0);
    let lean_mps = LEAN_MPS * (mean_of(&lean_deg) - LEAN_DEG).max(0.0);
    let arm_deg = ARMS.map(|arm| mean_of(&|joints| arm_deg(joints, arm))).into_iter().fold(0.0, f64::max);
    bent_mps + lean_mps + ARM_MPS * (arm_deg - ARM_DEG).max(0.0)
}

/// Share of a cycle with both feet in the air.
pub(crate) fn flight_share(cycle: &GaitCycle) -> f64 {
    let flies = |contacts: &&[f64; 2]| contacts.iter().all(|contact| *contact < 0.5);
    cycle.contacts.iter().filter(flies).count() as f64 / cycle.contacts.len().max(1) as f64
}

fn position_m(joints: &HumanJoints, joint: Joint) -> DVec3 {
    joints.positions_m[joint.index()]
}

/// Height of the hips over the ankle of the straighter leg, m.
fn straighter_leg_m(joints: &HumanJoints) -> f64 {
    let height_m = |side: usize| position_m(joints, Joint::THIGHS[side]).z - position_m(joints, Joint::FEET[side]).z;
    height_m(0).max(height_m(1))
}

/// Angle of the trunk off the vertical, degrees.
fn lean_deg(joints: &HumanJoints) -> f64 {
    angle_deg(position_m(joints, Joint::Neck) - position_m(joints, Joint::Pelvis), DVec3::Z)
}

/// Angle of a wrist off straight down, seen from its shoulder, degrees.
fn arm_deg(joints: &HumanJoints, [shoulder, _, wrist]: [Joint; 3]) -> f64 {
    angle_deg(position_m(joints, wrist) - position_m(joints, shoulder), DVec3::NEG_Z)
}

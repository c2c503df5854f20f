//! A clip of steps, assembled: footprints → pelvis → swings → legs → upper body → frames.
//!
//! All parts are in the frame of the moving root (x forward, y left, z up, metres, radians) and close over the clip's
//! strides. Only [`stepping_frames`] puts the root on its arc, in the world.

use glam::DQuat;

use crate::body::ClipPose;
use crate::body::leg_ik::leg_to_ankle;
use crate::body::rotation::{about_x, about_y, about_z};
use crate::body::skeleton::{FEET, JOINT_COUNT, SHANKS, THIGHS, TOES};
use crate::motion::foot_roll::FootPlacement;
use crate::motion::pelvis::{self, PelvisHeight, PelvisPose, pelvis_pose};
use crate::motion::steps::PlannedSteps;
use crate::motion::swing::FootSwing;
use crate::motion::upper_body::upper_body_pose;
use crate::plan::{FRAME_RATE_HZ, GaitPlan, StrideVariation};

/// Direction of the knee between those of pelvis and foot, share towards the foot's.
const KNEE_TOWARDS_FOOT: f64 = 0.6;
/// Rounds of lowering the hips where a leg would be overstretched; the height converges to under a millimetre.
const LOWERING_ROUNDS: usize = 12;

/// Direction in which a planned gait is played.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) enum Playback {
    /// As the gait was planned.
    Forward,
    /// Backward in time: a forward gait becomes a backward one.
    Reversed,
}

/// Legs that must reach their ankles.
#[derive(Clone, Copy, PartialEq)]
enum ReachingLegs {
    All,
    Standing,
}

/// A stepping body that can be posed at any phase.
#[derive(Debug)]
struct SteppingBody<'a> {
    steps: &'a PlannedSteps<'a>,
    height: PelvisHeight,
    /// Swings of each side, in the order of its strides; each follows the stance of its stride.
    swings: [Vec<FootSwing>; 2],
}

/// The frames of a clip: whole strides, and the frame after them, which is the first one moved on.
pub(crate) fn stepping_frames(gait: &GaitPlan, playback: Playback, variation: &StrideVariation) -> Vec<ClipPose> {
    let steps = PlannedSteps::of(gait, variation);
    let stepping = SteppingBody::new(&steps);
    let direction = if playback == Playback::Forward { 1.0 } else { -1.0 };
    let last = libm::round(variation.strides() as f64 * gait.stride_frames) as usize;
    // The clip begins where the yaw of hips and chest turns back, so that it biases no mean over the clip's ends.
    let start = gait.yaw_peak;
    (0..=last)
        .map(|frame| {
            let strides_gone = direction * frame as f64 / FRAME_RATE_HZ / gait.period_s();
            let phase = start + variation.strides_after(strides_gone);
            let root_s = steps.root_time_s(phase) - steps.root_time_s(start);
            let mut pose = stepping.pose(phase);
            let turn = about_z(gait.root.heading_rad(root_s));
            pose.hips_m = gait.root.position_m(root_s).extend(0.0) + turn * pose.hips_m;
            pose.rotations[0] = turn * pose.rotations[0];
            pose
        })
        .collect()
}

impl<'a> SteppingBody<'a> {
    /// The body with its hips over the planned feet, lowered until the legs reach.
    fn new(steps: &'a PlannedSteps<'a>) -> Self {
        let mut heights_m = pelvis::published_heights_m(steps);
        let mut stepping = Self::at_height(steps, PelvisHeight::through(steps, &heights_m));
        for _ in 0..LOWERING_ROUNDS {
            for (sample, height_m) in heights_m.iter_mut().enumerate() {
                *height_m -= stepping.overstretch_m(pelvis::phase_of(sample), ReachingLegs::All);
            }
            stepping = Self::at_height(steps, PelvisHeight::through(steps, &heights_m));
        }
        // The smoothing leaves some overstretch: at least standing legs must reach.
        let left_m = |sample| stepping.overstretch_m(pelvis::phase_of(sample), ReachingLegs::Standing);
        let drop_m = (0..heights_m.len()).map(left_m).fold(0.0, f64::max);
        Self::at_height(steps, stepping.height.lowered_by_m(drop_m))
    }

    /// The body with the swings that its height gives.
    fn at_height(steps: &'a PlannedSteps<'a>, height: PelvisHeight) -> Self {
        let swing = |side: usize, stride: usize| {
            let strike = stride as f64 - 0.5 * side as f64;
            let [from, to] = [strike, strike + 1.0].map(|strike| steps.stance(side, strike));
            FootSwing::between(&from, &to, &hip_height_of_leg(steps, &height, side, strike))
        };
        let strides = steps.variation.strides();
        let swings = [0, 1].map(|side| (0..strides).map(|stride| swing(side, stride)).collect());
        Self { steps, height, swings }
    }

    /// The greater overstretch of both legs, m.
    fn overstretch_m(&self, phase: f64, legs: ReachingLegs) -> f64 {
        let of_leg = |side: usize| {
            let in_swing = self.steps.stance_at(side, phase).1 > self.steps.gait.toe_off;
            if in_swing && legs == ReachingLegs::Standing {
                return 0.0;
            }
            self.height.overstretch_m(self.steps, phase, side, self.foot(phase, side).ankle_m)
        };
        of_leg(0).max(of_leg(1))
    }

    fn pose(&self, phase: f64) -> ClipPose {
        let PlannedSteps { gait, variation, .. } = self.steps;
        let pelvis = pelvis_pose(self.steps, &self.height, phase);
        let mut rotations = [DQuat::IDENTITY; JOINT_COUNT];
        rotations[0] = pelvis.rotation;
        for side in 0..2 {
            set_leg(&pelvis, &self.foot(phase, side), side, &mut rotations);
        }
        let amplitudes = variation.of_upper_body(&gait.upper_body, phase);
        upper_body_pose(gait, &amplitudes, phase).write(&pelvis, &mut rotations);
        ClipPose { hips_m: pelvis.hips_m, rotations }
    }

    /// One foot, on the ground or in the air.
    fn foot(&self, phase: f64, side: usize) -> FootPlacement {
        let (stance, p) = self.steps.stance_at(side, phase);
        if p <= self.steps.gait.toe_off {
            return stance.foot(p);
        }
        let swings = &self.swings[side];
        let stride = libm::round(stance.strike + 0.5 * side as f64) as i64;
        let swing = &swings[stride.rem_euclid(swings.len() as i64) as usize];
        swing.foot(self.steps.gait, p, &hip_height_of_leg(self.steps, &self.height, side, stance.strike))
    }
}

/// Sets the rotations of hip, knee, ankle and toe joint of one side.
pub(crate) fn set_leg(pelvis: &PelvisPose, foot: &FootPlacement, side: usize, rotations: &mut [DQuat; JOINT_COUNT]) {
    let knee_yaw_rad = pelvis.yaw_rad + KNEE_TOWARDS_FOOT * (foot.yaw_rad - pelvis.yaw_rad);
    let leg = leg_to_ankle(pelvis::hip_m(pelvis, side), foot.ankle_m, knee_yaw_rad);
    let sole = about_z(foot.yaw_rad) * about_x(foot.roll_rad) * about_y(-foot.pitch_rad);
    rotations[THIGHS[side]] = pelvis.rotation.inverse() * leg.thigh;
    rotations[SHANKS[side]] = leg.thigh.inverse() * leg.shank;
    rotations[FEET[side]] = leg.shank.inverse() * sole;
    rotations[TOES[side]] = about_y(-foot.toe_bend_rad);
}

/// Height of a hip as a function of the leg phase since a strike, m.
fn hip_height_of_leg(steps: &PlannedSteps, height: &PelvisHeight, side: usize, strike: f64) -> impl Fn(f64) -> f64 {
    move |p| pelvis::hip_m(&pelvis_pose(steps, height, strike + p), side).z
}

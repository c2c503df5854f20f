//! A clip of steps, assembled: footprints → pelvis → swings → legs → upper body → frames.
//!
//! All parts live in the frame of the moving root and close over the clip's strides; only [`frames`] puts the root on
//! its arc.

use glam::DQuat;

use crate::body::{FEET, JOINT_COUNT, Pose, SHANKS, THIGHS, TOES};
use crate::cadence::{FRAME_RATE_HZ, Gait};
use crate::foot_roll::Foot;
use crate::pelvis::{self, Height, PelvisPose};
use crate::rotation::{about_x, about_y, about_z};
use crate::steps::Steps;
use crate::swing::Swing;
use crate::variation::Variation;
use crate::{legs, upper_body};

/// The knee points between the pelvis's and the foot's direction, by this share towards the foot's.
const KNEE_TOWARDS_FOOT: f64 = 0.6;
/// Rounds of lowering the hips where a leg would be overstretched; the smooth height converges within them to under a
/// millimetre.
const LOWERING_ROUNDS: usize = 12;

/// Which way the film runs.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) enum Film {
    /// As the gait was planned.
    Forward,
    /// Back to front: a forward gait becomes a backward one.
    Reversed,
}

/// Which legs must reach.
#[derive(Clone, Copy, PartialEq)]
enum Legs {
    All,
    Standing,
}

/// Steps made ready to be posed at any phase.
#[derive(Debug)]
struct Stepping<'a> {
    steps: &'a Steps<'a>,
    height: Height,
    /// Of each side, in the order of its strides; each follows the stance of its stride.
    swings: [Vec<Swing>; 2],
}

/// The clip: `strides` whole strides and the frame after them, which is the first one moved on.
pub(crate) fn frames(gait: &Gait, film: Film, variation: &Variation) -> Vec<Pose> {
    let steps = Steps::of(gait, variation);
    let stepping = Stepping::new(&steps);
    let direction = if film == Film::Forward { 1.0 } else { -1.0 };
    let last = libm::round(variation.strides() as f64 * gait.stride_frames) as usize;
    // Begins where the yaw of hips and chest turns back, so that it biases no mean over the clip's ends.
    let start = gait.yaw_peak;
    (0..=last)
        .map(|frame| {
            let strides_gone = direction * frame as f64 / FRAME_RATE_HZ / gait.period_s();
            let phase = start + variation.strides_after(strides_gone);
            let root_s = steps.root_time_s(phase) - steps.root_time_s(start);
            let mut pose = stepping.pose(phase);
            let turn = about_z(gait.root.heading_rad(root_s));
            pose.hips_m = gait.root.place_m(root_s).extend(0.0) + turn * pose.hips_m;
            pose.rotations[0] = turn * pose.rotations[0];
            pose
        })
        .collect()
}

impl<'a> Stepping<'a> {
    /// Sets the hips over the planned feet, and lowers them until the legs reach.
    fn new(steps: &'a Steps<'a>) -> Self {
        let mut wanted_m = pelvis::wanted_heights_m(steps);
        let mut stepping = Self::at_height(steps, Height::through(steps, &wanted_m));
        for _ in 0..LOWERING_ROUNDS {
            for (sample, height_m) in wanted_m.iter_mut().enumerate() {
                *height_m -= stepping.overstretch_m(pelvis::phase_of(sample), Legs::All);
            }
            stepping = Self::at_height(steps, Height::through(steps, &wanted_m));
        }
        // What the smoothing left: standing legs must reach.
        let still_m = |sample| stepping.overstretch_m(pelvis::phase_of(sample), Legs::Standing);
        let drop_m = (0..wanted_m.len()).map(still_m).fold(0.0, f64::max);
        Self::at_height(steps, stepping.height.lowered_by_m(drop_m))
    }

    fn at_height(steps: &'a Steps<'a>, height: Height) -> Self {
        let swing = |side: usize, stride: usize| {
            let strike = stride as f64 - 0.5 * side as f64;
            let [from, to] = [strike, strike + 1.0].map(|strike| steps.stance(side, strike));
            Swing::between(&from, &to, &hip_height_of_leg(steps, &height, side, strike))
        };
        let strides = steps.variation.strides();
        let swings = [0, 1].map(|side| (0..strides).map(|stride| swing(side, stride)).collect());
        Self { steps, height, swings }
    }

    /// The greater overstretch of the two legs, m.
    fn overstretch_m(&self, phase: f64, legs: Legs) -> f64 {
        let of_leg = |side: usize| {
            let in_swing = self.steps.stance_at(side, phase).1 > self.steps.gait.toe_off;
            if in_swing && legs == Legs::Standing {
                return 0.0;
            }
            self.height.overstretch_m(self.steps, phase, side, self.foot(phase, side).ankle_m)
        };
        of_leg(0).max(of_leg(1))
    }

    fn pose(&self, phase: f64) -> Pose {
        let Steps { gait, variation, .. } = self.steps;
        let pelvis = pelvis::pose(self.steps, &self.height, phase);
        let mut rotations = [DQuat::IDENTITY; JOINT_COUNT];
        rotations[0] = pelvis.rotation;
        for side in 0..2 {
            write_leg(&pelvis, &self.foot(phase, side), side, &mut rotations);
        }
        let swing = variation.of_upper_body(&gait.upper_body, phase);
        upper_body::in_gait(gait, &swing, phase).write(&pelvis, &mut rotations);
        Pose { hips_m: pelvis.place_m, rotations }
    }

    fn foot(&self, phase: f64, side: usize) -> Foot {
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

/// Writes hip, knee, ankle and toe joint of one side.
pub(crate) fn write_leg(pelvis: &PelvisPose, foot: &Foot, side: usize, rotations: &mut [DQuat; JOINT_COUNT]) {
    let knee_yaw_rad = pelvis.yaw_rad + KNEE_TOWARDS_FOOT * (foot.yaw_rad - pelvis.yaw_rad);
    let leg = legs::solve(pelvis::hip_m(pelvis, side), foot.ankle_m, knee_yaw_rad);
    let sole = about_z(foot.yaw_rad) * about_x(foot.roll_rad) * about_y(-foot.pitch_rad);
    rotations[THIGHS[side]] = pelvis.rotation.inverse() * leg.thigh;
    rotations[SHANKS[side]] = leg.thigh.inverse() * leg.shank;
    rotations[FEET[side]] = leg.shank.inverse() * sole;
    rotations[TOES[side]] = about_y(-foot.toe_bend_rad);
}

/// By leg phase since a strike.
fn hip_height_of_leg(steps: &Steps, height: &Height, side: usize, strike: f64) -> impl Fn(f64) -> f64 {
    move |p| pelvis::hip_m(&pelvis::pose(steps, height, strike + p), side).z
}

//! One closed cycle of a gait, assembled: footprints → pelvis → swings → legs → upper body; and the frames of a clip
//! made of it.
//!
//! All parts live in the frame of the moving root, in which a steady gait is periodic; only [`frames`] puts the root on
//! its arc.

use std::array;

use glam::{DQuat, DVec2};

use crate::body::{FEET, JOINT_COUNT, Pose, SHANKS, THIGHS, TOES};
use crate::cadence::{FRAME_RATE_HZ, Gait, UpperBodySwing};
use crate::foot_roll::Foot;
use crate::footsteps::{Footprint, leg_phase};
use crate::legs;
use crate::pelvis::{self, Height, PelvisPose};
use crate::rotation::{about_x, about_y, about_z};
use crate::swing::{Stance, Swing};
use crate::upper_body;
use crate::variation::Variation;

/// Where the foot of a gait without published curves stands under the body: the ankle 3 cm behind the hips, the weight
/// over its middle, m.
const ANKLE_UNDER_HIPS_M: f64 = -0.03;
/// Adults' steps are longer than those of the children whose curves these are (.80 leg lengths against .75 at their
/// free speed), mostly behind them: with the feet so much farther back hip and knee come nearest to the curves, m.
const ADULT_TRAIL_M: f64 = 0.025;
/// Speeds from which adults' steps begin to be longer, and from which they are so in full, m/s.
const ADULT_TRAIL_FROM_MPS: [f64; 2] = [0.3, 1.1];
/// The knee points between the pelvis's and the foot's direction, by this share towards the foot's.
const KNEE_TOWARDS_FOOT: f64 = 0.6;
/// Rounds of lowering the hips where a leg would be overstretched; the smooth height converges within them to under a
/// millimetre.
const LOWERING_ROUNDS: usize = 12;
/// Samples when placing the feet.
const SAMPLES: usize = 60;

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

/// A gait made ready to be posed at any phase.
#[derive(Clone, Debug)]
struct Cycle<'a> {
    gait: &'a Gait,
    prints: [Footprint; 2],
    height: Height,
    swings: [Swing; 2],
}

/// The clip: `strides` whole strides and the frame after them, which is the first one moved on.
pub(crate) fn frames(gait: &Gait, strides: usize, film: Film, variation: &Variation) -> Vec<Pose> {
    let cycle = Cycle::new(gait);
    let direction = if film == Film::Forward { 1.0 } else { -1.0 };
    let last = libm::round(strides as f64 * gait.stride_frames) as usize;
    (0..=last)
        .map(|frame| {
            let time_s = direction * frame as f64 / FRAME_RATE_HZ;
            // Begins where the yaw of hips and chest turns back, so that it biases no mean over the clip's ends.
            let strides_gone = time_s / gait.period_s();
            let upper_body = variation.of_upper_body(&gait.upper_body, strides_gone);
            let mut pose = cycle.pose(gait.yaw_peak + strides_gone, &upper_body);
            let turn = about_z(gait.root.heading_rad(time_s));
            pose.hips_m = gait.root.place_m(time_s).extend(0.0) + turn * pose.hips_m;
            pose.rotations[0] = turn * pose.rotations[0];
            pose
        })
        .collect()
}

impl<'a> Cycle<'a> {
    /// Plans the feet, sets the hips over them, and lowers the hips until the legs reach.
    fn new(gait: &'a Gait) -> Self {
        let prints = footprints(gait);
        let mut wanted_m = pelvis::wanted_heights_m(gait, &prints.map(|mid_print| Stance { gait, mid_print }));
        let mut cycle = Self::at_height(gait, prints, Height::through(gait, &wanted_m));
        for _ in 0..LOWERING_ROUNDS {
            for (sample, height_m) in wanted_m.iter_mut().enumerate() {
                *height_m -= cycle.overstretch_m(pelvis::phase_of(sample), Legs::All);
            }
            cycle = Self::at_height(gait, prints, Height::through(gait, &wanted_m));
        }
        // What the smoothing left: standing legs must reach.
        let still_m = |sample| cycle.overstretch_m(pelvis::phase_of(sample), Legs::Standing);
        let drop_m = (0..pelvis::SAMPLES).map(still_m).fold(0.0, f64::max);
        Self::at_height(gait, prints, cycle.height.lowered_by_m(drop_m))
    }

    fn at_height(gait: &'a Gait, prints: [Footprint; 2], height: Height) -> Self {
        let stances = prints.map(|mid_print| Stance { gait, mid_print });
        let swings = array::from_fn(|side| Swing::between(&stances[side], &hip_height_of_leg(gait, &height, side)));
        Self { gait, prints, height, swings }
    }

    /// The greater overstretch of the two legs, m.
    fn overstretch_m(&self, cycle_phase: f64, legs: Legs) -> f64 {
        let of_leg = |side: usize| {
            let in_swing = leg_phase(cycle_phase, side) > self.gait.toe_off;
            if in_swing && legs == Legs::Standing {
                return 0.0;
            }
            self.height.overstretch_m(self.gait, cycle_phase, side, self.foot(cycle_phase, side).ankle_m)
        };
        of_leg(0).max(of_leg(1))
    }

    fn pose(&self, cycle_phase: f64, swing: &UpperBodySwing) -> Pose {
        let pelvis = pelvis::pose(self.gait, &self.height, cycle_phase);
        let mut rotations = [DQuat::IDENTITY; JOINT_COUNT];
        rotations[0] = pelvis.rotation;
        for side in 0..2 {
            write_leg(&pelvis, &self.foot(cycle_phase, side), side, &mut rotations);
        }
        upper_body::in_gait(self.gait, swing, cycle_phase).write(&pelvis, &mut rotations);
        Pose { hips_m: pelvis.place_m, rotations }
    }

    fn foot(&self, cycle_phase: f64, side: usize) -> Foot {
        let p = leg_phase(cycle_phase, side);
        if p <= self.gait.toe_off {
            Stance { gait: self.gait, mid_print: self.prints[side] }.foot(p)
        } else {
            self.swings[side].foot(self.gait, p, &hip_height_of_leg(self.gait, &self.height, side))
        }
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

fn hip_height_of_leg(gait: &Gait, height: &Height, side: usize) -> impl Fn(f64) -> f64 {
    move |p| pelvis::hip_m(&pelvis::pose(gait, height, p - 0.5 * side as f64), side).z
}

/// Both feet at their mid-stances: so far ahead that until the other foot strikes the hip angles are, on the mean, the
/// published ones.
fn footprints(gait: &Gait) -> [Footprint; 2] {
    let ahead_m = gait.style_share * published_ahead_m(gait) + (1.0 - gait.style_share) * ANKLE_UNDER_HIPS_M;
    [1.0, -1.0].map(|sign| Footprint {
        ground_m: DVec2::new(ahead_m, sign * gait.half_width_m + gait.footprint_shift_m()),
        yaw_rad: sign * gait.toe_out_rad,
    })
}

fn published_ahead_m(gait: &Gait) -> f64 {
    let sample_m = |i: usize| {
        let p = gait.toe_off.min(0.5) * (i as f64 + 0.5) / SAMPLES as f64;
        let carried_m = gait.root.speed_mps * gait.period_s() * (p - gait.mid_stance());
        gait.style.flexion(p, gait.toe_off).ankle_from_hip_m()[0] + carried_m - gait.roll.advance_m(p, gait.toe_off)
    };
    let [from_mps, full_mps] = ADULT_TRAIL_FROM_MPS;
    let trail_share = ((gait.root.pace_mps() - from_mps) / (full_mps - from_mps)).clamp(0.0, 1.0);
    let trail_m = if gait.running { 0.0 } else { ADULT_TRAIL_M * trail_share };
    (0..SAMPLES).map(sample_m).sum::<f64>() / SAMPLES as f64 - trail_m
}

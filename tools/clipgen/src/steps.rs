//! The steps of a whole clip: where each foot stands while the root goes on, no two strides the same.
//!
//! Time runs in strides: phase n + p is the share p of the n-th stride, 0 a strike of the left heel. Where the root is
//! at a phase, and where each foot is put down, is the steady gait's plan and its [`Variation`]; a foot once put down
//! stays. Root frame: x forward, y left, metres.

use glam::DVec2;

use crate::cadence::Gait;
use crate::foot_roll::Foot;
use crate::footsteps::{Footprint, leg_phase};
use crate::variation::Variation;

/// Where the foot of a gait without published curves stands under the body: the ankle 3 cm behind the hips, the weight
/// over its middle, m.
const ANKLE_UNDER_HIPS_M: f64 = -0.03;
/// Adults' steps are longer than those of the children whose curves these are (.80 leg lengths against .75 at their
/// free speed), mostly behind them: with the feet so much farther back hip and knee come nearest to the curves, m.
const ADULT_TRAIL_M: f64 = 0.030;
/// Speeds from which adults' steps begin to be longer, and from which they are so in full, m/s.
const ADULT_TRAIL_FROM_MPS: [f64; 2] = [0.3, 1.1];
/// Samples when placing the feet.
const SAMPLES: usize = 60;

/// All steps of one clip.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Steps<'a> {
    /// The steady gait.
    pub(crate) gait: &'a Gait,
    /// What the strides change of it.
    pub(crate) variation: &'a Variation,
    /// Both feet at their mid-stances, seen from the root of then.
    mid_prints: [Footprint; 2],
}

/// One foot on the ground, from a strike to its toe-off.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Stance<'a> {
    /// The clip's steps.
    pub(crate) steps: &'a Steps<'a>,
    /// Phase of the strike.
    pub(crate) strike: f64,
    side: usize,
    mid_print: Footprint,
}

impl<'a> Steps<'a> {
    /// Feet stand so far ahead that until the other foot strikes the hip angles are, on the mean, the published ones.
    pub(crate) fn of(gait: &'a Gait, variation: &'a Variation) -> Self {
        let ahead_m = gait.style_share * published_ahead_m(gait) + (1.0 - gait.style_share) * ANKLE_UNDER_HIPS_M;
        let mid_prints = [1.0, -1.0].map(|sign| Footprint {
            ground_m: DVec2::new(ahead_m, sign * gait.half_width_m + gait.footprint_shift_m()),
            yaw_rad: sign * gait.toe_out_rad,
        });
        Self { gait, variation, mid_prints }
    }

    /// The stance of one side that begins at a strike.
    pub(crate) fn stance(&'a self, side: usize, strike: f64) -> Stance<'a> {
        let (print, changed) = (&self.mid_prints[side], self.variation.of_step(side, strike));
        let mid_print = Footprint {
            ground_m: print.ground_m + DVec2::new(0.0, changed.aside_m),
            yaw_rad: print.yaw_rad + changed.yaw_rad,
        };
        Stance { steps: self, strike, side, mid_print }
    }

    /// The stance of one side that is, or was last, at a phase; and the share of a stride since its strike.
    pub(crate) fn stance_at(&'a self, side: usize, phase: f64) -> (Stance<'a>, f64) {
        let p = leg_phase(phase, side);
        (self.stance(side, phase - p), p)
    }

    /// How long the steadily moving root would have taken to where it is at a phase, s.
    pub(crate) fn root_time_s(&self, phase: f64) -> f64 {
        self.gait.period_s() * self.variation.way_strides(phase)
    }
}

impl Stance<'_> {
    /// How much higher than usual the foot was lifted on its way here, m.
    pub(crate) fn lift_m(&self) -> f64 {
        self.steps.variation.of_step(self.side, self.strike).lift_m
    }

    /// The foot at leg phase `p` from strike; seen from the root of then.
    pub(crate) fn foot(&self, p: f64) -> Foot {
        let Steps { gait, .. } = self.steps;
        let root_s = |p: f64| self.steps.root_time_s(self.strike + p);
        let print = self.mid_print.seen_later(&gait.root, root_s(p) - root_s(gait.mid_stance()));
        gait.roll.standing(&print, p, gait.toe_off)
    }
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

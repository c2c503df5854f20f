//! The steps of a whole clip: where each foot stands as the root moves on, no two strides the same.
//!
//! Time runs in strides: phase n + p is the share p of the n-th stride, 0 a strike of the left heel. The position of
//! the root at a phase, and of each footprint, follows from the plan of the steady gait and its [`StrideVariation`]. A
//! foot stays where it is set. Root frame: x forward, y left, metres.

use glam::DVec2;

use crate::motion::foot_roll::FootPlacement;
use crate::motion::footprint::{Footprint, leg_phase};
use crate::plan::{GaitPlan, StrideVariation};

/// Ankle ahead of the hips at mid-stance in a gait without published curves, m: the weight is over the foot's middle.
const ANKLE_UNDER_HIPS_M: f64 = -0.03;
/// Displacement of the feet backward, m: adults' steps are longer than those of the children whose curves are published
/// (.80 leg lengths against .75 at free speed). With it hip and knee come nearest to the curves.
const ADULT_TRAIL_M: f64 = 0.030;
/// Speeds from which adults' steps begin to be longer, and from which they are longer by all of it, m/s.
const ADULT_TRAIL_FROM_MPS: [f64; 2] = [0.3, 1.1];
/// Samples of a stance from which the feet are placed.
const SAMPLES: usize = 60;

/// All steps of one clip.
#[derive(Clone, Copy, Debug)]
pub(crate) struct PlannedSteps<'a> {
    /// Plan of the steady gait.
    pub(crate) gait: &'a GaitPlan,
    /// Changes of the plan from stride to stride.
    pub(crate) variation: &'a StrideVariation,
    /// Footprints of both feet at their mid-stances, in the root frame of that time.
    mid_prints: [Footprint; 2],
}

/// One foot on the ground, from a strike to its toe-off.
#[derive(Clone, Copy, Debug)]
pub(crate) struct PlannedStance<'a> {
    /// All steps of the clip.
    pub(crate) steps: &'a PlannedSteps<'a>,
    /// Phase of the strike, strides.
    pub(crate) strike: f64,
    side: usize,
    mid_print: Footprint,
}

impl<'a> PlannedSteps<'a> {
    /// The steps of a gait. Feet stand so far ahead that the mean hip angle, until the other foot strikes, is
    /// published.
    pub(crate) fn of(gait: &'a GaitPlan, variation: &'a StrideVariation) -> Self {
        let ahead_m = gait.style_share * published_ahead_m(gait) + (1.0 - gait.style_share) * ANKLE_UNDER_HIPS_M;
        let mid_prints = [1.0, -1.0].map(|sign| Footprint {
            ground_m: DVec2::new(ahead_m, sign * gait.half_width_m + gait.footprint_shift_m()),
            yaw_rad: sign * gait.toe_out_rad,
        });
        Self { gait, variation, mid_prints }
    }

    /// The stance of one side that begins at a strike.
    pub(crate) fn stance(&'a self, side: usize, strike: f64) -> PlannedStance<'a> {
        let (print, changed) = (&self.mid_prints[side], self.variation.of_step(side, strike));
        let mid_print = Footprint {
            ground_m: print.ground_m + DVec2::new(0.0, changed.aside_m),
            yaw_rad: print.yaw_rad + changed.yaw_rad,
        };
        PlannedStance { steps: self, strike, side, mid_print }
    }

    /// The present or the last stance of one side at a phase, and the share of a stride since its strike.
    pub(crate) fn stance_at(&'a self, side: usize, phase: f64) -> (PlannedStance<'a>, f64) {
        let p = leg_phase(phase, side);
        (self.stance(side, phase - p), p)
    }

    /// Time that the root, moving steadily, takes to its position at a phase, s.
    pub(crate) fn root_time_s(&self, phase: f64) -> f64 {
        self.gait.period_s() * self.variation.path_strides(phase)
    }
}

impl PlannedStance<'_> {
    /// Additional lift of the swing that ends with this stance, m.
    pub(crate) fn lift_m(&self) -> f64 {
        self.steps.variation.of_step(self.side, self.strike).lift_m
    }

    /// The foot at leg phase `p` from the strike, in the root frame of that time.
    pub(crate) fn foot(&self, p: f64) -> FootPlacement {
        let PlannedSteps { gait, .. } = self.steps;
        let root_s = |p: f64| self.steps.root_time_s(self.strike + p);
        let print = self.mid_print.seen_later(&gait.root, root_s(p) - root_s(gait.mid_stance()));
        gait.roll.standing(&print, p, gait.toe_off)
    }
}

/// Distance of the ankle ahead of the hips at mid-stance with which the mean hip angle is the published one, m.
fn published_ahead_m(gait: &GaitPlan) -> f64 {
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

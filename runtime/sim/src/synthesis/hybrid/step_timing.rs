//! Step timing: a slow body takes its steps in natural time, and rests between them on both feet.
//!
//! Slow steps would play in slow motion: examples at a low rate ([`crate::synthesis::command::step_state`]), or a base
//! walk at a low cadence. In people the swing of short steps takes no longer than that of a walk (captures: .3 to .4 s
//! at 15 to 60 cm), and both feet stand meanwhile. So the phase runs quickly while a foot swings, and waits while both
//! are planted.
//!
//! The root moves evenly, as the planner expects; the body moves in steps. It is drawn ahead of its root or behind it
//! by a lead, so that planted feet hold. With the pace g, the phase rate over its mean φ', the velocity v of the root,
//! and the lead d, of which ℓ is the time along v,
//!
//! ```text
//! d' = (g − 1)·v,  ℓ = d·v/v²
//! g = q              while a foot swings
//! g = R/(R + ℓ + G/2)  while both feet stand: over R, the time that this still takes at pace 1, ℓ falls to −G/2
//! G = (1 − 1/q)·T      lead that a swing of duration T at pace 1 gains.
//! ```
//!
//! A lead across v, and that of a body at rest, decays: nothing else makes it up. A body that stops where its
//! swinging foot lands does not wait while both stand.
//!
//! World, metres, seconds; phases as in [`crate::synthesis`].

use glam::Vec2;

use crate::synthesis::TimeStep;

/// Distance in phase from mid-stance within which the other foot swings.
const SWING_HALF: f32 = 0.19;
/// Duration of the swing of a short step, divided by that in the base walk.
const SHORT_SWING: f32 = 0.8;
/// Phase rates, divided by that of the base walk, at which steps are short, and from which on they keep their timing.
const SHORT_STEPS: [f32; 2] = [0.75, 1.0];
/// Greatest distance of the body from its root, m: half a small step.
const LEAD_MAX_M: f32 = 0.1;
/// Lead that is over, m.
const LEAD_OVER_M: f32 = 2e-4;
/// Speed below which a body makes up no lead by its steps, m/s.
const RESTING_MPS: f32 = 0.1;
/// Greatest pace of a swing.
const PACE_MAX: f32 = 6.0;
/// Range of the pace while both feet stand.
const RESTING_PACE: [f32; 2] = [0.02, 2.0];

/// The timing of a body's steps.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct StepTiming {
    /// g, the phase rate divided by its mean.
    pub(crate) pace: f32,
    /// d, from the root to the body, m.
    pub(crate) lead_m: Vec2,
}

impl Default for StepTiming {
    fn default() -> Self {
        Self { pace: 1.0, lead_m: Vec2::ZERO }
    }
}

impl StepTiming {
    /// Follows a gait at a phase.
    pub(crate) fn follow(&mut self, phase: f32, gait: &GaitTiming, step: &TimeStep) {
        let &GaitTiming { mean_hz, base_hz, velocity_mps, speed_to_come, stops } = gait;
        let swing_pace = swing_pace(mean_hz / base_hz, speed_to_come);
        if swing_pace == 1.0 && *self == Self::default() {
            return;
        }
        let speed_mps = velocity_mps.length();
        let along = velocity_mps.normalize_or_zero();
        let lead_s = self.lead_m.dot(along) / speed_mps.max(RESTING_MPS);
        // Phase since the nearest mid-stance.
        let since = phase - 0.5 * (2.0 * phase).round();
        let pace = if since.abs() < SWING_HALF {
            swing_pace
        } else if stops {
            RESTING_PACE[1]
        } else {
            let gained_s = (1.0 - 1.0 / swing_pace) * 2.0 * SWING_HALF / mean_hz;
            let left_s = (-SWING_HALF - since).rem_euclid(0.5) / mean_hz;
            let [least, greatest] = RESTING_PACE;
            let until_s = (left_s + lead_s + 0.5 * gained_s).max(f32::MIN_POSITIVE);
            (left_s / until_s).clamp(least, greatest)
        };
        self.pace = pace + step.pace_left * (self.pace - pace);
        let walking = (speed_mps / RESTING_MPS).min(1.0);
        let kept_m = walking * self.lead_m.dot(along) * along;
        let lead_m = kept_m + step.lead_left * (self.lead_m - kept_m) + (self.pace - 1.0) * step.dt_s * velocity_mps;
        self.lead_m = lead_m.clamp_length_max(LEAD_MAX_M);
        if swing_pace == 1.0 && (self.pace - 1.0).abs() < 1e-3 && self.lead_m.length() < LEAD_OVER_M {
            *self = Self::default();
        }
    }

    /// Follows a clip: its pace, and how far it has moved ahead of the root, world, m.
    pub(crate) fn follow_clip(&mut self, pace: f32, ahead_m: Vec2) {
        self.pace = pace;
        self.lead_m = (self.lead_m + ahead_m).clamp_length_max(LEAD_MAX_M);
    }

    /// Whether the lead is as great as it may be.
    pub(crate) fn leads_too_far(&self) -> bool {
        self.lead_m.length() >= 0.999 * LEAD_MAX_M
    }
}

/// What the timing of steps depends on.
#[derive(Clone, Copy, Debug)]
pub(crate) struct GaitTiming {
    /// φ', mean phase rate of the gait, 1/s.
    pub(crate) mean_hz: f32,
    /// Phase rate of the base walk, 1/s.
    pub(crate) base_hz: f32,
    /// v, velocity of the gait, world, m/s.
    pub(crate) velocity_mps: Vec2,
    /// Speed to which the body is to change, divided by that of the base walk.
    pub(crate) speed_to_come: f32,
    /// Whether the body stops where its swinging foot lands.
    pub(crate) stops: bool,
}

/// q of a gait, given its phase rate and the speed to come, each divided by that of the base walk. The step that a body
/// takes to a greater speed is no shorter than those that follow.
fn swing_pace(rate: f32, speed_to_come: f32) -> f32 {
    let [short, long] = SHORT_STEPS;
    let rate = rate.max(speed_to_come);
    let shortness = ((long - rate) / (long - short)).clamp(0.0, 1.0);
    1.0 + shortness * ((1.0 / (SHORT_SWING * rate)).min(PACE_MAX) - 1.0)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Length of a stride of small steps, m.
    const STRIDE_M: f32 = 0.5;

    fn gait(mean_hz: f32, speed_mps: f32) -> GaitTiming {
        let (velocity_mps, speed_to_come) = (speed_mps * Vec2::X, speed_mps / 1.1);
        GaitTiming { mean_hz, base_hz: 0.83, velocity_mps, speed_to_come, stops: false }
    }

    /// Durations of the swings and of whole strides of a gait, and the range of its lead after some strides, s.
    fn timing(mean_hz: f32, dt_s: f32) -> (f32, f32, [f32; 2]) {
        let (mut timing, mut phase, step) = (StepTiming::default(), 0.3_f32, TimeStep::new(dt_s));
        let (mut swing_s, mut all_s, mut strides, mut leads_s) = (0.0, 0.0, 0.0, [f32::MAX, f32::MIN]);
        for index in 0..(60.0 / dt_s) as usize {
            timing.follow(phase, &gait(mean_hz, STRIDE_M * mean_hz), &step);
            let swings = (phase - 0.5 * (2.0 * phase).round()).abs() < SWING_HALF;
            phase += dt_s * mean_hz * timing.pace;
            if index as f32 * dt_s > 20.0 {
                all_s += dt_s;
                strides += dt_s * mean_hz * timing.pace;
                swing_s += if swings { dt_s } else { 0.0 };
                let lead_s = timing.lead_m.x / (STRIDE_M * mean_hz);
                leads_s = [leads_s[0].min(lead_s), leads_s[1].max(lead_s)];
            }
            phase -= phase.floor();
        }
        (swing_s / (2.0 * strides), all_s / strides, leads_s)
    }

    #[test]
    fn slow_steps_swing_in_natural_time() {
        for (mean_hz, dt_s) in [(0.2, 1.0 / 60.0), (0.4, 1.0 / 60.0), (0.6, 1.0 / 60.0), (0.3, 1.0 / 30.0)] {
            let (swing_s, stride_s, [least_s, greatest_s]) = timing(mean_hz, dt_s);
            assert!((0.32..0.44).contains(&swing_s), "{mean_hz} Hz: {swing_s} s");
            assert!((stride_s * mean_hz - 1.0).abs() < 0.03, "{mean_hz} Hz: a stride takes {stride_s} s");
            assert!((least_s + greatest_s).abs() < 0.1 * (greatest_s - least_s) + 0.05, "{least_s} to {greatest_s} s");
        }
    }

    #[test]
    fn a_walk_keeps_its_timing() {
        let (_, stride_s, leads_s) = timing(0.83, 1.0 / 60.0);
        assert_eq!(leads_s, [0.0; 2]);
        assert!((stride_s * 0.83 - 1.0).abs() < 1e-3);
    }

    #[test]
    fn the_first_step_of_a_walk_is_no_short_one() {
        let (mut timing, step) = (StepTiming::default(), TimeStep::new(1.0 / 60.0));
        timing.follow(0.9, &GaitTiming { speed_to_come: 1.2, ..gait(0.3, 0.2) }, &step);
        assert_eq!(timing, StepTiming::default());
    }

    #[test]
    fn a_body_that_turns_or_speeds_up_does_not_leap() {
        let lead_m = 0.08 * Vec2::X;
        for velocity_mps in [Vec2::X, Vec2::Y, 0.05 * Vec2::Y] {
            let (mut timing, step) = (StepTiming { pace: 1.0, lead_m }, TimeStep::new(1.0 / 60.0));
            timing.follow(0.25, &GaitTiming { velocity_mps, ..gait(0.7, 1.0) }, &step);
            assert!(timing.lead_m.distance(lead_m) < 0.02, "{timing:?}");
        }
    }

    #[test]
    fn a_lead_is_made_up_where_the_body_walks_on() {
        let (mut timing, step, mut phase) =
            (StepTiming { pace: 3.0, lead_m: 0.08 * Vec2::X }, TimeStep::new(1.0 / 60.0), 0.1_f32);
        for _ in 0..300 {
            timing.follow(phase, &gait(0.9, 0.2), &step);
            phase = (phase + timing.pace * 0.9 / 60.0).fract();
        }
        assert_eq!(timing, StepTiming::default());
    }
}

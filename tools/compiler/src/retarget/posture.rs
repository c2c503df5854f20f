//! Posture: the parts of a clip in which the body is not upright.
//!
//! A body is upright while its straighter leg carries the hips nearly a leg's length over the ankle and its trunk stands
//! over them. People who walk keep 0.85 to 1.0 of their leg; runs flex it to 0.7, so the limit falls with speed. A knee
//! on the ground leaves 0.5, a seat or a squat less. Figures are means over a second, so that one low step counts as
//! little as one high one. Clips are in metres, z up.

use std::ops::Range;

use glam::DVec3;
use motiondb::body::Joint;
use motiondb::diagnostic::Posture;
use motiondb::statistics::{lower_quantile, mean};
use serde::{Deserialize, Serialize};

use crate::frame_runs::frame_runs;
use crate::read::source_clip::SourceClip;
use crate::retarget::source_parameters::SourceParameters;
use crate::retarget::units::{HUMAN_LEG_M, leg_length, middle};
use crate::rig::roles::Roles;

/// Span over which figures are averaged, s: about a stride.
const SPAN_S: f64 = 1.0;
/// Least height of the hips over the ankle of the straighter leg in a walk, leg lengths. Development set: 0.82 and more.
const WALKING_LEG_MIN: f64 = 0.78;
/// The same in a run. Development set, tightest circle at 1.7 m/s: 0.74; drawn characters: 0.67.
const RUNNING_LEG_MIN: f64 = 0.62;
/// Speed up to which the limit of a walk holds, m/s for a person's leg.
const WALKING_MPS: f64 = 1.2;
/// Speed from which the limit of a run holds, m/s for a person's leg.
const RUNNING_MPS: f64 = 2.2;
/// Greatest lean of an upright trunk that walks or runs, degrees. Development set: 38 in the lowest twentieth of a
/// sprint's start.
const LEAN_MAX_DEG: f64 = 50.0;
/// The same of a body that stands. A deeper lean is a bow, or a reach for the ground. Idles of the development set: up
/// to 24.
const STANDING_LEAN_MAX_DEG: f64 = 40.0;
/// Speed from which the limit of a walk holds, m/s for a person's leg; below it the limit falls linearly to that of
/// standing.
const LEANING_WALK_MPS: f64 = 0.3;
/// Height over the ankles below which a knee is on the ground, leg lengths. The rear knee of a crouched walk: 0.16.
const KNEE_ON_GROUND_MAX: f64 = 0.11;
/// Height over the ankles below which a wrist is that of a hand on the ground, leg lengths.
const HAND_ON_GROUND_MAX: f64 = 0.2;
/// Height of the hips over the ankles below which a body lies, leg lengths.
const LYING_MAX: f64 = 0.35;
/// Share of the heights of the feet below the height of their ground.
const GROUND_QUANTILE: f64 = 0.05;

/// A part of a clip in which the body is not upright.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct LowPart {
    /// Frames of the clip.
    pub frames: Range<usize>,
    /// What the body does instead, on average.
    pub posture: Posture,
}

/// The parts of a clip in which the body is not upright, in order of time.
pub(crate) fn low_parts(clip: &SourceClip, roles: &Roles, parameters: &SourceParameters) -> Vec<LowPart> {
    let legs = LegHeights { clip, roles, leg_m: leg_length(clip, roles) };
    let frames = 0..clip.frame_count();
    let half = ((0.5 * SPAN_S * clip.frame_rate_hz) as usize).max(1);
    let leg_shares = moving_mean(frames.clone().map(|frame| legs.straighter_leg(frame)), half);
    let leans = moving_mean(frames.clone().map(|frame| legs.trunk(frame)), half);
    let ground_mps =
        if parameters.is_in_place { libm::hypot(parameters.speed_mps, parameters.strafe_mps) } else { 0.0 };
    let speeds_mps = moving_mean(frames.clone().map(|frame| legs.speed_mps(frame)), half);
    let is_low: Vec<bool> = frames
        .map(|frame| {
            let human_mps = legs.human_mps(ground_mps.max(speeds_mps[frame]));
            leg_shares[frame] < least_leg(human_mps) || lean_deg(leans[frame]) > lean_max_deg(human_mps)
        })
        .collect();
    frame_runs(&is_low, true).into_iter().map(|frames| legs.low_part(frames)).collect()
}

/// The frames in which the body is upright, not in passing to or from another posture; all frames where it never is.
pub(crate) fn upright_frames(clip: &SourceClip, low_parts: &[LowPart]) -> Vec<usize> {
    let half = (0.5 * SPAN_S * clip.frame_rate_hz) as usize;
    let is_near = |part: &LowPart, frame: usize| frame + half >= part.frames.start && frame < part.frames.end + half;
    let frames = 0..clip.frame_count();
    let upright: Vec<usize> =
        frames.clone().filter(|&frame| !low_parts.iter().any(|part| is_near(part, frame))).collect();
    if upright.is_empty() { frames.collect() } else { upright }
}

/// Heights of a clip's joints.
struct LegHeights<'a> {
    clip: &'a SourceClip,
    roles: &'a Roles,
    leg_m: f64,
}

impl LegHeights<'_> {
    fn position_m(&self, joint: Joint, frame: usize) -> DVec3 {
        self.clip.position(frame, self.roles.required(joint))
    }

    /// Height of the hips over the ankles, the greater of both sides, leg lengths.
    fn straighter_leg(&self, frame: usize) -> f64 {
        let [left_m, right_m] = [0, 1]
            .map(|side| self.position_m(Joint::THIGHS[side], frame).z - self.position_m(Joint::FEET[side], frame).z);
        left_m.max(right_m) / self.leg_m
    }

    /// Unit vector from the hips to the shoulders.
    fn trunk(&self, frame: usize) -> DVec3 {
        let [hips, shoulders] =
            [Joint::THIGHS, Joint::UPPER_ARMS].map(|pair| middle(self.clip, self.roles, pair, frame));
        (shoulders - hips).normalize_or_zero()
    }

    /// Speed of the hips over the ground from the frame before, m/s.
    fn speed_mps(&self, frame: usize) -> f64 {
        let hips = |frame| middle(self.clip, self.roles, Joint::THIGHS, frame).truncate();
        let frame = frame.max(1);
        hips(frame).distance(hips(frame - 1)) * self.clip.frame_rate_hz
    }

    /// A speed scaled to a person's leg, m/s: speeds of legs of another length scale with its root (Froude number).
    fn human_mps(&self, speed_mps: f64) -> f64 {
        speed_mps * (HUMAN_LEG_M / self.leg_m).sqrt()
    }

    /// What the body does in frames in which it is not upright, six cases:
    /// - lean up to 50°, a knee low: it kneels;
    /// - lean of 40 to 50°, legs straight: it bends over;
    /// - lean up to 50° otherwise: it crouches;
    /// - lean above 50°, hips low: it lies;
    /// - hips high, a hand low: it goes on its hands;
    /// - hands high: it bends over.
    fn low_part(&self, frames: Range<usize>) -> LowPart {
        let soles = frames.clone().flat_map(|frame| Joint::FEET.map(|foot| self.position_m(foot, frame).z));
        let ground_m = lower_quantile(soles, GROUND_QUANTILE).unwrap_or_default();
        let lower = |pair: [Joint; 2]| {
            let heights =
                frames.clone().map(|frame| pair.map(|joint| self.position_m(joint, frame).z)).map(|[a, b]| a.min(b));
            (mean(heights).unwrap_or_default() - ground_m) / self.leg_m
        };
        let trunk = frames.clone().map(|frame| self.trunk(frame)).sum::<DVec3>();
        let leg_share = mean(frames.clone().map(|frame| self.straighter_leg(frame))).unwrap_or_default();
        let posture = match lean_deg(trunk) > LEAN_MAX_DEG {
            false if lower(Joint::SHANKS) < KNEE_ON_GROUND_MAX => Posture::Kneeling,
            false if lean_deg(trunk) > STANDING_LEAN_MAX_DEG && leg_share > WALKING_LEG_MIN => Posture::BentOver,
            false => Posture::Crouching,
            true if lower(Joint::THIGHS) < LYING_MAX => Posture::Lying,
            true if lower([Joint::LeftHand, Joint::RightHand]) < HAND_ON_GROUND_MAX => Posture::OnHands,
            true => Posture::BentOver,
        };
        LowPart { frames, posture }
    }
}

/// Least [`LegHeights::straighter_leg`] of an upright body at a person's speed.
fn least_leg(human_mps: f64) -> f64 {
    let run = ((human_mps - WALKING_MPS) / (RUNNING_MPS - WALKING_MPS)).clamp(0.0, 1.0);
    WALKING_LEG_MIN + run * (RUNNING_LEG_MIN - WALKING_LEG_MIN)
}

/// Greatest lean of an upright trunk at a person's speed, degrees.
fn lean_max_deg(human_mps: f64) -> f64 {
    let moving = (human_mps / LEANING_WALK_MPS).min(1.0);
    STANDING_LEAN_MAX_DEG + moving * (LEAN_MAX_DEG - STANDING_LEAN_MAX_DEG)
}

/// Angle of a trunk off the vertical, degrees.
fn lean_deg(trunk: DVec3) -> f64 {
    libm::acos(trunk.normalize_or(DVec3::Z).z).to_degrees()
}

/// Mean over `half` frames before and after each frame, as far as there are.
fn moving_mean<T>(values: impl Iterator<Item = T>, half: usize) -> Vec<T>
where
    T: Copy + Default + std::ops::Add<Output = T> + std::ops::Sub<Output = T> + std::ops::Div<f64, Output = T>,
{
    let mut sums = vec![T::default()];
    values.for_each(|value| sums.push(sums[sums.len() - 1] + value));
    let count = sums.len() - 1;
    let mean_about = |frame: usize| {
        let (first, end) = (frame.saturating_sub(half), (frame + half + 1).min(count));
        (sums[end] - sums[first]) / (end - first) as f64
    };
    (0..count).map(mean_about).collect()
}

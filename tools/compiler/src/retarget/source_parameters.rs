//! Whole-clip parameters (v_f, ω_t, ω_s) of a source, on its own skeleton, unsmoothed. Clips are in metres, z up.
//!
//! v_f and ω_s are the means of the hip midpoint's velocity along the facing and to its left. ω_t is the change of the
//! facing between its means over the first and the last 0.25 s, divided by the time between them. For a clip in place,
//! v_f and ω_s are those of the ground under its stance feet (`treadmill_speed`).

use glam::DVec2;
use motiondb::body::Joint;

use crate::read::source_clip::SourceClip;
use crate::retarget::facing_frame::{facing_rad, heading, in_body_frame};
use crate::retarget::treadmill_speed;
use crate::retarget::units::{HUMAN_LEG_M, leg_length, middle};
use crate::rig::roles::Roles;

/// Duration at each end over which the facing is averaged, s.
const END_S: f64 = 0.25;
/// Greatest extent of the hips' path in a clip in place, m for a person's leg.
const IN_PLACE_EXTENT_M: f64 = 0.35;
/// Greatest speed of the hips, divided by that of the ground, in a clip in place whose hips go farther.
const IN_PLACE_SHARE: f64 = 0.1;
/// Least speed of the ground under a clip in place, m/s for a person's leg; slower feet stand or turn on the spot.
const IN_PLACE_MIN_MPS: f64 = 0.2;

/// v_f, ω_t and ω_s of a whole clip.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SourceParameters {
    /// v_f, m/s.
    pub speed_mps: f64,
    /// ω_t, rad/s.
    pub turn_rate_rad_s: f64,
    /// ω_s, m/s.
    pub strafe_mps: f64,
    /// Whether the clip is in place: v_f and ω_s come from the slide of its stance feet.
    pub is_in_place: bool,
}

/// The parameters of a clip in metres, z up.
pub fn source_parameters(clip: &SourceClip, roles: &Roles) -> SourceParameters {
    let frames = 0..clip.frame_count();
    let hips: Vec<DVec2> = frames.clone().map(|frame| middle(clip, roles, Joint::THIGHS, frame).truncate()).collect();
    let facings = unwrapped(frames.map(|frame| facing_rad(clip, roles, frame)));
    let turn_rate_rad_s = turn_rate_rad_s(&facings, clip.frame_rate_hz);
    let scale = leg_length(clip, roles) / HUMAN_LEG_M;
    let travel = mean_velocity_mps(&hips, &facings, clip.frame_rate_hz);
    let treadmill = Some(treadmill_speed::ground_velocity(clip, roles)).filter(|ground| {
        let stays = extent_m(&hips) < IN_PLACE_EXTENT_M * scale || travel.length() < IN_PLACE_SHARE * ground.length();
        stays && ground.length() > IN_PLACE_MIN_MPS * scale
    });
    let velocity = treadmill.unwrap_or(travel);
    SourceParameters {
        speed_mps: velocity.x,
        turn_rate_rad_s,
        strafe_mps: velocity.y,
        is_in_place: treadmill.is_some(),
    }
}

/// Angles without jumps of a whole turn, rad.
fn unwrapped(angles: impl Iterator<Item = f64>) -> Vec<f64> {
    let mut result: Vec<f64> = Vec::new();
    for angle in angles {
        let last = result.last().copied().unwrap_or(angle);
        let turns = libm::round((last - angle) / std::f64::consts::TAU);
        result.push(angle + turns * std::f64::consts::TAU);
    }
    result
}

fn turn_rate_rad_s(facings: &[f64], frame_rate_hz: f64) -> f64 {
    let frames = facings.len();
    let count = ((END_S * frame_rate_hz + 1e-9) as usize).min(frames / 4).max(1);
    let mean = |part: &[f64]| part.iter().sum::<f64>() / part.len() as f64;
    let span_s = (frames - count).max(1) as f64 / frame_rate_hz;
    (mean(&facings[frames - count..]) - mean(&facings[..count])) / span_s
}

/// Mean velocity of the hips in the body's frame, m/s.
fn mean_velocity_mps(hips: &[DVec2], facings: &[f64], frame_rate_hz: f64) -> DVec2 {
    let steps = hips.windows(2).zip(facings.windows(2)).map(|(hips, facings)| {
        let forward = (heading(facings[0]) + heading(facings[1])).normalize_or_zero();
        in_body_frame(hips[1] - hips[0], forward) * frame_rate_hz
    });
    steps.sum::<DVec2>() / (hips.len() - 1) as f64
}

/// Diagonal of the rectangle about points, m.
fn extent_m(points: &[DVec2]) -> f64 {
    let least = points.iter().copied().fold(DVec2::INFINITY, DVec2::min);
    let most = points.iter().copied().fold(DVec2::NEG_INFINITY, DVec2::max);
    (most - least).length()
}

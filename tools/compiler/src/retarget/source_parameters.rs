//! Whole-clip parameters of a source: v_f, ω_t, ω_s on its own skeleton, unsmoothed.
//!
//! Hip midpoint against the facing of hips and shoulders. ω_t is the change of the facing between its means over the
//! first and the last quarter second. A clip that treads on the spot takes v_f and ω_s from the slide of its stance
//! feet (`tread.rs`).

use glam::DVec2;
use motiondb::body::Joint;

use crate::read::source_clip::SourceClip;
use crate::retarget::treadmill_speed;
use crate::retarget::units::{HUMAN_LEG_M, leg_length, middle};
use crate::rig::roles::Roles;

/// Seconds at either end over which the facing is averaged.
const END_S: f64 = 0.25;
/// Hips that stay within this much of a person's leg stay in place, m.
const IN_PLACE_EXTENT_M: f64 = 0.35;
/// And so do hips that wander farther, at less than this share of the speed at which the feet tread.
const IN_PLACE_SHARE: f64 = 0.1;
/// A stance foot that slides faster than this treads, m/s; slower feet stand (idle) or turn on the spot.
const TREAD_MIN_MPS: f64 = 0.2;

/// v_f, ω_t, ω_s of a whole clip.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct WholeClip {
    /// v_f, m/s.
    pub speed_mps: f64,
    /// ω_t, rad/s.
    pub turn_rate_rad_s: f64,
    /// ω_s, m/s.
    pub strafe_mps: f64,
    /// The speeds come from the stance foot's slide.
    pub in_place: bool,
}

/// Measures a clip in metres, Z up.
pub fn measure(clip: &SourceClip, roles: &Roles) -> WholeClip {
    let frames = 0..clip.frame_count();
    let hips: Vec<DVec2> = frames.clone().map(|frame| middle(clip, roles, Joint::THIGHS, frame).truncate()).collect();
    let facings = unwrapped(frames.map(|frame| facing_rad(clip, roles, frame)));
    let turn_rate_rad_s = turn_rate(&facings, clip.frame_rate_hz);
    let scale = leg_length(clip, roles) / HUMAN_LEG_M;
    let moved = mean_velocity(&hips, &facings, clip.frame_rate_hz);
    let treading = Some(treadmill_speed::ground_velocity(clip, roles)).filter(|slide| {
        let stays = extent_m(&hips) < IN_PLACE_EXTENT_M * scale || moved.length() < IN_PLACE_SHARE * slide.length();
        stays && slide.length() > TREAD_MIN_MPS * scale
    });
    let velocity = treading.unwrap_or(moved);
    WholeClip { speed_mps: velocity.x, turn_rate_rad_s, strafe_mps: velocity.y, in_place: treading.is_some() }
}

/// Mean of the left→right unit vectors of hips and shoulders, turned 90° and projected on the ground.
pub(crate) fn facing_rad(clip: &SourceClip, roles: &Roles, frame: usize) -> f64 {
    let across = |[left, right]: [Joint; 2]| {
        let [left, right] = [left, right].map(|joint| clip.position(frame, roles.required(joint)));
        (right - left).normalize_or_zero()
    };
    let right = across(Joint::THIGHS) + across(Joint::UPPER_ARMS);
    libm::atan2(right.x, -right.y)
}

fn unwrapped(angles: impl Iterator<Item = f64>) -> Vec<f64> {
    let mut result: Vec<f64> = Vec::new();
    for angle in angles {
        let last = result.last().copied().unwrap_or(angle);
        let turns = libm::round((last - angle) / std::f64::consts::TAU);
        result.push(angle + turns * std::f64::consts::TAU);
    }
    result
}

fn turn_rate(facings: &[f64], frame_rate_hz: f64) -> f64 {
    let frames = facings.len();
    let count = ((END_S * frame_rate_hz + 1e-9) as usize).min(frames / 4).max(1);
    let mean = |part: &[f64]| part.iter().sum::<f64>() / part.len() as f64;
    let span_s = (frames - count).max(1) as f64 / frame_rate_hz;
    (mean(&facings[frames - count..]) - mean(&facings[..count])) / span_s
}

pub(crate) fn heading(angle_rad: f64) -> DVec2 {
    DVec2::new(libm::cos(angle_rad), libm::sin(angle_rad))
}

/// A ground vector in the body's frame: along the facing, to its left.
pub(crate) fn in_body(vector: DVec2, forward: DVec2) -> DVec2 {
    DVec2::new(vector.dot(forward), forward.perp_dot(vector))
}

fn mean_velocity(hips: &[DVec2], facings: &[f64], frame_rate_hz: f64) -> DVec2 {
    let steps = hips.windows(2).zip(facings.windows(2)).map(|(hips, facings)| {
        let forward = (heading(facings[0]) + heading(facings[1])).normalize_or_zero();
        in_body(hips[1] - hips[0], forward) * frame_rate_hz
    });
    steps.sum::<DVec2>() / (hips.len() - 1) as f64
}

fn extent_m(points: &[DVec2]) -> f64 {
    let least = points.iter().copied().fold(DVec2::INFINITY, DVec2::min);
    let most = points.iter().copied().fold(DVec2::NEG_INFINITY, DVec2::max);
    (most - least).length()
}

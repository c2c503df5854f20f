//! Whether level ground carries a body by its feet; what else moves it, with what was measured.
//!
//! Stairs, ramps, moonwalks, turntables and jumps are motion of a human body, and no locomotion on flat ground: gait
//! analysis finds no steady stride in them, and its reason alone would not tell why. Metres, Z up.

use std::ops::Range;

use glam::{DVec2, DVec3};
use motiondb::body::Joint;
use motiondb::diagnostic::Warning;
use motiondb::statistics::median;

use crate::checks::plausibility::{LEAD_MIN_M, passings};
use crate::read::source_clip::SourceClip;
use crate::retarget::source_parameters::WholeClip;
use crate::retarget::treadmill_speed;
use crate::retarget::units::{HUMAN_LEG_M, leg_length, middle};
use crate::rig::roles::Roles;

/// Steeper ground is none to blend into walks on the flat: 1 in 12 is the steepest that building codes (ADA 405.2) call
/// a ramp for everybody.
const SLOPE_MAX: f64 = 1.0 / 12.0;
/// Feet that end nearer to the height at which they began say nothing of a slope, m for a person's leg.
const RISE_MIN_M: f64 = 0.1;
/// Ways are measured in steps of this time, in which jitter is nothing.
const WAY_STEP_S: f64 = 0.25;
/// In this time a foot stands once, in the slowest walk.
const STANCE_SPAN_S: f64 = 0.7;
/// Feet that slide faster over the ground, and than this share of the body's speed, do not carry it, m/s: the noisiest
/// captures slide by 0.18.
const SLIDE_MAX_MPS: f64 = 0.4;
const SLIDE_SHARE: f64 = 0.3;
/// And it is no slide but noise where feet do not keep to it for so much of the time.
const STANCE_SHARE_MIN: f64 = 0.3;
/// A body that turns faster than this without a step is turned, rad/s.
const TURNED_MIN_RAD_S: f64 = 0.25;
/// Feet that rise by less do not step, m for a person's leg; both higher than this are in a jump (runs: 5 cm).
const STEP_LIFT_MIN_M: f64 = 0.03;
const JUMP_LIFT_M: f64 = 0.12;
/// Of the heights of a foot those at which it stands.
const LOW_SHARE: f64 = 0.05;
/// Nobody goes faster (Bolt, at his fastest: 12.4), m/s for a person's leg; a frame in which a body does so, farther
/// than this, m, and farther by this factor than in most frames, is a leap from one take to another.
const FASTEST_MPS: f64 = 12.5;
const LEAP_MIN_M: f64 = 0.3;
const LEAP_OVER_USUAL: f64 = 5.0;
/// Shorter clips say nothing of what is missing in them, s.
const TURN_MIN_S: f64 = 1.0;

/// The warning, where something else than feet on level ground moves the body.
pub(crate) fn doubt(clip: &SourceClip, roles: &Roles, whole: &WholeClip) -> Option<Warning> {
    let scale = leg_length(clip, roles) / HUMAN_LEG_M;
    let steps = passings(clip, roles, LEAD_MIN_M * scale).len();
    let body = Body { clip, roles, scale, steps };
    let moves = (!whole.in_place).then(|| body.climbs().or_else(|| body.slides(whole))).flatten();
    body.leaps().or(moves).or_else(|| body.is_turned(whole)).or_else(|| body.jumps())
}

struct Body<'a> {
    clip: &'a SourceClip,
    roles: &'a Roles,
    /// Over a person's size.
    scale: f64,
    /// How often one foot passes the other.
    steps: usize,
}

impl Body<'_> {
    /// Takes that were strung together, or a loop that was repeated without its way.
    fn leaps(&self) -> Option<Warning> {
        let hips = |frame: usize| middle(self.clip, self.roles, Joint::THIGHS, frame);
        let ways_m: Vec<f64> =
            (1..self.clip.frame_count()).map(|frame| hips(frame).distance(hips(frame - 1))).collect();
        let usual_m = median(ways_m.iter().copied())?;
        let fastest_m = FASTEST_MPS * self.scale.sqrt() / self.clip.frame_rate_hz;
        let least_m = fastest_m.max(LEAP_MIN_M * self.scale).max(LEAP_OVER_USUAL * usual_m);
        let leaps: Vec<usize> = (0..ways_m.len()).filter(|&frame| ways_m[frame] > least_m).collect();
        let (&first, others) = leaps.split_first()?;
        let frame = (self.clip.first_frame + first + 1) as u32;
        Some(Warning::Leap { distance_m: ways_m[first] as f32, frame, more: others.len() as u32 })
    }

    fn climbs(&self) -> Option<Warning> {
        let [rise_m, way_m] = self.rise_and_way_m();
        let is_level = rise_m.abs() < RISE_MIN_M * self.scale || rise_m.abs() < SLOPE_MAX * way_m;
        if is_level || self.steps == 0 {
            return None;
        }
        Some(Warning::Slope { rise_cm: (100.0 * rise_m / self.steps as f64) as f32 })
    }

    /// How much higher the lower foot stands at the end than at the beginning, and the way of the hips.
    fn rise_and_way_m(&self) -> [f64; 2] {
        let step = ((WAY_STEP_S * self.clip.frame_rate_hz) as usize).max(1);
        let hips = |frame: usize| middle(self.clip, self.roles, Joint::THIGHS, frame);
        let places: Vec<DVec3> = (0..self.clip.frame_count()).step_by(step).map(hips).collect();
        let way_m = places.windows(2).map(|pair| (pair[1] - pair[0]).truncate().length()).sum();
        let count = self.clip.frame_count();
        let span = ((STANCE_SPAN_S * self.clip.frame_rate_hz) as usize).clamp(1, count);
        let lowest_m = |frames: Range<usize>| {
            let ankles = Joint::FEET.map(|foot| self.roles.required(foot));
            let heights = frames.flat_map(|frame| ankles.map(|ankle| self.clip.position(frame, ankle).z));
            heights.fold(f64::INFINITY, f64::min)
        };
        [lowest_m(count - span..count) - lowest_m(0..span), way_m]
    }

    fn slides(&self, whole: &WholeClip) -> Option<Warning> {
        let slide = treadmill_speed::ground_velocity(self.clip, self.roles);
        let moved = DVec2::new(whole.speed_mps, whole.strafe_mps);
        let stands = treadmill_speed::planted_share(self.clip, self.roles, slide, 0.0)
            .is_some_and(|share| share > STANCE_SHARE_MIN);
        if !stands || slide.length() < SLIDE_MAX_MPS.max(SLIDE_SHARE * moved.length()) * self.scale.sqrt() {
            return None;
        }
        let [slide_mps, body_mps] = [slide, moved].map(|velocity| velocity.length() as f32);
        Some(Warning::Skating { body_mps, slide_mps, steps: self.steps > 0 })
    }

    fn is_turned(&self, whole: &WholeClip) -> Option<Warning> {
        let stand = (0..2).all(|side| self.lift_m(side) < STEP_LIFT_MIN_M * self.scale);
        let is_long = self.clip.frame_count() as f64 > TURN_MIN_S * self.clip.frame_rate_hz;
        (stand && is_long && whole.turn_rate_rad_s.abs() > TURNED_MIN_RAD_S)
            .then_some(Warning::TurnWithoutStep { turn_rate_rad_s: whole.turn_rate_rad_s as f32 })
    }

    /// From where a foot stands to its highest.
    fn lift_m(&self, side: usize) -> f64 {
        let heights = self.heights_m(side);
        heights[heights.len() - 1] - heights[0]
    }

    /// Of an ankle, sorted.
    fn heights_m(&self, side: usize) -> Vec<f64> {
        let ankle = self.roles.required(Joint::FEET[side]);
        let mut heights: Vec<f64> = (0..self.clip.frame_count()).map(|f| self.clip.position(f, ankle).z).collect();
        heights.sort_by(f64::total_cmp);
        heights
    }

    fn jumps(&self) -> Option<Warning> {
        let stands_m = [0, 1].map(|side| {
            let heights = self.heights_m(side);
            heights[(LOW_SHARE * (heights.len() - 1) as f64) as usize]
        });
        let lift_m = |frame: usize, side: usize| {
            self.clip.position(frame, self.roles.required(Joint::FEET[side])).z - stands_m[side]
        };
        let lower_m = |frame: usize| lift_m(frame, 0).min(lift_m(frame, 1));
        let highest_m = (0..self.clip.frame_count()).map(lower_m).fold(0.0, f64::max);
        (self.steps == 0 && highest_m > JUMP_LIFT_M * self.scale)
            .then_some(Warning::Jump { lift_cm: (100.0 * highest_m) as f32 })
    }
}

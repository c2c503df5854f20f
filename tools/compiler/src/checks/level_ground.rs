//! Whether the feet alone move a body on level ground; if not, what moves it.
//!
//! Stairs, ramps, moonwalks, turntables and jumps are human motion, but not locomotion on flat ground. Gait analysis
//! finds no steady stride in them and cannot state why. Clips are in metres, z up.

use std::ops::{Range, RangeInclusive};

use glam::{DVec2, DVec3};
use motiondb::body::Joint;
use motiondb::diagnostic::Warning;
use motiondb::statistics::{lower_quantile, median};

use crate::read::source_clip::SourceClip;
use crate::retarget::foot_passings::{LEAD_MIN_M, foot_passings};
use crate::retarget::source_parameters::SourceParameters;
use crate::retarget::treadmill_speed;
use crate::retarget::units::{HUMAN_LEG_M, leg_length, middle};
use crate::rig::roles::Roles;

/// Least slope that counts: 1 in 20 is the steepest walkway that building codes do not call a ramp (ADA 403.3).
const SLOPE_MIN: f64 = 1.0 / 20.0;
/// Least rise of the feet over the clip that counts, m for a person's leg.
const RISE_MIN_M: f64 = 0.1;
/// Time between two positions by which the length of a path is measured, s: in it, jitter is small.
const PATH_STEP_S: f64 = 0.25;
/// Duration in which each foot stands once, even in the slowest walk, s.
const STANCE_SPAN_S: f64 = 0.7;
/// Least slide of feet that do not carry the body, m/s for a person's leg; the noisiest captures slide by 0.18.
const SLIDE_MIN_MPS: f64 = 0.4;
/// Least slide of feet that do not carry the body, divided by the body's speed.
const SLIDE_MIN_SHARE: f64 = 0.3;
/// Least share of the time that feet keep to one slide; below it the slide is noise.
const STANCE_SHARE_MIN: f64 = 0.3;
/// Greatest turn of a joint where radians are read as degrees, degrees: a whole turn, 2π, is 6.3° then. The joints of a
/// stiff figure that slides do not turn at all.
const RADIANS_AS_DEGREES_DEG: RangeInclusive<f64> = 0.2..=std::f64::consts::TAU;
/// Least turn of the legs over that of the other joints in a gait. Brisk walks: 0.9; in bodies that stand legs turn least.
const LEGS_OVER_REST: f64 = 0.5;
/// Least number of steps that the legs would take if the angles were radians.
const RADIANS_STEPS_MIN: usize = 3;
/// Duration of a step, s for a person's leg: from a sprint to a stroll. Bodies that stand sway more slowly.
const STEP_S: RangeInclusive<f64> = 0.2..=1.2;
/// Least turn rate of a body that turns without a step, rad/s.
const TURN_MIN_RAD_S: f64 = 0.25;
/// Least lift of a foot that steps, m for a person's leg.
const STEP_LIFT_MIN_M: f64 = 0.03;
/// Least lift of both feet in a jump, m for a person's leg; runs lift both by 0.05.
const JUMP_LIFT_MIN_M: f64 = 0.12;
/// Share of an ankle's heights below the height at which it stands.
const STANDING_QUANTILE: f64 = 0.05;
/// Greatest speed of a body, m/s for a person's leg (Bolt's fastest: 12.4).
const FASTEST_MPS: f64 = 12.5;
/// Least distance of a leap between two frames, m for a person's leg.
const LEAP_MIN_M: f64 = 0.3;
/// Least distance of a leap, divided by the median distance between two frames.
const LEAP_OVER_USUAL: f64 = 5.0;
/// Least duration of a clip whose missing steps count, s.
const TURN_MIN_S: f64 = 1.0;

/// The warning about what moves the body if not its feet on level ground; `None` if the feet do.
pub(crate) fn warning(clip: &SourceClip, roles: &Roles, parameters: &SourceParameters) -> Option<Warning> {
    let scale = leg_length(clip, roles) / HUMAN_LEG_M;
    let steps = foot_passings(clip, roles, LEAD_MIN_M * scale);
    let check = GroundCheck { clip, roles, parameters, scale, steps };
    let travels = || if parameters.is_in_place { None } else { check.slope().or_else(|| check.skating()) };
    let on_the_spot = || check.radians_in_place().or_else(|| check.turn_without_step()).or_else(|| check.jump());
    check.leap().or_else(travels).or_else(on_the_spot)
}

/// A clip and what all checks need of it.
struct GroundCheck<'a> {
    clip: &'a SourceClip,
    roles: &'a Roles,
    parameters: &'a SourceParameters,
    /// Leg length, divided by a person's.
    scale: f64,
    /// Frames in which one foot passes the other.
    steps: Vec<usize>,
}

impl GroundCheck<'_> {
    fn hips_m(&self, frame: usize) -> DVec3 {
        middle(self.clip, self.roles, Joint::THIGHS, frame)
    }

    fn ankle_height_m(&self, frame: usize, side: usize) -> f64 {
        self.clip.position(frame, self.roles.required(Joint::FEET[side])).z
    }

    /// A frame to which the body leaps: takes that were joined, or a loop that was repeated without its displacement.
    fn leap(&self) -> Option<Warning> {
        let steps_m: Vec<f64> =
            (1..self.clip.frame_count()).map(|frame| self.hips_m(frame).distance(self.hips_m(frame - 1))).collect();
        let usual_m = median(steps_m.iter().copied())?;
        let fastest_m = FASTEST_MPS * self.scale.sqrt() / self.clip.frame_rate_hz;
        let least_m = fastest_m.max(LEAP_MIN_M * self.scale).max(LEAP_OVER_USUAL * usual_m);
        let leaps: Vec<usize> = (0..steps_m.len()).filter(|&frame| steps_m[frame] > least_m).collect();
        let (&first, others) = leaps.split_first()?;
        let frame = (self.clip.first_frame + first + 1) as u32;
        Some(Warning::Leap { distance_m: steps_m[first] as f32, frame, more: others.len() as u32 })
    }

    /// Ground that rises or falls.
    fn slope(&self) -> Option<Warning> {
        let count = self.clip.frame_count();
        let span = ((STANCE_SPAN_S * self.clip.frame_rate_hz) as usize).clamp(1, count);
        let rise_m = self.rise_m(span);
        // Both heights are those of the lower end of their span: the body rose over the path between two such ends.
        let risen_frames = (count - span) as f64;
        let path_m = self.path_m() * risen_frames / count as f64;
        let is_level = rise_m.abs() < RISE_MIN_M * self.scale || rise_m.abs() < SLOPE_MIN * path_m;
        if is_level {
            return None;
        }
        let step_share = match self.steps[..] {
            [] => return None,
            [_] => 1.0,
            [first, .., last] => (last - first) as f64 / ((self.steps.len() - 1) as f64 * risen_frames),
        };
        Some(Warning::Slope { rise_cm: (100.0 * step_share * rise_m) as f32 })
    }

    /// Height of the lower foot over the last `span` frames minus its height over the first ones, m.
    fn rise_m(&self, span: usize) -> f64 {
        let count = self.clip.frame_count();
        let lowest_m = |frames: Range<usize>| {
            let heights = frames.flat_map(|frame| [0, 1].map(|side| self.ankle_height_m(frame, side)));
            heights.fold(f64::INFINITY, f64::min)
        };
        lowest_m(count - span..count) - lowest_m(0..span)
    }

    /// Length of the hips' path on the ground, m.
    fn path_m(&self) -> f64 {
        let step = ((PATH_STEP_S * self.clip.frame_rate_hz) as usize).max(1);
        let positions: Vec<DVec3> =
            (0..self.clip.frame_count()).step_by(step).map(|frame| self.hips_m(frame)).collect();
        positions.windows(2).map(|pair| (pair[1] - pair[0]).truncate().length()).sum()
    }

    /// Feet that slide over the ground while the body travels.
    fn skating(&self) -> Option<Warning> {
        let slide = treadmill_speed::ground_velocity(self.clip, self.roles);
        let travel = DVec2::new(self.parameters.speed_mps, self.parameters.strafe_mps);
        let stands = treadmill_speed::planted_share(self.clip, self.roles, slide, 0.0)
            .is_some_and(|share| share > STANCE_SHARE_MIN);
        if !stands || slide.length() < SLIDE_MIN_MPS.max(SLIDE_MIN_SHARE * travel.length()) * self.scale.sqrt() {
            return None;
        }
        let [slide_mps, body_mps] = [slide, travel].map(|velocity| velocity.length() as f32);
        let skating = Warning::Skating { body_mps, slide_mps, steps: !self.steps.is_empty() };
        Some(self.radians().unwrap_or(skating))
    }

    /// Legs that take no step and hardly turn, but at least half as much as the rest of the body.
    fn radians(&self) -> Option<Warning> {
        if !self.steps.is_empty() {
            return None;
        }
        let [legs_rad, rest_rad] =
            [true, false].map(|of_legs| self.greatest_turn_of(&|joint| is_of_leg(joint) == of_legs));
        let turned_rad = legs_rad.max(rest_rad);
        let is_likely =
            RADIANS_AS_DEGREES_DEG.contains(&turned_rad.to_degrees()) && legs_rad > LEGS_OVER_REST * rest_rad;
        is_likely.then_some(Warning::RadiansLikely { turned_rad: turned_rad as f32 })
    }

    /// The same in a clip in place. In addition the legs would step if their angles were radians.
    fn radians_in_place(&self) -> Option<Warning> {
        let found = self.radians()?;
        let lead = LEAD_MIN_M * self.scale * 1.0_f64.to_radians();
        let steps = foot_passings(self.clip, self.roles, lead);
        let step_s = median(steps.windows(2).map(|pair| (pair[1] - pair[0]) as f64 / self.clip.frame_rate_hz))?;
        let is_human = STEP_S.contains(&(step_s / self.scale.sqrt()));
        (steps.len() >= RADIANS_STEPS_MIN && is_human).then_some(found)
    }

    /// Greatest turn since the first frame of the joints that count, rad.
    fn greatest_turn_of(&self, counts: &dyn Fn(Joint) -> bool) -> f64 {
        let joints = Joint::ALL.into_iter().filter(|joint| counts(*joint));
        let sources = joints.filter_map(|joint| self.roles.joints[joint.index()]);
        let turn_rad = |frame: usize, joint: usize| {
            self.clip.orientation(frame, joint).angle_between(self.clip.orientation(0, joint))
        };
        let poses = sources.flat_map(|joint| (1..self.clip.frame_count()).map(move |frame| (frame, joint)));
        poses.map(|(frame, joint)| turn_rad(frame, joint)).fold(0.0, f64::max)
    }

    fn turn_without_step(&self) -> Option<Warning> {
        let stands = (0..2).all(|side| self.lift_m(side) < STEP_LIFT_MIN_M * self.scale);
        let is_long = self.clip.frame_count() as f64 > TURN_MIN_S * self.clip.frame_rate_hz;
        let turn_rate_rad_s = self.parameters.turn_rate_rad_s;
        (stands && is_long && turn_rate_rad_s.abs() > TURN_MIN_RAD_S)
            .then_some(Warning::TurnWithoutStep { turn_rate_rad_s: turn_rate_rad_s as f32 })
    }

    /// Difference of an ankle's greatest and least height, m.
    fn lift_m(&self, side: usize) -> f64 {
        let heights = || (0..self.clip.frame_count()).map(|frame| self.ankle_height_m(frame, side));
        heights().fold(f64::NEG_INFINITY, f64::max) - heights().fold(f64::INFINITY, f64::min)
    }

    fn jump(&self) -> Option<Warning> {
        let frames = 0..self.clip.frame_count();
        let standing_m = [0, 1].map(|side| {
            let heights = frames.clone().map(|frame| self.ankle_height_m(frame, side));
            lower_quantile(heights, STANDING_QUANTILE).unwrap_or_default()
        });
        let lift_m = |frame: usize, side: usize| self.ankle_height_m(frame, side) - standing_m[side];
        let lower_m = |frame: usize| lift_m(frame, 0).min(lift_m(frame, 1));
        let highest_m = frames.clone().map(lower_m).fold(0.0, f64::max);
        (self.steps.is_empty() && highest_m > JUMP_LIFT_MIN_M * self.scale)
            .then_some(Warning::Jump { lift_cm: (100.0 * highest_m) as f32 })
    }
}

fn is_of_leg(joint: Joint) -> bool {
    [Joint::THIGHS, Joint::SHANKS, Joint::FEET].concat().contains(&joint)
}

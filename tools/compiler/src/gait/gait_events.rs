//! Contacts → stances: the instants at which a foot touches the ground and leaves it, finer than frames.
//!
//! Slide needs to know in which frames a foot is planted; an event of the gait is one instant. Between swing and stance
//! the contact point ([`crate::gait::contacts`]) is slow *and* low no more: (h/h₀)² + (v/v₀)² = 1, where h is its height over
//! where it is in this contact and v its speed in space. Heels strike behind the ankle: the heel is one of the sole
//! here.
//!
//! A foot that rolls off over its toes may creep before it leaves, more so in captures of 120 frames a second, where
//! markers on the shoe tremble. So a toe-off is no earlier than the onset of the swing: a leg swings nearly as a
//! pendulum and gathers speed evenly, so that the tangent to its speed where that grows fastest leads back to the
//! instant of release, whatever the frame rate and however fast the step. Frames of the clip, metres, seconds.

use std::ops::Range;

use glam::DVec3;

use crate::gait::contacts::runs;
use crate::ground::root_motion::percentile;

/// A foot that stands still on the ground is no higher than this over where it is in this contact, metres. It leaves
/// about where it stood; in some captures it lands higher and sinks by up to this through a stance.
const STRIKE_HEIGHT_MAX_M: f64 = 0.05;
const OFF_HEIGHT_MAX_M: f64 = 0.03;
/// A foot at its height is no faster than this and a share of the body's speed, m/s: fitted to hand labels of a walk, a
/// run, a side-step, a backward walk and a walk at 120 Hz (`tests/gait_events`). At the same height and speed the last
/// of these still stands where a walk at 30 Hz has left: no limits meet both.
const STRIKE_SPEED_MAX_MPS: f64 = 0.15;
const STRIKE_SPEED_MAX_SHARE: f64 = 0.2;
const OFF_SPEED_MAX_MPS: f64 = 0.1;
const OFF_SPEED_MAX_SHARE: f64 = 0.23;
/// A runner's toe drags as it pushes off, but no foot leaves faster than this, m/s.
const DRAG_MAX_MPS: f64 = 0.8;
/// Speeds are taken over this time, heights are averaged over it: the frame of the slowest clips, so that 120 frames a
/// second say the same as 30.
const SPAN_S: f64 = 1.0 / 30.0;
/// Within one contact a point's planted height is this percentile of its heights.
const PLANTED_PERCENTILE: f64 = 0.1;
/// The feet of noisy captures slide all the time: one is planted up to this multiple of its median speed in a contact,
/// where that is more than the limit.
const STRIKE_SLIDE_RATIO_MAX: f64 = 1.0;
const OFF_SLIDE_RATIO_MAX: f64 = 1.5;
/// A shorter lift is no swing, seconds, as in [`crate::gait::contacts`].
const LIFT_MIN_S: f64 = 0.1;
/// A foot swings from this share of its greatest speed up to mid-swing on; it has gathered that within this time,
/// seconds. Events hardly move for shares from 0.3 to 0.4; below, it may still creep, above, runners' shanks fold.
const SWING_SPEED_SHARE: f64 = 1.0 / 3.0;
const SWING_ONSET_S: f64 = 0.08;
/// A foot creeps for no longer than this before it swings, seconds: what does is dragged, or turns on the spot.
const CREEP_MAX_S: f64 = 0.05;
/// An end is looked for in steps of a frame over this.
const TICKS_PER_FRAME: usize = 8;
/// A landing foot may slip or bounce once more for less than this, a leaving one drag, seconds; swings last 0.3 s and
/// more.
const STRIKE_SLIP_MAX_S: f64 = 0.05;
const OFF_SLIP_MAX_S: f64 = 0.03;

/// One contact of a foot with the ground.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Stance {
    /// Heel strike, or whatever touches first, frames; −∞ where it lies before the clip.
    pub strike_frame: f64,
    /// Toe-off, or whatever leaves last, frames; ∞ where it lies after the clip.
    pub off_frame: f64,
}

impl Stance {
    /// Of a foot that never leaves the ground.
    pub const ALWAYS: Self = Self { strike_frame: f64::NEG_INFINITY, off_frame: f64::INFINITY };

    /// How deep a frame lies in this stance: frames to its nearer end, negative outside.
    pub fn depth_frames(&self, frame: f64) -> f64 {
        (frame - self.strike_frame).min(self.off_frame - frame)
    }
}

/// Whether a foot with these stances, in order of time, stands at a frame.
pub(crate) fn stands_at(stances: &[Stance], frame: f64) -> bool {
    let begun = stances.partition_point(|stance| stance.strike_frame <= frame);
    stances[..begun].last().is_some_and(|stance| frame <= stance.off_frame)
}

/// The stances of one foot, in order of time: one for each contact in `planted`. `feet` holds the heel on the sole,
/// ball and toe tip, a value a frame.
pub(crate) fn find(feet: &[[DVec3; 3]], planted: &[bool], frame_rate_hz: f64, body_speed_mps: f64) -> Vec<Stance> {
    let runs = runs(planted);
    let [at_strike, at_off] = [Limits::at_strike(body_speed_mps), Limits::at_off(body_speed_mps)];
    let last = ticks(feet.len().saturating_sub(1));
    // Ends may be looked for up to the middle of the swing before or after.
    let middle = |swing: (bool, usize, usize)| (ticks(swing.1) + ticks(swing.2 - 1)) / 2;
    let contacts = runs.iter().enumerate().filter(|(_, run)| run.0);
    let stances = contacts.map(|(index, &(_, start, end))| {
        let contact = Contact::over(feet, start..end, frame_rate_hz);
        let frames = [ticks(start), ticks(end - 1)];
        let earliest = if index < 2 { 0 } else { middle(runs[index - 1]) };
        let latest = if index + 2 < runs.len() { middle(runs[index + 1]) } else { last };
        let strike_frame = contact.end(&at_strike, frames[1], frames[0], earliest);
        let off_frame = contact.release(contact.end(&at_off, frames[0], frames[1], latest), latest);
        Stance {
            strike_frame: if strike_frame > 0.0 { strike_frame } else { f64::NEG_INFINITY },
            off_frame: if off_frame < frame_of(last) { off_frame } else { f64::INFINITY },
        }
    });
    joined(stances, LIFT_MIN_S * frame_rate_hz)
}

/// Stances with less than a swing between them are one.
fn joined(stances: impl Iterator<Item = Stance>, lift_frames: f64) -> Vec<Stance> {
    let mut joined: Vec<Stance> = Vec::new();
    for stance in stances {
        match joined.last_mut() {
            Some(before) if stance.strike_frame - before.off_frame < lift_frames => before.off_frame = stance.off_frame,
            _ => joined.push(stance),
        }
    }
    joined
}

/// Steps in which ends are looked for, from the clip's first frame to this one.
fn ticks(frame: usize) -> isize {
    (frame * TICKS_PER_FRAME) as isize
}

fn frame_of(tick: isize) -> f64 {
    tick as f64 / TICKS_PER_FRAME as f64
}

/// How high and how fast a foot on the ground may be.
struct Limits {
    height_m: f64,
    speed_mps: f64,
    /// Its speed over its median speed in the contact.
    slide_ratio: f64,
    /// How long it may be beyond these limits meanwhile.
    slip_s: f64,
}

impl Limits {
    fn at_strike(body_speed_mps: f64) -> Self {
        Self {
            height_m: STRIKE_HEIGHT_MAX_M,
            speed_mps: STRIKE_SPEED_MAX_MPS + STRIKE_SPEED_MAX_SHARE * body_speed_mps,
            slide_ratio: STRIKE_SLIDE_RATIO_MAX,
            slip_s: STRIKE_SLIP_MAX_S,
        }
    }

    fn at_off(body_speed_mps: f64) -> Self {
        let speed_mps = (OFF_SPEED_MAX_MPS + OFF_SPEED_MAX_SHARE * body_speed_mps).min(DRAG_MAX_MPS);
        Self { height_m: OFF_HEIGHT_MAX_M, speed_mps, slide_ratio: OFF_SLIDE_RATIO_MAX, slip_s: OFF_SLIP_MAX_S }
    }
}

/// One contact of a foot while its ends are looked for.
struct Contact<'a> {
    feet: &'a [[DVec3; 3]],
    /// Where its points are while it is planted.
    heights_m: [f64; 3],
    /// How fast its contact point slides meanwhile, median.
    slide_mps: f64,
    frame_rate_hz: f64,
}

impl<'a> Contact<'a> {
    fn over(feet: &'a [[DVec3; 3]], frames: Range<usize>, frame_rate_hz: f64) -> Self {
        let heights_m = [0, 1, 2].map(|point| {
            let mut heights: Vec<f64> = feet[frames.clone()].iter().map(|foot| foot[point].z).collect();
            percentile(&mut heights, PLANTED_PERCENTILE)
        });
        let mut contact = Self { feet, heights_m, slide_mps: 0.0, frame_rate_hz };
        let mut speeds: Vec<f64> = frames.map(|frame| contact.contact_point(frame as f64).1).collect();
        contact.slide_mps = percentile(&mut speeds, 0.5);
        contact
    }

    /// The frame at which a contact known from tick `inner` to `outer` ends: `outer` moves inward until it is planted,
    /// then outward, over slips, until it is no more; `bound` at the farthest.
    fn end(&self, limits: &Limits, inner: isize, outer: isize, bound: isize) -> f64 {
        let outward = (bound - inner).signum();
        let is_planted = |tick: isize| self.excess(limits, tick) < 1.0;
        let mut edge = outer;
        while edge != inner && !is_planted(edge) {
            edge -= outward;
        }
        if !is_planted(edge) {
            return frame_of(outer) + 0.5 * outward as f64;
        }
        let slip_ticks = (limits.slip_s * self.frame_rate_hz * TICKS_PER_FRAME as f64) as isize + 1;
        let mut tick = edge;
        while tick != bound && (tick - edge).abs() < slip_ticks {
            tick += outward;
            if is_planted(tick) {
                edge = tick;
            }
        }
        if edge == bound { frame_of(bound) } else { self.crossing(limits, edge, edge + outward) }
    }

    /// Where, between a planted tick and the next that is not, the foot is planted no more.
    fn crossing(&self, limits: &Limits, inside: isize, outside: isize) -> f64 {
        let [within, beyond] = [inside, outside].map(|tick| self.excess(limits, tick));
        let share = ((1.0 - within) / (beyond - within)).clamp(0.0, 1.0);
        frame_of(inside) + share * (frame_of(outside) - frame_of(inside))
    }

    /// How far the contact point is beyond being planted: 1 at the end of a contact, less within.
    fn excess(&self, limits: &Limits, tick: isize) -> f64 {
        let (height_m, speed_mps) = self.contact_point(frame_of(tick));
        let speed_max_mps = limits.speed_mps.max(limits.slide_ratio * self.slide_mps);
        let (height, speed) = (height_m / limits.height_m, speed_mps / speed_max_mps);
        height * height + speed * speed
    }

    /// When a foot that creeps from a frame on begins to swing, if it soon does so.
    fn release(&self, creeps_frame: f64, bound: isize) -> f64 {
        let swings_frame = self.swing_onset((creeps_frame * TICKS_PER_FRAME as f64) as isize, bound);
        let latest_frame = frame_of(bound).min(creeps_frame + CREEP_MAX_S * self.frame_rate_hz);
        swings_frame.min(latest_frame).max(creeps_frame)
    }

    /// The frame to which the tangent to the speed of heel and ball, of whichever is slower, leads back from where a
    /// swing gathers speed fastest; −∞ where nothing swings between two ticks.
    fn swing_onset(&self, from: isize, to: isize) -> f64 {
        let speed_mps = |tick: isize| {
            let speeds_mps = self.speeds_mps(frame_of(tick));
            speeds_mps[0].min(speeds_mps[1])
        };
        let fastest_mps = (from..=to).map(speed_mps).fold(0.0, f64::max);
        let swings = (from..=to).find(|&tick| speed_mps(tick) >= SWING_SPEED_SHARE * fastest_mps).unwrap_or(to);
        let half_ticks = (self.half_span_frames() * TICKS_PER_FRAME as f64) as isize;
        let gain_mps = |tick: isize| speed_mps(tick + half_ticks) - speed_mps(tick - half_ticks);
        let before = swings - (SWING_ONSET_S * self.frame_rate_hz * TICKS_PER_FRAME as f64) as isize;
        let steepest = (before..=swings).max_by(|a, b| gain_mps(*a).total_cmp(&gain_mps(*b))).unwrap_or(swings);
        let gain_per_frame_mps = gain_mps(steepest) / (2.0 * frame_of(half_ticks));
        if gain_per_frame_mps > 0.0 {
            frame_of(steepest) - speed_mps(steepest) / gain_per_frame_mps
        } else {
            f64::NEG_INFINITY
        }
    }

    /// Height of the lowest of the foot's points over where it is planted, and its speed; of several as low the
    /// slowest.
    fn contact_point(&self, frame: f64) -> (f64, f64) {
        let half_frames = self.half_span_frames();
        let [from_m, at_m, to_m] =
            [-half_frames, 0.0, half_frames].map(|frames| self.points_m(self.clamped(frame + frames)));
        let speeds_mps = self.speeds_mps(frame);
        let point = |point: usize| {
            let height_m = 0.25 * (from_m[point].z + 2.0 * at_m[point].z + to_m[point].z) - self.heights_m[point];
            (height_m.max(0.0), speeds_mps[point])
        };
        let lower = |a: (f64, f64), b: (f64, f64)| if b < a { b } else { a };
        lower(lower(point(0), point(1)), point(2))
    }

    /// Speeds in space of the foot's points.
    fn speeds_mps(&self, frame: f64) -> [f64; 3] {
        let half_frames = self.half_span_frames();
        let [before, after] = [-half_frames, half_frames].map(|frames| self.clamped(frame + frames));
        let (from_m, to_m) = (self.points_m(before), self.points_m(after));
        [0, 1, 2].map(|point| to_m[point].distance(from_m[point]) * self.frame_rate_hz / (after - before))
    }

    fn half_span_frames(&self) -> f64 {
        0.5 * (SPAN_S * self.frame_rate_hz).max(1.0)
    }

    fn clamped(&self, frame: f64) -> f64 {
        frame.clamp(0.0, (self.feet.len() - 1) as f64)
    }

    /// The foot's points between frames, linearly.
    fn points_m(&self, frame: f64) -> [DVec3; 3] {
        let base = (frame as usize).min(self.feet.len().saturating_sub(2));
        let next = (base + 1).min(self.feet.len() - 1);
        [0, 1, 2].map(|point| self.feet[base][point].lerp(self.feet[next][point], frame - base as f64))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::gait::contacts;
    use crate::retarget::human_clip::HumanPose;
    use crate::synthetic::{self, Walk};

    /// Millimetres to either side, the same at every call.
    fn jitter_m(frame: usize, point: usize, amplitude_m: f64) -> DVec3 {
        let noise = |axis: usize| {
            let seed = libm::sin((frame * 9 + point * 3 + axis) as f64 * 12.9898) * 43758.5453;
            amplitude_m * (2.0 * (seed - libm::floor(seed)) - 1.0)
        };
        DVec3::new(noise(0), noise(1), noise(2))
    }

    /// The synthetic walker's right foot: planted for 0.3 of a period of 1.1 s before and after 0.37, 1.37 … of it.
    fn check_events(frame_rate_hz: f64, amplitude_m: f64, tolerance_s: f64) {
        let clip = synthetic::walk("walk", Walk { frame_rate_hz, ..Walk::default() });
        let foot = |(frame, pose): (usize, &HumanPose)| {
            let points = pose.forward_kinematics(&clip.body).landing_points_m(&clip.body, 1);
            [0, 1, 2].map(|point| points[point] + jitter_m(frame, point, amplitude_m))
        };
        let feet: Vec<[DVec3; 3]> = clip.frames.iter().enumerate().map(foot).collect();
        let contacts = contacts::find(&feet, frame_rate_hz, 1.2, 1.0);
        let stances = find(&feet, &contacts.planted, frame_rate_hz, 1.2);
        assert_eq!(stances.len(), 4, "{stances:?}");
        for (step, stance) in stances.iter().enumerate() {
            let events_s = [stance.strike_frame, stance.off_frame].map(|frame| frame / frame_rate_hz);
            let wanted_s = [0.07, 0.67].map(|cycles| 1.1 * (cycles + step as f64));
            for (found_s, wanted_s) in events_s.into_iter().zip(wanted_s) {
                let off_s = if found_s.is_finite() { found_s - wanted_s } else { 0.0 };
                assert!(off_s.abs() < tolerance_s, "step {step} at {frame_rate_hz} Hz: {found_s} s, not {wanted_s} s");
            }
        }
    }

    #[test]
    fn events_are_found_between_frames() {
        for frame_rate_hz in [24.0, 25.0, 30.0, 50.0, 60.0, 100.0, 120.0] {
            check_events(frame_rate_hz, 0.0, 0.02);
        }
    }

    #[test]
    fn jitter_moves_events_by_less_than_a_frame_at_30() {
        for frame_rate_hz in [24.0, 30.0, 60.0, 120.0] {
            for amplitude_m in [0.001, 0.002, 0.003] {
                check_events(frame_rate_hz, amplitude_m, 1.0 / 30.0);
            }
        }
    }

    /// A foot at rest that creeps at 0.45 m/s from 0.45 s on, lifts and swings from 0.5 s on, and lands at 0.9 s.
    fn creeping_foot(time_s: f64) -> [DVec3; 3] {
        let [creeps_s, swings_s] = [(time_s.min(0.9) - 0.45).max(0.0), (time_s.min(0.9) - 0.5).max(0.0)];
        let phase = std::f64::consts::TAU * swings_s / 0.4;
        let ahead_m = 0.45 * (creeps_s - swings_s) + 0.6 * (swings_s / 0.4 - libm::sin(phase) / std::f64::consts::TAU);
        let place_m = DVec3::new(ahead_m, 0.0, 0.04 * (1.0 - libm::cos(phase)));
        [0.0, 0.15, 0.22].map(|along_m| place_m + DVec3::X * along_m)
    }

    #[test]
    fn a_foot_that_creeps_leaves_the_ground_when_it_swings() {
        for frame_rate_hz in [30.0, 60.0, 120.0] {
            let feet: Vec<[DVec3; 3]> =
                (0..(1.6 * frame_rate_hz) as usize).map(|frame| creeping_foot(frame as f64 / frame_rate_hz)).collect();
            let contacts = contacts::find(&feet, frame_rate_hz, 1.2, 1.0);
            let off_s = find(&feet, &contacts.planted, frame_rate_hz, 1.2)[0].off_frame / frame_rate_hz;
            assert!((off_s - 0.5).abs() < 1.0 / 30.0, "at {frame_rate_hz} Hz: {off_s} s");
        }
    }

    #[test]
    fn a_contact_that_the_clip_cuts_has_no_such_end() {
        let feet = vec![[DVec3::ZERO; 3]; 30];
        assert_eq!(find(&feet, &[true; 30], 30.0, 0.0), [Stance::ALWAYS]);
    }

    #[test]
    fn frames_are_as_deep_in_a_stance_as_its_nearer_end_is_far() {
        let stance = Stance { strike_frame: 4.0, off_frame: 20.5 };
        assert_eq!([3.0, 6.0, 18.0, 22.0].map(|frame| stance.depth_frames(frame)), [-1.0, 2.0, 2.5, -1.5]);
        assert_eq!([3.0, 6.0, 18.0, 22.0].map(|frame| stands_at(&[stance], frame)), [false, true, true, false]);
    }
}

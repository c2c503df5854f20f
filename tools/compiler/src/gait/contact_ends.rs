//! The two ends of one contact of a foot with the ground, finer than frames.
//!
//! Between swing and stance the contact point is slow *and* low no more: (h/h₀)² + (v/v₀)² = 1, where h is its height
//! above its planted height in this contact and v its speed in space. Heels strike behind the ankle: the heel is that
//! of the sole here.
//!
//! A foot lands on any of its points that the source shows. An estimated toe tip lies straight ahead of the ball; the toes
//! of a foot that lands on its ball bend up instead, so that tip would touch the ground too early.
//!
//! A foot that rolls off over its toes may creep before it leaves, more so in captures at 120 frames per second, where
//! markers on the shoe tremble. So a toe-off is not earlier than the onset of the swing. A leg swings nearly as a
//! pendulum and gathers speed evenly: the tangent to its speed where that grows fastest leads back to the instant of
//! release, at any frame rate and any speed of the step.
//!
//! The limits were fitted to events labelled by hand (`tests/gait_events`; history: `docs/tuning.md`). Times in ticks,
//! a fraction of a frame of the clip; world frame: metres, seconds, Z up.

use std::ops::Range;

use glam::DVec3;
use motiondb::statistics::percentile;

/// Greatest height of a landing foot above its planted height in this contact, m: in some captures it then sinks so
/// far.
const STRIKE_HEIGHT_MAX_M: f64 = 0.05;
/// Greatest height of a leaving foot above its planted height in this contact, m.
const OFF_HEIGHT_MAX_M: f64 = 0.03;
/// Greatest speed of a landing foot at its planted height, of a body that stands, m/s; fitted to labels.
const STRIKE_SPEED_MAX_MPS: f64 = 0.15;
/// Share of the body's speed that adds to [`STRIKE_SPEED_MAX_MPS`]; fitted to labels.
const STRIKE_SPEED_MAX_SHARE: f64 = 0.2;
/// Greatest speed of a leaving foot at its planted height, of a body that stands, m/s; fitted to labels.
const OFF_SPEED_MAX_MPS: f64 = 0.1;
/// Share of the body's speed that adds to [`OFF_SPEED_MAX_MPS`]; fitted to labels.
const OFF_SPEED_MAX_SHARE: f64 = 0.23;
/// Greatest speed of a leaving foot at any speed of the body, m/s: a runner's toe drags as it pushes off.
const DRAG_MAX_MPS: f64 = 0.8;
/// Duration over which speeds are taken and heights averaged, s: one frame of the slowest clips.
const SPAN_S: f64 = 1.0 / 30.0;
/// Share of a point's heights within one contact below its planted height.
const PLANTED_PERCENTILE: f64 = 0.1;
/// Speed of a landing foot, divided by its median speed in the contact, up to which it is planted, if its feet slide.
const STRIKE_SLIDE_RATIO_MAX: f64 = 1.0;
/// The same of a leaving foot.
const OFF_SLIDE_RATIO_MAX: f64 = 1.5;
/// Share of a foot's greatest speed up to mid-swing from which it swings. Events hardly move for 0.3 to 0.4.
const SWING_SPEED_SHARE: f64 = 1.0 / 3.0;
/// Duration within which a swinging foot has gathered that speed, s.
const SWING_ONSET_S: f64 = 0.08;
/// Longest creep of a foot before its swing, s; a foot that creeps longer is dragged, or turns on the spot.
const CREEP_MAX_S: f64 = 0.05;
/// Ticks of a frame: steps in which an end is searched.
const TICKS_PER_FRAME: usize = 8;
/// Longest slip or bounce of a landing foot, s; swings last 0.3 s and more.
const STRIKE_SLIP_MAX_S: f64 = 0.05;
/// Longest drag of a leaving foot, s.
const OFF_SLIP_MAX_S: f64 = 0.03;

/// Ticks from the clip's first frame to a frame.
pub(crate) fn ticks(frame: usize) -> isize {
    (frame * TICKS_PER_FRAME) as isize
}

/// The frame of a tick.
pub(crate) fn frame_of(tick: isize) -> f64 {
    tick as f64 / TICKS_PER_FRAME as f64
}

/// Height and speed up to which a foot is on the ground.
pub(crate) struct ContactLimits {
    /// Height above the planted height at speed 0, m.
    height_m: f64,
    /// Speed at the planted height, m/s.
    speed_mps: f64,
    /// Speed divided by the median speed in the contact, where that is more than `speed_mps`.
    slide_ratio: f64,
    /// Duration for which the foot may exceed these limits in between, s.
    slip_s: f64,
    /// Number of points that count, of heel, ball and toe tip.
    points: usize,
}

impl ContactLimits {
    /// Limits of a foot that lands.
    pub(crate) fn at_strike(body_speed_mps: f64, shows_toe_end: bool) -> Self {
        Self {
            height_m: STRIKE_HEIGHT_MAX_M,
            speed_mps: STRIKE_SPEED_MAX_MPS + STRIKE_SPEED_MAX_SHARE * body_speed_mps,
            slide_ratio: STRIKE_SLIDE_RATIO_MAX,
            slip_s: STRIKE_SLIP_MAX_S,
            points: if shows_toe_end { 3 } else { 2 },
        }
    }

    /// Limits of a foot that leaves.
    pub(crate) fn at_off(body_speed_mps: f64) -> Self {
        let speed_mps = (OFF_SPEED_MAX_MPS + OFF_SPEED_MAX_SHARE * body_speed_mps).min(DRAG_MAX_MPS);
        Self {
            height_m: OFF_HEIGHT_MAX_M,
            speed_mps,
            slide_ratio: OFF_SLIDE_RATIO_MAX,
            slip_s: OFF_SLIP_MAX_S,
            points: 3,
        }
    }
}

/// The points of a foot during the whole clip, with what one contact shows of them.
pub(crate) struct ContactPoints<'a> {
    /// Heel on the sole, ball and toe tip at each frame, world, m.
    feet: &'a [[DVec3; 3]],
    /// Planted height of each point in this contact, m.
    heights_m: [f64; 3],
    /// Median speed of the contact point in this contact, m/s.
    slide_mps: f64,
    frame_rate_hz: f64,
}

impl<'a> ContactPoints<'a> {
    /// The contact over some frames.
    pub(crate) fn over(feet: &'a [[DVec3; 3]], frames: Range<usize>, frame_rate_hz: f64) -> Self {
        let heights_m = [0, 1, 2].map(|point| {
            let heights_m = feet[frames.clone()].iter().map(|foot| foot[point].z);
            percentile(heights_m, PLANTED_PERCENTILE).unwrap_or(0.0)
        });
        let mut contact = Self { feet, heights_m, slide_mps: 0.0, frame_rate_hz };
        let speeds_mps = frames.map(|frame| contact.height_and_speed(frame as f64, 3).1);
        contact.slide_mps = percentile(speeds_mps, 0.5).unwrap_or(0.0);
        contact
    }

    /// The frame at which the contact ends; it is known from tick `inner` to tick `outer`.
    ///
    /// The search moves `outer` inward until the foot is planted, then outward, over slips, until it is planted no
    /// more, at most to `bound`.
    pub(crate) fn end_frame(&self, limits: &ContactLimits, inner: isize, outer: isize, bound: isize) -> f64 {
        let outward = (bound - inner).signum();
        let is_planted = |tick: isize| self.excess(limits, tick) < 1.0;
        let mut edge = outer;
        while edge != inner && !is_planted(edge) {
            edge -= outward;
        }
        if !is_planted(edge) {
            return frame_of(outer) + 0.5 * outward as f64;
        }
        let slip_ticks = self.ticks_of(limits.slip_s) + 1;
        let mut tick = edge;
        while tick != bound && (tick - edge).abs() < slip_ticks {
            tick += outward;
            if is_planted(tick) {
                edge = tick;
            }
        }
        if edge == bound { frame_of(bound) } else { self.crossing_frame(limits, edge, edge + outward) }
    }

    /// The frame between a planted tick and the next that is not, at which the limits are reached.
    fn crossing_frame(&self, limits: &ContactLimits, inside: isize, outside: isize) -> f64 {
        let [within, beyond] = [inside, outside].map(|tick| self.excess(limits, tick));
        let share = ((1.0 - within) / (beyond - within)).clamp(0.0, 1.0);
        frame_of(inside) + share * (frame_of(outside) - frame_of(inside))
    }

    /// (h/h₀)² + (v/v₀)² of the contact point: 1 at the end of a contact, less within.
    fn excess(&self, limits: &ContactLimits, tick: isize) -> f64 {
        let (height_m, speed_mps) = self.height_and_speed(frame_of(tick), limits.points);
        let speed_max_mps = limits.speed_mps.max(limits.slide_ratio * self.slide_mps);
        let (height, speed) = (height_m / limits.height_m, speed_mps / speed_max_mps);
        height * height + speed * speed
    }

    /// The frame at which a foot that creeps from a frame on begins to swing; the frame itself where it creeps too
    /// long.
    pub(crate) fn release_frame(&self, creeps_frame: f64, bound: isize) -> f64 {
        let swings_frame = self.swing_onset_frame((creeps_frame * TICKS_PER_FRAME as f64) as isize, bound);
        let latest_frame = frame_of(bound).min(creeps_frame + CREEP_MAX_S * self.frame_rate_hz);
        swings_frame.min(latest_frame).max(creeps_frame)
    }

    /// The frame at which the swing begins: the tangent to the speed of heel and ball (of the slower) where it grows
    /// fastest, followed back to speed 0; −∞ where nothing swings between two ticks.
    fn swing_onset_frame(&self, from: isize, to: isize) -> f64 {
        let speed_mps = |tick: isize| {
            let speeds_mps = self.speeds_mps(frame_of(tick));
            speeds_mps[0].min(speeds_mps[1])
        };
        let fastest_mps = (from..=to).map(speed_mps).fold(0.0, f64::max);
        let swings = (from..=to).find(|&tick| speed_mps(tick) >= SWING_SPEED_SHARE * fastest_mps).unwrap_or(to);
        let half_ticks = (self.half_span_frames() * TICKS_PER_FRAME as f64) as isize;
        let gain_mps = |tick: isize| speed_mps(tick + half_ticks) - speed_mps(tick - half_ticks);
        let before = swings - self.ticks_of(SWING_ONSET_S);
        let steepest = (before..=swings).max_by(|a, b| gain_mps(*a).total_cmp(&gain_mps(*b))).unwrap_or(swings);
        let gain_per_frame_mps = gain_mps(steepest) / (2.0 * frame_of(half_ticks));
        if gain_per_frame_mps > 0.0 {
            frame_of(steepest) - speed_mps(steepest) / gain_per_frame_mps
        } else {
            f64::NEG_INFINITY
        }
    }

    fn ticks_of(&self, duration_s: f64) -> isize {
        (duration_s * self.frame_rate_hz * TICKS_PER_FRAME as f64) as isize
    }

    /// Height of the contact point above its planted height (m), and its speed (m/s): of the lowest of the foot's
    /// points, of several as low the slowest.
    fn height_and_speed(&self, frame: f64, points: usize) -> (f64, f64) {
        let half_frames = self.half_span_frames();
        let [from_m, at_m, to_m] =
            [-half_frames, 0.0, half_frames].map(|frames| self.points_m(self.clamped(frame + frames)));
        let speeds_mps = self.speeds_mps(frame);
        let point = |point: usize| {
            let height_m = 0.25 * (from_m[point].z + 2.0 * at_m[point].z + to_m[point].z) - self.heights_m[point];
            (height_m.max(0.0), speeds_mps[point])
        };
        let lower = |a: (f64, f64), b: (f64, f64)| if b < a { b } else { a };
        (1..points).map(point).fold(point(0), lower)
    }

    /// Speeds in space of the foot's points, m/s.
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

    /// The foot's points between frames, linearly, world, m.
    fn points_m(&self, frame: f64) -> [DVec3; 3] {
        let base = (frame as usize).min(self.feet.len().saturating_sub(2));
        let next = (base + 1).min(self.feet.len() - 1);
        [0, 1, 2].map(|point| self.feet[base][point].lerp(self.feet[next][point], frame - base as f64))
    }
}

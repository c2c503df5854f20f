//! Movements of a clip that may be transitions: from a pause to steps, from steps to a pause, between two pauses, and
//! sharp turns between steps. Each has several cuts, at pauses and at foot strikes; which one is used follows from how
//! well its ends fit the examples ([`crate::transition`]).
//!
//! Times in frames of the clip; seconds, radians.

use std::f64::consts::PI;
use std::ops::Range;

use motiondb::motion::ActionKind;
use serde::{Deserialize, Serialize};

use crate::gait::body_track::BodyTrack;
use crate::gait::foot_stance::FootStance;
use crate::gait::pauses::Pause;

/// Greatest duration of a start or a stop, s: slow starts reach their speed within 2 s (Tirosh & Sparrow 2005: two steps).
const START_MAX_S: f64 = 3.0;
/// Greatest number of strikes at which a start may end, and a stop begin.
const START_STRIKES_MAX: usize = 6;
/// Strikes after a pause before a start may end, and before a pause after a stop may begin: the first step is not yet as
/// long and as fast as the others (Breniere & Do 1986: steady speed at the end of the first or second step).
const BRAKING_STRIKES: usize = 1;
/// Least strikes between two pauses of a body that walks between them; fewer are steps and turns on the spot.
const WALK_STRIKES_MIN: usize = 4;
/// Greatest number of strikes of a turn on the spot.
const TURN_STRIKES_MAX: usize = 8;
/// Greatest duration of a movement between two pauses, s.
const BETWEEN_MAX_S: f64 = 6.0;
/// Greatest duration of a pivot, s.
const PIVOT_MAX_S: f64 = 3.0;
/// Least turn of a pivot, rad: 60°.
const PIVOT_MIN_RAD: f64 = PI / 3.0;
/// Greatest turn of a pivot, rad: 210°, more than about-face. A body that turns farther spins or dances.
const PIVOT_MAX_RAD: f64 = 7.0 * PI / 6.0;
/// Least mean turn rate of a pivot, rad/s: 60 °/s. Slower turns are steady walks in curves.
const PIVOT_RATE_MIN_RAD_S: f64 = PI / 3.0;
/// Greatest turn rate in the step before a pivot and in the one after it, over that of the pivot.
const BESIDE_PIVOT_SHARE: f64 = 0.5;

/// Time outside of a cut at which the steps are compared with the examples again, s: a quarter of a stride.
pub(crate) const BESIDE_S: f64 = 0.25;
/// Half the span over which the velocities of joints are taken, s.
pub(crate) const VELOCITY_SPAN_S: f64 = 1.0 / 30.0;

/// Number of frames before and after a cut that are read.
pub(crate) fn frames_beside_cut(frame_rate_hz: f64) -> usize {
    libm::ceil((BESIDE_S + VELOCITY_SPAN_S) * frame_rate_hz) as usize + 3
}

/// What a movement leads from and to.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub(crate) enum MovementKind {
    /// From a pause to steps.
    Start,
    /// From steps to a pause.
    Stop,
    /// Between two pauses.
    Between,
    /// From steps over a sharp turn to steps.
    Pivot,
}

impl MovementKind {
    /// Whether the body stands at the first frame and at the last.
    pub(crate) const fn stands(self) -> [bool; 2] {
        match self {
            Self::Start => [true, false],
            Self::Stop => [false, true],
            Self::Between => [true, true],
            Self::Pivot => [false, false],
        }
    }

    /// The movement that an action of a kind is.
    pub(crate) const fn of(kind: ActionKind) -> Self {
        match kind {
            ActionKind::Start => Self::Start,
            ActionKind::Stop => Self::Stop,
            ActionKind::Idle | ActionKind::Turn | ActionKind::Step => Self::Between,
            ActionKind::Pivot => Self::Pivot,
        }
    }

    /// The kind of action, of a body whose root turns by so much (rad).
    pub(crate) const fn action(self, turns: bool) -> ActionKind {
        match (self, turns) {
            (Self::Start, _) => ActionKind::Start,
            (Self::Stop, _) => ActionKind::Stop,
            (Self::Between, true) => ActionKind::Turn,
            (Self::Between, false) => ActionKind::Step,
            (Self::Pivot, _) => ActionKind::Pivot,
        }
    }
}

/// A part of a clip that may be a transition.
#[derive(Clone, Debug, Serialize, Deserialize)]
pub(crate) struct Movement {
    /// What it leads from and to.
    pub(crate) kind: MovementKind,
    /// First and last frame of each cut, the shortest cut first.
    pub(crate) cuts: Vec<[f64; 2]>,
    /// Whether each end is a pause that the clip cuts ([`Pause::is_cut`]).
    pub(crate) is_cut: [bool; 2],
}

impl Movement {
    /// First and last frame of all cuts.
    pub(crate) fn frames(&self) -> [f64; 2] {
        self.cuts.iter().fold([f64::INFINITY, 0.0], |[first, last], cut| [cut[0].min(first), cut[1].max(last)])
    }
}

/// A touch of the ground by a foot.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Strike {
    /// Frame, may lie between frames.
    pub(crate) frame: f64,
    /// Facing of the body, without jumps of 2π, rad.
    pub(crate) facing_rad: f64,
}

/// The touches of the ground by both feet within some frames, in order of time.
pub(crate) fn strikes(stances: &[Vec<FootStance>; 2], track: &BodyTrack, frames: &Range<usize>) -> Vec<Strike> {
    let within = frames.start as f64..(frames.end - 1) as f64;
    let all = stances.iter().flatten().map(|stance| stance.strike_frame).filter(|frame| within.contains(frame));
    let strike = |frame: f64| Strike { frame, facing_rad: track.root_at(frame, 0.0).facing_rad };
    let mut strikes: Vec<Strike> = all.map(strike).collect();
    strikes.sort_by(|a, b| a.frame.total_cmp(&b.frame));
    strikes
}

/// The movements within some frames of a clip, in order of time.
pub(crate) fn movements(pauses: &[Pause], strikes: &[Strike], rate_hz: f64, frames: &Range<usize>) -> Vec<Movement> {
    let mut found = Vec::new();
    for gap in 0..=pauses.len() {
        let (before, after) = (gap.checked_sub(1).map(|index| &pauses[index]), pauses.get(gap));
        let first = before.map_or(frames.start, |pause| pause.frames.end - 1) as f64;
        let last = after.map_or(frames.end - 1, |pause| pause.frames.start) as f64;
        let inside: Vec<Strike> =
            strikes.iter().copied().filter(|strike| (first..last).contains(&strike.frame)).collect();
        if let (Some(before), Some(after)) = (before, after) {
            let is_short = (last - first) / rate_hz <= BETWEEN_MAX_S && (1..=TURN_STRIKES_MAX).contains(&inside.len());
            let is_cut = [before.is_cut, after.is_cut];
            found.extend(is_short.then(|| Movement { kind: MovementKind::Between, cuts: vec![[first, last]], is_cut }));
        }
        if before.is_some() && after.is_some() && inside.len() < WALK_STRIKES_MIN {
            continue;
        }
        found.extend(before.map(|pause| start(pause, &inside, after.is_none().then_some(last), rate_hz)));
        found.extend(pivots(&inside, rate_hz));
        found.extend(after.map(|pause| stop(pause, &inside, before.is_none().then_some(first), rate_hz)));
    }
    found.retain(|movement| !movement.cuts.is_empty());
    found
}

/// The start after a pause; `end` is the last frame of a clip that ends while the body walks.
fn start(pause: &Pause, strikes: &[Strike], end: Option<f64>, rate_hz: f64) -> Movement {
    let first = (pause.frames.end - 1) as f64;
    // Before another pause the last two steps brake.
    let usable = if end.is_some() { strikes } else { &strikes[..strikes.len() - 2] };
    let usable = usable.get(BRAKING_STRIKES..).unwrap_or_default();
    let is_near = |last: &f64| (last - first) / rate_hz <= START_MAX_S;
    let ends =
        usable.iter().map(|strike| strike.frame).take(START_STRIKES_MAX).chain(end.filter(|_| !strikes.is_empty()));
    let cuts = ends.filter(is_near).map(|last| [first, last]).collect();
    Movement { kind: MovementKind::Start, cuts, is_cut: [pause.is_cut, false] }
}

/// The stop before a pause; `begin` is the first frame of a clip that begins while the body walks.
fn stop(pause: &Pause, strikes: &[Strike], begin: Option<f64>, rate_hz: f64) -> Movement {
    let last = pause.frames.start as f64;
    // After another pause the first two steps speed up.
    let usable = if begin.is_some() { strikes } else { &strikes[2..] };
    let usable = &usable[..usable.len().saturating_sub(BRAKING_STRIKES)];
    let is_near = |first: &f64| (last - first) / rate_hz <= START_MAX_S;
    let begins = usable
        .iter()
        .rev()
        .map(|strike| strike.frame)
        .take(START_STRIKES_MAX)
        .chain(begin.filter(|_| !strikes.is_empty()));
    let cuts = begins.filter(is_near).map(|first| [first, last]).collect();
    Movement { kind: MovementKind::Stop, cuts, is_cut: [false, pause.is_cut] }
}

/// The sharp turns among the steps of a body that walks: of each, all cuts at two strikes.
fn pivots(strikes: &[Strike], rate_hz: f64) -> Vec<Movement> {
    let turn_rad = |from: usize, to: usize| strikes[to].facing_rad - strikes[from].facing_rad;
    let seconds = |from: usize, to: usize| (strikes[to].frame - strikes[from].frame) / rate_hz;
    let is_pivot = |from: usize, to: usize| {
        let (turned_rad, lasted_s) = (turn_rad(from, to), seconds(from, to));
        let rate_rad_s = turned_rad / lasted_s;
        let is_calm = |from: usize, to: usize| {
            turn_rad(from, to).abs() <= BESIDE_PIVOT_SHARE * rate_rad_s.abs() * seconds(from, to)
        };
        lasted_s <= PIVOT_MAX_S
            && (PIVOT_MIN_RAD..=PIVOT_MAX_RAD).contains(&turned_rad.abs())
            && rate_rad_s.abs() >= PIVOT_RATE_MIN_RAD_S
            && is_calm(from - 1, from)
            && is_calm(to, to + 1)
    };
    let mut found: Vec<Movement> = Vec::new();
    for from in 1..strikes.len().saturating_sub(2) {
        for to in (from + 1..strikes.len() - 1).take_while(|&to| seconds(from, to) <= PIVOT_MAX_S) {
            if !is_pivot(from, to) {
                continue;
            }
            let cut = [strikes[from].frame, strikes[to].frame];
            match found.last_mut().filter(|last| last.cuts.iter().any(|other| other[1] > cut[0])) {
                Some(last) => last.cuts.push(cut),
                None => found.push(Movement { kind: MovementKind::Pivot, cuts: vec![cut], is_cut: [false; 2] }),
            }
        }
    }
    for movement in &mut found {
        movement.cuts.sort_by(|a, b| (a[1] - a[0]).total_cmp(&(b[1] - b[0])).then(a[0].total_cmp(&b[0])));
    }
    found
}

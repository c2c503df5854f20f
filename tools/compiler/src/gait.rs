//! GroundedClip → strides: landmarks from foot contacts, and the steady window in which every stride is like the others.
//!
//! Phase 0 is the middle of a right contact, phase ½ the middle of a left one (`definitions.md`, "Phase"). A stride runs between two
//! landmarks of the same foot with exactly one of the other foot between them, and may begin at either. Times are in frames of the clip.

use std::ops::{Range, RangeInclusive};

use glam::{DQuat, DVec3};
use motiondb::skeleton::Side;

use crate::arc::{Arc, Rates, RootSample};
use crate::contacts::{self, contact_points_m, runs};
use crate::human_clip::{HumanBody, HumanJoints};
use crate::root_motion::{GroundedClip, percentile};

/// A stride takes this long: sprints 0.45 s, the slowest shuffles 2.2 s.
const PERIOD_S: RangeInclusive<f64> = 0.4..=2.5;
/// Share of the period from the first landmark to the second: real clips .40–.60 (`definitions.md`, "Phase").
const HALF_SHARE: RangeInclusive<f64> = 0.32..=0.68;
/// Strides of a steady window differ from their mean by at most: speed (m/s, or this share of it), turn rate, share of the period.
const STEADY_SPEED_MPS: f64 = 0.12;
const STEADY_SPEED_SHARE: f64 = 0.12;
const STEADY_TURN_RAD_S: f64 = 15.0 * std::f64::consts::PI / 180.0;
const STEADY_PERIOD_SHARE: f64 = 0.15;
/// Both feet on the ground for a larger share of a stride: the body stops between steps. Very slow walking: 36 % (Schwartz et al. 2008).
const DOUBLE_SUPPORT_MAX: f64 = 0.45;
/// A stride that neither goes nor turns this far treads on the spot, which is no locomotion: metres, 10°.
const STRIDE_TRAVEL_M: f64 = 0.05;
const STRIDE_TURN_RAD: f64 = 10.0 * std::f64::consts::PI / 180.0;
/// Speeds of the two steps of a stride differ by at most this, or this share of their mean.
const STEP_SPEED_MPS: f64 = 0.2;
const STEP_SPEED_SHARE: f64 = 0.25;
/// Multiples of the contact limits of the definition that are tried.
const LENIENCES: [f64; 3] = [1.0, 1.5, 2.25];
/// Root mean square distance of the joints between both ends of a stride, relative to the root; steps of real people: 1 to 6 cm.
const STRIDE_GAP_M: f64 = 0.1;
/// A body stands that moves slower than this, with its feet planted for nearly all of the clip.
const STANDING_SPEED_MPS: f64 = 0.06;
const STANDING_SHARE_MIN: f64 = 0.95;
/// Shorter clips are poses.
const STANDING_MIN_S: f64 = 0.5;
/// Samples of a stride's root, uniform in time.
const ROOT_SAMPLES: usize = 64;

/// One whole stride of a clip.
#[derive(Clone, Copy, Debug)]
pub struct Stride {
    /// Frame of phase 0; before the stride's first landmark where that is a left one.
    pub zero_frame: f64,
    /// The phase at which the stride begins: 0 or ½.
    pub start_phase: f64,
    /// Frames of the stride.
    pub period_frames: f64,
    /// h: share of the period from right to left mid-stance.
    pub left_share: f64,
    /// Its root; time 0 is the frame of phase 0.
    pub arc: Arc,
    /// Speed of the hips in its first and its second step, m/s.
    pub step_speeds_mps: [f64; 2],
}

impl Stride {
    /// Share of the period from phase 0 to the stride's first landmark.
    fn half_phase_share(&self) -> f64 {
        if self.start_phase > 0.0 { self.left_share } else { 0.0 }
    }
}

/// What the feet do in a clip.
#[derive(Clone, Debug)]
pub enum Gait {
    /// Steady strides, one after the other.
    Steps(Vec<Stride>),
    /// A body that stands, both feet planted.
    Stands,
    /// Neither: why, for the report.
    Unsteady(&'static str),
}

/// A clip's contacts and gait.
#[derive(Clone, Debug)]
pub struct GaitAnalysis {
    /// Planted or not, `[left, right]`, a value a frame.
    pub planted: [Vec<bool>; 2],
    /// Steps, standing or neither.
    pub gait: Gait,
}

/// Finds contacts, landmarks and the longest steady window.
///
/// Contacts are those of the definition where they show steps; the feet of noisy captures are let slide and lift more, as little as it takes.
pub fn analyze(clip: &GroundedClip, body: &HumanBody) -> GaitAnalysis {
    let joints: Vec<HumanJoints> = clip.poses.iter().map(|pose| pose.forward_kinematics(body)).collect();
    let root = RootTrack::of(&joints);
    let feet = [0, 1]
        .map(|side| joints.iter().map(|joints| contact_points_m(joints, body, side)).collect::<Vec<[DVec3; 3]>>());
    let speed_mps = mean_speed_mps(&joints, clip.frame_rate_hz);
    let analyses = LENIENCES.map(|lenience| {
        let contacts = [0, 1].map(|side| contacts::find(&feet[side], clip.frame_rate_hz, speed_mps, lenience));
        let planted = contacts.each_ref().map(|contacts| contacts.planted.clone());
        let stepping = contacts.map(|contacts| contacts.stepping);
        let gait = if stands(&planted, &root, clip) { Gait::Stands } else { steps(clip, &stepping, &joints, &root) };
        GaitAnalysis { planted, gait }
    });
    // The first of the best: `max_by_key` alone would take the last.
    let best = analyses.into_iter().rev().max_by_key(|analysis| analysis.gait.rank());
    best.expect("there is at least one lenience")
}

impl Gait {
    /// More whole strides are better; standing is sure where it is seen at all.
    fn rank(&self) -> usize {
        match self {
            Self::Unsteady(_) => 0,
            Self::Steps(strides) => strides.len(),
            Self::Stands => usize::MAX,
        }
    }
}

/// Mean horizontal speed of the hips, m/s.
fn mean_speed_mps(joints: &[HumanJoints], frame_rate_hz: f64) -> f64 {
    let path: f64 = joints.windows(2).map(|pair| (pair[1].hips_m() - pair[0].hips_m()).truncate().length()).sum();
    path * frame_rate_hz / (joints.len().max(2) - 1) as f64
}

fn stands(planted: &[Vec<bool>; 2], root: &RootTrack, clip: &GroundedClip) -> bool {
    let share = |side: &Vec<bool>| side.iter().filter(|planted| **planted).count() as f64 / side.len() as f64;
    let frames = clip.poses.len() as f64;
    let travelled_m = root.hips_m[root.hips_m.len() - 1].distance(root.hips_m[0]);
    frames >= STANDING_MIN_S * clip.frame_rate_hz
        && travelled_m * clip.frame_rate_hz < STANDING_SPEED_MPS * frames
        && planted.iter().all(|side| share(side) >= STANDING_SHARE_MIN)
}

/// Hips and unwrapped facing, frame by frame.
struct RootTrack {
    hips_m: Vec<glam::DVec2>,
    facing_rad: Vec<f64>,
}

impl RootTrack {
    fn of(joints: &[HumanJoints]) -> Self {
        let mut facing_rad: Vec<f64> = joints.iter().map(HumanJoints::facing_rad).collect();
        for frame in 1..facing_rad.len() {
            let step = facing_rad[frame] - facing_rad[frame - 1];
            facing_rad[frame] -= std::f64::consts::TAU * libm::round(step / std::f64::consts::TAU);
        }
        Self { hips_m: joints.iter().map(|joints| joints.hips_m().truncate()).collect(), facing_rad }
    }

    /// Between frames, linearly.
    fn at(&self, frame: f64, time_s: f64) -> RootSample {
        let base = (frame.max(0.0) as usize).min(self.hips_m.len() - 2);
        let share = frame - base as f64;
        let facing_rad = self.facing_rad[base] + share * (self.facing_rad[base + 1] - self.facing_rad[base]);
        RootSample { time_s, hips_m: self.hips_m[base].lerp(self.hips_m[base + 1], share), facing_rad }
    }
}

/// The middle of a contact.
#[derive(Clone, Copy, Debug)]
struct Landmark {
    side: Side,
    frame: f64,
}

fn steps(clip: &GroundedClip, stepping: &[Vec<bool>; 2], joints: &[HumanJoints], root: &RootTrack) -> Gait {
    let landmarks = landmarks(stepping);
    let strides: Vec<Option<Stride>> = (0..landmarks.len().saturating_sub(2))
        .map(|first| stride(&landmarks[first..first + 3], clip, stepping, root))
        .map(|stride| stride.filter(|stride| closes(stride, joints, clip.frame_rate_hz)))
        .collect();
    let window = match clip.loop_frames {
        Some(round) => round_of_strides(&strides, &landmarks, round as f64),
        None => steady_window(&strides),
    };
    match window {
        Some(strides) if !strides.is_empty() => Gait::Steps(strides),
        _ if strides.iter().all(Option::is_none) => Gait::Unsteady("no whole stride with one step of each foot"),
        _ => Gait::Unsteady("no steady stride"),
    }
}

/// Middles of all contacts, in order of time. Where the clip cuts a contact, its middle is half of a usual contact away from the end that
/// is seen, if that still lies within the clip.
fn landmarks(stepping: &[Vec<bool>; 2]) -> Vec<Landmark> {
    let contacts = stepping.each_ref().map(|frames| {
        runs(frames).into_iter().filter(|run| run.0).map(|(_, start, end)| start..end).collect::<Vec<Range<usize>>>()
    });
    let frames = stepping[0].len();
    let whole = |contact: &&Range<usize>| contact.start > 0 && contact.end < frames;
    let lengths = |side: usize| contacts[side].iter().filter(whole).map(|c| c.len() as f64).collect::<Vec<f64>>();
    let mut landmarks = Vec::new();
    for side in Side::BOTH {
        let own = lengths(side.index());
        let mut usual = if own.is_empty() { lengths(side.other().index()) } else { own };
        let half = 0.5 * (percentile(&mut usual, 0.5) - 1.0).max(0.0);
        let middles = contacts[side.index()].iter().filter_map(|contact| middle(contact, frames, half));
        landmarks.extend(middles.map(|frame| Landmark { side, frame }));
    }
    landmarks.sort_by(|a, b| a.frame.total_cmp(&b.frame));
    landmarks
}

/// The middle of a contact of a clip, `half` a usual contact away from the end that is seen; none where it is not seen or not at all known.
fn middle(contact: &Range<usize>, frames: usize, half: f64) -> Option<f64> {
    let (first, last) = (contact.start as f64, (contact.end - 1) as f64);
    let middle = match (contact.start > 0, contact.end < frames) {
        (true, true) => 0.5 * (first + last),
        (false, true) => last - half,
        (true, false) => first + half,
        (false, false) => return None,
    };
    (half > 0.0 && (first..=last).contains(&middle)).then_some(middle)
}

/// Whether the body is at the end of a stride as it was at its beginning.
fn closes(stride: &Stride, joints: &[HumanJoints], frame_rate_hz: f64) -> bool {
    let local = |frame: f64| {
        let index = (frame + 0.5) as usize;
        let (position_m, facing_rad) = stride.arc.at((index as f64 - stride.zero_frame) / frame_rate_hz);
        let turn = DQuat::from_rotation_z(-facing_rad);
        joints[index.min(joints.len() - 1)].positions_m.map(|joint| turn * (joint - position_m.extend(0.0)))
    };
    let first_frame = stride.zero_frame + stride.period_frames * stride.half_phase_share();
    let (first, last) = (local(first_frame), local(first_frame + stride.period_frames));
    let squares: f64 = first.iter().zip(&last).map(|(a, b)| a.distance_squared(*b)).sum();
    squares < STRIDE_GAP_M * STRIDE_GAP_M * first.len() as f64
}

/// The stride over three landmarks, if it is one.
fn stride(marks: &[Landmark], clip: &GroundedClip, stepping: &[Vec<bool>; 2], root: &RootTrack) -> Option<Stride> {
    let [first, middle, last] = marks else { return None };
    let period_frames = last.frame - first.frame;
    let half_share = (middle.frame - first.frame) / period_frames;
    let alternates = first.side == last.side && first.side != middle.side;
    let in_range = PERIOD_S.contains(&(period_frames / clip.frame_rate_hz)) && HALF_SHARE.contains(&half_share);
    if !alternates || !in_range || pauses(stepping, first.frame, last.frame) {
        return None;
    }
    let (zero_frame, start_phase, left_share) = match first.side {
        Side::Right => (first.frame, 0.0, half_share),
        Side::Left => (middle.frame - period_frames, 0.5, 1.0 - half_share),
    };
    let samples: Vec<RootSample> = (0..=ROOT_SAMPLES)
        .map(|sample| {
            let frames = period_frames * sample as f64 / ROOT_SAMPLES as f64;
            root.at(first.frame + frames, frames / clip.frame_rate_hz)
        })
        .collect();
    let arc = Arc::fit(&samples).shifted((zero_frame - first.frame) / clip.frame_rate_hz);
    let step_speeds_mps = [[first, middle], [middle, last]].map(|[from, to]| {
        let (frames, path) = (to.frame - from.frame, root.at(to.frame, 0.0).hips_m - root.at(from.frame, 0.0).hips_m);
        path.length() * clip.frame_rate_hz / frames
    });
    if !goes_somewhere(&arc.rates, period_frames / clip.frame_rate_hz) {
        return None;
    }
    Some(Stride { zero_frame, start_phase, period_frames, left_share, arc, step_speeds_mps })
}

/// Whether a body goes much faster in one step than in the other: with no other stride to compare with, it starts or stops.
fn speeds_up([first, second]: [f64; 2]) -> bool {
    (second - first).abs() > STEP_SPEED_MPS.max(STEP_SPEED_SHARE * 0.5 * (first + second))
}

fn goes_somewhere(rates: &Rates, period_s: f64) -> bool {
    libm::hypot(rates.speed_mps, rates.strafe_mps) * period_s > STRIDE_TRAVEL_M
        || rates.turn_rate_rad_s.abs() * period_s > STRIDE_TURN_RAD
}

/// Whether both feet stay down too long for a gait.
fn pauses(stepping: &[Vec<bool>; 2], from: f64, to: f64) -> bool {
    let both = (from as usize..to as usize).filter(|&frame| stepping[0][frame] && stepping[1][frame]).count();
    both as f64 > DOUBLE_SUPPORT_MAX * (to - from)
}

/// Of a loop all strides of one round, from the first landmark of its middle copy.
fn round_of_strides(strides: &[Option<Stride>], landmarks: &[Landmark], round: f64) -> Option<Vec<Stride>> {
    // Rounding must not tell a landmark from its copy one round later.
    let first = landmarks.iter().position(|mark| mark.frame >= round - 0.25)?;
    let past = landmarks.iter().position(|mark| mark.frame >= 2.0 * round - 0.25)?;
    let whole = (past - first).is_multiple_of(2) && past > first;
    if !whole {
        return None;
    }
    (first..past).step_by(2).map(|index| strides.get(index).copied().flatten()).collect()
}

/// The longest run of strides, end to end, that are like their mean; of several as long, the steadiest.
fn steady_window(strides: &[Option<Stride>]) -> Option<Vec<Stride>> {
    let mut best: Option<(usize, f64, Vec<Stride>)> = None;
    for first in 0..strides.len() {
        for last in (first..strides.len()).step_by(2) {
            // Every stride counts for steadiness, also those that begin with the other foot; every second one goes into the mean.
            let Some(all) = strides[first..=last].iter().copied().collect::<Option<Vec<Stride>>>() else { break };
            let Some(deviation) = deviation(&all) else { continue };
            if all.len() == 1 && speeds_up(all[0].step_speeds_mps) {
                continue;
            }
            let longer = best.as_ref().is_none_or(|best| (last - first, -deviation) > (best.0, -best.1));
            if longer {
                best = Some((last - first, deviation, all.into_iter().step_by(2).collect()));
            }
        }
    }
    best.map(|(_, _, strides)| strides)
}

/// The greatest deviation of any stride from the mean, 1 at the limit; none beyond.
fn deviation(strides: &[Stride]) -> Option<f64> {
    let mean = |value: fn(&Stride) -> f64| strides.iter().map(value).sum::<f64>() / strides.len() as f64;
    let spread = |value: fn(&Stride) -> f64, limit: f64| {
        let mean = mean(value);
        strides.iter().map(|stride| (value(stride) - mean).abs() / limit).fold(0.0, f64::max)
    };
    let (forward, left) = (mean(|s| s.arc.rates.speed_mps), mean(|s| s.arc.rates.strafe_mps));
    let speed_limit = STEADY_SPEED_MPS.max(STEADY_SPEED_SHARE * libm::hypot(forward, left));
    let deviation = spread(|s| s.arc.rates.speed_mps, speed_limit)
        .max(spread(|s| s.arc.rates.strafe_mps, speed_limit))
        .max(spread(|s| s.arc.rates.turn_rate_rad_s, STEADY_TURN_RAD_S))
        .max(spread(|s| s.period_frames, STEADY_PERIOD_SHARE * mean(|s| s.period_frames)));
    (deviation <= 1.0).then_some(deviation)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::root_motion::ground;
    use crate::synthetic::{self, Walk};

    fn strides(walk: Walk) -> Vec<Stride> {
        let clip = synthetic::walk("walk", walk);
        match analyze(&ground(&clip, &clip.body), &clip.body).gait {
            Gait::Steps(strides) => strides,
            other => panic!("{other:?}"),
        }
    }

    #[test]
    fn landmarks_come_where_the_feet_stand_under_the_body() {
        for (left_share, frame_rate_hz) in [(0.5, 30.0), (0.45, 60.0), (0.57, 120.0)] {
            for stride in strides(Walk { left_share, frame_rate_hz, ..Walk::default() }) {
                let cycles = stride.zero_frame / frame_rate_hz / 1.1 - 0.37;
                assert!((cycles - libm::round(cycles)).abs() < 0.03, "{stride:?}");
                assert!((stride.left_share - left_share).abs() < 0.03, "{stride:?}");
                assert!((stride.period_frames / frame_rate_hz - 1.1).abs() < 0.03, "{stride:?}");
            }
        }
    }

    #[test]
    fn contacts_that_the_clip_cuts_still_mark_a_stride() {
        // The second right contact is cut after 64 % of it.
        assert_eq!(strides(Walk { duration_s: 1.6, ..Walk::default() }).len(), 1);
    }

    #[test]
    fn of_a_clip_that_speeds_up_only_the_steady_part_counts() {
        let clip = |speed_mps| {
            synthetic::walk("walk", Walk { rates: Rates { speed_mps, ..Rates::default() }, ..Walk::default() })
        };
        let (slow, mut fast) = (clip(0.5), clip(1.1));
        let off_m = slow.frames[240].pelvis_m - fast.frames[0].pelvis_m;
        fast.frames.truncate(200);
        fast.frames.iter_mut().for_each(|pose| pose.pelvis_m += off_m);
        let mut both = slow;
        both.frames.truncate(240);
        both.frames.extend(fast.frames);
        let Gait::Steps(strides) = analyze(&ground(&both, &both.body), &both.body).gait else { panic!("no steps") };
        assert!(strides.iter().all(|stride| (stride.arc.rates.speed_mps - 0.5).abs() < 0.02), "{strides:?}");
    }

    #[test]
    fn a_body_that_stands_makes_no_steps() {
        let clip = synthetic::idle("idle", 3.0);
        assert!(matches!(analyze(&ground(&clip, &clip.body), &clip.body).gait, Gait::Stands));
    }
}

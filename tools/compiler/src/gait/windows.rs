//! GroundedClip → what the feet do: contacts, steps and their landmarks, steady parts, standing.
//!
//! Phase 0 is the middle of a right contact, phase ½ the middle of a left one (definition "Phase" of
//! `docs/definitions.md`). Between landmarks lie strides ([`crate::gait::stride`]), of which the steady ones
//! ([`crate::gait::steady_strides`]) make examples. Contacts are read several times, more and more leniently: a
//! *reading* is the index of one of these. Times in frames of the clip; world frame, metres.

use std::ops::Range;

use glam::DVec3;
use motiondb::body::Side;
use motiondb::diagnostic::Unfit;
use motiondb::statistics::percentile;

use crate::frame_runs::frame_runs;
use crate::gait::body_track::{BodyPath, BodyTrack};
use crate::gait::contacts::{ContactFrames, contact_readings};
use crate::gait::foot_stance::{FootStance, foot_stances};
use crate::gait::movements::{Strike, strikes};
use crate::gait::pauses::{Pause, pauses};
use crate::gait::standing;
use crate::gait::steady_strides::{ClipSteps, round_of_strides, steady_windows};
use crate::gait::stride::{Landmark, Stride, valid_stride};
use crate::gait::stride_alignment::aligned_strides;
use crate::gait::unsteady_strides::why_unsteady;
use crate::ground::grounded_clip::GroundedClip;
use crate::retarget::human_clip::{HumanBody, HumanJoints};

/// Lenience of each reading: multiples of the contact limits of the definition.
const LENIENCES: [f64; 3] = [1.0, 1.5, 2.25];
/// Index of each reading.
const READINGS: [usize; LENIENCES.len()] = [0, 1, 2];

/// Steps from which a clip that only rests is taken to walk too; fewer shift the weight.
const LOST_STEPS_MIN: usize = 3;

/// What the feet do in a steady part of a clip.
#[derive(Clone, Debug)]
pub enum WindowGait {
    /// Steady strides, end to end.
    Steps(Vec<Stride>),
    /// Frames in which the body stands, both feet planted.
    Stands(Range<usize>),
}

/// A steady part of a clip.
#[derive(Clone, Debug)]
pub struct GaitWindow {
    /// What the feet do in it.
    pub gait: WindowGait,
    /// Index of the reading, in [`GaitAnalysis::stances`], that shows the window.
    pub reading: usize,
    /// First and last frame; of a loop counted in one round.
    pub frames: [f64; 2],
}

/// Contacts and gait of a clip.
#[derive(Clone, Debug)]
pub struct GaitAnalysis {
    /// Stances of each foot, `[left, right]`, by reading: contacts as defined, then more and more leniently.
    pub stances: [[Vec<FootStance>; 2]; LENIENCES.len()],
    /// Steady parts, disjoint in time, the longest first and standing last; or why there is none.
    pub windows: Result<Vec<GaitWindow>, Unfit>,
    /// Frames in which the body stands, in order of time; of a loop within its middle round.
    pub rests: Vec<Range<usize>>,
    /// Frames in which a body without such rests stands more briefly between its strides, as `rests`.
    pub brief_rests: Vec<Range<usize>>,
    /// Where the body stands, if only for a moment, in order of time; of a loop within its middle round.
    pub(crate) pauses: Vec<Pause>,
    /// Touches of the ground, in order of time; of a loop within its middle round.
    pub(crate) strikes: Vec<Strike>,
    /// Where the body is in each frame of the analysed clip.
    pub(crate) path: BodyPath,
    /// Why no window steps although the body makes steps; only of a clip whose windows all stand.
    pub lost_steps: Option<Unfit>,
}

/// Finds contacts, landmarks and steady windows of a clip.
///
/// The reading that shows the most strides counts, of several the strictest: the feet of noisy captures may slide and
/// lift more, as little as it takes. No frame that is left out is in a stride or a rest.
pub(crate) fn analyze_gait(clip: &GroundedClip, body: &HumanBody, left_out: &[Range<usize>]) -> GaitAnalysis {
    let mut left = FootPoints::default();
    let track = BodyTrack::of(clip, body, |joints| left.push(joints, body, 0));
    // One foot after the other: the points of a long clip take much memory.
    let left = left.readings(&track, body.shows_toe_ends[0]);
    let mut right = FootPoints::default();
    (0..track.frame_count()).for_each(|frame| right.push(&track.joints(frame), body, 1));
    let mut sides = [left, right.readings(&track, body.shows_toe_ends[1])];
    let left_out = LeftOutFrames { parts: left_out, loop_frames: clip.loop_frames() };
    let steps = READINGS.map(|reading| {
        let stepping = sides.each_mut().map(|side| std::mem::take(&mut side.contacts[reading].stepping));
        left_out.without_strides(clip_steps(&stepping, &track))
    });
    let planted = READINGS.map(|reading| {
        sides.each_mut().map(|side| left_out.without_frames(std::mem::take(&mut side.contacts[reading].planted)))
    });
    let rests = rests_of(&planted, &track, clip.loop_frames(), standing::REST_MIN_S);
    let windows = gait_windows(&planted, &steps, &rests, &track, clip.loop_frames());
    let brief = || rests_of(&planted, &track, clip.loop_frames(), standing::STANDING_MIN_S);
    let brief_rests = rests.is_none().then(brief).flatten().map_or_else(Vec::new, |(_, rests)| rests);
    let rests = rests.map_or_else(Vec::new, |(_, rests)| rests);
    let stances = READINGS.map(|reading| sides.each_mut().map(|side| std::mem::take(&mut side.stances[reading])));
    let frames = searched_frames(track.frame_count(), clip.loop_frames());
    let lost_steps = lost_steps(&windows, &steps[0], &frames);
    let (pauses_of, strikes_of) = (pauses, strikes);
    let (pauses, strikes) = (Vec::new(), Vec::new());
    let path = BodyPath::default();
    let mut found =
        GaitAnalysis { stances, windows, rests, brief_rests: Vec::new(), pauses, strikes, path, lost_steps };
    found.brief_rests = brief_rests.into_iter().filter(|rest| !found.is_in_strides(rest, clip.loop_frames())).collect();
    found.pauses = pauses_of(&track, found.clearest_stances(), &frames);
    found.strikes = strikes_of(found.clearest_stances(), &track, &frames);
    found.path = BodyPath { hips_m: track.hips_m, facing_rad: track.facing_rad };
    found
}

/// Frames of a clip of which no window is made.
struct LeftOutFrames<'a> {
    parts: &'a [Range<usize>],
    /// Frames of a round, of a loop.
    loop_frames: Option<usize>,
}

impl LeftOutFrames<'_> {
    fn contains(&self, frame: usize) -> bool {
        let frame = self.loop_frames.map_or(frame, |round| frame % round);
        self.parts.iter().any(|part| part.contains(&frame))
    }

    fn without_strides(&self, mut steps: ClipSteps) -> ClipSteps {
        for stride in &mut steps.strides {
            let is_in = |stride: &Stride| {
                (stride.first_frame() as usize..=stride.last_frame() as usize).any(|frame| self.contains(frame))
            };
            stride.take_if(|stride| is_in(stride));
        }
        steps
    }

    fn without_frames(&self, mut planted: Vec<bool>) -> Vec<bool> {
        if !self.parts.is_empty() {
            planted.iter_mut().enumerate().for_each(|(frame, planted)| *planted &= !self.contains(frame));
        }
        planted
    }
}

/// Points of one foot at each frame, world, m.
#[derive(Default)]
struct FootPoints {
    /// Heel, ball and toe tip where slide is measured.
    measured_m: Vec<[DVec3; 3]>,
    /// Heel on the sole.
    heels_m: Vec<DVec3>,
}

/// What one foot does, by reading.
struct FootReadings {
    contacts: [ContactFrames; LENIENCES.len()],
    stances: [Vec<FootStance>; LENIENCES.len()],
}

impl FootPoints {
    fn push(&mut self, joints: &HumanJoints, body: &HumanBody, side: usize) {
        self.measured_m.push(joints.measured_points_m(body, side));
        self.heels_m.push(joints.landing_points_m(body, side)[0]);
    }

    fn readings(mut self, track: &BodyTrack, shows_toe_end: bool) -> FootReadings {
        let (frame_rate_hz, speed_mps) = (track.frame_rate_hz, track.mean_speed_mps());
        let contacts = contact_readings(&self.measured_m, frame_rate_hz, speed_mps, LENIENCES);
        // A foot lands and leaves with the heel of the sole, and with ball and toe tip where slide is measured.
        self.measured_m.iter_mut().zip(&self.heels_m).for_each(|([heel_m, ..], landing_m)| *heel_m = *landing_m);
        let stances = contacts
            .each_ref()
            .map(|contacts| foot_stances(&self.measured_m, shows_toe_end, &contacts.planted, frame_rate_hz, speed_mps));
        FootReadings { contacts, stances }
    }
}

impl GaitAnalysis {
    /// Stances of each foot, `[left, right]`, as the longest steady window shows them; without a window as defined.
    pub fn clearest_stances(&self) -> &[Vec<FootStance>; 2] {
        let reading = self.windows.as_ref().ok().and_then(|windows| windows.first()).map_or(0, |window| window.reading);
        &self.stances[reading]
    }

    /// First and last frame of each window of strides; of a loop counted in one round.
    pub(crate) fn steady_parts(&self) -> Vec<[f64; 2]> {
        let windows = self.windows.iter().flatten();
        windows.filter(|window| matches!(window.gait, WindowGait::Steps(_))).map(|window| window.frames).collect()
    }

    /// Whether some frames of the analysed clip lie in steady strides: a body that side-steps slowly stands for a moment
    /// in each.
    pub(crate) fn is_in_strides(&self, frames: &Range<usize>, loop_frames: Option<usize>) -> bool {
        let middle = 0.5 * (frames.start + frames.end - 1) as f64 - loop_frames.unwrap_or(0) as f64;
        self.steady_parts().iter().any(|[first, last]| (*first..=*last).contains(&middle))
    }
}

/// The windows of a clip, in three cases:
/// - the whole clip stands: one window;
/// - a loop with steady strides: one window of a whole round;
/// - else every steady part, and the longest rest.
fn gait_windows(
    planted: &[[Vec<bool>; 2]],
    steps: &[ClipSteps],
    rests: &Option<(usize, Vec<Range<usize>>)>,
    track: &BodyTrack,
    loop_frames: Option<usize>,
) -> Result<Vec<GaitWindow>, Unfit> {
    let frames = 0..track.frame_count();
    if let Some(reading) = planted.iter().position(|planted| standing::stands(planted, track)) {
        return Ok(vec![GaitWindow::standing(frames, reading, 0)]);
    }
    if let Some(window) = loop_frames.and_then(|round| whole_round(steps, round, track)) {
        return Ok(vec![window]);
    }
    let frames = searched_frames(frames.len(), loop_frames);
    let before = loop_frames.unwrap_or(0);
    let mut windows: Vec<GaitWindow> = steady_windows(steps, [frames.start as f64, (frames.end - 1) as f64])
        .into_iter()
        .map(|window| GaitWindow::stepping(aligned_strides(&window.strides, track), window.reading, before))
        .collect();
    windows.extend(rests.iter().filter_map(|(reading, rests)| {
        Some(GaitWindow::standing(standing::longest(rests)?.clone(), *reading, before))
    }));
    if windows.is_empty() { Err(why_unsteady(&steps[0], &frames)) } else { Ok(windows) }
}

/// The rests of a clip that last longer than `least_s` seconds, by the strictest reading that shows one, and that
/// reading. A clip that stands is one rest.
fn rests_of(
    planted: &[[Vec<bool>; 2]],
    track: &BodyTrack,
    loop_frames: Option<usize>,
    least_s: f64,
) -> Option<(usize, Vec<Range<usize>>)> {
    let frames = searched_frames(track.frame_count(), loop_frames);
    if let Some(reading) = planted.iter().position(|planted| standing::stands(planted, track)) {
        return Some((reading, vec![frames]));
    }
    let of_readings = planted.iter().map(|planted| standing::rests(planted, track, frames.clone(), least_s));
    of_readings.enumerate().find(|(_, rests)| !rests.is_empty())
}

/// The frames of a clip in which windows are searched. A loop that is not steady is a capture that ends as it began: its
/// middle copy has all of it.
pub(crate) fn searched_frames(frame_count: usize, loop_frames: Option<usize>) -> Range<usize> {
    loop_frames.map_or(0..frame_count, |round| round..2 * round + 1)
}

impl GaitWindow {
    /// The window of strides; its frames are counted from frame `before` of the analysed clip.
    fn stepping(strides: Vec<Stride>, reading: usize, before: usize) -> Self {
        let frames = [strides[0].first_frame(), strides[strides.len() - 1].last_frame()];
        Self { gait: WindowGait::Steps(strides), reading, frames: frames.map(|frame| frame - before as f64) }
    }

    /// The window of a rest; its frames are counted from frame `before` of the analysed clip.
    fn standing(rest: Range<usize>, reading: usize, before: usize) -> Self {
        let frames = [rest.start - before, rest.end - 1 - before].map(|frame| frame as f64);
        Self { gait: WindowGait::Stands(rest), reading, frames }
    }
}

/// All strides of a loop, by the first reading that shows the most.
fn whole_round(steps: &[ClipSteps], round: usize, track: &BodyTrack) -> Option<GaitWindow> {
    let rounds = steps.iter().enumerate().filter_map(|(reading, steps)| {
        Some((reading, round_of_strides(steps, round as f64).filter(|strides| !strides.is_empty())?))
    });
    // The first of the longest: `max_by_key` alone would take the last.
    let (reading, strides) = rounds.rev().max_by_key(|(_, strides)| strides.len())?;
    let gait = WindowGait::Steps(aligned_strides(&strides, track));
    Some(GaitWindow { gait, reading, frames: [0.0, round as f64] })
}

/// Landmarks and strides of one reading.
fn clip_steps(stepping: &[Vec<bool>; 2], track: &BodyTrack) -> ClipSteps {
    let landmarks = landmarks(stepping);
    let strides = landmarks.windows(3).map(|marks| valid_stride(marks, stepping, track)).collect();
    ClipSteps { landmarks, strides }
}

/// Why a clip whose windows all stand gives no window of its steps; `None` where it makes hardly any.
fn lost_steps(windows: &Result<Vec<GaitWindow>, Unfit>, steps: &ClipSteps, frames: &Range<usize>) -> Option<Unfit> {
    let is_rest = |window: &GaitWindow| matches!(window.gait, WindowGait::Stands(_));
    let only_rests = windows.as_ref().is_ok_and(|windows| windows.iter().all(is_rest));
    (only_rests && steps.landmarks.len() >= LOST_STEPS_MIN).then(|| why_unsteady(steps, frames))
}

/// Middles of all contacts, in order of time.
///
/// Where the clip cuts a contact, its middle is half of a usual contact away from the visible end, if that still lies
/// within the clip.
fn landmarks(stepping: &[Vec<bool>; 2]) -> Vec<Landmark> {
    let contacts = stepping.each_ref().map(|frames| frame_runs(frames, true));
    let frames = stepping[0].len();
    let whole = |contact: &&Range<usize>| contact.start > 0 && contact.end < frames;
    let lengths = |side: usize| contacts[side].iter().filter(whole).map(|c| c.len() as f64).collect::<Vec<f64>>();
    let mut landmarks = Vec::new();
    for side in Side::BOTH {
        let own = lengths(side.index());
        let known = if own.is_empty() { lengths(side.other().index()) } else { own };
        let half = 0.5 * (percentile(known, 0.5).unwrap_or(0.0) - 1.0).max(0.0);
        let middles = contacts[side.index()].iter().filter_map(|contact| contact_middle(contact, frames, half));
        landmarks.extend(middles.map(|frame| Landmark { side, frame }));
    }
    landmarks.sort_by(|a, b| a.frame.total_cmp(&b.frame));
    landmarks
}

/// The middle frame of a contact; `half` a usual contact from the visible end where the clip of `frames` cuts the
/// other.
fn contact_middle(contact: &Range<usize>, frames: usize, half: f64) -> Option<f64> {
    let (first, last) = (contact.start as f64, (contact.end - 1) as f64);
    let middle = match (contact.start > 0, contact.end < frames) {
        (true, true) => 0.5 * (first + last),
        (false, true) => last - half,
        (true, false) => first + half,
        (false, false) => return None,
    };
    (half > 0.0 && (first..=last).contains(&middle)).then_some(middle)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::ground::loop_unrolling::unrolled;
    use crate::ground::root_arc::Rates;
    use crate::ground::root_motion::grounded_clip;
    use crate::retarget::human_clip::HumanPose;
    use crate::synthetic::{self, SyntheticWalk};

    fn strides(walk: SyntheticWalk) -> Vec<Stride> {
        synthetic::strides_of(&synthetic::walk("walk", walk))
    }

    #[test]
    fn landmarks_are_mid_stances() {
        for (left_share, frame_rate_hz) in [(0.5, 30.0), (0.45, 60.0), (0.57, 120.0)] {
            for stride in strides(SyntheticWalk { left_share, frame_rate_hz, ..SyntheticWalk::default() }) {
                let cycles = stride.zero_frame / frame_rate_hz / 1.1 - 0.37;
                assert!((cycles - libm::round(cycles)).abs() < 0.03, "{stride:?}");
                assert!((stride.left_share - left_share).abs() < 0.03, "{stride:?}");
                assert!((stride.period_frames / frame_rate_hz - 1.1).abs() < 0.03, "{stride:?}");
            }
        }
    }

    #[test]
    fn slow_walks_have_strides() {
        let rates = Rates { speed_mps: 0.6, ..Rates::default() };
        let mut clip = synthetic::walk("walk", SyntheticWalk { rates, ..SyntheticWalk::default() });
        clip.frame_rate_hz /= 3.5;
        let periods_s =
            synthetic::strides_of(&clip).into_iter().map(|stride| stride.period_frames / clip.frame_rate_hz);
        let periods_s: Vec<f64> = periods_s.collect();
        assert!(
            !periods_s.is_empty() && periods_s.iter().all(|period_s| (period_s - 3.85).abs() < 0.1),
            "{periods_s:?}"
        );
    }

    #[test]
    fn contacts_cut_by_the_clip_still_mark_a_stride() {
        // The second right contact is cut after 64 % of it.
        assert_eq!(strides(SyntheticWalk { duration_s: 1.6, ..SyntheticWalk::default() }).len(), 1);
    }

    #[test]
    fn a_change_of_speed_parts_two_windows() {
        let clip = |speed_mps| {
            let rates = Rates { speed_mps, ..Rates::default() };
            synthetic::walk("walk", SyntheticWalk { rates, ..SyntheticWalk::default() })
        };
        let (slow, mut fast) = (clip(0.5), clip(1.1));
        let offset_m = slow.frames[240].pelvis_m - fast.frames[0].pelvis_m;
        fast.frames.truncate(200);
        fast.frames.iter_mut().for_each(|pose| pose.pelvis_m += offset_m);
        let mut both = slow;
        both.frames.truncate(240);
        both.frames.extend(fast.frames);
        let windows = analyze_gait(&grounded_clip(&both, &both.body), &both.body, &[]).windows.unwrap();
        let [before, after] = &windows[..] else { panic!("{windows:?}") };
        for (window, frames, speed_mps) in [(before, 0.0..=245.0, 0.5), (after, 235.0..=440.0, 1.1)] {
            let WindowGait::Steps(strides) = &window.gait else { panic!("{window:?}") };
            assert!(strides.iter().all(|stride| (stride.arc.rates.speed_mps - speed_mps).abs() < 0.02), "{window:?}");
            assert!(window.frames.iter().all(|frame| frames.contains(frame)), "{window:?}");
        }
    }

    #[test]
    fn a_rest_reports_why_its_walk_is_lost() {
        let lost = |walked_s: f64| {
            let mut clip = synthetic::walk("walk", SyntheticWalk { duration_s: walked_s, ..SyntheticWalk::default() });
            let rest = vec![clip.frames[0].clone(); (2.0 * clip.frame_rate_hz) as usize];
            clip.frames.splice(0..0, rest);
            let found = analyze_gait(&grounded_clip(&clip, &clip.body), &clip.body, &[]);
            assert!(matches!(found.windows.unwrap().last().unwrap().gait, WindowGait::Stands(_)));
            found.lost_steps
        };
        assert_eq!(lost(1.4), Some(Unfit::NoWholeStride));
        assert_eq!(lost(4.0), None);
    }

    #[test]
    fn unsteady_loops_give_their_steady_parts() {
        let clip = |speed_mps| {
            let rates = Rates { speed_mps, ..Rates::default() };
            synthetic::walk("loop", SyntheticWalk { rates, duration_s: 4.4, ..SyntheticWalk::default() }).frames
        };
        let mut both = synthetic::walk("loop", SyntheticWalk::default());
        both.frames.clear();
        for part in [clip(0.6), clip(1.0), clip(0.6)] {
            let from_m = both.frames.pop().map_or(part[0].pelvis_m, |last: HumanPose| last.pelvis_m);
            let offset_m = from_m - part[0].pelvis_m;
            both.frames.extend(part.into_iter().map(|pose| HumanPose { pelvis_m: pose.pelvis_m + offset_m, ..pose }));
        }
        both.frames.truncate(2 * 264 + 1);
        let rounds = unrolled(grounded_clip(&both, &both.body), &both.body);
        assert!(rounds.loop_frames().is_some());
        let windows = analyze_gait(&rounds, &both.body, &[]).windows.unwrap();
        let speeds_mps = windows.iter().filter_map(|window| match &window.gait {
            WindowGait::Steps(strides) => Some(strides[0].arc.rates.speed_mps),
            WindowGait::Stands(_) => None,
        });
        let speeds_mps: Vec<f64> = speeds_mps.collect();
        for part_mps in [0.6, 1.0] {
            assert!(speeds_mps.iter().any(|speed| (speed - part_mps).abs() < 0.1), "{speeds_mps:?}");
        }
    }

    #[test]
    fn all_strides_of_a_loop_count() {
        let rates = Rates { speed_mps: 0.7, turn_rate_rad_s: 0.8, strafe_mps: 0.0 };
        let clip = synthetic::walk("loop", SyntheticWalk { rates, duration_s: 2.2, ..SyntheticWalk::default() });
        let rounds = unrolled(grounded_clip(&clip, &clip.body), &clip.body);
        assert_eq!(rounds.loop_frames(), Some(132));
        let windows = analyze_gait(&rounds, &clip.body, &[]).windows.unwrap();
        let [GaitWindow { gait: WindowGait::Steps(strides), .. }] = &windows[..] else { panic!("{windows:?}") };
        assert_eq!(strides.len(), 2);
        for stride in strides {
            assert!((stride.arc.rates.speed_mps - 0.7).abs() < 0.01, "{stride:?}");
            assert!((stride.arc.rates.turn_rate_rad_s - 0.8).abs() < 0.01, "{stride:?}");
        }
    }

    #[test]
    fn standing_clips_have_one_window() {
        let clip = synthetic::idle("idle", 3.0);
        let windows = analyze_gait(&grounded_clip(&clip, &clip.body), &clip.body, &[]).windows.unwrap();
        assert!(
            matches!(windows[..], [GaitWindow { gait: WindowGait::Stands(_), frames: [0.0, 180.0], .. }]),
            "{windows:?}"
        );
    }
}

//! HumanClip → AnalyzedClip: the clip on the target body and its steady cycles, or why it gives none.
//!
//! # Steps
//! 1. Find the gait on the performer's own body ([`crate::gait::performer_gait`]).
//! 2. Put the clip, and the windows of the gait, on the target body.
//! 3. Close each window into a steady cycle, or find why it is unfit ([`crate::cycle::steady_cycle`]).

use std::ops::Range;

use glam::DQuat;
use motiondb::diagnostic::{Diagnostic, Note, Unfit};
use motiondb::motion::SourceRecord;
use serde::{Deserialize, Serialize};

use crate::cycle::corners::{Corner, SHOWN_SHARE, SharpTurn, sharp_turns};
use crate::cycle::flaws::standing_flaws;
use crate::cycle::foot_slide::follow_feet;
use crate::cycle::mean_stride::{frames_beside, mean_stride};
use crate::cycle::rest::Rest;
use crate::cycle::steady_cycle::{SteadyCycle, SteadyMotion};
use crate::gait::foot_stance::FootStance;
use crate::gait::movements::{Movement, MovementKind, frames_beside_cut, movements};
use crate::gait::pauses::Pause;
use crate::gait::performer_gait::PerformerGait;
use crate::gait::windows::{GaitAnalysis, GaitWindow, WindowGait, searched_frames};
use crate::ground::grounded_clip::GroundedClip;
use crate::ground::head_bends::bend_head;
use crate::retarget::human_clip::{HumanBody, HumanClip};
use crate::retarget::posture::LowPart;

/// Least duration of a part that is not upright and is reported, s.
const LOW_PART_MIN_S: f64 = 0.5;

/// A clip on the target body, and its steady windows that may become examples.
#[derive(Serialize, Deserialize)]
pub(crate) struct AnalyzedClip {
    /// The clip on the target body; after [`Self::keep_needed`] some of its poses.
    pub(crate) grounded: GroundedClip<'static>,
    /// Number of frames of the clip, one round of a loop.
    pub(crate) frame_count: usize,
    /// Steady windows, the longest first.
    pub(crate) windows: Vec<SteadyCycle>,
    /// Frames of the clip in which the body stands, in order of time; of a loop within its middle round.
    pub(crate) rests: Vec<Range<usize>>,
    /// Frames in which a body without such rests stands briefly, as `rests`; they count where no other clip stands.
    pub(crate) brief_rests: Vec<Range<usize>>,
    /// Stances of each foot, `[left, right]`.
    pub(crate) stances: [Vec<FootStance>; 2],
    /// Where transitions may lie, in order of time; of a loop within its middle round.
    pub(crate) movements: Vec<Movement>,
    /// Sharp turns of the walking body that no steady window shows, in order of time.
    pub(crate) corners: Vec<Corner>,
    /// Diagnostics of the clip as a whole.
    pub(crate) diagnostics: Vec<Diagnostic>,
    /// Steady windows that give no example beside others.
    pub(crate) left_out: LeftOutWindows,
}

/// Counts of steady windows of a clip that give no example beside others.
#[derive(Default, Serialize, Deserialize)]
pub(crate) struct LeftOutWindows {
    /// Windows whose feet slide or are hardly planted.
    pub(crate) doubtful: usize,
    /// Windows near-equal to one that is as good or better.
    pub(crate) near_equal: usize,
    /// Windows near-equal to a better one, in which the body carries itself otherwise.
    other_carriage: usize,
    /// First and last second of the longest of these and of the better one.
    longest_of_other_carriage_s: [[f64; 2]; 2],
}

impl AnalyzedClip {
    /// Analyses one clip. It has no frames afterwards: its poses are changed in place, so that the poses of an hour are
    /// held once.
    pub(crate) fn of(clip: &mut HumanClip, body: &HumanBody) -> Self {
        let frame_count = clip.frames.len();
        let growth = body.leg_length_m() / clip.body.leg_length_m();
        let performer = PerformerGait::of(clip);
        let grounded = performer.clip_on(clip, body);
        let found = clip.unfit.clone().map_or_else(|| performer.windows_on(&grounded, body), Err);
        let found = found.map_err(|reason| not_upright(clip, frame_count).unwrap_or(reason));
        let times = ClipTimes::of(clip, frame_count);
        let (mut windows, mut reasons, mut doubtful) = (Vec::new(), Vec::new(), 0);
        match found {
            Ok(found) => {
                let (rests, is_in_place) = (&performer.gait.rests[..], clip.in_place_mps.is_some());
                let on_body = ClipOnBody { times: &times, grounded: &grounded, rests, body, growth, is_in_place };
                for window in found {
                    match on_body.steady_cycle(&performer.gait.stances[window.reading], &window) {
                        Ok(steady) => windows.push(steady),
                        Err(unfit) => {
                            doubtful += usize::from(!is_of_arms(&unfit));
                            reasons.push(unfit);
                        }
                    }
                }
            }
            Err(unfit) => reasons.push(unfit),
        }
        if clip.choices.transition.is_some() {
            (windows, reasons) = (Vec::new(), vec![clip.unfit.clone().unwrap_or(Unfit::StatedTransition)]);
        }
        let standing_flaws = standing_flaws(clip);
        windows
            .iter_mut()
            .filter(|window| window.stepping().is_none())
            .for_each(|window| window.flaws += standing_flaws);
        let stances = performer.gait.clearest_stances().clone();
        let movements = clip_movements(clip, &performer.gait, &grounded);
        let corners = clip_corners(clip, &performer.gait, &times, grounded.loop_frames());
        // The parts of a clip that import rejects, or of which a transition is stated, give nothing and are not reported.
        let gives_parts = clip.unfit.is_none() && clip.choices.transition.is_none();
        let (rests, mut brief_rests) = (performer.gait.rests, performer.gait.brief_rests);
        brief_rests.retain(|rest| gives_parts && Rest::of(&grounded, rest, body).unfit().is_none());
        let low_parts = times.low_parts_note(clip.left_out_parts());
        let rests_left_out = times.rests_note(clip, &rests, &grounded, body);
        let mut left_out = LeftOutWindows::default();
        let diagnostics = if windows.is_empty() {
            let reason = reasons.into_iter().next();
            let low_parts = low_parts.filter(|_| !matches!(reason, Some(Unfit::NotUpright { .. })));
            let rests_left_out = rests_left_out.filter(|_| !reason.as_ref().is_some_and(is_of_arms));
            let parts = low_parts.into_iter().chain(rests_left_out).filter(|_| gives_parts);
            reason.map(Diagnostic::NoExample).into_iter().chain(parts.map(Diagnostic::Note)).collect()
        } else {
            left_out.doubtful = doubtful;
            let lost_steps = performer.gait.lost_steps.map(|reason| Note::OnlyRestUsed { reason });
            let in_place = in_place_note(clip, &windows);
            lost_steps
                .into_iter()
                .chain(low_parts)
                .chain(rests_left_out)
                .chain(in_place)
                .map(Diagnostic::Note)
                .collect()
        };
        Self { grounded, frame_count, windows, rests, brief_rests, stances, movements, corners, diagnostics, left_out }
    }

    /// The frames in which something is searched: all, or the middle round of a loop.
    pub(crate) fn searched_frames(&self) -> Range<usize> {
        searched_frames(self.grounded.frame_count(), self.grounded.loop_frames())
    }

    /// Whether the clip may give an example or a transition.
    pub(crate) fn gives_motion(&self) -> bool {
        !self.windows.is_empty() || !self.movements.is_empty()
    }

    /// Leaves the whole clip out, for a reason that only the set shows.
    pub(crate) fn leave_out(&mut self, reason: Unfit) {
        (self.windows, self.movements, self.corners) = Default::default();
        (self.rests, self.brief_rests) = Default::default();
        (self.diagnostics, self.left_out) = (vec![Diagnostic::NoExample(reason)], LeftOutWindows::default());
    }

    /// Frees the poses that no standing cycle, no idle and no transition needs.
    pub(crate) fn keep_needed(mut self) -> Self {
        let stands = self.windows.iter().filter_map(SteadyCycle::standing);
        // Rests give idles only where a window stands.
        let rests = self.rests.iter().filter(|_| self.windows.iter().any(|window| window.standing().is_some()));
        let rests = rests.chain(&self.brief_rests);
        // The cycle of a rest is at most as long as the rest.
        let with_margin = |frames: &Range<usize>| beside(frames.clone(), frames_beside(frames.len()));
        let moves = self.movements.iter().map(|movement| {
            let [first, last] = movement.frames();
            beside(first as usize..last as usize + 2, frames_beside_cut(self.grounded.frame_rate_hz))
        });
        let needed = stands.chain(rests).map(with_margin).chain(moves).collect();
        self.grounded.keep_frames(needed);
        self
    }

    /// Bends the head in all poses. What is known of the clip does not depend on it.
    pub(crate) fn bend_head(&mut self, bend: DQuat) {
        let cycles = self.windows.iter_mut().filter_map(|window| match &mut window.motion {
            SteadyMotion::Steps(cycle) => Some(&mut cycle.rows),
            SteadyMotion::Stands(_) => None,
        });
        cycles.flatten().chain(self.grounded.poses.own_mut()).for_each(|pose| bend_head(pose, bend));
    }

    /// Times of two frames of the analysed clip, s from the file's first frame. The analysed clip of a loop begins a round
    /// before the clip.
    pub(crate) fn in_file_s(&self, clip: &HumanClip, frames: [f64; 2]) -> [f64; 2] {
        let before = self.grounded.loop_frames().unwrap_or(0) as f64;
        frames.map(|frame| ClipTimes::of(clip, self.frame_count).in_file_s(frame - before))
    }

    /// Duration from the first frame to the last, s.
    pub(crate) fn duration_s(&self) -> f64 {
        (self.frame_count - 1) as f64 / self.grounded.frame_rate_hz
    }

    /// The record of the clip, with all diagnostics: of import, of the clip as a whole, of its first window, of each
    /// further window with its time, and of the windows that are left out.
    pub(crate) fn record(&self, clip: &HumanClip) -> SourceRecord {
        let mut record = clip.source.clone();
        let diagnostics = &mut record.diagnostics;
        diagnostics.extend(self.diagnostics.iter().cloned());
        for (index, window) in self.windows.iter().enumerate() {
            let start_s = window.window_s[0] as f32;
            let of_window = |found: Diagnostic| if index == 0 { found } else { found.with_example_start_s(start_s) };
            diagnostics.extend(window.diagnostics.iter().cloned().map(of_window));
        }
        diagnostics.extend(self.left_out.notes().map(Diagnostic::Note));
        record
    }
}

impl LeftOutWindows {
    /// Counts windows in which the body carries itself otherwise than in a better one; first and last second of both.
    pub(crate) fn add_other_carriages(&mut self, windows_s: &[[[f64; 2]; 2]]) {
        self.other_carriage += windows_s.len();
        let duration_s = |[[first_s, last_s], _]: [[f64; 2]; 2]| last_s - first_s;
        for &window_s in windows_s {
            if duration_s(window_s) > duration_s(self.longest_of_other_carriage_s) {
                self.longest_of_other_carriage_s = window_s;
            }
        }
    }

    fn notes(&self) -> impl Iterator<Item = Note> {
        let [near_equal, doubtful, windows] =
            [self.near_equal, self.doubtful, self.other_carriage].map(|count| count as u32);
        let plain = (near_equal + doubtful > 0).then_some(Note::WindowsLeftOut { near_equal, doubtful });
        let [longest_s, kept_s] = self.longest_of_other_carriage_s.map(|window_s| window_s.map(|time_s| time_s as f32));
        plain.into_iter().chain((windows > 0).then_some(Note::CarriageLeftOut { windows, longest_s, kept_s }))
    }
}

/// The note on a clip in place that gives a stride.
fn in_place_note(clip: &HumanClip, windows: &[SteadyCycle]) -> Option<Note> {
    let ground_mps = clip.in_place_mps.filter(|_| windows.iter().any(|window| window.stepping().is_some()))?;
    Some(Note::InPlace { speed_mps: ground_mps.length() as f32 })
}

/// Frames and so many before and after them.
fn beside(frames: Range<usize>, margin: usize) -> Range<usize> {
    frames.start.saturating_sub(margin)..frames.end + margin
}

/// The movements of a clip that may be transitions: the body is upright, its pose does not jump, and they are of the
/// kind that a manifest states.
fn clip_movements(clip: &HumanClip, gait: &GaitAnalysis, grounded: &GroundedClip) -> Vec<Movement> {
    if clip.unfit.is_some() {
        return Vec::new();
    }
    let frames = searched_frames(grounded.frame_count(), grounded.loop_frames());
    let before = grounded.loop_frames().unwrap_or(0) as f64;
    let stated = clip.choices.transition;
    let is_between = |pause: &&Pause| stated.is_some() || !gait.is_in_strides(&pause.frames, grounded.loop_frames());
    let pauses: Vec<Pause> = gait.pauses.iter().filter(is_between).cloned().collect();
    let mut found = movements(&pauses, &gait.strikes, grounded.frame_rate_hz, &frames);
    let left_out = clip.left_out_frames();
    let is_left_out = |movement: &Movement| {
        let [first, last] = movement.frames();
        let is_part = |part: &Range<usize>| first - before < part.end as f64 && part.start as f64 <= last - before;
        left_out.iter().any(is_part)
    };
    let is_stated = |movement: &Movement| stated.is_none_or(|kind| MovementKind::of(kind) == movement.kind);
    found.retain(|movement| is_stated(movement) && !is_left_out(movement));
    found
}

/// Whether a rest is left out because of how the body holds its arms.
fn is_of_arms(unfit: &Unfit) -> bool {
    matches!(unfit, Unfit::TPose | Unfit::ArmsOut | Unfit::ArmRaised)
}

/// The reason that the body is not upright for most of a clip, if it is so.
fn not_upright(clip: &HumanClip, frame_count: usize) -> Option<Unfit> {
    let low_frames: usize = clip.left_out_parts().iter().map(|part| part.frames.len()).sum();
    let longest = longest_part(clip.left_out_parts())?;
    (2 * low_frames > frame_count).then_some(Unfit::NotUpright { posture: longest.posture })
}

fn longest_part(parts: &[LowPart]) -> Option<&LowPart> {
    // The first of the longest: `max_by_key` alone would take the last.
    parts.iter().rev().max_by_key(|part| part.frames.len())
}

/// The corners of a clip that no steady window shows; none in parts that are left out.
fn clip_corners(clip: &HumanClip, gait: &GaitAnalysis, times: &ClipTimes, loop_frames: Option<usize>) -> Vec<Corner> {
    if clip.unfit.is_some() {
        return Vec::new();
    }
    let before = loop_frames.unwrap_or(0);
    let frames = searched_frames(gait.path.hips_m.len(), loop_frames);
    let left_out = clip.left_out_frames();
    let steady_s = gait.steady_parts().into_iter().map(|frames| frames.map(|frame| times.in_file_s(frame)));
    let steady_s: Vec<[f64; 2]> = steady_s.collect();
    let corner = |turn: SharpTurn| {
        let frames = turn.frames.start - before..turn.frames.end - before;
        let is_left_out = left_out.iter().any(|part| frames.start < part.end && part.start < frames.end);
        let window_s = [frames.start, frames.end - 1].map(|frame| times.in_file_s(frame as f64));
        let corner = Corner { window_s, turn_rad: turn.turn_rad };
        let is_steady = steady_s.iter().map(|part_s| corner.share_within(*part_s)).sum::<f64>() >= SHOWN_SHARE;
        (!is_left_out && !is_steady).then_some(corner)
    };
    sharp_turns(&gait.path, clip.frame_rate_hz, &frames).into_iter().filter_map(corner).collect()
}

/// The frames of a clip in its file.
struct ClipTimes {
    /// Number of the file's frames before the first frame of the clip.
    first_frame: usize,
    /// Number of frames.
    frame_count: usize,
    frame_rate_hz: f64,
}

impl ClipTimes {
    /// The frames of a clip that has, or had, so many.
    fn of(clip: &HumanClip, frame_count: usize) -> Self {
        Self { first_frame: clip.first_frame, frame_count, frame_rate_hz: clip.frame_rate_hz }
    }

    /// Time of a frame of the clip, s from the file's first frame.
    fn in_file_s(&self, frame: f64) -> f64 {
        let last_frame = (self.frame_count - 1) as f64;
        (self.first_frame as f64 + frame.clamp(0.0, last_frame)) / self.frame_rate_hz
    }

    /// The note on parts that are not upright; none of parts that are shorter than a step.
    fn low_parts_note(&self, parts: &[LowPart]) -> Option<Note> {
        let duration_s = |part: &LowPart| part.frames.len() as f64 / self.frame_rate_hz;
        let counted = || parts.iter().filter(|part| duration_s(part) > LOW_PART_MIN_S);
        let LowPart { frames, posture } = longest_part(parts).filter(|part| duration_s(part) > LOW_PART_MIN_S)?;
        Some(Note::LowPartsLeftOut {
            posture: *posture,
            longest_s: [frames.start, frames.end - 1].map(|frame| self.in_file_s(frame as f64) as f32),
            total_s: counted().map(duration_s).sum::<f64>() as f32,
            more: counted().count() as u32 - 1,
        })
    }

    /// First and last second of a rest of the analysed clip.
    fn of_rest_s(&self, rest: &Range<usize>, grounded: &GroundedClip) -> [f64; 2] {
        let before = grounded.loop_frames().unwrap_or(0) as f64;
        [rest.start, rest.end - 1].map(|frame| self.in_file_s(frame as f64 - before))
    }

    /// The note on rests in which the body does not stand at ease, and on bind poses.
    fn rests_note(
        &self,
        clip: &HumanClip,
        rests: &[Range<usize>],
        grounded: &GroundedClip,
        body: &HumanBody,
    ) -> Option<Note> {
        let unfit = |frames: &Range<usize>| {
            let reason = Rest::of(grounded, frames, body).unfit()?;
            Some((frames.len(), self.of_rest_s(frames, grounded), reason))
        };
        let spread = |frames: &Range<usize>| {
            let window_s = [frames.start, frames.end - 1].map(|frame| self.in_file_s(frame as f64));
            (frames.len(), window_s, Unfit::ArmsOut)
        };
        let rests = rests.iter().filter_map(unfit);
        let left_out: Vec<_> = rests.chain(clip.spread_parts.iter().map(spread)).collect();
        // The first of the longest: `max_by_key` alone would take the last.
        let (_, window_s, reason) = left_out.iter().rev().max_by_key(|(length, _, _)| *length)?;
        Some(Note::RestsLeftOut {
            longest_s: window_s.map(|time_s| time_s as f32),
            reason: reason.clone(),
            more: left_out.len() as u32 - 1,
        })
    }
}

/// A clip on the target body, of which windows become cycles.
struct ClipOnBody<'a> {
    times: &'a ClipTimes,
    grounded: &'a GroundedClip<'static>,
    /// Frames in which the body stands, in order of time.
    rests: &'a [Range<usize>],
    body: &'a HumanBody,
    /// Size of the body over that of the performer.
    growth: f64,
    /// Whether the body does not travel in the source.
    is_in_place: bool,
}

impl ClipOnBody<'_> {
    /// The cycle of the rest with the fewest flaws in which the body stands at ease; or the reason why the longest of all is
    /// unfit.
    fn standing_cycle(&self, longest: &Range<usize>) -> Result<SteadyCycle, Unfit> {
        let cycle = |rest: &Range<usize>| {
            let window_s = self.times.of_rest_s(rest, self.grounded);
            SteadyCycle::of_rest(self.grounded, rest, self.body, window_s)
        };
        let others = self.rests.iter().filter(|rest| *rest != longest).map(cycle);
        let fit = [cycle(longest)].into_iter().chain(others).flatten();
        let best = fit.min_by(|a, b| a.flaws.total_cmp(&b.flaws));
        best.map_or_else(|| cycle(longest), Ok)
    }

    /// The steady cycle of a window, or why it is unfit; `stances` are those of both feet, `[left, right]`.
    fn steady_cycle(&self, stances: &[Vec<FootStance>; 2], window: &GaitWindow) -> Result<SteadyCycle, Unfit> {
        let window_s = window.frames.map(|frame| self.times.in_file_s(frame));
        match &window.gait {
            WindowGait::Stands(longest) => self.standing_cycle(longest),
            WindowGait::Steps(strides) => {
                let mut cycle = mean_stride(self.grounded, self.body, stances, strides);
                if self.is_in_place {
                    follow_feet(&mut cycle, self.body);
                }
                SteadyCycle::of_strides(cycle, strides, self.body, self.growth, window_s)
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use glam::DVec2;

    use super::*;
    use crate::action::idle_loop::idle_loop;
    use crate::cycle::standing_cycle::standing_cycle;
    use crate::retarget::human_clip::HumanPose;
    use crate::synthetic::{SyntheticWalk, idle, performance, walk};

    #[test]
    fn a_walk_in_place_is_named() {
        let codes = |in_place_mps: Option<DVec2>| {
            let mut clip = walk("walk", SyntheticWalk::at(1.1, 0.0, 0.0));
            // Synthetic walks head for .4 rad.
            let root_mps = DVec2::from_angle(0.4).rotate(in_place_mps.unwrap_or_default());
            for (frame, pose) in clip.frames.iter_mut().enumerate() {
                pose.pelvis_m -= (frame as f64 / clip.frame_rate_hz * root_mps).extend(0.0);
            }
            clip.in_place_mps = in_place_mps;
            let body = clip.body.clone();
            let found = AnalyzedClip::of(&mut clip, &body).diagnostics;
            found.iter().map(Diagnostic::code).collect::<Vec<_>>()
        };
        assert_eq!([codes(None), codes(Some(DVec2::new(1.1, 0.0)))], [vec![], vec!["in_place"]]);
    }

    #[test]
    fn rests_and_movements_are_alike_without_the_other_poses() {
        let long = walk("part", SyntheticWalk { duration_s: 12.0, ..SyntheticWalk::default() });
        let parts = [long.clone(), idle("part", 3.0), long];
        for mut clip in [performance("capture", &parts), idle("idle", 2.0)] {
            let body = clip.body.clone();
            let analyzed = AnalyzedClip::of(&mut clip, &body);
            let rest = analyzed.windows.iter().find_map(SteadyCycle::standing).cloned().unwrap();
            let cycle = |clip: &GroundedClip| standing_cycle(clip, &body, rest.clone(), 1.1).rows;
            let idles = |found: &AnalyzedClip| -> Vec<Vec<HumanPose>> {
                found.rests.iter().map(|rest| idle_loop(&found.grounded, &body, rest).poses).collect()
            };
            let cuts = |found: &AnalyzedClip| -> Vec<HumanPose> {
                let ends = found.movements.iter().flat_map(|movement| movement.cuts.iter().flatten());
                ends.map(|&frame| found.grounded.pose_at(frame, &body)).collect()
            };
            let all = |found: &AnalyzedClip| (cycle(&found.grounded), idles(found), cuts(found));
            let whole = all(&analyzed);
            let count = analyzed.grounded.frame_count();
            let kept = analyzed.keep_needed();
            assert_eq!(all(&kept), whole);
            assert_eq!(kept.grounded.frame_count(), count);
        }
    }
}

//! GroundedClip → what the feet do: contacts, steps and their landmarks, standing.
//!
//! Phase 0 is the middle of a right contact, phase ½ the middle of a left one. Between landmarks lie strides
//! ([`crate::gait::stride`]), of which the steady ones ([`crate::gait::steady_window`]) make examples. Times are in frames of the
//! clip.

use std::ops::Range;

use glam::DVec3;
use motiondb::body::Side;
use motiondb::diagnostic::Unfit;

use crate::gait::contacts::{self, runs};
use crate::gait::gait_events::{self, Stance};
use crate::gait::standing;
use crate::gait::steady_window::{Steps, round_of_strides, steady_windows};
use crate::gait::stride::{BodyTrack, Landmark, Stride, stride};
use crate::gait::stride_alignment::align;
use crate::ground::root_motion::{GroundedClip, percentile};
use crate::retarget::human_clip::HumanBody;

/// Multiples of the contact limits of the definition that are tried.
const LENIENCES: [f64; 3] = [1.0, 1.5, 2.25];

/// A clip that rests and makes so many steps meant to walk: fewer shift its weight.
const LOST_STEPS_MIN: usize = 3;

/// What the feet do in a steady part of a clip.
#[derive(Clone, Debug)]
pub enum Gait {
    /// Steady strides, one after the other.
    Steps(Vec<Stride>),
    /// Frames in which the body stands, both feet planted.
    Stands(Range<usize>),
}

/// A steady part of a clip.
#[derive(Clone, Debug)]
pub struct Window {
    /// Its gait.
    pub gait: Gait,
    /// Which of [`GaitAnalysis::stances`] shows it.
    pub reading: usize,
    /// Its first and its last frame, of a loop counted in one round.
    pub frames: [f64; 2],
}

/// A clip's contacts and gait.
#[derive(Clone, Debug)]
pub struct GaitAnalysis {
    /// When each foot stands on the ground, `[left, right]`: its contacts as defined, then more and more leniently.
    pub stances: [[Vec<Stance>; 2]; LENIENCES.len()],
    /// Steady parts, disjoint in time, the longest first and standing last; or why there is none.
    pub windows: Result<Vec<Window>, Unfit>,
    /// Why no window steps, though the body does: of a clip that rests, too.
    pub lost_steps: Option<Unfit>,
}

/// Finds contacts, landmarks and the steady windows.
///
/// Contacts are those of the definition where they show the most strides; the feet of noisy captures are let slide and
/// lift more, as little as it takes.
pub(crate) fn analyze(clip: &GroundedClip, body: &HumanBody) -> GaitAnalysis {
    let joints = clip.poses.iter().map(|pose| pose.forward_kinematics(body)).collect();
    let track = BodyTrack::of(joints, clip.frame_rate_hz);
    let feet = [0, 1].map(|side| {
        track.joints.iter().map(|joints| joints.measured_points_m(body, side)).collect::<Vec<[DVec3; 3]>>()
    });
    let speed_mps = track.mean_speed_mps();
    let contacts = LENIENCES
        .map(|lenience| [0, 1].map(|side| contacts::find(&feet[side], clip.frame_rate_hz, speed_mps, lenience)));
    let planted = contacts.each_ref().map(|feet| feet.each_ref().map(|contacts| contacts.planted.clone()));
    let steps = contacts.map(|feet| steps(&feet.map(|contacts| contacts.stepping), &track));
    let windows = windows(&planted, &steps, &track, clip.loop_frames);
    let feet = [0, 1]
        .map(|side| track.joints.iter().map(|joints| joints.landing_points_m(body, side)).collect::<Vec<[DVec3; 3]>>());
    let stances = planted.map(|planted| {
        [0, 1].map(|side| gait_events::find(&feet[side], &planted[side], clip.frame_rate_hz, speed_mps))
    });
    let lost_steps = lost_steps(&windows, &steps[0]);
    GaitAnalysis { stances, windows, lost_steps }
}

impl GaitAnalysis {
    /// Of each foot, as the longest steady window shows it; as defined where there is none.
    pub fn clearest_stances(&self) -> &[Vec<Stance>; 2] {
        let reading = self.windows.as_ref().ok().and_then(|windows| windows.first()).map_or(0, |window| window.reading);
        &self.stances[reading]
    }
}

/// A clip that stands, a loop, or whatever is steady in a capture.
fn windows(
    planted: &[[Vec<bool>; 2]],
    steps: &[Steps],
    track: &BodyTrack,
    loop_frames: Option<usize>,
) -> Result<Vec<Window>, Unfit> {
    let frames = 0..track.joints.len();
    if let Some(reading) = planted.iter().position(|planted| standing::stands(planted, track)) {
        return Ok(vec![Window::standing(frames, reading, 0)]);
    }
    if let Some(window) = loop_frames.and_then(|round| whole_round(steps, round, track)) {
        return Ok(vec![window]);
    }
    // A loop that is not steady is a capture that ends as it began: its middle copy has all of it.
    let frames = loop_frames.map_or(frames, |round| round..2 * round + 1);
    let before = loop_frames.unwrap_or(0);
    let mut windows: Vec<Window> = steady_windows(steps, [frames.start as f64, (frames.end - 1) as f64])
        .into_iter()
        .map(|window| Window::stepping(align(&window.strides, track), window.reading, before))
        .collect();
    windows.extend(planted.iter().enumerate().find_map(|(reading, planted)| {
        Some(Window::standing(standing::longest_rest(planted, track, frames.clone())?, reading, before))
    }));
    if windows.is_empty() { Err(why_unsteady(&steps[0])) } else { Ok(windows) }
}

impl Window {
    /// Strides of a clip with some frames before what was given.
    fn stepping(strides: Vec<Stride>, reading: usize, before: usize) -> Self {
        let frames = [strides[0].first_frame(), strides[strides.len() - 1].last_frame()];
        Self { gait: Gait::Steps(strides), reading, frames: frames.map(|frame| frame - before as f64) }
    }

    /// A rest in a clip with some frames before what was given.
    fn standing(rest: Range<usize>, reading: usize, before: usize) -> Self {
        let frames = [rest.start - before, rest.end - 1 - before].map(|frame| frame as f64);
        Self { gait: Gait::Stands(rest), reading, frames }
    }
}

/// All strides of a loop, by the first reading that shows the most.
fn whole_round(steps: &[Steps], round: usize, track: &BodyTrack) -> Option<Window> {
    let rounds = steps.iter().enumerate().filter_map(|(reading, steps)| {
        Some((reading, round_of_strides(steps, round as f64).filter(|strides| !strides.is_empty())?))
    });
    // `max_by_key` alone would take the last.
    let (reading, strides) = rounds.rev().max_by_key(|(_, strides)| strides.len())?;
    Some(Window { gait: Gait::Steps(align(&strides, track)), reading, frames: [0.0, round as f64] })
}

fn steps(stepping: &[Vec<bool>; 2], track: &BodyTrack) -> Steps {
    let landmarks = landmarks(stepping);
    let strides = landmarks.windows(3).map(|marks| stride(marks, stepping, track)).collect();
    Steps { landmarks, strides }
}

fn lost_steps(windows: &Result<Vec<Window>, Unfit>, steps: &Steps) -> Option<Unfit> {
    let rests =
        windows.as_ref().is_ok_and(|windows| windows.iter().all(|window| matches!(window.gait, Gait::Stands(_))));
    (rests && steps.landmarks.len() >= LOST_STEPS_MIN).then(|| why_unsteady(steps))
}

fn why_unsteady(steps: &Steps) -> Unfit {
    if steps.landmarks.is_empty() {
        Unfit::NoStep
    } else if steps.strides.iter().all(Option::is_none) {
        Unfit::NoWholeStride
    } else {
        Unfit::NoSteadyStride
    }
}

/// Middles of all contacts, in order of time. Where the clip cuts a contact, its middle is half of a usual contact away
/// from the end that is seen, if that still lies within the clip.
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

/// The middle of a contact of a clip, `half` a usual contact away from the end that is seen; none where it is not seen
/// or not at all known.
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

#[cfg(test)]
mod tests {
    use super::*;
    use crate::ground::arc::Rates;
    use crate::ground::loop_unrolling::unroll;
    use crate::ground::root_motion::ground;
    use crate::retarget::human_clip::HumanPose;
    use crate::synthetic::{self, Walk};

    fn strides(walk: Walk) -> Vec<Stride> {
        synthetic::strides_of(&synthetic::walk("walk", walk))
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
    fn a_clip_that_speeds_up_has_a_steady_window_before_and_one_after() {
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
        let windows = analyze(&ground(&both, &both.body), &both.body).windows.unwrap();
        let [before, after] = &windows[..] else { panic!("{windows:?}") };
        for (window, frames, speed_mps) in [(before, 0.0..=245.0, 0.5), (after, 235.0..=440.0, 1.1)] {
            let Gait::Steps(strides) = &window.gait else { panic!("{window:?}") };
            assert!(strides.iter().all(|stride| (stride.arc.rates.speed_mps - speed_mps).abs() < 0.02), "{window:?}");
            assert!(window.frames.iter().all(|frame| frames.contains(frame)), "{window:?}");
        }
    }

    #[test]
    fn a_rest_before_too_short_a_walk_tells_what_the_walk_lacks() {
        let lost = |walked_s: f64| {
            let mut clip = synthetic::walk("walk", Walk { duration_s: walked_s, ..Walk::default() });
            let rest = vec![clip.frames[0].clone(); (2.0 * clip.frame_rate_hz) as usize];
            clip.frames.splice(0..0, rest);
            let found = analyze(&ground(&clip, &clip.body), &clip.body);
            assert!(matches!(found.windows.unwrap().last().unwrap().gait, Gait::Stands(_)));
            found.lost_steps
        };
        assert_eq!(lost(1.4), Some(Unfit::NoWholeStride));
        assert_eq!(lost(4.0), None);
    }

    #[test]
    fn a_loop_that_speeds_up_is_taken_for_its_steady_parts() {
        let clip = |speed_mps| {
            let rates = Rates { speed_mps, ..Rates::default() };
            synthetic::walk("loop", Walk { rates, duration_s: 4.4, ..Walk::default() }).frames
        };
        let mut both = synthetic::walk("loop", Walk::default());
        both.frames.clear();
        for part in [clip(0.6), clip(1.0), clip(0.6)] {
            let from_m = both.frames.pop().map_or(part[0].pelvis_m, |last: HumanPose| last.pelvis_m);
            let off_m = from_m - part[0].pelvis_m;
            both.frames.extend(part.into_iter().map(|pose| HumanPose { pelvis_m: pose.pelvis_m + off_m, ..pose }));
        }
        both.frames.truncate(2 * 264 + 1);
        let unrolled = unroll(ground(&both, &both.body), &both.body);
        assert!(unrolled.loop_frames.is_some());
        let windows = analyze(&unrolled, &both.body).windows.unwrap();
        let speeds_mps = windows.iter().filter_map(|window| match &window.gait {
            Gait::Steps(strides) => Some(strides[0].arc.rates.speed_mps),
            Gait::Stands(_) => None,
        });
        let speeds_mps: Vec<f64> = speeds_mps.collect();
        for wanted in [0.6, 1.0] {
            assert!(speeds_mps.iter().any(|speed| (speed - wanted).abs() < 0.1), "{speeds_mps:?}");
        }
    }

    #[test]
    fn a_body_that_stands_makes_no_steps() {
        let clip = synthetic::idle("idle", 3.0);
        let windows = analyze(&ground(&clip, &clip.body), &clip.body).windows.unwrap();
        assert!(matches!(windows[..], [Window { gait: Gait::Stands(_), frames: [0.0, 180.0], .. }]), "{windows:?}");
    }
}

//! GroundedClip → what the feet do: contacts, steps and their landmarks, standing (`definitions.md`, "Phase").
//!
//! Phase 0 is the middle of a right contact, phase ½ the middle of a left one. Between landmarks lie strides
//! ([`crate::stride`]), of which the steady ones ([`crate::steady_window`]) make an example. Times are in frames of the
//! clip.

use std::ops::Range;

use glam::DVec3;
use motiondb::skeleton::Side;

use crate::contacts::{self, runs};
use crate::human_clip::HumanBody;
use crate::root_motion::{GroundedClip, percentile};
use crate::steady_window::{round_of_strides, steady_window};
use crate::stride::{BodyTrack, Landmark, Stride, stride};
use crate::stride_alignment::align;

/// Multiples of the contact limits of the definition that are tried.
const LENIENCES: [f64; 3] = [1.0, 1.5, 2.25];
/// A body stands that moves slower than this, with its feet planted for nearly all of the clip.
const STANDING_SPEED_MPS: f64 = 0.06;
const STANDING_SHARE_MIN: f64 = 0.95;
/// And whose joints move slower than this in the mean: who breathes and shifts weight stands (0.003–0.02), who dances
/// does not.
const STANDING_STIR_MPS: f64 = 0.06;
/// Shorter clips are poses.
const STANDING_MIN_S: f64 = 0.5;

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

/// Finds contacts, landmarks and the steady window.
///
/// Contacts are those of the definition where they show the most strides; the feet of noisy captures are let slide and
/// lift more, as little as it takes.
pub fn analyze(clip: &GroundedClip, body: &HumanBody) -> GaitAnalysis {
    let joints = clip.poses.iter().map(|pose| pose.forward_kinematics(body)).collect();
    let track = BodyTrack::of(joints, clip.frame_rate_hz);
    let feet = [0, 1].map(|side| {
        track.joints.iter().map(|joints| joints.measured_points_m(body, side)).collect::<Vec<[DVec3; 3]>>()
    });
    let speed_mps = track.mean_speed_mps();
    let analyses = LENIENCES.map(|lenience| {
        let contacts = [0, 1].map(|side| contacts::find(&feet[side], clip.frame_rate_hz, speed_mps, lenience));
        let planted = contacts.each_ref().map(|contacts| contacts.planted.clone());
        let stepping = contacts.map(|contacts| contacts.stepping);
        let gait = if stands(&planted, &track) { Gait::Stands } else { steps(&stepping, &track, clip.loop_frames) };
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

fn stands(planted: &[Vec<bool>; 2], track: &BodyTrack) -> bool {
    let share = |side: &Vec<bool>| side.iter().filter(|planted| **planted).count() as f64 / side.len() as f64;
    track.joints.len() as f64 >= STANDING_MIN_S * track.frame_rate_hz
        && track.net_speed_mps() < STANDING_SPEED_MPS
        && track.mean_joint_speed_mps() < STANDING_STIR_MPS
        && planted.iter().all(|side| share(side) >= STANDING_SHARE_MIN)
}

fn steps(stepping: &[Vec<bool>; 2], track: &BodyTrack, loop_frames: Option<usize>) -> Gait {
    let landmarks = landmarks(stepping);
    let strides: Vec<Option<Stride>> = landmarks.windows(3).map(|marks| stride(marks, stepping, track)).collect();
    let window = match loop_frames {
        Some(round) => round_of_strides(&strides, &landmarks, round as f64),
        None => steady_window(&strides),
    };
    match window {
        Some(strides) if !strides.is_empty() => Gait::Steps(align(&strides, track)),
        _ if landmarks.is_empty() => Gait::Unsteady("no step, and the body does not stand still"),
        _ if strides.iter().all(Option::is_none) => Gait::Unsteady("no whole stride with one step of each foot"),
        _ => Gait::Unsteady("no steady stride"),
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
    use crate::arc::Rates;
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

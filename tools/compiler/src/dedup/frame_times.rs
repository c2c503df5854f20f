//! Copies of one take whose frame times differ → how far from a human's each frame time makes the gait.
//!
//! A leg swings as a pendulum does: whatever the gait, people's feet are in the air for about as long at each step. So
//! the swing, (1 − planted share)·period, tells the time without knowing the speed. Longer legs swing longer, by the
//! root of their length. Of two copies of one take one frame time is wrong; the wrong one makes steps that swing too
//! long or too short.

use std::collections::VecDeque;

use motiondb::statistics::median;

use crate::cycle::analyzed_clip::AnalyzedClip;
use crate::cycle::foot_slide;
use crate::cycle::steady_cycle::SteadyCycle;
use crate::dedup::alignment::Alignment;
use crate::retarget::human_clip::{HumanBody, HumanClip};
use crate::retarget::units::HUMAN_LEG_M;

/// Swing of a person's foot, s: the median over 102 examples of walking, running, side-stepping, turning and going
/// backwards from 12 sources; half of them have 0.43 to 0.52 s, nine in ten 0.35 to 0.69 s.
const HUMAN_SWING_S: f64 = 0.48;

/// Which clips show the take of each, and how it lies on each of them.
pub(crate) type Neighbours = Vec<Vec<(usize, Alignment)>>;

/// Of each clip how far its swings are from a human's, |ln|; 0 where its take is told at one frame time, or shows no
/// step. What clips of one frame time say of their take they say together.
pub(crate) fn implausibilities(
    clips: &[HumanClip],
    analyzed: &[AnalyzedClip],
    neighbours: &Neighbours,
    body: &HumanBody,
) -> Vec<f64> {
    let mut implausible = vec![0.0; clips.len()];
    for take in takes_of_several_times(neighbours) {
        let swings = take.iter().flat_map(|&(clip, pace)| {
            let leg = libm::sqrt(clips[clip].body.leg_length_m() / HUMAN_LEG_M);
            let told_s = analyzed[clip].windows.iter().filter_map(|window| swing_s(window, body));
            told_s.map(move |swing_s| pace * swing_s / leg)
        });
        if let Some(swing_s) = median(swings) {
            take.iter().for_each(|&(clip, pace)| implausible[clip] = libm::log(swing_s / pace / HUMAN_SWING_S).abs());
        }
    }
    implausible
}

/// Mean time of a cycle that a foot is in the air.
fn swing_s(window: &SteadyCycle, body: &HumanBody) -> Option<f64> {
    let cycle = window.stepping()?;
    let planted_share = foot_slide::foot_slide(cycle, body).planted_share;
    Some((1.0 - planted_share) * f64::from(cycle.phase_map.period_s))
}

/// The clips of each take, each with how much of the first one's time goes by in its second.
fn takes_of_several_times(neighbours: &Neighbours) -> Vec<Vec<(usize, f64)>> {
    let mut is_reached = vec![false; neighbours.len()];
    let mut takes = Vec::new();
    for first in 0..neighbours.len() {
        let mut take = Vec::new();
        let mut reached = VecDeque::from([(first, Alignment::SAME)]);
        while let Some((clip, on_first)) = reached.pop_front() {
            if std::mem::replace(&mut is_reached[clip], true) {
                continue;
            }
            take.push((clip, on_first.pace));
            // The neighbour on the clip on the first.
            reached
                .extend(neighbours[clip].iter().map(|(other, on_other)| (*other, on_other.inverse().then(&on_first))));
        }
        let same_pace = |&(_, pace): &(usize, f64)| !Alignment { pace, ..Alignment::SAME }.times_differ();
        if !take.iter().all(same_pace) {
            takes.push(take);
        }
    }
    takes
}

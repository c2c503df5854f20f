//! Copies of one take whose frame times differ → how far from a human's each frame time makes the gait.
//!
//! A leg swings as a pendulum does: whatever the gait, people's feet are in the air for about as long at each step. So
//! the swing, (1 − planted share)·period, shows the time without the speed. Longer legs swing longer, by the root of
//! their length. Of two copies of one take one frame time is wrong; the wrong one makes steps that swing too long or
//! too short.

use motiondb::statistics::median;

use crate::dedup::alignment::Alignment;
use crate::dedup::groups::{Groups, Member};
use crate::cycle::analyzed_clip::AnalyzedClip;
use crate::cycle::steady_cycle::SteadyCycle;
use crate::cycle::foot_slide;
use crate::retarget::human_clip::{HumanBody, HumanClip};
use crate::retarget::units::HUMAN_LEG_M;

/// Swing of a person's foot, s: the median over 102 examples of walking, running, side-stepping, turning and going
/// backwards from 12 sources; half of them have 0.43 to 0.52 s, nine in ten 0.35 to 0.69 s.
const HUMAN_SWING_S: f64 = 0.48;

/// Of each clip how far its swings are from a human's, |ln|; 0 where its take has one frame time, or shows no step.
/// Clips of one frame time have one value: the median of their take.
pub(crate) fn implausibilities(
    clips: &[HumanClip],
    analyzed: &[AnalyzedClip],
    groups: &Groups,
    body: &HumanBody,
) -> Vec<f64> {
    let mut implausible = vec![0.0; clips.len()];
    let times_differ = |members: &&Vec<Member>| members.iter().any(|(_, on_leader)| on_leader.times_differ());
    for members in groups.members.iter().filter(times_differ) {
        let swings = members.iter().flat_map(|(clip, on_leader)| {
            let leg = libm::sqrt(clips[*clip].body.leg_length_m() / HUMAN_LEG_M);
            let swings_s = analyzed[*clip].windows.iter().filter_map(|window| swing_s(window, body));
            swings_s.map(move |swing_s| on_leader.pace * swing_s / leg)
        });
        if let Some(swing_s) = median(swings) {
            for (clip, Alignment { pace, .. }) in members {
                implausible[*clip] = libm::log(swing_s / pace / HUMAN_SWING_S).abs();
            }
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

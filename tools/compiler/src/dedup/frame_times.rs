//! Plausibility of frame times: of copies of one take with different frame times, how far each makes the gait from a
//! human's.
//!
//! A leg swings as a pendulum does: in all gaits, a human foot is in the air for about the same time at each step. So
//! the swing, (1 − planted share)·period, shows the frame time without the speed. Longer legs swing longer, by the root
//! of their length. A wrong frame time makes swings too long or too short.

use motiondb::statistics::median;

use crate::cycle::analyzed_clip::AnalyzedClip;
use crate::cycle::foot_slide;
use crate::cycle::steady_cycle::SteadyCycle;
use crate::dedup::alignment::Alignment;
use crate::dedup::groups::{Groups, Member};
use crate::retarget::human_clip::{HumanBody, HumanClip};
use crate::retarget::units::HUMAN_LEG_M;

/// Swing of a human foot, s: median over 102 examples of all gaits from 12 sources; nine in ten have 0.35 to 0.69 s.
const HUMAN_SWING_S: f64 = 0.48;

/// Deviation of each clip's swings from a human's, |ln|; 0 where its take has one frame time or shows no step. All
/// clips of a take with the same frame time have the same value, from the take's median swing.
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

/// Mean time for which a foot is in the air in a cycle, s.
fn swing_s(window: &SteadyCycle, body: &HumanBody) -> Option<f64> {
    let cycle = window.stepping()?;
    let planted_share = foot_slide::foot_slide(cycle, body).planted_share;
    Some((1.0 - planted_share) * f64::from(cycle.phase_map.period_s))
}

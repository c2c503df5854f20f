//! Clips whose frame rate is rare among the clips of their rig, and whose steps would be usual at the rig's usual rate: a
//! rate that is stated wrong by a factor of two is not seen in a circle or a side-step alone.

use std::collections::BTreeMap;
use std::ops::RangeInclusive;

use motiondb::diagnostic::{Diagnostic, Warning};

use crate::cycle::analyzed_clip::AnalyzedClip;
use crate::cycle::gait_cycle::GaitCycle;
use crate::retarget::human_clip::HumanClip;
use crate::rig::rig_head::Rig;

/// Least number of clips that show the usual rate of a rig.
const USUAL_MIN: usize = 3;
/// Least ratio of two rates that differ.
const RATIO_MIN: f64 = 1.8;
/// Steps a minute of walks, turns and side-steps; runs take more.
const USUAL_STEPS_PER_MIN: RangeInclusive<f64> = 80.0..=145.0;

/// Adds a warning to the clips whose frame rate is probably stated wrong.
pub(crate) fn warn_of_rare_frame_rates(clips: &[HumanClip], analyzed: &mut [AnalyzedClip]) {
    let mut of_rigs: BTreeMap<&Rig, BTreeMap<u32, usize>> = BTreeMap::new();
    for clip in clips {
        if let Some(head) = &clip.rig_head {
            *of_rigs.entry(&head.rig).or_default().entry(whole_hz(clip.frame_rate_hz)).or_default() += 1;
        }
    }
    let usual_hz = |clip: &HumanClip| {
        let rates = of_rigs.get(&clip.rig_head.as_ref()?.rig)?;
        let usual = rates.iter().find(|(_, count)| **count >= USUAL_MIN && 2 * **count > rates.values().sum::<usize>());
        usual.map(|(hz, _)| f64::from(*hz))
    };
    for (clip, found) in clips.iter().zip(analyzed) {
        let cycle = found.windows.iter().find_map(|window| window.stepping());
        let Some((usual_hz, cycle)) = usual_hz(clip).zip(cycle) else { continue };
        let steps_per_min = steps_per_min(cycle);
        let at_usual = steps_per_min * usual_hz / clip.frame_rate_hz;
        let ratio = (usual_hz / clip.frame_rate_hz).max(clip.frame_rate_hz / usual_hz);
        let is_doubtful = !clip.choices.is_frame_rate_stated
            && ratio >= RATIO_MIN
            && !cycle.is_run()
            && !USUAL_STEPS_PER_MIN.contains(&steps_per_min)
            && USUAL_STEPS_PER_MIN.contains(&at_usual);
        if is_doubtful {
            found.diagnostics.push(Diagnostic::Warning(Warning::RareFrameRate {
                frame_rate_hz: clip.frame_rate_hz as f32,
                usual_hz: usual_hz as f32,
                steps_per_min: [steps_per_min, at_usual].map(|steps| steps as f32),
            }));
        }
    }
}

/// Rates such as 59.94 and 60 Hz are one.
fn whole_hz(rate_hz: f64) -> u32 {
    libm::round(rate_hz) as u32
}

fn steps_per_min(cycle: &GaitCycle) -> f64 {
    2.0 * 60.0 / f64::from(cycle.phase_map.period_s)
}

#[cfg(test)]
mod tests {
    use motiondb::motion::MotionDb;

    use crate::rig::rig_head::{Rig, RigHead};
    use crate::synthetic::{SyntheticWalk, database_of, walk};

    /// The set of a rig with four walks at 60 Hz and a turn of this period, s, whose rate is stated as `stated_hz`.
    fn set(period_s: f64, stated_hz: f64) -> MotionDb {
        let head = || RigHead {
            rig: Rig { names: vec!["Hips".to_owned()], lengths: Vec::new() },
            offset: glam::DQuat::IDENTITY,
            rest_offset: None,
            rest_up: String::new(),
        };
        let mut clips: Vec<_> = [0.7, 0.9, 1.2, 1.4]
            .map(|speed_mps| walk(&format!("walk_{speed_mps}"), SyntheticWalk::at(speed_mps, 0.0, 0.0)))
            .into();
        clips.push(walk("turn", SyntheticWalk { period_s, ..SyntheticWalk::at(0.5, 0.9, 0.0) }));
        clips.last_mut().unwrap().frame_rate_hz = stated_hz;
        clips.iter_mut().for_each(|clip| clip.rig_head = Some(head()));
        database_of(clips, 0)
    }

    #[track_caller]
    fn check(period_s: f64, stated_hz: f64, is_warned: bool) {
        let db = set(period_s, stated_hz);
        let turn = db.sources.iter().find(|source| source.file == "turn.bvh").unwrap();
        let codes: Vec<&str> = turn.diagnostics.iter().map(|found| found.code()).collect();
        assert_eq!(codes.contains(&"rare_frame_rate"), is_warned, "{codes:?}");
    }

    #[test]
    fn a_rare_rate_is_doubtful_where_the_usual_one_gives_usual_steps() {
        check(1.1, 60.0, false);
        check(1.1, 120.0, true);
        check(1.1, 30.0, true);
        // At its stated rate it takes 109 steps a minute.
        check(2.2, 120.0, false);
    }
}

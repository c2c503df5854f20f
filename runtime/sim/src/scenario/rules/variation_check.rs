//! The rules of `[variation]`.

use std::ops::RangeInclusive;

use crate::scenario::fault::{ScenarioFault, ScenarioPart};
use crate::scenario::ranges::{REMOVE, within};
use crate::variation::Variation;

/// Reaction time, s: longer ones are `pre_movement_s`.
const REACTION_S: RangeInclusive<f32> = 0.0..=10.0;
/// Deviation of cadence, as a share. At 0.1 some bodies take steps that are a third longer than those of others.
const CADENCE: RangeInclusive<f32> = 0.0..=0.1;
/// Deviations of the swing of the arms, as shares: no arm swings backward.
const SWING: RangeInclusive<f32> = 0.0..=0.4;
/// Deviations of the pitch of trunk and head, degrees.
const PITCH_DEG: RangeInclusive<f32> = 0.0..=10.0;
/// Deviation of the size of the body, as a share.
const STATURE: RangeInclusive<f32> = 0.0..=0.1;
/// Secondary motion, divided by that of captures.
const SECONDARY: RangeInclusive<f32> = 0.0..=3.0;

/// Checks how much bodies differ.
///
/// # Errors
/// The first number that is out of range.
pub(crate) fn check_variation(variation: &Variation) -> Result<(), ScenarioFault> {
    let part = &ScenarioPart::Variation;
    let Variation {
        reaction_s: [from_s, to_s],
        cadence,
        arm_swing,
        arm_asymmetry,
        trunk_pitch_deg,
        head_pitch_deg,
        secondary_motion,
        stature,
    } = *variation;
    let help = "write `reaction_s = [least, greatest]`, in seconds";
    within(part, "the least of reaction_s", from_s, &REACTION_S, help)?;
    within(part, "the greatest of reaction_s", to_s, &(from_s..=*REACTION_S.end()), help)?;
    within(part, "cadence", cadence, &CADENCE, REMOVE)?;
    within(part, "arm_swing", arm_swing, &SWING, REMOVE)?;
    within(part, "arm_asymmetry", arm_asymmetry, &SWING, REMOVE)?;
    within(part, "trunk_pitch_deg", trunk_pitch_deg, &PITCH_DEG, REMOVE)?;
    within(part, "head_pitch_deg", head_pitch_deg, &PITCH_DEG, REMOVE)?;
    within(part, "secondary_motion", secondary_motion, &SECONDARY, REMOVE)?;
    within(part, "stature", stature, &STATURE, REMOVE)
}

#[cfg(test)]
mod tests {
    use std::path::PathBuf;

    use motiondb::files::SourceText;

    use crate::scenario::{Scenario, ScenarioError, parse};
    use crate::variation::Variation;

    fn read(variation: &str) -> Result<Scenario, ScenarioError> {
        let text = format!("duration_s = 2\nagents = [{{ at_m = [0, 0], goals_m = [[1, 0]] }}]\n{variation}\n");
        parse(&SourceText { path: PathBuf::from("crowd.toml"), text }).map(|(scenario, _)| scenario)
    }

    #[test]
    fn bodies_of_a_scenario_file_differ_unless_it_says_no() {
        let variation = |text: &str| read(text).unwrap().variation;
        assert_eq!(variation(""), Some(Variation::default()));
        assert_eq!(variation("variation = true"), Some(Variation::default()));
        assert_eq!(variation("variation = false"), None);
        let table = Variation { cadence: 0.02, ..Variation::default() };
        assert_eq!(variation("[variation]\ncadence = 0.02"), Some(table));
    }

    #[test]
    fn bad_variations_are_errors_in_the_file() {
        let cases = [
            ("[variation]\ncadence = 0.2", "cadence is 0.2"),
            ("[variation]\nreaction_s = [0.8, 0.2]", "the greatest of reaction_s is 0.2"),
            ("[variation]\nreaction_s = [0.2, 20]", "the greatest of reaction_s is 20"),
            ("[variation]\nhead_pitch_deg = nan", "head_pitch_deg is NaN"),
            ("[variation]\nstature = 0.2", "stature is 0.2"),
            ("[variation]\nheight = 1", "unknown field `height`"),
            ("variation = 3", "`true`, `false` or a table `[variation]` is expected here"),
        ];
        for (text, expected) in cases {
            let message = read(text).unwrap_err().to_string();
            assert!(message.contains(expected) && message.starts_with("crowd.toml:"), "{text}: {message}");
        }
    }
}

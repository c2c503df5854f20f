//! The rules of `[shot]`.

use std::ops::RangeInclusive;

use crate::scenario::fault::{ScenarioFault, ScenarioPart};
use crate::scenario::places::shot_spec::ShotSpec;
use crate::scenario::ranges::{REMOVE, within};

/// Frames per second.
const FPS: RangeInclusive<f32> = 0.1..=1_000.0;
/// Number of the first frame: with all frames of a day it is still a number of an EXR header.
const FIRST_FRAME: RangeInclusive<u32> = 0..=1_000_000_000;
/// Moments of a frame.
const SAMPLES: RangeInclusive<u32> = 1..=256;
/// Opening of the shutter, degrees.
const SHUTTER_DEG: RangeInclusive<f32> = 1.0..=360.0;

/// Checks a shot of a simulation of this duration.
///
/// # Errors
/// The first number that is out of range.
pub fn check_shot(shot: &ShotSpec, duration_s: f32) -> Result<(), ScenarioFault> {
    let part = &ScenarioPart::Shot;
    let help = "give a time in seconds within the simulated time, `duration_s`";
    within(part, "preroll_s", shot.preroll_s, &(0.0..=duration_s), help)?;
    within(part, "first_frame", shot.first_frame, &FIRST_FRAME, REMOVE)?;
    if let Some(fps) = shot.fps {
        within(part, "fps", fps, &FPS, "give the frames per second, such as 24 or 23.976")?;
    }
    within(part, "samples_per_frame", shot.samples_per_frame, &SAMPLES, "1 draws sharp frames")?;
    within(part, "shutter_deg", shot.shutter_deg, &SHUTTER_DEG, "180 opens the shutter for half a frame")
}

#[cfg(test)]
mod tests {
    use std::path::PathBuf;

    use motiondb::files::SourceText;

    use crate::scenario::{ScenarioError, parse};

    #[test]
    fn bad_shots_are_errors_at_their_line() {
        let cases = [
            ("preroll_s = 3", "preroll_s is 3, not between 0 and 2"),
            ("preroll_s = nan", "preroll_s is NaN"),
            ("fps = 0", "fps is 0"),
            ("fps = 2000", "fps is 2000"),
            ("samples_per_frame = 0", "samples_per_frame is 0"),
            ("shutter_deg = 400", "shutter_deg is 400"),
            ("first_frame = -1", "a whole number from 0 on"),
            ("frames = 3", "unknown field `frames`"),
        ];
        for (line, expected) in cases {
            let agents = "duration_s = 2\nagents = { at_m = [0, 0], goals_m = [[1, 0]] }";
            let source = SourceText { path: PathBuf::from("x.toml"), text: format!("{agents}\n[shot]\n{line}\n") };
            match parse(&source) {
                Err(ScenarioError::Invalid(invalid)) => {
                    assert!(invalid.to_string().contains(expected), "{line}: {invalid}");
                    assert!((3..=4).contains(&invalid.line()), "{line}: line {}", invalid.line());
                }
                other => panic!("{line}: {:?}", other.map(|(scenario, _)| scenario.shot)),
            }
        }
    }
}

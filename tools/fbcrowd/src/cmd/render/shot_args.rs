//! The options that state a shot.

use fbcrowd_sim::recording::Recording;
use fbcrowd_sim::scenario::{ShotSpec, check_shot};

use crate::terminal::failure::Failure;

/// Frames in time. Each option replaces a key of the scenario's `[shot]`.
#[derive(clap::Args)]
#[command(next_help_heading = "Shot (default: the scenario's `[shot]`)")]
pub(crate) struct ShotArgs {
    /// Frames per second, such as 24 or 23.976; poses between steps are interpolated with planted feet held.
    #[arg(long, value_name = "RATE", allow_negative_numbers = true)]
    fps: Option<f32>,
    /// Simulated time before the first frame, s.
    #[arg(long, value_name = "SECONDS", allow_negative_numbers = true)]
    preroll: Option<f32>,
    /// Number of the first frame; `--frames` counts from it.
    #[arg(long, value_name = "N")]
    first_frame: Option<u32>,
    /// Moments that a frame of a camera blends: motion blur; 1 is sharp.
    #[arg(long, value_name = "N")]
    samples_per_frame: Option<u32>,
    /// Opening of the shutter, degrees; 360 is the time of a frame.
    #[arg(long, value_name = "DEGREES", allow_negative_numbers = true)]
    shutter: Option<f32>,
}

impl ShotArgs {
    /// The shot of a recording; none where neither options nor scenario state one.
    pub(crate) fn shot(&self, recording: &Recording) -> Result<Option<ShotSpec>, Failure> {
        let Self { fps, preroll, first_frame, samples_per_frame, shutter } = *self;
        let stated = recording.header().scenario.shot.clone();
        if fps.is_none()
            && preroll.is_none()
            && first_frame.is_none()
            && samples_per_frame.is_none()
            && shutter.is_none()
        {
            return Ok(stated);
        }
        let of_file = stated.unwrap_or_default();
        let shot = ShotSpec {
            preroll_s: preroll.unwrap_or(of_file.preroll_s),
            first_frame: first_frame.unwrap_or(of_file.first_frame),
            fps: fps.or(of_file.fps),
            samples_per_frame: samples_per_frame.unwrap_or(of_file.samples_per_frame),
            shutter_deg: shutter.unwrap_or(of_file.shutter_deg),
        };
        check_shot(&shot, recording.header().scenario.duration_s)
            .map_err(|fault| Failure::bad(format!("{}; {}", fault.message, fault.help)))?;
        Ok(Some(shot))
    }
}

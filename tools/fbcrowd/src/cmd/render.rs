//! `fbcrowd render`: a recording to a frame sequence.

use std::path::PathBuf;

use clap::ValueEnum;
use fbcrowd_render::frame_range::FrameRange;
use fbcrowd_render::sequence::{Format, SequenceOptions};

use crate::failure::{Answer, Failure};
use crate::{output, rendering};

/// Render a recording to a frame sequence.
#[derive(clap::Args)]
#[command(
    after_help = "Examples:\n  fbcrowd render crossing.fbrec -o frames\n  fbcrowd render crossing.fbrec -o frames --format exr --frames 1001-1100x2"
)]
pub(crate) struct Args {
    /// The recording.
    #[arg(value_name = "FILE.fbrec")]
    recording: PathBuf,
    /// The folder for `NAME.1001.png` onwards.
    #[arg(short, long, value_name = "DIR")]
    output: PathBuf,
    /// From where to look.
    #[arg(long, value_enum, default_value_t = ViewArg::Top)]
    view: ViewArg,
    /// File format: PNG (sRGB) or EXR (scene-linear, half).
    #[arg(long, value_enum, default_value_t = FormatArg::Png)]
    format: FormatArg,
    /// Frames, as in `1001-1100`, `1001-1100x2`, `1010,1020`; all by default.
    #[arg(long, value_name = "RANGE")]
    frames: Option<FrameRange>,
}

#[derive(Clone, Copy, ValueEnum)]
enum ViewArg {
    Top,
}

#[derive(Clone, Copy, ValueEnum)]
enum FormatArg {
    Png,
    Exr,
}

pub(crate) fn run(args: &Args) -> Result<Answer, Failure> {
    let ViewArg::Top = args.view;
    let recording = rendering::open(&args.recording)?;
    let options = SequenceOptions {
        folder: args.output.clone(),
        name: recording.header().scenario.name.clone(),
        format: match args.format {
            FormatArg::Png => Format::Png,
            FormatArg::Exr => Format::Exr,
        },
        frames: args.frames.clone(),
    };
    let rendered = rendering::render(&recording, &options)?;
    output::print(&format!(
        "{} frames in {}, {:.1} ms a frame",
        rendered.frames,
        args.output.display(),
        rendered.ms_per_frame
    ))?;
    Ok(Answer::Yes)
}

//! `fbcrowd render`: a recording to a frame sequence.

use std::path::PathBuf;

use clap::ValueEnum;
use fbcrowd_jobs::output_path::LockedFolder;
use fbcrowd_jobs::rendering;
use fbcrowd_jobs::wording::counted;
use fbcrowd_render::top_view::{FrameRange, PictureFormat, SequenceOptions};

use crate::terminal::failure::{Answer, Failure};
use crate::terminal::output;
use crate::terminal::progress::ProgressDisplay;

/// Render a recording to a frame sequence.
#[derive(clap::Args)]
#[command(
    after_help = "Examples:\n  fbcrowd render crossing.fbrec -o frames\n  fbcrowd render crossing.fbrec -o frames --format exr --frames 1001-1100x2\n  fbcrowd render crossing.fbrec -o overlay --overlay constraints --agent 3 --frames 1090-1120"
)]
pub(crate) struct Args {
    /// The recording.
    #[arg(value_name = "FILE.fbrec")]
    recording: PathBuf,
    /// Folder for `NAME.1001.png` and the frames after it.
    #[arg(short, long, value_name = "DIR")]
    output: PathBuf,
    /// The view.
    #[arg(long, value_enum, default_value_t = ViewArg::Top)]
    view: ViewArg,
    /// File format: PNG (sRGB) or EXR (scene-linear, half).
    #[arg(long, value_enum, default_value_t = FormatArg::Png)]
    format: FormatArg,
    /// Frames, as in `1001-1100`, `1001-1100x2`, `1010,1020`; all by default.
    #[arg(long, value_name = "RANGE")]
    frames: Option<FrameRange>,
    /// Draw, beside the scene, the velocity space of the agents given by --agent.
    #[arg(long, value_enum, value_name = "WHAT")]
    overlay: Option<OverlayArg>,
    /// An agent of the overlay, counted from 0; repeat it, or write 3,7, for several panels.
    #[arg(long, value_name = "N", value_delimiter = ',', requires = "overlay")]
    agent: Vec<usize>,
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

#[derive(Clone, Copy, ValueEnum)]
enum OverlayArg {
    /// Velocity space: every half-plane that limits the plan, and the preferred, planned and actual velocities.
    Constraints,
}

pub(crate) fn run(args: &Args) -> Result<Answer, Failure> {
    let ViewArg::Top = args.view;
    let recording = rendering::open(&args.recording)?;
    let options = SequenceOptions {
        folder: args.output.clone(),
        name: recording.header().scenario.name.clone(),
        format: match args.format {
            FormatArg::Png => PictureFormat::Png,
            FormatArg::Exr => PictureFormat::Exr,
        },
        frames: args.frames.clone(),
        constraints_of: constraints_of(args, recording.population().agents.len())?,
    };
    rendering::check_frames(&recording, &options, std::slice::from_ref(&args.recording))?;
    let _lock = LockedFolder::shared(&args.output)?;
    let progress = ProgressDisplay::default();
    let rendered = rendering::render(&recording, &options, &|event| progress.observe(event))?;
    output::print(&format!(
        "{} in {}, {:.1} ms a frame",
        counted(rendered.frames, "frame", "frames"),
        args.output.display(),
        rendered.ms_per_frame
    ))?;
    Ok(Answer::Yes)
}

fn constraints_of(args: &Args, count: usize) -> Result<Vec<usize>, Failure> {
    match args.overlay {
        Some(OverlayArg::Constraints) if args.agent.is_empty() => Err(Failure::bad(format!(
            "--overlay constraints draws the velocity space of an agent, and no agent is named; add --agent N (0 to {})",
            count.saturating_sub(1)
        ))),
        Some(OverlayArg::Constraints) | None => Ok(args.agent.clone()),
    }
}

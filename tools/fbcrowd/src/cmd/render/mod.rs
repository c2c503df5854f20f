//! `fbcrowd render`: a recording to a frame sequence, from above or from a camera.

mod shot_args;
mod values;

use std::path::PathBuf;

use fbcrowd_jobs::output_path::{LockedFolder, check_file, check_is_no_input};
use fbcrowd_jobs::rendering::video::{self, VideoOptions};
use fbcrowd_jobs::rendering::{self, RenderedSequence};
use fbcrowd_jobs::wording::counted;
use fbcrowd_jobs::{camera_file, character};
use fbcrowd_render::camera::{CameraOptions, Quality};
use fbcrowd_render::passes::{ColourSpace, ExrCompression, PassSet};
use fbcrowd_render::plots::crowd::StripOptions;
use fbcrowd_render::top_view::{FrameRange, SequenceOptions};
use fbcrowd_render::visibility::SamplePattern;
use fbcrowd_sim::recording::Recording;

use crate::cmd::outside_arg::OutsideArg;
use crate::cmd::render::shot_args::ShotArgs;
use crate::cmd::render::values::{
    ColourByArg, ColourSpaceArg, CompressionArg, FormatArg, OcclusionArg, OverlayArg, ViewArg, sample_pattern, size_px,
};
use crate::terminal::failure::{Answer, Failure};
use crate::terminal::output;
use crate::terminal::progress::ProgressDisplay;

/// Render a recording to a frame sequence, from above or from a camera, or single agents to strips.
#[derive(clap::Args)]
#[command(
    after_help = "Examples:\n  fbcrowd render crossing.fbrec -o frames\n  fbcrowd render crossing.fbrec -o frames --view camera --samples 16 --format exr\n  fbcrowd render mall.fbrec -o atrium --view camera --camera atrium --frames 1001-1100x2 --burn-in\n  fbcrowd render crossing.fbrec --view camera --fps 24 --samples-per-frame 8 --video crossing.mp4\n  fbcrowd render crossing.fbrec -o overlay --overlay constraints --agent 3 --frames 1090-1120\n  fbcrowd render crossing.fbrec -o strips --view strip --agent 3 --frames 1001-1120x6"
)]
pub(crate) struct Args {
    /// The recording.
    #[arg(value_name = "FILE.fbrec")]
    recording: PathBuf,
    /// Folder for `NAME.1001.png` and the frames after it.
    #[arg(short, long, value_name = "DIR", required_unless_present = "video")]
    output: Option<PathBuf>,
    /// Write a video (.mp4, .mov, .mkv; H.264) instead of frames; needs ffmpeg.
    #[arg(long, value_name = "FILE", conflicts_with = "output")]
    video: Option<PathBuf>,
    /// The program that writes the video.
    #[arg(long, value_name = "PATH", default_value = "ffmpeg", requires = "video")]
    ffmpeg: PathBuf,
    /// Quality of the video: constant rate factor, less is better and larger.
    #[arg(long, value_name = "N", default_value_t = video::CRF, requires = "video", value_parser = clap::value_parser!(u8).range(0..=51))]
    crf: u8,
    /// The view: from above, from a camera, or of single agents.
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
    /// An agent of the overlay or strip, counted from 0; repeat it, or write 3,7, for several.
    #[arg(long, value_name = "N", value_delimiter = ',')]
    agent: Vec<usize>,
    #[command(flatten)]
    shot: ShotArgs,
    #[command(flatten)]
    camera: CameraArgs,
    #[command(flatten)]
    exr: ExrArgs,
    #[command(flatten)]
    outside: OutsideArg,
}

/// Options of `--view camera --format exr`.
#[derive(clap::Args)]
#[command(next_help_heading = "EXR of the camera view")]
struct ExrArgs {
    /// Passes, with commas between them: z, n, p, motion, agent, group, material (Cryptomattes), id; or all.
    #[arg(long, value_name = "PASSES")]
    passes: Option<PassSet>,
    /// Compression; all are lossless.
    #[arg(long, value_enum)]
    compression: Option<CompressionArg>,
    /// Colour space of the scene-linear picture.
    #[arg(long, value_enum)]
    colour_space: Option<ColourSpaceArg>,
}

impl ExrArgs {
    /// Whether an option is given.
    fn is_given(&self) -> bool {
        self.passes.is_some() || self.compression.is_some() || self.colour_space.is_some()
    }
}

/// Options of `--view camera`.
#[derive(clap::Args)]
#[command(next_help_heading = "Camera view")]
struct CameraArgs {
    /// The camera; by default the scenario's first, else `default`, which shows the crowd best.
    #[arg(long, value_name = "NAME")]
    camera: Option<String>,
    /// Take cameras from a TOML file with `[camera]` or `[[cameras]]`, such as a scenario, or from a GLB or glTF file;
    /// and the picture size from `[view]` of a TOML file.
    #[arg(long, value_name = "FILE")]
    cameras: Option<PathBuf>,
    /// Width and height of the pictures, pixels; default: the scenario's `[view]`.
    #[arg(long, value_name = "WxH", value_parser = size_px)]
    size: Option<[u32; 2]>,
    /// Samples of a pixel: 4 for previews, 16 for finals.
    #[arg(long, value_name = "N", default_value = "4", value_parser = sample_pattern)]
    samples: SamplePattern,
    /// What is darkened where little sky is seen.
    #[arg(long, value_enum, default_value_t = OcclusionArg::Full)]
    occlusion: OcclusionArg,
    /// Draw no shadows of the sun.
    #[arg(long)]
    no_shadow: bool,
    /// What the colours of clothes show.
    #[arg(long, value_enum, default_value_t = ColourByArg::Agent)]
    colour_by: ColourByArg,
    /// Draw a strip with frame, time and camera; PNG only.
    #[arg(long)]
    burn_in: bool,
    /// Write each agent's number over it; PNG only.
    #[arg(long)]
    labels: bool,
}

impl CameraArgs {
    /// Name of an option that has another value than its default.
    fn given(&self) -> Option<&'static str> {
        let options = [
            ("--camera", self.camera.is_some()),
            ("--cameras", self.cameras.is_some()),
            ("--size", self.size.is_some()),
            ("--samples", self.samples != SamplePattern::default()),
            ("--occlusion", self.occlusion != OcclusionArg::Full),
            ("--no-shadow", self.no_shadow),
            ("--colour-by", self.colour_by != ColourByArg::Agent),
            ("--burn-in", self.burn_in),
            ("--labels", self.labels),
        ];
        options.into_iter().find_map(|(name, is_given)| is_given.then_some(name))
    }
}

pub(crate) fn run(args: &Args) -> Result<Answer, Failure> {
    if !args.agent.is_empty() && args.overlay.is_none() && args.view != ViewArg::Strip {
        return Err(Failure::bad("--agent names whom --overlay or --view strip shows; add one of these"));
    }
    if args.exr.is_given() && args.view != ViewArg::Camera {
        return Err(Failure::bad("--passes, --compression and --colour-space need --view camera"));
    }
    let recording = rendering::open(&args.recording)?;
    let rendered = match args.view {
        ViewArg::Top => render_top(args, &recording)?,
        ViewArg::Camera => render_camera(args, &recording)?,
        ViewArg::Strip => return render_strips(args, &recording),
    };
    let written = args.video.as_ref().or(args.output.as_ref()).map_or(String::new(), |path| path.display().to_string());
    output::print(&format!(
        "{} in {written}, {:.1} ms a frame",
        counted(rendered.frames, "frame", "frames"),
        rendered.ms_per_frame
    ))?;
    Ok(Answer::Yes)
}

/// The video of the arguments, checked: none where frames are written.
fn video_options(args: &Args, inputs: &[PathBuf]) -> Result<Option<VideoOptions>, Failure> {
    let Some(path) = &args.video else { return Ok(None) };
    if matches!(args.format, FormatArg::Exr) {
        return Err(Failure::bad("--video is made of sRGB pictures; remove --format exr".to_owned()));
    }
    let options = VideoOptions { path: path.clone(), ffmpeg: args.ffmpeg.clone(), crf: args.crf };
    check_is_no_input(path, inputs)?;
    check_file(path)?;
    video::check(&options)?;
    Ok(Some(options))
}

fn render_top(args: &Args, recording: &Recording) -> Result<RenderedSequence, Failure> {
    if let Some(option) = args.camera.given() {
        return Err(Failure::bad(format!("{option} belongs to a camera; add --view camera")));
    }
    let options = SequenceOptions {
        folder: args.output.clone().unwrap_or_default(),
        name: recording.header().scenario.name.clone(),
        format: args.format.into(),
        frames: args.frames.clone(),
        shot: args.shot.shot(recording)?,
        constraints_of: constraints_of(args, recording.population().agents.len())?,
    };
    let progress = ProgressDisplay::default();
    if let Some(video) = video_options(args, std::slice::from_ref(&args.recording))? {
        return Ok(rendering::render_video(recording, &options, &video, &|event| progress.observe(event))?);
    }
    rendering::check_frames(recording, &options, std::slice::from_ref(&args.recording))?;
    let _lock = LockedFolder::shared(&options.folder)?;
    Ok(rendering::render(recording, &options, &|event| progress.observe(event))?)
}

fn render_camera(args: &Args, recording: &Recording) -> Result<RenderedSequence, Failure> {
    let CameraArgs { camera, cameras, size, samples, occlusion, no_shadow, colour_by, burn_in, labels } = &args.camera;
    if args.overlay.is_some() {
        return Err(Failure::bad("--overlay is drawn in the view from above; remove --view camera".to_owned()));
    }
    if !matches!(args.format, FormatArg::Exr) && args.exr.is_given() {
        return Err(Failure::bad(
            "--passes, --compression and --colour-space belong to EXR; add --format exr".to_owned(),
        ));
    }
    if matches!(args.format, FormatArg::Exr) && (*burn_in || *labels) {
        return Err(Failure::bad("--burn-in and --labels are drawn into PNG; remove them or --format exr".to_owned()));
    }
    let mut inputs = vec![args.recording.clone()];
    let (mut size_px, mut other_cameras) = (*size, None);
    if let Some(path) = cameras {
        let view = &recording.header().scenario.view;
        let others = camera_file::cameras_for(path, view, size_px, args.outside.into())?;
        (other_cameras, size_px) = (Some(others.cameras), size_px.or(others.size_px));
        inputs.push(path.clone());
    }
    let options = CameraOptions {
        folder: args.output.clone().unwrap_or_default(),
        name: recording.header().scenario.name.clone(),
        format: args.format.into(),
        frames: args.frames.clone(),
        shot: args.shot.shot(recording)?,
        cameras: other_cameras,
        size_px,
        camera: camera.clone(),
        characters: character::of_recording(&args.recording, recording.header())?,
        quality: Quality { samples: *samples, shadow: !no_shadow, occlusion: (*occlusion).into() },
        colour_by: (*colour_by).into(),
        passes: args.exr.passes.clone().unwrap_or_default(),
        compression: args.exr.compression.map_or_else(ExrCompression::default, Into::into),
        colour_space: args.exr.colour_space.map_or_else(ColourSpace::default, Into::into),
        burn_in: *burn_in,
        labels: *labels,
    };
    let progress = ProgressDisplay::default();
    if let Some(video) = video_options(args, &inputs)? {
        return Ok(rendering::render_camera_video(recording, &options, &video, &|event| progress.observe(event))?);
    }
    rendering::check_camera_frames(recording, &options, &inputs)?;
    let _lock = LockedFolder::shared(&options.folder)?;
    Ok(rendering::render_camera(recording, &options, &|event| progress.observe(event))?)
}

/// Draws a strip of each agent.
fn render_strips(args: &Args, recording: &Recording) -> Result<Answer, Failure> {
    if args.agent.is_empty() {
        return Err(Failure::bad("--view strip draws single agents, and none is named; add --agent N"));
    }
    let others = [
        ("--overlay", args.overlay.is_some()),
        ("--video", args.video.is_some()),
        ("--format exr", matches!(args.format, FormatArg::Exr)),
    ];
    let other = others.into_iter().find_map(|(name, is_given)| is_given.then_some(name));
    if let Some(option) = other.or(args.camera.given()) {
        return Err(Failure::bad(format!("{option} belongs to frames; remove it or --view strip")));
    }
    let options = StripOptions {
        folder: args.output.clone().unwrap_or_default(),
        agents: args.agent.clone(),
        frames: args.frames.clone(),
        shot: args.shot.shot(recording)?,
        characters: character::of_recording(&args.recording, recording.header())?,
    };
    let strips = rendering::render_strips(recording, &options, std::slice::from_ref(&args.recording))?;
    strips.iter().for_each(|strip| output::say(&format!("drew {}", strip.display())));
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

//! `fbcrowd render`: a recording to a frame sequence, from above or from a camera.

use std::ops::RangeInclusive;
use std::path::PathBuf;

use clap::ValueEnum;
use fbcrowd_jobs::output_path::{LockedFolder, check_file, check_is_no_input};
use fbcrowd_jobs::rendering::{self, RenderedSequence};
use fbcrowd_jobs::video::{self, VideoOptions};
use fbcrowd_jobs::wording::counted;
use fbcrowd_jobs::{camera_file, character};
use fbcrowd_render::camera::{CameraOptions, ColourBy, Quality};
use fbcrowd_render::passes::{ColourSpace, ExrCompression, PassSet};
use fbcrowd_render::shading::Occlusion;
use fbcrowd_render::top_view::{FrameRange, PictureFormat, SequenceOptions};
use fbcrowd_render::visibility::SamplePattern;
use fbcrowd_sim::recording::Recording;
use fbcrowd_sim::scenario::{self, ShotSpec, check_shot};

use crate::cmd::outside_arg::OutsideArg;
use crate::terminal::failure::{Answer, Failure};
use crate::terminal::output;
use crate::terminal::progress::ProgressDisplay;

/// Sides of a picture, pixels, as in `[view]`.
const SIDE_PX: RangeInclusive<u32> = 16..=8_192;

/// Render a recording to a frame sequence, from above or from a camera.
#[derive(clap::Args)]
#[command(
    after_help = "Examples:\n  fbcrowd render crossing.fbrec -o frames\n  fbcrowd render crossing.fbrec -o frames --view camera --samples 16 --format exr\n  fbcrowd render mall.fbrec -o atrium --view camera --camera atrium --frames 1001-1100x2 --burn-in\n  fbcrowd render crossing.fbrec --view camera --fps 24 --samples-per-frame 8 --video crossing.mp4\n  fbcrowd render crossing.fbrec -o overlay --overlay constraints --agent 3 --frames 1090-1120"
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
    /// The view: from above, or from a camera.
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
    #[command(flatten)]
    shot: ShotArgs,
    #[command(flatten)]
    camera: CameraArgs,
    #[command(flatten)]
    exr: ExrArgs,
    #[command(flatten)]
    outside: OutsideArg,
}

/// Frames in time. Each option replaces a key of the scenario's `[shot]`.
#[derive(clap::Args)]
#[command(next_help_heading = "Shot (default: the scenario's `[shot]`)")]
pub(crate) struct ShotArgs {
    /// Frames per second, such as 24 or 23.976; poses between steps are interpolated with planted feet held.
    #[arg(long, value_name = "RATE")]
    fps: Option<f32>,
    /// Simulated time before the first frame, s.
    #[arg(long, value_name = "SECONDS")]
    preroll: Option<f32>,
    /// Number of the first frame; `--frames` counts from it.
    #[arg(long, value_name = "N")]
    first_frame: Option<u32>,
    /// Moments that a frame of a camera blends: motion blur; 1 is sharp.
    #[arg(long, value_name = "N")]
    samples_per_frame: Option<u32>,
    /// Opening of the shutter, degrees; 360 is the time of a frame.
    #[arg(long, value_name = "DEGREES")]
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

#[derive(Clone, Copy, ValueEnum)]
enum CompressionArg {
    /// Deflate, sixteen lines at once: the default.
    Zip16,
    /// Deflate, line by line.
    Zip1,
    /// Runs of equal bytes: fast, about twice as large.
    Rle,
    /// Wavelets.
    Piz,
    None,
}

#[derive(Clone, Copy, ValueEnum)]
enum ColourSpaceArg {
    /// Primaries of Rec. 709 and sRGB: the default.
    Rec709,
    /// ACEScg, primaries AP1.
    #[value(name = "acescg")]
    AcesCg,
}

/// Options of `--view camera`.
#[derive(clap::Args)]
#[command(next_help_heading = "Camera view")]
struct CameraArgs {
    /// The camera; by default the scenario's first, else `default`, which frames the crowd at eye height.
    #[arg(long, value_name = "NAME")]
    camera: Option<String>,
    /// Take cameras and picture size from a scenario file, or cameras from a GLB or glTF file, instead of from the recording.
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

#[derive(Clone, Copy, PartialEq, Eq, ValueEnum)]
enum ViewArg {
    /// From straight above.
    Top,
    /// From a camera in the scene.
    Camera,
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

#[derive(Clone, Copy, ValueEnum)]
enum OcclusionArg {
    None,
    /// The ground at the feet.
    Ground,
    /// The ground and the bodies.
    Full,
}

#[derive(Clone, Copy, ValueEnum)]
enum ColourByArg {
    /// Each agent has its own hue.
    Agent,
    /// Each group has its own hue.
    Group,
    /// Planned speed: red stands, green walks briskly.
    Speed,
    /// Blue blends examples, ochre deforms the base walk.
    Synthesis,
    /// Agents around: green is free, red is crowded.
    Density,
}

impl From<CompressionArg> for ExrCompression {
    fn from(arg: CompressionArg) -> Self {
        match arg {
            CompressionArg::Zip16 => Self::Zip16,
            CompressionArg::Zip1 => Self::Zip1,
            CompressionArg::Rle => Self::Rle,
            CompressionArg::Piz => Self::Piz,
            CompressionArg::None => Self::Uncompressed,
        }
    }
}

impl From<ColourSpaceArg> for ColourSpace {
    fn from(arg: ColourSpaceArg) -> Self {
        match arg {
            ColourSpaceArg::Rec709 => Self::Rec709,
            ColourSpaceArg::AcesCg => Self::AcesCg,
        }
    }
}

/// Reads a picture's size, such as `1920x1080`.
fn size_px(text: &str) -> Result<[u32; 2], String> {
    let side = |text: &str| text.parse().ok().filter(|side| SIDE_PX.contains(side));
    let sides = text.split_once('x').and_then(|(width, height)| Some([side(width)?, side(height)?]));
    sides.ok_or_else(|| "give a size such as 1920x1080, of 16 to 8192 pixels a side".to_owned())
}

fn sample_pattern(text: &str) -> Result<SamplePattern, String> {
    let count = text.parse().ok();
    count.and_then(SamplePattern::of).ok_or_else(|| "give 1, 4 or 16".to_owned())
}

pub(crate) fn run(args: &Args) -> Result<Answer, Failure> {
    let recording = rendering::open(&args.recording)?;
    let rendered = match args.view {
        ViewArg::Top => render_top(args, &recording)?,
        ViewArg::Camera => render_camera(args, &recording)?,
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
    if args.exr.passes.is_some() || args.exr.compression.is_some() || args.exr.colour_space.is_some() {
        return Err(Failure::bad("--passes, --compression and --colour-space need --view camera".to_owned()));
    }
    if args.camera.camera.is_some() || args.camera.cameras.is_some() {
        return Err(Failure::bad("--camera and --cameras choose a camera; add --view camera".to_owned()));
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
    let ExrArgs { passes, compression, colour_space } = &args.exr;
    if !matches!(args.format, FormatArg::Exr) && (passes.is_some() || compression.is_some() || colour_space.is_some()) {
        return Err(Failure::bad(
            "--passes, --compression and --colour-space belong to EXR; add --format exr".to_owned(),
        ));
    }
    let mut inputs = vec![args.recording.clone()];
    let (mut size_px, mut other_cameras) = (*size, None);
    if let Some(path) = cameras {
        if camera_file::is_camera_file(path) {
            let view = &recording.header().scenario.view;
            let [width, height] = size_px.unwrap_or([view.width, view.height]).map(f64::from);
            other_cameras = Some(camera_file::cameras_of(path, width / height, args.outside.into())?);
        } else {
            let (mut scenario, _) = scenario::read(path)?;
            camera_file::resolve(&mut scenario, path, args.outside.into())?;
            size_px = size_px.or(Some([scenario.view.width, scenario.view.height]));
            other_cameras = Some(scenario.cameras);
        }
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

fn constraints_of(args: &Args, count: usize) -> Result<Vec<usize>, Failure> {
    match args.overlay {
        Some(OverlayArg::Constraints) if args.agent.is_empty() => Err(Failure::bad(format!(
            "--overlay constraints draws the velocity space of an agent, and no agent is named; add --agent N (0 to {})",
            count.saturating_sub(1)
        ))),
        Some(OverlayArg::Constraints) | None => Ok(args.agent.clone()),
    }
}

impl From<FormatArg> for PictureFormat {
    fn from(format: FormatArg) -> Self {
        match format {
            FormatArg::Png => Self::Png,
            FormatArg::Exr => Self::Exr,
        }
    }
}

impl From<OcclusionArg> for Occlusion {
    fn from(occlusion: OcclusionArg) -> Self {
        match occlusion {
            OcclusionArg::None => Self::None,
            OcclusionArg::Ground => Self::Ground,
            OcclusionArg::Full => Self::Full,
        }
    }
}

impl From<ColourByArg> for ColourBy {
    fn from(colour_by: ColourByArg) -> Self {
        match colour_by {
            ColourByArg::Agent => Self::Agent,
            ColourByArg::Group => Self::Group,
            ColourByArg::Speed => Self::Speed,
            ColourByArg::Synthesis => Self::Synthesis,
            ColourByArg::Density => Self::Density,
        }
    }
}

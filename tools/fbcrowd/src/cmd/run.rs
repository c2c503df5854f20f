//! `fbcrowd run`: the main job in one line: compile, simulate, measure, render.

use std::fs;
use std::path::{Path, PathBuf};
use std::sync::Arc;

use fbcrowd_jobs::camera_file;
use fbcrowd_jobs::character::{self, ScenarioCharacters};
use fbcrowd_jobs::clip_paths;
use fbcrowd_jobs::compiling::{self, Overrides};
use fbcrowd_jobs::output_path::{LockedFolder, check_files};
use fbcrowd_jobs::rendering::{self, RenderedSequence};
use fbcrowd_jobs::simulation;
use fbcrowd_jobs::wording::counted;
use fbcrowd_jobs::{JobEvent, Observer};
use fbcrowd_render::camera::CameraOptions;
use fbcrowd_render::top_view::{PictureFormat, SequenceOptions};
use fbcrowd_scenes::{ReadOptions, is_scene};
use fbcrowd_sim::measures;
use fbcrowd_sim::scenario::{self, MotionSource, Scenario};
use motiondb::files::database_file;
use motiondb::motion::MotionDb;

use crate::cmd::convert::{Conversion, Converted, duration_s};
use crate::cmd::outside_arg::OutsideArg;
use crate::cmd::rejected;
use crate::report::crowd::{measures_text, timings_text};
use crate::report::plain_text::without_control_characters;
use crate::terminal::failure::{Answer, Failure};
use crate::terminal::output;
use crate::terminal::progress::ProgressDisplay;

/// Compile the clips of a scenario, then simulate and render the scenario.
///
/// Writes `motion.fbdb`, `NAME.fbrec`, `trajectories.png` and `frames/NAME.####.png`; where the scenario has a camera,
/// its first one's frames to `camera/NAME.####.png`, and where it has characters, `characters/`. A scene of another program is
/// converted first: `NAME.toml` is written beside them.
#[derive(clap::Args)]
#[command(
    after_help = "Examples:\n  fbcrowd run assets/scenarios/antipodal.toml\n  fbcrowd run tradeshow.xml --clips assets/clips --duration 60"
)]
pub(crate) struct Args {
    /// The scenario; or a scene that `fbcrowd convert` reads.
    #[arg(value_name = "SCENARIO.toml")]
    scenario: PathBuf,
    /// Clips or manifest for the motion of a scene of another program.
    #[arg(long, value_name = "PATH")]
    clips: Option<PathBuf>,
    /// Simulated time of a scene of another program, s; default: the scene's, or 120 s.
    #[arg(long, value_name = "SECONDS", value_parser = duration_s)]
    duration: Option<f64>,
    /// The folder to write to; `out/NAME` by default.
    #[arg(short, long, value_name = "DIR")]
    output: Option<PathBuf>,
    #[command(flatten)]
    outside: OutsideArg,
}

pub(crate) fn run(args: &Args) -> Result<Answer, Failure> {
    let progress = ProgressDisplay::default();
    let observer = |event: JobEvent<'_>| progress.observe(event);
    let subject = Subject::new(args)?;
    let read = scenario::read(&subject.file);
    if read.is_err() {
        subject.remove_written();
    }
    let Subject { file, folder, files, answer: converted, .. } = subject;
    let (mut scenario, motion) = read?;
    let motion = motion?;
    let files = [files, camera_file::files(&scenario, &file)].concat();
    camera_file::resolve(&mut scenario, &file, args.outside.into())?;
    let outputs = RunOutputs::new(folder, &scenario);
    let characters = ScenarioCharacters::load(&file, &scenario, args.outside.into(), &observer)?;
    let files = [files, characters.files.clone()].concat();
    outputs.check(&inputs(&file, files, &motion)?, &characters)?;

    // Everything that bad input can end comes before the first output.
    let MotionInput { db, checksum, answer } = MotionInput::new(motion, args, &outputs, &observer)?;
    scenario::check_styles(&file, &db.style_names())?;
    let db = Arc::new(db);
    characters.wear(&mut scenario, &db.skeleton);
    let mut prepared = simulation::prepare(Arc::clone(&db), scenario, &observer)?;
    prepared.character_checksums = characters.checksums();
    characters.note(&db.skeleton, &observer);
    let folders =
        [Some(&outputs.folder), Some(&outputs.frames.folder), outputs.camera.as_ref().map(|camera| &camera.folder)];
    let _locks =
        folders.into_iter().flatten().map(|folder| LockedFolder::exclusive(folder)).collect::<Result<Vec<_>, _>>()?;
    let checksum = match checksum {
        Some(checksum) => checksum,
        None => compiling::write_database(&outputs.database, &db, &observer)?,
    };
    characters.write(&outputs.recording)?;
    let timings = prepared.record(checksum, &outputs.recording, &observer)?;
    let recording = rendering::open(&outputs.recording)?;
    let measures = measures::measure(&recording)?;
    rendering::plot_trajectories(&recording, &outputs.trajectories)?;
    rendering::remove_frames(&outputs.frames.folder, &outputs.frames.name)?;
    let mut rendered = rendering::render(&recording, &outputs.frames, &observer)?;
    if let Some(camera) = &outputs.camera {
        rendering::remove_frames(&camera.folder, &camera.name)?;
        let worn = character::of_recording(&outputs.recording, recording.header())?;
        let camera = &CameraOptions { characters: worn, ..camera.clone() };
        rendered = rendered.and(rendering::render_camera(&recording, camera, &observer)?);
    }

    let figures = measures_text::text(&measures) + &timings_text::text(&timings);
    output::print(&(figures + &outputs_text(&rendered, &outputs.folder)))?;
    Ok(converted.and(answer))
}

/// The scenario file that is run.
struct Subject {
    file: PathBuf,
    /// The folder to write to, where it is stated.
    folder: Option<PathBuf>,
    /// Files of the scene from which it was converted.
    files: Vec<PathBuf>,
    /// Files that the conversion wrote.
    written: Vec<PathBuf>,
    /// No where something happens otherwise than in that scene.
    answer: Answer,
}

impl Subject {
    /// The scenario of the arguments; a scene of another program is converted into the output folder first.
    fn new(args: &Args) -> Result<Self, Failure> {
        let Args { scenario, output, clips, duration, outside } = args;
        if !is_scene(scenario) {
            if clips.is_some() || duration.is_some() {
                let message = "--clips and --duration are for scenes of other programs";
                return Err(Failure::bad(format!("{message}; set `clips` and `duration_s` in {}", scenario.display())));
            }
            return Ok(Self {
                file: scenario.clone(),
                folder: output.clone(),
                files: Vec::new(),
                written: Vec::new(),
                answer: Answer::Yes,
            });
        }
        let Some(clips) = clips else {
            let message = format!("{} names no motion; add --clips with clips or a manifest", scenario.display());
            return Err(Failure::bad(message));
        };
        let stem = scenario.file_stem().unwrap_or_default();
        let folder = output.clone().unwrap_or_else(|| Path::new("out").join(stem));
        fs::create_dir_all(&folder).map_err(|error| Failure::unwritable(&folder, error))?;
        let file = folder.join(stem).with_extension("toml");
        let options = ReadOptions { allow_outside: outside.allow_outside, units: None };
        let conversion =
            Conversion { scene: scenario, output: &file, clips: Some(clips), duration_s: *duration, options };
        let Converted { report, inputs, outputs } = conversion.convert()?;
        output::say_text(without_control_characters(report.text().trim_end()).as_ref());
        let answer = Answer::of(!report.changes);
        Ok(Self { file, folder: Some(folder), files: inputs, written: outputs, answer })
    }

    /// Removes what the conversion wrote, since the scenario cannot be run.
    fn remove_written(&self) {
        // What cannot be removed stays; the error of the scenario is the one that matters.
        for file in &self.written {
            let _ = fs::remove_file(file);
        }
        if let (Some(folder), [_, ..]) = (&self.folder, &self.written[..]) {
            let _ = fs::remove_dir(folder);
            output::say_text("the converted scenario is not kept; `fbcrowd convert` writes it");
        }
    }
}

/// Where a run writes.
struct RunOutputs {
    folder: PathBuf,
    /// Written where the scenario names clips.
    database: PathBuf,
    recording: PathBuf,
    trajectories: PathBuf,
    frames: SequenceOptions,
    /// Frames of the scenario's first camera.
    camera: Option<CameraOptions>,
}

impl RunOutputs {
    fn new(folder: Option<PathBuf>, scenario: &Scenario) -> Self {
        let name = &scenario.name;
        let folder = folder.unwrap_or_else(|| Path::new("out").join(name));
        let camera = (!scenario.cameras.is_empty()).then(|| CameraOptions {
            folder: folder.join("camera"),
            name: name.clone(),
            ..CameraOptions::default()
        });
        Self {
            database: folder.join("motion.fbdb"),
            recording: folder.join(format!("{name}.fbrec")),
            trajectories: folder.join("trajectories.png"),
            frames: SequenceOptions {
                folder: folder.join("frames"),
                name: name.clone(),
                format: PictureFormat::Png,
                frames: None,
                shot: None,
                constraints_of: Vec::new(),
            },
            camera,
            folder,
        }
    }

    /// Checks that every output can be written, and replaces none of the inputs.
    fn check(&self, inputs: &Inputs, characters: &ScenarioCharacters) -> Result<(), Failure> {
        let database = inputs.are_compiled.then_some(&self.database);
        let files: Vec<PathBuf> = [&self.recording, &self.trajectories].into_iter().chain(database).cloned().collect();
        check_files(&self.folder, &files, &inputs.files)?;
        if let Some(camera) = &self.camera {
            rendering::check_old_frames(&camera.folder, &camera.name, &inputs.files)?;
        }
        let worn = characters.outputs(&self.recording);
        if let Some(folder) = worn.first().and_then(|path| path.parent()) {
            check_files(folder, &worn, &inputs.files)?;
        }
        Ok(rendering::check_old_frames(&self.frames.folder, &self.frames.name, &inputs.files)?)
    }
}

/// What a run reads.
struct Inputs {
    files: Vec<PathBuf>,
    /// Whether a database is compiled from them.
    are_compiled: bool,
}

fn inputs(scenario: &Path, files: Vec<PathBuf>, motion: &MotionSource) -> Result<Inputs, Failure> {
    let (motion, are_compiled) = match motion {
        MotionSource::Database(path) => (vec![path.clone()], false),
        MotionSource::Clips(clips) => {
            let paths = [clips.clone()];
            (clip_paths::inputs(&paths, &clip_paths::manifest(&paths)?), true)
        }
    };
    let files = [files, vec![scenario.to_owned()], scenario::agent_files(scenario)?, motion].concat();
    Ok(Inputs { files, are_compiled })
}

/// The scenario's motion in memory.
struct MotionInput {
    db: MotionDb,
    /// Checksum of the database's file; `None` where the database is compiled and not written yet.
    checksum: Option<u32>,
    /// No where some clip was refused.
    answer: Answer,
}

impl MotionInput {
    fn new(motion: MotionSource, args: &Args, outputs: &RunOutputs, observer: &Observer) -> Result<Self, Failure> {
        match motion {
            MotionSource::Database(path) => {
                let (db, checksum) = database_file::load(&path)?;
                Ok(Self { db, checksum: Some(checksum), answer: Answer::Yes })
            }
            MotionSource::Clips(clips) => {
                let overrides = Overrides { outside: args.outside.into(), ..Overrides::default() };
                let clips = [clips];
                let compiled = compiling::compile(&clips, &outputs.database, &overrides, observer)?;
                rejected::print_passed_over(&clips)?;
                rejected::print(&compiled.rejected);
                Ok(Self { db: compiled.db, checksum: None, answer: rejected::answer(&compiled.rejected) })
            }
        }
    }
}

fn outputs_text(rendered: &RenderedSequence, folder: &Path) -> String {
    let rendering = format!("{}, {:.1} ms a frame", counted(rendered.frames, "frame", "frames"), rendered.ms_per_frame);
    format!("{:<25}{rendering}\n{:<25}{}", "rendering", "written to", folder.display())
}

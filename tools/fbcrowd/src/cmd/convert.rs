//! `fbcrowd convert`: a scene of another program becomes a scenario file.

use std::path::{Component, Path, PathBuf};

use fbcrowd_jobs::output_path::{check_file, check_files, check_is_no_input};
use fbcrowd_scenes::write::{WriteOptions, WrittenScene, write};
use fbcrowd_scenes::{ReadOptions, Units, read};
use motiondb::files::atomic_file;

use crate::report::scenes::ConvertReport;
use crate::terminal::failure::{Answer, Failure};
use crate::terminal::output;

/// Convert a scene of another program (Menge, WKT, GeoJSON, DXF, Vadere) into a scenario file.
#[derive(clap::Args)]
#[command(
    after_help = "Examples:\n  fbcrowd convert tradeshow.xml -o tradeshow.toml --clips assets/clips\n  fbcrowd convert station.wkt -o station.toml\n  fbcrowd convert plan.dxf -o plan.toml --units mm\n\ndocs/convert.md lists what is read. Exit code 1: a note states that something happens otherwise than in the scene."
)]
pub(crate) struct Args {
    /// The scene: .xml (a Menge project), .wkt, .geojson, .json, .dxf or .scenario (Vadere).
    #[arg(value_name = "SCENE")]
    scene: PathBuf,
    /// The scenario file; long lists of agents are written beside it.
    #[arg(short, long, alias = "out", value_name = "SCENARIO.toml")]
    output: PathBuf,
    /// Clips or manifest that the scenario names as its motion.
    #[arg(long, value_name = "PATH")]
    clips: Option<PathBuf>,
    /// Simulated time, s; default: the scene's, or 120 s.
    #[arg(long, value_name = "SECONDS", value_parser = duration_s)]
    duration: Option<f64>,
    /// Unit of a DXF drawing; default: as its header states.
    #[arg(long, value_name = "UNIT", value_parser = ["m", "cm", "mm", "in", "ft"])]
    units: Option<String>,
    /// Also read files of a project that lie outside its folder.
    #[arg(long)]
    allow_outside: bool,
    /// Print JSON; docs/json.md describes it.
    #[arg(long)]
    json: bool,
}

/// A simulated time that scenario files take.
pub(crate) fn duration_s(text: &str) -> Result<f64, String> {
    match text.parse() {
        Ok(duration_s) if (0.001..=86_400.0).contains(&duration_s) => Ok(duration_s),
        _ => Err("give 0.001 to 86400 seconds".to_owned()),
    }
}

pub(crate) fn run(args: &Args) -> Result<Answer, Failure> {
    let units = args.units.as_deref().and_then(Units::of_name);
    let Args { scene, output, clips, duration, allow_outside, .. } = args;
    let conversion = Conversion {
        scene,
        output,
        clips: clips.as_deref(),
        duration_s: *duration,
        options: ReadOptions { allow_outside: *allow_outside, units },
    };
    let Converted { report, .. } = conversion.convert()?;
    if args.json {
        output::print_json(&report)?;
    } else {
        output::print(&report.text())?;
    }
    Ok(Answer::of(!report.changes))
}

/// A scene of another program, and the scenario file that it becomes.
pub(crate) struct Conversion<'a> {
    pub(crate) scene: &'a Path,
    pub(crate) output: &'a Path,
    /// Clips or manifest that the scenario names as its motion.
    pub(crate) clips: Option<&'a Path>,
    /// Simulated time, s; none: the scene's.
    pub(crate) duration_s: Option<f64>,
    pub(crate) options: ReadOptions,
}

/// What a conversion read and wrote.
pub(crate) struct Converted {
    pub(crate) report: ConvertReport,
    /// Files of the scene.
    pub(crate) inputs: Vec<PathBuf>,
    /// Files that were written.
    pub(crate) outputs: Vec<PathBuf>,
}

impl Conversion<'_> {
    /// Reads the scene and writes the scenario file and its agent files.
    pub(crate) fn convert(&self) -> Result<Converted, Failure> {
        let output = self.output.to_owned();
        check_is_no_input(&output, [self.scene])?;
        check_file(&output)?;
        let scene = read(self.scene, &self.options)?;
        let folder = folder_of(&output);
        let clips = self.clips.map(|clips| relative_to(folder, clips)).transpose()?;
        let stem = output.file_stem().unwrap_or_default().to_string_lossy().into_owned();
        let written = write(&scene.scene, &WriteOptions { stem, clips, duration_s: self.duration_s });
        let agent_files: Vec<PathBuf> =
            written.agent_files.iter().map(|file| output.with_file_name(&file.name)).collect();
        let outputs = [&agent_files[..], std::slice::from_ref(&output)].concat();
        check_files(folder, &outputs, &scene.inputs)?;
        write_files(&output, &agent_files, &written)?;
        let report = ConvertReport::new(&scene.scene, &output, &agent_files);
        Ok(Converted { report, inputs: scene.inputs, outputs })
    }
}

/// Writes the agent files first, so that no scenario names a file that is missing.
fn write_files(output: &Path, agent_files: &[PathBuf], written: &WrittenScene) -> Result<(), Failure> {
    let texts = written.agent_files.iter().map(|file| &file.text).chain([&written.scenario]);
    for (path, text) in agent_files.iter().map(PathBuf::as_path).chain([output]).zip(texts) {
        atomic_file::write(path, text.as_bytes()).map_err(|error| Failure::unwritable(path, error))?;
    }
    Ok(())
}

fn folder_of(path: &Path) -> &Path {
    path.parent().filter(|folder| !folder.as_os_str().is_empty()).unwrap_or(Path::new("."))
}

/// A path as a file in a folder names it.
fn relative_to(folder: &Path, path: &Path) -> Result<String, Failure> {
    let missing = |_| Failure::bad(format!("{} does not exist; name clips or a manifest", path.display()));
    let target = path.canonicalize().map_err(missing)?;
    if path.is_absolute() {
        return Ok(path.display().to_string());
    }
    let folder = folder.canonicalize().map_err(|error| Failure::unwritable(folder, error))?;
    let shared = folder.components().zip(target.components()).take_while(|(a, b)| a == b).count();
    let up = folder.components().skip(shared).map(|_| Component::ParentDir);
    let relative: PathBuf = up.chain(target.components().skip(shared)).collect();
    Ok(if relative.as_os_str().is_empty() { ".".to_owned() } else { relative.display().to_string() })
}

//! `fbcrowd inspect`: the content of a database, of clips or of a character, as tables, JSON and pictures.

mod character;
mod character_picture;

use std::path::{Path, PathBuf};

use fbcrowd_jobs::character::is_compiled;
use fbcrowd_jobs::compiling;
use fbcrowd_jobs::leave_one_out::leave_one_out;
use fbcrowd_jobs::output_path::check_files;
use fbcrowd_render::plots::database::{database_plot_paths, write_database_plots};
use motiondb::files::database_file::{self, FileError};
use motiondb::motion::MotionDb;
use motiondb_compiler::ClipSet;
use motiondb_compiler::input::nearest_first;
use motiondb_compiler::read::ForeignFormat;
use motiondb_compiler::survey::survey;

use self::character::CharacterOptions;
use crate::cmd::outside_arg::OutsideArg;
use crate::cmd::rejected;
use crate::report::correspondence_table::CorrespondenceTable;
use crate::report::inspect_report::{BrokenInvariant, BrokenReport, ClipsReport, DatabaseReport};
use crate::report::inspect_text;
use crate::report::motion::style_report::style_reports;
use crate::terminal::failure::{ALL_REJECTED, Answer, Failure};
use crate::terminal::output;
use crate::terminal::progress::ProgressDisplay;

/// Show the content of a database, of clips or of a character.
///
/// A single GLB, glTF or VRM file with meshes on a human skeleton is shown as a character too.
///
/// Exit code 0: success; 1: an invariant of the database is broken, or a clip was rejected; 2: nothing can be read.
#[derive(clap::Args)]
#[command(
    after_help = "Examples:\n  fbcrowd inspect motion.fbdb --plots out/plots\n  fbcrowd inspect motion.fbdb --leave-one-out\n  fbcrowd inspect motion.fbdb --correspondence walk_110 run_350\n  fbcrowd inspect my/clips --json\n  fbcrowd inspect figure.glb -o figure.png\n  fbcrowd inspect figure.glb --recording out/antipodal/antipodal.fbrec"
)]
pub(crate) struct Args {
    /// A database; clips: files or folders; or a character: *.fbchar, *.vrm, *.glb or *.gltf.
    #[arg(required = true, value_name = "FILE.fbdb|CLIPS|CHARACTER")]
    input: Vec<PathBuf>,
    /// Print JSON; docs/json.md describes it.
    #[arg(long)]
    json: bool,
    #[command(flatten)]
    outside: OutsideArg,
    /// Write pictures of a database: velocity sets, parameters, where the examples are thin, bodies, steps, transitions,
    /// and how similar the poses of m_sp and m_mb are.
    #[arg(long, value_name = "DIR")]
    plots: Option<PathBuf>,
    /// Show a style of a database; by default the one in which agents without a style move.
    #[arg(long, value_name = "NAME")]
    style: Option<String>,
    /// Draw a character alone: its bind pose with the joint of each role, and a stride, of the recording or of a bundled
    /// walk.
    #[arg(short, long, value_name = "PICTURE.png")]
    output: Option<PathBuf>,
    /// Show a character alone, and measure its feet on the bodies of a recording: planted slide, soles under the ground.
    #[arg(long, value_name = "FILE.fbrec")]
    recording: Option<PathBuf>,
    /// Show a character alone, without a mesh, by its name in the list; can be given several times.
    #[arg(long, value_name = "MESH")]
    hide: Vec<String>,
    /// For each recorded example: rebuild the database without it, blend at its parameters, and print the RMS joint
    /// distance to it. The distance to the nearest other example is printed for comparison.
    #[arg(long)]
    leave_one_out: bool,
    /// List the times at which two examples of a database have similar poses (positions and velocities of the joints),
    /// so that synthesis could change from one to the other. With --plots, also draw the distances of all their poses.
    #[arg(long, num_args = 2, value_names = ["FROM", "TO"])]
    correspondence: Option<Vec<String>>,
}

pub(crate) fn run(args: &Args) -> Result<Answer, Failure> {
    match args.input.as_slice() {
        [database] if is_database(database) && !is_of_character(args) => inspect_database(args, database),
        [path] if is_character(path) || is_of_character(args) || character::is_character_alone(path) => {
            character::show(path, &character_options(args)?)
        }
        _ if is_of_character(args) => {
            Err(Failure::bad("--recording, --output and --hide show one character; name one file"))
        }
        inputs if inputs.iter().any(|input| is_character(input)) => {
            Err(Failure::bad("a character is shown alone; inspect characters one by one, and clips without them"))
        }
        inputs if inputs.iter().any(|input| is_database(input)) => {
            Err(Failure::bad("a database is shown alone; inspect databases one by one, and clips without them"))
        }
        clips => {
            clips.iter().try_for_each(|path| check_kind(path))?;
            inspect_clips(args, clips)
        }
    }
}

/// Whether an option is given that shows a character alone.
fn is_of_character(args: &Args) -> bool {
    args.recording.is_some() || args.output.is_some() || !args.hide.is_empty()
}

fn character_options(args: &Args) -> Result<CharacterOptions<'_>, Failure> {
    Ok(CharacterOptions {
        json: args.json,
        outside: args.outside.into(),
        recording: args.recording.as_deref(),
        hide: &args.hide,
        picture: character_picture::path(args.output.as_deref(), args.plots.as_deref())?,
    })
}

/// Checks by its name that a file may hold clips. Folders, missing files and files of other formats are accepted here;
/// reading them gives a more precise error.
fn check_kind(path: &Path) -> Result<(), Failure> {
    let extension = path.extension().unwrap_or_default().to_string_lossy().to_ascii_lowercase();
    let is_accepted = ["bvh", "glb", "gltf", "toml"].contains(&extension.as_str());
    if !path.is_file() || is_accepted || ForeignFormat::of_name(path).is_some() {
        return Ok(());
    }
    let what = match extension.as_str() {
        "fbrec" => "a recording; `fbcrowd measure` and `fbcrowd render` show it",
        _ => {
            "neither a database (*.fbdb), a clip (*.bvh, *.glb, *.gltf) nor a character (*.fbchar, *.vrm); give one of \
              these, or a folder of clips"
        }
    };
    Err(Failure::bad(format!("{}: {what}", path.display())))
}

fn is_database(path: &Path) -> bool {
    path.extension().is_some_and(|extension| extension == "fbdb")
}

/// Whether a name is that of a character alone; *.glb and *.gltf may be clips.
fn is_character(path: &Path) -> bool {
    is_compiled(path) || path.extension().is_some_and(|extension| extension.eq_ignore_ascii_case("vrm"))
}

fn inspect_database(args: &Args, path: &Path) -> Result<Answer, Failure> {
    let whole = match database_file::load(path) {
        Ok((db, _)) => db,
        // The file could be read, and the answer is no.
        Err(broken @ FileError::Invariant { .. }) => return say_broken(args, &broken),
        Err(unreadable) => return Err(unreadable.into()),
    };
    let db = match &args.style {
        Some(style) => whole.of_style(style).ok_or_else(|| Failure::bad(no_style(&whole, style)))?,
        None => &whole,
    };
    let table = match args.correspondence.as_deref() {
        Some([from, to]) => Some(CorrespondenceTable::new(db, [from, to]).map_err(Failure::bad)?),
        _ => None,
    };
    if let Some(folder) = &args.plots {
        let further: Vec<(&MotionDb, PathBuf)> = match &args.style {
            Some(_) => Vec::new(),
            None => whole.further_styles.iter().map(|style| (style, folder.join(&style.style))).collect(),
        };
        check_plots(db, folder, path)?;
        further.iter().try_for_each(|(style, folder)| check_plots(style, folder, path))?;
        let mut pictures = write_database_plots(db, folder)?;
        for (style, folder) in &further {
            pictures.extend(write_database_plots(style, folder)?);
        }
        if let Some(table) = &table {
            pictures.push(table.draw(db, folder)?);
        }
        pictures.iter().for_each(|picture| output::say(&format!("drew {}", picture.display())));
    }
    let mut report = DatabaseReport::new(db, style_reports(&whole));
    report.correspondence_between = table;
    report.leave_one_out = args.leave_one_out.then(|| leave_one_out(db));
    if args.json {
        output::print_json(&report)?;
    } else {
        output::print(&inspect_text::database_text(db, &report))?;
    }
    Ok(Answer::Yes)
}

/// That a database lacks a style, and which ones it has.
fn no_style(db: &MotionDb, style: &str) -> String {
    let styles: Vec<&str> = db.styles().map(|db| db.style.as_str()).filter(|style| !style.is_empty()).collect();
    if styles.is_empty() {
        return format!("there is no style `{style}`: the database has none; leave --style out");
    }
    format!("there is no style `{style}`; the database has {}", nearest_first(style, styles).join(", "))
}

/// Checks that every plot can be written, and none replaces the database.
fn check_plots(db: &MotionDb, folder: &Path, database: &Path) -> Result<(), Failure> {
    let mut plots = database_plot_paths(db, folder);
    plots.push(CorrespondenceTable::plot_path(folder));
    Ok(check_files(folder, &plots, &[database.to_owned()])?)
}

fn say_broken(args: &Args, broken: &FileError) -> Result<Answer, Failure> {
    if let (true, FileError::Invariant { invariant, detail, .. }) = (args.json, broken) {
        let broken = BrokenInvariant { invariant: (*invariant).to_owned(), detail: detail.clone() };
        output::print_json(&BrokenReport { broken })?;
    }
    output::say(&broken.to_string());
    Ok(Answer::No)
}

fn inspect_clips(args: &Args, paths: &[PathBuf]) -> Result<Answer, Failure> {
    let of_databases = [
        (args.plots.is_some(), "--plots draws databases"),
        (args.style.is_some(), "--style shows a style of a database"),
        (args.leave_one_out, "--leave-one-out needs a database"),
        (args.correspondence.is_some(), "--correspondence compares examples of a database"),
    ];
    if let Some((_, message)) = of_databases.into_iter().find(|(is_given, _)| *is_given) {
        return Err(Failure::bad(format!("{message}; compile the clips first with `fbcrowd compile`")));
    }
    let figure = match paths {
        [path] => character::of_clip(path, args.outside.into()),
        _ => None,
    };
    let progress = ProgressDisplay::default();
    let ClipSet { clips, rejected } = compiling::import(paths, args.outside.into(), &|event| progress.observe(event))?;
    rejected::print_passed_over(paths)?;
    rejected::print(&rejected);
    let has_character = figure.is_some();
    let (is_empty, answer) = (clips.is_empty(), rejected::answer(&rejected));
    let surveyed = survey(clips);
    if args.json {
        let mut report = ClipsReport::new(&surveyed, rejected);
        report.character = figure;
        output::print_json(&report)?;
    } else if let (false, Some(character)) = (is_empty, &figure) {
        output::print(&format!("{}\n{}", inspect_text::clips_text(&surveyed), character.text()))?;
    } else if !is_empty {
        output::print(&inspect_text::clips_text(&surveyed))?;
    } else if let Some(character) = &figure {
        output::print(&character.text())?;
    }
    if is_empty && !has_character {
        return Err(Failure::bad(ALL_REJECTED));
    }
    Ok(answer)
}

//! `fbcrowd clips`: writes the bundled clips.

use std::fs;
use std::path::PathBuf;

use fbcrowd_jobs::output_path::check_files;
use motiondb::files::atomic_file;

use crate::terminal::failure::{Answer, Failure};
use crate::terminal::output;

/// Write the bundled locomotion clips.
#[derive(clap::Args)]
#[command(after_help = "Example:\n  fbcrowd clips --output assets/clips")]
pub(crate) struct Args {
    /// Folder for the clips.
    #[arg(short, long, alias = "out", value_name = "DIR")]
    output: PathBuf,
}

pub(crate) fn run(args: &Args) -> Result<Answer, Failure> {
    let clips = clipgen::generate();
    let paths: Vec<PathBuf> = clips.iter().map(|clip| args.output.join(&clip.name)).collect();
    check_files(&args.output, &paths, &[])?;
    fs::create_dir_all(&args.output).map_err(|error| Failure::unwritable(&args.output, error))?;
    for (clip, path) in clips.iter().zip(&paths) {
        atomic_file::write(path, &clip.bytes).map_err(|error| Failure::unwritable(path, error))?;
    }
    output::print(&format!("{} clips in {}", clips.len(), args.output.display()))?;
    Ok(Answer::Yes)
}

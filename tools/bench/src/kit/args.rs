//! Arguments that several benches share, and the checks of their outputs.

use std::path::{Path, PathBuf};

use fbcrowd_jobs::output_path::check_files;

use crate::error::BenchError;

use fbcrowd_sim::scenario::STEP_RANGE_S;

/// The motion database of a bench.
#[derive(clap::Args)]
pub struct DatabaseArg {
    /// Motion database; default: compiled from the bundled clips.
    #[arg(long = "db", value_name = "FILE.fbdb")]
    pub database: Option<PathBuf>,
}

impl DatabaseArg {
    /// Checks, before work begins, that files can be written into a folder, which need not exist.
    pub(crate) fn check_folder(&self, folder: Option<&PathBuf>) -> Result<(), BenchError> {
        folder.map_or(Ok(()), |folder| self.check(folder, &[]))
    }

    /// Checks, before work begins, that a file can be written and is not the database. Its folder need not exist.
    pub(crate) fn check_file(&self, file: &Path) -> Result<(), BenchError> {
        let folder = file.parent().filter(|folder| !folder.as_os_str().is_empty()).unwrap_or(Path::new("."));
        self.check(folder, &[file.to_owned()])
    }

    fn check(&self, folder: &Path, files: &[PathBuf]) -> Result<(), BenchError> {
        let inputs: Vec<PathBuf> = self.database.iter().cloned().collect();
        Ok(check_files(folder, files, &inputs)?)
    }
}

/// The clips of a bench of the compiler.
#[derive(clap::Args)]
pub struct MocapArg {
    /// Folder of motion-capture clips (not included in this repository).
    #[arg(long, value_name = "DIR")]
    pub mocap: PathBuf,
}

/// The seeds of a bench.
#[derive(clap::Args)]
pub struct SeedsArg {
    /// Seeds to run; default: all.
    #[arg(long, value_name = "N,N", value_delimiter = ',')]
    pub seeds: Vec<u64>,
}

/// The time step of a bench of behaviour.
#[derive(clap::Args)]
pub struct StepArg {
    /// Time step, s, as a number or a fraction; crowds are judged at 0.1, 1/30 and 1/60.
    #[arg(long = "dt", value_name = "S", value_parser = step_s, default_value = "0.1")]
    pub dt_s: f32,
}

/// Reads a time step: a number or a fraction such as `1/60`, in the range of a scenario's `dt_s`.
fn step_s(text: &str) -> Result<f32, String> {
    let number = |text: &str| text.parse::<f32>().map_err(|_| format!("`{text}` is not a number"));
    let dt_s = match text.split_once('/') {
        Some((above, below)) => number(above)? / number(below)?,
        None => number(text)?,
    };
    if STEP_RANGE_S.contains(&dt_s) { Ok(dt_s) } else { Err(format!("{dt_s} s is not between 0.001 and 0.25 s")) }
}

/// The pictures of a bench.
#[derive(clap::Args)]
pub struct PlotsArg {
    /// Write plots to this folder: agent paths, and the bench's table or diagram if it has one.
    #[arg(long, value_name = "DIR")]
    pub plots: Option<PathBuf>,
}

/// The picture of a bench that always draws one.
#[derive(clap::Args)]
pub struct PictureArg {
    /// Picture of the agent paths; default: out/NAME.png with the NAME of the bench.
    #[arg(short, long, value_name = "FILE.png")]
    pub output: Option<PathBuf>,
}

impl PictureArg {
    /// Path of the picture; `out/NAME.png` with the name of the bench where none is given.
    pub fn path(&self, bench: &str) -> PathBuf {
        self.output.clone().unwrap_or_else(|| PathBuf::from(format!("out/{bench}.png")))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_step_is_a_number_or_a_fraction_in_range() {
        assert_eq!((step_s("0.1"), step_s("1/60")), (Ok(0.1), Ok(1.0 / 60.0)));
        for text in ["1/0", "0.5", "0/1", "a/2", "", "nan"] {
            assert!(step_s(text).is_err(), "{text}");
        }
    }
}

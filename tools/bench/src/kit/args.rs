//! Arguments that several benches share.

use std::path::PathBuf;

/// The motion database of a bench.
#[derive(clap::Args)]
pub struct DatabaseArg {
    /// Motion database; default: compiled from the bundled clips.
    #[arg(long = "db", value_name = "FILE.fbdb")]
    pub database: Option<PathBuf>,
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

//! Arguments that several benches share.

use std::path::PathBuf;

/// The motion database of a bench.
#[derive(clap::Args)]
pub struct DatabaseArg {
    /// Motion database of the bodies; that of the bundled clips by default.
    #[arg(long = "db", value_name = "FILE.fbdb")]
    pub database: Option<PathBuf>,
}

/// The clips of a bench of the compiler.
#[derive(clap::Args)]
pub struct MocapArg {
    /// Folder of clips: recordings of others, which are no part of this repository.
    #[arg(long, value_name = "DIR")]
    pub mocap: PathBuf,
}

/// The seeds of a bench.
#[derive(clap::Args)]
pub struct SeedsArg {
    /// Only these seeds; all by default.
    #[arg(long, value_name = "N,N", value_delimiter = ',')]
    pub seeds: Vec<u64>,
}

/// The pictures of a bench.
#[derive(clap::Args)]
pub struct PlotsArg {
    /// Draw into this folder: the paths of all agents, and the bench's table or diagram where it has one.
    #[arg(long, value_name = "DIR")]
    pub plots: Option<PathBuf>,
}

/// The picture of a bench that always draws one.
#[derive(clap::Args)]
pub struct PictureArg {
    /// The picture of the paths; by default out/NAME.png with the NAME of the bench.
    #[arg(short, long, value_name = "FILE.png")]
    pub output: Option<PathBuf>,
}

impl PictureArg {
    /// Path of the picture; `out/NAME.png` with the name of the bench where none is given.
    pub fn path(&self, bench: &str) -> PathBuf {
        self.output.clone().unwrap_or_else(|| PathBuf::from(format!("out/{bench}.png")))
    }
}

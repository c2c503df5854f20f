//! The option `--allow-outside` of the commands that read clips.

use motiondb_compiler::Outside;

/// Whether buffers of glTF files, and files of a project, may lie outside its folder.
#[derive(Clone, Copy, clap::Args)]
pub(crate) struct OutsideArg {
    /// Also read buffers of glTF files that lie outside the folder of their .gltf file.
    #[arg(long)]
    pub(crate) allow_outside: bool,
}

impl From<OutsideArg> for Outside {
    fn from(arg: OutsideArg) -> Self {
        if arg.allow_outside { Self::Allowed } else { Self::Refused }
    }
}

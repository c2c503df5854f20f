//! The picture of a character: where it is written, and the stride that it shows.

use std::fs;
use std::path::{Path, PathBuf};

use fbcrowd_jobs::compiling::{self, Overrides};
use fbcrowd_jobs::output_path::{check_file, check_is_no_input};
use fbcrowd_render::plots::character::{Stride, character_sheet};
use fbcrowd_render::png_frame;
use fbcrowd_sim::recording::Recording;
use motiondb::character::Character;

use crate::cmd::png_path::check_is_png;
use crate::terminal::failure::Failure;
use crate::terminal::output;

/// The bundled clip whose stride is shown where there is no recording.
const NEUTRAL_WALK: &str = "walk_110.bvh";

/// The path of the picture, if one is requested.
pub(super) fn path(output: Option<&Path>, plots: Option<&Path>) -> Result<Option<PathBuf>, Failure> {
    if plots.is_some() {
        return Err(Failure::bad("--plots draws databases; draw a character with --output PICTURE.png"));
    }
    let Some(path) = output else { return Ok(None) };
    check_is_png(path)?;
    Ok(Some(path.to_owned()))
}

/// Checks that the picture can be written, and replaces none of the files that are read.
pub(super) fn check(path: &Path, inputs: &[&Path]) -> Result<(), Failure> {
    check_is_no_input(path, inputs)?;
    Ok(check_file(path)?)
}

/// Draws the picture, with a stride of a recording or of a bundled walk.
pub(super) fn write(path: &Path, character: &Character, recording: Option<&Recording>) -> Result<(), Failure> {
    let stride = match recording {
        Some(recording) => Stride::of_recording(recording)?,
        None => neutral_stride()?,
    };
    png_frame::write(path, &character_sheet(character, &stride))?;
    output::say(&format!("drew {}", path.display()));
    Ok(())
}

/// A stride of a bundled walk, from a database of this clip alone.
fn neutral_stride() -> Result<Stride, Failure> {
    let folder = tempfile::tempdir().map_err(|error| Failure::unwritable(&std::env::temp_dir(), error))?;
    let path = folder.path().join(NEUTRAL_WALK);
    let clip = clipgen::generate().into_iter().find(|clip| clip.name == NEUTRAL_WALK);
    let bytes = clip.map(|clip| clip.bytes).unwrap_or_default();
    fs::write(&path, bytes).map_err(|error| Failure::unwritable(&path, error))?;
    let compiled = compiling::compile(&[path], &folder.path().join("walk.fbdb"), &Overrides::default(), &|_| ())?;
    Ok(Stride::of_database(&compiled.db))
}

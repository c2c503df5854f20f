//! Mistakes of cameras that are found after their file was read.

use std::path::Path;

use toml::Spanned;

use crate::scenario::error::ScenarioError;
use crate::scenario::file::cameras::camera_file::{CameraTables, is_scenario};
use crate::scenario::file::reading::{at_key, read_text};
use crate::scenario::file::scenario_file::ScenarioFile;

/// A mistake of a camera, by its index, that is found outside its file: shown at the line of the key that the message
/// begins with. Where the file cannot be read any more, that is the mistake.
pub fn camera_mistake(path: &Path, camera: usize, message: String, help: &str) -> ScenarioError {
    let pointed = || {
        let source = read_text(path)?;
        let spans: Vec<_> = match is_scenario(&source) {
            true => ScenarioFile::parse(&source)?.cameras().map(Spanned::span).collect(),
            false => CameraTables::parse(&source)?.cameras().map(Spanned::span).collect(),
        };
        let table = spans.get(camera).cloned().unwrap_or(0..0);
        Ok(at_key(&source, table, message, help))
    };
    pointed().unwrap_or_else(|error| error)
}

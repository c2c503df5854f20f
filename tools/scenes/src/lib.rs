//! Scenes of other programs become scenario files that read as if a person had written them.
//!
//! Every format is read into one neutral model, a [`Scene`]; one writer turns it into TOML. What a
//! scenario cannot say becomes a note: file, line, what, and whether it changes what happens.
//!
//! ```
//! # fn main() -> Result<(), Box<dyn std::error::Error>> {
//! use fbcrowd_scenes::{ReadOptions, read, write::{WriteOptions, write}};
//!
//! let folder = tempfile::tempdir()?;
//! let room = folder.path().join("room.wkt");
//! std::fs::write(&room, "POLYGON ((0 0, 8 0, 8 5, 0 5, 0 0))")?;
//! let read = read(&room, &ReadOptions::default())?;
//! let written = write(&read.scene, &WriteOptions::default());
//! assert!(written.scenario.contains("polygon_m = [[0, 0], [8, 0], [8, 5], [0, 5]]"));
//! # Ok(())
//! # }
//! ```
//!
//! Read [`scene`] (the model), then a format (`menge`, `plans`, `vadere`), then [`write`](mod@write).

mod error;
mod geometry;
mod json_place;
mod limits;
mod menge;
mod plans;
mod random;
pub mod scene;
mod vadere;
pub mod write;

use std::path::{Path, PathBuf};

use crate::geometry::free_ground::move_to_free_ground;
use crate::limits::check_limits;
use crate::scene::Scene;

pub use error::SceneError;
pub use plans::Units;

/// How a scene is read.
#[derive(Clone, Copy, Debug, Default)]
pub struct ReadOptions {
    /// Whether a project may name files outside its folder.
    pub allow_outside: bool,
    /// Unit of a DXF drawing; none: as its header states.
    pub units: Option<Units>,
}

/// A scene, and the files from which it was read.
#[derive(Clone, Debug)]
pub struct ReadScene {
    /// The scene.
    pub scene: Scene,
    /// Files of the scene, which no output may replace.
    pub inputs: Vec<PathBuf>,
}

/// Whether a JSON file is a scenario of Vadere, not GeoJSON.
fn is_vadere(path: &Path) -> Result<bool, SceneError> {
    Ok(error::read_text(path)?.text.contains("\"topography\""))
}

/// Whether the extension of a name is that of a scene of another program.
pub fn is_scene(path: &Path) -> bool {
    const EXTENSIONS: [&str; 6] = ["xml", "wkt", "geojson", "json", "scenario", "dxf"];
    let extension = path.extension().unwrap_or_default().to_string_lossy().to_ascii_lowercase();
    EXTENSIONS.contains(&extension.as_str())
}

/// Reads a scene; the extension of its name states the format.
///
/// # Errors
/// Where a file cannot be read, is wrong, or is too large for a scenario: the error states file, line and remedy.
pub fn read(path: &Path, options: &ReadOptions) -> Result<ReadScene, SceneError> {
    let extension = path.extension().unwrap_or_default().to_string_lossy().to_ascii_lowercase();
    let alone = |scene: Scene| (scene, vec![path.to_owned()]);
    let (mut scene, inputs) = match extension.as_str() {
        "xml" => menge::read(path, options.allow_outside)?,
        "wkt" => alone(plans::read_wkt(path)?),
        "geojson" => alone(plans::read_geojson(path)?),
        "json" if is_vadere(path)? => alone(vadere::read(path)?),
        "json" => alone(plans::read_geojson(path)?),
        "scenario" => alone(vadere::read(path)?),
        "dxf" => alone(plans::read_dxf(path, options.units)?),
        _ => return Err(SceneError::UnknownFormat { path: path.to_owned() }),
    };
    check_limits(&scene, path)?;
    move_to_free_ground(&mut scene);
    Ok(ReadScene { scene, inputs })
}

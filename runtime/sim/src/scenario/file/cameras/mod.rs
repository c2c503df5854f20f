//! Cameras of a file: one that holds nothing else, or a scenario file.
//!
//! Enters: the text of the file. Leaves: checked cameras; every mistake at its position in the text.
//!
//! Read `camera_file`, then `camera_mistake` (mistakes that are found later, in the files that cameras name).

mod camera_file;
mod camera_mistake;

pub use camera_file::{CameraFile, read_camera_file};
pub use camera_mistake::camera_mistake;

//! Cameras of a file of their own, or of a scenario file.
//!
//! ```toml
//! [view]                              # size of the pictures; may be left out
//! width = 1920
//! height = 1080
//! [camera]                            # or several [[cameras]]: see `camera_spec.rs`
//! eye_m = [-8, -6, 1.65]
//! look_at_m = [0, 0, 1.2]
//! focal_mm = 35
//! ```

use std::path::Path;

use motiondb::files::SourceText;
use serde::Deserialize;
use toml::Spanned;

use crate::scenario::error::ScenarioError;
use crate::scenario::fault::{ScenarioFault, ScenarioPart};
use crate::scenario::file::reading::{at_key, parse, read_text};
use crate::scenario::file::scenario_file;
use crate::scenario::places::camera_spec::CameraSpec;
use crate::scenario::ranges::check_view;
use crate::scenario::rules::camera_check::check_cameras;
use crate::scenario::view::View;

/// Keys by one of which a file of cameras is recognised.
const KEYS: [&str; 3] = ["camera", "cameras", "view"];
/// How to mend a file without cameras.
const NO_CAMERA: &str = "add `[camera]` with a position and a lens, as docs/scenario.md shows it";

/// What a file states of cameras.
#[derive(Clone, Debug, PartialEq)]
pub struct CameraFile {
    /// The cameras, in the order of the file.
    pub cameras: Vec<CameraSpec>,
    /// The view, which states the size of their pictures; none where a file of cameras states none.
    pub view: Option<View>,
}

/// A file that holds cameras alone, as written.
#[derive(Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct CameraTables {
    view: Option<Spanned<View>>,
    camera: Option<Spanned<CameraSpec>>,
    #[serde(default)]
    cameras: Vec<Spanned<CameraSpec>>,
}

/// Reads the cameras of a scenario file, or of a file that holds nothing but cameras and a view.
///
/// # Errors
/// Where the file cannot be read, or a camera breaks a rule.
pub fn read_camera_file(path: &Path) -> Result<CameraFile, ScenarioError> {
    cameras_of(&read_text(path)?)
}

fn cameras_of(source: &SourceText) -> Result<CameraFile, ScenarioError> {
    if is_scenario(source) {
        let (scenario, _) = parse(source)?;
        return Ok(CameraFile { cameras: scenario.cameras, view: Some(scenario.view) });
    }
    let tables = CameraTables::parse(source)?;
    let cameras: Vec<CameraSpec> = tables.cameras().map(|camera| camera.get_ref().clone()).collect();
    if cameras.is_empty() {
        return Err(source.invalid(0..0, "there is no camera in this file", NO_CAMERA).into());
    }
    let view = tables.view.as_ref().map(|view| view.get_ref().clone());
    check_cameras(&cameras)
        .and_then(|()| view.as_ref().map_or(Ok(()), check_view))
        .map_err(|fault| tables.point_at(source, fault))?;
    Ok(CameraFile { cameras, view })
}

/// Whether a text states what only scenarios state.
pub(super) fn is_scenario(source: &SourceText) -> bool {
    source.has_a_key(&scenario_file::KEYS)
}

impl CameraTables {
    pub(super) fn parse(source: &SourceText) -> Result<Self, ScenarioError> {
        scenario_file::check_camera_count(source)?;
        toml::from_str(&source.text).map_err(|error| source.unparsed(error.span(), error.message(), &KEYS).into())
    }

    /// The tables of cameras, `[camera]` first.
    pub(super) fn cameras(&self) -> impl Iterator<Item = &Spanned<CameraSpec>> {
        self.camera.iter().chain(&self.cameras)
    }

    /// A broken rule, shown at the key or the table that breaks it.
    fn point_at(&self, source: &SourceText, fault: ScenarioFault) -> ScenarioError {
        let table = match fault.part {
            ScenarioPart::Camera(index) => self.cameras().nth(index).map_or(0..0, Spanned::span),
            _ => self.view.as_ref().map_or(0..0, Spanned::span),
        };
        at_key(source, table, fault.message, fault.help)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const STILL: &str = "eye_m = [0, -4, 1.6]\nlook_at_m = [0, 0, 1]";

    fn read(text: &str) -> Result<CameraFile, ScenarioError> {
        cameras_of(&SourceText { path: "cameras.toml".into(), text: text.to_owned() })
    }

    #[test]
    fn a_file_of_cameras_alone_is_enough() {
        let names = |file: &CameraFile| file.cameras.iter().map(|camera| camera.name.clone()).collect::<Vec<_>>();
        let one = read(&format!("[camera]\n{STILL}\nfocal_mm = 35\n")).unwrap();
        assert!(names(&one) == ["camera"] && one.view.is_none());
        let two = format!(
            "# two\n[view]\nwidth = 640\n[[cameras]]\nname = 'a'\n{STILL}\nfov_deg = 40\n\
             [[cameras]]\nname = 'b'\nfollow = {{ agent = 900 }}\nfov_deg = 40\n"
        );
        let two = read(&two).unwrap();
        assert!(names(&two) == ["a", "b"] && two.view.map(|view| view.width) == Some(640));
    }

    #[test]
    fn a_scenario_gives_its_cameras() {
        let text = format!(
            "duration_s = 1\nagents = {{ at_m = [0, 0], goals_m = [[1, 0]] }}\n[camera]\n{STILL}\nfov_deg = 40"
        );
        let file = read(&text).unwrap();
        assert_eq!((file.cameras.len(), file.view.map(|view| view.width)), (1, Some(1280)));
    }

    #[test]
    fn too_many_cameras_are_rejected_before_they_are_parsed() {
        // Without a lens, so that parsed cameras would be another mistake.
        let text = "[[cameras]]\n".repeat(1_001);
        let list = format!("cameras = [\n{}]", "{},\n".repeat(1_001));
        let texts = [
            (text.clone(), 1_001),
            (format!("duration_s = 1\nagents = []\n{text}"), 1_003),
            (list.clone(), 1_002),
            (format!("{list}\nduration_s = 1\nagents = []"), 1_002),
        ];
        for (text, line) in texts {
            let message = read(&text).unwrap_err().to_string();
            let expected = format!(":{line}: the file has more than 1000 cameras");
            assert!(message.contains(&expected), "{message}");
        }
    }

    #[test]
    fn mistakes_are_shown_at_line_and_key() {
        let cases = [
            (format!("[camera]\n{STILL}\n"), "cameras.toml:1: the camera has no focal length"),
            (format!("[camera]\n{STILL}\nfocal_mm = nan"), "cameras.toml:4: focal_mm is NaN"),
            (
                "[camera]\nlook_at_m = [0, 0, 1]\neye_m = [0, nan, 1]\nfov_deg = 40".into(),
                "cameras.toml:3: y of eye_m is NaN",
            ),
            (format!("[camera]\n{STILL}\nfov_deg = 40\nzoom = 2"), "cameras.toml:5: "),
            (format!("[camera]\n{STILL}\nfov_deg = 40\n[view]\nwidth = 0"), "cameras.toml:6: width is 0"),
            (format!("[camera]\n{STILL}\nfov_deg = 40\n[lights]\n"), "cameras.toml:5: "),
            (format!("[camera]\n{STILL}\nfov_deg = [\n"), "cameras.toml:4: "),
            ("[view]\nwidth = 640\n".into(), "cameras.toml:1: there is no camera in this file; add `[camera]`"),
            (String::new(), "cameras.toml:1: there is no camera in this file"),
            ("token = 3".into(), "this is a file of another kind, expected one of `view`, `camera`, `cameras`"),
        ];
        for (text, words) in cases {
            let message = read(&text).expect_err(&text).to_string();
            assert!(message.contains(words), "{text}\n{message}");
        }
    }
}

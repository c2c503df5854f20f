//! The same frame by Cycles, Blender's path tracer, on one thread of the CPU: where a Python has Blender as its package
//! `bpy`.
//!
//! Enters: triangles of a scene with a colour at each vertex, and a lens. Leaves: processor time of a frame with four
//! samples a pixel and direct light of a sun and of the sky, or the reason why there is none. World, metres.

use std::fs;
use std::io;
use std::path::{Path, PathBuf};
use std::process::Command;

use fbcrowd_render::visibility::{Lens, Meshes};
use glam::Vec3;
use schemars::JsonSchema;
use serde::Serialize;

/// The program that Python runs. A file called `cycles.py` would hide Blender's own module.
const PROGRAM: &str = include_str!("cycles_frame.py");
/// Variable of the environment that names a Python with `bpy`.
const VARIABLE: &str = "FBCROWD_BLENDER_PYTHON";
/// Pythons that are tried where neither option nor environment name one.
const PYTHONS: [&str; 2] = ["python3.11", "python3"];
/// Number of frames of which the quickest counts.
const TURNS: u32 = 2;
/// Greatest number of letters of Python's message that a reason quotes.
const QUOTED_LETTERS: usize = 300;

/// A frame by Cycles of the triangles that our frame of skinned characters draws.
#[derive(Debug, JsonSchema, Serialize)]
pub struct CyclesCase {
    /// Number of triangles, without the ground.
    pub triangles: usize,
    /// Version of Blender; null where it did not run.
    pub version: Option<String>,
    /// Processor time of a frame on one thread, s; null where it did not run.
    pub frame_s: Option<f64>,
    /// Why it did not run; null where it did.
    pub skipped: Option<String>,
}

impl CyclesCase {
    /// Times a frame by the named Python, or by the first that has `bpy`.
    pub(crate) fn measure(python: Option<&Path>, meshes: &Meshes, lens: &Lens) -> Self {
        let measured = python_with_blender(python).and_then(|python| {
            let folder = std::env::temp_dir().join(format!("fbcrowd_bench_cycles_{}", std::process::id()));
            let measured = write_scene(&folder, meshes, lens)
                .map_err(|error| format!("{}: {error}", folder.display()))
                .and_then(|()| run(&python, &folder));
            // A folder that stays does no harm.
            let _ = fs::remove_dir_all(&folder);
            measured
        });
        let triangles = meshes.triangles.len();
        match measured {
            Ok((version, frame_s)) => Self { triangles, version: Some(version), frame_s: Some(frame_s), skipped: None },
            Err(reason) => Self { triangles, version: None, frame_s: None, skipped: Some(reason) },
        }
    }

    /// The result as a line; `ours_s` is the time of our frame.
    pub(crate) fn line(&self, ours_s: f64) -> String {
        let Self { triangles, version, frame_s, skipped } = self;
        match (version, frame_s) {
            (Some(version), Some(frame_s)) => format!(
                "Cycles of Blender {version}, CPU, the same {triangles} triangles and 4 samples, direct light: {frame_s:.3} s a \
                 frame, {:.1} times ours\n",
                frame_s / ours_s
            ),
            _ => format!("Cycles: skipped: {}\n", skipped.as_deref().unwrap_or("not measured")),
        }
    }
}

/// The Python that is named, else the first that has `bpy`.
fn python_with_blender(named: Option<&Path>) -> Result<PathBuf, String> {
    let named = named.map(Path::to_owned).or_else(|| std::env::var_os(VARIABLE).map(PathBuf::from));
    let tried: Vec<PathBuf> = match &named {
        Some(python) => vec![python.clone()],
        None => PYTHONS.map(PathBuf::from).to_vec(),
    };
    let has_blender = |python: &&PathBuf| {
        let output = Command::new(python).args(["-c", "import bpy"]).output();
        output.is_ok_and(|output| output.status.success())
    };
    tried.iter().find(has_blender).cloned().ok_or_else(|| {
        let names = tried.iter().map(|python| python.display().to_string()).collect::<Vec<_>>().join(" or ");
        format!(
            "{names} has no package `bpy`; run `python3.11 -m pip install bpy==5.0.1`, or name a Python by \
             --blender-python or {VARIABLE}"
        )
    })
}

/// Writes what `cycles_frame.py` reads.
fn write_scene(folder: &Path, meshes: &Meshes, lens: &Lens) -> io::Result<()> {
    let numbers = |values: &[Vec3]| -> Vec<u8> {
        values.iter().flat_map(|value| value.to_array()).flat_map(f32::to_le_bytes).collect()
    };
    let corners: Vec<u8> = meshes.triangles.as_flattened().iter().flat_map(|corner| corner.to_le_bytes()).collect();
    let camera = serde_json::json!({
        "size_px": lens.size_px,
        "eye_m": lens.eye_m.to_array(),
        "right": lens.right.to_array(),
        "down": lens.down.to_array(),
        "forward": lens.forward.to_array(),
        "width_tangent": lens.pixel * lens.size_px[0] as f32,
    });
    fs::create_dir_all(folder)?;
    fs::write(folder.join("cycles_frame.py"), PROGRAM)?;
    fs::write(folder.join("camera.json"), camera.to_string())?;
    fs::write(folder.join("positions.f32"), numbers(&meshes.positions_m))?;
    fs::write(folder.join("colours.f32"), numbers(&meshes.colours))?;
    fs::write(folder.join("triangles.u32"), corners)
}

/// Blender's version, and the least processor time of a frame, s.
fn run(python: &Path, folder: &Path) -> Result<(String, f64), String> {
    let mut command = Command::new(python);
    command.arg(folder.join("cycles_frame.py")).arg(folder).arg(TURNS.to_string());
    let output = command.output().map_err(|error| format!("{}: {error}", python.display()))?;
    let printed = String::from_utf8_lossy(&output.stdout);
    result(&printed).filter(|_| output.status.success()).ok_or_else(|| {
        let said = String::from_utf8_lossy(&output.stderr);
        let last = said.trim_end().lines().last().unwrap_or("no message");
        format!("{} failed: {}", python.display(), last.chars().take(QUOTED_LETTERS).collect::<String>())
    })
}

/// The last line of `cycles_frame.py`: version and time, s.
fn result(printed: &str) -> Option<(String, f64)> {
    let line = printed.lines().rev().find_map(|line| line.strip_prefix("cycles "))?;
    let (version, frame_s) = line.rsplit_once(' ')?;
    Some((version.to_owned(), frame_s.parse().ok()?))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_python_without_blender_is_skipped_with_the_reason() {
        let lens = Lens::perspective([16, 9], Vec3::ZERO, Vec3::Y, 1.0);
        let case = CyclesCase::measure(Some(Path::new("/no/python")), &Meshes::default(), &lens);
        assert!(case.frame_s.is_none());
        let line = case.line(1.0);
        assert!(
            line.starts_with("Cycles: skipped: /no/python has no package `bpy`") && line.contains(VARIABLE),
            "{line}"
        );
    }

    #[test]
    fn the_result_is_the_line_of_the_program() {
        assert_eq!(result("Fra: 1\ncycles 5.0.1 LTS 12.250\nSaved\n"), Some(("5.0.1 LTS".to_owned(), 12.25)));
        assert_eq!(result("Saved\n"), None);
    }
}

//! Cameras of GLB and glTF files, as those of a scenario: for `[[cameras]]` with `gltf`, `render --cameras` and
//! `convert`.

use std::path::{Path, PathBuf};

use fbcrowd_sim::scenario::{
    CameraFile, CameraKey, CameraSpec, KeyLine, Scenario, View, camera_mistake, read_camera_file,
};
use glam::Vec3;
use motiondb_compiler::Outside;
use motiondb_compiler::read::gltf::{GltfCamera, GltfCameraKey, GltfLens, read_cameras};

use crate::error::JobError;

/// Distance of the point that a key looks at, m.
const TARGET_M: f64 = 10.0;

/// Whether a path names a file that may hold cameras.
pub fn is_camera_file(path: &Path) -> bool {
    let extension = path.extension().unwrap_or_default().to_string_lossy().to_ascii_lowercase();
    extension == "glb" || extension == "gltf"
}

/// All cameras of a file. `aspect`, the width of a picture over its height, holds for cameras that state none.
///
/// # Errors
/// If the file cannot be read, or has no camera.
pub fn cameras_of(path: &Path, aspect: f64, outside: Outside) -> Result<Vec<CameraSpec>, JobError> {
    let cameras = read_cameras(path, outside)?;
    if cameras.is_empty() {
        return Err(JobError::NoCamera { path: path.to_owned() });
    }
    Ok(cameras.iter().map(|camera| spec(camera, aspect)).collect())
}

/// Cameras of a file, for a recording.
#[derive(Clone, Debug, PartialEq)]
pub struct OtherCameras {
    /// The cameras, in the file's order.
    pub cameras: Vec<CameraSpec>,
    /// Size of their pictures, pixels: that of a TOML file's `[view]`; none where the file states none.
    pub size_px: Option<[u32; 2]>,
}

/// The cameras of a GLB, glTF or TOML file for a recording with a view. `size_px` is a stated size of the pictures, before
/// the file's and the recording's: a camera of a glTF file takes the picture's proportions from it.
///
/// # Errors
/// If the file cannot be read, or a camera breaks a rule: shown at its line.
pub fn cameras_for(
    path: &Path,
    recorded: &View,
    size_px: Option<[u32; 2]>,
    outside: Outside,
) -> Result<OtherCameras, JobError> {
    let aspect = |size_px: Option<[u32; 2]>| {
        let [width, height] = size_px.unwrap_or([recorded.width, recorded.height]).map(f64::from);
        width / height
    };
    if is_camera_file(path) {
        return Ok(OtherCameras { cameras: cameras_of(path, aspect(size_px), outside)?, size_px: None });
    }
    let CameraFile { mut cameras, view } = read_camera_file(path)?;
    let of_file_px = view.map(|view| [view.width, view.height]);
    resolve_cameras(&mut cameras, aspect(size_px.or(of_file_px)), path, outside)?;
    Ok(OtherCameras { cameras, size_px: of_file_px })
}

/// Replaces the cameras of a scenario that name a file by what the file holds. Paths are relative to the scenario's file.
///
/// # Errors
/// If a file cannot be read, or does not have the camera: shown at the line of the scenario that names it.
pub fn resolve(scenario: &mut Scenario, file: &Path, outside: Outside) -> Result<(), JobError> {
    let aspect = f64::from(scenario.view.width) / f64::from(scenario.view.height);
    resolve_cameras(&mut scenario.cameras, aspect, file, outside)
}

fn resolve_cameras(cameras: &mut [CameraSpec], aspect: f64, file: &Path, outside: Outside) -> Result<(), JobError> {
    for (index, camera) in cameras.iter_mut().enumerate() {
        if let Some(gltf) = &camera.gltf {
            let path = file.parent().unwrap_or(Path::new("")).join(gltf);
            let mistake = |message: String, help: &str| JobError::from(camera_mistake(file, index, message, help));
            let chosen = chosen(&path, camera.node.as_deref(), aspect, outside, mistake)?;
            *camera = CameraSpec { name: camera.name.clone(), fog_m: camera.fog_m, ..chosen };
        }
    }
    Ok(())
}

/// The camera that a node of a file holds; the file's first one where no node is named. `mistake` makes an error of a
/// message, which begins with a key, and a remedy.
fn chosen(
    path: &Path,
    node: Option<&str>,
    aspect: f64,
    outside: Outside,
    mistake: impl Fn(String, &str) -> JobError,
) -> Result<CameraSpec, JobError> {
    if !path.exists() {
        return Err(mistake(
            format!("gltf: {} is no file", path.display()),
            "give a path relative to the file that names it",
        ));
    }
    let found = cameras_of(path, aspect, outside).map_err(|error| {
        if error.is_of_machine() { error } else { mistake(format!("gltf: {error}"), "or name another file") }
    })?;
    let names = found.iter().map(|camera| camera.name.as_str()).collect::<Vec<_>>().join(", ");
    let camera = match node {
        None => found.into_iter().next(),
        Some(node) => found.into_iter().find(|found| found.name == node),
    };
    camera.ok_or_else(|| {
        let message = format!("node: there is no camera {:?} in {}", node.unwrap_or_default(), path.display());
        mistake(message, &format!("set `node` to one of: {names}"))
    })
}

/// The files that cameras of a scenario name.
pub fn files(scenario: &Scenario, file: &Path) -> Vec<PathBuf> {
    let folder = file.parent().unwrap_or(Path::new(""));
    scenario.cameras.iter().filter_map(|camera| Some(folder.join(camera.gltf.as_ref()?))).collect()
}

fn spec(camera: &GltfCamera, aspect: f64) -> CameraSpec {
    let (fov_deg, width_m) = match camera.lens {
        GltfLens::Orthographic { width_m } => (None, Some(width_m as f32)),
        GltfLens::Perspective { height_tangent, aspect: own } => {
            let half = 0.5 * height_tangent * own.unwrap_or(aspect);
            (Some((2.0 * libm::atan(half)).to_degrees().clamp(0.5, 170.0) as f32), None)
        }
    };
    let name: String = camera
        .name
        .chars()
        .map(|letter| if ['/', '\\'].contains(&letter) || letter.is_control() { '_' } else { letter })
        .collect();
    let placed = CameraSpec { name, fov_deg, width_m, ..CameraSpec::default() };
    match &camera.keys[..] {
        [only] => {
            let CameraKey { eye_m, look_at_m, up, .. } = key(only);
            CameraSpec { eye_m: Some(eye_m), look_at_m: Some(look_at_m), up, ..placed }
        }
        keys => CameraSpec { keys: keys.iter().map(key).collect(), key_line: KeyLine::Straight, ..placed },
    }
}

fn key(key: &GltfCameraKey) -> CameraKey {
    let GltfCameraKey { time_s, eye_m, forward, up } = *key;
    // A camera that is level needs no direction of its own.
    let right = forward.cross(glam::DVec3::Z);
    let is_level = up.z > 1e-3 && right.length() > 1e-3 && right.normalize().dot(up).abs() < 1e-5;
    let single = |vector: glam::DVec3| Vec3::new(vector.x as f32, vector.y as f32, vector.z as f32);
    CameraKey {
        time_s: time_s as f32,
        eye_m: single(eye_m),
        look_at_m: single(eye_m + TARGET_M * forward),
        up: (!is_level).then_some(single(up)),
    }
}

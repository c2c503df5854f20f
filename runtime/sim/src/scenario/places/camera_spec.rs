//! The `[camera]` and `[[cameras]]` tables: from where pictures at eye height are taken. World, metres, z up, seconds.
//!
//! A table states one of six ways in which the camera is placed, and one of three lenses:
//!
//! ```toml
//! [[cameras]]
//! name = "corner"
//! eye_m = [-8, -6, 1.65]              # still; or `keys`, `orbit`, `follow`, `eyes_of`, `gltf`
//! look_at_m = [0, 0, 1.2]
//! focal_mm = 35                       # with `film_width_mm = 36`; or `fov_deg`, or `width_m` (orthographic)
//! ```

use std::path::PathBuf;

use glam::Vec3;
use serde::{Deserialize, Serialize};

/// Name of a camera that states none.
const NAME: &str = "camera";
/// Width of the film that states none, mm: a still camera's, by which focal lengths are known.
const FILM_WIDTH_MM: f32 = 36.0;

/// A camera, as written; [`check_numbers`](crate::scenario::check) lets only whole ones pass.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields, default)]
pub struct CameraSpec {
    /// Name, by which a picture is requested.
    pub name: String,
    /// Position of a still camera, world, m.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub eye_m: Option<Vec3>,
    /// What a still camera looks at, world, m.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub look_at_m: Option<Vec3>,
    /// Direction that is up in the picture of a still camera, world; z where absent.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub up: Option<Vec3>,
    /// Positions over time.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub keys: Vec<CameraKey>,
    /// How the camera moves from key to key.
    #[serde(skip_serializing_if = "KeyLine::is_smooth")]
    pub key_line: KeyLine,
    /// GLB or glTF file that holds the camera, relative to the scenario's; what it holds takes its place before work
    /// begins.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub gltf: Option<PathBuf>,
    /// Name of the camera's node in that file; its first camera where absent.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub node: Option<String>,
    /// A circle around a point.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub orbit: Option<CameraOrbit>,
    /// A place behind an agent.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub follow: Option<CameraFollow>,
    /// Id of the agent whose eyes are the camera.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub eyes_of: Option<u32>,
    /// Focal length, mm.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub focal_mm: Option<f32>,
    /// Width of the film, mm.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub film_width_mm: Option<f32>,
    /// Field of view from the left to the right edge, degrees.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub fov_deg: Option<f32>,
    /// Width of the picture of an orthographic camera, m.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub width_m: Option<f32>,
    /// Distance at which fog leaves a third of the light, m; no fog where absent.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub fog_m: Option<f32>,
}

/// Where a keyed camera is at a time.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct CameraKey {
    /// Time, s.
    pub time_s: f32,
    /// Position, world, m.
    pub eye_m: Vec3,
    /// What it looks at, world, m.
    pub look_at_m: Vec3,
    /// Direction that is up in the picture, world; z where absent.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub up: Option<Vec3>,
}

/// How a camera moves from key to key.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum KeyLine {
    /// Without a jump of its velocity.
    #[default]
    Smooth,
    /// In straight lines.
    Straight,
}

impl KeyLine {
    fn is_smooth(&self) -> bool {
        *self == Self::Smooth
    }
}

/// A camera that circles a point, counter-clockwise as seen from above.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct CameraOrbit {
    /// The point that it looks at, world, m.
    pub centre_m: Vec3,
    /// Distance on the ground from that point, m.
    pub radius_m: f32,
    /// Height of the camera above the ground, m.
    pub height_m: f32,
    /// Time of one turn, s; negative for clockwise turns.
    pub period_s: f32,
    /// Direction from the point to the camera at 0 s, counter-clockwise from world x, degrees.
    #[serde(default)]
    pub start_deg: f32,
}

/// A camera that stays behind an agent.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct CameraFollow {
    /// Id of the agent.
    pub agent: u32,
    /// Distance behind the agent, m; negative before it.
    #[serde(default = "behind_m")]
    pub behind_m: f32,
    /// Distance to its left, m; negative to its right.
    #[serde(default)]
    pub left_m: f32,
    /// Height of the camera above the ground, m.
    #[serde(default = "height_m")]
    pub height_m: f32,
}

fn behind_m() -> f32 {
    3.5
}

fn height_m() -> f32 {
    1.9
}

impl Default for CameraSpec {
    fn default() -> Self {
        Self {
            name: NAME.to_owned(),
            eye_m: None,
            look_at_m: None,
            up: None,
            keys: Vec::new(),
            key_line: KeyLine::Smooth,
            gltf: None,
            node: None,
            orbit: None,
            follow: None,
            eyes_of: None,
            focal_mm: None,
            film_width_mm: None,
            fov_deg: None,
            width_m: None,
            fog_m: None,
        }
    }
}

impl CameraSpec {
    /// Width of the picture over its distance; none of an orthographic camera.
    pub fn width_tangent(&self) -> Option<f32> {
        let film_width_mm = self.film_width_mm.unwrap_or(FILM_WIDTH_MM);
        let by_fov = self.fov_deg.map(|fov_deg| 2.0 * libm::tanf(0.5 * fov_deg.to_radians()));
        self.focal_mm.map(|focal_mm| film_width_mm / focal_mm).or(by_fov)
    }
}

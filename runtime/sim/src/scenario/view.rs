//! How the top view frames a scenario: the `[view]` table.

use glam::Vec2;
use serde::{Deserialize, Serialize};

use crate::scenario::point;

/// How the top view frames the scene.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields, default)]
pub struct View {
    /// Width of the picture, pixels.
    pub width: u32,
    /// Height of the picture, pixels.
    pub height: u32,
    /// Frame rate of the sequence, Hz; the recording is sampled at it.
    pub frame_rate_hz: f32,
    /// Centre of the picture, world, m; framed automatically where absent.
    #[serde(deserialize_with = "point::optional")]
    pub centre_m: Option<Vec2>,
    /// Width of the ground that the picture shows, m; framed automatically where absent.
    pub width_m: Option<f32>,
    /// Length of the trails, s; 0 draws none.
    pub trail_s: f32,
    /// Whether each agent's index is written beside it.
    pub labels: bool,
}

impl Default for View {
    fn default() -> Self {
        Self {
            width: 1280,
            height: 720,
            frame_rate_hz: 30.0,
            centre_m: None,
            width_m: None,
            trail_s: 2.0,
            labels: false,
        }
    }
}

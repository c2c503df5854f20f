//! The bounding disc of an agent (`FbCrowd` §3.1), which planners and walls see of its body.

use glam::Vec2;

/// A disc in motion: position, velocity and radius, world axes.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Disc {
    /// p: centre, world, m.
    pub position_m: Vec2,
    /// v: velocity, world, m/s.
    pub velocity_mps: Vec2,
    /// r: radius, m.
    pub radius_m: f32,
}

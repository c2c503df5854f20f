//! A half-plane of permitted velocities that keeps its source.
//!
//! The convention of van den Berg et al. 2011, which `FbCrowd` §4.1 shares: a point and a unit direction, permitted is
//! the **left** side. World axes, m/s. With the source, a picture or a test can show why a velocity was chosen.

use glam::Vec2;

use crate::planning::plan::VelocitySet;

/// What a half-plane stands for.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum HalfPlaneSource {
    /// Edge of an obstacle, by index: C_iW (§4.4).
    Obstacle(u32),
    /// The stance foot: C_bm (§4.2).
    Stance,
    /// A sharp-turn edge of the wrapping polygon (§4.1).
    SharpTurn,
    /// An edge of the turning set (§4.1, Eqs. 4, 5).
    TurningHull,
    /// An edge of the holding set, of velocities at held facing ([`motiondb::velocity_sets::velocity_hull`]).
    HoldingHull,
    /// A one-way zone that holds the agent, by index.
    OneWay(u32),
    /// The queue that the agent waits in.
    Queue,
    /// Another agent, by index: C_ij (§4.4).
    Agent(u32),
}

impl From<VelocitySet> for HalfPlaneSource {
    /// The source of the edges of a set.
    fn from(set: VelocitySet) -> Self {
        match set {
            VelocitySet::Turning => Self::TurningHull,
            VelocitySet::Holding => Self::HoldingHull,
        }
    }
}

/// Velocities on the left of a directed line.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct HalfPlane {
    /// p: a point of the line, m/s.
    pub point_mps: Vec2,
    /// d: unit direction of the line.
    pub direction: Vec2,
    /// What the half-plane stands for.
    pub source: HalfPlaneSource,
    /// Weight of its violation where some half-planes must be violated: the greater, the less it yields.
    pub weight: f32,
}

impl HalfPlane {
    /// The half-plane behind a point, of weight 1; the unit vector `outward` points to the forbidden side.
    pub fn behind(point_mps: Vec2, outward: Vec2, source: HalfPlaneSource) -> Self {
        Self::new(point_mps, outward.perp(), source)
    }

    /// The half-plane on the left of a line, of weight 1.
    pub fn new(point_mps: Vec2, direction: Vec2, source: HalfPlaneSource) -> Self {
        Self { point_mps, direction, source, weight: 1.0 }
    }

    /// Distance of a velocity from the permitted side, m/s; negative inside.
    pub fn violation_mps(&self, velocity_mps: Vec2) -> f32 {
        self.direction.perp_dot(self.point_mps - velocity_mps)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_left_is_permitted_and_the_right_violates() {
        let x_up_to_two = HalfPlane::behind(Vec2::new(2.0, 5.0), Vec2::X, HalfPlaneSource::Stance);
        assert_eq!(x_up_to_two.violation_mps(Vec2::new(3.5, 0.0)), 1.5);
        assert_eq!(x_up_to_two.violation_mps(Vec2::new(0.0, -7.0)), -2.0);
    }
}

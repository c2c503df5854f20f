//! The blend space as it is stored: simplices in (v_f, ω_t, ω_s); and shares of examples (`FbCrowd` §5).
//!
//! Metric of all distances: each axis is first divided by its range over the examples.

use glam::{DVec3, Vec3};
use serde::{Deserialize, Serialize};

use crate::motion::parameters::Parameters;

/// Greatest number of corners of a simplex.
pub const MAX_CORNERS: usize = 4;

/// A triangulation of the examples' parameters, in as many dimensions as they span.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct BlendSpace {
    /// Number of dimensions that the examples span: 0 (one point) to 3.
    pub dimension: u32,
    /// Range of each axis over the examples, m/s, rad/s, m/s; distances are divided by it. 0: the axis is ignored.
    pub axis_ranges: [f32; 3],
    /// Corners of the simplices: indices of examples, `dimension + 1` for each.
    pub simplices: Vec<u32>,
    /// Volume of the simplices, divided by the volume of the examples' convex hull.
    pub covered_share: f32,
}

/// Shares of up to four examples. The shares sum to 1; unused entries are (0, 0).
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Shares {
    /// Indices of the examples.
    pub examples: [u32; MAX_CORNERS],
    /// Fraction of the cycle time that each example contributes (barycentric coordinate), in [0, 1].
    pub shares: [f32; MAX_CORNERS],
}

impl BlendSpace {
    /// Corners of each simplex, as indices of examples.
    pub fn simplices(&self) -> impl Iterator<Item = &[u32]> {
        self.simplices.chunks_exact(self.dimension as usize + 1)
    }

    /// A point with each axis divided by its range.
    pub fn scaled(&self, parameters: Parameters) -> Vec3 {
        parameters.to_vec3() * self.metric_scale().as_vec3()
    }

    /// Scale factor of each axis: 1 divided by its range; 0 for an ignored axis.
    pub(crate) fn metric_scale(&self) -> DVec3 {
        let scale = |range: f32| if range > 0.0 { f64::from(range).recip() } else { 0.0 };
        DVec3::from_array(self.axis_ranges.map(scale))
    }
}

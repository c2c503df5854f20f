//! Simplices in (v_f, ω_t, ω_s) and the shares of examples at a query (`FbCrowd` §5; `definitions.md`, "Blend").

use serde::{Deserialize, Serialize};

/// A triangulation of the examples' parameters in as many dimensions as they span.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct BlendSpace {
    /// 0 (one point) to 3.
    pub dimension: u32,
    /// Range of each axis over the examples, the metric's unit; 0 where an axis has no range and is dropped.
    pub axis_ranges: [f32; 3],
    /// Indices of examples, `dimension + 1` to a simplex.
    pub simplices: Vec<u32>,
    /// Volume of the simplices over the volume of the examples' convex hull.
    pub covered_share: f32,
}

//! Why no mesh can be made of a ground.

/// Why no mesh can be made of a ground.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum RouteError {
    /// A coordinate that the grid cannot hold.
    #[error("[{x_m}, {y_m}] is not within 16 km of the origin; give finite coordinates in metres, near the origin")]
    Coordinate {
        /// The coordinate in x, m.
        x_m: f32,
        /// The coordinate in y, m.
        y_m: f32,
    },
    /// A distance that routes cannot keep from walls.
    #[error("wall_radius_m is {wall_radius_m}, not between 0 and 10; give the distance from walls in metres")]
    WallRadius {
        /// The distance, m.
        wall_radius_m: f32,
    },
    /// Edges that cross, which the union of polygons on the grid excludes.
    #[error("{edges} edges of the free space cannot be triangulated; move obstacles by some millimetres")]
    Triangulation {
        /// Number of edges.
        edges: usize,
    },
    /// Walls of too much detail.
    #[error("the ground between the walls has {corners} corners, more than {most}; merge obstacles that overlap")]
    Corners {
        /// Number of corners.
        corners: usize,
        /// Greatest number of corners.
        most: usize,
    },
}

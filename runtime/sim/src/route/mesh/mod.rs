//! Free space as a mesh of triangles.
//!
//! Enters: the contours of the free space. Leaves: triangles, the triangle at a position, the nearest position on the
//! mesh, and the passages that are too narrow.
//!
//! Read along the data: `triangulation`, `route_mesh` (arrays), `clearance` (farther from walls where there is room),
//! `gates` and `cut` (one-way zones), `box_tree` and `locate` (positions on the mesh), `passages`.

pub(crate) mod box_tree;
pub(crate) mod clearance;
pub(crate) mod cut;
pub(crate) mod gates;
pub(crate) mod locate;
pub(crate) mod passages;
pub(crate) mod route_mesh;
pub(crate) mod triangulation;

pub use crate::route::polygons::error::RouteError;
pub use crate::route::polygons::free_space::{FreeSpace, walkable_contours_m};
pub use crate::route::polygons::ground::{Ground, WalkablePolygon};
pub use passages::{ClosedPassage, closed_passages};
pub use route_mesh::RouteMesh;

//! Free space as a mesh: where the centre of an agent that keeps its distance from walls can be.
//!
//! Enters: obstacles and walkable polygons, the distance from walls. Leaves: triangles, the triangle at a position, the
//! nearest position on the mesh, and the passages that are too narrow.
//!
//! Read along the data: `ground` (input), `grid` (1/1024 m), `outline` (one obstacle), `growth` (by the distance),
//! `union`, `free_space`, `triangulation`, `route_mesh` (arrays), `clearance` (farther from walls
//! where there is room), `gates` and `cut` (one-way zones), `box_tree` and `locate` (positions on the mesh), `passages`.

pub(crate) mod box_tree;
pub(crate) mod clearance;
pub(crate) mod cut;
pub(crate) mod error;
pub(crate) mod free_space;
pub(crate) mod gates;
pub(crate) mod grid;
pub(crate) mod ground;
pub(crate) mod growth;
pub(crate) mod locate;
pub(crate) mod outline;
pub(crate) mod passages;
pub(crate) mod route_mesh;
pub(crate) mod triangulation;
pub(crate) mod union;

pub use error::RouteError;
pub use free_space::{FreeSpace, walkable_contours_m};
pub use ground::{Ground, WalkablePolygon};
pub use passages::{ClosedPassage, closed_passages};
pub use route_mesh::RouteMesh;

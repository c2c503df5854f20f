//! Plane geometry of scenes, exact enough for a millimetre: polygons, walls without thickness, free ground. World,
//! metres.
//!
//! Enters: corners as a file lists them. Leaves: polygons that a scenario accepts, and starts apart from walls and each
//! other. Read `polygon` first, then `walls`, `free_ground` and
//! `inner_point`.

pub(crate) mod free_ground;
pub(crate) mod inner_point;
pub(crate) mod polygon;
pub(crate) mod rings;
pub(crate) mod walls;

//! Plans: ground alone, without agents. WKT, GeoJSON, DXF.
//!
//! Enters: the path of a file. Leaves: a [`Scene`] of walkable polygons and obstacles. Read `rings_of_plan` first (what
//! all have in common), then `wkt_plan`, `geojson_plan` with `coordinate_system`, and `dxf_plan` with `dxf_pairs`.

mod coordinate_system;
mod dxf_pairs;
mod dxf_plan;
mod geojson_plan;
mod rings_of_plan;
mod wkt_plan;

pub use dxf_plan::Units;
pub(crate) use dxf_plan::read as read_dxf;
pub(crate) use geojson_plan::read as read_geojson;
pub(crate) use wkt_plan::read as read_wkt;

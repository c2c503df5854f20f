//! The default camera: of many places and focal lengths, the one that shows a crowd best over its recording.
//!
//! Enters: a recording whose scenario states no camera, and the size of the pictures. Leaves: a camera, still or moving
//! with the crowd.
//!
//! Read `crowd` (a few moments of the recording), `candidates` (places that are tried), `framing` (aim and focal length
//! there), `walls` and `wall_grid` (what hides bodies), `coarse_picture` and `cell_rows` (how well a lens shows a moment),
//! `path` (how a moving camera goes), and `search` (the choice).

mod candidates;
mod cell_rows;
mod coarse_picture;
mod crowd;
mod framing;
mod path;
mod search;
mod wall_grid;
mod walls;

pub(crate) use search::{DEFAULT_NAME, default_camera};

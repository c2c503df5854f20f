//! The default camera: of many places and focal lengths, the one that shows a crowd best over its recording.
//!
//! Enters: a recording whose scenario states no camera, and the size of the pictures. Leaves: a camera, still or moving
//! with the crowd.
//!
//! Read `crowd` (a few moments of the recording), `candidates` (places that are tried), `framing` (aim and focal length
//! there), `walls` (what hides bodies), `coarse_picture` (how well a lens shows a moment), and `search` (the choice).

mod candidates;
mod coarse_picture;
mod crowd;
mod framing;
mod path;
mod search;
mod walls;

pub(crate) use search::{DEFAULT_NAME, default_camera};

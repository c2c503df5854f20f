//! Motion: what the database stores of each example, and when one example can follow another.
//!
//! Read `parameters` and `phase_map`, then `motion_db` (the database itself), then `correspondence` with `pose_distance`
//! (`FbCrowd` §5, Eq. 10).

pub(crate) mod correspondence;
pub(crate) mod motion_db;
pub(crate) mod parameters;
pub(crate) mod phase_map;
pub(crate) mod pose_distance;

pub use correspondence::{Alike, Correspondence, THRESHOLD_RATIO, table};
pub use motion_db::{MotionDb, MotionExample, PHASE_COUNT, Rows, SourceRecord};
pub use parameters::Parameters;
pub use phase_map::{PhaseMap, wrapped};
pub use pose_distance::{Distances, distances_m};

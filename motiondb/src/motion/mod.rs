//! Motion: what the database stores of each example, and the times in the cycle at which synthesis can switch from one
//! example to another.
//!
//! Enters: closed, phase-aligned cycles. Leaves: the database, and the correspondence times T between two examples
//! (`FbCrowd` §5, Eq. 10).
//!
//! Read `parameters` and `phase_map`, then `motion_db` (the database itself), then `pose_distance` and
//! `correspondence`.

pub(crate) mod correspondence;
pub(crate) mod motion_db;
pub(crate) mod parameters;
pub(crate) mod phase_map;
pub(crate) mod pose_distance;

pub use correspondence::{PosePair, THRESHOLD_RATIO, pose_pairs};
pub use motion_db::{Correspondence, MotionDb, MotionExample, PHASE_COUNT, Rows, SourceRecord};
pub use parameters::Parameters;
pub use phase_map::{PhaseMap, wrapped};
pub use pose_distance::{Distances, distances_m};

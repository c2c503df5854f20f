//! Motion: what the database stores of each example and of each action, and the times in the cycle at which synthesis can
//! switch from one example to another.
//!
//! Enters: closed, phase-aligned cycles. Leaves: the database, and the correspondence times T between two examples
//! (`FbCrowd` §5, Eq. 10).
//!
//! Read `parameters`, `phase_map` and `action`, then `motion_db` (the database itself) with `extra_motion`, then
//! `pose_distance` and `correspondence`.

pub(crate) mod action;
pub(crate) mod correspondence;
pub(crate) mod extra_motion;
pub(crate) mod motion_db;
pub(crate) mod parameters;
pub(crate) mod phase_map;
pub(crate) mod pose_distance;

pub use action::{ACTION_FRAMES_MAX, ACTION_RATE_HZ, Action, ActionEnd, ActionFrame, ActionKind};
pub use correspondence::{PosePair, THRESHOLD_RATIO, pose_pairs};
pub use extra_motion::{ExtraBone, ExtraMotion};
pub use motion_db::{Correspondence, MotionDb, MotionExample, PHASE_COUNT, Rows, SourceRecord};
pub use parameters::Parameters;
pub use phase_map::{PhaseMap, wrapped};
pub use pose_distance::{Distances, distances_m};

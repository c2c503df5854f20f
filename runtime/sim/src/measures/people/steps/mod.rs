//! How single bodies step: small steps, starts, stops, pivots; and where legs or hips do what no person's do.
//!
//! Enters: the track of each body. Leaves: figures of the crowd.
//!
//! Read `swing`, `start`, `stop`, `foot_pivot`, then `pelvis_lurch` and `shank_gap`.

pub(crate) mod foot_pivot;
pub(crate) mod pelvis_lurch;
pub(crate) mod shank_gap;
pub(crate) mod start;
pub(crate) mod stop;
pub(crate) mod swing;

pub(crate) use foot_pivot::FootPivotTally;
pub use foot_pivot::FootPivots;
pub(crate) use pelvis_lurch::PelvisLurchTally;
pub use pelvis_lurch::PelvisLurches;
pub(crate) use shank_gap::ShankGapTally;
pub use shank_gap::ShankGaps;
pub(crate) use start::StartTally;
pub use start::Starts;
pub(crate) use stop::StopTally;
pub use stop::Stops;
pub use swing::SwingClass;
pub(crate) use swing::SwingTally;

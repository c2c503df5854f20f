//! Measures of pedestrian studies: flow, lanes, density and speed, and the shape of a waiting crowd.
//!
//! Enters: the roots of all agents before and after each step. Leaves: the measures that studies of real crowds report.
//! Each file stands alone.

pub(crate) mod gate;
pub(crate) mod lanes;
pub(crate) mod measured_section;
pub(crate) mod waiting_crowd;

pub use gate::Gate;
pub use lanes::{LaneOrder, LaneWalker, lane_order};
pub use measured_section::{MeasuredSection, SectionMeans, weidmann_mps};
pub use waiting_crowd::{SECTORS, WaitingCrowd, WaitingShape};

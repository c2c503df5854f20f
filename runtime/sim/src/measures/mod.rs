//! What is measured of a crowd, frame by frame or of a whole recording: the figures of the paper's App. 11, of bodies,
//! of pedestrian studies, and the table of a recording.

pub mod agent_table;
pub(crate) mod arching;
pub(crate) mod body_penetration;
pub(crate) mod collision_rate;
pub(crate) mod gate;
pub(crate) mod lanes;
pub(crate) mod measured_section;
pub mod metrics;
pub(crate) mod planted_slide;
pub(crate) mod root_measures;
pub(crate) mod wall_contact;

pub use arching::{SECTORS, Shape, WaitingCrowd};
pub use body_penetration::{BodyPenetration, Penetration};
pub use collision_rate::Collisions;
pub use gate::Gate;
pub use lanes::{LaneOrder, LaneWalker, lane_order};
pub use measured_section::{MeasuredSection, Seen, weidmann_mps};
pub use planted_slide::{PlantedSlide, Slide};
pub use root_measures::{Mean, RootMeasures};
pub use wall_contact::{Contacts, WallContact};

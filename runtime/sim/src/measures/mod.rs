//! What is measured of a crowd, frame by frame or of a whole recording: the figures of the paper's App. 11, of bodies,
//! of pedestrian studies, and the table of a recording.

pub mod agent_table;
pub mod arching;
pub mod body_penetration;
pub mod collision_rate;
pub mod gate;
pub mod lanes;
pub mod measured_section;
pub mod metrics;
pub mod planted_slide;
pub mod root_measures;
pub mod wall_contact;

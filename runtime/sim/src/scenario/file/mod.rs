//! Scenario files in TOML: read, resolved to explicit agents, checked; every mistake is shown at its position in the
//! text.
//!
//! Enters: the text of a scenario file, and the agent files that it names. Leaves: a [`Scenario`](crate::Scenario), and
//! apart from it the source of its motion.
//!
//! Read `reading` (the steps from text to scenario), then `scenario_file` (the keys), `agent_groups` and `agent_lines`
//! (tables and lines of agents), `agent_area` (agents spread over an area), `profile_tables` (numbers that are drawn),
//! `agent_placement` (from them to agents), `group_keys` (agents that walk together), `sources` (agents that come
//! later), `ground_tables` and `marking_tables`
//! (walls, what is painted on the ground), `measure_tables` and `zone_tables` (lines and areas),
//! `variation_value` (how much bodies differ), and `cameras` (files that hold cameras alone).

mod agent_area;
mod agent_groups;
mod agent_lines;
mod agent_placement;
pub(crate) mod behaviour;
mod cameras;
mod ground_tables;
mod group_keys;
mod marking_tables;
mod measure_tables;
mod profile_tables;
mod reading;
mod scenario_file;
mod sources;
mod variation_value;
mod wkt_polygons;
mod zone_tables;

pub use agent_placement::{agents_of_lines, fault_of_lines};
pub use cameras::{CameraFile, camera_mistake, read_camera_file};
pub use reading::{agent_files, character_files, check_styles, names_motion, parse, read, read_plan};
pub use scenario_file::MotionSource;

//! The simulation: one step in the order of the paper's Fig. 2, told in [`step`].

pub mod agents;
pub mod angle;
pub mod around;
pub mod body_penetration;
pub mod cns;
pub mod collision_rate;
pub mod crowd;
pub mod decay;
pub mod hms;
pub mod mcn;
pub mod metrics;
pub mod neighbours;
pub mod obstacles;
pub mod params;
pub mod path;
pub mod plan;
pub mod planner;
pub mod planted_slide;
pub mod polygon;
pub mod reasons;
pub mod recording;
pub mod recording_chunk;
pub mod recording_error;
pub mod recording_frame;
pub mod recording_packing;
pub mod replay;
pub mod rivals;
pub mod root_measures;
pub mod scenario;
mod scenario_agents;
pub mod scenario_check;
pub mod scenario_error;
pub mod scenario_file;
mod scenario_point;
pub mod scenario_ranges;
pub mod segment_distance;
pub mod split_mix;
pub mod step;
pub mod wild_program;
pub mod wild_world;
pub mod world;

#[cfg(test)]
mod test_db;

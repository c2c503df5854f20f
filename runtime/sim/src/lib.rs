//! The simulation: one step in the order of the paper's Fig. 2, told in [`step`].

pub mod agents;
pub mod angle;
pub mod around;
pub mod arrival;
pub mod blocked_ways;
pub mod cns;
pub mod crowd;
pub mod decay;
pub mod decoupled;
pub mod hms;
pub mod mcn;
pub mod measures;
pub mod neighbours;
pub mod obstacles;
pub mod params;
pub mod path;
pub mod plan;
pub mod planner;
pub mod polygon;
pub mod reasons;
pub mod recording;
pub mod replay;
pub mod rivals;
pub mod scenario;
pub mod segment_distance;
pub mod split_mix;
pub mod step;
mod sweep;
pub mod world;

#[cfg(test)]
mod test_db;

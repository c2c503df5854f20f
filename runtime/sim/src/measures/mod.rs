//! Measures of a crowd: those of the paper (App. 11), of the bodies, and of pedestrian research.
//!
//! Enters: frames of a running simulation, one by one, or a whole recording. Leaves: measures, a table, or
//! trajectories.
//!
//! Read `crowd_measures`, which collects the measures of `fbcrowd measure` from its parts: `collision_rate` (Eqs. 16,
//! 17), `root_measures` (Eq. 18, arrival, tracking), `planted_slide`, `body_penetration` and `wall_contact` (both by
//! the capsules of `bone_capsule`); `frame_pairs` pairs the agents of two frames. `state_visits` counts agents in
//! states, `places` holds the scenario's own lines and areas, `pedestrian_studies` flow, lanes, density and waiting
//! crowds; `people` whether bodies move and differ as people do; `agent_table` and `trajectories` write a recording as text.
//! `shot_slide` measures feet in the frames of a shot. `character_soles` measures the feet of a character that wears a recording's poses.

pub(crate) mod agent_table;
pub(crate) mod body_penetration;
pub(crate) mod bone_capsule;
pub(crate) mod character_soles;
pub(crate) mod collision_rate;
pub(crate) mod crowd_measures;
pub(crate) mod frame_pairs;
pub(crate) mod pedestrian_studies;
pub mod people;
pub(crate) mod places;
pub(crate) mod planted_slide;
pub(crate) mod root_measures;
pub(crate) mod shot_slide;
pub(crate) mod state_visits;
pub(crate) mod trajectories;
pub(crate) mod wall_contact;

pub use agent_table::write_table;
pub use character_soles::{CharacterSoles, character_soles};
pub use collision_rate::Collisions;
pub use crowd_measures::{Measures, Measuring, measure};
pub use pedestrian_studies::{
    Gate, LaneOrder, LaneWalker, MeasuredSection, SECTORS, SectionMeans, WaitingCrowd, WaitingShape, lane_order,
    weidmann_mps,
};
pub use places::{AreaMeasures, AreaMoment, EgressMeasures, LEVELS_OF_SERVICE, LineMeasures, Passages, PlaceMeasures};
pub use planted_slide::{FootSlide, PlantedSlide};
pub use shot_slide::{ShotSlide, shot_slide};
pub use state_visits::StateMeasures;
pub use trajectories::{write_roots, write_trajectories};

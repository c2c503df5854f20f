//! Scenarios: what is simulated, resolved and checked.
//!
//! Enters: a scenario file ([`file`](mod@file)), or agents made in code. Leaves: a [`Scenario`] in which every agent is
//! explicit, every number is in range and no path occurs.
//!
//! Read `resolved` (the scenario) with `walls`, `agent_spec`, `source_spec`, `schedule`, `due_times`, `profile`,
//! `social_group`, `places` (zones, doors, markings, measured lines and areas, cameras, shots), `coupling` and `view`; then
//! `rules` and `ranges`, `fault` and `error` (how a broken rule is shown), `notes` (what has no effect); then
//! [`file`](mod@file).

pub(crate) mod agent_spec;
pub(crate) mod characters;
pub(crate) mod coupling;
pub(crate) mod due_times;
pub(crate) mod error;
pub(crate) mod fault;
pub mod file;
pub(crate) mod notes;
pub(crate) mod places;
mod point;
pub(crate) mod profile;
pub(crate) mod ranges;
pub(crate) mod resolved;
pub(crate) mod rules;
pub(crate) mod schedule;
pub(crate) mod social_group;
pub(crate) mod source_spec;
pub(crate) mod view;
pub(crate) mod walls;

pub use agent_spec::{AgentSpec, AtGoal, WALL_RADIUS_M};
pub use characters::character_spec::{CHARACTERS_MAX, CharacterSize, CharacterSpec};
pub use characters::character_tables::CharacterFile;
pub use coupling::Coupling;
pub use due_times::DueTimes;
pub use error::{Invalid, ScenarioError};
pub use fault::{ScenarioFault, ScenarioPart};
pub use file::{
    CameraFile, MotionSource, agent_files, agents_of_lines, camera_mistake, character_files, check_styles,
    fault_of_lines, names_motion, parse, read, read_camera_file, read_plan,
};
pub use places::barred_goals::BarredGoals;
pub use places::camera_spec::{CameraFollow, CameraKey, CameraOrbit, CameraSpec, KeyLine};
pub use places::door::DoorSpec;
pub use places::marking::{Marking, MarkingColour, MarkingShape, PlaceLabel};
pub use places::measure_spec::{MeasureSpec, MeasuredPlace};
pub use places::shot_spec::{FIRST_FRAME, FrameRate, ShotSpec};
pub use places::state_zones::StateZones;
pub use places::zone_spec::ZoneSpec;
pub use profile::{DrawnNumbers, Profile};
pub use ranges::{STATURE, STEP_RANGE_S, check_view};
pub use resolved::Scenario;
pub use rules::check;
pub use rules::shot_check::check_shot;
pub use schedule::{RateRow, Schedule, TimeRow};
pub use social_group::{GroupMember, GroupSizes};
pub use source_spec::SourceSpec;
pub use view::View;

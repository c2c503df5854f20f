//! The header of a recording: what holds for all its frames, and the checks that let readers trust its numbers.

use glam::Vec3;
use motiondb::body::{BONE_MAX_M, EXTRA_JOINTS_MAX, LIMIT_MAX_RAD, Skeleton};
use motiondb::motion::{ExtraBone, MotionDb};
use motiondb::velocity_sets::velocity_hull::VelocityHull;
use serde::{Deserialize, Serialize};

use crate::behaviour::Behaviour;
use crate::recording::chunk::ChunkFile;
use crate::recording::error::RecordingError;
use crate::recording::format::{HEAD, HEAD_BYTE};
use crate::recording::zipped_json;
use crate::scenario::ranges::check_has_agents;
use crate::scenario::rules::check::check_numbers;
use crate::scenario::{CharacterSpec, Scenario};

/// Greatest velocity of a set, m/s; none of a body comes near.
const SPEED_MAX_MPS: f32 = 100.0;
/// Greatest number of databases and of characters.
const DATABASES_MAX: usize = 10_000;
/// Greatest number of behaviour states: a frame names them by a u16.
const STATES_MAX: usize = 1 << 16;
/// Greatest length of the name of a character, joint or state, bytes.
const NAME_MAX_BYTES: usize = 200;

/// What holds for all frames of a recording. No timings, no dates, no paths.
///
/// A header is JSON, so that later versions of the program can add keys: a key that is added must have a default that
/// means what the program did before.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Header {
    /// The databases that the bodies came from; at least one.
    pub databases: Vec<RecordedDatabase>,
    /// The characters that bodies are drawn as.
    #[serde(default)]
    pub characters: Vec<RecordedCharacter>,
    /// Names of the behaviour states; at least one.
    #[serde(default = "default_states")]
    pub states: Vec<String>,
    /// The joints beside the 22 roles that each frame holds; empty where frames hold none.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub extra_joints: Vec<RecordedExtraJoint>,
    /// The whole scenario: agents at the start, sources, obstacles, tunables, time step, view.
    pub scenario: Scenario,
}

/// What a recording keeps of a database: with it, bodies can be drawn and any step can be planned again.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct RecordedDatabase {
    /// CRC-32 of the database.
    pub checksum: u32,
    /// The bodies: bones, soles, capsules.
    pub skeleton: Skeleton,
    /// Velocity sets of the database.
    pub velocity_hull: VelocityHull,
    /// Style of the motion; empty for agents without a style.
    #[serde(default, skip_serializing_if = "String::is_empty")]
    pub style: String,
}

/// A character that bodies are drawn as.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct RecordedCharacter {
    /// Name of the character.
    pub name: String,
    /// CRC-32 of the character's file; 0 where the simulation had none.
    pub checksum: u32,
}

/// A joint beside the 22 roles.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct RecordedExtraJoint {
    /// Name of the joint, such as `left_index_1`: that of [`ExtraJoint`](motiondb::body::ExtraJoint).
    pub name: String,
    /// Position relative to the parent, in the parent's rest axes, metres.
    pub offset_m: Vec3,
}

impl From<&ExtraBone> for RecordedExtraJoint {
    fn from(bone: &ExtraBone) -> Self {
        Self { name: bone.joint.name(), offset_m: bone.offset_m }
    }
}

fn default_states() -> Vec<String> {
    Behaviour::default().state_names()
}

impl Header {
    /// The header of a scenario with bodies from one database, and its styles that the scenario names.
    pub fn new(db: &MotionDb, database_checksum: u32, scenario: Scenario) -> Self {
        let database = |db: &MotionDb, style: String| RecordedDatabase {
            checksum: database_checksum,
            skeleton: db.skeleton.clone(),
            velocity_hull: db.velocity_hull.clone(),
            style,
        };
        let of_style = |style: &String| database(db.of_style(style).unwrap_or(db), style.clone());
        let styles: Vec<RecordedDatabase> = scenario.styles.iter().map(of_style).collect();
        let mut header = Self::of(database(db, String::new()), scenario);
        header.databases.extend(styles);
        header
    }

    /// The header of a recording whose frames hold the extra joints of a database too.
    #[must_use]
    pub fn with_extra_joints(self, db: &MotionDb) -> Self {
        Self { extra_joints: db.extra.bones.iter().map(RecordedExtraJoint::from).collect(), ..self }
    }

    /// The header of a scenario with bodies from one recorded database. The checksums of its characters are 0.
    pub fn of(database: RecordedDatabase, scenario: Scenario) -> Self {
        let states = scenario.behaviour.state_names();
        let character = |spec: &CharacterSpec| RecordedCharacter { name: spec.name.clone(), checksum: 0 };
        let characters = scenario.characters.iter().map(character).collect();
        Self { databases: vec![database], characters, states, extra_joints: Vec::new(), scenario }
    }

    /// The bodies of the first database; all styles have the same.
    ///
    /// # Panics
    /// If the header has no database; that of an opened recording has one.
    pub fn skeleton(&self) -> &Skeleton {
        &self.databases[0].skeleton
    }

    /// The velocity sets of the first database, by which agents without a style move.
    ///
    /// # Panics
    /// If the header has no database; that of an opened recording has one.
    pub fn velocity_hull(&self) -> &VelocityHull {
        &self.databases[0].velocity_hull
    }

    /// Decodes and checks the `HEAD` chunk of a file.
    pub(crate) fn read(file: &ChunkFile) -> Result<Self, RecordingError> {
        let payload = file.read_chunk(HEAD_BYTE, HEAD, zipped_json::PAYLOAD_MAX_BYTES)?;
        let header: Self = zipped_json::decode(&payload)
            .map_err(|what| file.damaged(HEAD_BYTE, format!("the header cannot be decoded ({what})")))?;
        header.check().map_err(|what| file.damaged(HEAD_BYTE, what))?;
        Ok(header)
    }

    /// Checks every number and name.
    ///
    /// # Errors
    /// What is wrong.
    pub(crate) fn check(&self) -> Result<(), String> {
        check_has_agents(&self.scenario).and_then(|()| check_numbers(&self.scenario)).map_err(|fault| fault.message)?;
        let counts = [
            ("databases", self.databases.len(), 1..=DATABASES_MAX),
            ("characters", self.characters.len(), 0..=DATABASES_MAX),
            ("behaviour states", self.states.len(), 1..=STATES_MAX),
            ("extra joints", self.extra_joints.len(), 0..=EXTRA_JOINTS_MAX),
        ];
        if let Some((what, count, _)) = counts.iter().find(|(_, count, range)| !range.contains(count)) {
            return Err(format!("the header has {count} {what}"));
        }
        if self.scenario.agents.iter().any(|agent| agent.style as usize >= self.databases.len()) {
            return Err("the style of an agent has no database".into());
        }
        let names = self.states.iter().chain(self.characters.iter().map(|character| &character.name));
        let mut names = names.chain(self.extra_joints.iter().map(|joint| &joint.name));
        if names.any(|name| name.len() > NAME_MAX_BYTES) {
            return Err("the name of a state, character or joint is longer than 200 bytes".into());
        }
        let is_bone = |offset_m: Vec3| offset_m.is_finite() && offset_m.abs().max_element() <= BONE_MAX_M;
        if !self.extra_joints.iter().all(|joint| is_bone(joint.offset_m)) {
            return Err("an extra joint is out of range".into());
        }
        if !self.databases.iter().all(|database| is_in_range(&database.skeleton)) {
            return Err("the skeleton is out of range".into());
        }
        if !self.databases.iter().all(|database| is_reachable(&database.velocity_hull)) {
            return Err("the velocity sets are out of range".into());
        }
        Ok(())
    }
}

/// Whether every bone, point and limit of a skeleton is finite and within [`BONE_MAX_M`] and [`LIMIT_MAX_RAD`]. Every
/// valid database satisfies this.
fn is_in_range(skeleton: &Skeleton) -> bool {
    let is_within = |max: f32| move |vector: Vec3| vector.is_finite() && vector.abs().max_element() <= max;
    let feet = skeleton.feet.iter();
    let points_m = feet.flat_map(|foot| [foot.heel_m, foot.ball_m, foot.toe_tip_m].into_iter().chain(foot.measured_m));
    let vectors = [skeleton.offsets_m, skeleton.segment_ends_m].into_iter().flatten();
    vectors.chain(points_m).all(is_within(BONE_MAX_M))
        && skeleton.limits_rad.iter().flatten().copied().all(is_within(LIMIT_MAX_RAD))
        && skeleton.segment_radii_m.iter().all(|radius_m| (0.0..=BONE_MAX_M).contains(radius_m))
}

/// Whether every velocity of the sets is finite and no faster than [`SPEED_MAX_MPS`].
fn is_reachable(hull: &VelocityHull) -> bool {
    let corners_mps = hull.turning_mps.iter().chain(&hull.holding_mps).chain(hull.sharp_turn_edges_mps.as_flattened());
    corners_mps.copied().all(|corner_mps| corner_mps.is_finite() && corner_mps.length() <= SPEED_MAX_MPS)
}

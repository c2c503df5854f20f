//! The neutral model of a scene: what every format is read into, and what the one writer writes. World, metres,
//! seconds, degrees, m/s.
//!
//! Enters: what a reader found. Leaves: a [`Scene`], in which names refer to names. Read `shape` and `drawn_number`
//! first, then `agents`, `behaviour`, `ground` and `note`.

mod agents;
mod behaviour;
mod drawn_number;
mod ground;
mod note;
mod shape;

pub use agents::{Grid, SceneAgents, SceneProfile, SceneSource, SourceTimes, Starts};
pub use behaviour::{
    Choose, GoalPlace, Remember, SceneArea, SceneCondition, SceneGoals, SceneMovement, SceneSettings, SceneState,
    SceneTarget, SceneTransition,
};
pub use drawn_number::DrawnNumber;
pub use ground::{ClosedZone, SceneMeasure, SceneObstacle, Walkable};
pub use note::{Note, Notes};
pub(crate) use shape::round_to_mm;
pub use shape::{Point, Shape};

/// A scene of another program.
#[derive(Clone, Debug, Default)]
pub struct Scene {
    /// Kind of the source, as the header of the scenario states it: "Menge project".
    pub kind: &'static str,
    /// Name of the file that was converted.
    pub source: String,
    /// Simulated time, s, where the source states one.
    pub duration_s: Option<f64>,
    /// Seed of everything random, where the source states one.
    pub seed: Option<u64>,
    /// Lines of the scenario's header, beyond the source.
    pub remarks: Vec<String>,
    /// Numbers of agents by name; one that inherits comes after its parent.
    pub profiles: Vec<SceneProfile>,
    /// Agents at the start.
    pub agents: Vec<SceneAgents>,
    /// Agents that come later.
    pub sources: Vec<SceneSource>,
    /// Sets of goals by name.
    pub goals: Vec<SceneGoals>,
    /// Areas that conditions name.
    pub areas: Vec<SceneArea>,
    /// States by name.
    pub states: Vec<SceneState>,
    /// Ground on which agents walk; none: all ground.
    pub walkable: Vec<Walkable>,
    /// Obstacles.
    pub obstacles: Vec<SceneObstacle>,
    /// Ground that agents do not enter in some states.
    pub closed_zones: Vec<ClosedZone>,
    /// Areas in which the density is measured.
    pub measures: Vec<SceneMeasure>,
    /// Width and height of pictures, pixels.
    pub picture: Option<[u64; 2]>,
    /// What is not supported.
    pub notes: Notes,
}

impl Scene {
    /// Number of agents at the start.
    pub fn agent_count(&self) -> usize {
        self.agents.iter().map(|agents| agents.starts.count()).sum()
    }
}

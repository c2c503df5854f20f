//! A scenario, resolved: every agent explicit, nothing that names a path.

mod agents;
pub mod check;
pub(crate) mod coupling;
pub(crate) mod error;
pub mod file;
mod point;
pub(crate) mod ranges;

pub use check::{Fault, Place};
pub use coupling::Coupling;
pub use error::{Invalid, ScenarioError};
pub use file::{MotionSource, agents_of_lines, fault_of_lines, read};
pub use ranges::check_view;

use glam::Vec2;
use serde::{Deserialize, Serialize};

use crate::params::Params;
use crate::planning::planner::Planner;
use crate::synthesis::Modes;

/// What is simulated. A recording carries it whole.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Scenario {
    /// File stem of the scenario file, unless it sets `name`.
    pub name: String,
    /// Simulated time, s.
    pub duration_s: f32,
    /// Step, s.
    pub dt_s: f32,
    /// Seed of everything random.
    pub seed: u64,
    /// Who plans.
    pub planner: Planner,
    /// What moves the discs.
    pub coupling: Coupling,
    /// In index order.
    pub agents: Vec<AgentSpec>,
    /// Simple polygons, corners counter-clockwise, world, metres; agents stay outside.
    pub obstacles_m: Vec<Vec<Vec2>>,
    /// Tunables.
    pub params: Params,
    /// The picture.
    pub view: View,
}

/// A film's step, s.
const STEP_S: f32 = 1.0 / 30.0;
/// As long as a run of Table 1 (`definitions.md`), s.
const DURATION_S: f32 = 60.0;

impl Scenario {
    /// Agents on open ground, with everything else at its default; for who names what differs.
    pub fn of(agents: Vec<AgentSpec>) -> Self {
        Self {
            name: String::new(),
            duration_s: DURATION_S,
            dt_s: STEP_S,
            seed: 1,
            planner: Planner::default(),
            coupling: Coupling::default(),
            agents,
            obstacles_m: Vec::new(),
            params: Params::default(),
            view: View::default(),
        }
    }

    /// The syntheses that bodies may use: those that follow a path planned before them only blend.
    pub fn modes(&self) -> Modes {
        match self.coupling {
            Coupling::TwoWay => self.params.synthesis.modes,
            Coupling::Discs | Coupling::Decoupled => Modes::Blending,
        }
    }
}

/// One agent at its start.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct AgentSpec {
    /// World, metres.
    pub position_m: Vec2,
    /// World, radians; towards the first goal unless given.
    pub facing_rad: f32,
    /// Waypoints in order; the last one is the goal.
    pub goals_m: Vec<Vec2>,
    /// Radius of the bounding disc, m.
    pub radius_m: f32,
    /// Speed of v_pref, m/s.
    pub preferred_speed_mps: f32,
}

/// How the top view frames the scene.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields, default)]
pub struct View {
    /// Pixels.
    pub width: u32,
    /// Pixels.
    pub height: u32,
    /// Frames a second of the sequence; the recording is sampled at it.
    pub frame_rate_hz: f32,
    /// Centre of the picture, world, metres; framed automatically where absent.
    #[serde(deserialize_with = "point::optional")]
    pub centre_m: Option<Vec2>,
    /// Metres across the picture's width; framed automatically where absent.
    pub width_m: Option<f32>,
    /// Length of the trails, s; 0 draws none.
    pub trail_s: f32,
    /// Writes each agent's index beside it.
    pub labels: bool,
}

impl Default for View {
    fn default() -> Self {
        Self {
            width: 1280,
            height: 720,
            frame_rate_hz: 30.0,
            centre_m: None,
            width_m: None,
            trail_s: 2.0,
            labels: false,
        }
    }
}

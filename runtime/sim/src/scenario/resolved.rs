//! A scenario, resolved: every agent explicit, nothing that names a path. World, metres, seconds.

use glam::Vec2;
use serde::{Deserialize, Serialize};

use crate::behaviour::Behaviour;
use crate::params::Params;
use crate::planning::planner::Planner;
use crate::route::mesh::WalkablePolygon;
use crate::scenario::agent_spec::AgentSpec;
use crate::scenario::characters::character_spec::CharacterSpec;
use crate::scenario::coupling::Coupling;
use crate::scenario::places::camera_spec::CameraSpec;
use crate::scenario::places::door::DoorSpec;
use crate::scenario::places::marking::{Marking, PlaceLabel};
use crate::scenario::places::measure_spec::MeasureSpec;
use crate::scenario::places::shot_spec::ShotSpec;
use crate::scenario::places::zone_spec::ZoneSpec;
use crate::scenario::source_spec::SourceSpec;
use crate::scenario::view::View;
use crate::synthesis::Modes;
use crate::variation::Variation;

/// Default time step, s: a film's.
const STEP_S: f32 = 1.0 / 30.0;
/// Default duration, s: that of a run of Table 1.
const DURATION_S: f32 = 60.0;
/// Default seed.
pub(crate) const SEED: u64 = 1;

/// What is simulated. A recording carries it whole.
///
/// ```
/// use std::path::PathBuf;
///
/// use fbcrowd_sim::scenario;
/// use motiondb::files::SourceText;
///
/// let text = "
///     database = 'motion.fbdb'
///     duration_s = 20
///     agents = { circle = { count = 17, radius_m = 4 } }
/// ";
/// let source = SourceText { path: PathBuf::from("circle.toml"), text: text.to_owned() };
/// // The source of the motion is a result of its own: `motion.fbdb` need not exist.
/// let (scenario, _motion) = scenario::parse(&source)?;
/// assert_eq!(scenario.name, "circle");
/// assert_eq!(scenario.agents.len(), 17);
/// assert_eq!(scenario.agents[0].goals_m, [-scenario.agents[0].position_m]);
/// # Ok::<(), scenario::ScenarioError>(())
/// ```
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Scenario {
    /// Name of the scenario: the stem of its file, unless the file sets `name`.
    pub name: String,
    /// Simulated time, s.
    pub duration_s: f32,
    /// Time step, s.
    pub dt_s: f32,
    /// Seed of everything random.
    pub seed: u64,
    /// The planner of all agents.
    pub planner: Planner,
    /// What moves the discs.
    pub coupling: Coupling,
    /// The agents at the start, in index order.
    pub agents: Vec<AgentSpec>,
    /// Sources of further agents.
    #[serde(default)]
    pub sources: Vec<SourceSpec>,
    /// Goals, states and signals.
    #[serde(default, skip_serializing_if = "Behaviour::is_empty")]
    pub behaviour: Behaviour,
    /// Ground on which agents walk slower or faster.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub zones: Vec<ZoneSpec>,
    /// What is measured besides the figures of every recording.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub measures: Vec<MeasureSpec>,
    /// Simple polygons, corners counter-clockwise, world, m; agents stay outside.
    pub obstacles_m: Vec<Vec<Vec2>>,
    /// Height of each obstacle in pictures, by index, m; none where the file states none.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub obstacle_heights_m: Vec<Option<f32>>,
    /// Obstacles that are absent while a signal is green.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub doors: Vec<DoorSpec>,
    /// Simple polygons with a wall without thickness around each, which agents cross in neither direction.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub enclosures_m: Vec<Vec<Vec2>>,
    /// Polygons on which agents can walk, united; the ground is open where there are none.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub walkable_m: Vec<WalkablePolygon>,
    /// Markings of the ground, the lowest first.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub markings: Vec<Marking>,
    /// Texts at places.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub labels: Vec<PlaceLabel>,
    /// Characters that bodies are drawn as; plain bodies where there are none.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub characters: Vec<CharacterSpec>,
    /// Styles of motion that agents name, by the order of their names.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub styles: Vec<String>,
    /// Cameras, by which pictures at eye height are taken.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub cameras: Vec<CameraSpec>,
    /// Which moments become frames; none where the file states none.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub shot: Option<ShotSpec>,
    /// How much bodies differ; none: all move as in the clips.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub variation: Option<Variation>,
    /// Tunables.
    pub params: Params,
    /// How the top view frames the scene.
    pub view: View,
}

impl Scenario {
    /// Number of time steps.
    pub fn steps(&self) -> usize {
        (self.duration_s / self.dt_s).round() as usize
    }

    /// Agents on open ground whose bodies all move as in the clips, with everything else at its default.
    ///
    /// ```
    /// use fbcrowd_sim::scenario::{AgentSpec, Scenario};
    /// use glam::Vec2;
    ///
    /// let agent = AgentSpec {
    ///     position_m: Vec2::ZERO,
    ///     facing_rad: 0.0,
    ///     goals_m: vec![Vec2::new(5.0, 0.0)],
    ///     radius_m: 0.25,
    ///     wall_radius_m: 0.2,
    ///     preferred_speed_mps: 1.33,
    ///     ..AgentSpec::default()
    /// };
    /// let scenario = Scenario { duration_s: 10.0, ..Scenario::of(vec![agent]) };
    /// assert_eq!(scenario.dt_s, 1.0 / 30.0);
    /// ```
    pub fn of(agents: Vec<AgentSpec>) -> Self {
        Self {
            name: String::new(),
            duration_s: DURATION_S,
            dt_s: STEP_S,
            seed: SEED,
            planner: Planner::default(),
            coupling: Coupling::default(),
            agents,
            sources: Vec::new(),
            behaviour: Behaviour::default(),
            zones: Vec::new(),
            measures: Vec::new(),
            obstacles_m: Vec::new(),
            obstacle_heights_m: Vec::new(),
            doors: Vec::new(),
            enclosures_m: Vec::new(),
            walkable_m: Vec::new(),
            markings: Vec::new(),
            labels: Vec::new(),
            characters: Vec::new(),
            styles: Vec::new(),
            cameras: Vec::new(),
            shot: None,
            variation: None,
            params: Params::default(),
            view: View::default(),
        }
    }

    /// Whether any agent is in a group, or any source's may be.
    pub(crate) fn has_groups(&self) -> bool {
        self.agents.iter().any(|agent| agent.group.is_some())
            || self.sources.iter().any(|source| source.groups.is_some())
    }

    /// Whether any agent has a priority of its own, or may have it in a state.
    pub(crate) fn has_priorities(&self) -> bool {
        let of_sources = |source: &SourceSpec| {
            source.priority != 0.0 || source.profiles.iter().any(|profile| profile.priority != 0.0)
        };
        self.agents.iter().any(|agent| agent.priority != 0.0)
            || self.sources.iter().any(of_sources)
            || self.behaviour.states.iter().any(|state| state.settings.priority.is_some())
    }

    /// The syntheses that bodies may use. Bodies that follow a path planned before them only blend.
    pub fn modes(&self) -> Modes {
        match self.coupling {
            Coupling::TwoWay => self.params.synthesis.modes,
            Coupling::Discs | Coupling::Decoupled => Modes::Blending,
        }
    }
}

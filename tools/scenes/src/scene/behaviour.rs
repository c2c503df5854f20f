//! What agents of a scene want: goals, areas, states and transitions, by name.

use crate::scene::drawn_number::DrawnNumber;
use crate::scene::shape::{Point, Shape};

/// A set of goals.
#[derive(Clone, Debug, PartialEq)]
pub struct SceneGoals {
    /// Name of the set.
    pub name: String,
    /// How an agent chooses.
    pub choose: Choose,
    /// The goals.
    pub places: Vec<GoalPlace>,
    /// Position in the source, "file:line".
    pub origin: String,
}

/// How an agent chooses a goal of a set.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, PartialOrd, Ord)]
pub enum Choose {
    /// The nearest.
    #[default]
    Nearest,
    /// The farthest.
    Farthest,
    /// Any.
    Random,
    /// By weight.
    Weighted,
}

/// One goal of a set.
#[derive(Clone, Debug, PartialEq)]
pub struct GoalPlace {
    /// Its shape.
    pub shape: Shape,
    /// Greatest number of agents that go to it, where it is limited.
    pub capacity: Option<u64>,
    /// Weight of the choice.
    pub weight: f64,
}

/// An area that conditions name.
#[derive(Clone, Debug, PartialEq)]
pub struct SceneArea {
    /// Name of the area.
    pub name: String,
    /// Its shape.
    pub shape: Shape,
}

/// A state.
#[derive(Clone, Debug, PartialEq)]
pub struct SceneState {
    /// Name of the state.
    pub name: String,
    /// Where an agent goes.
    pub movement: SceneMovement,
    /// What changes when an agent enters.
    pub settings: SceneSettings,
    /// Transitions in order.
    pub transitions: Vec<SceneTransition>,
    /// Words behind the table's name.
    pub comment: String,
}

/// Where an agent goes.
#[derive(Clone, Debug, PartialEq)]
pub enum SceneMovement {
    /// To a goal of a set.
    Go {
        /// Name of the set.
        goals: String,
        /// Whose choice it remembers.
        remember: Option<Remember>,
    },
    /// To the position opposite its start, through a point.
    Mirror(Point),
    /// To the position at an offset from its start.
    Offset(Point),
    /// To its own goal, which its group states.
    OwnPath,
    /// It stands at its last goal, or where it is.
    Stand,
    /// At a constant velocity, m/s.
    Walk(Point),
    /// It leaves the scene.
    Remove,
}

/// A choice of goal that an agent remembers.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Remember {
    /// The state's own.
    Own,
    /// That of another state, by name.
    Of(String),
}

/// What changes when an agent enters a state.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct SceneSettings {
    /// Preferred speed, m/s.
    pub preferred_speed_mps: Option<DrawnNumber>,
    /// Factor of the preferred speed.
    pub speed_factor: Option<DrawnNumber>,
    /// Radius of the disc, m.
    pub radius_m: Option<DrawnNumber>,
    /// Position to which the agent is moved at once.
    pub teleport: Option<Shape>,
    /// Whether speed and radius stay changed.
    pub remain: bool,
}

/// A transition.
#[derive(Clone, Debug, PartialEq)]
pub struct SceneTransition {
    /// When it is taken.
    pub when: SceneCondition,
    /// Where it leads.
    pub to: SceneTarget,
}

/// When a transition is taken.
#[derive(Clone, Debug, PartialEq)]
pub enum SceneCondition {
    /// At once.
    Always,
    /// Within this distance of the goal, m; 0: inside.
    Reached(f64),
    /// This time after it entered, s.
    After(DrawnNumber),
    /// Inside an area, by name.
    Inside(String),
    /// At least, and at most, so many agents are in a state.
    Population(String, Option<u64>, Option<u64>),
    /// All hold.
    All(Vec<SceneCondition>),
    /// One holds.
    Any(Vec<SceneCondition>),
    /// It does not hold.
    Not(Box<SceneCondition>),
}

/// Where a transition leads.
#[derive(Clone, Debug, PartialEq)]
pub enum SceneTarget {
    /// To a state.
    State(String),
    /// To one of several states, by weight.
    Weights(Vec<(String, f64)>),
    /// To the state before.
    Back,
}

impl SceneTarget {
    /// Names of the states to which it leads.
    pub fn states(&self) -> Vec<&str> {
        match self {
            Self::State(name) => vec![name],
            Self::Weights(weights) => weights.iter().map(|(name, _)| name.as_str()).collect(),
            Self::Back => Vec::new(),
        }
    }
}

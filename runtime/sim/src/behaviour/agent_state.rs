//! What the state machine remembers of one agent, and what it wants of it. World, metres, seconds, radians.

use glam::Vec2;

/// An area of a set of goals, both by index.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub struct GoalRef {
    /// The set.
    pub set: u32,
    /// The area in the set.
    pub area: u32,
}

/// What an agent wants: the route turns it into v_pref.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub enum Aim {
    /// To walk along its own waypoints.
    #[default]
    OwnPath,
    /// To walk to an area, and inside it to a position of its own.
    Goal {
        /// The area.
        goal: GoalRef,
        /// Its position in the area, world, m.
        position_m: Vec2,
        /// Facing once it stands there, world, rad; none: as it arrives.
        facing_rad: Option<f32>,
    },
    /// To walk to a position that no other agent has as its goal, world, m.
    Position(Vec2),
    /// To walk at a velocity, world, m/s.
    Velocity(Vec2),
    /// To stand where it is.
    Stay {
        /// Facing, world, rad; none: as it is.
        facing_rad: Option<f32>,
    },
    /// To leave the scene.
    Leave {
        /// Before the next step, not between two steps of its feet.
        at_once: bool,
    },
}

impl Aim {
    /// The position to which the agent walks, m.
    pub fn position_m(&self) -> Option<Vec2> {
        match *self {
            Self::Goal { position_m, .. } | Self::Position(position_m) => Some(position_m),
            Self::OwnPath | Self::Velocity(_) | Self::Stay { .. } | Self::Leave { .. } => None,
        }
    }

    /// Facing of the agent once it stands, rad; none: as it is.
    pub fn facing_rad(&self) -> Option<f32> {
        match *self {
            Self::Goal { facing_rad, .. } | Self::Stay { facing_rad } => facing_rad,
            Self::OwnPath | Self::Position(_) | Self::Velocity(_) | Self::Leave { .. } => None,
        }
    }
}

/// What settings change of an agent.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Traits {
    /// Preferred speed, m/s.
    pub preferred_speed_mps: f32,
    /// Radius of the disc that other agents see, m.
    pub radius_m: f32,
}

/// A goal that an agent has chosen.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct ChosenGoal {
    pub(crate) at: GoalRef,
    /// Its position in the area, world, m.
    pub(crate) position_m: Vec2,
    /// Whether it counts in the area: an agent that walks to a queue joins it only near its end.
    pub(crate) is_taken: bool,
}

/// What the state machine remembers of one agent.
#[derive(Clone, Debug, PartialEq)]
pub struct AgentState {
    /// The state, by index.
    pub state: u32,
    /// The state before; none at the start.
    pub(crate) before: Option<u32>,
    /// Time at which it entered the state, s.
    pub(crate) entered_s: f64,
    /// Number of states entered.
    pub(crate) entries: u32,
    pub(crate) goal: Option<ChosenGoal>,
    /// Time at which it came to the head of its queue, s.
    pub(crate) at_head_s: Option<f64>,
    /// Time of its last choice, s.
    pub(crate) chosen_s: f64,
    /// Goals that it keeps while it is elsewhere, by the memory of their states.
    pub(crate) remembered: Vec<(u32, ChosenGoal)>,
    /// Traits without the settings of the present state that end with it.
    pub(crate) lasting: Traits,
    /// Present traits.
    pub traits: Traits,
    /// Its start, world, m.
    pub(crate) start_m: Vec2,
    /// What it wants.
    pub aim: Aim,
    /// Whether it wants to walk to another position than in the last step.
    pub has_new_aim: bool,
}

impl AgentState {
    /// The area that it has for a goal.
    pub fn goal_at(&self) -> Option<GoalRef> {
        self.goal.map(|goal| goal.at)
    }

    /// An agent that is about to enter a state for the first time.
    pub(crate) fn new(state: u32, traits: Traits, start_m: Vec2) -> Self {
        Self {
            state,
            before: None,
            entered_s: 0.0,
            entries: 0,
            goal: None,
            at_head_s: None,
            chosen_s: 0.0,
            remembered: Vec::new(),
            lasting: traits,
            traits,
            start_m,
            aim: Aim::OwnPath,
            has_new_aim: true,
        }
    }
}
